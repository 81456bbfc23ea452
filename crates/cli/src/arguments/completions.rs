//! Arguments of `armill completions`.

use clap::Args;
use clap_complete::Shell;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  armill completions bash > /etc/bash_completion.d/armill
  armill completions fish > ~/.config/fish/completions/armill.fish")]
pub(crate) struct CompletionsArguments {
    /// Shell for which completions are printed
    pub shell: Shell,
}

//! What can be typed behind `armill man`.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(after_help = "\
Pages that are there already are written anew.

Examples:
  armill man ~/.local/share/man/man1 && man armill-run")]
pub(crate) struct ManArguments {
    /// Folder to write them into
    pub dir: PathBuf,
    #[command(flatten)]
    pub writing: WritingOptions,
}

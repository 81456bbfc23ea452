//! `armill serve [STUDY]`: the live page of a study.

use std::path::PathBuf;

use clap::Args;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  armill serve                        the study in the current folder, else the example mh12-groove
  armill serve cell --port 8080
  armill serve cell --no-open         only print the address
The address contains a token that is new at every start: anyone who has it can read and write the folder of the study.
The page can only be reached from this machine. Ctrl-C stops the server.")]
pub(crate) struct ServeArguments {
    /// Folder with a study.toml, the file itself, or the name of an example [default: current folder, else mh12-groove]
    pub study: Option<PathBuf>,
    /// Port on 127.0.0.1 [default: the same for a study at every start, or a free port]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub port: u16,
    /// Do not open the browser
    #[arg(long)]
    pub no_open: bool,
}

//! `armill serve [STUDY]`: the live page of a study.

use std::path::PathBuf;

use clap::Args;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  armill serve                        the study of this folder, else the example mh12-groove
  armill serve cell --port 8080
  armill serve cell --no-open         print the address alone
The address holds a token that is new at every start: whoever has it may read and write the folder of the study.
Only this machine can reach it. Ctrl-C ends it.")]
pub(crate) struct ServeArguments {
    /// Folder with a study.toml, the file itself, or the name of an example study (the current folder, else mh12-groove)
    pub study: Option<PathBuf>,
    /// Port on 127.0.0.1; one that is free if left out
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub port: u16,
    /// Do not open the browser
    #[arg(long)]
    pub no_open: bool,
}

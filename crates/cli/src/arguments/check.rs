//! Arguments of `armill check`.
//!
//! Clap requires a study unless `--schema` is given.

use std::path::PathBuf;

use clap::Args;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  armill check cell                  report all problems of cell/study.toml
  armill check --schema > study.schema.json   JSON Schema, for your editor")]
pub(crate) struct CheckArguments {
    /// Folder with a study.toml, the file itself, or the name of an example study
    #[arg(required_unless_present = "schema")]
    pub study: Option<PathBuf>,
    /// Print the JSON Schema of the study file instead
    #[arg(long)]
    pub schema: bool,
    /// Print problems and warnings as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

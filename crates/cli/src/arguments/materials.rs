//! Arguments of `armill materials`.

use clap::Args;

#[derive(Debug, Args)]
#[command(after_help = "\
A study names a material in its [cut]. Forces are the mean of its complete coefficient sets; their scatter gives the
uncertainty.

Examples:
  armill materials
  armill materials aluminium-7075-t6
  armill materials steel-low-alloy --json")]
pub(crate) struct MaterialsArguments {
    /// Name in the library
    pub name: Option<String>,
    /// Print as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

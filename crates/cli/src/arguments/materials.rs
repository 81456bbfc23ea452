//! Arguments of `armill materials`.

use clap::Args;

#[derive(Debug, Args)]
#[command(after_help = "\
A study names a material in its table [cut]. Forces are computed from the mean of the complete coefficient sets of the \
material; the scatter of the sets gives the uncertainty.

Examples:
  armill materials
  armill materials aluminium-7075-t6
  armill materials steel-low-alloy --json")]
pub(crate) struct MaterialsArguments {
    /// Name of a material in the library
    pub name: Option<String>,
    /// Print as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

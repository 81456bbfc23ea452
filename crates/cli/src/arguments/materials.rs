//! What can be typed behind `armill materials`.

use clap::Args;

#[derive(Debug, Args)]
#[command(after_help = "\
A study names a material in its [cut]. Forces come from the mean of its whole sets; their scatter is the uncertainty.

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

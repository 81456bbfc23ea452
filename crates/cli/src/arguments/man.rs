//! Arguments of `armill man`.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(after_help = "\
Existing pages are overwritten.

Examples:
  armill man ~/.local/share/man/man1 && man armill-run")]
pub(crate) struct ManArguments {
    /// Folder for the pages
    pub dir: PathBuf,
    #[command(flatten)]
    pub writing: WritingOptions,
}

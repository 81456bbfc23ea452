//! Options of every command that writes files.

use armill_formats::file::Writer;
use clap::Args;

#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct WritingOptions {
    /// Overwrite files that armill did not write or that were changed since, but never an input of the command
    #[arg(long)]
    pub force: bool,
}

impl WritingOptions {
    /// The writer of the command `by`; call it after its inputs were named, see [`Writer::new`].
    pub(crate) fn writer(self, by: &'static str) -> Writer {
        Writer::new(by, self.force)
    }
}

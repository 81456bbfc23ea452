//! Files that are written: whole or not at all, and never over what is not ours.
//!
//! | question | where |
//! |---|---|
//! | why a file was not written | `error`: [`FileError`] |
//! | how a file is whole or not there, also after a power cut | `part`: [`write_atomically`], [`PartFile`] |
//! | temporary files where the system has none | `wasi` |
//! | which files armill made, and whether they were changed since | `ledger`: `.armill-files` |
//! | which run writes into a folder | `lock`: `.armill-lock` |
//! | what a command may replace and remove | `writer`: [`Writer`], [`ResultFolder`] |
//!
//! The rules of [`Writer`], which every command writes through:
//!
//! - a file that exists is replaced if armill made it and it was not changed since, or with `--force`;
//! - an input of the same command is never replaced;
//! - only files that the same command made and that were not changed since are removed;
//! - links are never followed.

mod error;
mod ledger;
mod lock;
mod part;
#[cfg(target_os = "wasi")]
mod wasi;
mod writer;

pub use error::FileError;
pub use ledger::sum_of;
pub use part::{PartFile, create_folder, new_part, remove_abandoned, sync_folder, write_atomically};
pub use writer::{ResultFolder, Writer};

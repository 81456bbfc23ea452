//! The bytes of a file with a limit on how many of them are read.
//!
//! Links, trees and chunk indices of an HDF5 file may name the same bytes any number of times. A reader that follows all of them does not end in
//! reasonable time, or needs memory without limit. Whatever it does, it reads: what it may read in total is limited here.

use std::sync::atomic::{AtomicU64, Ordering};

use hdf5_pure::{FormatError, Source};

/// Bytes that a read costs in addition to its length.
const COST_OF_A_READ: u64 = 64;

pub(super) struct Metered {
    content: Vec<u8>,
    /// What may be read from now on, byte.
    left: AtomicU64,
}

impl Metered {
    /// A file of which at most `most` bytes may be read.
    pub(super) fn new(content: Vec<u8>, most: u64) -> Metered {
        Metered {
            content,
            left: AtomicU64::new(most),
        }
    }
}

impl Source for Metered {
    fn len(&self) -> u64 {
        self.content.len() as u64
    }

    fn read_at(&self, offset: u64, into: &mut [u8]) -> Result<(), FormatError> {
        let cost = (into.len() as u64).saturating_add(COST_OF_A_READ);
        let pay = |left: u64| left.checked_sub(cost);
        if self
            .left
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, pay)
            .is_err()
        {
            return Err(FormatError::Source(
                "its parts refer to the same bytes too often".to_owned(),
            ));
        }
        let start = usize::try_from(offset).ok();
        let end = start.and_then(|start| start.checked_add(into.len()));
        let found = start
            .zip(end)
            .and_then(|(start, end)| self.content.get(start..end));
        let Some(found) = found else {
            return Err(FormatError::UnexpectedEof {
                expected: end.unwrap_or(usize::MAX),
                available: self.content.len(),
            });
        };
        into.copy_from_slice(found);
        Ok(())
    }
}

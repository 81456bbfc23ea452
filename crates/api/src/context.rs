//! What all answers share.

use armill_study::live::{PartCache, PathCache};

use crate::cell::Cell;

/// The study, and what was evaluated last.
pub struct Context {
    /// The study and its folder.
    pub cell: Cell,
    /// The last evaluated path.
    pub paths: PathCache,
    /// The last evaluated part.
    pub parts: PartCache,
}

impl Context {
    /// Of this study, with nothing evaluated.
    pub fn new(cell: Cell) -> Context {
        Context {
            cell,
            paths: PathCache::default(),
            parts: PartCache::default(),
        }
    }
}

//! The deviation at holes in any order, each with a posture of its own.
//!
//! [`table`] the key `holes`; [`resolve`](mod@resolve) their positions, directions and load; [`answer`], [`sentence`]
//! and [`warnings`](mod@warnings); [`columns`](mod@columns), [`pictures`](mod@pictures) and [`report`].

pub mod answer;
pub mod columns;
pub mod pictures;
pub mod report;
pub mod resolve;
pub mod sentence;
pub mod table;
pub mod warnings;

use armill_core::optimize::PostureSearch;
use armill_core::robot::BranchPattern;

use crate::analysis::path::PathAnalysis;

/// Holes with their load.
#[derive(Clone, Debug)]
pub struct HolesAnalysis {
    /// Their positions as separate points, and the load there.
    pub path: PathAnalysis,
    /// Spins and branches that are tried at each.
    pub search: PostureSearch,
}

impl HolesAnalysis {
    /// Permitted branches, in words: `best` if all are.
    pub fn branch(&self) -> String {
        let open = self.search.branches;
        match open == BranchPattern::default() {
            true => "best".to_owned(),
            false => open.to_string(),
        }
    }
}

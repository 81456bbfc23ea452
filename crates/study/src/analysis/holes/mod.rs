//! The deviation at holes in any order, each with its best posture.
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

pub use resolve::HolesAnalysis;

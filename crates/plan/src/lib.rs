//! What to do about a deviation.
//!
//! [`place`] searches the best placement of a part, [`compensate`] the path to command so that the tool follows the
//! nominal one, [`advise`] recommends measures for a path, [`compare`] compares several studies or robots.

pub mod advise;
pub mod compare;
pub mod compensate;
pub mod place;

mod measure;
mod study_text;

pub use measure::Measure;

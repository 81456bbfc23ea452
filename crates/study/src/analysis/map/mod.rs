//! The deviation over a plane.
//!
//! [`answer`] its region, worst and best point as JSON; [`sentence`]; [`pictures`]; [`report`].

pub mod answer;
pub mod pictures;
pub mod report;
pub mod sentence;

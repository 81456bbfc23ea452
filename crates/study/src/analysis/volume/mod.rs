//! The deviation in a box.
//!
//! [`table`] the key `box`; [`resolve`] its points; [`answer`] and [`sentence`]; [`pictures`] slices; [`report`].

pub mod answer;
pub mod pictures;
pub mod report;
pub mod resolve;
pub mod sentence;
pub mod table;

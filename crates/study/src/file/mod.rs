//! What a user writes: the study file, format 1.
//!
//! [`format`](mod@format) is the file as it stands; [`resolve`] checks it and works out what each ask means.

pub mod format;
pub mod resolve;

mod places;

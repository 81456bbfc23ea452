//! What pushes on the tool?
//!
//! [`cases`]: a set of given wrenches, the same at every point.

pub mod cases;

pub use cases::{LoadCases, LoadFrame};

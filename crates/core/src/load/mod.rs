//! What pushes on the tool?
//!
//! [`cases`]: a set of given wrenches, the same at every point. [`doubt`]: how sure they are.

pub mod cases;
pub mod doubt;

pub use cases::{LoadCases, LoadFrame};
pub use doubt::Doubt;

//! What pushes on the tool?
//!
//! [`cases`]: a set of given wrenches, the same at every point. [`along`]: wrenches that turn with the feed, or change
//! from point to point. [`doubt`]: how sure they are.

pub mod along;
pub mod cases;
pub mod doubt;

pub use along::PathLoad;
pub use cases::{LoadCases, LoadFrame};
pub use doubt::Doubt;

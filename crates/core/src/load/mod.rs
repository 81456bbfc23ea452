//! What pushes on the tool?
//!
//! [`cases`]: a set of given wrenches, the same at every point. [`doubt`]: how sure they are.
//! [`record`]: a force as it was measured over time.

pub mod cases;
pub mod doubt;
pub mod record;

pub use cases::{LoadCases, LoadFrame};
pub use doubt::Doubt;
pub use record::{ActsOn, Record, RecordError};

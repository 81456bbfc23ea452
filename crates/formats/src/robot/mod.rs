//! Robot descriptions in: our own robot file, and URDF.
//!
//! Each format has the same parts: what it is, `read`, tests incl. broken input. All give a
//! [`RobotDescription`]: the robot of the core, with the source of its numbers.

pub mod armill;
pub mod structure;
pub mod urdf;

mod description;

pub use description::{JointNote, RobotDescription, Source, Symbol};

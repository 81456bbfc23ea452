//! Robot descriptions in: our own robot file, URDF, xacro, OPW parameters, Denavit-Hartenberg tables, chains of
//! elementary motions; poses as pendants show them.
//!
//! Each format has the same parts: what it is, `read`, tests incl. broken input. All give a
//! [`RobotDescription`]: the robot of the core, with the source of its numbers. [`format`](mod@format) tells which
//! of them a file is.

pub mod armill;
pub mod chain;
pub mod dh;
pub mod format;
pub mod opw;
pub mod pendant;
pub mod spring_tables;
pub mod urdf;
#[cfg(feature = "xacro")]
pub mod xacro;

mod description;
mod xml;

/// More joints than this are no serial arm, and what looks at pairs of joints would take long: the longest snake robots
/// have about thirty. The schema of our own robot file says the same.
const MOST_JOINTS: usize = 64;

/// An angle in rad beyond two turns is one in degrees under the wrong name.
const TWO_TURNS: f64 = 4.0 * std::f64::consts::PI;

pub use description::{JointNote, OtherLimits, RobotDescription, Symbol};

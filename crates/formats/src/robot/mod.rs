//! Robot descriptions in: our own robot file, URDF, xacro, OPW parameters, Denavit-Hartenberg tables, chains of
//! elementary motions; poses as pendants show them.
//!
//! Each format has the same parts: what it is, `read`, tests incl. broken input. All give a
//! [`RobotDescription`]: the robot of the core, with the source of its numbers. [`format`](mod@format) tells which
//! of them a file is.
//!
//! [`armill`]: our own; `structure`: its springs and masses. [`urdf`], `xacro` (both over `xml`), [`opw`], [`dh`],
//! [`elementary`]: those of others. [`pendant`]: readings. `description`: what all of them give.

pub mod armill;
pub mod dh;
pub mod elementary;
pub mod format;
pub mod opw;
pub mod pendant;
pub mod structure;
pub mod urdf;
#[cfg(feature = "xacro")]
pub mod xacro;

mod description;
mod xml;

/// More joints than this are no serial arm, and what looks at pairs of joints would take long: the longest snake robots
/// have about thirty. The schema of our own robot file says the same.
const MOST_JOINTS: usize = 64;

pub use description::{JointNote, RobotDescription, Source, Symbol};

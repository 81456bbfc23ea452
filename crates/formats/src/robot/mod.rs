//! Which robot does a file describe, and what does its pendant show?
//!
//! | format | module |
//! |---|---|
//! | our own robot file, the only one with compliances; written as well | [`armill`] |
//! | URDF, and xacro, which becomes URDF | [`urdf`], `xacro` |
//! | OPW parameters | [`opw`] |
//! | Denavit-Hartenberg table | [`dh`] |
//! | calibration file of Universal Robots | [`ur`] |
//! | chain of elementary motions | [`chain`] |
//!
//! Each gives a [`RobotDescription`]: the robot of the core, with the source of its numbers and what was assumed. Each
//! has a `read`, or a `read_to_tip` where there are links to choose from, and tests with broken input.
//! [`format`](mod@format) detects which of them a file is, and reads it.
//!
//! [`spring_tables`] and [`shape_tables`]: tables of springs, masses and shapes, which studies have as well. `body_inertia`: what no
//! inertia of a body is.
//! [`pendant`]: what a pendant shows. [`export`]: robots out, in formats of other programs.
//! `description`: what all of them give.

pub mod armill;
pub mod chain;
pub mod dh;
pub mod export;
pub mod format;
pub mod opw;
pub mod pendant;
pub mod shape_tables;
pub mod spring_tables;
pub mod ur;
pub mod urdf;
#[cfg(feature = "xacro")]
pub mod xacro;

mod body_inertia;
mod description;

/// More joints are not accepted, since checks of pairs of joints would take long: the longest snake robots
/// have about thirty. The schema of our own robot file has the same limit.
const MOST_JOINTS: usize = 64;

/// An angle in rad beyond two turns is one in degrees under the wrong name.
const TWO_TURNS: f64 = 4.0 * std::f64::consts::PI;

pub use description::{BodyNote, JointNote, OtherLimits, RobotDescription, Symbol};

//! What was measured? Records of force over time in, tables of load tests, points of round profiles, circular tests.
//!
//! - [`format`](mod@format): a force record in either format, whichever the file is.
//! - [`dynoware`]: text exports of Kistler's DynoWare.
//! - [`csv`]: any other table with a column for each channel.
//! - [`load_tests`]: loads on a standing robot, and how far it gave way.
//! - [`profile`]: points of a profile that was to be round.
//! - [`ballbar`]: radii along a circle, and what a ball-bar's own program made of them.
//! - [`poses`]: joint positions and where a laser tracker saw the arm.
//! - [`trace`]: where the tip went along a path, run after run.
//!
//! Force records are [`Record`](armill_core::load::Record)s in the axes of the sensor. Whether the force acts on the
//! tool or on the part, and how the sensor stands, no file tells: the caller says it.
//!
//! `columns`: what a column holds, in which unit; samples as they come.

pub mod ballbar;
mod columns;
pub mod csv;
pub mod dynoware;
pub mod format;
pub mod load_tests;
pub mod poses;
pub mod profile;
pub mod trace;

//! Tool paths: readers of tool path programs.
//!
//! - [`format`](mod@format): a program in any format: which one it is in, and its steps.
//! - [`apt`]: cutter locations of CAM systems: APT-CL, CLDATA, CLSF.
//! - [`gcode`]: programs of machine tools: RS-274, as LinuxCNC reads it.
//! - [`csv`]: a table of points, for those without CAM.
//! - [`notes`]: ignored words and assumptions.
//!
//! Each reader gives [`Step`](armill_core::path::Step)s one by one, as long as the program is, and a [`Summary`].
//!
//! `length_unit`: millimetres or inches; `direction`: tool axes of length 1; `summary`: common results of all readers
//! at the end.

pub mod apt;
pub mod csv;
pub mod format;
pub mod gcode;
pub mod notes;

mod direction;
mod length_unit;
mod summary;

pub use length_unit::LengthUnit;
pub use summary::Summary;

//! Which way does the tool go? Tool path programs in.
//!
//! - [`program`]: a program in any of these formats.
//! - [`format`](mod@format): which format is a file in?
//! - [`apt`]: cutter locations of CAM systems: APT-CL, CLDATA, CLSF.
//! - [`gcode`]: programs of machine tools: RS-274, as LinuxCNC reads it.
//! - [`csv`]: a table of points, for those without CAM.
//!
//! Each reader gives [`Step`](armill_core::path::Step)s one by one, as long as the program is.
//!
//! `length_unit`: millimetres or inches.

pub mod apt;
pub mod csv;
pub mod format;
pub mod gcode;
pub mod program;

mod length_unit;

pub use length_unit::LengthUnit;

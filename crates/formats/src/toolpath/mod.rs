//! Tool path programs in: what tells a tool where to go becomes the steps of the core.
//!
//! Each format has the same parts: what it is, `read`, tests incl. broken input.

pub mod gcode;

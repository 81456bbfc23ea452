//! Where was the arm when it stood still? Joint positions and measured places, as laser trackers write them.
//!
//! - `columns`: what a column is, in which unit; names of a public data set; names that the caller maps.
//! - [`table`]: rows to poses.
//!
//! All lengths come out in m, all angles in rad, in the axes of the tracker.

mod columns;
pub mod table;

pub use self::columns::{Mapping, NoMapping};
pub use self::table::{MeasuredPoses, PoseReadOptions, TurnOrder, read};

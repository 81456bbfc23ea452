//! Measured poses of an arm at rest: joint positions and measured positions, as laser trackers write them.
//!
//! - `columns`: quantity and unit of each column; names of a public data set; mapped names.
//! - [`table`]: rows as poses.
//!
//! All lengths are in m, all angles in rad, in the axes of the tracker.

pub(super) mod columns;
pub mod table;

pub use self::columns::{Mapping, NoMapping};
pub use self::table::{MeasuredPoses, PoseReadOptions, TurnOrder, read};

//! Motion: what a controller makes of a path: speed along it, time, and where the joints are.
//!
//! Read in this order: [`along`](mod@along) (a whole path), and its stages: [`rounded`] (corners within zones), [`joint_path`] (joint positions along a path, and their
//! derivatives), [`limits`], [`speed`] (the fastest speed within the limits), [`jerk`] (the same with limited jerk), [`lag`] (joints that follow late), [`contour`] (the
//! distance of the path that is followed from the one that is commanded), which `late_path` joins; [`displacement`]: of the tool by the motion, [`detail`] the paths next to the point where it is largest.
//! [`followed`](mod@followed): the same at even times, as in a log.
//!
//! Lengths in m, angles in rad, times in s.

pub mod along;
pub mod contour;
pub mod detail;
pub mod displacement;
pub mod followed;
pub mod jerk;
pub mod joint_path;
pub mod lag;
mod late_path;
pub mod limits;
pub mod rounded;
pub mod speed;

pub use along::{Motion, MotionModel, motion_along};
pub use detail::MotionDetail;
pub use followed::{Followed, followed};
pub use joint_path::JointPath;
pub use lag::Lag;
pub use limits::{JointLimits, Limiting, MotionLimits};
pub use rounded::{Programmed, Rounded};
pub use speed::{SpeedProfile, fastest};

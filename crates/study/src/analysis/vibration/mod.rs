//! The vibration at the points of an analysis: does the cut chatter there, and how far does the tool vibrate under its teeth?
//!
//! [`arm_modes`]: modes of the arm in a posture; [`points`]: lowest mode, stable depth and forced vibration at every point;
//! [`worst`]: the point whose cut is nearest to chatter, with its uncertainty; [`columns`] of tables; [`mod@answer`]: the summary, its
//! sentence and its warning; [`report`] its section; [`remedies`]: speeds and depths that make a cut stable; [`wall`]: error
//! of the wall with its uncertainty, for the budget of a circle.
//!
//! ```text
//! posture -> modes of the arm -+
//! modes of the tool -----------+-> modes at the tip, feed frame -> stable depth, vibration
//! cut, spindle speed, feed ----+
//! ```

pub mod answer;
pub mod arm_modes;
pub mod columns;
pub mod points;
pub mod remedies;
pub mod report;
pub mod wall;
pub mod worst;

pub use answer::VibrationAnswer;
pub use points::{CutAt, Cuts, SeriesVibration};

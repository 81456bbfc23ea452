//! What a calibrated robot leaves of measured poses, learnt: the result of `armill learn`.
//!
//! ```text
//! robot + poses.csv + Question -> Learning -> LearnAnswer, picture, robot file with residuals
//! ```
//!
//! [`learning`] (calibration and residual of all poses, errors of poses held out, other poses), [`answer`](mod@answer) (the result
//! as one JSON value), [`output`] (picture, robot file and its file of residuals).

pub mod answer;
pub mod learning;
pub mod output;

pub use answer::{LearnAnswer, answer};
pub use learning::{Learning, OtherPoses, Question, learn};
pub use output::{drawing, robot_file};

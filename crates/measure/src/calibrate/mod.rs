//! Calibration of a robot from measured poses: the result of `armill calibrate`.
//!
//! ```text
//! robot + poses.csv + Question -> Calibration -> CalibrateAnswer, table of residuals, robot file with small motions
//! ```
//!
//! [`question`] (settings, and reading the poses), [`calibration`](mod@calibration) (fits before and after, validation
//! poses), [`answer`](mod@answer) (the result as one JSON value), [`output`] (table of residuals, drawing, robot file).

pub mod answer;
pub mod calibration;
pub mod output;
pub mod question;

pub use answer::{CalibrateAnswer, ErrorsAnswer, SetAnswer, answer};
pub use calibration::{Calibration, PoseSet, calibrate};
pub use output::{drawing, residuals, robot_file};
pub use question::{Question, ValidationPoses, read};

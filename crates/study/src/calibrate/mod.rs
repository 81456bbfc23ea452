//! Measured poses in, the geometry of this very arm out: what `armill calibrate` answers.
//!
//! ```text
//! robot + poses.csv + Question -> Calibration -> CalibrateAnswer, table of residuals, robot file with small motions
//! ```
//!
//! [`question`] (what is asked, and reading the poses), [`calibration`](mod@calibration) (fits before and after, poses held
//! out), [`answer`](mod@answer) (all of it as one JSON value), [`output`] (table of residuals, drawing, robot file).

pub mod answer;
pub mod calibration;
pub mod output;
pub mod question;

pub use answer::{CalibrateAnswer, ErrorsAnswer, SetAnswer, answer};
pub use calibration::{Calibration, Set, calibrate};
pub use output::{drawing, residuals, robot_file};
pub use question::{HoldOut, Question, read};

//! `armill drives`: torsion of the joints from a log with motor encoders, link encoders and torques.
//!
//! ```text
//! log (CSV, MATLAB) -> signals of each joint -> torsion of each -> DrivesAnswer, picture; prediction of another log
//! ```
//!
//! [`question`] (settings, reading), [`answer`](mod@answer) (the result as one JSON value), [`picture`](mod@picture). The model: [`armill_core::torsion`].

pub mod answer;
pub mod picture;
pub mod question;

pub use answer::{DrivesAnswer, Evaluated, evaluate};
pub use picture::picture;
pub use question::{DriveLog, DrivesQuestion, MatlabNames, read};

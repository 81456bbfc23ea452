//! `armill drives`: friction, load and torsion of the joints from a log with motor encoders, torques and link encoders.
//!
//! ```text
//! log (CSV, MATLAB) -> signals of each joint -> torsion, friction and load of each -> DrivesAnswer, picture; prediction of another log
//! ```
//!
//! [`question`] (settings, reading), `estimate` (a value with its uncertainty), [`motor`] (friction and load), [`answer`](mod@answer) (the result as one JSON value), [`output`] (a robot file), [`picture`](mod@picture).
//! The models: [`armill_core::torsion`], [`armill_core::motor_torque`].

pub mod answer;
mod estimate;
pub mod motor;
pub mod output;
pub mod picture;
pub mod question;

pub use answer::{DrivesAnswer, Evaluated, evaluate};
pub use estimate::EstimateAnswer;
pub use output::robot_file;
pub use picture::picture;
pub use question::{DriveJoint, DriveLog, DrivesQuestion, MatlabNames, read};

//! Identification of springs from load tests: the result of `armill identify`.
//!
//! ```text
//! robot + tests.csv + Question -> Answer -> robot file with the new compliances
//! robot + Question + count     -> PlanAnswer: tests to do, as a table to fill in
//! ```
//!
//! [`question`] (settings of the command), [`answer`](mod@answer) (springs, uncertainties, residuals, as one JSON
//! value), [`robot_file`] (the robot with its new compliances), [`plan`](mod@plan) (tests to do, as a table to fill
//! in).

pub mod answer;
pub mod plan;
pub mod question;
pub mod robot_file;

pub use answer::{Answer, SpringAnswer, answer};
pub use plan::{PlanAnswer, plan};
pub use question::{PointsModel, PriorModel, Question, Units};

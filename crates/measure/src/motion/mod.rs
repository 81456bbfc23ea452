//! What joint logs say of the motion of an arm: the result of `armill motion`.
//!
//! ```text
//! log + robot -> stretches between rests -> tip -> moves and corners -> fit of acceleration, window, lag -> MotionAnswer, robot file
//!                                                                    -> prediction of other logs
//! ```
//!
//! [`question`] (settings, reading), `spikes`, `derivative`, [`stretches`], `line`, [`tool`] (the tip that makes moves straight), [`course`] (moves, corners, the programmed
//! path), [`observed`] (a stretch as it was logged), `simulate` (as it is predicted), `least_squares`, `leads` (motors ahead of the arm), `fit`, [`reached`], [`lag`] (commanded and actual positions),
//! [`learned`], [`answer`](mod@answer) (the result as one JSON value), [`robot_file`](mod@robot_file).

pub mod answer;
pub mod course;
mod derivative;
mod fit;
pub mod lag;
mod leads;
pub mod learned;
mod least_squares;
mod line;
pub mod observed;
pub mod question;
pub mod reached;
pub mod robot_file;
mod simulate;
mod spikes;
pub mod stretches;
pub mod tool;

pub use answer::{MotionAnswer, answer};
pub use learned::{Learned, learn};
pub use question::{NamedLog, Question, read};
pub use robot_file::robot_file;

//! How round does the tool go, and why not rounder? Files of a ball-bar from their text to quantities, parts and pictures.
//!
//! ```text
//! files -> Measured (one circle, its runs) -> analyse -> Found (SI) -> BallbarAnswer, tables, pictures, report
//! ```
//!
//! [`read`](mod@read): files into one circle. [`analyse`](mod@analyse): what it shows. [`answer`](mod@answer): that, in numbers with their units.
//! [`results`]: what the bar's own program made of it. `warnings`: what to know before use.
//! [`teach`](mod@teach): the circle to teach instead, and the test before beside the one after. [`program`]: that circle as
//! a program of the robot. [`output`]: tables, pictures, report.

pub mod analyse;
pub mod answer;
pub mod output;
pub mod program;
pub mod read;
pub mod results;
pub mod teach;
mod warnings;

pub use analyse::{Centring, Cyclic, Found, Question, analyse};
pub use answer::{BallbarAnswer, answer};
pub use program::{CircleWanted, points_within, sagitta, taught_program};
pub use read::{Measured, Wanted, read};
pub use teach::{BeforeAnswer, TaughtAnswer, TaughtCircle, before, teach};

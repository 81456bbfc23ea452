//! Analysis of circular tests: ball-bar files to quantities, contributions and pictures.
//!
//! ```text
//! files -> MeasuredTest (one circle, its runs) -> analyse -> BallbarAnalysis (SI) -> BallbarAnswer, tables, pictures, report
//! ```
//!
//! Files become one circle as in a study: [`armill_study::measured::circular_test`]. [`analyse`](mod@analyse): the
//! analysis. [`answer`](mod@answer): its values with units, which `numbers` gives. [`results`]: results of the software
//! of the ball-bar. `warnings`: what to know before use. [`teach`](mod@teach): the corrected circle, and the comparison
//! of two tests. [`program`]: that circle as a robot program. [`output`]: tables, pictures, report.

pub mod analyse;
pub mod answer;
mod numbers;
pub mod output;
pub mod program;
pub mod results;
pub mod teach;
mod warnings;

pub use analyse::{BallbarAnalysis, Centring, Cyclic, Question, analyse};
pub use answer::BallbarAnswer;
pub use numbers::answer;
pub use program::{CirclePlacement, points_within, taught_program};
pub use teach::{BeforeAnswer, TaughtAnswer, TaughtCircle, before, teach};

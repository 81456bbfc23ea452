//! How much play has each joint? From circular tests on circles of a study; which circles to drive; and the test that a
//! robot file would show.
//!
//! ```text
//! study with [[ballbar]] -> follow each circle -> estimate: Estimated (SI) -> BacklashAnswer, tables, pictures
//! ```
//!
//! [`circles`](mod@circles): the circles of a study, and the arm that follows them. [`estimate`](mod@estimate): gaps from what was measured.
//! [`answer`](mod@answer): that, in numbers with their units. [`plan`](mod@plan): circles to drive. [`simulate`](mod@simulate): files of a
//! ball-bar, made up from the robot file, with `noise`. [`output`]: tables and pictures.

pub mod answer;
pub mod circles;
pub mod estimate;
mod noise;
pub mod output;
pub mod plan;
pub mod simulate;

pub use answer::BacklashAnswer;
pub use estimate::{Estimated, Wanted, estimate};
pub use plan::{PlanAnswer, PlanWanted, plan};
pub use simulate::{Simulated, SimulationWanted, simulate};

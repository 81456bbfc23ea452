//! Backlash of the joints from circular tests on circles of a study; plans of circles; and simulated tests of a
//! robot file.
//!
//! ```text
//! study with [[ballbar]] -> follow each circle -> estimate: BacklashEstimate (SI) -> BacklashAnswer, tables, pictures
//! ```
//!
//! [`circles`](mod@circles): the circles of a study, the joint motion along them, and what they show. [`estimate`](mod@estimate):
//! backlash from the measurements. [`answer`](mod@answer): its values with units. [`plan`](mod@plan): circles to
//! measure. [`simulate`](mod@simulate): ball-bar files simulated from the robot file, with `noise`. [`output`]: tables
//! and pictures.

pub mod answer;
pub mod circles;
pub mod estimate;
mod noise;
pub mod output;
pub mod plan;
pub mod simulate;

pub use answer::BacklashAnswer;
pub use circles::{BacklashEstimate, FollowedCircle};
pub use estimate::{EstimateOptions, estimate};
pub use plan::{PlanAnswer, PlanOptions, plan};
pub use simulate::{SimulatedFile, SimulationOptions, simulate};

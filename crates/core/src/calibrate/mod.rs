//! Calibration: the geometry of one individual arm, from poses measured by a tracker.
//!
//! In reading order: [`pose`] (a measured pose), [`unknown`] (small displacements to be estimated), `arm` (the chain
//! with all of them, its forward kinematics and Jacobian), `select` (identifiable unknowns), [`prior`] (prior knowledge),
//! [`errors`] (prediction errors), [`fit`](mod@fit) (the most likely geometry, its uncertainty, the calibrated chain).
//!
//! Theory, sources and limits of the method: `docs/theory/calibration.md`.

mod arm;
pub mod errors;
pub mod fit;
pub mod pose;
pub mod prior;
mod select;
pub mod unknown;

pub(crate) use arm::Arm;
pub use errors::{PoseErrors, Spread};
pub use fit::{Calibrated, Estimate, Question, Refusal, fit};
pub use pose::MeasuredPose;
pub use prior::Prior;
pub use select::Redundant;
pub use unknown::{ParameterLocation, ParameterSet, Unknown};
pub(crate) use unknown::{uncertain_motions, unknowns};

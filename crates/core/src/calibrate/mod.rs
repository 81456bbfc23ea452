//! How long and how straight is this very arm? Its geometry, from poses that a tracker measured.
//!
//! In reading order: [`pose`] (what was measured), [`unknown`] (which small displacements are asked for), `arm` (the chain with
//! all of them, its forward and its columns), `triangle` (least squares of any number of rows in little memory), `select` (which unknowns
//! the poses can tell apart), [`prior`] (what is known before), [`errors`] (how far predictions miss), [`fit`](mod@fit) (the most likely geometry, its uncertainty, the
//! calibrated chain).
//!
//! Theory, sources and what the numbers leave out: `docs/theory/calibration.md`.

mod arm;
pub mod errors;
pub mod fit;
pub mod pose;
pub mod prior;
mod select;
mod triangle;
pub mod unknown;

pub use errors::{PoseErrors, Spread};
pub use fit::{Calibrated, Estimate, Question, Refusal, fit};
pub use pose::MeasuredPose;
pub use prior::Prior;
pub use select::Redundant;
pub use unknown::{Asked, Place, Unknown};

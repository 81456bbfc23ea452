//! What pushes on the tool?
//!
//! [`cases`]: a set of given wrenches, the same at every point. [`along`]: wrenches that turn with the feed, or change
//! from point to point. [`doubt`]: how sure they are.
//!
//! What a cut pushes with: [`end_mill_body`] and [`cutter`] (the edge on it), [`engagement`] and [`arc`] (where and how
//! thick it cuts), [`mechanistic`] and [`kienzle`] (force of a chip; [`law`] is either, [`sets`] several of one material),
//! [`milling`] (force at an angle of the spindle
//! and over a revolution), [`mean`] (its mean, and how sure it is), [`drilling`], [`process`] (all of it for a tool on
//! its way), [`force_equilibrium`] (the force on a tool that it pushes off its path).
//!
//! [`record`]: a force as it was measured over time.
//!
//! `quadrature`: sums for integrals along an edge; `error`: what a cutting force cannot be computed from.

pub mod along;
pub mod arc;
pub mod cases;
pub mod cutter;
mod input_uncertainty;
pub mod drilling;
pub mod end_mill_body;
pub mod engagement;
pub mod error;
pub mod kienzle;
pub mod law;
pub mod mean;
pub mod mechanistic;
pub mod milling;
pub mod process;
pub mod record;
pub mod sets;
pub mod force_equilibrium;

mod quadrature;

pub use along::{CutHere, CutsAlong, Greatest, PathLoad};
pub use cases::{LoadCases, LoadFrame};
pub use cutter::{Cutter, Hand, Runout};
pub use input_uncertainty::InputUncertainty;
pub use end_mill_body::EndMillBody;
pub use engagement::{Engagement, Immersion};
pub use error::CuttingError;
pub use kienzle::{Estimate, Kienzle, KienzleValues};
pub use law::CuttingLaw;
pub use mean::MeanForce;
pub use mechanistic::Mechanistic;
pub use milling::{Cut, Milling};
pub use process::{Advance, CuttingForce, Process};
pub use record::{ActsOn, Record, RecordError};
pub use sets::Together;
pub use force_equilibrium::{Rest, ForceEquilibrium, TipCompliance};

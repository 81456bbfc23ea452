//! Loads on the tool.
//!
//! [`cases`]: a set of given wrenches, the same at every point. [`along`]: wrenches that turn with the feed, or change
//! from point to point; `leaning_forces`: cuts whose tool leans; `actual_feed`: cuts at another feed. `input_uncertainty`: their uncertainty.
//!
//! Cutting forces: [`end_mill_body`] and [`cutter`] (the edge on it), [`engagement`] and [`arc`] (where it cuts and the
//! chip thickness), [`lean`], [`cut`], `arcs_of_point`, `pass_before`, `engaged_arcs` and
//! `edge_part` (the same of a leaning tool), [`mechanistic`] and [`kienzle`] (force of a chip; [`law`] is either, [`sets`] several of one
//! material), `teeth_at` (teeth with runout),
//! [`milling`] (force at a spindle angle and over a revolution), [`mean`] (its mean, with uncertainty),
//! `directional` (its derivative by a displacement of the tool), `peak` (its greatest over a revolution), `spindle` (torque, chip thickness, removal rate),
//! [`drilling`], [`process`] (a tool with its cutting data and feed), [`force_equilibrium`] (the force on a tool that
//! the cut deflects).
//!
//! [`record`]: a force measured over time.
//!
//! `quadrature`: integrals along an edge; `error`: errors of cutting force inputs.

mod actual_feed;
pub mod along;
pub mod arc;
mod arcs_of_point;
pub mod cases;
pub mod cut;
pub mod cutter;
mod directional;
pub mod drilling;
mod edge_part;
pub mod end_mill_body;
mod engaged_arcs;
pub mod engagement;
pub mod error;
pub mod force_equilibrium;
mod input_uncertainty;
pub mod kienzle;
pub mod law;
pub mod lean;
mod leaning_forces;
pub mod mean;
pub mod mechanistic;
pub mod milling;
mod pass_before;
mod peak;
pub mod process;
pub mod record;
pub mod sets;
mod spindle;
mod teeth_at;

mod quadrature;

pub use along::{CutHere, CutsAlong, GreatestForce, PathLoad};
pub use cases::{LoadCases, LoadFrame};
pub use cut::Cut;
pub use cutter::{Cutter, Hand, Runout};
pub use end_mill_body::EndMillBody;
pub use engagement::{Engagement, Immersion};
pub use error::CuttingError;
pub use force_equilibrium::{ForceEquilibrium, Rest, TipCompliance};
pub use input_uncertainty::InputUncertainty;
pub use kienzle::{Estimate, Kienzle, KienzleValues};
pub use law::CuttingLaw;
pub use lean::{Lean, LeanInCut};
pub use leaning_forces::LeaningForces;
pub use mean::MeanForce;
pub use mechanistic::Mechanistic;
pub use milling::Milling;
pub use process::{Advance, CuttingForce, Process};
pub use record::{ActsOn, Record, RecordError};
pub use sets::SetStatistics;

//! What moves the tool away from where it was asked to be?
//!
//! Every source is a module of the same shape: parameters, deviation, sensitivity, tests. `predict.rs` adds
//! them in a visible row.
//!
//! [`elastic`]: drives and springs give way to the load. [`stiffness_model`]: which parts of the model are on.
//! [`gravity`]: the weight of the arm itself. [`equilibrium`]: the load acts on the arm as it has yielded. [`standing`]:
//! all of these for one arm in one posture.
//!
//! `linear_system`: small systems of equations, in room that is reused.

pub mod elastic;
pub mod equilibrium;
pub mod gravity;
mod linear_system;
pub mod standing;
pub mod stiffness_model;

pub use equilibrium::Unstable;
pub use standing::Standing;
pub use stiffness_model::{Arm, Gravity, StiffnessModel};

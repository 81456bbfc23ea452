//! What moves the tool away from where it was asked to be?
//!
//! [`elastic`]: joints give way to the load, the simple model by itself. [`stiffness_model`]: which parts beyond it are on.
//! [`gravity`]: what masses do to drives and springs. [`equilibrium`]: where an arm comes to rest that the load changes.
//! [`backlash`]: where links lie in the gaps of their joints. [`geometric`]: an arm that is not the one that its controller
//! reckons with. [`repeatability`]: how it scatters from time to time.
//! [`standing`]: one arm in one posture, and what each of these moves there; `predict.rs` adds them in a visible row.
//!
//! `deviation`: what they give together. `linear_system`: small systems of equations, in room that is reused.

pub mod backlash;
mod deviation;
pub mod elastic;
pub mod equilibrium;
pub mod geometric;
pub mod gravity;
mod linear_system;
pub mod repeatability;
pub mod arm_state;
pub mod stiffness_model;

pub use deviation::Deviation;
pub use equilibrium::Unstable;
pub use arm_state::{Links, ArmState};
pub use stiffness_model::{Arm, Gravity, StiffnessModel};

//! Sources of the deviation of the tool.
//!
//! [`elastic`]: joint deflection under the load, the simple model. [`stiffness_model`]: the optional parts beyond it.
//! [`gravity`]: torques of the masses on drives and springs. [`equilibrium`]: equilibrium of an arm that the load
//! changes.
//! [`backlash`]: positions of the links within their backlash. [`geometric`]: the arm differs from the model in its
//! controller. [`thermal`]: growth of the links since the calibration. [`repeatability`]: scatter of repeated poses.
//! [`arm_state`]: one arm in one posture, and the effect of each source there; `predict.rs` adds them.
//!
//! `motion_displacement`: rounded corners and joints that follow late along a path, computed by [`crate::motion`]. `deviation`: the sum of all sources; `contributor`: what it is shared out to; `uncertain_input`: an arm with one input
//! changed by its standard uncertainty; `known_uncertainty`: which inputs have one. `linear_system`: small systems of equations in reused memory.

pub mod arm_state;
pub mod backlash;
mod contributor;
mod deviation;
pub mod elastic;
pub mod equilibrium;
pub mod geometric;
pub mod gravity;
mod known_uncertainty;
mod linear_system;
mod motion_displacement;
pub mod repeatability;
pub mod stiffness_model;
pub mod thermal;
mod uncertain_input;

pub use arm_state::{ArmState, Links};
pub use contributor::Contributor;
pub use deviation::Deviation;
pub use equilibrium::Unstable;
pub use known_uncertainty::InputWithoutUncertainty;
pub use motion_displacement::MotionDisplacement;
pub use stiffness_model::{Arm, Gravity, StiffnessModel, standard_uncertainties};
pub use thermal::ThermalGrowth;
pub(crate) use uncertain_input::compliance_changes;
pub use uncertain_input::{ChangedArm, UncertainInput};

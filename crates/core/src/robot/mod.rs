//! The robot: kinematics, structure and postures.
//!
//! In reading order: [`chain`] (elementary motions and their inner form), [`joint`] (limits, signs, zeros, compliance),
//! [`structure_error`] (why a structure is not valid), [`spring`], [`compensator`] (and masses), [`motor`], [`damping`], [`torque_curve`], [`backlash`], [`uncertain_geometry`],
//! [`learnt`] (what the model leaves of measured positions; `learnt_of_robot`: of a robot),
//! [`structure`] (the parts other than drives), [`ground`] (the link that does not move), [`model`] (the robot as one
//! value), [`positioner`] (an arm and the positioner of the part as one chain), [`hand`] (an arm that holds the part), [`forward`] (joint positions to frames), [`jacobian`] (screws at the tool), `forward_of_eight` (both for eight postures at once, along the chain by
//! `frame_in_lanes`), [`deflected_arm`] (frames and screws of the deflected arm), [`branch`] and [`posture`] (the
//! postures of a pose), [`unreachable`](mod@unreachable) (why there may be none), [`inverse`] (tool pose to every
//! posture), [`mod@reach`] (reach of the wrist centre), [`convention`] (which sign or zero disagrees with the pendant).

pub mod backlash;
pub mod branch;
pub mod chain;
pub mod compensator;
pub mod convention;
pub mod damping;
pub mod deflected_arm;
pub mod forward;
mod forward_of_eight;
mod frame_in_lanes;
pub mod ground;
pub mod hand;
pub mod inverse;
pub mod jacobian;
pub mod joint;
pub mod learnt;
pub(crate) mod learnt_of_robot;
pub mod model;
pub mod motor;
pub mod positioner;
pub mod posture;
pub mod reach;
pub mod spring;
pub mod structure;
pub mod structure_error;
pub mod torque_curve;
pub mod uncertain_geometry;
pub mod unreachable;

pub use backlash::{Backlash, BacklashSide, STANDSTILL};
pub use branch::{Branch, BranchPattern, Elbow, Shoulder, Wrist};
pub use chain::{Amount, Axis, Chain, Motion};
pub use compensator::{Compensator, Mass};
pub use damping::Damping;
pub use ground::{Ground, HeldByArm, MovedBy};
pub use joint::{Joint, JointCompliance, Limits};
pub use learnt::{Learnt, LearntAxes, LearntError, LearntResidual, LearntSettings, ResidualAt};
pub use model::{Robot, RobotError};
pub use motor::Motor;
pub use posture::{Posture, PostureName, Sides, Singularity};
pub use reach::reach;
pub use spring::{Attachment, Spring};
pub use structure::Structure;
pub use structure_error::StructureError;
pub use torque_curve::{JointCurve, TorqueCurve};
pub use uncertain_geometry::{SmallMotion, UncertainGeometry, UncertainGeometryError};
pub use unreachable::{Overrun, Unreachable};

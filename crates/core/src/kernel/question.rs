//! What is asked at every point.

use nalgebra::{Unit, Vector3};

use crate::frame::Isometry;
use crate::load::Doubt;
use crate::robot::joint::JointCompliance;
use crate::robot::{BranchPattern, Robot};
use crate::source::{Arm, StiffnessModel};
use crate::spatial::Wrench;

/// Which posture stands for a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BranchChoice {
    /// Of the branches that match, the one with the most room to its joint limits, inside them or not. Of an arm whose
    /// branches have no names the posture that continues the one of the point before (of a map, in the same block of
    /// points), or the one nearest to home.
    Of(BranchPattern),
    /// Of all postures inside the joint limits, the one with the least envelope of in-plane deviation.
    Best,
}

/// One question for many tool poses.
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    /// The robot.
    pub robot: &'a Robot,
    /// Compliance of each of its joints.
    pub compliance: &'a [JointCompliance],
    /// What else yields and weighs; [`StiffnessModel::DRIVES`] for nothing. Lanes answer for drives alone.
    pub model: &'a StiffnessModel,
    /// Flange to tool centre point.
    pub flange_from_tool: &'a Isometry,
    /// Joint positions where a rail or a joint to spare stands, and that further joints to spare are drawn to; without,
    /// the middle of their ranges.
    pub home: Option<&'a [f64]>,
    /// Load cases on the tool at the TCP, base basis; at least one.
    pub cases: &'a [Wrench],
    /// How sure load and tool are; lanes answer where there is no doubt.
    pub doubt: Doubt,
    /// Outward normal of the plane that deviations are split on, base basis.
    pub normal: Unit<Vector3<f64>>,
    /// Which posture stands for a point.
    pub choice: BranchChoice,
}

impl<'a> Question<'a> {
    /// The arm that is asked, with all that yields and weighs in it.
    pub fn held_by(&self) -> Arm<'a> {
        Arm {
            robot: self.robot,
            compliance: self.compliance,
            model: self.model,
            flange_from_tool: self.flange_from_tool,
        }
    }
}

//! What is asked at every point.

use nalgebra::{Unit, Vector3};

use crate::load::InputUncertainty;
use crate::robot::BranchPattern;
use crate::source::Arm;
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
    /// The arm and its tool, with all that yields and weighs. Lanes answer for drives alone.
    pub arm: Arm<'a>,
    /// Joint positions where a rail or a joint to spare stands, and that further joints to spare are drawn to; without,
    /// the middle of their ranges.
    pub home: Option<&'a [f64]>,
    /// Load cases on the tool at the TCP, base basis; at least one.
    pub cases: &'a [Wrench],
    /// How sure load and tool are; lanes answer where there is no doubt.
    pub uncertainty: InputUncertainty,
    /// Outward normal of the plane that deviations are split on, base basis.
    pub normal: Unit<Vector3<f64>>,
    /// Which posture stands for a point.
    pub choice: BranchChoice,
}

impl<'a> Question<'a> {
    /// A question about this arm without load: for work that brings its own loads, normals and branches.
    pub fn unloaded(arm: Arm<'a>, home: Option<&'a [f64]>) -> Question<'a> {
        Question {
            arm,
            home,
            cases: &[],
            uncertainty: InputUncertainty::NONE,
            normal: Vector3::z_axis(),
            choice: BranchChoice::Best,
        }
    }
}

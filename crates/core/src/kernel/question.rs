//! Input that is common to all points.

use nalgebra::{Unit, Vector3};

use crate::clearance::{ClearanceCheck, DemandedClearance, PlacedCell};
use crate::frame::Isometry;
use crate::load::InputUncertainty;
use crate::robot::BranchPattern;
use crate::source::Arm;
use crate::spatial::Wrench;

/// Which posture is used at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BranchChoice {
    /// Of the branches that match, the one with the largest margin to its joint limits, inside them or not. Of an arm
    /// without branch names, the posture that continues the one of the point before (of a map, in the same block of
    /// points), or the one nearest to home.
    Of(BranchPattern),
    /// Of all postures inside the joint limits, the one with the smallest envelope of in-plane deviation.
    Best,
}

/// One question for many tool poses.
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    /// The arm and its tool, with all compliances and masses. Lanes support drives only.
    pub arm: Arm<'a>,
    /// Joint positions of a rail or a redundant joint, and start values of further redundant joints; if not given, the
    /// middle of their ranges.
    pub home: Option<&'a [f64]>,
    /// [`Question::home`] at each point along a path, one value a joint, point after point; used by [`super::evaluate_in_order`]
    /// and [`super::evaluate_loaded`] alone.
    pub homes: Option<&'a [f64]>,
    /// Load cases on the tool at the TCP, base axes; at least one.
    pub cases: &'a [Wrench],
    /// Uncertainty of load and tool; lanes are used where it is zero.
    pub uncertainty: InputUncertainty,
    /// Outward normal of the plane that deviations are split on, base basis.
    pub normal: Unit<Vector3<f64>>,
    /// Which posture is used at a point.
    pub choice: BranchChoice,
    /// The clearance that postures must keep; those that do not keep it are not used.
    pub clearance: Option<DemandedClearance<'a>>,
}

impl<'a> Question<'a> {
    /// The home at point `index` of a path.
    pub(super) fn home_at(&self, index: usize) -> Option<&'a [f64]> {
        let count = self.arm.robot.joints().len();
        let of_point = self.homes.map(|homes| &homes[index * count..][..count]);
        of_point.or(self.home)
    }

    /// The demanded clearance with the frame of the part here in base.
    pub fn clearance_with_part_at<'p>(
        &'p self,
        base_from_part: &'p Isometry,
    ) -> Option<DemandedClearance<'p>> {
        let demanded = self.clearance?;
        Some(DemandedClearance {
            placed: PlacedCell {
                base_from_part,
                ..demanded.placed
            },
            ..demanded
        })
    }

    /// A check of the demanded clearance, if there is one.
    pub(crate) fn clearance_check(&self) -> Option<ClearanceCheck<'a>> {
        let demanded = self.clearance?;
        Some(ClearanceCheck::new(
            demanded,
            self.arm.robot,
            self.arm.flange_from_tool,
        ))
    }

    /// A question about this arm without load: for functions that set loads, normals and branches themselves.
    pub fn unloaded(arm: Arm<'a>, home: Option<&'a [f64]>) -> Question<'a> {
        Question {
            arm,
            home,
            homes: None,
            cases: &[],
            uncertainty: InputUncertainty::NONE,
            normal: Vector3::z_axis(),
            choice: BranchChoice::Best,
            clearance: None,
        }
    }
}

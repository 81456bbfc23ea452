//! What comes out at every point.

use nalgebra::Vector3;

use super::question::Question;
use crate::robot::{PostureName, Singularity, Unreachable};

/// How far (rad) outside a limit still counts as at it: rounding of a joint that stands at its limit.
pub const AT_LIMIT: f64 = 1e-9;

/// Deviations that differ by less than this, relative, differ by rounding alone.
const SAME: f64 = 1e-10;

/// A point where the arm holds the tool. Lengths m, angles rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// In this posture.
    pub name: PostureName,
    /// Least distance of a joint to its limit, negative outside; infinite where no joint has limits.
    pub limit_margin: f64,
    /// Which joint that is.
    pub limit_joint: usize,
    /// Near which singularity, if any.
    pub singularity: Option<Singularity>,
    /// Load case with the largest in-plane deviation.
    pub deciding_case: usize,
    /// Largest in-plane deviation of all cases.
    pub in_plane: f64,
    /// Its standard uncertainty from the compliances.
    pub in_plane_uncertainty: f64,
    /// Deviation along the outward normal, of the case where it is largest in size.
    pub normal: f64,
    /// Largest length of the deviation of all cases.
    pub full: f64,
}

impl Held {
    /// Whether every joint stands inside its limits.
    pub fn within_limits(&self) -> bool {
        self.limit_margin >= -AT_LIMIT
    }
}

/// Answers at many points, by point index; arrays of several values a point are flat.
#[derive(Clone, Debug)]
pub struct Answers {
    /// How the arm holds the tool, or why it cannot.
    pub points: Vec<Result<Held, Unreachable>>,
    /// Joint positions, `joint_count` a point, rad; zeros where unreachable.
    pub joints: Vec<f64>,
    /// Deviation (m, base) under each load case, `case_count` a point; zeros where unreachable.
    pub deviations: Vec<Vector3<f64>>,
    /// Share of each joint, then of base, flange and tool where springs sit, in `in_plane` (m), `share_count` a point:
    /// its part along the in-plane deviation of the deciding case. The shares of a point add up to its `in_plane`; under a
    /// load-dependent model in first order.
    pub shares: Vec<f64>,
    /// Joints of the robot.
    pub joint_count: usize,
    /// Load cases.
    pub case_count: usize,
    /// Whom shares are told for: [`crate::source::StiffnessModel::sharers`].
    pub share_count: usize,
}

impl Answers {
    pub(super) fn empty(question: &Question<'_>, count: usize) -> Answers {
        let (joint_count, case_count) = (question.arm.robot.joints().len(), question.cases.len());
        let share_count = question.arm.model.sharers(joint_count).len();
        Answers {
            points: vec![Err(Unreachable::TooFar { by: 0.0 }); count],
            joints: vec![0.0; count * joint_count],
            deviations: vec![Vector3::zeros(); count * case_count],
            shares: vec![0.0; count * share_count],
            joint_count,
            case_count,
            share_count,
        }
    }

    /// Memory that the answers at one point take, bytes.
    pub fn bytes_per_point(joint_count: usize, share_count: usize, case_count: usize) -> usize {
        size_of::<Result<Held, Unreachable>>() + 8 * (joint_count + share_count) + 24 * case_count
    }

    /// Joint positions at point `index`, rad.
    pub fn joints_at(&self, index: usize) -> &[f64] {
        &self.joints[index * self.joint_count..][..self.joint_count]
    }

    /// Deviations at point `index`, one a load case, m, base.
    pub fn deviations_at(&self, index: usize) -> &[Vector3<f64>] {
        &self.deviations[index * self.case_count..][..self.case_count]
    }

    /// Share of each sharer in the in-plane deviation at point `index`, m.
    pub fn shares_at(&self, index: usize) -> &[f64] {
        &self.shares[index * self.share_count..][..self.share_count]
    }

    /// The point with the largest in-plane deviation, if any point is reached. Of points that differ by rounding alone (a
    /// plane and its mirror image) it is the first, on every machine.
    pub fn worst(&self) -> Option<(usize, &Held)> {
        let most = self
            .held()
            .map(|(_, held)| held.in_plane)
            .max_by(f64::total_cmp)?;
        self.held().find(|(_, held)| held.in_plane >= most * (1.0 - SAME))
    }

    /// The point with the least in-plane deviation, if any point is reached; of equal ones the first, likewise.
    pub fn best(&self) -> Option<(usize, &Held)> {
        let least = self
            .held()
            .map(|(_, held)| held.in_plane)
            .min_by(f64::total_cmp)?;
        self.held()
            .find(|(_, held)| held.in_plane <= least * (1.0 + SAME))
    }

    /// The points where the arm holds the tool, with their index.
    pub fn held(&self) -> impl Iterator<Item = (usize, &Held)> {
        self.points
            .iter()
            .enumerate()
            .filter_map(|(i, point)| Some((i, point.as_ref().ok()?)))
    }
}

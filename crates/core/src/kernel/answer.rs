//! What comes out at every point.

use nalgebra::{Unit, Vector3};

use super::question::Question;
use crate::robot::{PostureName, Attachment, Singularity, Unreachable};
use crate::workpiece::Split;

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
    /// Its standard uncertainty: from compliances, load and tool as far as they are known, and the arm's repeatability.
    pub in_plane_uncertainty: f64,
    /// Deviation along the outward normal, of the case where it is largest in size.
    pub normal: f64,
    /// Largest length of the deviation of all cases.
    pub full: f64,
}

impl Held {
    /// Takes in the deviations of the load cases (m, base): what they are along and across `normal`, and which decides.
    pub(super) fn take_envelope(&mut self, deviations: &[Vector3<f64>], normal: Unit<Vector3<f64>>) {
        (self.in_plane, self.normal, self.full, self.deciding_case) = (0.0, 0.0, 0.0, 0);
        for (case, deviation) in deviations.iter().enumerate() {
            let split = Split::of(deviation, normal);
            if split.in_plane > self.in_plane {
                (self.in_plane, self.deciding_case) = (split.in_plane, case);
            }
            if split.normal.abs() > self.normal.abs() {
                self.normal = split.normal;
            }
            self.full = self.full.max(split.full);
        }
    }

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
    /// Whom shares are told for: [`crate::source::StiffnessModel::contributors`].
    pub share_count: usize,
}

impl Answers {
    /// Room for the answers of `question` at so many points, each unanswered; without shares where none are told.
    pub(super) fn new(question: &Question<'_>, count: usize, given: Told) -> Answers {
        let (joint_count, case_count) = (question.arm.robot.joints().len(), question.cases.len());
        let share_count = given.contributors(question).len();
        Answers {
            points: vec![UNANSWERED; count],
            joints: vec![0.0; count * joint_count],
            deviations: vec![Vector3::zeros(); count * case_count],
            shares: vec![0.0; count * share_count],
            joint_count,
            case_count,
            share_count,
        }
    }

    /// The answers to one question at stretches of points, one behind the other; at least one.
    pub(crate) fn joined(stretches: Vec<Answers>) -> Answers {
        let mut stretches = stretches.into_iter();
        let mut joined = stretches.next().expect("one stretch at least");
        for more in stretches {
            joined.points.extend(more.points);
            joined.joints.extend(more.joints);
            joined.deviations.extend(more.deviations);
            joined.shares.extend(more.shares);
        }
        joined
    }

    /// Moves the tool at point `index`, where it is held, by as much more under each load case (m, base), seen on a plane
    /// with this normal. Shares are not told of such answers.
    pub(crate) fn move_on(&mut self, index: usize, by: &[Vector3<f64>], normal: Unit<Vector3<f64>>) {
        assert_eq!(self.share_count, 0, "shares would no longer add up");
        let deviations = &mut self.deviations[index * self.case_count..][..self.case_count];
        if let Ok(evaluation) = &mut self.points[index] {
            for (deviation, by) in deviations.iter_mut().zip(by) {
                *deviation += by;
            }
            evaluation.take_envelope(deviations, normal);
        }
    }

    /// Where the answers go, in blocks of so many points.
    pub(super) fn blocks(&mut self, size: usize) -> Vec<Slots<'_>> {
        let mut rest = Slots {
            points: &mut self.points,
            joints: &mut self.joints,
            deviations: &mut self.deviations,
            shares: &mut self.shares,
        };
        let mut blocks = Vec::with_capacity(rest.points.len().div_ceil(size));
        while !rest.points.is_empty() {
            let (block, after) = rest.split(size);
            blocks.push(block);
            rest = after;
        }
        blocks
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

    /// Share of each contributor in the in-plane deviation at point `index`, m.
    pub fn shares_at(&self, index: usize) -> &[f64] {
        &self.shares[index * self.share_count..][..self.share_count]
    }

    /// The point with the largest in-plane deviation, if any point is reached. Of points that differ by rounding alone (a
    /// plane and its mirror image) it is the first, on every machine.
    pub fn worst(&self) -> Option<(usize, &Held)> {
        let most = self
            .evaluation()
            .map(|(_, evaluation)| evaluation.in_plane)
            .max_by(f64::total_cmp)?;
        self.evaluation().find(|(_, evaluation)| evaluation.in_plane >= most * (1.0 - SAME))
    }

    /// The point with the least in-plane deviation, if any point is reached; of equal ones the first, likewise.
    pub fn best(&self) -> Option<(usize, &Held)> {
        let least = self
            .evaluation()
            .map(|(_, evaluation)| evaluation.in_plane)
            .min_by(f64::total_cmp)?;
        self.evaluation()
            .find(|(_, evaluation)| evaluation.in_plane <= least * (1.0 + SAME))
    }

    /// The points where the arm holds the tool, with their index.
    pub fn evaluation(&self) -> impl Iterator<Item = (usize, &Held)> {
        self.points
            .iter()
            .enumerate()
            .filter_map(|(i, point)| Some((i, point.as_ref().ok()?)))
    }
}

/// What a point holds until it is answered.
const UNANSWERED: Result<Held, Unreachable> = Err(Unreachable::OtherBranch);

/// What is told of a point beside its posture and its deviations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Told {
    /// Who made the deviation of the deciding case, and how sure it is; of all that moves the tool.
    Shares,
    /// Nothing more, and of what the load does alone.
    DeviationsAlone,
}

impl Told {
    /// Whom shares are told for.
    pub fn contributors(self, question: &Question<'_>) -> Vec<Attachment> {
        match self {
            Told::Shares => question.arm.model.contributors(question.arm.robot.joints().len()),
            Told::DeviationsAlone => Vec::new(),
        }
    }
}

/// Where the answers of a block of points go; as many values a point as [`Answers`] have.
pub(super) struct Slots<'a> {
    pub points: &'a mut [Result<Held, Unreachable>],
    pub joints: &'a mut [f64],
    pub deviations: &'a mut [Vector3<f64>],
    pub shares: &'a mut [f64],
}

impl<'a> Slots<'a> {
    /// The first points, `count` or as many as there are, and the rest.
    fn split(self, count: usize) -> (Slots<'a>, Slots<'a>) {
        let all = self.points.len();
        let count = count.min(all);
        let (points, later_points) = self.points.split_at_mut(count);
        let (joints, later_joints) = self.joints.split_at_mut(self.joints.len() / all * count);
        let (deviations, later_deviations) =
            self.deviations.split_at_mut(self.deviations.len() / all * count);
        let (shares, later_shares) = self.shares.split_at_mut(self.shares.len() / all * count);
        let first = Slots {
            points,
            joints,
            deviations,
            shares,
        };
        let rest = Slots {
            points: later_points,
            joints: later_joints,
            deviations: later_deviations,
            shares: later_shares,
        };
        (first, rest)
    }

    /// Where the answer of one point of the block goes.
    pub fn at(&mut self, index: usize) -> Slot<'_> {
        let all = self.points.len();
        let [joints, cases, shares] =
            [self.joints.len(), self.deviations.len(), self.shares.len()].map(|values| values / all);
        Slot {
            point: &mut self.points[index],
            joints: &mut self.joints[index * joints..][..joints],
            deviations: &mut self.deviations[index * cases..][..cases],
            shares: &mut self.shares[index * shares..][..shares],
        }
    }
}

/// Where the answer of one point goes.
pub(super) struct Slot<'a> {
    pub point: &'a mut Result<Held, Unreachable>,
    pub joints: &'a mut [f64],
    pub deviations: &'a mut [Vector3<f64>],
    pub shares: &'a mut [f64],
}

#[cfg(test)]
mod tests;

//! Results at every point.

use nalgebra::{Unit, Vector3};
use rayon::prelude::*;

use super::question::Question;
use crate::clearance::{CellState, Clearance};
use crate::numbers::Float;
use crate::robot::{PostureName, Singularity, Unreachable};
use crate::source::Contributor;
use crate::workpiece::Split;

/// Tolerance (rad) at a limit: rounding of a joint that is at its limit.
pub const AT_LIMIT: f64 = <f64 as Float>::AT_LIMIT;

/// Envelopes that differ by less (relative) are equal, and the first posture is used. Two flips without names differ by
/// rounding, which would otherwise select a different one at neighbouring points.
pub(super) const ALIKE: f64 = 1e-9;

/// Deviations that differ by less than this (relative) differ by rounding only.
const SAME: f64 = 1e-10;

/// A point that the arm reaches. Lengths m, angles rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evaluation {
    /// The posture.
    pub name: PostureName,
    /// Smallest distance of a joint to its limit, negative outside; infinite where no joint has limits.
    pub limit_margin: f64,
    /// The joint with this distance.
    pub limit_joint: usize,
    /// The singularity that the posture is near to, if any.
    pub singularity: Option<Singularity>,
    /// Load case with the largest in-plane deviation.
    pub worst_case: usize,
    /// Largest in-plane deviation of all cases.
    pub in_plane: f64,
    /// Its standard uncertainty: from compliances, load and tool as far as these are known, and the repeatability of
    /// the arm. `None` where it is not known ([`Arm::has_known_uncertainty`](crate::source::Arm)) or not computed.
    pub in_plane_uncertainty: Option<f64>,
    /// Deviation along the outward normal, of the load case where its magnitude is largest.
    pub normal: f64,
    /// Largest magnitude of the deviation of all load cases.
    pub full: f64,
}

impl Evaluation {
    /// Sets the envelope from the deviations of the load cases (m, base): the parts along and across `normal`, and the
    /// worst case.
    pub(super) fn take_envelope(&mut self, deviations: &[Vector3<f64>], normal: Unit<Vector3<f64>>) {
        (self.in_plane, self.normal, self.full, self.worst_case) = (0.0, 0.0, 0.0, 0);
        for (case, deviation) in deviations.iter().enumerate() {
            let split = Split::of(deviation, normal);
            if split.in_plane > self.in_plane {
                (self.in_plane, self.worst_case) = (split.in_plane, case);
            }
            if split.normal.abs() > self.normal.abs() {
                self.normal = split.normal;
            }
            self.full = self.full.max(split.full);
        }
    }

    /// Whether every joint is inside its limits.
    pub fn within_limits(&self) -> bool {
        self.limit_margin >= -AT_LIMIT
    }
}

/// Answers at many points, by point index; arrays with several values per point are flat.
#[derive(Clone, Debug)]
pub struct Answers {
    /// Evaluation of each point, or why it is unreachable.
    pub points: Vec<Result<Evaluation, Unreachable>>,
    /// Joint positions, `joint_count` per point, rad; zeros where unreachable.
    pub joints: Vec<f64>,
    /// Deviation (m, base) under each load case, `case_count` per point; zeros where unreachable.
    pub deviations: Vec<Vector3<f64>>,
    /// Share of each joint, then of base, flange and tool if they have springs, in `in_plane` (m), `share_count` per
    /// point: its part along the in-plane deviation of the worst case. The shares of a point add up to its `in_plane`;
    /// for a load-dependent model in first order.
    pub shares: Vec<f64>,
    /// The least distance of the bodies of the cell at each point, `None` where it has no posture; empty unless
    /// [`Answers::measure_clearances`] was called.
    pub clearances: Vec<Option<Clearance>>,
    /// Number of joints of the robot.
    pub joint_count: usize,
    /// Number of load cases.
    pub case_count: usize,
    /// Number of contributors: [`crate::source::StiffnessModel::contributors`].
    pub share_count: usize,
}

impl Answers {
    /// Allocates the answers of `question` at this number of points, all unanswered; without shares where these are not
    /// requested.
    pub(super) fn new(question: &Question<'_>, count: usize, detail: AnswerDetail) -> Answers {
        Answers::with_shares(question, count, detail.contributors(question).len())
    }

    /// The same with this number of shares at each point.
    pub(super) fn with_shares(question: &Question<'_>, count: usize, share_count: usize) -> Answers {
        let mut answers = Answers {
            share_count,
            ..Answers::with_capacity(question, count, AnswerDetail::DeviationsAlone)
        };
        answers.grow(count);
        answers
    }

    /// No answers yet, and memory for those of `question` at this number of points.
    pub(super) fn with_capacity(question: &Question<'_>, count: usize, detail: AnswerDetail) -> Answers {
        let (joint_count, case_count) = (question.arm.robot.joints().len(), question.cases.len());
        let share_count = detail.contributors(question).len();
        keep_when_freed(count * Answers::bytes_per_point(joint_count, share_count, case_count));
        Answers {
            points: Vec::with_capacity(count),
            joints: Vec::with_capacity(count * joint_count),
            deviations: Vec::with_capacity(count * case_count),
            shares: Vec::with_capacity(count * share_count),
            clearances: Vec::new(),
            joint_count,
            case_count,
            share_count,
        }
    }

    /// Adds this number of points, unanswered.
    pub(super) fn grow(&mut self, count: usize) {
        fill(&mut self.points, || UNANSWERED, count);
        fill(&mut self.joints, || 0.0, count * self.joint_count);
        fill(&mut self.deviations, Vector3::zeros, count * self.case_count);
        fill(&mut self.shares, || 0.0, count * self.share_count);
    }

    /// Joins the answers to one question at consecutive stretches of points; at least one.
    pub(crate) fn joined(stretches: Vec<Answers>) -> Answers {
        let mut stretches = stretches.into_iter();
        let mut joined = stretches.next().expect("at least one stretch");
        for more in stretches {
            joined.points.extend(more.points);
            joined.joints.extend(more.joints);
            joined.deviations.extend(more.deviations);
            joined.shares.extend(more.shares);
            joined.clearances.extend(more.clearances);
        }
        joined
    }

    /// The largest part of the demanded clearance that is missing at those points that are `usable`, m; `None` where all keep
    /// it.
    pub(crate) fn missing_clearance(&self, usable: impl Fn(usize) -> bool) -> Option<f64> {
        let points = self.points.iter().enumerate();
        let missing = points.filter_map(|(index, point)| match point {
            Err(Unreachable::InCollision { missing, .. }) if usable(index) => Some(*missing),
            _ => None,
        });
        missing.max_by(f64::total_cmp)
    }

    /// Measures the clearance of every point with a posture in the cell of `question`, which has the same arm; nothing if
    /// it demands none.
    pub fn measure_clearances(&mut self, question: &Question<'_>) {
        let Some(demanded) = question.clearance else {
            return;
        };
        let arm = &question.arm;
        let measured = |state: &mut CellState<'_>, index: usize| {
            self.points[index].as_ref().ok()?;
            state.set_joints(self.joints_at(index));
            state.clearance(f64::INFINITY)
        };
        self.clearances = (0..self.points.len())
            .into_par_iter()
            .map_init(
                || CellState::new(demanded.placed, arm.robot, arm.flange_from_tool),
                measured,
            )
            .collect();
    }

    /// Removes shares and uncertainties: they are those of the load alone.
    pub(crate) fn remove_shares(&mut self) {
        self.share_count = 0;
        self.shares.clear();
        for evaluation in self.points.iter_mut().flatten() {
            evaluation.in_plane_uncertainty = None;
        }
    }

    /// Adds a displacement of the tool under each load case (m, base) at point `index`, if it is reachable, split on a
    /// plane with this normal. Only for answers without shares.
    pub(crate) fn add_displacement(&mut self, index: usize, by: &[Vector3<f64>], normal: Unit<Vector3<f64>>) {
        assert_eq!(self.share_count, 0, "shares would no longer add up");
        let deviations = &mut self.deviations[index * self.case_count..][..self.case_count];
        if let Ok(evaluation) = &mut self.points[index] {
            for (deviation, by) in deviations.iter_mut().zip(by) {
                *deviation += by;
            }
            evaluation.take_envelope(deviations, normal);
        }
    }

    /// Output slots of all points, in blocks of this number.
    pub(super) fn blocks(&mut self, size: usize) -> Vec<Slots<'_>> {
        self.blocks_from(0, size)
    }

    /// Output slots of the points from `first` on, in blocks of this number.
    pub(super) fn blocks_from(&mut self, first: usize, size: usize) -> Vec<Slots<'_>> {
        let mut rest = Slots {
            points: &mut self.points[first..],
            joints: &mut self.joints[first * self.joint_count..],
            deviations: &mut self.deviations[first * self.case_count..],
            shares: &mut self.shares[first * self.share_count..],
        };
        let mut blocks = Vec::with_capacity(rest.points.len().div_ceil(size));
        while !rest.points.is_empty() {
            let (block, after) = rest.split(size);
            blocks.push(block);
            rest = after;
        }
        blocks
    }

    /// Memory for the answers at one point, bytes.
    pub fn bytes_per_point(joint_count: usize, share_count: usize, case_count: usize) -> usize {
        size_of::<Result<Evaluation, Unreachable>>() + 8 * (joint_count + share_count) + 24 * case_count
    }

    /// Joint positions at point `index`, rad.
    pub fn joints_at(&self, index: usize) -> &[f64] {
        &self.joints[index * self.joint_count..][..self.joint_count]
    }

    /// Deviations at point `index`, one per load case, m, base.
    pub fn deviations_at(&self, index: usize) -> &[Vector3<f64>] {
        &self.deviations[index * self.case_count..][..self.case_count]
    }

    /// Share of each contributor in the in-plane deviation at point `index`, m.
    pub fn shares_at(&self, index: usize) -> &[f64] {
        &self.shares[index * self.share_count..][..self.share_count]
    }

    /// The point with the largest in-plane deviation, if any point is reachable. Of points that differ by rounding only
    /// (a plane and its mirror image), it is the first one on every machine.
    pub fn worst(&self) -> Option<(usize, &Evaluation)> {
        let most = self
            .evaluations()
            .map(|(_, evaluation)| evaluation.in_plane)
            .max_by(f64::total_cmp)?;
        self.evaluations()
            .find(|(_, evaluation)| evaluation.in_plane >= most * (1.0 - SAME))
    }

    /// The point with the smallest in-plane deviation, if any point is reachable; of equal ones the first.
    pub fn best(&self) -> Option<(usize, &Evaluation)> {
        let least = self
            .evaluations()
            .map(|(_, evaluation)| evaluation.in_plane)
            .min_by(f64::total_cmp)?;
        self.evaluations()
            .find(|(_, evaluation)| evaluation.in_plane <= least * (1.0 + SAME))
    }

    /// The point with the largest deviation along the normal, by size, if any point is reachable; of equal ones the
    /// first.
    pub fn largest_along_normal(&self) -> Option<(usize, &Evaluation)> {
        let most = self
            .evaluations()
            .map(|(_, evaluation)| evaluation.normal.abs())
            .max_by(f64::total_cmp)?;
        self.evaluations()
            .find(|(_, evaluation)| evaluation.normal.abs() >= most * (1.0 - SAME))
    }

    /// The reachable points, with their index.
    pub fn evaluations(&self) -> impl Iterator<Item = (usize, &Evaluation)> {
        self.points
            .iter()
            .enumerate()
            .filter_map(|(i, point)| Some((i, point.as_ref().ok()?)))
    }
}

/// Makes the memory allocator keep this number of bytes, up to a limit, when they are freed: to get them from the system
/// again, page by page, takes several times as long as the answers that are written to them. The C library of Linux
/// gives back what is more than twice the largest block freed so far, which is less than the arrays of [`Answers`]
/// together; here a block of their sum is freed. It is never written, so it takes no memory.
fn keep_when_freed(bytes: usize) {
    /// Larger blocks are always given back.
    const LIMIT: usize = 31 << 20;
    std::hint::black_box(Vec::<u8>::with_capacity(bytes.min(LIMIT)));
}

/// Adds `count` times one value, written by all threads: the system provides memory at the first write to it, which
/// takes longer than the write.
fn fill<T: Send>(values: &mut Vec<T>, value: impl Fn() -> T + Sync, count: usize) {
    /// Values of one thread, at least.
    const TOGETHER: usize = 4096;
    let indices = (0..count).into_par_iter().with_min_len(TOGETHER);
    values.par_extend(indices.map(|_| value()));
}

/// Value of a point before it is answered.
const UNANSWERED: Result<Evaluation, Unreachable> = Err(Unreachable::OtherBranch);

/// What is computed at a point in addition to its posture and deviations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AnswerDetail {
    /// Shares of the contributors in the deviation of the worst case, and its uncertainty; backlash and geometry are
    /// included.
    Shares,
    /// Nothing more, and the effect of the load only.
    DeviationsAlone,
}

impl AnswerDetail {
    /// The contributors that shares are computed for.
    pub fn contributors(self, question: &Question<'_>) -> Vec<Contributor> {
        match self {
            AnswerDetail::Shares => question.arm.model.contributors(question.arm.robot.joints().len()),
            AnswerDetail::DeviationsAlone => Vec::new(),
        }
    }
}

/// Output of a block of points; as many values per point as [`Answers`] has.
pub(super) struct Slots<'a> {
    pub points: &'a mut [Result<Evaluation, Unreachable>],
    pub joints: &'a mut [f64],
    pub deviations: &'a mut [Vector3<f64>],
    pub shares: &'a mut [f64],
}

impl<'a> Slots<'a> {
    /// The first points, `count` or as many as there are, and the remaining ones.
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

    /// Output of one point of the block.
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

/// Output of one point.
pub(super) struct Slot<'a> {
    pub point: &'a mut Result<Evaluation, Unreachable>,
    pub joints: &'a mut [f64],
    pub deviations: &'a mut [Vector3<f64>],
    pub shares: &'a mut [f64],
}

#[cfg(test)]
mod tests;

//! One point after the other: the plain physics of `predict.rs` with scratch that is reused.
//!
//! Lanes hand over to it where they cannot decide: no posture, and why; joints 4 and 6 in line.

use nalgebra::Vector3;

use super::answer::Held;
use super::question::{BranchChoice, Question};
use crate::frame::Isometry;
use crate::robot::forward::{Frames, forward_into};
use crate::robot::inverse::{Solution, holds};
use crate::robot::{Branch, Seat, Unreachable};
use crate::source::Standing;
use crate::source::standing::Loaded;
use crate::workpiece::Split;

/// Room for one point, reused from point to point.
pub(super) struct General<'q> {
    tool_from_flange: Isometry,
    frames: Frames,
    standing: Standing<'q>,
    /// Whom shares are told for.
    sharers: Vec<Seat>,
    joints: [f64; 6],
    deviations: Vec<Vector3<f64>>,
    shares: Vec<f64>,
    /// The same three for the best posture so far.
    kept: (Vec<f64>, Vec<Vector3<f64>>, Vec<f64>),
}

impl<'q> General<'q> {
    pub(super) fn new(question: &Question<'q>) -> General<'q> {
        let (joints, cases) = (question.robot.joints().len(), question.cases.len());
        let sharers = question.model.sharers(joints);
        General {
            tool_from_flange: question.flange_from_tool.inverse(),
            frames: Frames::for_robot(question.robot),
            standing: Standing::new(question.held_by()),
            joints: [0.0; 6],
            deviations: vec![Vector3::zeros(); cases],
            shares: vec![0.0; sharers.len()],
            kept: (
                vec![0.0; joints],
                vec![Vector3::zeros(); cases],
                vec![0.0; sharers.len()],
            ),
            sharers,
        }
    }

    /// The answer at one pose; what [`General::write`] gives afterwards belongs to it.
    pub(super) fn answer(
        &mut self,
        question: &Question<'_>,
        base_from_tool: &Isometry,
        near: Option<&[f64]>,
    ) -> Result<Held, Unreachable> {
        let base_from_flange = base_from_tool * self.tool_from_flange;
        match question.choice {
            BranchChoice::Of(pattern) => {
                let candidates = Branch::ALL.into_iter().filter(|branch| pattern.matches(*branch));
                let roomiest = self.roomiest(question, &base_from_flange, candidates, near)?;
                let held = self.judge(question, &base_from_flange, base_from_tool, &roomiest)?;
                self.keep();
                Ok(held)
            }
            BranchChoice::Best => self.best(question, &base_from_flange, base_from_tool, near),
        }
    }

    /// Copies joint positions, deviations and shares of the last answer.
    pub(super) fn write(&self, joints: &mut [f64], deviations: &mut [Vector3<f64>], shares: &mut [f64]) {
        joints.copy_from_slice(&self.kept.0);
        deviations.copy_from_slice(&self.kept.1);
        shares.copy_from_slice(&self.kept.2);
    }

    fn keep(&mut self) {
        self.kept.0.copy_from_slice(&self.joints);
        self.kept.1.copy_from_slice(&self.deviations);
        self.kept.2.copy_from_slice(&self.shares);
    }

    /// The candidate with the most room to its joint limits.
    fn roomiest(
        &self,
        question: &Question<'_>,
        base_from_flange: &Isometry,
        candidates: impl Iterator<Item = Branch>,
        near: Option<&[f64]>,
    ) -> Result<Solution, Unreachable> {
        let mut roomiest: Option<(f64, Solution)> = None;
        let mut miss = Unreachable::TooFar { by: f64::INFINITY };
        for branch in candidates {
            match question.arm.solve(question.robot, base_from_flange, branch, near) {
                Ok(solution) => {
                    let room = limit_margin(question, &solution.joints).1;
                    if roomiest.as_ref().is_none_or(|(most, _)| room > *most) {
                        roomiest = Some((room, solution));
                    }
                }
                Err(reason) => miss = reason,
            }
        }
        roomiest.map(|(_, solution)| solution).ok_or(miss)
    }

    /// The posture inside limits with the least envelope.
    fn best(
        &mut self,
        question: &Question<'_>,
        base_from_flange: &Isometry,
        base_from_tool: &Isometry,
        near: Option<&[f64]>,
    ) -> Result<Held, Unreachable> {
        let mut best: Option<Held> = None;
        let mut miss: Option<Unreachable> = None;
        // The flip leaves the deviation by drive springs unchanged: of the two the one with more room stands for both.
        let alike = if question.model.is_drives_alone() { 2 } else { 1 };
        for pair in Branch::ALL.chunks(alike) {
            match self.roomiest(question, base_from_flange, pair.iter().copied(), near) {
                Err(reason) => miss = miss.or(Some(reason)),
                Ok(solution) => {
                    let held = self.judge(question, base_from_flange, base_from_tool, &solution)?;
                    if !held.within_limits() {
                        let by = -held.limit_margin;
                        let outside = Unreachable::OutsideLimits {
                            joint: held.limit_joint,
                            by,
                        };
                        miss = match miss {
                            Some(Unreachable::OutsideLimits { by: less, .. }) if less <= by => miss,
                            _ => Some(outside),
                        };
                    } else if best.is_none_or(|b| held.in_plane < b.in_plane) {
                        best = Some(held);
                        self.keep();
                    }
                }
            }
        }
        best.ok_or(miss.unwrap_or(Unreachable::TooFar { by: f64::INFINITY }))
    }

    /// Verifies a solution by forward kinematics and works out its deviations.
    fn judge(
        &mut self,
        question: &Question<'_>,
        base_from_flange: &Isometry,
        base_from_tool: &Isometry,
        solution: &Solution,
    ) -> Result<Held, Unreachable> {
        self.joints = solution.joints;
        forward_into(question.robot, &solution.joints, &mut self.frames);
        holds(&self.frames, base_from_flange)?;
        let tcp = base_from_tool.translation.vector.into();
        self.standing.stand_in(&solution.joints, &self.frames, &tcp);
        let (limit_joint, limit_margin) = limit_margin(question, &solution.joints);
        let mut held = Held {
            branch: solution.branch,
            limit_margin,
            limit_joint,
            singularity: solution.singularity,
            deciding_case: 0,
            in_plane: -1.0,
            in_plane_uncertainty: 0.0,
            normal: 0.0,
            full: 0.0,
        };
        for (case, wrench) in question.cases.iter().enumerate() {
            let unstable = |_| Unreachable::Unstable { case };
            let elastic = self.standing.elastic(wrench).map_err(unstable)?.linear;
            let gravity = self.standing.gravity().map_err(unstable)?;
            let deviation = gravity.map_or(elastic, |gravity| elastic + gravity.linear);
            self.deviations[case] = deviation;
            let split = Split::of(&deviation, question.normal);
            if split.in_plane > held.in_plane {
                (held.in_plane, held.deciding_case) = (split.in_plane, case);
            }
            if split.normal.abs() > held.normal.abs() {
                held.normal = split.normal;
            }
            held.full = held.full.max(split.full);
        }
        held.in_plane_uncertainty = self.share(question, &held, base_from_tool)?;
        Ok(held)
    }

    /// Fills the shares of the deciding case and gives the standard uncertainty of its in-plane part.
    fn share(
        &mut self,
        question: &Question<'_>,
        held: &Held,
        base_from_tool: &Isometry,
    ) -> Result<f64, Unreachable> {
        let case = held.deciding_case;
        let deviation = self.deviations[case];
        let in_plane = deviation - question.normal.into_inner() * deviation.dot(&question.normal);
        let along = in_plane.try_normalize(0.0).unwrap_or_default();
        let unstable = |_| Unreachable::Unstable { case };
        if case + 1 != question.cases.len() {
            // The arm stands under the last load case still.
            self.standing.elastic(&question.cases[case]).map_err(unstable)?;
        }
        self.standing.share_along(&along, &self.sharers, &mut self.shares);
        let mut variance = self.standing.variance_along(&along).max(0.0);
        if !question.doubt.is_none() {
            let loaded = Loaded {
                joints: &self.joints,
                frames: &self.frames,
                tcp: base_from_tool.translation.vector.into(),
                tool_axis: base_from_tool.rotation * Vector3::z(),
                wrench: &question.cases[case],
            };
            let of_doubt = self.standing.variance_of_doubt(&question.doubt, &loaded, &along);
            variance += of_doubt.map_err(unstable)?;
        }
        Ok(variance.sqrt())
    }
}

/// The joint nearest to (or farthest outside) its limits, and its margin; infinite without limits.
fn limit_margin(question: &Question<'_>, joints: &[f64]) -> (usize, f64) {
    question.robot.limit_margin(joints).unwrap_or((0, f64::INFINITY))
}

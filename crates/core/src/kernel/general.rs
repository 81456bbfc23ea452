//! One point after the other: the plain physics of `predict.rs` with scratch that is reused.
//!
//! Any arm goes through it but ortho-parallel ones, whose lanes hand over where they cannot decide: no posture, and
//! why; joints 4 and 6 in line.

use nalgebra::Vector3;

use super::answer::Held;
use super::question::{BranchChoice, Question};
use crate::frame::Isometry;
use crate::robot::forward::{Frames, forward_into};
use crate::robot::inverse::{Finder, Found, Wanted};
use crate::robot::jacobian::screws_into;
use crate::robot::{PostureName, Unreachable};
use crate::source::elastic;
use crate::spatial::Twist;
use crate::workpiece::Split;

/// Room for one point, reused from point to point.
pub(super) struct General<'q> {
    tool_from_flange: Isometry,
    finder: Finder<'q>,
    /// What may stand for the point: postures, the roomier of two flips that are alike.
    candidates: Vec<Found>,
    frames: Frames,
    screws: Vec<Twist>,
    joints: Vec<f64>,
    deviations: Vec<Vector3<f64>>,
    shares: Vec<f64>,
    /// The same three for the best posture so far.
    kept: (Vec<f64>, Vec<Vector3<f64>>, Vec<f64>),
}

impl<'q> General<'q> {
    pub(super) fn new(question: &Question<'q>) -> General<'q> {
        let (joints, cases) = (question.robot.joints().len(), question.cases.len());
        General {
            tool_from_flange: question.flange_from_tool.inverse(),
            finder: Finder::new(question.robot),
            candidates: Vec::new(),
            frames: Frames::for_robot(question.robot),
            screws: vec![Twist::ZERO; joints],
            joints: vec![0.0; joints],
            deviations: vec![Vector3::zeros(); cases],
            shares: vec![0.0; joints],
            kept: (
                vec![0.0; joints],
                vec![Vector3::zeros(); cases],
                vec![0.0; joints],
            ),
        }
    }

    /// Starts anew: what comes does not follow on what was.
    pub(super) fn forget(&mut self) {
        self.finder.forget();
    }

    /// The answer at one pose; what [`General::write`] gives afterwards belongs to it.
    pub(super) fn answer(
        &mut self,
        question: &Question<'_>,
        base_from_tool: &Isometry,
        near: Option<&[f64]>,
    ) -> Result<Held, Unreachable> {
        let wanted = Wanted {
            base_from_flange: base_from_tool * self.tool_from_flange,
            near,
            home: question.home,
        };
        match question.choice {
            BranchChoice::Of(pattern) => {
                let found = self.finder.matching(&wanted, pattern)?;
                self.candidates.clear();
                self.candidates.extend(roomiest(question, found).cloned());
            }
            BranchChoice::Best => {
                let found = self.finder.all(&wanted)?;
                self.candidates.clear();
                if question.robot.inverse().flips_are_alike() {
                    let pairs = found.chunk_by(|a, b| differ_in_flip(a.name, b.name));
                    self.candidates
                        .extend(pairs.filter_map(|pair| roomiest(question, pair)).cloned());
                } else {
                    self.candidates.extend_from_slice(found);
                }
            }
        }
        self.least(question, base_from_tool)
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

    /// Of the candidates the one with the least envelope; inside limits, where the question chooses by it.
    fn least(&mut self, question: &Question<'_>, base_from_tool: &Isometry) -> Result<Held, Unreachable> {
        let mut best: Option<Held> = None;
        let mut miss: Option<Unreachable> = None;
        let candidates = std::mem::take(&mut self.candidates);
        for found in &candidates {
            let held = self.judge(question, base_from_tool, found);
            if question.choice == BranchChoice::Best && !held.within_limits() {
                let (joint, by) = (held.limit_joint, -held.limit_margin);
                if miss.is_none_or(|miss| by < miss.amount()) {
                    miss = Some(Unreachable::OutsideLimits { joint, by });
                }
            } else if best.is_none_or(|b| held.in_plane < b.in_plane) {
                best = Some(held);
                self.keep();
            }
        }
        self.candidates = candidates;
        best.ok_or(miss.unwrap_or(Unreachable::TooFar { by: f64::INFINITY }))
    }

    /// Works out the deviations of a posture.
    fn judge(&mut self, question: &Question<'_>, base_from_tool: &Isometry, found: &Found) -> Held {
        self.joints.copy_from_slice(&found.joints);
        forward_into(question.robot, &found.joints, &mut self.frames);
        screws_into(
            question.robot,
            &self.frames,
            &base_from_tool.translation.vector.into(),
            &mut self.screws,
        );
        let (limit_joint, limit_margin) = limit_margin(question, &found.joints);
        let mut held = Held {
            name: found.name,
            limit_margin,
            limit_joint,
            singularity: found.singularity,
            deciding_case: 0,
            in_plane: -1.0,
            in_plane_uncertainty: 0.0,
            normal: 0.0,
            full: 0.0,
        };
        for (case, wrench) in question.cases.iter().enumerate() {
            let deviation = elastic::displacement(&self.screws, question.compliance, wrench);
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
        held.in_plane_uncertainty = self.share(question, &held);
        held
    }

    /// Fills the joint shares of the deciding case and gives the standard uncertainty of its in-plane part.
    fn share(&mut self, question: &Question<'_>, held: &Held) -> f64 {
        let deviation = self.deviations[held.deciding_case];
        let in_plane = deviation - question.normal.into_inner() * deviation.dot(&question.normal);
        let along = in_plane.try_normalize(0.0).unwrap_or_default();
        let wrench = &question.cases[held.deciding_case];
        let mut variance = 0.0;
        for (share, (screw, joint)) in self
            .shares
            .iter_mut()
            .zip(self.screws.iter().zip(question.compliance))
        {
            let sensitivity = elastic::sensitivity(screw, wrench).linear.dot(&along);
            *share = sensitivity * joint.value;
            variance += (sensitivity * joint.standard_uncertainty).powi(2);
        }
        variance.sqrt()
    }
}

/// The posture with the most room of its turning joints to their limits, the first of equal ones: a rail stands still
/// whatever the posture.
fn roomiest<'f>(question: &Question<'_>, found: &'f [Found]) -> Option<&'f Found> {
    let mut roomiest: Option<(f64, &Found)> = None;
    for one in found {
        let robot = question.robot;
        let room = (0..one.joints.len())
            .filter(|joint| !robot.slides(*joint))
            .filter_map(|joint| Some(robot.joints()[joint].limits?.margin(one.joints[joint])))
            .fold(f64::INFINITY, f64::min);
        if roomiest.is_none_or(|(most, _)| room > most) {
            roomiest = Some((room, one));
        }
    }
    roomiest.map(|(_, one)| one)
}

/// Whether two branches are the flip of each other.
fn differ_in_flip(a: PostureName, b: PostureName) -> bool {
    let without_flip = |name: PostureName| name.branch().map(|branch| (branch.shoulder, branch.elbow));
    without_flip(a) == without_flip(b)
}

/// The joint nearest to (or farthest outside) its limits, and its margin; infinite without limits.
fn limit_margin(question: &Question<'_>, joints: &[f64]) -> (usize, f64) {
    question.robot.limit_margin(joints).unwrap_or((0, f64::INFINITY))
}

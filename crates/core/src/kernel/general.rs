//! One point after the other: the plain physics of `predict.rs` with scratch that is reused.
//!
//! Any arm goes through it but ortho-parallel ones, whose lanes hand over where they cannot decide: no posture, and
//! why; joints 4 and 6 in line.

use nalgebra::Vector3;

use super::answer::{Held, Told};
use super::question::{BranchChoice, Question};
use crate::frame::{Isometry, both_across};
use crate::predict::deviation_of;
use crate::robot::forward::{Frames, forward_into};
use crate::robot::inverse::{Finder, Found, Wanted};
use crate::robot::{Overrun, PostureName, Attachment, Unreachable};
use crate::source::arm_state::LoadedPosture;
use crate::source::{Links, ArmState};

/// Envelopes that differ by less (relative) are equal, and the first posture stands: two flips without names differ by
/// rounding, which would take one here and the other beside it.
const ALIKE: f64 = 1e-9;

/// Room for one point, reused from point to point.
pub(super) struct General<'q> {
    tool_from_flange: Isometry,
    finder: Finder<'q>,
    /// What may stand for the point: postures, the roomier of two flips that are alike.
    candidates: Vec<Found>,
    frames: Frames,
    arm_state: ArmState<'q>,
    /// Whom shares are told for; nobody where they are not asked for.
    contributors: Vec<Attachment>,
    beside: Beside<'q>,
    joints: Vec<f64>,
    deviations: Vec<Vector3<f64>>,
    shares: Vec<f64>,
    /// The same three for the best posture so far.
    kept: (Vec<f64>, Vec<Vector3<f64>>, Vec<f64>),
}

/// What moves the tool beside its load.
enum Beside<'q> {
    /// Nothing, or whoever asks adds it.
    Nothing,
    /// On a path: geometry, and links that friction dragged here in their gaps, rad (m), one a joint.
    Dragged(&'q [f64]),
    /// At a point by itself: geometry, and links that lie where they move the tool farthest; where, one a joint and case.
    Farthest(Vec<f64>),
}

impl<'q> General<'q> {
    pub(super) fn new(question: &Question<'q>, given: Told) -> General<'q> {
        let (joints, cases) = (question.arm.robot.joints().len(), question.cases.len());
        let contributors = given.contributors(question);
        let beside = match given {
            Told::Shares if question.arm.model.moves_unloaded() => {
                Beside::Farthest(vec![0.0; joints * cases])
            }
            _ => Beside::Nothing,
        };
        General {
            tool_from_flange: question.arm.flange_from_tool.inverse(),
            finder: Finder::new(question.arm.robot),
            candidates: Vec::new(),
            frames: Frames::for_robot(question.arm.robot),
            arm_state: ArmState::new(question.arm),
            joints: vec![0.0; joints],
            deviations: vec![Vector3::zeros(); cases],
            shares: vec![0.0; contributors.len()],
            kept: (
                vec![0.0; joints],
                vec![Vector3::zeros(); cases],
                vec![0.0; contributors.len()],
            ),
            contributors,
            beside,
        }
    }

    /// The same on a path, where it is known where links were dragged to in their gaps, rad (m), one a joint.
    pub(super) fn on_path(question: &Question<'q>, given: Told, dragged: &'q [f64]) -> General<'q> {
        General {
            beside: Beside::Dragged(dragged),
            ..General::new(question, given)
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
        let requested = Wanted {
            base_from_flange: base_from_tool * self.tool_from_flange,
            near,
            home: question.home,
        };
        match question.choice {
            BranchChoice::Of(pattern) => {
                let found = self.finder.matching(&requested, pattern)?;
                self.candidates.clear();
                self.candidates.extend(roomiest(question, found).cloned());
            }
            BranchChoice::Best => {
                let found = self.finder.all(&requested)?;
                self.candidates.clear();
                let by_load_alone = matches!(self.beside, Beside::Nothing);
                let alike =
                    question.arm.model.is_drives_alone() && question.arm.robot.inverse().flips_are_alike();
                if by_load_alone && alike {
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
            let judged = self.judge(question, base_from_tool, found);
            let outside = |evaluation: &Held| question.choice == BranchChoice::Best && !evaluation.within_limits();
            let missed = match judged {
                Err(reason) => Some(reason),
                Ok(evaluation) if outside(&evaluation) => Some(outside_limits(question, &evaluation)),
                Ok(evaluation) => {
                    if best.is_none_or(|b| evaluation.in_plane < b.in_plane * (1.0 - ALIKE)) {
                        best = Some(evaluation);
                        self.keep();
                    }
                    None
                }
            };
            let nearer = |missed: &Unreachable| miss.is_none_or(|miss| missed.is_nearer_than(&miss));
            miss = missed.filter(nearer).or(miss);
        }
        self.candidates = candidates;
        best.ok_or(miss.unwrap_or(Unreachable::OtherBranch))
    }

    /// Works out the deviations of a posture.
    fn judge(
        &mut self,
        question: &Question<'_>,
        base_from_tool: &Isometry,
        found: &Found,
    ) -> Result<Held, Unreachable> {
        self.joints.copy_from_slice(&found.joints);
        forward_into(question.arm.robot, &found.joints, &mut self.frames);
        let tcp = base_from_tool.translation.vector.into();
        self.arm_state.set_frames(&found.joints, &self.frames, &tcp);
        let (limit_joint, limit_margin) = limit_margin(question, &found.joints);
        let mut evaluation = Held {
            name: found.name,
            limit_margin,
            limit_joint,
            singularity: found.singularity,
            deciding_case: 0,
            in_plane: 0.0,
            in_plane_uncertainty: 0.0,
            normal: 0.0,
            full: 0.0,
        };
        for (case, wrench) in question.cases.iter().enumerate() {
            let unstable = |_| Unreachable::Unstable { case };
            let mut links = match &mut self.beside {
                Beside::Nothing => Links::Neglected,
                Beside::Dragged(dragged) => Links::KeptByFriction(dragged),
                Beside::Farthest(placement) => {
                    let placement = &mut placement[case * self.joints.len()..][..self.joints.len()];
                    Links::Farthest(both_across(&question.normal), placement)
                }
            };
            let deviation = deviation_of(&mut self.arm_state, wrench, &mut links);
            self.deviations[case] = deviation.map_err(unstable)?.linear;
        }
        evaluation.take_envelope(&self.deviations, question.normal);
        if !self.contributors.is_empty() {
            evaluation.in_plane_uncertainty = self.share(question, &evaluation, base_from_tool)?;
        }
        Ok(evaluation)
    }

    /// Fills the shares of the deciding case and gives the standard uncertainty of its in-plane part.
    fn share(
        &mut self,
        question: &Question<'_>,
        evaluation: &Held,
        base_from_tool: &Isometry,
    ) -> Result<f64, Unreachable> {
        let case = evaluation.deciding_case;
        let deviation = self.deviations[case];
        let in_plane = deviation - question.normal.into_inner() * deviation.dot(&question.normal);
        let along = in_plane.try_normalize(0.0).unwrap_or_default();
        let unstable = |_| Unreachable::Unstable { case };
        if case + 1 != question.cases.len() {
            // The arm stands under the last load case still.
            self.arm_state.elastic(&question.cases[case]).map_err(unstable)?;
        }
        self.arm_state.share_along(&along, &self.contributors, &mut self.shares);
        let mut variance = self.arm_state.variance_along(&along).max(0.0) + self.arm_state.scatter().powi(2);
        let placement = match &self.beside {
            Beside::Nothing => None,
            Beside::Dragged(dragged) => Some(*dragged),
            Beside::Farthest(placement) => Some(&placement[case * self.joints.len()..][..self.joints.len()]),
        };
        if let Some(placement) = placement {
            let (arm_state, placement) = (&self.arm_state, (placement, &question.cases[case]));
            variance += arm_state.share_backlash(&along, placement, &self.contributors, &mut self.shares);
        }
        if !question.uncertainty.is_none() {
            let arm_state = LoadedPosture {
                joints: &self.joints,
                frames: &self.frames,
                tcp: base_from_tool.translation.vector.into(),
                tool_axis: base_from_tool.rotation * Vector3::z(),
                wrench: &question.cases[case],
            };
            let of_doubt = self
                .arm_state
                .variance_of_inputs(&question.uncertainty, &arm_state, &along);
            variance += of_doubt.map_err(unstable)?;
        }
        Ok(variance.sqrt())
    }
}

/// The posture with the most room of its turning joints to their limits, the first of equal ones: a rail stands still
/// whatever the posture.
fn roomiest<'f>(question: &Question<'_>, found: &'f [Found]) -> Option<&'f Found> {
    let mut roomiest: Option<(f64, &Found)> = None;
    for one in found {
        let robot = question.arm.robot;
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

/// By how much a posture leaves the range of the joint that is farthest outside.
fn outside_limits(question: &Question<'_>, evaluation: &Held) -> Unreachable {
    let (joint, by) = (evaluation.limit_joint, -evaluation.limit_margin);
    let by = if question.arm.robot.slides(joint) {
        Overrun::Slid(by)
    } else {
        Overrun::Turned(by)
    };
    Unreachable::OutsideLimits { joint, by }
}

/// Whether two branches are the flip of each other.
fn differ_in_flip(a: PostureName, b: PostureName) -> bool {
    let without_flip = |name: PostureName| name.branch().map(|branch| (branch.shoulder, branch.elbow));
    without_flip(a) == without_flip(b)
}

/// The joint nearest to (or farthest outside) its limits, and its margin; infinite without limits.
fn limit_margin(question: &Question<'_>, joints: &[f64]) -> (usize, f64) {
    question
        .arm
        .robot
        .limit_margin(joints)
        .unwrap_or((0, f64::INFINITY))
}

//! One point after the other: the physics of `predict.rs` with reused buffers.
//!
//! Used for arms and models that lanes do not know, and for the points that they cannot decide: no posture and its
//! reason; joints 4 and 6 in line; no equilibrium.

use nalgebra::Vector3;

use super::answer::{ALIKE, AnswerDetail, Evaluation};
use super::on_path::OnPath;
use super::question::{BranchChoice, Question};
use crate::clearance::ClearanceCheck;
use crate::frame::{Isometry, both_across};
use crate::predict::deviation_of;
use crate::robot::forward::{Frames, forward_into};
use crate::robot::inverse::{Finder, InverseSolution, InverseTarget, name_of, tool_on};
use crate::robot::{Overrun, PostureName, Unreachable};
use crate::source::arm_state::LoadedPosture;
use crate::source::{ArmState, Contributor, Links, MotionDisplacement};
use crate::spatial::Twist;

/// Buffers for one point, reused from point to point.
pub(super) struct General<'q> {
    tool_from_flange: Isometry,
    finder: Finder<'q>,
    /// Candidate postures for the point: of two equal flips, the one with the larger margin to the limits.
    candidates: Vec<InverseSolution>,
    frames: Frames,
    arm_state: ArmState<'q>,
    /// Contributors whose shares are computed; empty where shares are not requested.
    contributors: Vec<Contributor>,
    links: LinkOffsets<'q>,
    clearance: Option<ClearanceCheck<'q>>,
    joints: Vec<f64>,
    deviations: Vec<Vector3<f64>>,
    shares: Vec<f64>,
    uncertainty_is_known: bool,
    motion: Option<MotionDisplacement>,
    /// The same three for the best posture so far.
    kept: (Vec<f64>, Vec<Vector3<f64>>, Vec<f64>),
}

/// Backlash and geometry in addition to the load.
enum LinkOffsets<'q> {
    /// Neglected, or added by the caller.
    Neglected,
    /// On a path: geometry, and known link offsets (kept there by friction), rad (m), one per joint.
    Known(&'q [f64]),
    /// At a single point: geometry, and the link offsets with the largest deviation, one per joint and load case.
    WorstCase(Vec<f64>),
}

impl<'q> General<'q> {
    pub(super) fn new(question: &Question<'q>, detail: AnswerDetail) -> General<'q> {
        let (joints, cases) = (question.arm.robot.joints().len(), question.cases.len());
        let contributors = detail.contributors(question);
        let links = match detail {
            AnswerDetail::Shares if question.arm.model.has_unloaded_deviation() => {
                LinkOffsets::WorstCase(vec![0.0; joints * cases])
            }
            _ => LinkOffsets::Neglected,
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
            uncertainty_is_known: question.arm.has_known_uncertainty(),
            motion: None,
            kept: (
                vec![0.0; joints],
                vec![Vector3::zeros(); cases],
                vec![0.0; contributors.len()],
            ),
            contributors,
            links,
            clearance: question.clearance_check(),
        }
    }

    /// The same with what the way along a path adds.
    pub(super) fn on_path(question: &Question<'q>, detail: AnswerDetail, on_path: OnPath<'q>) -> General<'q> {
        let mut general = General::new(question, detail);
        if let Some(link_offsets) = on_path.link_offsets {
            let joints = question.arm.robot.joints().len();
            assert_eq!(link_offsets.len(), joints, "one link offset per joint");
            general.links = LinkOffsets::Known(link_offsets);
        }
        general.motion = on_path.motion;
        if general.motion.is_some() && !general.contributors.is_empty() {
            general.contributors.extend(MotionDisplacement::CONTRIBUTORS);
            for shares in [&mut general.shares, &mut general.kept.2] {
                shares.resize(general.contributors.len(), 0.0);
            }
        }
        general
    }

    /// Number of contributors whose shares are computed.
    pub(super) fn share_count(&self) -> usize {
        self.contributors.len()
    }

    /// Why the posture at these joint positions, rad (m), cannot be used: it does not keep the demanded clearance.
    pub(super) fn conflict(&mut self, joints: &[f64]) -> Option<Unreachable> {
        let conflict = self.clearance.as_mut()?.conflict(joints)?;
        Some(Unreachable::InCollision {
            missing: conflict.missing,
            bodies: conflict.bodies,
        })
    }

    /// Resets: the next point does not follow the previous one.
    pub(super) fn forget(&mut self) {
        self.finder.forget();
    }

    /// The answer at one pose; [`General::write`] then writes its values.
    pub(super) fn answer(
        &mut self,
        question: &Question<'_>,
        base_from_tool: &Isometry,
        near: Option<&[f64]>,
    ) -> Result<Evaluation, Unreachable> {
        let requested = InverseTarget {
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
                let by_load_alone = matches!(self.links, LinkOffsets::Neglected);
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

    /// The answer in the posture at these joint positions, rad (m).
    pub(super) fn answer_in(
        &mut self,
        question: &Question<'_>,
        joints: &[f64],
    ) -> Result<Evaluation, Unreachable> {
        let arm = &question.arm;
        let (name, singularity) = name_of(arm.robot, joints);
        let posture = InverseSolution {
            name,
            joints: joints.to_vec(),
            singularity,
        };
        forward_into(arm.robot, joints, &mut self.frames);
        let base_from_tool = tool_on(&self.frames, arm.flange_from_tool);
        let evaluation = self.evaluate_posture(question, &base_from_tool, &posture)?;
        self.keep();
        Ok(evaluation)
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

    /// The candidate with the smallest envelope; inside limits, where the question selects the best one.
    fn least(
        &mut self,
        question: &Question<'_>,
        base_from_tool: &Isometry,
    ) -> Result<Evaluation, Unreachable> {
        let mut best: Option<Evaluation> = None;
        let mut miss: Option<Unreachable> = None;
        let candidates = std::mem::take(&mut self.candidates);
        for found in &candidates {
            let evaluated = self.evaluate_posture(question, base_from_tool, found);
            let outside = |evaluation: &Evaluation| {
                question.choice == BranchChoice::Best && !evaluation.within_limits()
            };
            let missed = match evaluated {
                Err(reason) => Some(reason),
                Ok(evaluation) if outside(&evaluation) => Some(outside_limits(question, &evaluation)),
                Ok(evaluation) => match self.conflict(&found.joints) {
                    Some(conflict) => Some(conflict),
                    None => {
                        if best.is_none_or(|b| evaluation.in_plane < b.in_plane * (1.0 - ALIKE)) {
                            best = Some(evaluation);
                            self.keep();
                        }
                        None
                    }
                },
            };
            let nearer = |missed: &Unreachable| miss.is_none_or(|miss| missed.is_nearer_than(&miss));
            miss = missed.filter(nearer).or(miss);
        }
        self.candidates = candidates;
        best.ok_or(miss.unwrap_or(Unreachable::OtherBranch))
    }

    /// Computes the deviations of a posture.
    fn evaluate_posture(
        &mut self,
        question: &Question<'_>,
        base_from_tool: &Isometry,
        found: &InverseSolution,
    ) -> Result<Evaluation, Unreachable> {
        self.joints.copy_from_slice(&found.joints);
        forward_into(question.arm.robot, &found.joints, &mut self.frames);
        let tcp = base_from_tool.translation.vector.into();
        self.arm_state.set_frames(&found.joints, &self.frames, &tcp);
        let (limit_joint, limit_margin) = limit_margin(question, &found.joints);
        let mut evaluation = Evaluation {
            name: found.name,
            limit_margin,
            limit_joint,
            singularity: found.singularity,
            worst_case: 0,
            in_plane: 0.0,
            in_plane_uncertainty: None,
            normal: 0.0,
            full: 0.0,
        };
        for (case, wrench) in question.cases.iter().enumerate() {
            let unstable = |_| Unreachable::Unstable { case };
            let mut links = match &mut self.links {
                LinkOffsets::Neglected => Links::Neglected,
                LinkOffsets::Known(link_offsets) => Links::KeptByFriction(link_offsets),
                LinkOffsets::WorstCase(offsets) => {
                    let offsets = &mut offsets[case * self.joints.len()..][..self.joints.len()];
                    Links::Farthest(both_across(&question.normal), offsets)
                }
            };
            let deviation = deviation_of(&mut self.arm_state, wrench, &mut links);
            let by_motion = self.motion.map_or_else(Vector3::zeros, |motion| motion.total());
            self.deviations[case] = deviation.map_err(unstable)?.linear + by_motion;
        }
        evaluation.take_envelope(&self.deviations, question.normal);
        if !self.contributors.is_empty() {
            let uncertainty = self.share(question, &evaluation, base_from_tool)?;
            evaluation.in_plane_uncertainty = self.uncertainty_is_known.then_some(uncertainty);
        }
        Ok(evaluation)
    }

    /// Computes the shares of the worst case and returns the standard uncertainty of its in-plane part.
    fn share(
        &mut self,
        question: &Question<'_>,
        evaluation: &Evaluation,
        base_from_tool: &Isometry,
    ) -> Result<f64, Unreachable> {
        let case = evaluation.worst_case;
        let deviation = self.deviations[case];
        let in_plane = deviation - question.normal.into_inner() * deviation.dot(&question.normal);
        let along = in_plane.try_normalize(0.0).unwrap_or_default();
        let unstable = |_| Unreachable::Unstable { case };
        if case + 1 != question.cases.len() {
            // The arm state is still that of the last load case.
            self.arm_state.elastic(&question.cases[case]).map_err(unstable)?;
        }
        self.arm_state
            .share_along(&along, &self.contributors, &mut self.shares);
        let mut variance = self.arm_state.variance_along(&along).max(0.0) + self.arm_state.scatter().powi(2);
        let offsets = match &self.links {
            LinkOffsets::Neglected => None,
            LinkOffsets::Known(link_offsets) => Some(*link_offsets),
            LinkOffsets::WorstCase(offsets) => {
                Some(&offsets[case * self.joints.len()..][..self.joints.len()])
            }
        };
        let (contributors, shares) = (&self.contributors, &mut self.shares);
        let mut add = |contributor, part: Vector3<f64>, u: Vector3<f64>| {
            if let Some(share) = contributors.iter().position(|other| *other == contributor) {
                shares[share] += part.dot(&along);
            }
            variance += u.dot(&along).powi(2);
        };
        if let Some(offsets) = offsets {
            let add = |contributor, part: Twist, u| add(contributor, part.linear, u);
            self.arm_state.each_unloaded(offsets, &question.cases[case], add);
        }
        for (contributor, part, u) in self.motion.iter().flat_map(MotionDisplacement::parts) {
            add(contributor, part, u);
        }
        if !question.uncertainty.is_none() {
            let arm_state = LoadedPosture {
                joints: &self.joints,
                frames: &self.frames,
                tcp: base_from_tool.translation.vector.into(),
                tool_axis: base_from_tool.rotation * Vector3::z(),
                wrench: &question.cases[case],
            };
            let of_inputs = self
                .arm_state
                .variance_of_inputs(&question.uncertainty, &arm_state, &along);
            variance += of_inputs.map_err(unstable)?;
        }
        Ok(variance.sqrt())
    }
}

/// The posture with the largest margin of its revolute joints to their limits, the first of equal ones: a rail has the
/// same position in every posture.
fn roomiest<'f>(question: &Question<'_>, found: &'f [InverseSolution]) -> Option<&'f InverseSolution> {
    let mut roomiest: Option<(f64, &InverseSolution)> = None;
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

/// The joint that is farthest outside its range, and by how much.
fn outside_limits(question: &Question<'_>, evaluation: &Evaluation) -> Unreachable {
    let (joint, by) = (evaluation.limit_joint, -evaluation.limit_margin);
    let by = if question.arm.robot.slides(joint) {
        Overrun::Slid(by)
    } else {
        Overrun::Turned(by)
    };
    Unreachable::OutsideLimits { joint, by }
}

/// Whether two branches differ only in the flip.
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

//! Modes of vibration of an arm in one posture.
//!
//! | part of the answer | frame and point |
//! |---|---|
//! | `direction`, `modal_mass_kg`, `shape` | of the TCP, axes of the frame `base` |
//! | `shares` | parts of the potential energy of a mode, by contributor; their sum is 1 |
//!
//! The equations are in `docs/theory/modes.md`.

use armill_core::dynamics::ArmMode;
use armill_core::dynamics::modes::{ASSUMED_DAMPING, PUBLISHED_DAMPING};
use armill_core::frame::Isometry;
use armill_core::nalgebra::{Matrix3, Vector3};
use armill_core::robot::{Attachment, Damping, JointCompliance, Robot};
use armill_core::source::{Arm, ArmState, Contributor, StiffnessModel};
use armill_core::units::{to_mm, to_per_um};
use armill_formats::robot::RobotDescription;
use armill_formats::sources::Source;
use schemars::JsonSchema;
use serde::Serialize;

use crate::StudyError;
use crate::analysis::vibration::arm_modes::compliance_covariance;
use crate::file::resolve::Study;
use crate::joint_order::{contributor_names, in_joint_order, joint_names, joint_positions, shown_positions};
use crate::model_words::uncertain_masses;
use crate::pose::first_setting;

/// A query for the modes in one posture.
#[derive(Clone, Debug)]
pub struct ModesQuestion {
    /// Joint positions, deg (mm).
    pub joints_deg: Vec<f64>,
    /// Flange to tool centre point.
    pub flange_from_tool: Isometry,
    /// Frame in whose axes directions are given.
    pub base: String,
    /// Damping ratio of every mode in place of what the robot file gives.
    pub damping_ratio: Option<f64>,
    /// The warning for assumed compliances, if they are.
    pub caution: Option<String>,
}

/// The modes in one posture.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ModesAnswer {
    /// Name of the robot.
    pub robot: String,
    /// Frame in whose axes directions are given.
    pub base: String,
    /// Names of the joints.
    pub joint_names: Vec<String>,
    /// Their positions, of prismatic joints in mm.
    pub joints_deg: Vec<f64>,
    /// The TCP in the frame.
    pub tcp_mm: [f64; 3],
    /// The modes, frequencies rising.
    pub modes: Vec<ModeAnswer>,
    /// Whether the joint compliances are assumed, not measured.
    pub compliance_assumed: bool,
    /// Whether the damping ratio is assumed.
    pub damping_assumed: bool,
    /// What was assumed, neglected or is missing.
    pub notes: Vec<String>,
    /// Sources of the numbers of the robot.
    pub sources: Vec<Source>,
}

/// One mode.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ModeAnswer {
    /// Undamped natural frequency.
    pub frequency_hz: f64,
    /// Its standard uncertainty by that of the compliances; none where it is not known.
    pub frequency_u_hz: Option<f64>,
    /// Damping over critical damping.
    pub damping_ratio: f64,
    /// Direction in which the TCP moves; none where it does not.
    pub direction: Option<[f64; 3]>,
    /// Modal mass in this direction.
    pub modal_mass_along_kg: Option<f64>,
    /// Modal stiffness in this direction: modal mass times the square of the angular frequency.
    pub modal_stiffness_along_n_per_um: Option<f64>,
    /// Modal mass in x, y and z; none where the TCP does not move along it.
    pub modal_mass_kg: [Option<f64>; 3],
    /// Shape at the TCP, normalised by mass: translation in 1/sqrt(kg), then rotation in rad/(m sqrt(kg)).
    // unit: SI, of a shape normalised by mass
    pub shape: [f64; 6],
    /// Who deflects: joints, then base, flange and tool where they have springs.
    pub shares: Vec<EnergyShare>,
}

/// Part of one contributor in the potential energy of a mode.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct EnergyShare {
    /// Name of the contributor.
    pub contributor: String,
    /// From 0 to 1.
    pub share: f64,
}

/// A TCP that moves less than this part of its greatest modal motion does not move.
const STILL: f64 = 1e-9;

/// A tool whose TCP is nearer than this to the axis about which a mode turns it, m, turns only.
const LEVER: f64 = 1e-3;

/// The modes of one robot.
///
/// # Errors
/// A wrong number of joints, an unknown frame; unknown compliances; an arm without masses.
pub fn answer(described: &RobotDescription, question: &ModesQuestion) -> Result<ModesAnswer, StudyError> {
    let model = StiffnessModel {
        structure: described.robot.structure().clone(),
        ..StiffnessModel::DRIVES.clone()
    };
    answer_with(described, question, &model)
}

/// The modes of the arm of a study, with the springs and masses of its tool.
///
/// # Errors
/// As of [`answer`]; a study without analyses.
pub fn answer_in_study(study: &Study, question: &ModesQuestion) -> Result<ModesAnswer, StudyError> {
    answer_with(&study.robot, question, &first_setting(study)?.model)
}

fn answer_with(
    described: &RobotDescription,
    question: &ModesQuestion,
    model: &StiffnessModel,
) -> Result<ModesAnswer, StudyError> {
    let robot = &described.robot;
    let base_from_reference = crate::base_from_reference(robot, &question.base).map_err(|known| {
        StudyError::value(
            format!("robot `{}` has no frame `{}`", robot.name(), question.base),
            format!("it has: {known}"),
        )
    })?;
    let q = joint_positions(robot, &question.joints_deg)?;
    let mut model = model.clone();
    model.load_dependent = false;
    with_damping(&mut model, question.damping_ratio)?;
    let compliance = known_compliance(robot)?;
    needs_mass(robot, &model)?;
    let arm = Arm {
        robot,
        compliance,
        model: &model,
        flange_from_tool: &question.flange_from_tool,
    };
    let mut state = ArmState::new(arm);
    state.set_joints(&q);
    let unstable = |error: armill_core::source::Unstable| StudyError::value(error.to_string(), "");
    let found = state.modes().map_err(unstable)?;
    let compliances = state.tangent_compliances().map_err(unstable)?;
    if found.modes.is_empty() {
        let message = match compliances.iter().all(|compliance| *compliance == 0.0) {
            true => "all joints and springs are rigid: nothing vibrates",
            false => "no mass moves when the joints and springs of the arm deflect: it has no modes",
        };
        let hint = "add [[mass]] at the links behind the joints that deflect";
        return Err(StudyError::value(message, hint));
    }
    let turn = base_from_reference.rotation.inverse().to_rotation_matrix();
    let tcp = base_from_reference.inverse_transform_point(&state.base_from_tool().translation.vector.into());
    let words = Words {
        robot,
        model: &model,
        turn: turn.into_inner(),
    };
    let known = arm.has_known_uncertainty();
    let covariance = compliance_covariance(&arm);
    let by_masses = state.frequency_uncertainties_by_masses(&found.modes);
    let modes = found.modes.iter().zip(&by_masses).map(|(mode, by_masses)| {
        let relative = known.then(|| {
            mode.relative_uncertainty(&compliances, &covariance)
                .hypot(*by_masses)
        });
        words.mode(mode, relative)
    });
    let mut notes: Vec<String> = question.caution.iter().chain(&described.note).cloned().collect();
    notes.extend(words.assumptions());
    Ok(ModesAnswer {
        robot: robot.name().to_owned(),
        base: question.base.clone(),
        joint_names: joint_names(robot),
        joints_deg: shown_positions(robot, &q),
        tcp_mm: to_mm(tcp.coords).into(),
        modes: modes.collect(),
        compliance_assumed: question.caution.is_some(),
        damping_assumed: model.structure.damping.is_none(),
        notes,
        sources: described.sources.clone(),
    })
}

/// Puts a damping ratio of every mode into the model, if one is given.
pub(crate) fn with_damping(model: &mut StiffnessModel, ratio: Option<f64>) -> Result<(), StudyError> {
    let Some(ratio) = ratio else { return Ok(()) };
    if !(0.0..1.0).contains(&ratio) {
        let message = format!("a damping ratio of {ratio} is not a number from 0 to below 1");
        return Err(StudyError::value(message, "such as 0.03"));
    }
    model.structure.damping = Some(Damping::Ratio(ratio));
    Ok(())
}

/// The joint compliances, without which there are no modes.
pub(crate) fn known_compliance(robot: &Robot) -> Result<&[JointCompliance], StudyError> {
    robot.compliance().ok_or_else(|| {
        let message = format!("no joint compliance of robot `{}` is known: its modes cannot be predicted", robot.name());
        let hint = "give --compliance-rad-per-n-m C1,C2,..., or assume them with --compliance-class light|medium|heavy";
        StudyError::value(message, hint)
    })
}

/// An arm without any mass has no modes.
pub(crate) fn needs_mass(robot: &Robot, model: &StiffnessModel) -> Result<(), StudyError> {
    if model.structure.has_inertia() {
        return Ok(());
    }
    let message = format!(
        "robot `{}` has no masses: its modes cannot be predicted",
        robot.name()
    );
    let hint = "add to its file, for each link, [[mass]] with at, mass_kg, centre_mm, inertia_kg_m2 and source, and for each joint \
        [[motor]] with joint, rotor_inertia_kg_m2, ratio and source; a URDF gives them in <inertial>, `armill robots masses` estimates them";
    Err(StudyError::value(message, hint))
}

/// An arm whose modes are described.
struct Words<'a> {
    robot: &'a Robot,
    model: &'a StiffnessModel,
    /// Components in base to those in the frame of the answer.
    turn: Matrix3<f64>,
}

impl Words<'_> {
    /// A mode in the units of the answer.
    fn mode(&self, mode: &ArmMode, relative_uncertainty: Option<f64>) -> ModeAnswer {
        let omega = mode.at_tool.angular_frequency;
        let translation: Vector3<f64> = self.turn * mode.at_tool.shape.fixed_rows::<3>(0);
        let rotation: Vector3<f64> = self.turn * mode.at_tool.shape.fixed_rows::<3>(3);
        let most = translation.norm();
        let frequency_hz = mode.at_tool.frequency_hz();
        // Half of the modes point the other way: the largest component is positive.
        let side = translation[translation.iamax()].signum();
        let moves = most > LEVER * rotation.norm();
        ModeAnswer {
            frequency_hz,
            frequency_u_hz: relative_uncertainty.map(|u| u * frequency_hz),
            damping_ratio: mode.at_tool.damping_ratio,
            direction: moves.then(|| (translation * (side / most)).into()),
            modal_mass_along_kg: moves.then(|| 1.0 / (most * most)),
            modal_stiffness_along_n_per_um: moves.then(|| to_per_um(omega * omega / (most * most))),
            modal_mass_kg: [0, 1, 2].map(|axis| {
                let phi = translation[axis];
                (phi.abs() > STILL * most).then(|| 1.0 / (phi * phi))
            }),
            shape: [
                translation.x * side,
                translation.y * side,
                translation.z * side,
                rotation.x * side,
                rotation.y * side,
                rotation.z * side,
            ],
            shares: self.shares(&mode.shares),
        }
    }

    /// The shares of drives, then springs, by contributor.
    fn shares(&self, each: &[f64]) -> Vec<EnergyShare> {
        let joints = self.robot.joints().len();
        let springs = self
            .model
            .structure
            .springs
            .iter()
            .map(|spring| spring.attachment);
        let attachments: Vec<Attachment> = (0..joints).map(Attachment::Joint).chain(springs).collect();
        let contributors = self.model.contributors(joints);
        let share = |contributor: &Contributor| -> f64 {
            let own = attachments
                .iter()
                .zip(each)
                .filter(|(attachment, _)| Contributor::At(**attachment) == *contributor);
            own.map(|(_, share)| share).sum()
        };
        let shares: Vec<f64> = contributors.iter().map(share).collect();
        contributor_names(self.robot, self.model, false)
            .into_iter()
            .zip(in_joint_order(self.robot, &shares))
            .zip(in_joint_order(self.robot, &contributors))
            .filter(|(_, contributor)| matches!(contributor, Contributor::At(_)))
            .map(|((contributor, share), _)| EnergyShare { contributor, share })
            .collect()
    }

    /// What was assumed, neglected or is missing.
    fn assumptions(&self) -> Vec<String> {
        let (structure, joints) = (&self.model.structure, self.robot.joints());
        let mut notes = Vec::new();
        if structure.damping.is_none() {
            let [least, most] = PUBLISHED_DAMPING;
            notes.push(format!(
                "damping ratio {ASSUMED_DAMPING} assumed for every mode; published values of machining robots range from {least} to {most}"
            ));
        }
        let points = structure
            .masses
            .iter()
            .filter(|mass| mass.inertia.is_none() && mass.mass > 0.0)
            .count();
        if points > 0 {
            notes.push(format!(
                "{points} of {} masses have no inertia and are taken as points: the frequencies are upper bounds in this respect",
                structure.masses.len()
            ));
        }
        let uncertain = uncertain_masses(self.robot, structure);
        if !uncertain.is_empty() {
            notes.push(format!(
                "masses with a standard uncertainty, which is part of that of the frequencies: {}",
                uncertain.join(", ")
            ));
        }
        let ground = self.robot.chain().ground();
        let massless: Vec<&str> = (0..joints.len())
            .filter(|joint| !ground.part_is_in_hand() && *joint >= ground.joints)
            .filter(|joint| {
                !structure
                    .masses
                    .iter()
                    .any(|mass| mass.attachment == Attachment::Joint(*joint))
            })
            .map(|joint| joints[joint].name.as_str())
            .collect();
        if !massless.is_empty() {
            notes.push(format!(
                "the links behind these joints have no mass: {}",
                massless.join(", ")
            ));
        }
        let without: Vec<&str> = (0..joints.len())
            .filter(|joint| !structure.motors.iter().any(|motor| motor.joint == *joint))
            .map(|joint| joints[joint].name.as_str())
            .collect();
        if !without.is_empty() {
            notes.push(format!(
                "rotors of the motors are neglected, as if the drives held them: {}",
                without.join(", ")
            ));
        }
        notes
    }
}

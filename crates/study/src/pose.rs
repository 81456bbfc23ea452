//! One pose: every posture there, its compliance, and its deviation under a load.
//!
//! | part of the answer | frame and point |
//! |---|---|
//! | `tool` | TCP in the frame `base` |
//! | `jacobian`, `compliance`, `stiffness` | at the TCP, base axes, translation first, SI |
//! | `deviation_um`, `rotation_urad`, `joint_share_um` | of the TCP, base axes |
//!
//! Joint positions are in deg, of prismatic joints in mm, in the convention of the robot file.

use armill_core::clearance::CellState;
use armill_core::compliance::{
    by_force, permissible_force_in_worst_direction, principal_compliances, stiffness_at_tool,
};
use armill_core::frame::{Isometry, both_across, tool_orientation};
use armill_core::kernel::{AT_LIMIT, OnPath};
use armill_core::nalgebra::{DMatrix, Matrix6, Point3, Unit, Vector3};
use armill_core::predict::{Deviation, predict};
use armill_core::robot::inverse::{ToolAt, posture_at, postures};
use armill_core::robot::jacobian::{condition_number, jacobian, manipulability};
use armill_core::robot::{Posture, Robot, Unreachable};
use armill_core::source::stiffness_model::FREE_FALL;
use armill_core::source::{Arm, ArmState, Gravity, Links, StiffnessModel, Unstable};
use armill_core::spatial::Wrench;
use armill_core::units::{to_deg, to_mm, to_um, to_urad};
use armill_formats::robot::RobotDescription;

use crate::StudyError;
use crate::file::resolve::Study;
use crate::input::cell::AnalysisCell;
use crate::input::setting::Setting;
use crate::joint_order::{
    contributor_names, in_joint_order, joint_names, joint_order, joint_positions, shown_positions,
};
use crate::joint_unit::JointUnit;
use crate::model_words::{left_out, parts};
use crate::number::without_rounding;
pub use crate::pose_answer::{PoseAnswer, PostureAnswer, StiffnessAnswer, ToolAnswer, UnreachableAnswer};

/// A query for one pose.
#[derive(Clone, Debug)]
pub struct PoseQuestion {
    /// Joint positions, or the position or pose of the tool.
    pub at: At,
    /// Flange to tool centre point.
    pub flange_from_tool: Isometry,
    /// Load on the tool at the TCP, base axes.
    pub wrench: Option<Wrench>,
    /// Whether the load acts on the deflected arm.
    pub load_dependent: bool,
    /// Joint positions when the tool was set, deg (mm): gravity is relative to them, down the z axis of base.
    pub reference_joints_deg: Option<Vec<f64>>,
    /// Frame that positions count from.
    pub base: String,
    /// The warning for assumed compliances, if they are.
    pub caution: Option<String>,
    /// Position of a rail (mm) and preferred positions of redundant joints (deg), one for each joint; if left out, the
    /// middle of their ranges.
    pub home_deg: Option<Vec<f64>>,
}

/// Joint positions, or the position or pose of the tool.
#[derive(Clone, Debug)]
pub enum At {
    /// Joint positions, deg (mm for prismatic joints), in the robot file's own signs and zeros.
    JointsDeg(Vec<f64>),
    /// Position of the TCP (m), tool axis and spin (rad), in the frame that positions count from.
    Tool {
        /// TCP, m.
        tcp: Point3<f64>,
        /// Tool axis, from the spindle towards the part.
        axis: Unit<Vector3<f64>>,
        /// Turn about the axis, rad.
        spin: f64,
    },
    /// The complete pose of the tool, in base.
    Pose(Isometry),
}

/// The least distance of the bodies of a cell in a posture.
struct ClearanceAnswer {
    distance_mm: f64,
    bodies: [String; 2],
    points_mm: [[f64; 3]; 2],
}

impl ClearanceAnswer {
    fn of(
        state: &mut CellState<'_>,
        placed: &AnalysisCell,
        base_from_reference: &Isometry,
        posture: &Posture,
    ) -> Option<ClearanceAnswer> {
        state.set_joints(&posture.joints);
        let found = state.clearance(f64::INFINITY)?;
        let in_reference = |point: &Point3<f64>| base_from_reference.inverse_transform_point(point);
        Some(ClearanceAnswer {
            distance_mm: to_mm(found.nearest.distance),
            bodies: found.bodies.map(|body| placed.cell.name(body).to_owned()),
            points_mm: found.nearest.points.each_ref().map(|point| {
                in_reference(point)
                    .coords
                    .map(|m| without_rounding(to_mm(m)))
                    .into()
            }),
        })
    }
}

/// A length (m) that makes rotations comparable with translations: the reach of an arm.
const WEIGHING_LENGTH: f64 = 1.0;

/// The answer for one pose of one robot.
///
/// # Errors
/// A wrong number of joints, an unknown frame.
pub fn answer(described: &RobotDescription, question: &PoseQuestion) -> Result<PoseAnswer, StudyError> {
    let model = stiffness_model(described, question)?;
    answer_in(
        described,
        question,
        &PoseContext {
            model: &model,
            normal: None,
            on_path: &|_| OnPath::default(),
            cell: None,
        },
    )
}

/// The answer in the cell of a study: with the stiffness model and the bodies of its first analysis.
///
/// # Errors
/// As of [`answer`]; a study without analyses.
pub fn answer_in_study(study: &Study, question: &PoseQuestion) -> Result<PoseAnswer, StudyError> {
    let setting = first_setting(study)?;
    let mut found = answer_in(
        &study.robot,
        question,
        &PoseContext {
            model: &setting.model,
            normal: None,
            on_path: &|_| OnPath::default(),
            cell: setting.cell.as_ref(),
        },
    )?;
    found.notes.extend(study.cell_notes.iter().cloned());
    Ok(found)
}

/// What the points of the first analysis share.
///
/// # Errors
/// A study without analyses.
pub fn first_setting(study: &Study) -> Result<&Setting, StudyError> {
    study.settings().next().ok_or_else(|| {
        StudyError::value(
            "the study has no analysis",
            "add [[analysis]], or remove `analysis = []`",
        )
    })
}

/// The context of a query in which a posture is evaluated.
pub(crate) struct PoseContext<'a> {
    /// Compliances and masses.
    pub model: &'a StiffnessModel,
    /// Links of joints with backlash are where they move the tool farthest across this direction (base); its axis if
    /// `None`.
    pub normal: Option<Unit<Vector3<f64>>>,
    /// What the way along a path adds in the posture with these joint positions, rad (m).
    pub on_path: &'a dyn Fn(&[f64]) -> OnPath<'a>,
    /// The bodies of the cell, if there are any.
    pub cell: Option<&'a AnalysisCell>,
}

/// [`answer`] in this context, which replaces the values of the question.
///
/// # Errors
/// As of [`answer`].
pub(crate) fn answer_in(
    described: &RobotDescription,
    question: &PoseQuestion,
    situation: &PoseContext<'_>,
) -> Result<PoseAnswer, StudyError> {
    let model = situation.model;
    let robot = &described.robot;
    let base_from_reference = crate::base_from_reference(robot, &question.base).map_err(|known| {
        StudyError::value(
            format!("robot `{}` has no frame `{}`", robot.name(), question.base),
            format!("it has: {known}"),
        )
    })?;
    let mut unreachable = None;
    let mut postures_at = |base_from_tool: &Isometry| -> Result<Vec<Posture>, StudyError> {
        // The preferred positions are used only if joints can be chosen.
        let home = question.home_deg.as_deref();
        let home = home.map(|home| joint_positions(robot, home)).transpose()?;
        let tool = ToolAt {
            flange_from_tool: &question.flange_from_tool,
            near: None,
            home: home.as_deref(),
        };
        Ok(postures(robot, base_from_tool, tool).unwrap_or_else(|miss| {
            unreachable = Some(unreachable_answer(miss));
            Vec::new()
        }))
    };
    let found = match &question.at {
        At::JointsDeg(joints) => vec![posture_at(
            robot,
            &joint_positions(robot, joints)?,
            &question.flange_from_tool,
        )],
        At::Tool { tcp, axis, spin } => {
            let reference_from_tool = Isometry::from_parts(tcp.coords.into(), tool_orientation(*axis, *spin));
            postures_at(&(base_from_reference * reference_from_tool))?
        }
        At::Pose(base_from_tool) => postures_at(base_from_tool)?,
    };
    let mut cell_state = situation
        .cell
        .map(|placed| CellState::new(placed.placed(), robot, &question.flange_from_tool));
    let mut arm_state = robot.compliance().map(|compliance| {
        ArmState::new(Arm {
            robot,
            compliance,
            model,
            flange_from_tool: &question.flange_from_tool,
        })
    });
    Ok(PoseAnswer {
        robot: robot.name().to_owned(),
        base: question.base.clone(),
        joint_names: joint_names(robot),
        joint_units: joint_order(robot)
            .into_iter()
            .map(|joint| JointUnit::of(robot, joint).name)
            .collect(),
        compliance_assumed: question.caution.is_some(),
        model: parts(robot, model),
        contributors: contributor_names(
            robot,
            model,
            found
                .iter()
                .any(|posture| (situation.on_path)(&posture.joints).motion.is_some()),
        ),
        postures: found
            .iter()
            .map(|p| {
                let deflection = arm_state
                    .as_mut()
                    .map(|arm_state| posture_deflection(arm_state, p, situation, question.wrench));
                let clearance = cell_state
                    .as_mut()
                    .zip(situation.cell)
                    .and_then(|(state, placed)| ClearanceAnswer::of(state, placed, &base_from_reference, p));
                PostureAnswer {
                    clearance_mm: clearance.as_ref().map(|found| found.distance_mm),
                    nearest: clearance.as_ref().map(|found| found.bodies.clone()),
                    nearest_mm: clearance.map(|found| found.points_mm),
                    ..posture_answer(robot, deflection, &base_from_reference, p)
                }
            })
            .collect(),
        unreachable,
        notes: notes(described, question, model),
        sources: described.sources.clone(),
    })
}

/// The stiffness model of the robot file, with the additions of the query.
fn stiffness_model(
    described: &RobotDescription,
    question: &PoseQuestion,
) -> Result<StiffnessModel, StudyError> {
    let gravity = |joints: &Vec<f64>| -> Result<Gravity, StudyError> {
        Ok(Gravity {
            acceleration: -Vector3::z() * FREE_FALL,
            reference: joint_positions(&described.robot, joints)?,
        })
    };
    Ok(StiffnessModel {
        structure: described.robot.structure().clone(),
        gravity: question.reference_joints_deg.as_ref().map(gravity).transpose()?,
        load_dependent: question.load_dependent,
        ..StiffnessModel::DRIVES.clone()
    })
}

/// The deflection of one posture of an arm with springs.
#[derive(Default)]
struct PostureDeflection {
    compliance: Option<Matrix6<f64>>,
    loaded_compliance: Option<Matrix6<f64>>,
    deviation: Option<Deviation>,
    uncertainty_is_known: bool,
    unstable: Option<Unstable>,
}

/// The compliance of the arm in this posture, and under a load its deviation, or that there is no equilibrium.
fn posture_deflection(
    arm_state: &mut ArmState<'_>,
    posture: &Posture,
    situation: &PoseContext<'_>,
    wrench: Option<Wrench>,
) -> PostureDeflection {
    arm_state.set_joints(&posture.joints);
    let mut found = PostureDeflection {
        compliance: arm_state.compliance(),
        uncertainty_is_known: arm_state.arm().has_known_uncertainty(),
        ..PostureDeflection::default()
    };
    let Some(wrench) = wrench else { return found };
    let mut positions = vec![0.0; posture.joints.len()];
    let axis = || Unit::new_unchecked(posture.base_from_tool * Vector3::z());
    let on_path = (situation.on_path)(&posture.joints);
    let mut links = match on_path.link_offsets {
        Some(link_offsets) => Links::KeptByFriction(link_offsets),
        None => Links::Farthest(
            both_across(&situation.normal.unwrap_or_else(axis)),
            &mut positions,
        ),
    };
    match predict(arm_state, &wrench, &mut links) {
        Ok(mut deviation) => {
            if let Some(motion) = &on_path.motion {
                deviation.add_motion(motion);
            }
            found.deviation = Some(deviation);
            found.loaded_compliance = arm_state.loaded_compliance();
        }
        Err(unstable) => found.unstable = Some(unstable),
    }
    found
}

/// One posture in the units of the answer; without `deflection` no joint compliance is known.
fn posture_answer(
    robot: &Robot,
    deflection: Option<PostureDeflection>,
    base_from_reference: &Isometry,
    posture: &Posture,
) -> PostureAnswer {
    let PostureDeflection {
        compliance,
        loaded_compliance,
        deviation,
        uncertainty_is_known,
        unstable,
    } = deflection.unwrap_or_default();
    let from_si = |i: usize, value: f64| value * JointUnit::of(robot, i).scale;
    let margin = robot.limit_margin(&posture.joints);
    let j = jacobian(robot, &posture.screws);
    let order = joint_order(robot);
    let reference_from_tool = base_from_reference.inv_mul(&posture.base_from_tool);
    let axis = Unit::new_unchecked(posture.base_from_tool * Vector3::z());
    let rotation = reference_from_tool.rotation.quaternion();
    PostureAnswer {
        branch: posture.name.to_string(),
        joints_deg: shown_positions(robot, &posture.joints),
        within_limits: margin.is_none_or(|(_, margin)| margin >= -AT_LIMIT),
        limit_margin_deg: margin.map(|(i, margin)| from_si(i, margin)),
        limit_joint: margin.map(|(i, _)| robot.joints()[i].name.clone()),
        tool: ToolAnswer {
            xyz_mm: to_mm(reference_from_tool.translation.vector).into(),
            quaternion_wxyz: [rotation.w, rotation.i, rotation.j, rotation.k],
        },
        singularity: posture.singularity.map(|s| s.to_string()),
        manipulability: manipulability(&j),
        condition_number: condition_number(&j, WEIGHING_LENGTH),
        jacobian: rows(&DMatrix::from_fn(6, order.len(), |row, column| {
            j[(row, order[column])]
        })),
        compliance: compliance.map(|c| six_rows(&c)),
        stiffness: compliance.map(|c| stiffness_answer(&c, axis)),
        loaded_compliance: loaded_compliance.map(|c| six_rows(&c)),
        unstable: unstable.map(|unstable| unstable.to_string()),
        deviation_um: deviation.as_ref().map(|d| to_um(d.twist.linear).into()),
        rotation_urad: deviation.as_ref().map(|d| to_urad(d.twist.angular).into()),
        joint_share_um: deviation
            .as_ref()
            .map(|d| in_joint_order(robot, &d.shares))
            .map(|shares| shares.iter().map(|s| to_um(s.linear).into()).collect()),
        deviation_u_um: deviation
            .as_ref()
            .filter(|_| uncertainty_is_known)
            .map(|d| to_um(d.covariance.diagonal().map(|v| v.max(0.0).sqrt())).into()),
        clearance_mm: None,
        nearest: None,
        nearest_mm: None,
    }
}

/// Results that follow from a compliance; `axis` is the tool axis in base.
fn stiffness_answer(compliance: &Matrix6<f64>, axis: Unit<Vector3<f64>>) -> StiffnessAnswer {
    let stiffness = stiffness_at_tool(compliance, WEIGHING_LENGTH);
    let by_force = by_force(compliance);
    let principal = principal_compliances(&by_force);
    StiffnessAnswer {
        stiffness: six_rows(&stiffness.matrix),
        rank: stiffness.rank,
        condition_number: stiffness
            .condition_number
            .is_finite()
            .then_some(stiffness.condition_number),
        principal_um_per_n: principal.map(|p| to_um(p.value)),
        principal_direction: principal.map(|p| p.direction.into()),
        permissible_n_per_um: permissible_force_in_worst_direction(&by_force, axis, 1e-6).0,
    }
}

/// Why there is no posture, in word and numbers.
fn unreachable_answer(miss: Unreachable) -> UnreachableAnswer {
    let turned = match miss {
        Unreachable::NotFound { turned, .. } => Some(to_deg(turned)),
        _ => None,
    };
    UnreachableAnswer {
        reason: miss.word().to_owned(),
        // No value if the arm is not stable.
        amount_mm: to_mm(miss.amount().unwrap_or_default()),
        amount_deg: turned,
        message: miss.to_string(),
    }
}

/// Caution first, then the note of the robot file, masses without gravity, and unknown compliances.
fn notes(described: &RobotDescription, question: &PoseQuestion, model: &StiffnessModel) -> Vec<String> {
    let said = question.caution.iter().chain(&described.note).cloned();
    let mut notes: Vec<String> = said.chain(left_out(model)).collect();
    if described.robot.compliance().is_none() {
        notes.push("no joint compliance is known: identify it from load tests (`armill identify`) and give it with --compliance-rad-per-n-m, or assume one with --compliance-class light|medium|heavy".to_owned());
    }
    notes
}

/// A matrix row by row.
fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix
        .row_iter()
        .map(|row| row.iter().copied().collect())
        .collect()
}

/// A 6 x 6 matrix row by row.
fn six_rows(matrix: &Matrix6<f64>) -> [[f64; 6]; 6] {
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)]))
}

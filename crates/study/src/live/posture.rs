//! The postures of the arm at one target of an analysis, and the deviation under each load case there.
//!
//! A target is given on the plane of the analysis, by joints, as a point in the reference frame with the tool
//! orientation of the plane, or by the number of a point of a path, of holes or of a box. Compliances and masses are
//! those of the study, as in its answer.
//!
//! At a point of a path, the deviation of the posture followed is that of the path: see `along`.

use armill_core::compliance::{by_force, permissible_force, permissible_force_in_worst_direction};
use armill_core::frame::{Isometry, tool_orientation};
use armill_core::kernel::{BranchChoice, OnPath, Question, evaluate_posture};
use armill_core::nalgebra::{Point2, Point3, Rotation3, Unit, Vector3};
use armill_core::robot::Robot;
use armill_core::robot::forward::{base_from_ground, forward, joint_axis};
use armill_core::robot::inverse::tool_on;
use armill_core::source::Arm;
use armill_core::spatial::Wrench;
use armill_core::units::{from_mm, to_mm, to_um};
use armill_core::watch::Watch;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::analysis::arm::arm_posture;
use crate::analysis::{AnalysisResult, Subject};
use crate::error::StudyError;
use crate::file::resolve::Study;
use crate::input::setting::Setting;
use crate::joint_order::{in_joint_order, joint_order, joint_positions, shown_positions};
use crate::joint_unit::JointUnit;
use crate::live::along::{ToolTarget, answered_posture, at_hole, on_path};
use crate::live::bodies::{BodyPose, DrawnBodies, DrawnCell};
use crate::live::meshes::{DrawnMesh, Shapes};
use crate::live::{EditedAnalysis, StudyText};
use crate::number::without_rounding;
use crate::pose::{At, PoseAnswer, PoseContext, PoseQuestion, PostureAnswer, answer_in};

/// A target of the tool: one of these.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PoseTarget {
    /// In the plane, together with `z_mm`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y_mm: Option<f64>,
    /// In the plane, together with `y_mm`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z_mm: Option<f64>,
    /// Joint positions in the convention of the robot file; mm for prismatic joints.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joints_deg: Option<Vec<f64>>,
    /// TCP in the reference frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub xyz_mm: Option<[f64; 3]>,
    /// Point of a path, of holes or of a box, from 0, in the order of their table.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point: Option<usize>,
    /// Of sections which one, from 0; the first if left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub section: Option<usize>,
}

/// A query for one target.
#[derive(Clone, Debug)]
pub struct PostureQuestion<'a> {
    /// The analysis; the first if left out.
    pub analysis: Option<&'a str>,
    /// The target.
    pub at: PoseTarget,
    /// Load case whose deviation is reported, from 1.
    pub case: usize,
}

/// Every posture at one target, as in `armill pose --json`, and its drawing.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PosturesAnswer {
    /// The postures under the requested load case, with every source: the same totals as `in_plane`.
    pub answer: PoseAnswer,
    /// The arm in each posture.
    pub drawings: Vec<DrawnPosture>,
    /// Limits of the joints.
    pub limits: Vec<JointLimits>,
    /// Joints of each posture in the convention of the chain, not of the controller.
    pub chain: Vec<Vec<ChainPosition>>,
    /// Deviation of each posture under each load case; `null` if the arm has no equilibrium, or no compliance is known.
    /// Along a path, backlash and geometry are included for the posture in which it is followed.
    pub in_plane: Vec<Vec<Option<CaseAnswer>>>,
    /// Index of the posture of the analysis there: the one whose deviation is in its answer; `null` if it has none, and
    /// at a target given by joints.
    pub answered: Option<usize>,
}

/// The arm in one posture, base.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct DrawnPosture {
    /// Joints, base to flange.
    pub joints: Vec<DrawnJoint>,
    /// Centre of the flange.
    pub flange_mm: [f64; 3],
    /// Axes x, y, z of the flange.
    // unit: directions, length 1
    pub flange_axes: [[f64; 3]; 3],
    /// Tool centre point.
    pub tool_mm: [f64; 3],
    /// Axis of the tool, from the spindle towards the part.
    pub tool_axis: [f64; 3],
    /// The arm as a line: from its base through its joints and the flange to the TCP; without the joints of a positioner.
    pub links_mm: Vec<[f64; 3]>,
    /// The ground on which robot and obstacles stand: the base, unless a positioner moves the table.
    pub ground: BodyPose,
    /// The meshes of its links, if the robot file names them and all exist.
    pub meshes: Vec<DrawnMesh>,
    /// The bodies of the cell; `null` without any.
    pub cell: Option<DrawnCell>,
}

/// A joint in a drawing.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct DrawnJoint {
    /// Its name.
    pub name: String,
    /// A point of its axis.
    pub origin_mm: [f64; 3],
    /// Its axis.
    pub axis: [f64; 3],
    /// `turns` or `slides`.
    pub kind: &'static str,
}

/// Limits of a joint in the convention of the robot file; `null` if they are not known.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct JointLimits {
    /// Its name.
    pub name: String,
    /// Lower limit, mm for a prismatic joint.
    pub lower_deg: Option<f64>,
    /// Upper limit, mm for a prismatic joint.
    pub upper_deg: Option<f64>,
    /// `deg` or `mm`.
    pub unit: &'static str,
}

/// A joint in the convention of the chain: right-handed about the axes of the chain, zero where the chain is straight.
/// The signs, zeros and couplings of the robot file are applied; mm for a prismatic joint.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ChainPosition {
    /// Its position.
    pub at_deg: f64,
    /// Lower limit; `null` if it has none. Limits of a coupled joint move with the other.
    pub lower_deg: Option<f64>,
    /// Upper limit; `null` if it has none.
    pub upper_deg: Option<f64>,
}

/// A deviation relative to the plane; values that are not known for such a posture are `null`.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct CaseAnswer {
    /// Length of its component in the plane.
    pub in_plane_um: f64,
    /// Its standard uncertainty, from compliances, load, tool length, repeatability and model error; none where it is
    /// not known.
    pub in_plane_u_um: Option<f64>,
    /// Along the outward normal.
    pub normal_um: f64,
    /// Its length.
    pub full_um: f64,
    /// The force of the case there, base axes.
    pub force_n: [f64; 3],
    /// The whole vector, of the TCP, base axes.
    pub deviation_um: [f64; 3],
    /// Share of each of `answer.contributors` in the in-plane deviation; their sum is the deviation.
    pub share_um: Vec<f64>,
    /// Force that meets the tolerance in the direction of this case; none without a force or without an in-plane
    /// deviation.
    pub permissible_along_load_n: Option<f64>,
    /// Force that meets the tolerance in any direction.
    pub permissible_any_direction_n: Option<f64>,
}

/// Every posture at a target of this analysis.
///
/// # Errors
/// Every problem of the text that concerns the analysis; an invalid target; no such load case.
pub fn postures(
    text: StudyText<'_>,
    question: &PostureQuestion<'_>,
    watch: Watch<'_>,
) -> Result<PosturesAnswer, StudyError> {
    let edited = text.one_analysis(question.analysis)?;
    postures_of(&edited, &question.at, question.case, None, watch)
}

/// [`postures`] of a text that has been read; the analysis may have been evaluated. `case` counts from 1.
pub(super) fn postures_of(
    edited: &EditedAnalysis<'_>,
    at: &PoseTarget,
    case: usize,
    done: Option<&AnalysisResult<'_>>,
    watch: Watch<'_>,
) -> Result<PosturesAnswer, StudyError> {
    let study = &edited.study;
    let setting = edited.setting(at.section.unwrap_or(0))?;
    let requested = requested(study, setting, at, done, watch)?;
    let robot = &study.robot.robot;
    let wrench = match (
        case.checked_sub(1).and_then(|case| requested.cases.get(case)),
        requested.cases.len(),
    ) {
        (None, count) if count > 0 => {
            let message = format!("load case {case} does not exist");
            return Err(StudyError::value(message, format!("cases are 1 to {count}")));
        }
        (found, _) => found.copied(),
    };
    // Redundant joints are positioned as in the answer.
    let pose = requested.pose.as_ref().and_then(|pose| pose.joints.as_ref());
    let home = pose.or(setting.home.as_ref());
    let answer = answer_in(
        &study.robot,
        &PoseQuestion {
            at: requested.at.clone(),
            flange_from_tool: setting.flange_from_tool,
            wrench,
            load_dependent: setting.model.load_dependent,
            reference_joints_deg: None,
            base: setting.base_name.clone(),
            caution: study.own_compliance.as_ref().and_then(|own| own.caution.clone()),
            home_deg: home.map(|home| shown_positions(robot, home)),
        },
        &PoseContext {
            model: &setting.model,
            normal: Some(requested.normal),
            on_path: &|q| (requested.pose.as_ref()).map_or_else(OnPath::default, |pose| pose.on_path_in(q)),
            cell: setting.cell.as_ref(),
        },
    )?;
    let joints = answer
        .postures
        .iter()
        .map(|posture| joint_positions(&study.robot.robot, &posture.joints_deg));
    let joints: Vec<Vec<f64>> = joints.collect::<Result<_, StudyError>>()?;
    let of_cases = joints.iter().map(|q| deviations(robot, setting, q, &requested));
    let shapes = Shapes::of(&edited.parsed.file.robot, edited.folder);
    let cell = setting.cell.as_ref();
    let mut bodies = cell.map(|cell| DrawnBodies::of(cell, robot, &setting.flange_from_tool));
    let drawn = |(q, posture): (&Vec<f64>, &PostureAnswer)| DrawnPosture {
        meshes: shapes.drawn(robot, q),
        cell: (bodies.as_mut()).map(|bodies| bodies.drawn(q, posture, &setting.base_from_reference)),
        ..drawn(robot, q, &setting.flange_from_tool)
    };
    Ok(PosturesAnswer {
        in_plane: of_cases.collect(),
        answered: answered_posture(robot, setting, &requested, &joints, watch)?,
        drawings: joints.iter().zip(&answer.postures).map(drawn).collect(),
        limits: limits(robot),
        chain: joints.iter().map(|q| as_chain(robot, q)).collect(),
        answer,
    })
}

/// The tool target of a query.
fn requested(
    study: &Study,
    setting: &Setting,
    at: &PoseTarget,
    done: Option<&AnalysisResult<'_>>,
    watch: Watch<'_>,
) -> Result<ToolTarget, StudyError> {
    let on_plane = |at: At| ToolTarget {
        at,
        normal: setting.plane.normal(),
        cases: setting.cases.clone(),
        pose: None,
    };
    let one_of = "one of: y_mm with z_mm, joints_deg, xyz_mm, point";
    let numbers = [at.y_mm, at.z_mm].into_iter().flatten();
    let numbers = numbers.chain(at.xyz_mm.into_iter().flatten());
    let mut numbers = numbers.chain(at.joints_deg.iter().flatten().copied());
    if let Some(beyond) = numbers.find(|value| !value.is_finite() || value.abs() > LARGEST) {
        return Err(StudyError::value(
            format!("{beyond} is larger than {LARGEST:e}"),
            "check the unit",
        ));
    }
    match (at.y_mm, at.z_mm, &at.joints_deg, at.xyz_mm, at.point) {
        (Some(y), Some(z), None, None, None) => {
            // y' is opposite to x of the part.
            let in_part = Point2::new(from_mm(-y), from_mm(z));
            Ok(on_plane(At::Pose(setting.plane.base_from_tool(in_part, 0.0))))
        }
        (None, None, Some(joints), None, None) => Ok(on_plane(At::JointsDeg(joints.clone()))),
        (None, None, None, Some(xyz), None) => {
            let tcp = setting.base_from_reference * Point3::from(from_mm(Vector3::from(xyz)));
            Ok(on_plane(At::Pose(pose_on_plane(setting, tcp))))
        }
        (None, None, None, None, Some(index)) => point(study, setting, index, done, watch),
        _ => Err(StudyError::value("give exactly one kind of target", one_of)),
    }
}

/// Larger lengths (mm) or angles (deg) are refused: the unit must be wrong.
const LARGEST: f64 = 1e9;

/// The tool with its tip there (base), oriented as on the plane.
fn pose_on_plane(setting: &Setting, tcp: Point3<f64>) -> Isometry {
    Isometry::from_parts(
        tcp.coords.into(),
        tool_orientation(setting.plane.tool_axis(), 0.0),
    )
}

/// Refuses a point that does not exist; points count from 0.
pub(super) fn existing_point(index: usize, count: usize) -> Result<(), StudyError> {
    match index < count {
        true => Ok(()),
        false => Err(StudyError::value(
            format!("point {index} does not exist"),
            format!("points are 0 to {}", count.saturating_sub(1)),
        )),
    }
}

/// A point of a path, of holes or of a box.
fn point(
    study: &Study,
    setting: &Setting,
    index: usize,
    done: Option<&AnalysisResult<'_>>,
    watch: Watch<'_>,
) -> Result<ToolTarget, StudyError> {
    match study.analyses.first().map(|analysis| &analysis.subject) {
        Some(Subject::Path(path)) => {
            existing_point(index, path.track.len())?;
            on_path(study, path, index, done, watch)
        }
        Some(Subject::Holes(holes)) => {
            existing_point(index, holes.path.track.len())?;
            at_hole(study, holes, index, done, watch)
        }
        Some(Subject::Volume(_, grid)) => {
            existing_point(index, grid.len())?;
            Ok(ToolTarget {
                at: At::Pose(pose_on_plane(setting, grid.point(index))),
                normal: setting.plane.normal(),
                cases: setting.cases.clone(),
                pose: None,
            })
        }
        _ => Err(StudyError::value(
            "points of a map are given by y_mm and z_mm",
            "such as {\"y_mm\": 0, \"z_mm\": 0}",
        )),
    }
}

/// The deviation of this posture under each case. Outside paths, and for other postures than that of the path, it is
/// that of a single point.
fn deviations(
    robot: &Robot,
    setting: &Setting,
    q: &[f64],
    requested: &ToolTarget,
) -> Vec<Option<CaseAnswer>> {
    let (cases, normal) = (&requested.cases, requested.normal);
    let Some(compliance) = robot.compliance() else {
        return vec![None; cases.len()];
    };
    let on_path = (requested.pose.as_ref()).map_or_else(OnPath::default, |pose| pose.on_path_in(q));
    let arm = Arm {
        robot,
        compliance,
        model: &setting.model,
        flange_from_tool: &setting.flange_from_tool,
    };
    let compliance_by_force = by_force(&setting.compliance_at(robot, q));
    let any = permissible_force_in_worst_direction(&compliance_by_force, normal, setting.tolerance).0;
    let of = |wrench: &Wrench| {
        let question = Question {
            arm,
            home: None,
            homes: None,
            cases: std::slice::from_ref(wrench),
            uncertainty: setting.uncertainty,
            normal,
            choice: BranchChoice::Best,
            clearance: None,
        };
        let answers = evaluate_posture(&question, q, on_path);
        let evaluation = answers.points[0].as_ref().ok()?;
        // A case that is a moment alone has no direction.
        let along = Unit::try_new(wrench.force, 1e-12)
            .map(|f| permissible_force(&compliance_by_force, normal, f, setting.tolerance));
        Some(CaseAnswer {
            in_plane_um: to_um(evaluation.in_plane),
            in_plane_u_um: evaluation.in_plane_uncertainty.map(to_um),
            normal_um: to_um(evaluation.normal),
            full_um: to_um(evaluation.full),
            force_n: wrench.force.map(without_rounding).into(),
            deviation_um: to_um(answers.deviations_at(0)[0]).into(),
            share_um: in_joint_order(robot, answers.shares_at(0))
                .iter()
                .map(to_um)
                .collect(),
            permissible_along_load_n: along.filter(|n| n.is_finite()),
            permissible_any_direction_n: Some(any).filter(|n| n.is_finite()),
        })
    };
    cases.iter().map(of).collect()
}

/// The axes x, y, z of a frame.
pub(super) fn axes(rotation: &Rotation3<f64>) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| rotation.matrix().column(i).map(without_rounding).into())
}

/// The arm at these joint positions (rad, m).
fn drawn(robot: &Robot, q: &[f64], flange_from_tool: &Isometry) -> DrawnPosture {
    let arm = arm_posture(robot, q, flange_from_tool);
    let frames = forward(robot, q);
    let ground = base_from_ground(robot, q);
    let clean = |v: Vector3<f64>| -> [f64; 3] { v.map(without_rounding).into() };
    let joint = |i: usize| DrawnJoint {
        name: robot.joints()[i].name.clone(),
        origin_mm: to_mm(frames.origin(i).coords).into(),
        axis: clean(joint_axis(robot, &frames, i)),
        kind: if robot.slides(i) { "slides" } else { "turns" },
    };
    let origins = arm.joints.iter().map(|joint| joint.origin_mm);
    let links = std::iter::once(arm.base_mm)
        .chain(origins)
        .chain([arm.flange_mm, arm.tool_mm]);
    DrawnPosture {
        joints: joint_order(robot).into_iter().map(joint).collect(),
        flange_mm: arm.flange_mm,
        flange_axes: axes(&frames.base_from_flange.rotation),
        tool_mm: arm.tool_mm,
        tool_axis: clean(tool_on(&frames, flange_from_tool) * Vector3::z()),
        links_mm: links.collect(),
        ground: BodyPose::of(&ground.translation.vector.into(), &ground.rotation),
        meshes: Vec::new(),
        cell: None,
    }
}

/// These joint positions (rad, m) in the convention of the chain.
fn as_chain(robot: &Robot, q: &[f64]) -> Vec<ChainPosition> {
    let of = |i: usize| {
        let scale = JointUnit::of(robot, i).scale;
        let mut other = q.to_vec();
        let mut given = |value: f64| {
            other[i] = value;
            without_rounding(robot.theta(i, &other) * scale)
        };
        let limits = robot.joints()[i].limits;
        // A joint of negative sign is measured from its upper limit.
        let ends = limits.map(|limits| [given(limits.lower), given(limits.upper)]);
        ChainPosition {
            at_deg: given(q[i]),
            lower_deg: ends.map(|[a, b]| a.min(b)),
            upper_deg: ends.map(|[a, b]| a.max(b)),
        }
    };
    joint_order(robot).into_iter().map(of).collect()
}

/// Limits of every joint.
fn limits(robot: &Robot) -> Vec<JointLimits> {
    let of = |i: usize| {
        let joint = &robot.joints()[i];
        let unit = JointUnit::of(robot, i);
        let given = |value: f64| without_rounding(value * unit.scale);
        JointLimits {
            name: joint.name.clone(),
            lower_deg: joint.limits.map(|limits| given(limits.lower)),
            upper_deg: joint.limits.map(|limits| given(limits.upper)),
            unit: unit.name,
        }
    };
    joint_order(robot).into_iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chain_counts_by_sign_zero_and_coupling_and_back() {
        // The FANUC couples its second joint with the third.
        for name in ["yaskawa/mh12", "fanuc/r2000ic"] {
            let robot = crate::library::robot(name).unwrap().unwrap().robot;
            let q: Vec<f64> = (0..robot.joints().len()).map(|i| 0.1 + 0.05 * i as f64).collect();
            let mut back = Vec::new();
            for (i, given) in as_chain(&robot, &q).iter().enumerate() {
                assert!(
                    given.lower_deg < Some(given.at_deg) && Some(given.at_deg) < given.upper_deg,
                    "{name} {i}"
                );
                back.push(robot.joint_position(i, given.at_deg.to_radians(), &back));
                assert!((back[i] - q[i]).abs() < 1e-9, "{name} {i}");
            }
        }
    }
}

//! How the arm stands at one place of an ask, in every posture, and what each load case does there.
//!
//! A place is told on the plane of the ask, by joints, as a point of the frame that coordinates count from with the tool
//! held as on the plane, or by the number of a point of a path, of holes or of a box. What yields and weighs is the
//! study's, as in its answer.
//!
//! At a point of a path the posture that the path is followed in deviates as the path tells: `along` says what that takes.

use armill_core::compliance::{by_force, permissible_force, permissible_force_in_worst_direction};
use armill_core::frame::{Isometry, both_across, tool_orientation};
use armill_core::kernel::{BranchChoice, Question, evaluate, evaluate_on_path};
use armill_core::nalgebra::{Point2, Point3, Unit, Vector3};
use armill_core::predict::predict;
use armill_core::robot::Robot;
use armill_core::robot::forward::{forward, joint_axis};
use armill_core::robot::inverse::tool_on;
use armill_core::source::{Arm, Links, ArmState};
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;
use armill_core::workpiece::Split;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::along::{Held, at_hole, on_path};
use super::meshes::{DrawnMesh, Shapes};
use super::{Text, setting};
use crate::error::StudyError;
use crate::file::resolve::{Parsed, Setting, Study, Subject};
use crate::joint_unit::JointUnit;
use crate::number::without_rounding;
use crate::output::arm_posture;
use crate::pose::{At, PoseAnswer, PoseQuestion, Situation, answer_in, joint_positions};
use crate::run::Done;

/// Where the tool is: one of these.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Place {
    /// In the plane, together with `z_mm`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y_mm: Option<f64>,
    /// In the plane, together with `y_mm`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z_mm: Option<f64>,
    /// Joint positions as the robot file counts them; mm for sliding ones.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joints_deg: Option<Vec<f64>>,
    /// TCP in the frame that coordinates count from.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub xyz_mm: Option<[f64; 3]>,
    /// Point of a path, of holes or of a box, from 0, in the order of their table.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point: Option<usize>,
    /// Of sections which one, from 0; the first if left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub section: Option<usize>,
}

/// What is asked of one place.
#[derive(Clone, Debug)]
pub struct PostureQuestion<'a> {
    /// The ask; the first if left out.
    pub analysis: Option<&'a str>,
    /// Where.
    pub at: Place,
    /// Load case that the answer tells the deviation of, from 1.
    pub case: usize,
}

/// Every posture at one place, as `armill pose --json` tells it, and how each is drawn.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PosturesAnswer {
    /// The postures under the load case asked for, with every source: the same totals as `in_plane`.
    pub answer: PoseAnswer,
    /// The arm in each posture.
    pub drawings: Vec<DrawnPosture>,
    /// Limits of the joints.
    pub limits: Vec<JointLimits>,
    /// Joints of each posture as the chain of the robot counts them, in place of its controller.
    pub chain: Vec<Vec<ChainPosition>>,
    /// Deviation of each posture under each load case; `null` where the arm finds no rest, or no compliance is known. Along a
    /// path backlash and geometry are in that of the posture that it is followed in.
    pub in_plane: Vec<Vec<Option<CaseAnswer>>>,
}

/// The arm in one posture, base.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct DrawnPosture {
    /// Joints, base to flange.
    pub joints: Vec<DrawnJoint>,
    /// Centre of the flange.
    pub flange_mm: [f64; 3],
    /// Tool centre point.
    pub tool_mm: [f64; 3],
    /// Axis of the tool, from the spindle towards the part.
    pub tool_axis: [f64; 3],
    /// The arm as a line: from its foot over the joints and the flange to the TCP.
    pub links_mm: Vec<[f64; 3]>,
    /// The shapes of its links, where the robot's file names them and all are there.
    pub meshes: Vec<DrawnMesh>,
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

/// Limits of a joint as the robot file counts; `null` where they are not known.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct JointLimits {
    /// Its name.
    pub name: String,
    /// Least position, mm of a joint that slides.
    pub lower_deg: Option<f64>,
    /// Greatest position, likewise.
    pub upper_deg: Option<f64>,
    /// `deg` or `mm`.
    pub unit: &'static str,
}

/// A joint as the chain counts it: by the right hand about the axes of the chain, from where the chain is straight. What
/// the robot file tells of signs, zeros and coupled joints is in it; mm of a joint that slides.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ChainPosition {
    /// Where it stands.
    pub at_deg: f64,
    /// Least position; `null` where it has no limits. Limits of a coupled joint move with the other.
    pub lower_deg: Option<f64>,
    /// Greatest position, likewise.
    pub upper_deg: Option<f64>,
}

/// A deviation seen from the plane; what is not told of such a posture is `null`.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct CaseAnswer {
    /// Length of its part in the plane.
    pub in_plane_um: f64,
    /// Its standard uncertainty, from compliances, load, tool length, repeatability and model error; of postures with a name.
    pub in_plane_u_um: Option<f64>,
    /// Along the outward normal.
    pub normal_um: f64,
    /// Its length.
    pub full_um: f64,
    /// All of it, of the TCP, base axes.
    pub deviation_um: [f64; 3],
    /// Share of each of `answer.contributors` in the in-plane deviation; they add up to it. Of postures with a name.
    pub share_um: Option<Vec<f64>>,
    /// Force that keeps the limit in the direction of this case; none where it has no force or moves nothing in the plane.
    pub permissible_along_load_n: Option<f64>,
    /// Force that keeps the limit whatever its direction.
    pub permissible_any_direction_n: Option<f64>,
}

/// Where the tool is, in the terms of the core.
pub(super) struct Asked {
    pub at: At,
    pub normal: Unit<Vector3<f64>>,
    /// Wrenches on the tool, base, one a case.
    pub cases: Vec<Wrench>,
    /// How the answer holds the tool there, of a path and of holes.
    pub evaluation: Option<Held>,
}

/// Every posture at a place of this ask.
///
/// # Errors
/// Every problem of the text that concerns the ask; a place that is none; no such load case.
pub fn postures(
    text: Text<'_>,
    question: &PostureQuestion<'_>,
    watch: Watch<'_>,
) -> Result<PosturesAnswer, StudyError> {
    let (parsed, _, study) = text.one_ask(question.analysis)?;
    postures_of(
        (text, &parsed, &study),
        (&question.at, question.case),
        None,
        watch,
    )
}

/// [`postures`] of a text that has been read, its study with this ask alone, which may have been done.
pub(super) fn postures_of(
    (text, parsed, study): (Text<'_>, &Parsed, &Study),
    (at, case): (&Place, usize),
    done: Option<&Done<'_>>,
    watch: Watch<'_>,
) -> Result<PosturesAnswer, StudyError> {
    let setting = setting(study, at.section.unwrap_or(0))?;
    let requested = requested((study, setting), at, done, watch)?;
    let robot = &study.robot.robot;
    let wrench = match (
        case.checked_sub(1).and_then(|case| requested.cases.get(case)),
        requested.cases.len(),
    ) {
        (None, count) if count > 0 => {
            let message = format!("there is no load case {case}");
            return Err(StudyError::value(
                message,
                format!("they count from 1 to {count}"),
            ));
        }
        (found, _) => found.copied(),
    };
    // Joints to spare stand as they do in the answer.
    let evaluation = requested.evaluation.as_ref().and_then(|evaluation| evaluation.joints.as_ref());
    let home = evaluation.or(setting.home.as_ref());
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
            home_deg: home.map(|home| {
                home.iter()
                    .enumerate()
                    .map(|(i, q)| q * JointUnit::of(robot, i).scale)
                    .collect()
            }),
        },
        &Situation {
            model: &setting.model,
            normal: Some(requested.normal),
            dragged: &|q| requested.evaluation.as_ref()?.dragged_in(q),
        },
    )?;
    let joints = answer
        .postures
        .iter()
        .map(|posture| joint_positions(&study.robot, &posture.joints_deg));
    let joints: Vec<Vec<f64>> = joints.collect::<Result<_, StudyError>>()?;
    let of_cases = joints
        .iter()
        .zip(&answer.postures)
        .map(|(q, posture)| deviations(robot, setting, (q, &posture.branch), &requested));
    let in_plane = of_cases.collect();
    let shapes = Shapes::of(&parsed.file.robot, text.folder);
    let drawn = |q: &Vec<f64>| DrawnPosture {
        meshes: shapes.drawn(robot, q),
        ..drawn(robot, q, &setting.flange_from_tool)
    };
    Ok(PosturesAnswer {
        in_plane,
        drawings: joints.iter().map(drawn).collect(),
        limits: limits(robot),
        chain: joints.iter().map(|q| as_chain(robot, q)).collect(),
        answer,
    })
}

/// What the place means.
fn requested(
    (study, setting): (&Study, &Setting),
    at: &Place,
    done: Option<&Done<'_>>,
    watch: Watch<'_>,
) -> Result<Asked, StudyError> {
    let on_plane = |at: At| Asked {
        at,
        normal: setting.plane.normal(),
        cases: setting.cases.clone(),
        evaluation: None,
    };
    let one_of = "one of: y_mm with z_mm, joints_deg, xyz_mm, point";
    let numbers = [at.y_mm, at.z_mm].into_iter().flatten();
    let numbers = numbers.chain(at.xyz_mm.into_iter().flatten());
    let mut numbers = numbers.chain(at.joints_deg.iter().flatten().copied());
    if let Some(beyond) = numbers.find(|value| !value.is_finite() || value.abs() > LARGEST) {
        return Err(StudyError::value(
            format!("{beyond} is beyond {LARGEST:e}"),
            "is the unit right?",
        ));
    }
    match (at.y_mm, at.z_mm, &at.joints_deg, at.xyz_mm, at.point) {
        (Some(y), Some(z), None, None, None) => {
            // y' runs against x of the part.
            let in_part = Point2::new(-y * 1e-3, z * 1e-3);
            Ok(on_plane(At::Pose(setting.plane.base_from_tool(in_part, 0.0))))
        }
        (None, None, Some(joints), None, None) => Ok(on_plane(At::JointsDeg(joints.clone()))),
        (None, None, None, Some(xyz), None) => {
            let tcp = setting.base_from_reference * Point3::from(Vector3::from(xyz) * 1e-3);
            Ok(on_plane(At::Pose(held_at(setting, tcp))))
        }
        (None, None, None, None, Some(index)) => point((study, setting), index, done, watch),
        _ => Err(StudyError::value("the place is not told in one way", one_of)),
    }
}

/// No length (mm) or angle (deg) of a real cell is larger; beyond it a unit is wrong.
const LARGEST: f64 = 1e9;

/// The tool with its tip there (base), held as on the plane.
fn held_at(setting: &Setting, tcp: Point3<f64>) -> Isometry {
    Isometry::from_parts(
        tcp.coords.into(),
        tool_orientation(setting.plane.tool_axis(), 0.0),
    )
}

/// A point of a path, of holes or of a box.
fn point(
    (study, setting): (&Study, &Setting),
    index: usize,
    done: Option<&Done<'_>>,
    watch: Watch<'_>,
) -> Result<Asked, StudyError> {
    let within = |count: usize| match index < count {
        true => Ok(()),
        false => Err(StudyError::value(
            format!("there is no point {index}"),
            format!("they count from 0 to {}", count.saturating_sub(1)),
        )),
    };
    match study.analyses.first().map(|analysis| &analysis.subject) {
        Some(Subject::Path(path)) => {
            within(path.track.len())?;
            on_path((study, path), index, done, watch)
        }
        Some(Subject::Holes(holes)) => {
            within(holes.path.track.len())?;
            at_hole((study, holes), index, done, watch)
        }
        Some(Subject::Volume(_, grid)) => {
            within(grid.len())?;
            Ok(Asked {
                at: At::Pose(held_at(setting, grid.point(index))),
                normal: setting.plane.normal(),
                cases: setting.cases.clone(),
                evaluation: None,
            })
        }
        _ => Err(StudyError::value(
            "points of a map are told by y_mm and z_mm",
            "such as {\"y_mm\": 0, \"z_mm\": 0}",
        )),
    }
}

/// The deviation of this posture under each case; beside paths, and of another one than the path's, as a point by itself has it.
fn deviations(
    robot: &Robot,
    setting: &Setting,
    (q, branch): (&[f64], &str),
    requested: &Asked,
) -> Vec<Option<CaseAnswer>> {
    let (cases, normal) = (&requested.cases, requested.normal);
    let Some(compliance) = robot.compliance() else {
        return vec![None; cases.len()];
    };
    let dragged = requested.evaluation.as_ref().and_then(|evaluation| evaluation.dragged_in(q));
    let arm = Arm {
        robot,
        compliance,
        model: &setting.model,
        flange_from_tool: &setting.flange_from_tool,
    };
    let mut arm_state = ArmState::new(arm);
    arm_state.set_joints(q);
    let mut positions = vec![0.0; q.len()];
    let yields = by_force(&setting.compliance_at(robot, q));
    let any = permissible_force_in_worst_direction(&yields, normal, setting.limit).0;
    let mut of = |wrench: &Wrench| {
        let mut links = match dragged {
            Some(dragged) => Links::KeptByFriction(dragged),
            None => Links::Farthest(both_across(&normal), &mut positions),
        };
        let moved = predict(&mut arm_state, wrench, &mut links).ok()?.twist.linear;
        let split = Split::of(&moved, normal);
        let question = Question {
            arm,
            home: Some(q),
            cases: std::slice::from_ref(wrench),
            uncertainty: setting.uncertainty,
            normal,
            choice: BranchChoice::Best,
        };
        let (u, shares) = in_plane_parts(&question, (q, branch), dragged).unzip();
        // A case that is a moment alone has no direction.
        let along =
            Unit::try_new(wrench.force, 1e-12).map(|f| permissible_force(&yields, normal, f, setting.limit));
        Some(CaseAnswer {
            in_plane_um: split.in_plane * 1e6,
            in_plane_u_um: u,
            normal_um: split.normal * 1e6,
            full_um: split.full * 1e6,
            deviation_um: (moved * 1e6).into(),
            share_um: shares,
            permissible_along_load_n: along.filter(|n| n.is_finite()),
            permissible_any_direction_n: Some(any).filter(|n| n.is_finite()),
        })
    };
    cases.iter().map(&mut of).collect()
}

/// Positions (rad, m) that are the same posture, whatever was computed on the way there.
const SAME_POSTURE: f64 = 1e-6;

/// Whether these positions (rad, m) are the same posture.
pub(super) fn is_same(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < SAME_POSTURE)
}

/// Standard uncertainty (um) of the in-plane deviation and the shares in it, as a map tells them, of the posture `q` of this
/// name; none where the arm cannot be asked for it by name. On a path it is known where links were `dragged` in their gaps.
fn in_plane_parts(
    question: &Question<'_>,
    (q, branch): (&[f64], &str),
    dragged: Option<&[f64]>,
) -> Option<(f64, Vec<f64>)> {
    let arm = &question.arm;
    let question = Question {
        choice: BranchChoice::Of(branch.parse().ok()?),
        ..*question
    };
    let base_from_tool = tool_on(&forward(arm.robot, q), arm.flange_from_tool);
    let answers = match dragged {
        Some(dragged) => evaluate_on_path(&question, &base_from_tool, dragged),
        None => evaluate(&question, 1, |_| base_from_tool, Watch::NONE).ok()?,
    };
    let evaluation = answers.points[0].as_ref().ok()?;
    let shares = answers.shares_at(0).iter().map(|share| share * 1e6).collect();
    is_same(answers.joints_at(0), q).then_some((evaluation.in_plane_uncertainty * 1e6, shares))
}

/// The arm at these joint positions (rad, m).
fn drawn(robot: &Robot, q: &[f64], flange_from_tool: &Isometry) -> DrawnPosture {
    let stands = arm_posture(robot, q, flange_from_tool);
    let frames = forward(robot, q);
    let clean = |v: Vector3<f64>| -> [f64; 3] { v.map(without_rounding).into() };
    let joint = |i: usize| DrawnJoint {
        name: robot.joints()[i].name.clone(),
        origin_mm: stands.joints[i].origin_mm,
        axis: clean(joint_axis(robot, &frames, i)),
        kind: if robot.slides(i) { "slides" } else { "turns" },
    };
    let origins = stands.joints.iter().map(|joint| joint.origin_mm);
    let links = std::iter::once(stands.base_mm)
        .chain(origins)
        .chain([stands.flange_mm, stands.tool_mm]);
    DrawnPosture {
        joints: (0..robot.joints().len()).map(joint).collect(),
        flange_mm: stands.flange_mm,
        tool_mm: stands.tool_mm,
        tool_axis: clean(tool_on(&frames, flange_from_tool) * Vector3::z()),
        links_mm: links.collect(),
        meshes: Vec::new(),
    }
}

/// These joint positions (rad, m) as the chain counts them.
fn as_chain(robot: &Robot, q: &[f64]) -> Vec<ChainPosition> {
    let of = |i: usize| {
        let scale = JointUnit::of(robot, i).scale;
        let mut other = q.to_vec();
        let mut given = |value: f64| {
            other[i] = value;
            without_rounding(robot.theta(i, &other) * scale)
        };
        let limits = robot.joints()[i].limits;
        // A joint of negative sign counts from its upper limit up.
        let ends = limits.map(|limits| [given(limits.lower), given(limits.upper)]);
        ChainPosition {
            at_deg: given(q[i]),
            lower_deg: ends.map(|[a, b]| a.min(b)),
            upper_deg: ends.map(|[a, b]| a.max(b)),
        }
    };
    (0..robot.joints().len()).map(of).collect()
}

/// Limits of every joint.
fn limits(robot: &Robot) -> Vec<JointLimits> {
    let of = |(i, joint): (usize, &armill_core::robot::Joint)| {
        let unit = JointUnit::of(robot, i);
        let given = |value: f64| without_rounding(value * unit.scale);
        JointLimits {
            name: joint.name.clone(),
            lower_deg: joint.limits.map(|limits| given(limits.lower)),
            upper_deg: joint.limits.map(|limits| given(limits.upper)),
            unit: unit.name,
        }
    };
    robot.joints().iter().enumerate().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chain_counts_by_sign_zero_and_coupling_and_back() {
        // The FANUC counts its second joint in with the third.
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

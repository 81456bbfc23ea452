//! Holes in the answer: the deviation of each from its nominal position, its posture, worst first.
//!
//! | axis of a hole | direction |
//! |---|---|
//! | depth | out of the part: positive is too shallow; negative too deep |
//! | x | x of the part, projected into the plane of the hole (y of the part if the hole is along x) |
//! | y | to the left of x, seen from outside |
//!
//! A deviation is that of the load case with the largest deviation across the hole.

use armill_core::frame::{Isometry, any_perpendicular};
use armill_core::kernel::{Evaluation, PostureStatus};
use armill_core::map::Counts;
use armill_core::nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use armill_core::optimize::HolesFound;
use armill_core::robot::jacobian::wrist_bend;
use armill_core::robot::{Robot, Unreachable};
use armill_core::units::{to_deg, to_mm, to_um};
use armill_core::workpiece::Plane;
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::clearance::LeastClearance;
use crate::analysis::holes::HolesAnalysis;
use crate::analysis::map::answer::CountsAnswer;
use crate::analysis::path::PathSource;
use crate::analysis::point::{PointAnswer, ReachedPoint, SettingAnswer};
use crate::analysis::rows::state;
use crate::input::setting::Setting;
use crate::joint_order::shown_positions;
use crate::number::without_rounding;

/// A set of holes.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct HolesAnswer {
    /// Its name.
    pub name: String,
    /// Permitted branches: words, or `best`.
    pub branch: String,
    /// How many holes.
    pub holes: usize,
    /// Holes without posture inside joint limits.
    pub unreachable: usize,
    /// Least distance of two bodies at any hole, 0 where they touch; none without bodies.
    pub least_clearance_mm: Option<f64>,
    /// The two bodies.
    pub nearest: Option<[String; 2]>,
    /// Holes by reason, those of `refused` left out; their sum and `refused` are the total.
    pub counts: CountsAnswer,
    /// Holes without a usable spin and branch, clear of singularities and inside joint limits; they are evaluated in a
    /// rejected posture.
    pub refused: usize,
    /// Holes within the tolerance in a usable posture, over all holes.
    pub fraction_within: f64,
    /// Mean deviation across the hole, of those that can be drilled; of those that are reached if none can.
    pub mean_in_plane_um: Option<f64>,
    /// Largest deviation across the hole, of the same holes.
    pub max_in_plane_um: Option<f64>,
    /// Largest deviation along the hole, by size, of all cases and of the same holes.
    pub max_depth_um: Option<f64>,
    /// Spins that were tried at each hole.
    pub turns: usize,
    /// The common setting of all holes.
    pub setting: SettingAnswer,
    /// File of the holes; none if the study lists them.
    pub file: Option<String>,
    /// Material that is drilled, if thrust and torque were computed from it.
    pub material: Option<String>,
    /// Largest thrust, if computed.
    pub largest_thrust_n: Option<f64>,
    /// Of the same holes those with the largest deviation, with contributions; at most five.
    pub worst_holes: Vec<WorstHole>,
    /// Every hole: first those that are not reached, then the largest deviation first.
    pub each: Vec<HoleAnswer>,
    /// What was skipped or assumed.
    pub notes: Vec<String>,
}

/// A hole with a large deviation.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct WorstHole {
    /// Its number, from 1.
    pub hole: usize,
    /// The point.
    pub point: PointAnswer,
}

/// One hole.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct HoleAnswer {
    /// Its number in the order given, from 1.
    pub hole: usize,
    /// Line of its file, or its number in the list.
    pub line: u32,
    /// Position of the tip at its end, in the reference frame.
    pub xyz_mm: [f64; 3],
    /// Out of the part, base axes.
    pub normal_axis: [f64; 3],
    /// `within`, `above_tolerance`, or why it cannot be drilled.
    pub state: &'static str,
    /// Why there is no posture, in words; none if there is one.
    pub reason: Option<String>,
    /// Why the reported posture is rejected, if no spin and branch is usable: `singular`, `outside_joint_limits`; none
    /// otherwise.
    pub blocked_by: Option<&'static str>,
    /// Branch of the posture.
    pub branch: Option<String>,
    /// Spin of the tool about its axis, relative to its nominal one.
    pub turn_deg: Option<f64>,
    /// Deviation along x of the hole.
    pub x_um: Option<f64>,
    /// Along its y.
    pub y_um: Option<f64>,
    /// Out of the part: too shallow.
    pub depth_um: Option<f64>,
    /// Across the hole.
    pub in_plane_um: Option<f64>,
    /// Its standard uncertainty.
    pub in_plane_u_um: Option<f64>,
    /// Joint positions (mm for prismatic joints).
    pub joints_deg: Vec<f64>,
    /// Least distance of a joint to its limit (mm for a prismatic joint).
    pub limit_margin_deg: Option<f64>,
    /// Which joint that is.
    pub limit_joint: Option<String>,
    /// Angle between axes 4 and 6.
    pub wrist_bend_deg: Option<f64>,
    /// Near which singularity.
    pub singularity: Option<String>,
}

/// Number of worst holes that are reported.
const WORST: usize = 5;

/// The result of the holes of the analysis called `name`.
pub fn answer(robot: &Robot, name: &str, analysis: &HolesAnalysis, found: &HolesFound) -> HolesAnswer {
    let (path, answers) = (&analysis.path, &found.answers);
    let setting = &path.setting;
    let reached = answers.evaluations().count();
    let counts = counts(found, setting.tolerance);
    let count = answers.points.len();
    let mut order: Vec<usize> = (0..count).collect();
    let key = |index: usize| {
        answers.points[index]
            .as_ref()
            .map_or(f64::INFINITY, |evaluation| evaluation.in_plane)
    };
    order.sort_by(|a, b| key(*b).total_cmp(&key(*a)));
    let decisive = decisive(found);
    let across = || decisive.iter().map(|(_, evaluation)| to_um(evaluation.in_plane));
    let depths = decisive
        .iter()
        .map(|(_, evaluation)| to_um(evaluation.normal.abs()));
    let mut worst: Vec<usize> = decisive.iter().map(|(index, _)| *index).collect();
    worst.sort_by(|a, b| key(*b).total_cmp(&key(*a)));
    let source = match &path.source {
        PathSource::Program { file, .. } => Some(file.clone()),
        PathSource::Holes { file } => file.clone(),
        PathSource::Shape(_) => None,
    };
    let clearance = LeastClearance::of(setting, answers);
    HolesAnswer {
        name: name.to_owned(),
        branch: analysis.branch(),
        holes: count,
        unreachable: count - reached,
        least_clearance_mm: clearance.as_ref().map(|least| least.distance_mm),
        nearest: clearance.map(|least| least.bodies),
        refused: reached - counts.within - counts.above_tolerance,
        fraction_within: counts.within as f64 / count.max(1) as f64,
        counts,
        mean_in_plane_um: (!decisive.is_empty()).then(|| across().sum::<f64>() / decisive.len() as f64),
        max_in_plane_um: across().max_by(f64::total_cmp),
        max_depth_um: depths.max_by(f64::total_cmp),
        turns: analysis.search.spins.count,
        setting: SettingAnswer::of(robot, setting),
        file: source,
        material: path.drill.as_ref().map(|drill| drill.material.name.clone()),
        largest_thrust_n: path
            .drill
            .as_ref()
            .and(path.forces)
            .map(|given| given.largest_mean),
        worst_holes: worst
            .iter()
            .take(WORST)
            .filter_map(|index| worst_hole(robot, analysis, found, *index))
            .collect(),
        each: order
            .iter()
            .map(|index| hole(robot, analysis, found, *index))
            .collect(),
        notes: notes(analysis),
    }
}

/// Holes by reason for this `limit` (m), the tolerance; a refused hole is none of them, whatever it deviates by.
fn counts(found: &HolesFound, limit: f64) -> CountsAnswer {
    let mut counts = CountsAnswer::of(&Counts::of(&found.answers, limit));
    for (_, evaluation) in found
        .answers
        .evaluations()
        .filter(|(index, _)| is_refused(found, *index))
    {
        if evaluation.in_plane <= limit {
            counts.within -= 1;
        } else {
            counts.above_tolerance -= 1;
        }
    }
    counts
}

/// Whether every posture of hole `index` is rejected: its answer is that of a rejected one.
pub fn is_refused(found: &HolesFound, index: usize) -> bool {
    let status = found.statuses.get(index);
    status.is_some_and(|status| *status != PostureStatus::Usable)
}

/// The holes that decide, with their indices: those that can be drilled; if none can, all that are reached.
pub fn decisive(found: &HolesFound) -> Vec<(usize, &Evaluation)> {
    let reached = || found.answers.evaluations();
    let drilled: Vec<_> = reached()
        .filter(|(index, _)| !is_refused(found, *index))
        .collect();
    if drilled.is_empty() {
        reached().collect()
    } else {
        drilled
    }
}

/// Axes of hole `index`, base: x and y across it, z out of the part.
pub(crate) fn base_from_hole(analysis: &HolesAnalysis, index: usize) -> Rotation3<f64> {
    let z = analysis.path.track.stop(index).normal.into_inner();
    let part = &analysis.path.track.base_from_part;
    let across = |axis: Vector3<f64>| projected_across(part * axis, &z);
    let x = across(Vector3::x())
        .or_else(|| across(Vector3::y()))
        .unwrap_or_else(|| any_perpendicular(&z));
    Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, z.cross(&x), z]))
}

/// Below this sine of the angle between an axis of the part and the hole the axis has no direction across it.
const ALONG: f64 = 1e-3;

/// The projection of an axis across `z`, of length 1; `None` if it is parallel to `z`.
fn projected_across(axis: Vector3<f64>, z: &Vector3<f64>) -> Option<Vector3<f64>> {
    (axis - z * axis.dot(z)).try_normalize(ALONG)
}

/// The deviation of the worst case at hole `index` in its axes, m.
pub(crate) fn error(
    analysis: &HolesAnalysis,
    found: &HolesFound,
    index: usize,
    evaluation: &Evaluation,
) -> Vector3<f64> {
    let deviation = found.answers.deviations_at(index)[evaluation.worst_case];
    base_from_hole(analysis, index).inverse() * deviation
}

fn hole(robot: &Robot, analysis: &HolesAnalysis, found: &HolesFound, index: usize) -> HoleAnswer {
    let (path, answers) = (&analysis.path, &found.answers);
    let setting = &path.setting;
    let stop = path.track.stop(index);
    let point = &answers.points[index];
    let evaluation = point.as_ref().ok();
    let error = evaluation.map(|evaluation| to_um(error(analysis, found, index, evaluation)));
    let tip = setting.in_reference(&stop.base_from_tool.translation.vector.into());
    let scale = |joint: usize| {
        if robot.slides(joint) { 1e3 } else { to_deg(1f64) }
    };
    let joints = answers.joints_at(index);
    HoleAnswer {
        hole: index + 1,
        line: path.track.path.points[index].line,
        xyz_mm: tip.coords.map(|c| without_rounding(to_mm(c))).into(),
        normal_axis: stop.normal.into_inner().map(without_rounding).into(),
        state: state(point, found.statuses.get(index).copied(), setting.tolerance),
        reason: point.as_ref().err().map(|miss| {
            let most = match found.statuses[index] {
                PostureStatus::OutOfReach | PostureStatus::Usable => String::new(),
                other => format!("; with other spins mostly {}", other.word().replace('_', " ")),
            };
            let bodies = match (miss, &setting.cell) {
                (Unreachable::InCollision { bodies, .. }, Some(placed)) => {
                    let [first, second] = bodies.map(|body| placed.cell.name(body));
                    format!(" ({first} and {second})")
                }
                _ => String::new(),
            };
            format!("{miss}{bodies}{most}")
        }),
        blocked_by: evaluation
            .and(found.statuses.get(index))
            .filter(|status| **status != PostureStatus::Usable)
            .map(|status| status.word()),
        branch: evaluation.map(|evaluation| evaluation.name.to_string()),
        turn_deg: evaluation.map(|_| without_rounding(to_deg(found.spins[index]))),
        x_um: error.map(|error| error.x),
        y_um: error.map(|error| error.y),
        depth_um: error.map(|error| error.z),
        in_plane_um: evaluation.map(|evaluation| to_um(evaluation.in_plane)),
        in_plane_u_um: evaluation.and_then(|evaluation| evaluation.in_plane_uncertainty.map(to_um)),
        joints_deg: match evaluation {
            Some(_) => shown_positions(robot, joints),
            None => Vec::new(),
        },
        limit_margin_deg: evaluation
            .map(|evaluation| evaluation.limit_margin * scale(evaluation.limit_joint))
            .filter(|margin| margin.is_finite()),
        limit_joint: evaluation
            .filter(|evaluation| evaluation.limit_margin.is_finite())
            .map(|evaluation| robot.joints()[evaluation.limit_joint].name.clone()),
        wrist_bend_deg: evaluation.and_then(|_| wrist_bend(robot, joints)).map(to_deg),
        singularity: evaluation
            .and_then(|evaluation| evaluation.singularity)
            .map(|s| s.to_string()),
    }
}

/// A hole with shares, on a plane across it.
fn worst_hole(
    robot: &Robot,
    analysis: &HolesAnalysis,
    found: &HolesFound,
    index: usize,
) -> Option<WorstHole> {
    let evaluation = found.answers.points[index].as_ref().ok()?;
    let path = &analysis.path;
    let here = path.track.loaded_stop(index, &path.load);
    let tip = here.stop.base_from_tool.translation;
    let turn = UnitQuaternion::from_rotation_matrix(&base_from_hole(analysis, index));
    let setting = Setting {
        plane: Plane {
            base_from_part: Isometry::from_parts(tip, turn),
        },
        tilt: None,
        cases: here.cases,
        ..path.setting.clone()
    };
    let tcp = tip.vector.into();
    let reached = ReachedPoint {
        answers: &found.answers,
        index,
        evaluation,
        tcp,
    };
    Some(WorstHole {
        hole: index + 1,
        point: PointAnswer {
            in_plane_mm: PointAnswer::in_plane_mm(&path.setting.plane, &tcp),
            ..PointAnswer::of(robot, &setting, &reached)
        },
    })
}

/// What was skipped in the program, and what the drill lacks.
fn notes(analysis: &HolesAnalysis) -> Vec<String> {
    let mut notes = match &analysis.path.source {
        PathSource::Program { summary, .. } => summary.notes.clone(),
        _ => Vec::new(),
    };
    notes.extend(analysis.path.drill.iter().flat_map(|drill| drill.remarks.clone()));
    notes
}

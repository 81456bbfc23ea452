//! Holes in the answer: how far each comes out from where it is drawn, in which posture, worst first.
//!
//! | axis of a hole | direction |
//! |---|---|
//! | depth | out of the part: the tool stands off, the hole is too shallow; negative too deep |
//! | x | x of the part, laid into the plane of the hole (y of the part where the hole goes along x) |
//! | y | to the left of x, seen from outside |
//!
//! A deviation is that of the load case with the largest deviation across the hole.

use armill_core::frame::{Isometry, some_across};
use armill_core::kernel::{Held, Stand};
use armill_core::map::Counts;
use armill_core::nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use armill_core::optimize::HolesFound;
use armill_core::robot::jacobian::wrist_bend;
use armill_core::workpiece::Plane;
use schemars::JsonSchema;
use serde::Serialize;

use super::map::CountsAnswer;
use super::point::{PointAnswer, SettingAnswer};
use crate::file::holes::HolesAnalysis;
use crate::file::path::PathSource;
use crate::file::resolve::{Setting, Study};
use crate::number::without_rounding;

/// A set of holes.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct HolesAnswer {
    /// Its name.
    pub name: String,
    /// Branches that were open: words, or `best`.
    pub branch: String,
    /// How many holes.
    pub holes: usize,
    /// Holes without posture inside joint limits.
    pub unreachable: usize,
    /// Holes by reason; they add up to all.
    pub counts: CountsAnswer,
    /// Holes that no turn and branch holds clear of singularities and inside joint limits; they are told in a posture that
    /// is refused.
    pub refused: usize,
    /// Holes within the limit in a posture that is not refused, over all holes.
    pub fraction_within: f64,
    /// Mean deviation across the hole, of those that are reached.
    pub mean_in_plane_um: Option<f64>,
    /// Largest deviation across the hole.
    pub max_in_plane_um: Option<f64>,
    /// Largest deviation along the hole, by size, of all cases.
    pub max_depth_um: Option<f64>,
    /// Turns that were tried at each hole.
    pub turns: usize,
    /// What all holes share.
    pub setting: SettingAnswer,
    /// File of the holes; none where the study lists them.
    pub file: Option<String>,
    /// Material that is drilled, where thrust and torque were computed from it.
    pub material: Option<String>,
    /// Largest thrust, likewise.
    pub largest_thrust_n: Option<f64>,
    /// Where the deviation is largest, and whose share that is; at most five.
    pub worst_holes: Vec<WorstHole>,
    /// Every hole: first those that are not reached, then the largest deviation first.
    pub each: Vec<HoleAnswer>,
    /// What was passed over, or taken for granted.
    pub notes: Vec<String>,
}

/// A hole where the deviation is large.
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
    /// Where the tip stands at its end, in the frame that positions count from.
    pub xyz_mm: [f64; 3],
    /// Out of the part, base axes.
    pub normal_axis: [f64; 3],
    /// `within`, `above_tolerance`, or why there is no posture.
    pub state: &'static str,
    /// Why no posture stands, in words; none where one does.
    pub reason: Option<String>,
    /// What is against the posture that is told where no turn and branch stands: `singular`, `outside_joint_limits`; none
    /// where one does.
    pub blocked_by: Option<&'static str>,
    /// Branch of the posture.
    pub branch: Option<String>,
    /// Turn of the tool about its axis, beside the one that it has unturned.
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
    /// Joint positions (mm for sliding joints).
    pub joints_deg: Vec<f64>,
    /// Least distance of a joint to its limit (mm for a sliding joint).
    pub limit_margin_deg: Option<f64>,
    /// Which joint that is.
    pub limit_joint: Option<String>,
    /// Angle between axes 4 and 6.
    pub wrist_bend_deg: Option<f64>,
    /// Near which singularity.
    pub singularity: Option<String>,
}

/// Holes told as worst.
const WORST: usize = 5;

/// What became of the holes that the ask called `name` asks for.
pub(super) fn answer(study: &Study, name: &str, analysis: &HolesAnalysis, found: &HolesFound) -> HolesAnswer {
    let (path, answers) = (&analysis.path, &found.answers);
    let setting = &path.setting;
    let counts = Counts::of(answers, setting.limit);
    let evaluation: Vec<(usize, &Held)> = answers.evaluation().collect();
    let count = answers.points.len();
    let mut order: Vec<usize> = (0..count).collect();
    let key = |index: usize| {
        answers.points[index]
            .as_ref()
            .map_or(f64::INFINITY, |evaluation| evaluation.in_plane)
    };
    order.sort_by(|a, b| key(*b).total_cmp(&key(*a)));
    let worst = order.iter().filter(|index| answers.points[**index].is_ok());
    let is_refused = |index: usize| {
        found
            .stands
            .get(index)
            .is_some_and(|stand| *stand != Stand::Holds)
    };
    let good = evaluation
        .iter()
        .filter(|(index, evaluation)| evaluation.in_plane <= setting.limit && !is_refused(*index))
        .count();
    let source = match &path.source {
        PathSource::Program { file, .. } => Some(file.clone()),
        PathSource::Holes { file } => file.clone(),
        PathSource::Shape(_) => None,
    };
    let mean = evaluation.iter().map(|(_, evaluation)| evaluation.in_plane).sum::<f64>() / evaluation.len().max(1) as f64;
    HolesAnswer {
        name: name.to_owned(),
        branch: analysis.branch(),
        holes: count,
        unreachable: count - evaluation.len(),
        refused: evaluation.iter().filter(|(index, _)| is_refused(*index)).count(),
        fraction_within: good as f64 / count.max(1) as f64,
        counts: CountsAnswer::of(&counts),
        mean_in_plane_um: (!evaluation.is_empty()).then_some(mean * 1e6),
        max_in_plane_um: answers.worst().map(|(_, evaluation)| evaluation.in_plane * 1e6),
        max_depth_um: evaluation
            .iter()
            .map(|(_, evaluation)| evaluation.normal.abs() * 1e6)
            .max_by(f64::total_cmp),
        turns: analysis.search.spins.count,
        setting: SettingAnswer::of(study, setting),
        file: source,
        material: path.drill.as_ref().map(|drill| drill.material.name.clone()),
        largest_thrust_n: path.drill.as_ref().and(path.forces).map(|given| given.largest_mean),
        worst_holes: worst
            .take(WORST)
            .filter_map(|index| worst_hole(study, analysis, found, *index))
            .collect(),
        each: order
            .iter()
            .map(|index| hole(study, (analysis, found), *index))
            .collect(),
        notes: notes(analysis),
    }
}

/// Axes of hole `index`, base: x and y across it, z out of the part.
pub(crate) fn base_from_hole(analysis: &HolesAnalysis, index: usize) -> Rotation3<f64> {
    let z = analysis.path.track.stop(index).normal.into_inner();
    let part = &analysis.path.track.base_from_part;
    let across = |axis: Vector3<f64>| laid_across(part * axis, &z);
    let x = across(Vector3::x())
        .or_else(|| across(Vector3::y()))
        .unwrap_or_else(|| some_across(&z));
    Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, z.cross(&x), z]))
}

/// Below this sine of the angle between an axis of the part and the hole the axis has no direction across it.
const ALONG: f64 = 1e-3;

/// The part of an axis across `z`, of length 1; `None` where it goes along.
fn laid_across(axis: Vector3<f64>, z: &Vector3<f64>) -> Option<Vector3<f64>> {
    (axis - z * axis.dot(z)).try_normalize(ALONG)
}

/// The deviation of the deciding case at hole `index` in its axes, m.
pub(crate) fn error(analysis: &HolesAnalysis, found: &HolesFound, (index, evaluation): (usize, &Held)) -> Vector3<f64> {
    let deviation = found.answers.deviations_at(index)[evaluation.deciding_case];
    base_from_hole(analysis, index).inverse() * deviation
}

fn hole(study: &Study, (analysis, found): (&HolesAnalysis, &HolesFound), index: usize) -> HoleAnswer {
    let (path, answers) = (&analysis.path, &found.answers);
    let (setting, robot) = (&path.setting, &study.robot.robot);
    let stop = path.track.stop(index);
    let point = &answers.points[index];
    let evaluation = point.as_ref().ok();
    let error = evaluation.map(|evaluation| error(analysis, found, (index, evaluation)) * 1e6);
    let tip = setting.counted(&stop.base_from_tool.translation.vector.into());
    let scale = |joint: usize| {
        if robot.slides(joint) {
            1e3
        } else {
            1f64.to_degrees()
        }
    };
    let joints = answers.joints_at(index);
    HoleAnswer {
        hole: index + 1,
        line: path.track.path.points[index].line,
        xyz_mm: tip.coords.map(|c| without_rounding(c * 1e3)).into(),
        normal_axis: stop.normal.into_inner().map(without_rounding).into(),
        state: match point {
            Ok(evaluation) if evaluation.in_plane <= setting.limit => "within",
            Ok(_) => "above_tolerance",
            Err(miss) => miss.word(),
        },
        reason: point.as_ref().err().map(|miss| {
            let most = match found.stands[index] {
                Stand::OutOfReach | Stand::Holds => String::new(),
                other => format!("; with other turns mostly {}", other.word().replace('_', " ")),
            };
            format!("{miss}{most}")
        }),
        blocked_by: evaluation
            .and(found.stands.get(index))
            .filter(|stand| **stand != Stand::Holds)
            .map(|stand| stand.word()),
        branch: evaluation.map(|evaluation| evaluation.name.to_string()),
        turn_deg: evaluation.map(|_| without_rounding(found.spins[index].to_degrees())),
        x_um: error.map(|error| error.x),
        y_um: error.map(|error| error.y),
        depth_um: error.map(|error| error.z),
        in_plane_um: evaluation.map(|evaluation| evaluation.in_plane * 1e6),
        in_plane_u_um: evaluation.map(|evaluation| evaluation.in_plane_uncertainty * 1e6),
        joints_deg: match evaluation {
            Some(_) => joints.iter().enumerate().map(|(i, q)| q * scale(i)).collect(),
            None => Vec::new(),
        },
        limit_margin_deg: evaluation
            .map(|evaluation| evaluation.limit_margin * scale(evaluation.limit_joint))
            .filter(|margin| margin.is_finite()),
        limit_joint: evaluation
            .filter(|evaluation| evaluation.limit_margin.is_finite())
            .map(|evaluation| robot.joints()[evaluation.limit_joint].name.clone()),
        wrist_bend_deg: evaluation.and_then(|_| wrist_bend(robot, joints)).map(f64::to_degrees),
        singularity: evaluation.and_then(|evaluation| evaluation.singularity).map(|s| s.to_string()),
    }
}

/// A hole with shares, on a plane across it.
fn worst_hole(study: &Study, analysis: &HolesAnalysis, found: &HolesFound, index: usize) -> Option<WorstHole> {
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
    let at = tip.vector.into();
    Some(WorstHole {
        hole: index + 1,
        point: PointAnswer {
            in_plane_mm: PointAnswer::in_plane_mm(&path.setting.plane, &at),
            ..PointAnswer::of(study, &setting, &found.answers, (index, evaluation, at))
        },
    })
}

/// What was passed over in the program, and what is not in the drill.
fn notes(analysis: &HolesAnalysis) -> Vec<String> {
    let mut notes = match &analysis.path.source {
        PathSource::Program { summary, .. } => summary.notes.clone(),
        _ => Vec::new(),
    };
    notes.extend(analysis.path.drill.iter().flat_map(|drill| drill.remarks.clone()));
    notes
}

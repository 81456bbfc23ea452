//! The map of a path over its length and the spin of the tool, and the spins that a search finds.
//!
//! Rows are constant spins: the spin of the placing (`spin_deg`, `program.spin_deg`) is in them, a curve is not. A cell is
//! the answer of the path at that spin, rounded as in its table.

use armill_core::kernel::AT_LIMIT;
use armill_core::map::{ObstacleKind, SpinCell, spin_map as map_of};
use armill_core::optimize::{PostureSearch, Steps};
use armill_core::path::{LoadedTrack, SpinCurve, Track};
use armill_core::robot::Robot;
use armill_core::units::{from_deg, to_deg, to_mm, to_um};
use armill_core::watch::Watch;
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::path::PathAnalysis;
use crate::analysis::path::answer::search::{component_name, objective_name};
use crate::analysis::runner::Runner;
use crate::analysis::{Subject, quantity};
use crate::error::StudyError;
use crate::input::posture_search::SearchTable;
use crate::joint_order::{joint_names, joint_order};
use crate::joint_unit::JointUnit;
use crate::live::scale::levels_around;
use crate::live::{EditedAnalysis, StudyText};
use crate::number::{decimals, without_rounding};

/// Columns of a map at most.
const COLUMNS: usize = 400;
/// Rows of a map at most: all spins 5 deg apart.
const ROWS: usize = 73;
/// Deviations beyond this many times the tolerance have one colour, as in the picture of a search.
const MOST_TOLERANCES: f64 = 4.0;
/// States in which a posture is not usable: outside joint limits, singular, out of reach, in collision.
const BLOCKED: u8 = 1 + 2 + 4 + 32;
/// A curve through spins that were found is at most this far from them, deg; farther where it would have too many knots.
const NEAR_DEG: f64 = 1.0;
/// Knots of such a curve at most.
const MOST_KNOTS: usize = 200;

/// The deviation of a path over its length and the spin of the tool.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SpinMapAnswer {
    /// Name of the analysis.
    pub analysis: String,
    /// Length of the path.
    pub length_mm: f64,
    /// Indices of the points of the columns.
    pub points: Vec<usize>,
    /// Distance along the path of each column.
    pub distance_mm: Vec<f64>,
    /// Spin of each row, ascending.
    pub spins_deg: Vec<f64>,
    /// In-plane deviation, row after row; `null` where the point is out of reach.
    pub in_plane_um: Vec<Vec<Option<f64>>>,
    /// Smallest distance of a joint from its limits (mm of a prismatic one), row after row; negative outside.
    pub limit_margin_deg: Vec<Vec<Option<f64>>>,
    /// The joint of this distance: its index among the names.
    pub limit_joint: Vec<Vec<u8>>,
    /// State of each cell, row after row: sum of 1 (outside joint limits), 2 (singular), 4 (out of reach), 8 (a joint jumps
    /// since the column before), 16 (a joint is too slow for the feed since the column before), 32 (no posture keeps the demanded
    /// clearance).
    pub state: Vec<Vec<u8>>,
    /// The joint that jumps or is too slow: its index among the names; 0 for other cells.
    pub move_joint: Vec<Vec<u8>>,
    /// Names of the joints.
    pub joint_names: Vec<String>,
    /// Levels of the colour scale for the cells inside limits and away from singularities, at most four times the
    /// tolerance; `null` if no point is reached.
    pub levels_um: Option<Vec<f64>>,
    /// The tolerance.
    pub tolerance_um: f64,
    /// Whether every point of the path was evaluated; otherwise those of the columns.
    pub is_complete: bool,
}

/// The spins along a path that a search finds.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SpinSearchAnswer {
    /// Name of the analysis.
    pub analysis: String,
    /// Indices of points, evenly spread.
    pub points: Vec<usize>,
    /// Distance along the path of each.
    pub distance_mm: Vec<f64>,
    /// Spin of each, as in the rows of the map; `null` where no spin is usable.
    pub spins_deg: Vec<Option<f64>>,
    /// A curve for the study that is near these spins, in addition to its constant spin.
    pub curve_mm_deg: Vec<[f64; 2]>,
    /// The branch, if it is the same on the whole path and has a name.
    pub branch: Option<String>,
    /// Largest in-plane deviation with these spins.
    pub max_in_plane_um: Option<f64>,
    /// Points of the path without a usable spin.
    pub unusable: usize,
    /// Points at which the arm has to stop and change its posture.
    pub breaks: Vec<usize>,
    /// Component of the deviation that was minimised: `in-plane`, `cross-track`, `axial`.
    pub component: &'static str,
    /// The objective: `worst`, `mean`, `above-tolerance`.
    pub objective: &'static str,
}

/// The map of this analysis, or of the first.
///
/// # Errors
/// Every problem of the text that concerns the analysis; no analysis of that name, or one that is no path; cancelled by
/// the watch.
pub fn spin_map(
    text: StudyText<'_>,
    analysis: Option<&str>,
    watch: Watch<'_>,
) -> Result<SpinMapAnswer, StudyError> {
    let edited = text.one_analysis(analysis)?;
    let path = path_of(&edited)?;
    let robot = &edited.study.robot.robot;
    let runner = Runner::new(robot, watch)?;
    let (load, _) = runner.pushed(path)?;
    let track = without_curve(path);
    let constant = track.placing.spin.angle();
    let spins = rows_of(path.setting.search.as_ref(), constant);
    let relative: Vec<f64> = spins.iter().map(|spin| from_deg(*spin) - constant).collect();
    let question = runner.question(&path.setting);
    let followed = LoadedTrack {
        track: &track,
        load: &load,
    };
    let map = map_of(&question, followed, &relative, COLUMNS, watch)?;
    let tolerance_um = to_um(path.setting.tolerance);
    // Cells that can be used have the scale; without any, those that are reached.
    let of = |usable: bool| {
        let cells = map
            .cells
            .iter()
            .filter(move |cell| !usable || state(cell) & BLOCKED == 0);
        cells.filter_map(|cell| Some(cell.evaluation?.in_plane))
    };
    let any = of(true).next().is_some();
    let range = of(any)
        .map(|um| [to_um(um); 2])
        .reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
    let rows = || map.cells.chunks(map.points.len().max(1));
    let order = joint_order(robot);
    let shown = |joint: usize| {
        order
            .iter()
            .position(|other| *other == joint)
            .unwrap_or(0)
            .min(255) as u8
    };
    let along = |index: &usize| without_rounding(to_mm(track.path.points[*index].along));
    Ok(SpinMapAnswer {
        length_mm: without_rounding(to_mm(path.length())),
        distance_mm: map.points.iter().map(along).collect(),
        spins_deg: spins,
        in_plane_um: rows().map(|row| row.iter().map(in_plane_um).collect()).collect(),
        limit_margin_deg: rows()
            .map(|row| row.iter().map(|cell| margin(robot, cell)).collect())
            .collect(),
        limit_joint: rows()
            .map(|row| row.iter().map(|cell| shown(limit_joint(cell))).collect())
            .collect(),
        state: rows().map(|row| row.iter().map(state).collect()).collect(),
        move_joint: rows()
            .map(|row| row.iter().map(|cell| shown(move_joint(cell))).collect())
            .collect(),
        joint_names: joint_names(robot),
        levels_um: range.map(|[least, largest]| {
            let largest = largest.min(least.max(MOST_TOLERANCES * tolerance_um));
            levels_around([least, largest], Some(tolerance_um))
        }),
        tolerance_um,
        is_complete: map.is_complete,
        analysis: edited.name.clone(),
        points: map.points,
    })
}

/// The spins that the search of the study finds for this analysis, or for the first; those of the default search, within
/// the branches that the study permits, if it has none.
///
/// # Errors
/// As of [`spin_map`].
pub fn spin_search(
    text: StudyText<'_>,
    analysis: Option<&str>,
    watch: Watch<'_>,
) -> Result<SpinSearchAnswer, StudyError> {
    let edited = text.one_analysis(analysis)?;
    let path = path_of(&edited)?;
    let runner = Runner::new(&edited.study.robot.robot, watch)?;
    let usual = || SearchTable::default().search(path.setting.tolerance, path.setting.open);
    let search = match path.setting.search.clone() {
        Some(search) => search,
        None => usual().map_err(|(message, hint)| StudyError::value(message, hint))?,
    };
    // The curve that is found holds spins alone.
    let search = PostureSearch {
        lean: None,
        axes: Vec::new(),
        ..search
    };
    let constant = PathAnalysis {
        track: without_curve(path),
        spin_curve: None,
        ..path.clone()
    };
    let (load, _) = runner.pushed(&constant)?;
    let found = runner.search(&constant, &load, &search)?;
    let (posture, along) = (found.posture, found.along);
    let track = &constant.track;
    let spin = track.placing.spin.angle();
    let count = track.len();
    let kept = count.min(COLUMNS);
    let points: Vec<usize> = (0..kept)
        .map(|column| column * (count - 1) / (kept - 1).max(1))
        .collect();
    let usable = |index: &usize| {
        let lost = &posture.unreachable;
        lost.binary_search_by_key(index, |(lost, _)| *lost).is_err()
    };
    let total = |index: &usize| decimals(to_deg(spin + posture.spins[*index]), 3);
    let mut apart = from_deg(NEAR_DEG);
    let mut near = SpinCurve::near(&track.path, &posture.spins, apart);
    while near
        .as_ref()
        .is_some_and(|curve| curve.knots().len() > MOST_KNOTS)
    {
        apart *= 2.0;
        near = SpinCurve::near(&track.path, &posture.spins, apart);
    }
    let knots = near.iter().flat_map(SpinCurve::knots);
    let mut branches = posture.branches.iter().flatten();
    let first = branches.next();
    Ok(SpinSearchAnswer {
        distance_mm: points
            .iter()
            .map(|index| without_rounding(to_mm(track.path.points[*index].along)))
            .collect(),
        spins_deg: points
            .iter()
            .map(|index| usable(index).then(|| total(index)))
            .collect(),
        curve_mm_deg: knots
            .map(|knot| [decimals(to_mm(knot.along), 3), decimals(to_deg(knot.spin), 1)])
            .collect(),
        branch: first
            .filter(|first| branches.all(|other| other == *first))
            .map(ToString::to_string),
        max_in_plane_um: along
            .answers
            .worst()
            .map(|(_, worst)| decimals(to_um(worst.in_plane), 3)),
        unusable: posture.unreachable.len(),
        breaks: posture.breaks,
        component: component_name(search.component),
        objective: objective_name(search.objective),
        analysis: edited.name.clone(),
        points,
    })
}

/// The path that is analysed.
fn path_of<'a>(edited: &'a EditedAnalysis<'_>) -> Result<&'a PathAnalysis, StudyError> {
    match edited.study.analyses.first().map(|analysis| &analysis.subject) {
        Some(Subject::Path(path)) => Ok(path),
        _ => Err(StudyError::value(
            format!("`{}` is no path", edited.name),
            "a map over path and spin needs an analysis of kind = \"path\"",
        )),
    }
}

/// The points of the path with the constant spin alone.
fn without_curve(path: &PathAnalysis) -> Track {
    Track {
        spins: None,
        homes: None,
        ..path.track.clone()
    }
}

/// The spins of the rows, deg: those of the search, at most [`ROWS`]; without a search a full turn.
fn rows_of(search: Option<&PostureSearch>, constant: f64) -> Vec<f64> {
    let [first, last] = match search {
        Some(PostureSearch {
            spins: spins @ Steps { first, count, .. },
            ..
        }) => {
            // The last spin of a full turn is its first, and is drawn too.
            let turn = from_deg(360.0);
            let end = spins.at(*count);
            let last = if end - first > turn - 1e-9 {
                end
            } else {
                spins.at(count - 1)
            };
            [first + constant, last + constant].map(to_deg)
        }
        None => [-180.0, 180.0],
    };
    let count = match search {
        Some(search) => (((last - first) / to_deg(search.spins.step)).round() as usize + 1).min(ROWS),
        None => ROWS,
    };
    let step = (last - first) / (count.max(2) - 1) as f64;
    (0..count)
        .map(|row| decimals(first + row as f64 * step, 6))
        .collect()
}

fn in_plane_um(cell: &SpinCell) -> Option<f64> {
    let decimal_places = i32::from(quantity::IN_PLANE.decimals);
    Some(decimals(to_um(cell.evaluation?.in_plane), decimal_places)).filter(|um| um.is_finite())
}

fn margin(robot: &Robot, cell: &SpinCell) -> Option<f64> {
    let evaluation = cell.evaluation?;
    let unit = JointUnit::of(robot, evaluation.limit_joint);
    Some(decimals(evaluation.limit_margin * unit.scale, 2)).filter(|margin| margin.is_finite())
}

fn limit_joint(cell: &SpinCell) -> usize {
    cell.evaluation.map_or(0, |evaluation| evaluation.limit_joint)
}

fn move_joint(cell: &SpinCell) -> usize {
    match cell.on_move {
        Some(ObstacleKind::Jump { joint, .. } | ObstacleKind::TooSlow { joint, .. }) => joint,
        _ => 0,
    }
}

fn state(cell: &SpinCell) -> u8 {
    let at_point = match &cell.evaluation {
        None if cell.in_collision => 32,
        None => 4,
        Some(evaluation) => {
            u8::from(evaluation.limit_margin < -AT_LIMIT) + 2 * u8::from(evaluation.singularity.is_some())
        }
    };
    at_point
        + match cell.on_move {
            Some(ObstacleKind::Jump { .. }) => 8,
            Some(ObstacleKind::TooSlow { .. }) => 16,
            _ => 0,
        }
}

//! The points of a path as columns of numbers: what a page draws of a path of any length, without text.
//!
//! | column | content |
//! |---|---|
//! | `xyz_mm`, `deviation_um` | the point, and its deviation under the worst case: x, y, z, base |
//! | `force_n` | size of the force on the tool of the worst case; of a cut as in the table |
//! | `time_s` | time of cutting before the point, without rapids, only if every cut has a feed; with `[motion]` that of the motion |
//! | `outside_joint_limits` | 1 for a posture outside joint limits, else 0 |
//! | `in_plane_um`, `limit_margin_deg`, `joint_NAME_deg`, ... | as in the table of the analysis, where it has them |
//! | `largest_share` | as the layer of that name |
//!
//! [`columns`] is the only list of them. Values are numbers of 4 bytes (24 bits of precision: 0.2 um at an arm's
//! length), NaN where a value is not known.

use std::ops::Range;

use armill_core::kernel::Evaluation;
use armill_core::nalgebra::Vector3;
use armill_core::path::{Clock, Speeds};
use armill_core::robot::Unreachable;
use armill_core::spatial::Wrench;
use armill_core::units::{to_mm, to_um};
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::columns::numbers_of;
use crate::analysis::path::PathAnalysis;
use crate::analysis::path::run::PathResult;
use crate::analysis::quantity;
use crate::analysis::rows::Rows;
use crate::analysis::{AnalysisData, AnalysisResult};
use crate::error::StudyError;
use crate::joint_order::joint_order;
use crate::joint_unit::JointUnit;
use crate::live::EditedAnalysis;
use crate::live::layer::LayerKey;
use crate::number::without_rounding;

/// A path whose points are requested as columns.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PathInView {
    /// Number of points.
    pub points: usize,
    /// Its columns.
    pub columns: Vec<PathColumnInView>,
    /// Its operations, in their order; those without a point are left out.
    pub operations: Vec<OperationInView>,
    /// The worst points of the answer, in its order.
    pub worst: Vec<usize>,
    /// Whether it has a machined part, whose surface can be requested.
    pub has_part: bool,
}

/// A column.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PathColumnInView {
    /// Its key.
    pub key: String,
    /// The unit of its values; `null` without one.
    pub unit: Option<String>,
    /// Values of each point: 1, or 3 of a vector.
    pub components: usize,
    /// The joint whose position it is; `null` of other columns.
    pub joint: Option<String>,
    /// Lower limit of the joint; `null` if it has none.
    // unit: as the column
    pub lower: Option<f64>,
    /// Upper limit of the joint; `null` if it has none.
    // unit: as the column
    pub upper: Option<f64>,
}

/// An operation of the program.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct OperationInView {
    /// Its first point.
    pub first: usize,
    /// Number of its points.
    pub points: usize,
    /// Name of the operation or its tool.
    pub name: Option<String>,
    /// Number of the tool.
    pub tool: Option<u32>,
    /// Line of the program where it begins.
    pub line: u32,
}

/// Appends the values of a range of points.
type Fill<'a> = Box<dyn Fn(Range<usize>, &mut Vec<f32>) + Send + Sync + 'a>;

/// A column with its values.
struct PathColumn<'a> {
    about: PathColumnInView,
    fill: Fill<'a>,
}

impl<'a> PathColumn<'a> {
    fn new(key: &str, unit: Option<&str>, fill: impl Fn(usize) -> f64 + Send + Sync + 'a) -> PathColumn<'a> {
        let fill: Fill<'a> =
            Box::new(move |points, values| values.extend(points.map(|index| fill(index) as f32)));
        PathColumn::filled(key, unit, fill)
    }

    fn vector(
        key: &str,
        unit: &str,
        fill: impl Fn(usize) -> Option<Vector3<f64>> + Send + Sync + 'a,
    ) -> PathColumn<'a> {
        let fill: Fill<'a> = Box::new(move |points, values| {
            for index in points {
                let v = fill(index).unwrap_or_else(|| Vector3::repeat(f64::NAN));
                values.extend(v.iter().map(|component| *component as f32));
            }
        });
        let mut column = PathColumn::filled(key, Some(unit), fill);
        column.about.components = 3;
        column
    }

    fn filled(key: &str, unit: Option<&str>, fill: Fill<'a>) -> PathColumn<'a> {
        PathColumn {
            about: PathColumnInView {
                key: key.to_owned(),
                unit: unit.map(str::to_owned),
                components: 1,
                joint: None,
                lower: None,
                upper: None,
            },
            fill,
        }
    }
}

/// All columns of a path; `rows`: its points.
fn columns<'a>(
    edited: &'a EditedAnalysis<'_>,
    data: &'a AnalysisData<'a>,
    rows: &'a [Rows<'a>],
) -> Vec<PathColumn<'a>> {
    let (AnalysisData::Path(path, found), Some(points)) = (data, rows.first()) else {
        return Vec::new();
    };
    let robot = &edited.study.robot.robot;
    let answers = &found.along.answers;
    let evaluation = |index: usize| -> Option<&Evaluation> { answers.points[index].as_ref().ok() };
    let or_nan = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let mut columns = vec![
        PathColumn::vector("xyz_mm", "mm", |index| {
            let at = path.track.placing.base_from_path * path.track.path.points[index].at;
            Some(to_mm(at.coords))
        }),
        PathColumn::vector("deviation_um", "um", move |index| {
            let worst = evaluation(index)?.worst_case;
            Some(answers.deviations_at(index)[worst].map(to_um))
        }),
        PathColumn::new("outside_joint_limits", None, move |index| {
            let outside = evaluation(index).is_some_and(|evaluation| !evaluation.within_limits());
            f64::from(u8::from(outside))
        }),
        PathColumn::new("largest_share", None, move |index| {
            or_nan(evaluation(index).and_then(|evaluation| {
                LayerKey::LargestShare.value((robot, &path.setting, answers), (index, evaluation))
            }))
        }),
    ];
    if path.setting.cell.is_some() {
        columns.push(PathColumn::new("in_collision", None, move |index| {
            let collides = matches!(answers.points[index], Err(Unreachable::InCollision { .. }));
            f64::from(u8::from(collides))
        }));
    }
    if found.process.is_none() {
        columns.push(PathColumn::new("force_n", Some("N"), move |index| {
            or_nan(evaluation(index).map(|evaluation| force(path, found, index, evaluation.worst_case)))
        }));
    }
    let without_rapids = Speeds {
        feed: None,
        rapid: Some(f64::INFINITY),
    };
    // With a motion, the time is a column of the table.
    columns.extend(
        Clock::of(&path.track.path, without_rapids)
            .ok()
            .filter(|_| found.motion.is_none())
            .map(|clock| PathColumn::new("time_s", Some("s"), move |index| clock.time()[index])),
    );
    let all = numbers_of(robot, data, rows).into_iter();
    let of_table = all.filter(|numbers| ![&quantity::SHARE, &quantity::OF_CASE].contains(&numbers.quantity));
    let mut joints = joint_order(robot).into_iter();
    for numbers in of_table {
        let (key, unit) = (numbers.name.clone(), numbers.quantity.unit);
        let of_joint = [&quantity::JOINT_DEG, &quantity::JOINT_MM].contains(&numbers.quantity);
        let fill: Fill<'a> = Box::new(move |range, values| {
            let mut known = Vec::with_capacity(range.len());
            (numbers.fill)(points, range, &mut known);
            values.extend(known.into_iter().map(|value| or_nan(value) as f32));
        });
        let mut column = PathColumn::filled(&key, unit, fill);
        let joint = if of_joint { joints.next() } else { None };
        if let Some(joint) = joint {
            let of = &robot.joints()[joint];
            let given = |value: f64| without_rounding(value * JointUnit::of(robot, joint).scale);
            column.about.joint = Some(of.name.clone());
            column.about.lower = of.limits.map(|limits| given(limits.lower));
            column.about.upper = of.limits.map(|limits| given(limits.upper));
        }
        columns.push(column);
    }
    columns
}

/// Size of the force on the tool under this case, N.
fn force(path: &PathAnalysis, found: &PathResult, index: usize, case: usize) -> f64 {
    let load = &found.along.load;
    let mut cases = vec![Wrench::ZERO; load.case_count()];
    path.track.wrenches(load, index, &mut cases);
    cases[case].force.norm()
}

/// The columns, operations and worst points of a path; none of another analysis.
pub(super) fn path_in_view(edited: &EditedAnalysis<'_>, done: &AnalysisResult<'_>) -> Option<PathInView> {
    let AnalysisData::Path(path, found) = &done.found else {
        return None;
    };
    let rows = done.rows();
    let evaluated = |worst: &&crate::analysis::path::run::PointDetail| {
        worst.answers.points.first().is_some_and(Result::is_ok)
    };
    Some(PathInView {
        points: path.track.len(),
        has_part: path.machined_part.is_some(),
        columns: columns(edited, &done.found, &rows)
            .into_iter()
            .map(|column| column.about)
            .collect(),
        operations: operations(path),
        worst: found
            .worst
            .iter()
            .filter(evaluated)
            .map(|worst| worst.index)
            .collect(),
    })
}

/// The operations that have a point.
fn operations(path: &PathAnalysis) -> Vec<OperationInView> {
    let all = &path.track.path.operations;
    let of = |(i, (first, operation)): (usize, &(usize, armill_core::path::Operation))| OperationInView {
        first: *first,
        points: all.get(i + 1).map_or(path.track.len(), |next| next.0) - first,
        name: operation.name.clone(),
        tool: operation.tool,
        line: operation.line,
    };
    let given = all.iter().enumerate().map(of);
    given.filter(|operation| operation.points > 0).collect()
}

/// Points that a thread fills at once.
const POINTS_AT_ONCE: usize = 4096;

/// The values of these columns, one column after the other, each point after point.
///
/// # Errors
/// An analysis that is not a path; a column that it does not have.
pub(super) fn column_bytes(
    edited: &EditedAnalysis<'_>,
    done: &AnalysisResult<'_>,
    keys: &[String],
) -> Result<Vec<u8>, StudyError> {
    let AnalysisData::Path(path, _) = &done.found else {
        let message = format!("the analysis `{}` is not a path", done.name);
        return Err(StudyError::value(message, "choose an analysis of the kind path"));
    };
    let rows = done.rows();
    let all = columns(edited, &done.found, &rows);
    let count = path.track.len();
    let mut bytes = Vec::new();
    for key in keys {
        let Some(column) = all.iter().find(|column| column.about.key == *key) else {
            let known: Vec<&str> = all.iter().map(|column| column.about.key.as_str()).collect();
            return Err(StudyError::value(
                format!("the path has no column `{key}`"),
                format!("columns are {}", known.join(", ")),
            ));
        };
        let starts: Vec<usize> = (0..count).step_by(POINTS_AT_ONCE).collect();
        let part = |start: &usize| -> Vec<u8> {
            let mut values = Vec::with_capacity(POINTS_AT_ONCE * column.about.components);
            (column.fill)(*start..count.min(start + POINTS_AT_ONCE), &mut values);
            values.iter().flat_map(|value| value.to_le_bytes()).collect()
        };
        let parts: Vec<Vec<u8>> = starts.par_iter().map(part).collect();
        bytes.reserve(parts.iter().map(Vec::len).sum());
        parts.iter().for_each(|part| bytes.extend_from_slice(part));
    }
    Ok(bytes)
}

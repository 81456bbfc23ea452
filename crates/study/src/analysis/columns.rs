//! The points of an analysis as a table: the quantities that every kind of analysis has.
//!
//! Positions are relative to the reference frame of the study; deviations are in base axes, micrometres.
//!
//! | column | meaning |
//! |---|---|
//! | `section` | label, of sections only |
//! | `x_mm`, `y_mm`, `z_mm` | TCP |
//! | `state` | `within`, `above_tolerance`, or why there is no posture |
//! | `branch`, `singularity` | the posture, and a singularity that is near |
//! | others | the quantities of [`crate::analysis::quantity`] |
//!
//! A point without posture has its position and state alone; uncertainty and probability are empty where no input has an
//! uncertainty. Uncertainty, probability and shares are left out if the core does not compute them: along a path whose load differs from point to point, or with a tilted tool.

use std::fmt::Display;

use armill_core::kernel::{Answers, Evaluation};
use armill_core::map::probability_within;
use armill_core::robot::Robot;
use armill_core::units::to_um;
use armill_formats::table::{Column, ColumnData, Table};
use rayon::prelude::*;

use crate::analysis::AnalysisData;
use crate::analysis::clearance::{clearance_mm, nearest_bodies};
use crate::analysis::numbers::Numbers;
use crate::analysis::quantity::{self, Quantity};
use crate::analysis::rows::{MM_DECIMALS, Rows, of_points};
use crate::analysis::vibration;
use crate::error::StudyError;
use crate::joint_order::{in_joint_order, joint_order};
use crate::joint_unit::JointUnit;

/// Points whose answers stay in the cache while all columns read them.
const POINTS_AT_ONCE: usize = 512;

/// The columns of these numbers, filled on all threads.
fn filled(numbers: &[Numbers<'_>], series: &[Rows<'_>]) -> Vec<Column> {
    let count = series.iter().map(|rows| rows.at_mm.len()).sum();
    let fill = |numbers: &[Numbers<'_>]| -> Vec<Column> {
        let mut values = vec![Vec::with_capacity(count); numbers.len()];
        for rows in series {
            for first in (0..rows.at_mm.len()).step_by(POINTS_AT_ONCE) {
                let points = first..rows.at_mm.len().min(first + POINTS_AT_ONCE);
                for (numbers, values) in numbers.iter().zip(&mut values) {
                    (numbers.fill)(rows, points.clone(), values);
                }
            }
        }
        numbers
            .iter()
            .zip(values)
            .map(|(numbers, values)| numbers.column(values))
            .collect()
    };
    // Each thread fills some columns, all of them point after point: what a point needs is then near.
    let share = numbers.len().div_ceil(rayon::current_num_threads());
    numbers.par_chunks(share).flat_map_iter(fill).collect()
}

/// The points of one analysis with their columns, one row a point.
///
/// # Errors
/// A table that cannot be made, which would be a fault of armill.
pub fn table(
    robot: &Robot,
    name: &str,
    found: &AnalysisData<'_>,
    series: &[Rows<'_>],
) -> Result<Table, StudyError> {
    let mut columns = Vec::new();
    if series.len() > 1 {
        columns.push(section(series));
    }
    for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
        columns.push(Column {
            name: format!("{letter}_mm"),
            unit: Some("mm".to_owned()),
            description: format!("{letter} of the TCP in the reference frame of the study"),
            decimals: Some(MM_DECIMALS),
            data: ColumnData::Float(of_points(series, |rows, index| rows.at_mm[index][axis])),
        });
    }
    columns.push(words(
        "state",
        "within the tolerance, above it, or why there is no posture that can be used",
        series,
        |rows, i| Some(rows.state(i)),
    ));
    columns.push(words("branch", "name of the posture", series, |rows, i| {
        rows.answers.points[i]
            .as_ref()
            .ok()
            .map(|evaluation| evaluation.name)
    }));
    columns.push(words(
        "singularity",
        "a singularity near the posture",
        series,
        |rows, i| Some(rows.answers.points[i].as_ref().ok()?.singularity?.word()),
    ));
    if series.iter().any(|rows| !rows.answers.clearances.is_empty()) {
        columns.push(words(
            "nearest",
            "the two bodies that `clearance_mm` is between",
            series,
            |rows, i| nearest_bodies(rows.setting, rows.answers, i),
        ));
    }
    columns.extend(filled(&numbers_of(robot, found, series), series));
    Ok(Table::new(name, columns)?)
}

/// The columns of numbers of one analysis, not filled yet. All series of an analysis have the same.
pub fn numbers_of<'a>(
    robot: &'a Robot,
    found: &'a AnalysisData<'_>,
    series: &[Rows<'_>],
) -> Vec<Numbers<'a>> {
    let Some(rows) = series.first() else {
        return Vec::new();
    };
    let contributors = rows.setting.contributor_names(robot);
    let mut columns = found.own_columns(robot);
    columns.extend(numbers(robot, contributors, rows.answers));
    columns.extend(vibration::columns::columns(rows.vibration));
    columns
}

/// A value of an evaluation, in the unit of its quantity; none where it is not known.
pub type EvaluationValue = fn(&Evaluation) -> Option<f64>;

/// The envelope of the load cases at a point: quantities that need the evaluation alone.
pub const ENVELOPE: [(&Quantity, EvaluationValue); 4] = [
    (&quantity::IN_PLANE, |evaluation| Some(to_um(evaluation.in_plane))),
    (&quantity::IN_PLANE_U, |evaluation| {
        evaluation.in_plane_uncertainty.map(to_um)
    }),
    (&quantity::NORMAL, |evaluation| Some(to_um(evaluation.normal))),
    (&quantity::FULL, |evaluation| Some(to_um(evaluation.full))),
];

/// Quantities without values at points where shares are not computed.
const WITH_SHARES: [&Quantity; 2] = [&quantity::IN_PLANE_U, &quantity::PROBABILITY_WITHIN];

/// The columns of numbers that every analysis has; `contributors` are those that have shares.
fn numbers<'a>(robot: &'a Robot, contributors: Vec<String>, answers: &Answers) -> Vec<Numbers<'a>> {
    let (cases, shared) = (answers.case_count, answers.share_count > 0);
    let mut columns = vec![
        Numbers::of(&quantity::LIMIT_MARGIN, |_, _, evaluation| {
            evaluation.limit_margin * JointUnit::of(robot, evaluation.limit_joint).scale
        }),
        Numbers::of(&quantity::WORST_CASE, |_, _, evaluation| {
            evaluation.worst_case as f64 + 1.0
        }),
    ];
    columns
        .extend(ENVELOPE.map(|(quantity, of)| Numbers::of(quantity, move |_, _, evaluation| of(evaluation))));
    if !answers.clearances.is_empty() {
        columns.push(clearances());
    }
    let probability = Numbers::of(&quantity::PROBABILITY_WITHIN, |rows, _, evaluation| {
        probability_within(evaluation, rows.setting.tolerance)
    });
    let after_u = columns
        .iter()
        .position(|column| column.quantity == &quantity::NORMAL);
    columns.insert(after_u.unwrap_or(columns.len()), probability);
    if !shared {
        columns.retain(|column| !WITH_SHARES.contains(&column.quantity));
    }
    for i in joint_order(robot) {
        let joint = &robot.joints()[i];
        let quantity = match robot.slides(i) {
            true => &quantity::JOINT_MM,
            false => &quantity::JOINT_DEG,
        };
        let scale = JointUnit::of(robot, i).scale;
        let of =
            move |rows: &Rows<'_>, index: usize, _: &Evaluation| rows.answers.joints_at(index)[i] * scale;
        columns.push(Numbers::of(quantity, of).named("NAME", &joint.name));
    }
    let of_contributors: Vec<usize> = (0..contributors.len()).collect();
    let of_contributors = in_joint_order(robot, &of_contributors).into_iter();
    for (i, contributor) in of_contributors.zip(&contributors).filter(|_| shared) {
        let of = move |rows: &Rows<'_>, index: usize, _: &Evaluation| to_um(rows.answers.shares_at(index)[i]);
        columns.push(Numbers::of(&quantity::SHARE, of).named("NAME", contributor));
    }
    for case in 0..cases {
        for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
            let of = move |rows: &Rows<'_>, index: usize, _: &Evaluation| {
                to_um(rows.answers.deviations_at(index)[case][axis])
            };
            let column = Numbers::of(&quantity::OF_CASE, of);
            columns.push(
                column
                    .named("AXIS", letter)
                    .named("NUMBER", &(case + 1).to_string()),
            );
        }
    }
    columns
}

/// The clearance, which points without a posture may have as well: that of the best posture.
fn clearances<'a>() -> Numbers<'a> {
    Numbers {
        quantity: &quantity::CLEARANCE,
        name: quantity::CLEARANCE.key.to_owned(),
        fill: Box::new(|rows, points, values| {
            values.extend(points.map(|index| clearance_mm(rows.setting, rows.answers, index)));
        }),
    }
}

/// The column with the section of a point.
fn section(series: &[Rows<'_>]) -> Column {
    let codes = series
        .iter()
        .zip(0..)
        .flat_map(|(rows, code)| std::iter::repeat_n(code, rows.at_mm.len()));
    Column {
        name: "section".to_owned(),
        unit: None,
        description: "which section".to_owned(),
        decimals: None,
        data: ColumnData::Category {
            codes: codes.collect(),
            labels: series.iter().map(|rows| rows.label.clone()).collect(),
        },
    }
}

/// A column of few words, by name and description; points without one get an empty text.
fn words<'s, 'r, W: PartialEq + Display>(
    name: &str,
    description: &str,
    series: &'s [Rows<'r>],
    word: impl Fn(&'s Rows<'r>, usize) -> Option<W>,
) -> Column {
    let mut words: Vec<Option<W>> = Vec::new();
    let mut codes = Vec::new();
    for rows in series {
        for index in 0..rows.at_mm.len() {
            let word = word(rows, index);
            let code = words.iter().position(|known| *known == word).unwrap_or_else(|| {
                words.push(word);
                words.len() - 1
            });
            codes.push(code as u32);
        }
    }
    let label = |word: &Option<W>| word.as_ref().map_or(String::new(), W::to_string);
    Column {
        name: name.to_owned(),
        unit: None,
        description: description.to_owned(),
        decimals: None,
        data: ColumnData::Category {
            codes,
            labels: words.iter().map(label).collect(),
        },
    }
}

//! Path accuracy and repeatability: the result of `armill path-accuracy`.
//!
//! ```text
//! commanded.csv + runs.csv -> Measured -> answer: PathAccuracyAnswer, table of points, drawing
//! ```
//!
//! Commanded and measured points are in the same axes: the tracker must be set to the frame of the path.

use std::io::BufReader;
use std::path::{Path, PathBuf};

use armill_core::measure::path_accuracy::{CYCLES, PathAccuracy, PointAccuracy, path_accuracy};
use armill_core::nalgebra::Vector3;
use armill_core::units::{to_mm, to_um};
use armill_formats::input;
use armill_formats::measurement::trace::{self, Traces};
use armill_formats::table::{Column, ColumnData, Table, csv};
use armill_report::{PathPlot, Series};
use armill_study::StudyError;
use armill_study::number::decimals;
use serde::Serialize;

/// Runs of a path, in numbers.
#[derive(Clone, Debug, Serialize)]
pub struct PathAccuracyAnswer {
    /// Where the path is commanded.
    pub commanded: String,
    /// Position of the runs.
    pub files: Vec<String>,
    /// Runs.
    pub cycles: usize,
    /// Commanded points that all runs passed.
    pub points: usize,
    /// Commanded points that one run did not pass.
    pub not_passed: usize,
    /// AT: the largest distance of the barycentre of the runs from the path.
    pub at_mm: f64,
    /// Where.
    pub at_worst: PlaceAnswer,
    /// Mean of that distance over the points.
    pub at_mean_mm: f64,
    /// RT: the largest mean distance from the barycentre with three standard deviations; none of one run.
    pub rt_mm: Option<f64>,
    /// Where.
    pub rt_worst: Option<PlaceAnswer>,
    /// Columns that were passed over, each with its file.
    pub unused: Vec<String>,
    /// What to know of these numbers.
    pub notes: Vec<String>,
    /// Sources of the definitions.
    pub sources: Vec<&'static str>,
}

/// A commanded point.
#[derive(Clone, Debug, Serialize)]
pub struct PlaceAnswer {
    /// Its line.
    pub line: usize,
    /// Where it is commanded.
    pub commanded_mm: [f64; 3],
    /// Barycentre of the runs less it.
    pub offset_mm: [f64; 3],
}

/// What was read.
#[derive(Clone, Debug)]
pub struct Measured {
    /// File of the path.
    pub commanded_file: String,
    /// The path, m.
    pub commanded: Vec<Vector3<f64>>,
    /// Line of each of its points.
    pub lines: Vec<usize>,
    /// Files of the runs.
    pub files: Vec<String>,
    /// Runs, m.
    pub runs: Vec<Vec<Vector3<f64>>>,
    /// Columns that were passed over, each with its file.
    pub unused: Vec<String>,
}

/// Reads the path and its runs.
///
/// # Errors
/// A file that cannot be read; the problems of a file; a path in several runs.
pub fn read(commanded: &Path, runs: &[PathBuf]) -> Result<Measured, StudyError> {
    let traces = |path: &Path| -> Result<(String, Traces), StudyError> {
        let shown = path.display().to_string();
        let file = input::open(path).map_err(|error| {
            StudyError::value(
                format!("cannot read {shown}: {error}"),
                "a table of points: x_mm, y_mm, z_mm, and run if it contains several",
            )
        })?;
        let found = trace::read(&shown, BufReader::new(file))?;
        Ok((shown, found))
    };
    let (commanded_file, path) = traces(commanded)?;
    let passed_over = |shown: &str, found: &Traces| -> Vec<String> {
        let unused = found.unused.iter();
        unused.map(|name| format!("{name} ({shown})")).collect()
    };
    let mut unused = passed_over(&commanded_file, &path);
    let count = path.runs.len();
    let mut paths = path.runs;
    let one = paths.pop().filter(|_| paths.is_empty()).ok_or_else(|| {
        StudyError::value(
            format!("{commanded_file}: {count} runs; a commanded path has one"),
            "a table without the column `run`",
        )
    })?;
    let mut measured = Measured {
        commanded_file,
        commanded: one.points,
        lines: one.lines,
        files: Vec::new(),
        runs: Vec::new(),
        unused: Vec::new(),
    };
    for file in runs {
        let (shown, found) = traces(file)?;
        unused.extend(passed_over(&shown, &found));
        measured.files.push(shown);
        measured.runs.extend(found.runs.into_iter().map(|run| run.points));
    }
    measured.unused = unused;
    Ok(measured)
}

/// AT and RT of the measured runs.
///
/// # Errors
/// Runs that do not match this path.
pub fn answer(measured: &Measured) -> Result<(PathAccuracy, PathAccuracyAnswer), StudyError> {
    let refused = |error: armill_core::measure::path_accuracy::PathRefusal| {
        StudyError::value(
            format!("{}: {error}", measured.commanded_file),
            "points of one path in its order, and runs along it in the same axes",
        )
    };
    let found = path_accuracy(&measured.commanded, &measured.runs).map_err(refused)?;
    let place = |point: &PointAccuracy| PlaceAnswer {
        line: measured.lines[point.index],
        commanded_mm: mm(point.commanded),
        offset_mm: mm(point.offset),
    };
    let nothing = armill_core::measure::path_accuracy::PathRefusal::Elsewhere;
    let (at, most) = found.accuracy().ok_or_else(|| refused(nothing))?;
    let repeated = found.repeatability();
    let sum: f64 = found.points.iter().map(|point| point.offset.norm()).sum();
    let reported = PathAccuracyAnswer {
        commanded: measured.commanded_file.clone(),
        files: measured.files.clone(),
        cycles: found.cycles,
        points: found.points.len(),
        not_passed: found.not_passed,
        at_mm: reported(to_mm(most)),
        at_worst: place(&found.points[at]),
        at_mean_mm: reported(to_mm(sum / found.points.len() as f64)),
        rt_mm: repeated.map(|(_, rt)| reported(to_mm(rt))),
        rt_worst: repeated.map(|(at, _)| place(&found.points[at])),
        unused: measured.unused.clone(),
        notes: notes(&found),
        sources: vec![
            "ISO 9283:1998, definitions from memory: compare with the standard before claiming conformity",
        ],
    };
    Ok((found, reported))
}

fn notes(found: &PathAccuracy) -> Vec<String> {
    let mut notes = vec!["commanded and measured points are assumed to be in the same axes".to_owned()];
    match found.cycles {
        1 => notes.push("one run: repeatability is not known".to_owned()),
        cycles if cycles < CYCLES => {
            notes.push(format!(
                "ISO 9283 requires {CYCLES} cycles of a path; this file has {cycles}"
            ));
        }
        _ => {}
    }
    if found.not_passed > 0 {
        notes.push(format!(
            "{} commanded points have no result: a run begins after them, ends before them or cuts the corner there",
            found.not_passed
        ));
    }
    notes
}

/// A row a commanded point, as CSV.
///
/// # Errors
/// A table that cannot be.
pub fn points(measured: &Measured, found: &PathAccuracy) -> Result<Vec<u8>, StudyError> {
    let all = || found.points.iter();
    let column = |name: &str, data: ColumnData| Column {
        name: name.to_owned(),
        unit: name.ends_with("_mm").then(|| "mm".to_owned()),
        description: String::new(),
        decimals: Some(6),
        data,
    };
    let lines = all().map(|point| measured.lines[point.index] as i64).collect();
    let mut columns = vec![Column {
        decimals: Some(0),
        ..column("line", ColumnData::Integer(lines))
    }];
    let mut floats = |name: &str, of: &dyn Fn(&PointAccuracy) -> f64| {
        columns.push(column(name, ColumnData::Float(all().map(of).collect())));
    };
    for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
        floats(&format!("{letter}_mm"), &|point| to_mm(point.commanded[axis]));
    }
    for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
        floats(&format!("offset_{letter}_mm"), &|point| to_mm(point.offset[axis]));
    }
    floats("at_mm", &|point| to_mm(point.offset.norm()));
    let rt = all().map(|point| point.repeatability.map(to_mm)).collect();
    columns.push(column("rt_mm", ColumnData::OptionalFloat(rt)));
    Ok(csv::write(&Table::new("points", columns)?))
}

/// AT and RT along the path, as SVG.
pub fn drawing(reported: &PathAccuracyAnswer, found: &PathAccuracy) -> String {
    let mut along = 0.0;
    let mut before: Option<Vector3<f64>> = None;
    let position: Vec<f64> = found
        .points
        .iter()
        .map(|point| {
            along += before.map_or(0.0, |before| (point.commanded - before).norm());
            before = Some(point.commanded);
            to_mm(along)
        })
        .collect();
    let series = |name: &str, of: &dyn Fn(&PointAccuracy) -> f64| Series {
        name: name.to_owned(),
        position: position.clone(),
        deviation_um: found.points.iter().map(|point| to_um(of(point))).collect(),
    };
    let mut all = vec![series("barycentre from the path (AT is the largest)", &|point| {
        point.offset.norm()
    })];
    if found.cycles > 1 {
        all.push(series(
            "mean distance from it and three scatters (RT is the largest)",
            &|point| point.repeatability.unwrap_or_default(),
        ));
    }
    let rt = reported
        .rt_mm
        .map_or(String::new(), |rt| format!(", RT {rt:.3} mm"));
    let runs = if reported.cycles == 1 { "run" } else { "runs" };
    PathPlot {
        title: "Path accuracy".to_owned(),
        subtitle: format!("{} {runs}: AT {:.3} mm{rt}", reported.cycles, reported.at_mm),
        position_label: "along the path (mm)".to_owned(),
        quantity: "distance (µm)".to_owned(),
        series: all,
        envelope: None,
        tolerance_um: None,
    }
    .to_svg()
}

fn mm(vector: Vector3<f64>) -> [f64; 3] {
    [0, 1, 2].map(|axis| reported(to_mm(vector[axis])))
}

/// To a nanometre.
fn reported(value: f64) -> f64 {
    decimals(value, 6)
}

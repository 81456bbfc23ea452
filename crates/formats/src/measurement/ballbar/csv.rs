//! Radii along a circle as a table: one row per sample. The name of each column states its unit.
//!
//! | column | meaning | unit |
//! |---|---|---|
//! | `angle_deg` | from the first axis of the plane towards the second, any turn | `_deg`, `_rad` |
//! | `index` | instead of an angle: number of the sample, consecutive, evenly spaced over one turn from `start_deg` | |
//! | `radius_dev_um` | radius minus the nominal radius, positive outwards | `_um`, `_mm`, `_m` |
//! | `radius_mm` | instead of a deviation: the radius; the nominal radius must be given | `_mm`, `_um`, `_m` |
//! | `direction` | `CW` or `CCW`; may also be given in a comment line or as an option | |
//! | `run` | number or name of the run; may also be given in a comment line | |
//!
//! Columns with other names are ignored and listed. Cells are separated by `;`, tab or `,`. With `;` or tab, decimal
//! commas are read too. Lines that begin with `#` may give the nominal radius, the feed and the plane; see `remarks`.
//! Rows with the same run and direction form one run, in any order. Without run names, a change of direction begins a
//! new run.
//!
//! ```text
//! # radius_mm: 100                         # Radius_mm: 100
//! angle_deg,radius_dev_um,direction,run    angle_deg;radius_mm;direction
//! 0.0,12.3,CCW,1                           0,0;100,0123;CCW
//! 0.5,12.1,CCW,1                           0,5;100,0121;CCW
//! ```

use std::f64::consts::TAU;
use std::io::BufRead;

use armill_core::measure::ballbar::{CircularTest, Direction, Run};
use armill_core::units::from_deg;

use super::columns::{Column, Columns, HEADER_HINT};
use super::remarks::Remarks;
use super::runs::{BallbarReadOptions, BallbarRuns, direction_of};
use crate::document::lines::is_remark;
use crate::document::lines::{Line, Lines};
use crate::document::{MOST_PROBLEMS, Problem, Problems};
use crate::measurement::columns::measured;
use crate::table::sheet::{Cell, is_blank_row, row_cells, separator_of};

/// Maximum number of samples: one hour at 1 kHz.
const MOST_SAMPLES: usize = 5_000_000;
/// An unnamed run that turns further than this is probably several runs.
const MORE_THAN_ONE_TURN: f64 = 1.6 * TAU;
/// Angles in degrees that never exceed this value are probably radians.
const RADIANS: f64 = 6.5;

/// Reads the runs in `reader`. `path` is the file name shown in problems.
///
/// # Errors
/// All problems of the file, at most 200: missing and duplicate columns, cells that are not numbers or directions, rows
/// of another length, no direction, no nominal radius, no start angle, runs that are too short or too many.
pub fn read(path: &str, reader: impl BufRead, options: &BallbarReadOptions) -> Result<BallbarRuns, Problems> {
    let mut lines = Lines::new(path, reader);
    let mut remarks = Remarks::with_options(options);
    let mut problems = Vec::new();
    let mut table: Option<Table> = None;
    while problems.len() < MOST_PROBLEMS {
        let line = match lines.next() {
            Ok(Some(line)) => line,
            Ok(None) => break,
            Err(wrong) => {
                problems.extend(wrong);
                break;
            }
        };
        if is_remark(&line.text) {
            problems.extend(remarks.take(path, &line).err().into_iter().flatten());
            continue;
        }
        match &mut table {
            Some(table) => match table.row(&line, &remarks) {
                Ok(()) => {}
                Err(Refused::Row(wrong)) => problems.extend(wrong),
                Err(Refused::File(wrong)) => {
                    problems.extend(wrong);
                    return Err(problems.into());
                }
            },
            None => match Table::of(path, line) {
                Ok(made) => table = Some(made),
                Err(wrong) => {
                    problems.extend(wrong);
                    break;
                }
            },
        }
    }
    let Some(table) = table else {
        if problems.is_empty() {
            problems.push(Problem::of_file(path, "the file has no radii", HEADER_HINT));
        }
        return Err(problems.into());
    };
    let recorded = table.finish(&remarks, &mut problems);
    Problems::from(problems).into_result()?;
    Ok(recorded)
}

/// Why a row is refused.
enum Refused {
    /// The problem.
    Row(Vec<Problem>),
    /// The file exceeds a maximum: reading stops.
    File(Vec<Problem>),
}

/// The values of a row.
struct Sample {
    direction: Direction,
    /// rad, or number of the sample.
    angle: f64,
    /// m: a deviation, or a radius.
    radius: f64,
}

/// A run as far as it has been read.
struct Group {
    /// Name in the file; for unnamed runs the number of changes so far.
    key: (String, Direction, usize),
    /// First line of the run.
    first: Line,
    /// Start angle of a run without angles, rad.
    start: Option<f64>,
    /// Whether a sample number out of order has been reported.
    is_reported: bool,
    /// rad, or number of the sample.
    angle: Vec<f64>,
    /// m: deviations, or radii.
    radius: Vec<f64>,
}

/// Table below the header.
struct Table {
    path: String,
    separator: char,
    header: Line,
    columns: Columns,
    groups: Vec<Group>,
    /// Group of the previous row.
    current: usize,
    /// Number of changes of direction so far.
    changes: usize,
    samples: usize,
}

impl Table {
    fn of(path: &str, header: Line) -> Result<Table, Vec<Problem>> {
        let separator = separator_of(&header.text);
        Ok(Table {
            columns: Columns::of(path, &header, separator)?,
            path: path.to_owned(),
            separator,
            header,
            groups: Vec::new(),
            current: 0,
            changes: 0,
            samples: 0,
        })
    }

    /// Reads one row.
    ///
    /// # Errors
    /// Wrong number of cells; cells that are not numbers or directions; no direction; too many rows.
    fn row(&mut self, line: &Line, remarks: &Remarks) -> Result<(), Refused> {
        if is_blank_row(&line.text, self.separator) {
            return Ok(());
        }
        let found = row_cells(&self.path, line, self.separator, self.columns.columns.len())
            .map_err(|wrong| Refused::Row(wrong.into_iter().collect()))?;
        let (mut angle, mut radius, mut run) = (0.0, 0.0, None);
        let mut direction = remarks.direction;
        let mut problems = Vec::new();
        for (cell, column) in found.iter().zip(&self.columns.columns) {
            let number = |factor: f64| {
                let number = measured(&cell.text, self.separator).map(|number| number * factor);
                number.ok_or_else(|| Problems::from(self.no_number(line, cell)))
            };
            let taken = match column {
                Some(Column::Angle(factor)) => number(*factor).map(|number| angle = number),
                Some(Column::Index) => number(1.0).map(|number| angle = number),
                Some(Column::Deviation(factor) | Column::Radius(factor)) => {
                    number(*factor).map(|number| radius = number)
                }
                Some(Column::Direction) => match direction_of(&cell.text) {
                    Some(of) => {
                        direction = Some(of);
                        Ok(())
                    }
                    None => {
                        let message = format!("`{}` is not a direction", cell.text);
                        Err(line
                            .problem(&self.path, cell.span.clone(), message, "use CW or CCW")
                            .into())
                    }
                },
                Some(Column::Run) => {
                    run = Some(cell.text.as_ref());
                    Ok(())
                }
                Some(Column::ForPeople) | None => Ok(()),
            };
            problems.extend(taken.err().into_iter().flatten());
        }
        problems.extend(self.too_far(line, &found, radius, remarks));
        if !problems.is_empty() {
            return Err(Refused::Row(problems));
        }
        let Some(direction) = direction else {
            let hint = "add a column `direction`, a line `# direction: CW` above the rows, or the option --direction";
            return match self.groups.is_empty() && self.samples == 0 {
                // Reported once, not for every row.
                true => {
                    self.samples = 1;
                    let message = "the direction of this run is not given".to_owned();
                    Err(Refused::Row(vec![self.at(line, message, hint)]))
                }
                false => Ok(()),
            };
        };
        self.samples += 1;
        if self.samples > MOST_SAMPLES {
            let message = format!("more than {MOST_SAMPLES} samples");
            return Err(Refused::File(vec![self.at(
                line,
                message,
                "split the file into its runs",
            )]));
        }
        let name = run.or(remarks.run.as_deref());
        let sample = Sample {
            direction,
            angle,
            radius,
        };
        self.push(name, sample, line, remarks)
    }

    /// Refuses a radius (m, or its deviation) that no circular test has, if the nominal radius is given above.
    fn too_far(&self, line: &Line, row: &[Cell<'_>], radius: f64, remarks: &Remarks) -> Option<Problem> {
        let nominal = remarks.radius?;
        let is_radius = |column: &Option<Column>| matches!(column, Some(Column::Radius(_)));
        let is_either =
            |column: &Option<Column>| is_radius(column) || matches!(column, Some(Column::Deviation(_)));
        let at = self.columns.columns.iter().position(is_either)?;
        let off = match is_radius(&self.columns.columns[at]) {
            true => radius - nominal,
            false => radius,
        };
        let error = CircularTest::too_far(nominal, off)?;
        let hint = "check the nominal radius and the unit of the radii";
        Some(line.problem(&self.path, row[at].span.clone(), error, hint))
    }

    /// Adds a sample to its run.
    ///
    /// # Errors
    /// Too many runs; a sample number that does not follow the previous one; a second start angle in the same run.
    fn push(
        &mut self,
        name: Option<&str>,
        sample: Sample,
        line: &Line,
        remarks: &Remarks,
    ) -> Result<(), Refused> {
        let Sample {
            direction,
            angle,
            radius,
        } = sample;
        let before = self.groups.get(self.current);
        if before.is_some_and(|group| group.key.1 != direction) {
            self.changes += 1;
        }
        // Rows of a named run belong together, in any order.
        let part = match name {
            Some(_) => 0,
            None => remarks.parts + self.changes,
        };
        let name = name.unwrap_or_default();
        let is_of = |group: &Group| group.key.0 == name && group.key.1 == direction && group.key.2 == part;
        if !before.is_some_and(is_of) {
            let known = self.groups.iter().position(is_of);
            if known.is_none() && self.groups.len() == CircularTest::MOST_RUNS {
                let message = format!("more than {} runs", CircularTest::MOST_RUNS);
                let hint = "`run` is the number of the run, not of the row";
                return Err(Refused::File(vec![self.at(line, message, hint)]));
            }
            self.current = known.unwrap_or_else(|| {
                self.groups.push(Group {
                    key: (name.to_owned(), direction, part),
                    first: line.clone(),
                    start: remarks.start,
                    is_reported: false,
                    angle: Vec::new(),
                    radius: Vec::new(),
                });
                self.groups.len() - 1
            });
        }
        let wrong = match self.columns.have(|column| column == Column::Index) {
            true => self.out_of_order(angle, remarks),
            false => None,
        };
        let group = &mut self.groups[self.current];
        group.angle.push(angle);
        group.radius.push(radius);
        match wrong {
            // Once per run.
            Some((message, hint)) if !group.is_reported => {
                group.is_reported = true;
                Err(Refused::Row(vec![self.at(line, message, hint)]))
            }
            _ => Ok(()),
        }
    }

    /// Problem of a sample number and a hint, if the number is out of order.
    fn out_of_order(&self, number: f64, remarks: &Remarks) -> Option<(String, &'static str)> {
        let group = &self.groups[self.current];
        if group.start != remarks.start {
            return Some((
                "a second `start_deg` of the same run".to_owned(),
                "use another run name",
            ));
        }
        let hint = "number samples consecutively; otherwise give their angles in a column `angle_deg`";
        match group.angle.last() {
            Some(before) if number != before + 1.0 => {
                Some((format!("sample {number} follows sample {before}"), hint))
            }
            None if number.fract() != 0.0 => Some((format!("sample {number} is not a whole number"), hint)),
            _ => None,
        }
    }

    /// The runs after the last row. Missing data are added to `problems`.
    fn finish(self, remarks: &Remarks, problems: &mut Vec<Problem>) -> BallbarRuns {
        let mut recorded = BallbarRuns {
            radius: remarks.radius,
            feed: remarks.feed,
            plane: remarks.plane.clone(),
            runs: Vec::new(),
            names: Vec::new(),
            unused: self.columns.unused.clone(),
            notes: Vec::new(),
        };
        if self.groups.is_empty() && problems.is_empty() {
            problems.push(self.at(&self.header, "no radii below the header".to_owned(), HEADER_HINT));
        }
        let is_radius = self.columns.have(|column| matches!(column, Column::Radius(_)));
        if is_radius && remarks.radius.is_none() {
            let hint = "add a line `# radius_mm: 100` above, or the option --radius-mm";
            problems.push(self.at(&self.header, "the nominal radius is not given".to_owned(), hint));
        }
        let by_index = self.columns.have(|column| column == Column::Index);
        if let Some(group) = self.groups.iter().find(|group| by_index && group.start.is_none()) {
            let hint = "add a line `# start_deg: 0` above, or the option --start-deg";
            let message = "the angle of the first sample is not given".to_owned();
            problems.push(self.at(&group.first, message, hint));
        }
        let degrees = self
            .columns
            .have(|column| matches!(column, Column::Angle(factor) if factor < 1.0));
        let nominal = if is_radius {
            remarks.radius.unwrap_or(0.0)
        } else {
            0.0
        };
        let mut small = true;
        for Group {
            key,
            first,
            start,
            angle,
            radius,
            ..
        } in self.groups
        {
            if problems.len() >= MOST_PROBLEMS {
                break;
            }
            let angle = match by_index {
                true => evenly(angle.len(), start.unwrap_or(0.0), key.1),
                false => angle,
            };
            let far = |most: f64| angle.iter().any(|a| a.abs() > most);
            if degrees && !far(from_deg(RADIANS)) && angle.len() >= Run::LEAST {
                let message = format!("no angle of this run exceeds {RADIANS} deg");
                let hint = "if the angles are radians, name the column `angle_rad`";
                problems.push(first.problem(&self.path, 0..first.text.len(), message, hint));
                continue;
            }
            let turned = travel(&angle);
            if key.0.is_empty() && turned > MORE_THAN_ONE_TURN {
                recorded.notes.push(format!(
                    "the {} run that begins on line {} turns {:.1} times; if it is several runs, name them in a \
                     column `run`",
                    key.1.name(), first.number, turned / TAU
                ));
            }
            let deviation: Vec<f64> = radius.iter().map(|radius| radius - nominal).collect();
            small &= deviation.iter().all(|dr| dr.abs() < 0.3e-6);
            match Run::new(key.1, angle, deviation) {
                Ok(run) => {
                    recorded.runs.push(run);
                    recorded.names.push(key.0);
                }
                Err(error) => problems.push(first.problem(
                    &self.path,
                    0..first.text.len(),
                    error.to_string(),
                    "check whether the file is cut off or rows have wrong run names",
                )),
            }
        }
        if small && !recorded.runs.is_empty() {
            recorded
                .notes
                .push("no deviation exceeds 0.3 um: check the unit in the column name".to_owned());
        }
        recorded
    }

    /// A problem of a cell that is not a number.
    fn no_number(&self, line: &Line, cell: &Cell<'_>) -> Problem {
        let message = format!("`{}` is not a number", cell.text);
        let hint =
            "write numbers without a unit; separate cells with `;` or tab if the decimal mark is a comma";
        line.problem(&self.path, cell.span.clone(), message, hint)
    }

    /// A problem of a whole line.
    fn at(&self, line: &Line, message: String, hint: &str) -> Problem {
        line.problem(&self.path, 0..line.text.len(), message, hint)
    }
}

/// Angles of `count` samples that are evenly spaced over one turn.
pub(super) fn evenly(count: usize, start: f64, direction: Direction) -> Vec<f64> {
    // The sample after the last one would be at the first angle again.
    let step = TAU / count as f64;
    let angle = |k: usize| start + direction.sign() * step * k as f64;
    (0..count).map(angle).collect()
}

/// Total angle of a run, rad, with jumps of a full turn removed.
fn travel(angle: &[f64]) -> f64 {
    let step = |pair: &[f64]| {
        let step = (pair[1] - pair[0]).rem_euclid(TAU);
        step.min(TAU - step)
    };
    angle.windows(2).map(step).sum()
}

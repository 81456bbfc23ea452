//! Load tests from a table: one row per test. The name of each column states its unit.
//!
//! | column | meaning | unit |
//! |---|---|---|
//! | `A1_deg` ... or `q1_deg` ... | joint positions as the controller reports them | `_deg`, `_rad`; `_mm`, `_m` for prismatic joints |
//! | `fx_n`, `fy_n`, `fz_n` | force on the tool, base axes, loaded minus unloaded; a missing column is 0 | `_n`, `_kn` |
//! | `mx_n_m`, ... | moment about the force point | `_n_m` |
//! | `dx_mm`, `dy_mm`, `dz_mm` | displacement in base axes; an empty cell was not measured | `_um`, `_mm`, `_m` |
//! | `d_u_mm` | standard uncertainty of the displacements | `_um`, `_mm`, `_m` |
//! | `joint`, `turn_urad` | rotation of one link relative to the previous one, about the joint's axis with the controller's sign | `_urad`, `_mrad`, `_rad`, `_deg` |
//! | `turn_u_urad` | standard uncertainty of the rotation | as for the rotation |
//! | `force_x_mm`, ... | force point in the flange frame, if it is not the tool point | `_mm`, `_m` |
//! | `gauge_x_mm`, ... | measured point in the flange frame, if it is not the tool point | `_mm`, `_m` |
//! | `weight` | number of ordinary tests that this test is equivalent to | |
//! | `test`, `note`, `expected_...` | labels; not evaluated | |
//!
//! Cells are separated by `;`, tab or `,`. With `;` or tab, decimal commas are read too. Lines that begin with `#`,
//! empty lines and rows without a reading are ignored.
//!
//! ```text
//! test;A1_deg;A2_deg;...;fx_n;fz_n;dx_mm;dy_mm;dz_mm;d_u_mm
//! 1;0;-90;...;0;-98,1;0,012;;-0,154;0,005
//! ```

mod columns;
mod sheet;

use std::io::BufRead;
use std::ops::RangeInclusive;

use armill_core::identify::{LoadTest, Measured, Reading};
use armill_core::nalgebra::Vector3;
use armill_core::robot::{Axis, Robot};
use armill_core::spatial::Wrench;
use armill_core::units::to_deg;

use self::columns::{Column, Columns};
use self::sheet::Sheet;
use crate::document::lines::Line;
use crate::document::{Problem, Problems};
use crate::table::sheet::{Cell, number};

/// Load tests of a file.
#[derive(Clone, Debug)]
pub struct LoadTests {
    /// In the order of the file.
    pub tests: Vec<LoadTest>,
    /// Name of each test: its `test` cell, or its line.
    pub names: Vec<String>,
    /// Number of rows without a reading.
    pub empty_rows: usize,
    /// Joint positions a little outside the limits of the robot file, each a sentence: a measured posture is a fact.
    pub outside_limits: Vec<String>,
    /// Whether every reading has a standard uncertainty.
    pub uncertainties_stated: bool,
}

/// Standard uncertainty of a displacement (m) and of a rotation (rad) if none is given. Only their ratio matters.
const UNSTATED: [f64; 2] = [1e-5, 1e-5];
/// A joint position further outside the limits than this, 10 deg in rad and 17.5 mm in m, is not a posture of this robot.
const OUTSIDE: [f64; 2] = [0.1745, 0.0175];
/// A joint outside its limits by less is at its limit, rad (m): limits of robot files are rounded.
const AT_LIMIT: f64 = 2e-3;
/// An angle above this value in radians is in degrees.
const TURNS: f64 = 4.0 * std::f64::consts::PI;
/// If all angles are below this many degrees, they were radians: tests so close together would give no information.
const RADIANS: f64 = 2.0 * std::f64::consts::PI;
/// Maximum number of columns: more than every quantity in every unit.
const MOST_COLUMNS: usize = 200;
/// Maximum number of reported problems: a systematic mistake is in every row.
const MOST_PROBLEMS: usize = 1000;
/// Maximum length, angle or force of a test, in the units of the file.
const LARGEST: f64 = 1e9;

/// Range of standard uncertainties, m or rad: finer than any gauge to coarser than any test.
const UNCERTAINTIES: RangeInclusive<f64> = 1e-12..=1.0;
/// Range of weights.
const WEIGHTS: RangeInclusive<f64> = 1e-6..=1e6;

/// Reads the load tests of `robot`. `path` is the file name shown in problems, `tool_point` (m, flange frame) the point
/// of force and displacement unless a row gives another.
///
/// A row without a reading is counted and gives no test. A row with a problem gives none either; the other rows are
/// still checked. Joint positions are in SI units as the controller reports them. Wrenches act at the force point, base axes.
///
/// # Errors
/// All problems of the file: missing, unknown and duplicate columns, cells that are not numbers, joint positions that
/// are not valid for this robot, implausible units, no test.
pub fn read(
    path: &str,
    text: impl BufRead,
    robot: &Robot,
    tool_point: Vector3<f64>,
) -> Result<LoadTests, Problems> {
    let Some(sheet) = Sheet::read(path, text)? else {
        let hint = "the first line names the columns; `armill identify --plan 20 --robot ...` writes a table to fill in";
        return Err(Problem::of_file(path, "the file has no table", hint).into());
    };
    let mut reader = Reader {
        sheet: &sheet,
        robot,
        tool_point,
        outside_limits: Vec::new(),
        problems: Vec::new(),
    };
    if let Some(cell) = sheet.heads().get(MOST_COLUMNS) {
        let message = format!("the table has more than {MOST_COLUMNS} columns");
        let hint = "use one row per test and one column per quantity";
        return Err(sheet.problem(&sheet.header, cell, message, hint).into());
    }
    let columns = Columns::of(&sheet, robot, &mut reader.problems);
    let mut found = LoadTests {
        tests: Vec::new(),
        names: Vec::new(),
        empty_rows: 0,
        outside_limits: Vec::new(),
        uncertainties_stated: true,
    };
    for row in &sheet.rows {
        if reader.problems.len() >= MOST_PROBLEMS {
            break;
        }
        reader.row(row, &columns, &mut found);
    }
    reader.angles(&columns);
    found.outside_limits = std::mem::take(&mut reader.outside_limits);
    if found.tests.is_empty() && reader.problems.is_empty() {
        let message = format!("none of the {} rows has a reading", sheet.rows.len());
        let hint = "fill in the measured values: dx_mm, dy_mm, dz_mm; one of them is enough";
        reader
            .problems
            .push(sheet.problem_of_line(&sheet.header, message, hint));
    }
    Problems::from(reader.problems).into_result()?;
    Ok(found)
}

/// Reads rows and collects their problems.
struct Reader<'a> {
    /// The table.
    sheet: &'a Sheet,
    /// The tested robot: its joints name columns, its limits check postures.
    robot: &'a Robot,
    /// Force point and gauge point if no column gives them; flange frame, m.
    tool_point: Vector3<f64>,
    /// Joint positions a little outside the limits.
    outside_limits: Vec<String>,
    /// Problems found so far.
    problems: Vec<Problem>,
}

/// A cell of a line.
struct Place<'a> {
    line: &'a Line,
    cell: &'a Cell<'a>,
}

/// Values of one row, in SI units.
struct Row {
    /// rad or m, as the controller reports them.
    joints: Vec<f64>,
    /// N, base axes.
    force: Vector3<f64>,
    /// N m about the force point, base axes.
    moment: Vector3<f64>,
    /// m, flange frame; the same for the next field.
    force_point: Vector3<f64>,
    gauge_point: Vector3<f64>,
    /// m, base axes; `None`: not measured.
    displacement: [Option<f64>; 3],
    /// Its standard uncertainty, m, for all three axes.
    displacement_u: Option<f64>,
    /// The joint that rotated.
    joint: Option<usize>,
    /// Rotation, rad, with the controller's sign.
    turn: Option<f64>,
    /// Its standard uncertainty, rad.
    turn_u: Option<f64>,
    /// Number of ordinary tests that it is equivalent to.
    weight: f64,
    /// Name of the test.
    name: Option<String>,
}

impl Reader<'_> {
    /// Adds a problem of a cell.
    fn report(&mut self, cell: &Place<'_>, message: String, hint: &str) {
        self.problems
            .push(self.sheet.problem(cell.line, cell.cell, message, hint));
    }

    /// Adds a row as a test if it has a reading and no problem.
    fn row(&mut self, line: &Line, columns: &Columns, found: &mut LoadTests) {
        let cells = match self.sheet.row(line, columns.columns.len()) {
            Ok(cells) => cells,
            Err(wrong) => return self.problems.extend(wrong),
        };
        let mut row = Row {
            joints: vec![0.0; self.robot.joints().len()],
            force: Vector3::zeros(),
            moment: Vector3::zeros(),
            force_point: self.tool_point,
            gauge_point: self.tool_point,
            displacement: [None; 3],
            displacement_u: None,
            joint: None,
            turn: None,
            turn_u: None,
            weight: 1.0,
            name: None,
        };
        let problems = self.problems.len();
        for (cell, column) in cells.iter().zip(&columns.columns) {
            self.cell(&Place { line, cell }, column.as_ref(), &mut row);
        }
        if row.turn.is_some() != row.joint.is_some() {
            let cell = Place {
                line,
                cell: &cells[0],
            };
            self.report(
                &cell,
                "a rotation and its joint must be given together".to_owned(),
                "fill in both `joint` and `turn_...`, or neither",
            );
        }
        if self.problems.len() > problems {
            return;
        }
        let (readings, stated) = readings(&row, self.robot);
        if readings.is_empty() {
            found.empty_rows += 1;
            return;
        }
        found.uncertainties_stated &= stated;
        found
            .names
            .push(row.name.unwrap_or_else(|| format!("line {}", line.number)));
        found.tests.push(LoadTest {
            joints: row.joints,
            wrench: Wrench {
                force: row.force,
                moment: row.moment,
            },
            force_point: row.force_point,
            measured_point: row.gauge_point,
            readings,
        });
    }

    /// Stores the value of a cell in the row; problems are collected.
    fn cell(&mut self, cell: &Place<'_>, column: Option<&Column>, row: &mut Row) {
        let Some(column) = column else { return };
        let text = &cell.cell.text;
        match column {
            Column::Name => row.name = (!text.is_empty()).then(|| text.to_string()),
            Column::ForPeople => {}
            Column::TurnedJoint => {
                let named = |joint: &armill_core::robot::Joint| joint.name.eq_ignore_ascii_case(text);
                row.joint = self.robot.joints().iter().position(named);
                if row.joint.is_none() && !text.is_empty() {
                    let names: Vec<&str> = self.robot.joints().iter().map(|j| j.name.as_str()).collect();
                    let hint = format!("use one of {}", names.join(", "));
                    self.report(cell, format!("`{text}` is not a joint of this robot"), &hint);
                }
            }
            _ => {
                let Some(value) = self.number(cell, column) else {
                    return;
                };
                match *column {
                    Column::Joint(joint, scale) => {
                        row.joints[joint] = value * scale;
                        self.within_limits(cell, joint, [value, scale]);
                    }
                    Column::Force(axis, scale) => row.force[axis] = value * scale,
                    Column::Moment(axis) => row.moment[axis] = value,
                    Column::Displacement(axis, scale) => row.displacement[axis] = Some(value * scale),
                    Column::DisplacementU(scale) => {
                        row.displacement_u = self.within(cell, value * scale, UNCERTAINTIES);
                    }
                    Column::ForcePoint(axis, scale) => row.force_point[axis] = value * scale,
                    Column::GaugePoint(axis, scale) => row.gauge_point[axis] = value * scale,
                    Column::Turn(scale) => row.turn = Some(value * scale),
                    Column::TurnU(scale) => row.turn_u = self.within(cell, value * scale, UNCERTAINTIES),
                    Column::Weight => row.weight = self.within(cell, value, WEIGHTS).unwrap_or(1.0),
                    Column::Name | Column::ForPeople | Column::TurnedJoint => {}
                }
            }
        }
    }

    /// The number in a cell, in the unit of its column; `None` if the cell is empty or not a number.
    fn number(&mut self, cell: &Place<'_>, column: &Column) -> Option<f64> {
        let text = &cell.cell.text;
        if text.is_empty() {
            if let Column::Joint(joint, _) = column {
                let name = &self.robot.joints()[*joint].name;
                let message = format!("no position of joint {name}");
                self.report(cell, message, "every test needs the positions of all joints");
            }
            return None;
        }
        match number(text, self.sheet.separator) {
            Some(value) if value.abs() <= LARGEST => Some(value),
            Some(_) => {
                let message = format!("`{text}` is not a number from -1e9 to 1e9");
                self.report(cell, message, "leave the cell empty if it was not measured");
                None
            }
            None => {
                let message = format!("`{text}` is not a number");
                let hint = "give the unit in the column name; leave the cell empty if it was not measured";
                self.report(cell, message, hint);
                None
            }
        }
    }

    /// A value in SI units if it is within this range; otherwise a problem is reported.
    fn within(&mut self, cell: &Place<'_>, value: f64, limits: RangeInclusive<f64>) -> Option<f64> {
        if limits.contains(&value) {
            return Some(value);
        }
        let text = &cell.cell.text;
        let (message, hint) = match value > 0.0 {
            false => (
                format!("`{text}` is not above 0"),
                "leave the cell empty if it is not known",
            ),
            true => {
                let (least, most) = limits.into_inner();
                let message = format!("`{text}` is {value:e} in SI units, not from {least:e} to {most:e}");
                (message, "check the unit in the column name")
            }
        };
        self.report(cell, message, hint);
        None
    }

    /// Reports a joint position that is outside the limits of its joint by more than [`OUTSIDE`], and notes one that is
    /// by less. `value` is the value in the file, `scale` its factor to SI.
    fn within_limits(&mut self, cell: &Place<'_>, joint: usize, [value, scale]: [f64; 2]) {
        let position = value * scale;
        let described = &self.robot.joints()[joint];
        let Some(limits) = described.limits else { return };
        // An angle of many turns is reported once per column, as degrees read as radians.
        let slides = self.robot.slides(joint);
        if limits.margin(position) >= -AT_LIMIT || (!slides && scale == 1.0 && value.abs() > TURNS) {
            return;
        }
        let (scale, unit) = if slides {
            (1e3, "mm")
        } else {
            (to_deg(1f64), "deg")
        };
        let message = format!(
            "joint {} at {:.1} {unit} is outside its limits {:.1} to {:.1} {unit}",
            described.name,
            position * scale,
            limits.lower * scale,
            limits.upper * scale
        );
        if limits.margin(position) >= -OUTSIDE[usize::from(slides)] {
            return self
                .outside_limits
                .push(format!("line {}: {message}", cell.line.number));
        }
        self.report(
            cell,
            message,
            "the robot file may use another zero or sign for this joint; `armill pose ROBOT \
             --joints-deg ...` shows where it puts the tool",
        );
    }

    /// Detects degrees in a column of radians, and the reverse.
    ///
    /// More than two turns in a column of radians are degrees. If no column of degrees exceeds 6.28 in any row,
    /// the values are radians. Columns with only zeros are neither.
    fn angles(&mut self, columns: &Columns) {
        let sheet = self.sheet;
        let heads = sheet.heads();
        let rows: Vec<Vec<Cell<'_>>> = sheet.rows.iter().map(|row| sheet.cells(row)).collect();
        let mut largest_deg: Option<f64> = None;
        for (index, column) in columns.columns.iter().enumerate() {
            let Some(Column::Joint(joint, scale)) = column else {
                continue;
            };
            if self.robot.slides(*joint) {
                continue;
            }
            let values = rows.iter().filter_map(|row| row.get(index));
            let largest = values
                .filter_map(|cell| number(&cell.text, sheet.separator))
                .fold(0.0, |largest: f64, value| largest.max(value.abs()));
            let head = &heads[index];
            if *scale == 1.0 && largest > TURNS {
                let name = head.text.trim_end_matches("_rad");
                let message = format!("`{}` contains {largest} rad, more than two turns", head.text);
                let hint = format!("if the values are degrees, name the column `{name}_deg`");
                self.problems
                    .push(sheet.problem(&sheet.header, head, message, &hint));
            }
            if *scale != 1.0 {
                largest_deg = Some(largest_deg.unwrap_or(0.0).max(largest));
            }
        }
        if let Some(largest) = largest_deg.filter(|largest| *largest < RADIANS && *largest > 0.0) {
            let message = format!("no joint exceeds {largest} deg in any test");
            let hint = "if the values are radians, name the columns `..._rad`";
            self.problems
                .push(sheet.problem_of_line(&sheet.header, message, hint));
        }
    }
}

/// The readings of a row, and whether each has an uncertainty.
///
/// Displacements come first (x, y, z), then the rotation. It has the sign of the kinematic chain: the sign of its joint
/// is removed. For a test of weight w the standard uncertainties are divided by the square root of w.
fn readings(row: &Row, robot: &Robot) -> (Vec<Reading>, bool) {
    let mut readings = Vec::new();
    let mut stated = true;
    let spread = row.weight.sqrt();
    for (axis, value) in [Axis::X, Axis::Y, Axis::Z].into_iter().zip(row.displacement) {
        if let Some(value) = value {
            stated &= row.displacement_u.is_some();
            readings.push(Reading {
                what: Measured::Displacement(axis),
                value,
                standard_uncertainty: row.displacement_u.unwrap_or(UNSTATED[0]) / spread,
            });
        }
    }
    if let (Some(joint), Some(turn)) = (row.joint, row.turn) {
        stated &= row.turn_u.is_some();
        readings.push(Reading {
            what: Measured::Turn(joint),
            value: turn * robot.joints()[joint].sign.factor(),
            standard_uncertainty: row.turn_u.unwrap_or(UNSTATED[1]) / spread,
        });
    }
    (readings, stated)
}

#[cfg(test)]
mod tests;

//! Load tests from a table: one row a test, the unit of each column in its name.
//!
//! | column | meaning | unit |
//! |---|---|---|
//! | `A1_deg` ... or `q1_deg` ... | joint positions in the controller's counting | `_deg`, `_rad`; `_mm`, `_m` where a joint slides |
//! | `fx_n`, `fy_n`, `fz_n` | force on the tool, base axes, loaded minus unloaded; a missing column is 0 | `_n`, `_kn` |
//! | `mx_n_m`, ... | moment about the force point | `_n_m` |
//! | `dx_mm`, `dy_mm`, `dz_mm` | displacement in base axes; an empty cell was not measured | `_um`, `_mm`, `_m` |
//! | `d_u_mm` | standard uncertainty of the displacements | `_um`, `_mm`, `_m` |
//! | `joint`, `turn_urad` | turn of one link against the one before, about the joint's axis in the controller's sign | `_urad`, `_mrad`, `_rad`, `_deg` |
//! | `turn_u_urad` | standard uncertainty of the turn | as the turn |
//! | `force_x_mm`, ... | force point in the flange frame, where it differs from the tool point | `_mm`, `_m` |
//! | `gauge_x_mm`, ... | measured point in the flange frame, likewise | `_mm`, `_m` |
//! | `weight` | how many ordinary tests this one counts for | |
//! | `test`, `note`, `expected_...` | for people | |
//!
//! Cells are separated by `;`, tab or `,`; with the first two a decimal comma is read too. Lines that begin with `#`
//! and empty ones are passed over, and so are rows without any reading.
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

use self::columns::{Column, Columns};
use self::sheet::Sheet;
use crate::document::lines::Line;
use crate::document::{Problem, Problems};
use crate::table::sheet::{Cell, number};

/// Load tests as a file tells them.
#[derive(Clone, Debug)]
pub struct LoadTests {
    /// In the order of the file.
    pub tests: Vec<LoadTest>,
    /// What each is called: its `test` cell, or its line.
    pub names: Vec<String>,
    /// Rows that hold no reading.
    pub empty_rows: usize,
    /// Whether every reading states its standard uncertainty.
    pub uncertainties_stated: bool,
}

/// Standard uncertainty of a displacement (m) and of a turn (rad) where none is stated: only their ratio counts.
const UNSTATED: [f64; 2] = [1e-5, 1e-5];
/// Further outside the limits than this (rad, m) a posture is not one of this robot.
const OUTSIDE: f64 = 0.0175;
/// An angle beyond this in radians is one in degrees.
const TURNS: f64 = 4.0 * std::f64::consts::PI;
/// All angles below this many degrees were radians: tests so near together tell nothing anyway.
const RADIANS: f64 = 2.0 * std::f64::consts::PI;
/// More columns than this are another table: every quantity in every unit comes to fewer.
const MOST_COLUMNS: usize = 200;
/// More problems than this are not told: one mistake is in every row.
const MOST_PROBLEMS: usize = 1000;
/// No length, angle or force of a test is larger, in the units of the file.
const LARGEST: f64 = 1e9;

/// No standard uncertainty is outside of this, m or rad: finer than any gauge, coarser than any test.
const UNCERTAINTIES: RangeInclusive<f64> = 1e-12..=1.0;
/// No test counts for less or more ordinary ones.
const WEIGHTS: RangeInclusive<f64> = 1e-6..=1e6;

/// The load tests of `robot` in this text; `path` is what problems show, `tool_point` (m, flange frame) where force and
/// displacement are unless a row says otherwise.
///
/// A row without reading is counted and gives no test; a row with a problem gives none either, and the others are still
/// looked at. Joint positions are in SI, in the controller's counting; wrenches act at the force point, base axes.
///
/// # Errors
/// Every problem of the file: missing, unknown and double columns, cells that are no numbers, joint positions that
/// this robot cannot have, units that cannot be, no test at all.
pub fn read(
    path: &str,
    text: impl BufRead,
    robot: &Robot,
    tool_point: Vector3<f64>,
) -> Result<LoadTests, Problems> {
    let Some(sheet) = Sheet::read(path, text)? else {
        let hint = "the first line names the columns; `armill identify --plan 20 --robot ...` makes a table to fill in";
        return Err(Problem::of_file(path, "no table in this file", hint).into());
    };
    let mut reader = Reader {
        sheet: &sheet,
        robot,
        tool_point,
        problems: Vec::new(),
    };
    if let Some(cell) = sheet.heads().get(MOST_COLUMNS) {
        let message = format!("the table has more than {MOST_COLUMNS} columns");
        let hint = "one row a test, one column a quantity";
        return Err(sheet.problem(&sheet.header, cell, message, hint).into());
    }
    let columns = Columns::of(&sheet, robot, &mut reader.problems);
    let mut found = LoadTests {
        tests: Vec::new(),
        names: Vec::new(),
        empty_rows: 0,
        uncertainties_stated: true,
    };
    for row in &sheet.rows {
        if reader.problems.len() >= MOST_PROBLEMS {
            break;
        }
        reader.row(row, &columns, &mut found);
    }
    reader.angles(&columns);
    if found.tests.is_empty() && reader.problems.is_empty() {
        let message = format!("none of the {} rows holds a reading", sheet.rows.len());
        let hint = "fill in what was measured: dx_mm, dy_mm, dz_mm; one of them is enough";
        reader
            .problems
            .push(sheet.problem_of_line(&sheet.header, message, hint));
    }
    Problems::from(reader.problems).into_result()?;
    Ok(found)
}

/// Reads rows, and keeps what is wrong with them.
struct Reader<'a> {
    /// The table.
    sheet: &'a Sheet,
    /// The arm that was tested: its joints name columns, its limits judge postures.
    robot: &'a Robot,
    /// Where force and gauge are where no column tells it; flange frame, m.
    tool_point: Vector3<f64>,
    /// Those found so far.
    problems: Vec<Problem>,
}

/// A cell of a line.
struct Place<'a> {
    line: &'a Line,
    cell: &'a Cell<'a>,
}

/// What the cells of one row say, in SI.
struct Row {
    /// rad or m, controller's counting.
    joints: Vec<f64>,
    /// N, base axes.
    force: Vector3<f64>,
    /// N m about the force point, base axes.
    moment: Vector3<f64>,
    /// m, flange frame; so is the next.
    force_point: Vector3<f64>,
    gauge_point: Vector3<f64>,
    /// m, base axes; `None`: not measured.
    displacement: [Option<f64>; 3],
    /// Its standard uncertainty, m, for all three axes.
    displacement_u: Option<f64>,
    /// The joint that turned.
    joint: Option<usize>,
    /// How far, rad, in the controller's sign.
    turn: Option<f64>,
    /// Its standard uncertainty, rad.
    turn_u: Option<f64>,
    /// How many ordinary tests it counts for.
    weight: f64,
    /// What people call it.
    name: Option<String>,
}

impl Reader<'_> {
    /// Keeps a problem of a cell.
    fn tell(&mut self, cell: &Place<'_>, message: String, hint: &str) {
        self.problems
            .push(self.sheet.problem(cell.line, cell.cell, message, hint));
    }

    /// Takes a row as a test, if it holds a reading and nothing is wrong with it.
    fn row(&mut self, line: &Line, columns: &Columns, found: &mut LoadTests) {
        let cells = self.sheet.cells(line);
        if cells.len() != columns.columns.len() {
            let message = format!(
                "{} cells in a table of {} columns",
                cells.len(),
                columns.columns.len()
            );
            let hint = if self.sheet.separator == ',' {
                "decimal commas need `;` between cells; an empty cell is nothing between two separators"
            } else {
                "an empty cell is nothing between two separators"
            };
            self.problems
                .push(self.sheet.problem_of_line(line, message, hint));
            return;
        }
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
            self.tell(
                &cell,
                "a turn and the joint that turned belong together".to_owned(),
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

    /// Puts what a cell says into the row; what is wrong with it is kept.
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
                    let hint = format!("one of {}", names.join(", "));
                    self.tell(cell, format!("`{text}` is no joint of this robot"), &hint);
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

    /// The number in a cell, in the unit of its column; `None` where it is empty or none.
    fn number(&mut self, cell: &Place<'_>, column: &Column) -> Option<f64> {
        let text = &cell.cell.text;
        if text.is_empty() {
            if let Column::Joint(joint, _) = column {
                let name = &self.robot.joints()[*joint].name;
                let message = format!("no position of joint {name}");
                self.tell(cell, message, "every test needs the whole posture");
            }
            return None;
        }
        match number(text, self.sheet.separator) {
            Some(value) if value.abs() <= LARGEST => Some(value),
            Some(_) => {
                let message = format!("`{text}` is not a number from -1e9 to 1e9");
                self.tell(cell, message, "leave the cell empty if it was not measured");
                None
            }
            None => {
                let message = format!("`{text}` is not a number");
                let hint = "units stand in the column's name; leave the cell empty if it was not measured";
                self.tell(cell, message, hint);
                None
            }
        }
    }

    /// A value in SI, if it is within these limits; else that is told.
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
                (message, "is the unit in the column's name the right one?")
            }
        };
        self.tell(cell, message, hint);
        None
    }

    /// Keeps a problem if a joint position lies outside the limits of its joint by more than [`OUTSIDE`]: about 1 deg,
    /// or 17.5 mm. `value` is as the file has it, `scale` its factor to SI.
    fn within_limits(&mut self, cell: &Place<'_>, joint: usize, [value, scale]: [f64; 2]) {
        let position = value * scale;
        let described = &self.robot.joints()[joint];
        let Some(limits) = described.limits else { return };
        // An angle of many turns is told once a column, as degrees read as radians.
        if limits.margin(position) >= -OUTSIDE
            || (!self.robot.slides(joint) && scale == 1.0 && value.abs() > TURNS)
        {
            return;
        }
        let (scale, unit) = if self.robot.slides(joint) {
            (1e3, "mm")
        } else {
            (1f64.to_degrees(), "deg")
        };
        let message = format!(
            "joint {} at {:.1} {unit} is outside its limits {:.1} to {:.1} {unit}",
            described.name,
            position * scale,
            limits.lower * scale,
            limits.upper * scale
        );
        self.tell(
            cell,
            message,
            "the robot file may count this joint from another zero or the other way round; `armill pose ROBOT \
             --joints-deg ...` shows where it puts the tool",
        );
    }

    /// Degrees under a name in radians, and the other way round.
    ///
    /// More than two turns in a column of radians are degrees; if no column of degrees goes beyond 6.28 in any row,
    /// they are radians. Columns of zeros alone are neither.
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
                let message = format!("`{}` holds {largest} rad, more than two turns", head.text);
                let hint = format!("these are degrees? call the column `{name}_deg`");
                self.problems
                    .push(sheet.problem(&sheet.header, head, message, &hint));
            }
            if *scale != 1.0 {
                largest_deg = Some(largest_deg.unwrap_or(0.0).max(largest));
            }
        }
        if let Some(largest) = largest_deg.filter(|largest| *largest < RADIANS && *largest > 0.0) {
            let message = format!("no joint is further than {largest} deg from its zero in any test");
            let hint = "these are radians? name the columns `..._rad`";
            self.problems
                .push(sheet.problem_of_line(&sheet.header, message, hint));
        }
    }
}

/// The readings of a row, and whether each states its uncertainty.
///
/// Displacements first, x, y, z, then the turn, which is counted with the chain: the sign of its joint is taken off. A
/// test of weight w has standard uncertainties smaller by the root of w.
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

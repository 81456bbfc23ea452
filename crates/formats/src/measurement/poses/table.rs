//! Measured poses as a table: one row per pose. The name of each column states its unit.
//!
//! Columns: see `columns`. Others are ignored and listed, so that an invalid time stamp has no effect. Cells are
//! separated by `;`, tab or `,`. With `;` or tab, decimal commas are read too. Lines that begin with `#`, empty lines
//! and zero bytes at line ends are ignored. Rows without any measured value are counted as not measured.
//!
//! ```text
//! q1_deg,q2_deg,...,q6_deg,x_mm,y_mm,z_mm          pose;direction;A1_deg;...;x_mm;y_mm;z_mm;rx_deg;ry_deg;rz_deg
//! 0,-90,...,0,2577.615,-1073.976,207.594           P1;from above;0,5;...;2577,615;...
//! ```

use std::io::BufRead;

use armill_core::calibrate::MeasuredPose;
use armill_core::frame::from_xyz_and_fixed_angles;
use armill_core::nalgebra::{UnitQuaternion, Vector3};
use armill_core::robot::Robot;
use armill_core::units::to_deg;

use super::columns::{Column, Mapping, Quantity, missing, named, of_data_set};
use crate::document::lines::{Line, Lines};
use crate::document::{Problem, Problems};
use crate::table::sheet::{RowLimit, cells, each_row, named_columns, number, row_cells, separator_of};

/// Maximum length that a tracker measures, m.
const FARTHEST: f64 = 1e4;
/// Maximum angle of a joint or body, rad. A larger value must be in degrees.
const MOST_TURN: f64 = 4.0 * std::f64::consts::PI;
const LIMIT: RowLimit = RowLimit {
    most: 1_000_000,
    rows: "poses",
    hint: "a few hundred poses are sufficient",
};
const COLUMNS_HINT: &str = "use one row per pose: joint positions (`q1_deg` ...), the measured point \
    (`x_mm,y_mm,z_mm`), and its orientation if it was measured (`rx_deg,ry_deg,rz_deg`); columns with other names can \
    be mapped";

/// Order of the angles of a measured body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TurnOrder {
    /// About the fixed axes x, then y, then z: `Rz Ry Rx`.
    FixedXyz,
    /// About the moving axes x, then y, then z: `Rx Ry Rz`.
    MovingXyz,
}

/// Values that the file does not give.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PoseReadOptions {
    /// Names of columns in the file.
    pub columns: Vec<Mapping>,
    /// Order of measured angles. Default: fixed axes, and moving axes for the data set of Landgraf et al.
    /// Commanded angles are always about fixed axes.
    pub turns: Option<TurnOrder>,
}

/// Content of a file of poses.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredPoses {
    /// In the order of the file.
    pub poses: Vec<MeasuredPose>,
    /// Line of each pose, from 1.
    pub lines: Vec<usize>,
    /// Commanded x, y, z (m) and rx, ry, rz (rad) of each pose; angles that are not given are 0.
    pub commanded: Option<Vec<[f64; 6]>>,
    /// The name of each pose.
    pub names: Option<Vec<String>>,
    /// Name of the approach direction of each pose.
    pub directions: Option<Vec<String>>,
    /// Ignored columns.
    pub unused: Vec<String>,
    /// Number of rows without a measured point.
    pub not_measured: usize,
}

impl TurnOrder {
    fn rotation(self, [x, y, z]: [f64; 3]) -> UnitQuaternion<f64> {
        match self {
            TurnOrder::FixedXyz => {
                from_xyz_and_fixed_angles(Vector3::zeros(), Vector3::new(x, y, z)).rotation
            }
            TurnOrder::MovingXyz => {
                let about = |axis: Vector3<f64>, by: f64| UnitQuaternion::new(axis * by);
                about(Vector3::x(), x) * about(Vector3::y(), y) * about(Vector3::z(), z)
            }
        }
    }
}

/// Reads the poses of `robot` in `reader`. `path` is the file name shown in problems.
///
/// # Errors
/// All problems of the file, at most 200: missing or duplicate columns, mappings of missing columns, units that are
/// missing or unknown, cells that are not numbers, rows of another length, implausible angles and lengths.
pub fn read(
    path: &str,
    reader: impl BufRead,
    robot: &Robot,
    given: &PoseReadOptions,
) -> Result<MeasuredPoses, Problems> {
    let mut lines = Lines::new(path, reader);
    let Some(first) = lines.next_row()? else {
        return Err(Problem::of_file(path, "the file has no poses", COLUMNS_HINT).into());
    };
    let table = Table::of(path, &first, robot, given)?;
    let mut measured = MeasuredPoses {
        poses: Vec::new(),
        lines: Vec::new(),
        commanded: table.has(Quantity::Commanded(0)).then(Vec::new),
        names: table.has(Quantity::Pose).then(Vec::new),
        directions: table.has(Quantity::Direction).then(Vec::new),
        unused: table.unused.clone(),
        not_measured: 0,
    };
    each_row(&mut lines, table.separator, LIMIT, |line| {
        table.row(line, &mut measured)
    })?;
    if measured.poses.is_empty() {
        return Err(Problem::of_file(path, "the file has no poses", COLUMNS_HINT).into());
    }
    Ok(measured)
}

/// Meaning of the columns of a file.
struct Table<'a> {
    path: &'a str,
    robot: &'a Robot,
    turns: TurnOrder,
    separator: char,
    /// `None` is ignored.
    columns: Vec<Option<Column>>,
    unused: Vec<String>,
}

impl<'a> Table<'a> {
    /// From the header line.
    fn of(
        path: &'a str,
        line: &Line,
        robot: &'a Robot,
        given: &PoseReadOptions,
    ) -> Result<Table<'a>, Problems> {
        let separator = separator_of(&line.text);
        let whole = 0..line.text.len();
        let found = cells(&line.text, separator);
        // A single name of the data set could mean anything; both together cannot.
        let is_data_set = ["shoulder_pan_joint", "measurement_x"].iter().all(|name| {
            found
                .iter()
                .any(|cell| of_data_set(&cell.text) == of_data_set(name))
        });
        let meaning = |cell: &str| {
            let mapped = given.columns.iter().find(|mapping| mapping.theirs == cell);
            let name = match mapped {
                Some(mapping) => mapping.ours.as_str(),
                None => of_data_set(cell).filter(|_| is_data_set).unwrap_or(cell),
            };
            match named(name, robot)? {
                None if mapped.is_some() => Err((
                    format!("`{cell}` is mapped to `{name}`, which is not a known column"),
                    COLUMNS_HINT.to_owned(),
                )),
                column => Ok(column),
            }
        };
        let named = named_columns(path, line, meaning, |one, other| one.quantity == other.quantity);
        let mut problems = named.problems;
        for mapping in &given.columns {
            if found.iter().all(|cell| cell.text != mapping.theirs) {
                let message = format!("no column is called `{}`", mapping.theirs);
                let hint = format!("it is mapped to `{}`", mapping.ours);
                problems.push(line.problem(path, whole.clone(), message, &hint));
            }
        }
        // A name with a problem is also missing.
        Problems::from(problems).into_result()?;
        let missing = missing(&named.columns, robot);
        if !missing.is_empty() {
            let message = format!("columns are missing: {}", missing.join(", "));
            return Err(line.problem(path, whole, message, COLUMNS_HINT).into());
        }
        Ok(Table {
            path,
            robot,
            turns: given.turns.unwrap_or(match is_data_set {
                true => TurnOrder::MovingXyz,
                false => TurnOrder::FixedXyz,
            }),
            separator,
            columns: named.columns,
            unused: named.unused,
        })
    }

    fn has(&self, quantity: Quantity) -> bool {
        self.columns
            .iter()
            .flatten()
            .any(|column| column.quantity == quantity)
    }

    /// Adds a row; a row with a problem adds nothing.
    fn row(&self, line: &Line, measured: &mut MeasuredPoses) -> Result<(), Problems> {
        let found = row_cells(self.path, line, self.separator, self.columns.len())?;
        let meant = || {
            let both = found.iter().zip(&self.columns);
            both.filter_map(|(cell, column)| Some((cell, (*column)?)))
        };
        let of_point = |quantity| matches!(quantity, Quantity::MeasuredPoses(_));
        if meant().all(|(cell, column)| !of_point(column.quantity) || cell.text.is_empty()) {
            measured.not_measured += 1;
            return Ok(());
        }
        let mut joints = vec![0.0; self.robot.joints().len()];
        let (mut point, mut commanded) = ([0.0; 6], [0.0; 6]);
        let mut problems = Vec::new();
        for (cell, column) in meant().filter(|(_, column)| !column.quantity.is_name()) {
            let value = match self.value(&cell.text, column) {
                Ok(value) => value,
                Err((message, hint)) => {
                    problems.push(line.problem(self.path, cell.span.clone(), message, hint));
                    continue;
                }
            };
            match column.quantity {
                Quantity::Joint(joint) => joints[joint] = value,
                Quantity::MeasuredPoses(component) => point[component] = value,
                Quantity::Commanded(component) => commanded[component] = value,
                Quantity::Pose | Quantity::Direction => {}
            }
        }
        Problems::from(problems).into_result()?;
        let [x, y, z, angles @ ..] = point;
        measured.poses.push(MeasuredPose {
            joints,
            position: Vector3::new(x, y, z),
            rotation: self
                .has(Quantity::MeasuredPoses(3))
                .then(|| self.turns.rotation(angles)),
        });
        measured.lines.push(line.number);
        if let Some(all) = &mut measured.commanded {
            all.push(commanded);
        }
        let text = |quantity| {
            let cell = meant().find(|(_, column)| column.quantity == quantity);
            cell.map_or(String::new(), |(cell, _)| cell.text.to_string())
        };
        if let Some(names) = &mut measured.names {
            names.push(text(Quantity::Pose));
        }
        if let Some(directions) = &mut measured.directions {
            directions.push(text(Quantity::Direction));
        }
        Ok(())
    }

    /// The value of a cell in SI units.
    fn value(&self, text: &str, column: Column) -> Result<f64, (String, &'static str)> {
        let Some(number) = number(text, self.separator).filter(|number| number.is_finite()) else {
            return Err((
                format!("`{text}` is not a number"),
                "give the unit in the column name; remove rows that were not measured",
            ));
        };
        let value = number * column.factor;
        if column.quantity.turns(self.robot) {
            if value.abs() > MOST_TURN {
                let message = format!("an angle of {:.1} deg exceeds two turns", to_deg(value));
                return Err((
                    message,
                    "if the values are degrees, use `_deg` in the column name",
                ));
            }
        } else if value.abs() > FARTHEST {
            let message = format!("a length of {value} m exceeds {FARTHEST} m");
            return Err((message, "check the unit in the column name"));
        }
        Ok(value)
    }
}

#[cfg(test)]
mod tests;

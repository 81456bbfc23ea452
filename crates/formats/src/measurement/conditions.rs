//! What acted on the arm at each row of a table of poses: loads and directions of the last motions; and readings of a ball-bar.
//!
//! | column | meaning | units |
//! |---|---|---|
//! | `q1_deg` ..., or a joint's own name such as `A1_deg` | joint positions as the controller reports them | as of measured poses |
//! | `fx_n`, `fy_n`, `fz_n` | force on the tool at its tip, base axes; a missing column or an empty cell is 0 | `_n`, `_kn` |
//! | `mx_n_m`, `my_n_m`, `mz_n_m` | moment about the tip | `_n_m` |
//! | `q1_direction` ..., or `A1_direction` | direction of the last motion of a joint as the controller reports it: 1, -1; 0 or an empty cell: not known | |
//! | `nx`, `ny`, `nz` | the position is that of a surface, known along this normal alone: its components, in the frame of the measured positions; all or none | |
//! | `radius_mm` | reading of a ball-bar: distance of the measured point from the pivot | `_mm`, `_um`, `_m`, `_in` |
//!
//! Other columns are ignored: they are those of [`poses`](super::poses).

use std::io::BufRead;

use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;
use armill_core::spatial::Wrench;
use armill_core::update::Condition;

use super::poses::columns::{self, Quantity};
use super::profile::LengthUnit;
use crate::document::lines::{Line, Lines};
use crate::document::{Problem, Problems};
use crate::table::sheet::{RowLimit, each_row, named_columns, number, row_cells, separator_of};

const LIMIT: RowLimit = RowLimit {
    most: 1_000_000,
    rows: "rows",
    hint: "a few hundred points are sufficient",
};
/// Largest force, N, and moment, N m: beyond that of any robot.
const LARGEST: f64 = 1e6;
/// How far the length of a normal may be from 1: it is rounded.
const ROUNDED: f64 = 1e-2;
/// Longest ball-bar, m.
const LONGEST: f64 = 100.0;
const HINT: &str = "joint positions (`q1_deg` ...), the load on the tool in base axes (`fx_n`, `fy_n`, `fz_n`), directions of the last motions (`q1_direction` ...)";

/// A row of the table.
#[derive(Clone, Debug, PartialEq)]
pub struct ConditionRow {
    /// Its line, from 1.
    pub line: usize,
    /// Joint positions, controller, rad or m.
    pub joints: Vec<f64>,
    /// Load and directions.
    pub condition: Condition,
    /// Reading of a ball-bar, m.
    pub radius: Option<f64>,
    /// Direction in which the position is known, unit vector; `None`: in all.
    pub normal: Option<Vector3<f64>>,
}

/// Quantity of a column, and the factor of its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Column {
    Joint(usize, f64),
    Force(usize, f64),
    Moment(usize),
    Direction(usize),
    Radius(f64),
    Normal(usize),
}

/// Whether a column of this name is read here, besides joint positions.
pub fn is_condition(name: &str, robot: &Robot) -> bool {
    let found = meaning(name, robot);
    !matches!(found, Ok(None | Some(Column::Joint(..))) | Err(_))
}

/// Reads a table of conditions of `robot`; `path` is the file name shown in problems.
///
/// # Errors
/// All problems of the file, at most 200: missing joints, cells that are not numbers, implausible values, no rows.
pub fn read(path: &str, reader: impl BufRead, robot: &Robot) -> Result<Vec<ConditionRow>, Problems> {
    let mut lines = Lines::new(path, reader);
    let Some(header) = lines.next_row()? else {
        return Err(Problem::of_file(path, "the file has no rows", HINT).into());
    };
    let separator = separator_of(&header.text);
    let is_same = |one: Column, other: Column| match (one, other) {
        (Column::Joint(a, _), Column::Joint(b, _)) | (Column::Force(a, _), Column::Force(b, _)) => a == b,
        (Column::Radius(_), Column::Radius(_)) => true,
        (one, other) => one == other,
    };
    let named = named_columns(path, &header, |name| meaning(name, robot), is_same);
    Problems::from(named.problems).into_result()?;
    let has = |joint| {
        named
            .columns
            .iter()
            .flatten()
            .any(|column| matches!(column, Column::Joint(of, _) if *of == joint))
    };
    let missing: Vec<&str> = (0..robot.joints().len())
        .filter(|joint| !has(*joint))
        .map(|joint| robot.joints()[joint].name.as_str())
        .collect();
    if !missing.is_empty() {
        let message = format!("positions of joints are missing: {}", missing.join(", "));
        return Err(header.problem(path, 0..header.text.len(), message, HINT).into());
    }
    let normals = (named.columns.iter().flatten()).filter(|column| matches!(column, Column::Normal(_)));
    if ![0, 3].contains(&normals.count()) {
        let message = "a normal has the columns `nx`, `ny` and `nz`";
        return Err(header
            .problem(path, 0..header.text.len(), message, "add those that are missing")
            .into());
    }
    let mut rows = Vec::new();
    each_row(&mut lines, separator, LIMIT, |line| {
        rows.push(row(path, line, &named.columns, (separator, robot))?);
        Ok(())
    })?;
    match rows.is_empty() {
        true => Err(Problem::of_file(path, "the file has no rows", HINT).into()),
        false => Ok(rows),
    }
}

fn row(
    path: &str,
    line: &Line,
    columns: &[Option<Column>],
    table: (char, &Robot),
) -> Result<ConditionRow, Problems> {
    let (separator, robot) = table;
    let cells = row_cells(path, line, separator, columns.len())?;
    let mut condition = Condition::unloaded(robot);
    let mut joints = vec![0.0; robot.joints().len()];
    let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
    let mut radius = None;
    let mut normal: Option<Vector3<f64>> = None;
    let mut problems = Vec::new();
    for (cell, column) in cells.iter().zip(columns) {
        let Some(column) = column else { continue };
        if cell.text.is_empty() && !matches!(column, Column::Joint(..)) {
            continue;
        }
        let value = number(&cell.text, separator).filter(|value| value.is_finite());
        let within = |largest: f64| value.filter(|value| value.abs() <= largest);
        let (found, hint) = match column {
            Column::Joint(joint, factor) => {
                let most = if robot.slides(*joint) {
                    1e3
                } else {
                    4.0 * std::f64::consts::PI
                };
                let found = value
                    .map(|value| value * factor)
                    .filter(|value| value.abs() <= most);
                joints[*joint] = found.unwrap_or_default();
                (
                    found,
                    "a joint position, in the unit that the name of the column ends with",
                )
            }
            Column::Force(axis, factor) => {
                let found = within(LARGEST).map(|value| value * factor);
                force[*axis] = found.unwrap_or_default();
                (found, "a force in N, not above 1e6 N")
            }
            Column::Moment(axis) => {
                let found = within(LARGEST);
                moment[*axis] = found.unwrap_or_default();
                (found, "a moment in N m, not above 1e6 N m")
            }
            Column::Radius(factor) => {
                let found = value.map(|value| value * factor);
                let found = found.filter(|radius| *radius > 0.0 && *radius <= LONGEST);
                radius = found;
                (found, "a distance above 0 and not above 100 m")
            }
            Column::Normal(axis) => {
                let found = within(1.0 + ROUNDED);
                normal.get_or_insert_default()[*axis] = found.unwrap_or_default();
                (found, "a component of a unit vector: from -1 to 1")
            }
            Column::Direction(joint) => {
                let found = value.filter(|value| [-1.0, 0.0, 1.0].contains(value));
                condition.directions[*joint] = found.unwrap_or_default();
                (found, "1 or -1; 0 where the direction is not known")
            }
        };
        if found.is_none() {
            let message = format!("`{}` is not valid here", cell.text);
            problems.push(line.problem(path, cell.span.clone(), message, hint));
        }
    }
    if problems.is_empty()
        && let Some(normal) = normal
        && (normal.norm() - 1.0).abs() > ROUNDED
    {
        let message = format!(
            "the normal (`nx`, `ny`, `nz`) has the length {:.4}",
            normal.norm()
        );
        problems.push(line.problem(
            path,
            0..line.text.len(),
            message,
            "a unit vector: its length is 1",
        ));
    }
    Problems::from(problems).into_result()?;
    condition.wrench = Wrench { force, moment };
    Ok(ConditionRow {
        line: line.number,
        joints,
        condition,
        radius,
        normal: normal.map(|normal| normal.normalize()),
    })
}

fn meaning(name: &str, robot: &Robot) -> Result<Option<Column>, (String, String)> {
    let lower = name.trim().to_lowercase();
    if let Some(joint) = lower.strip_suffix("_direction") {
        let unit = |unit: &str| columns::named(&format!("{joint}_{unit}"), robot).ok().flatten();
        let of = unit("deg").or_else(|| unit("mm")).map(|column| column.quantity);
        return match of {
            Some(Quantity::Joint(joint)) => Ok(Some(Column::Direction(joint))),
            _ => Ok(None),
        };
    }
    if let Some(unit) = lower.strip_prefix("radius_") {
        let unit: Option<LengthUnit> = unit.parse().ok();
        return Ok(unit.map(|unit| Column::Radius(unit.factor())));
    }
    for (axis, letter) in ["x", "y", "z"].iter().enumerate() {
        if lower == format!("n{letter}") {
            return Ok(Some(Column::Normal(axis)));
        }
        if let Some(unit) = lower.strip_prefix(&format!("f{letter}_")) {
            return match unit {
                "n" => Ok(Some(Column::Force(axis, 1.0))),
                "kn" => Ok(Some(Column::Force(axis, 1e3))),
                _ => Err((
                    format!("`{unit}` is not a unit of `f{letter}`"),
                    "known units are n and kn".to_owned(),
                )),
            };
        }
        if lower == format!("m{letter}_n_m") {
            return Ok(Some(Column::Moment(axis)));
        }
    }
    Ok(
        columns::named(name, robot)?.and_then(|column| match column.quantity {
            Quantity::Joint(joint) => Some(Column::Joint(joint, column.factor)),
            _ => None,
        }),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use armill_core::robot::{Amount, Axis, Joint, Motion};

    fn two_joints() -> Robot {
        let motions = [0, 1]
            .map(|joint| Motion::About(Axis::Z, Amount::Joint(joint)))
            .to_vec();
        Robot::new("two", motions, ["a", "b"].map(Joint::plain).to_vec()).unwrap()
    }

    fn of(text: &str) -> Result<Vec<ConditionRow>, Problems> {
        read("work.csv", text.as_bytes(), &two_joints())
    }

    #[test]
    fn loads_and_directions_are_read_beside_other_columns() {
        let rows =
            of("q1_deg;q2_deg;x_mm;fx_n;fz_kn;my_n_m;q2_direction\n90;-45;7;10,5;-0,2;3;-1\n0;0;;;;;\n")
                .unwrap();
        assert_eq!(rows.len(), 2);
        assert!((rows[0].joints[0] - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
        let condition = &rows[0].condition;
        assert_eq!(condition.wrench.force, Vector3::new(10.5, 0.0, -200.0));
        assert_eq!(condition.wrench.moment, Vector3::new(0.0, 3.0, 0.0));
        assert_eq!(condition.directions, [0.0, -1.0]);
        assert_eq!(rows[1].condition, Condition::unloaded(&two_joints()));
        assert_eq!(rows[1].line, 3);
        assert_eq!(rows[0].radius, None);
        let bar = of("q1_deg,q2_deg,radius_mm,radius_error\n0,0,150.002,7\n0,1,,\n").unwrap();
        assert!((bar[0].radius.unwrap() - 0.150_002).abs() < 1e-15 && bar[1].radius.is_none());
        let surface = of("q1_deg,q2_deg,nx,ny,nz\n0,0,0.6,0,-0.8\n0,1,,,\n").unwrap();
        assert_eq!(surface[0].normal, Some(Vector3::new(0.6, 0.0, -0.8)));
        assert_eq!(surface[1].normal, None);
        assert!(is_condition("q2_direction", &two_joints()) && !is_condition("q2_deg", &two_joints()));
    }

    #[test]
    fn all_problems_of_a_table_are_reported_with_their_places() {
        let problems = of("q1_deg,q2_deg,fx_n,q1_direction\n0,0,much,2\n0,1e9,1e7,\n")
            .unwrap_err()
            .to_string();
        for part in [
            "2:5", "`much`", "2:10", "`2`", "1 or -1", "3:3", "`1e9`", "`1e7`", "1e6 N",
        ] {
            assert!(problems.contains(part), "{part}: {problems}");
        }
        for (text, part) in [
            ("", "no rows"),
            ("q1_deg,q2_deg\n", "no rows"),
            ("q1_deg,fx_n\n0,1\n", "missing: b"),
            ("q1_deg,q2_deg,fx_lb\n0,0,1\n", "known units are n and kn"),
            ("q1_deg,q2_deg,fx_n,fx_kn\n0,0,1,1\n", "repeats"),
            ("q1_deg,q2_deg\n0\n", "2:"),
            ("q1_deg,q2_deg,radius_mm\n0,0,-1\n", "a distance above 0"),
            ("q1_deg,q2_deg,radius_mm,radius_um\n0,0,1,1\n", "repeats"),
            ("q1_deg,q2_deg,nx,ny\n0,0,1,0\n", "`nx`, `ny` and `nz`"),
            ("q1_deg,q2_deg,nx,ny,nz\n0,0,1,1,0\n", "length 1.4142"),
            ("q1_deg,q2_deg,nx,ny,nz\n0,0,1,0,7\n", "from -1 to 1"),
        ] {
            let problems = of(text).unwrap_err().to_string();
            assert!(problems.contains(part), "{text}: {problems}");
        }
    }
}

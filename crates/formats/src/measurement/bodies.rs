//! Positions and orientations of a body as trackers export them, with the joint positions if the table has them.
//!
//! | column | meaning |
//! |---|---|
//! | `x_mm` or `X [mm]`, ... | position; mm, um, m, in |
//! | `q0` ... `q3`, or `qw`, `qx`, `qy`, `qz` | orientation as a quaternion, the scalar first |
//! | `m_00` ... `m_23` (or `m_33`) | orientation and position (mm) as a matrix, row by row |
//! | `q1_deg` ..., `A1_deg` ..., or `theta_1` ... (rad) | joint positions |
//!
//! Case, blanks and brackets in names do not matter. Other columns are ignored and listed. A text that is not UTF-8 is read as Latin-1, as Leica writes
//! it. Orientation is that of the body in the frame of the tracker.

use std::borrow::Cow;

use armill_core::nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};
use armill_core::robot::Robot;

use super::poses::columns::{self, Quantity};
use super::profile::LengthUnit;
use crate::document::lines::{Line, Lines};
use crate::document::{Problem, Problems};
use crate::table::sheet::{RowLimit, each_row, named_columns, number, row_cells, separator_of};

const LIMIT: RowLimit = RowLimit {
    most: 1_000_000,
    rows: "rows",
    hint: "a few hundred poses are sufficient",
};
/// Maximum length that a tracker measures, m.
const FARTHEST: f64 = 1e4;
/// Deviation of a quaternion or matrix from a rotation that is rounding of its digits.
const ROUNDING: f64 = 1e-3;
const HINT: &str = "one row per pose: x_mm, y_mm, z_mm and, if it was measured, the orientation: q0 to q3 (scalar first), or m_00 to m_23";

/// Bodies of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Bodies {
    /// Position, m, in the frame of the tracker.
    pub positions: Vec<Vector3<f64>>,
    /// Orientations, if they were measured.
    pub rotations: Option<Vec<UnitQuaternion<f64>>>,
    /// Joint positions, if the table has them: rad, m.
    pub joints: Option<Vec<Vec<f64>>>,
    /// Ignored columns.
    pub unused: Vec<String>,
}

/// The meaning of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Column {
    /// Axis, and factor to m.
    Position(usize, f64),
    /// Part of a quaternion, scalar first.
    Quaternion(usize),
    /// Row and column of a matrix.
    Matrix(usize, usize),
    /// Joint, and factor to rad or m.
    Joint(usize, f64),
}

/// Reads bodies and, where they are in the table, joint positions of `robot`; `path` is the file name shown in problems.
///
/// # Errors
/// All problems of the file, at most 200: no positions, incomplete orientations or joints, cells that are not numbers, quaternions and matrices that are no rotations.
pub fn read(path: &str, bytes: &[u8], robot: &Robot) -> Result<Bodies, Problems> {
    let text = of_latin_1(bytes);
    let mut lines = Lines::new(path, text.as_ref());
    let Some(header) = lines.next_row()? else {
        return Err(Problem::of_file(path, "the file has no rows", HINT).into());
    };
    let separator = separator_of(&header.text);
    let is_same = |one: Column, other: Column| match (one, other) {
        (Column::Position(a, _), Column::Position(b, _)) | (Column::Joint(a, _), Column::Joint(b, _)) => {
            a == b
        }
        (one, other) => one == other,
    };
    let named = named_columns(path, &header, |name| meaning(name, robot), is_same);
    Problems::from(named.problems).into_result()?;
    let table = Table::of(path, &header, robot, named.columns)?;
    let mut bodies = Bodies {
        positions: Vec::new(),
        rotations: (table.orientation != Orientation::None).then(Vec::new),
        joints: table.has_joints.then(Vec::new),
        unused: named.unused,
    };
    each_row(&mut lines, separator, LIMIT, |line| {
        table.row(line, separator, &mut bodies)
    })?;
    match bodies.positions.is_empty() {
        true => Err(Problem::of_file(path, "the file has no rows", HINT).into()),
        false => Ok(bodies),
    }
}

/// How the orientation is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Orientation {
    None,
    Quaternion,
    Matrix,
}

struct Table<'a> {
    path: &'a str,
    columns: Vec<Option<Column>>,
    orientation: Orientation,
    has_joints: bool,
    joints: usize,
}

impl<'a> Table<'a> {
    fn of(
        path: &'a str,
        header: &Line,
        robot: &Robot,
        columns: Vec<Option<Column>>,
    ) -> Result<Table<'a>, Problems> {
        let has = |requested: &dyn Fn(Column) -> bool| {
            columns
                .iter()
                .flatten()
                .filter(|column| requested(**column))
                .count()
        };
        let refused = |message: String| Err(header.problem(path, 0..header.text.len(), message, HINT).into());
        let matrix = has(&|column| matches!(column, Column::Matrix(row, _) if row < 3));
        let quaternion = has(&|column| matches!(column, Column::Quaternion(_)));
        let position = has(&|column| matches!(column, Column::Position(..)));
        let joints = has(&|column| matches!(column, Column::Joint(..)));
        let orientation = match (quaternion, matrix) {
            (0, 0) => Orientation::None,
            (4, 0) => Orientation::Quaternion,
            (0, 12) if position == 0 => Orientation::Matrix,
            (_, 0) => return refused(format!("{quaternion} of the 4 parts of a quaternion are given")),
            _ => {
                return refused("an orientation is given twice, or a part of a matrix is missing".to_owned());
            }
        };
        if orientation != Orientation::Matrix && position != 3 {
            return refused("positions are missing: columns `x_mm`, `y_mm`, `z_mm`".to_owned());
        }
        let all = robot.joints().len();
        if joints != 0 && joints != all {
            return refused(format!("{joints} of the {all} joints are given"));
        }
        Ok(Table {
            path,
            columns,
            orientation,
            has_joints: joints > 0,
            joints: all,
        })
    }

    /// Adds a row; a row with a problem adds nothing.
    fn row(&self, line: &Line, separator: char, bodies: &mut Bodies) -> Result<(), Problems> {
        let cells = row_cells(self.path, line, separator, self.columns.len())?;
        let mut position = Vector3::zeros();
        let mut quaternion = [0.0; 4];
        let mut matrix = Matrix3::zeros();
        let mut joints = vec![0.0; self.joints];
        let mut problems = Vec::new();
        for (cell, column) in cells.iter().zip(&self.columns) {
            let Some(column) = column else { continue };
            let Some(value) = number(&cell.text, separator).filter(|value| value.is_finite()) else {
                let message = format!("`{}` is not a number", cell.text);
                problems.push(line.problem(self.path, cell.span.clone(), message, HINT));
                continue;
            };
            match *column {
                Column::Position(axis, factor) => position[axis] = value * factor,
                Column::Quaternion(part) => quaternion[part] = value,
                Column::Matrix(row, 3) if row < 3 => position[row] = value * LengthUnit::Millimetre.factor(),
                Column::Matrix(row, column) if row < 3 => matrix[(row, column)] = value,
                Column::Matrix(..) => {}
                Column::Joint(joint, factor) => joints[joint] = value * factor,
            }
        }
        let whole = 0..line.text.len();
        let mut report = |message: String, hint: &str| {
            problems.push(line.problem(self.path, whole.clone(), message, hint));
        };
        if position.norm() > FARTHEST {
            report("the position is beyond 10 km".to_owned(), "is the unit right?");
        }
        let rotation = match self.orientation {
            Orientation::None => None,
            Orientation::Quaternion => {
                let [w, x, y, z] = quaternion;
                let found = Quaternion::new(w, x, y, z);
                if (found.norm() - 1.0).abs() > ROUNDING {
                    report(
                        format!("the quaternion has the length {:.4}", found.norm()),
                        "a rotation has length 1; the scalar comes first",
                    );
                }
                Some(UnitQuaternion::from_quaternion(found))
            }
            Orientation::Matrix => {
                let off = (matrix.transpose() * matrix - Matrix3::identity()).abs().max();
                if off > ROUNDING || matrix.determinant() < 0.0 {
                    report(
                        "the matrix is not a rotation".to_owned(),
                        "rows m_00 to m_02, m_10 to m_12, m_20 to m_22",
                    );
                }
                Some(UnitQuaternion::from_rotation_matrix(
                    &Rotation3::from_matrix_unchecked(matrix),
                ))
            }
        };
        Problems::from(problems).into_result()?;
        bodies.positions.push(position);
        if let (Some(all), Some(rotation)) = (&mut bodies.rotations, rotation) {
            all.push(rotation);
        }
        if let Some(all) = &mut bodies.joints {
            all.push(joints);
        }
        Ok(())
    }
}

fn meaning(name: &str, robot: &Robot) -> Result<Option<Column>, (String, String)> {
    let plain: String = name
        .to_lowercase()
        .chars()
        .filter(|c| !c.is_whitespace() && *c != ']' && *c != ')')
        .map(|c| if c == '[' || c == '(' { '_' } else { c })
        .collect();
    let digit = |text: &str| match text.as_bytes() {
        [digit @ b'0'..=b'9'] => Some(usize::from(digit - b'0')),
        _ => None,
    };
    if let Some(part) = ["q0", "q1", "q2", "q3"].iter().position(|known| *known == plain) {
        return Ok(Some(Column::Quaternion(part)));
    }
    if let Some(part) = ["qw", "qx", "qy", "qz"].iter().position(|known| *known == plain) {
        return Ok(Some(Column::Quaternion(part)));
    }
    if let Some(place) = plain
        .strip_prefix("m_")
        .filter(|place| place.len() == 2 && place.is_ascii())
    {
        let found = digit(&place[..1]).zip(digit(&place[1..]));
        return Ok(found
            .filter(|(row, column)| *row < 4 && *column < 4)
            .map(|(row, column)| Column::Matrix(row, column)));
    }
    if let Some(joint) = plain
        .strip_prefix("theta_")
        .and_then(|number| number.parse::<usize>().ok())
    {
        let within = (1..=robot.joints().len()).contains(&joint);
        return Ok(within.then(|| Column::Joint(joint - 1, 1.0)));
    }
    let known = match plain.split_once('_') {
        Some(("x" | "y" | "z", _)) => columns::named(&plain, robot)?,
        Some(_) => columns::named(&plain, robot).ok().flatten(),
        None => None,
    };
    Ok(known.and_then(|column| match column.quantity {
        Quantity::Joint(joint) => Some(Column::Joint(joint, column.factor)),
        Quantity::MeasuredPoses(axis @ 0..=2) => Some(Column::Position(axis, column.factor)),
        _ => None,
    }))
}

/// The text as UTF-8: bytes that are not are taken as Latin-1.
fn of_latin_1(bytes: &[u8]) -> Cow<'_, [u8]> {
    match std::str::from_utf8(bytes) {
        Ok(_) => Cow::Borrowed(bytes),
        Err(_) => Cow::Owned(
            bytes
                .iter()
                .map(|byte| char::from(*byte))
                .collect::<String>()
                .into_bytes(),
        ),
    }
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

    fn of(text: &[u8]) -> Result<Bodies, Problems> {
        read("leica.csv", text, &two_joints())
    }

    #[test]
    fn a_leica_table_is_read_with_its_quaternions() {
        let half = 0.5f64.sqrt();
        let text = format!(
            "X  [mm],Y  [mm],Z  [mm],U(95)  [mm],Q0 ,Q1 ,Q2 ,Q3 ,Image RMS  [\u{b5}m],Time Stamp,\n754,-3193.366,303.745,0.004,{half},0,0,{half},0.2,'11.10.2022 15:06:48.043,\n"
        );
        let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
        assert!(std::str::from_utf8(&latin).is_err());
        let found = of(&latin).unwrap();
        assert!((found.positions[0] - Vector3::new(0.754, -3.193_366, 0.303_745)).norm() < 1e-12);
        let turned = found.rotations.unwrap()[0] * Vector3::x();
        assert!((turned - Vector3::y()).norm() < 1e-12);
        assert_eq!(found.joints, None);
        assert!(
            found.unused.iter().any(|name| name.starts_with("U(95)")),
            "{:?}",
            found.unused
        );
    }

    #[test]
    fn a_matrix_with_joints_is_read() {
        let text = "number, theta_1, theta_2, tau_1, m_00, m_01, m_02, m_03, m_10, m_11, m_12, m_13, m_20, m_21, m_22, m_23, m_30\n0, 0.5, -0.25, 3, 0, -1, 0, 10, 1, 0, 0, 20, 0, 0, 1, 1300, 0\n";
        let found = of(text.as_bytes()).unwrap();
        assert_eq!(found.joints.unwrap(), [[0.5, -0.25]]);
        assert!((found.positions[0] - Vector3::new(0.01, 0.02, 1.3)).norm() < 1e-15);
        assert!((found.rotations.unwrap()[0] * Vector3::x() - Vector3::y()).norm() < 1e-15);
    }

    #[test]
    fn all_problems_are_reported_with_their_places() {
        for (text, parts) in [
            ("", &["no rows"][..]),
            ("x_mm,y_mm,z_mm\n", &["no rows"]),
            ("x_mm,y_mm\n1,2\n", &["`z_mm`"]),
            ("x_mm,y_mm,z_mm,q0,q1\n1,2,3,1,0\n", &["2 of the 4 parts"]),
            ("x_mm,y_mm,z_mm,q1_deg\n1,2,3,0\n", &["1 of the 2 joints"]),
            ("x_lb,y_mm,z_mm\n1,2,3\n", &["`lb` is not a unit"]),
            ("x_mm,y_mm,z_mm,x_m\n1,2,3,4\n", &["repeats"]),
            ("m_00,x_mm,y_mm,z_mm\n1,1,2,3\n", &["part of a matrix is missing"]),
            (
                "x_mm,y_mm,z_mm,q0,q1,q2,q3\n1,2,wide,1,0,0,0\n1,2,3,1,1,0,0\n1e9,2,3,1,0,0,0\n",
                &["2:5", "`wide`", "3:1", "length 1.4142", "beyond 10 km"],
            ),
            (
                "m_00,m_01,m_02,m_03,m_10,m_11,m_12,m_13,m_20,m_21,m_22,m_23\n1,0,0,0,0,1,0,0,0,0,-1,0\n",
                &["not a rotation"],
            ),
        ] {
            let problems = of(text.as_bytes()).unwrap_err().to_string();
            for part in parts {
                assert!(problems.contains(part), "{part}: {problems}");
            }
        }
    }
}

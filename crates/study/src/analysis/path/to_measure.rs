//! The points of a path as a table for the journal of the arm: what acted on the arm at each, and the position that was measured there.
//!
//! | column | unit | meaning |
//! |---|---|---|
//! | `line` | - | line of the program, piece of the shape |
//! | `nominal_x_mm`, `nominal_y_mm`, `nominal_z_mm` | mm | where the tip should be, in the frame of the program |
//! | `S_deg`, ... | deg, mm | joint positions that the controller commands |
//! | `fx_n`, ..., `mx_n_m`, ... | N, N m | mean of the load cases, of a cut the mean force: on the tool at its tip, base axes |
//! | `S_direction`, ... | - | direction of the last motion of each joint: 1, -1; 0 before the first |
//! | `x_mm`, `y_mm`, `z_mm` | mm | the position that is measured, in the frame of the program; empty: to be completed |
//! | `nx`, `ny`, `nz` | - | of a measured surface: the only direction in which it is known, same frame |
//!
//! Points that a rapid leads to and points without a posture are left out.

use armill_core::map::AlongPath;
use armill_core::nalgebra::{Point3, Vector3};
use armill_core::path::Track;
use armill_core::robot::{Robot, STANDSTILL};
use armill_core::spatial::Wrench;
use armill_core::units::{to_deg, to_mm};
use armill_formats::table::{Column, ColumnData, Table};

use crate::error::StudyError;

/// A path that was followed, and where it should be.
#[derive(Clone, Copy)]
pub struct NominalPath<'a> {
    /// The arm.
    pub robot: &'a Robot,
    /// Nominal points.
    pub nominal: &'a Track,
    /// Postures and load.
    pub along: &'a AlongPath,
}

/// The position of the tip by the surface that it has left: known along the normal alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredTip {
    /// Point of the path.
    pub index: usize,
    /// Frame of the path, m.
    pub position: Point3<f64>,
    /// Of the surface, frame of the path, unit vector.
    pub normal: Vector3<f64>,
}

/// A point and what acts on the arm there.
struct Row {
    index: usize,
    joints: Vec<f64>,
    directions: Vec<f64>,
    /// Force, then moment, N, N m, base.
    load: [f64; 6],
    measured: Option<MeasuredTip>,
}

/// The table of a path, to be completed with measured positions.
///
/// # Errors
/// Never for a track and answers of the same points.
pub fn to_measure(name: &str, path: &NominalPath<'_>) -> Result<Table, StudyError> {
    table(name, path, &rows(path))
}

/// The table of the points that were measured by the surface of a part.
///
/// # Errors
/// As of [`to_measure`].
pub fn measured(name: &str, path: &NominalPath<'_>, tips: &[MeasuredTip]) -> Result<Table, StudyError> {
    let all = rows(path);
    let with_tip = |tip: &MeasuredTip| {
        let row = all.binary_search_by_key(&tip.index, |row| row.index).ok()?;
        let Row {
            index,
            joints,
            directions,
            load,
            ..
        } = &all[row];
        Some(Row {
            index: *index,
            joints: joints.clone(),
            directions: directions.clone(),
            load: *load,
            measured: Some(*tip),
        })
    };
    let rows: Vec<Row> = tips.iter().filter_map(with_tip).collect();
    table(name, path, &rows)
}

fn table(name: &str, path: &NominalPath<'_>, rows: &[Row]) -> Result<Table, StudyError> {
    let NominalPath { robot, nominal, .. } = path;
    let floats = |unit: Option<&str>, decimals: u8, name: &str, of: &dyn Fn(&Row) -> f64| {
        let values = ColumnData::Float(rows.iter().map(of).collect());
        column(name, unit, (decimals, values))
    };
    let integers = |name: &str, of: &dyn Fn(&Row) -> i64| {
        column(
            name,
            None,
            (0, ColumnData::Integer(rows.iter().map(of).collect())),
        )
    };
    let axes = ["x", "y", "z"];
    let joints = || robot.joints().iter().enumerate();
    let mut columns = vec![integers("line", &|row| {
        i64::from(nominal.path.points[row.index].line)
    })];
    columns.extend(axes.iter().enumerate().map(|(axis, letter)| {
        floats(Some("mm"), 6, &format!("nominal_{letter}_mm"), &|row| {
            to_mm(nominal.path.points[row.index].at[axis])
        })
    }));
    columns.extend(joints().map(|(joint, of)| match robot.slides(joint) {
        true => floats(Some("mm"), 6, &format!("{}_mm", of.name), &|row| {
            to_mm(row.joints[joint])
        }),
        false => floats(Some("deg"), 6, &format!("{}_deg", of.name), &|row| {
            to_deg(row.joints[joint])
        }),
    }));
    columns.extend(
        axes.iter()
            .enumerate()
            .map(|(axis, letter)| floats(Some("N"), 3, &format!("f{letter}_n"), &|row| row.load[axis])),
    );
    columns.extend(axes.iter().enumerate().map(|(axis, letter)| {
        floats(Some("N m"), 4, &format!("m{letter}_n_m"), &|row| {
            row.load[3 + axis]
        })
    }));
    columns.extend(joints().map(|(joint, of)| {
        integers(&format!("{}_direction", of.name), &|row| {
            row.directions[joint] as i64
        })
    }));
    columns.extend(axes.iter().enumerate().map(|(axis, letter)| {
        let values = (rows.iter()).map(|row| Some(to_mm(row.measured?.position[axis])));
        let values = ColumnData::OptionalFloat(values.collect());
        column(&format!("{letter}_mm"), Some("mm"), (6, values))
    }));
    if rows.iter().any(|row| row.measured.is_some()) {
        columns.extend(axes.iter().enumerate().map(|(axis, letter)| {
            floats(None, 6, &format!("n{letter}"), &|row| {
                row.measured.map_or(0.0, |tip| tip.normal[axis])
            })
        }));
    }
    Ok(Table::new(name, columns)?)
}

/// A column of a table of a path; the page that describes the table says what it means.
pub fn column(name: &str, unit: Option<&str>, (decimals, data): (u8, ColumnData)) -> Column {
    Column {
        name: name.to_owned(),
        unit: unit.map(str::to_owned),
        description: String::new(),
        decimals: Some(decimals),
        data,
    }
}

fn rows(path: &NominalPath<'_>) -> Vec<Row> {
    let NominalPath {
        robot,
        nominal,
        along,
    } = path;
    let base_from_part = nominal.placing.base_from_path;
    let mut cases = vec![Wrench::ZERO; along.load.case_count()];
    let mut directions = vec![0.0; robot.joints().len()];
    let mut before: Option<Vec<f64>> = None;
    let mut rows = Vec::new();
    for (index, _) in along.answers.evaluations() {
        let joints = along.answers.joints_at(index).to_vec();
        for (joint, moved) in before
            .iter()
            .flat_map(|before| joints.iter().zip(before).enumerate())
        {
            let by = moved.0 - moved.1;
            if by.abs() > STANDSTILL {
                directions[joint] = by.signum();
            }
        }
        if !nominal.path.begins(index) {
            (along.load).in_base(index, &base_from_part, &nominal.base_from_feed(index), &mut cases);
            let count = cases.len().max(1) as f64;
            let f = cases.iter().map(|case| case.force).sum::<Vector3<f64>>() / count;
            let m = cases.iter().map(|case| case.moment).sum::<Vector3<f64>>() / count;
            rows.push(Row {
                index,
                joints: joints.clone(),
                directions: directions.clone(),
                load: [f.x, f.y, f.z, m.x, m.y, m.z],
                measured: None,
            });
        }
        before = Some(joints);
    }
    rows
}

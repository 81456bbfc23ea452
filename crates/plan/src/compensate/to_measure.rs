//! The points of a commanded path as a table to be completed with measured positions: what acted on the arm at each, for the journal of the arm.
//!
//! | column | unit | meaning |
//! |---|---|---|
//! | `line` | - | line of the program, piece of the shape |
//! | `nominal_x_mm`, `nominal_y_mm`, `nominal_z_mm` | mm | where the tip should be, in the frame of the program |
//! | `S_deg`, ... | deg, mm | joint positions that the controller commands |
//! | `fx_n`, ..., `mx_n_m`, ... | N, N m | mean of the load cases, of a cut the mean force: on the tool at its tip, base axes |
//! | `S_direction`, ... | - | direction of the last motion of each joint: 1, -1; 0 before the first |
//! | `x_mm`, `y_mm`, `z_mm` | mm | empty: the position that is measured |
//!
//! Points that a rapid leads to and points without a posture are left out.

use armill_core::map::AlongPath;
use armill_core::nalgebra::Vector3;
use armill_core::path::Track;
use armill_core::robot::{Robot, STANDSTILL};
use armill_core::spatial::Wrench;
use armill_core::units::{to_deg, to_mm};
use armill_formats::table::{ColumnData, Table};
use armill_study::error::StudyError;

use super::commanded::column;

/// A point and what acts on the arm there.
struct Row {
    index: usize,
    joints: Vec<f64>,
    directions: Vec<f64>,
    /// Force, then moment, N, N m, base.
    load: [f64; 6],
}

/// The table of the path `along`, of which the nominal points are those of `nominal`.
///
/// # Errors
/// Never for a track and answers of the same points.
pub(super) fn to_measure(
    name: &str,
    robot: &Robot,
    nominal: &Track,
    along: &AlongPath,
) -> Result<Table, StudyError> {
    let rows = rows(robot, nominal, along);
    let floats = |unit: &str, decimals: u8, name: &str, of: &dyn Fn(&Row) -> f64| {
        let values = ColumnData::Float(rows.iter().map(of).collect());
        column(name, Some(unit), (decimals, values))
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
        floats("mm", 6, &format!("nominal_{letter}_mm"), &|row| {
            to_mm(nominal.path.points[row.index].at[axis])
        })
    }));
    columns.extend(joints().map(|(joint, of)| match robot.slides(joint) {
        true => floats("mm", 6, &format!("{}_mm", of.name), &|row| {
            to_mm(row.joints[joint])
        }),
        false => floats("deg", 6, &format!("{}_deg", of.name), &|row| {
            to_deg(row.joints[joint])
        }),
    }));
    columns.extend(
        axes.iter()
            .enumerate()
            .map(|(axis, letter)| floats("N", 3, &format!("f{letter}_n"), &|row| row.load[axis])),
    );
    columns.extend(
        axes.iter()
            .enumerate()
            .map(|(axis, letter)| floats("N m", 4, &format!("m{letter}_n_m"), &|row| row.load[3 + axis])),
    );
    columns.extend(joints().map(|(joint, of)| {
        integers(&format!("{}_direction", of.name), &|row| {
            row.directions[joint] as i64
        })
    }));
    let empty = || ColumnData::OptionalFloat(vec![None; rows.len()]);
    columns.extend(axes.map(|letter| column(&format!("{letter}_mm"), Some("mm"), (4, empty()))));
    Ok(Table::new(name, columns)?)
}

fn rows(robot: &Robot, nominal: &Track, along: &AlongPath) -> Vec<Row> {
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
            });
        }
        before = Some(joints);
    }
    rows
}

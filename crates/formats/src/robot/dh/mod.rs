//! Denavit-Hartenberg tables: text with a `convention` line, a header whose columns carry their units, a row a joint.
//!
//! ```text
//! convention = modified
//! joint, alpha_deg, a_mm, theta_deg, d_mm
//! S, 0, 0, 0, 450
//! L, -90, 155, -90, 0
//! ```
//!
//! | convention | a row is |
//! |---|---|
//! | `standard` | `Rz(theta) Tz(d) Tx(a) Rx(alpha)`: a and alpha lead to the next axis |
//! | `modified` (Craig) | `Rx(alpha) Tx(a) Rz(theta) Tz(d)`: a and alpha lead from the axis before |
//! | `hayati` | `Rz(theta) Tz(d) Tx(a) Rx(alpha) Ry(beta)`: standard, with a turn about y for axes that are nearly parallel |
//!
//! A joint adds to `theta` (a prismatic one to `d`): the column contains the value at the controller's zero. The two
//! conventions look alike and mean different arms, so the label is demanded; so are units.
//!
//! Columns: `a_mm` or `a_m`, `alpha_deg` or `alpha_rad`, `d_mm` or `d_m`, `theta_deg` or `theta_rad`; `beta_deg` or `beta_rad` with `hayati`; optional `joint`
//! (name), `type` (revolute, prismatic, fixed), `sign` (1 or -1), `lower_deg`, `upper_deg` (or `_rad`, `_mm`, `_m`).
//!
//! In reading order: `table` (lines, header, cells), `rows` (columns, units, SI), and here the chain of motions.
//!
//! Source: Denavit & Hartenberg 1955; Craig, Introduction to Robotics, section 3.4.

mod rows;
mod table;

use armill_core::robot::{Amount, Axis, Joint, Limits, Motion, Robot};

use self::rows::{Moves, Row};
use self::table::Convention;
use super::description::RobotDescription;
use crate::document::{Problems, Source};

/// The robot of this table; `path` is what errors show, `id` the robot's name in results.
///
/// A row of type `fixed` moves nothing and gives constant motions alone. The flange is the frame behind the last row.
///
/// # Errors
/// No convention, columns that are missing, unknown or without unit, cells that are not numbers.
pub fn read(path: &str, id: &str, text: &str) -> Result<RobotDescription, Problems> {
    let file = Source::new(path, text);
    let table = table::read(&file)?;
    let rows = rows::read(&file, &table)?;
    let mut motions = Vec::new();
    let mut joints = Vec::new();
    for row in &rows {
        motions.extend(motions_of(row, table.convention, joints.len()));
        joints.extend(joint_of(row));
    }
    let robot = Robot::new(id, motions, joints)
        .map_err(|error| Problems::from(file.problem(0..0, error.to_string(), None)))?;
    let mut found = RobotDescription::of_one_source(robot, "dh", path, "Denavit-Hartenberg table");
    if let Some(name) = table.name {
        found.title = name;
    }
    found.remarks = vec![match table.convention {
        Convention::Standard => "standard convention: a row is Rz(theta) Tz(d) Tx(a) Rx(alpha)".to_owned(),
        Convention::Modified => {
            "modified convention (Craig): a row is Rx(alpha) Tx(a) Rz(theta) Tz(d)".to_owned()
        }
        Convention::Hayati => {
            "convention of Hayati: a row is Rz(theta) Tz(d) Tx(a) Rx(alpha) Ry(beta)".to_owned()
        }
    }];
    found
        .remarks
        .push("the base is the table's frame 0, the flange its last frame".to_owned());
    Ok(found)
}

/// The elementary motions of a row; a joint's constant part is its zero offset, not a motion.
fn motions_of(row: &Row, convention: Convention, joint: usize) -> Vec<Motion> {
    let constant = Amount::Constant;
    let (theta, d) = match row.moves {
        Moves::Turns => (Amount::Joint(joint), constant(row.d)),
        Moves::Slides => (constant(row.theta), Amount::Joint(joint)),
        Moves::Not => (constant(row.theta), constant(row.d)),
    };
    let about_z = [Motion::About(Axis::Z, theta), Motion::Along(Axis::Z, d)];
    let motions = match convention {
        Convention::Standard | Convention::Hayati => [
            about_z[0],
            about_z[1],
            Motion::Along(Axis::X, constant(row.a)),
            Motion::About(Axis::X, constant(row.alpha)),
            Motion::About(Axis::Y, constant(row.beta)),
        ],
        Convention::Modified => [
            Motion::About(Axis::X, constant(row.alpha)),
            Motion::Along(Axis::X, constant(row.a)),
            about_z[0],
            about_z[1],
            Motion::About(Axis::Y, constant(0.0)),
        ],
    };
    let moves = |motion: &Motion| motion.amount() != constant(0.0);
    motions.into_iter().filter(moves).collect()
}

/// The joint of a row, its zero offset in rad or m; `None` for a row that is fixed.
fn joint_of(row: &Row) -> Option<Joint> {
    let zero_offset = match row.moves {
        Moves::Turns => row.theta,
        Moves::Slides => row.d,
        Moves::Not => return None,
    };
    Some(Joint {
        sign: row.sign,
        zero_offset,
        limits: row.limits.map(|[lower, upper]| Limits { lower, upper }),
        ..Joint::plain(&row.joint)
    })
}

#[cfg(test)]
mod tests;

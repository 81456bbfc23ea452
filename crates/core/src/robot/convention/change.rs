//! Possible differences between a robot file and its pendant, and the joint positions that follow.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{UnitQuaternion, Vector3};

use crate::robot::Robot;

/// One difference between file and pendant: the change of the file that removes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// The joint has the opposite direction.
    Sign {
        /// Index of the joint.
        joint: usize,
    },
    /// The joint has another zero: its chain position is `by` (rad) more at every joint position.
    Zero {
        /// Index of the joint.
        joint: usize,
        /// How much, rad.
        by: f64,
        /// Whether the value was found from the readings, not taken from the quarter turns.
        free: bool,
    },
    /// The joint is coupled to an earlier joint, with a factor higher than that of the file by `factor`.
    Coupling {
        /// Index of the joint.
        joint: usize,
        /// Index of the earlier joint.
        other: usize,
        /// Factor on top of the file's.
        factor: f64,
    },
    /// The pendant's base is higher than the assumed frame by this, m.
    BaseHeight {
        /// How much, m.
        by: f64,
    },
    /// The pendant's base is elsewhere, m.
    BaseShift {
        /// From the assumed frame to the pendant's.
        by: Vector3<f64>,
    },
    /// The pendant's flange frame is turned against the file's.
    FlangeTurn {
        /// File's flange to pendant's flange.
        turn: UnitQuaternion<f64>,
    },
    /// Positions were read in inches.
    Inches,
}

impl Change {
    /// Its complexity.
    pub fn count(&self) -> usize {
        match self {
            Change::BaseShift { .. } | Change::Zero { free: true, .. } => 2,
            _ => 1,
        }
    }

    /// Whether both change the same property of the same joint, so that no explanation needs both.
    fn excludes(&self, other: &Change) -> bool {
        match (self, other) {
            (Change::Zero { joint: a, .. }, Change::Zero { joint: b, .. })
            | (Change::Sign { joint: a }, Change::Sign { joint: b })
            | (Change::Coupling { joint: a, .. }, Change::Coupling { joint: b, .. }) => a == b,
            _ => false,
        }
    }
}

/// Every change of a joint that is tried without a free value.
pub fn joint_changes(robot: &Robot) -> Vec<Change> {
    let turning: Vec<usize> = (0..robot.joints().len()).filter(|&i| !robot.slides(i)).collect();
    let mut changes = Vec::new();
    for &joint in &turning {
        changes.push(Change::Sign { joint });
        let quarters = [1.0, -1.0, 2.0].map(|quarters| quarters * FRAC_PI_2);
        changes.extend(quarters.map(|by| Change::Zero {
            joint,
            by,
            free: false,
        }));
    }
    if let [_, other, joint, ..] = turning[..] {
        changes.extend([1.0, -1.0].map(|factor| Change::Coupling { joint, other, factor }));
    }
    changes
}

/// Visits every compatible set of `count` of these changes, in the order of the list, until `visit` fails.
///
/// # Errors
/// Errors of `visit`.
pub fn visit_sets<E>(
    changes: &[Change],
    count: usize,
    visit: &mut impl FnMut(&[Change]) -> Result<(), E>,
) -> Result<(), E> {
    extend_set(&mut Vec::with_capacity(count), changes, count, visit)
}

/// Visits every set of those chosen and `more` of the changes.
fn extend_set<E>(
    chosen: &mut Vec<Change>,
    changes: &[Change],
    more: usize,
    visit: &mut impl FnMut(&[Change]) -> Result<(), E>,
) -> Result<(), E> {
    if more == 0 {
        return visit(chosen);
    }
    for (index, change) in changes.iter().enumerate() {
        if !chosen.iter().any(|other| change.excludes(other)) {
            chosen.push(*change);
            let visited = extend_set(chosen, &changes[index + 1..], more - 1, visit);
            chosen.pop();
            visited?;
        }
    }
    Ok(())
}

/// The joint positions of the file at which its chain is that of the changed joints at `read` (rad, m).
pub fn positions_of_the_file(robot: &Robot, changes: &[Change], read: &[f64]) -> Vec<f64> {
    let mut positions: Vec<f64> = Vec::with_capacity(read.len());
    for index in 0..read.len() {
        let offset = robot.joints()[index].zero_offset;
        let mut position = robot.theta(index, read) - offset;
        let (mut turned, mut sign) = (0.0, 1.0);
        for change in changes {
            match *change {
                Change::Coupling { joint, other, factor } if joint == index => {
                    position += robot.joints()[index].sign.factor() * factor * read[other];
                }
                Change::Sign { joint } if joint == index => sign = -1.0,
                Change::Zero { joint, by, .. } if joint == index => turned += by,
                _ => {}
            }
        }
        let theta = sign * position + offset + turned;
        positions.push(robot.joint_position(index, theta, &positions));
    }
    positions
}

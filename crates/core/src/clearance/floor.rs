//! The floor: all that is below a plane.
//!
//! Its distance from a body is the height of the lowest point of the body,
//!
//! ```text
//! d = max(0, min over the points p of the body of  n . p - h)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `n` | unit normal, upward, base | - |
//! | `h` | distance of the plane from the origin along `n` | m |
//!
//! The base and the first link of the arm, and what carries them, are not checked against it: they are above it by design.

use nalgebra::Vector3;

use super::bounds::Capsule;
use super::nearest::Nearest;
use super::shape::Placed;
use crate::frame::Isometry;
use crate::robot::{Attachment, Robot};

/// The floor.
#[derive(Clone, Debug, PartialEq)]
pub struct Floor {
    /// Its name, for people.
    pub(super) name: String,
    normal: Vector3<f64>,
    height: f64,
    /// Bodies of the arm with a smaller rank are not checked.
    first_checked: usize,
}

impl Floor {
    /// The floor under this robot: all below the x-y plane of a frame.
    pub fn below(name: &str, base_from_plane: &Isometry, robot: &Robot) -> Floor {
        let normal = base_from_plane * Vector3::z();
        Floor {
            name: name.to_owned(),
            normal,
            height: normal.dot(&base_from_plane.translation.vector),
            first_checked: joints_in_front(robot) + 2,
        }
    }

    /// Whether bodies with this attachment are checked, of an arm with this many joints.
    pub(super) fn is_checked(&self, attachment: Attachment, joints: usize) -> bool {
        attachment.rank(joints).min(joints) >= self.first_checked
    }

    /// Height of a capsule above it, m; negative below.
    pub(super) fn height_of(&self, hull: &Capsule) -> f64 {
        hull.extent(&self.normal)[0] - self.height
    }

    /// The nearest points of a body and the floor, that of the body first.
    pub(super) fn nearest(&self, body: &Placed) -> Nearest {
        let lowest = body.farthest_along(&-self.normal);
        let above = self.normal.dot(&lowest.coords) - self.height;
        match above > 0.0 {
            true => Nearest {
                distance: above,
                points: [lowest, lowest - self.normal * above],
            },
            false => Nearest::touching(lowest),
        }
    }
}

/// Number of joints in front of the arm: those of a rail or gantry.
pub(super) fn joints_in_front(robot: &Robot) -> usize {
    (0..robot.joints().len())
        .take_while(|joint| robot.is_external(*joint))
        .count()
}

#[cfg(test)]
mod tests;

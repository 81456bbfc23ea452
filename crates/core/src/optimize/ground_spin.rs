//! Spin relative to the ground: where a positioner turns the part, the spins of a search are relative to the ground, so
//! that the tool keeps its orientation there while the part turns below it.
//!
//! ```text
//! spin = s + d(q) - d(q_home)        d: from the spin zero in base to that in the ground, about the tool axis
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `s` | spin of the search | rad |
//! | `q`, `q_home` | joint positions of the positioner, and those where it stands without the search | rad (m) |
//!
//! Spin zero is that of [`tool_orientation`]: y of the tool next to y of the frame. Spins relative to the feed, and those of a
//! program, turn with the part already.

use nalgebra::{Unit, UnitQuaternion, Vector3};

use crate::frame::tool_orientation;
use crate::path::{Spin, Track};
use crate::robot::Robot;
use crate::robot::forward::base_from_ground;

/// What the positioner adds to the spins of a search.
pub(super) struct GroundSpin<'a> {
    robot: &'a Robot,
    /// The ground in base at home; none where spins are relative to the part.
    at_home: Option<UnitQuaternion<f64>>,
}

impl<'a> GroundSpin<'a> {
    /// For this robot and track, with the positioner of `home`, rad (m).
    pub fn of(robot: &'a Robot, track: &Track, home: Option<&[f64]>) -> GroundSpin<'a> {
        let turns =
            robot.chain().ground().positioner_joints() > 0 && matches!(track.placing.spin, Spin::Fixed(_));
        GroundSpin {
            robot,
            at_home: turns.then(|| base_from_ground(robot, &robot.home(home)).rotation),
        }
    }

    /// The angle (rad) that the spin of a tool with this axis (base, away from the spindle) is greater at `home` than the
    /// spin of the search.
    pub fn at(&self, home: &[f64], axis: &Vector3<f64>) -> f64 {
        self.at_home.map_or(0.0, |at_home| {
            let axis = Unit::new_normalize(*axis);
            let here = base_from_ground(self.robot, home).rotation;
            ahead(&here, axis) - ahead(&at_home, axis)
        })
    }
}

/// From spin zero in base to spin zero in the ground, about the tool axis, rad.
fn ahead(base_from_ground: &UnitQuaternion<f64>, axis: Unit<Vector3<f64>>) -> f64 {
    let in_ground = Unit::new_unchecked(base_from_ground.inverse() * axis.into_inner());
    let x = base_from_ground * (tool_orientation(in_ground, 0.0) * Vector3::x());
    let in_base = tool_orientation(axis, 0.0);
    let [x_base, y_base] = [in_base * Vector3::x(), in_base * Vector3::y()];
    x.dot(&y_base).atan2(x.dot(&x_base))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spins_follow_a_turn_about_the_tool_and_no_other() {
        let down = Unit::new_normalize(-Vector3::z());
        for angle in [-2.0, -0.3, 0.0, 1.2, 3.0] {
            let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle);
            let expected = turn * (tool_orientation(down, 0.0) * Vector3::x());
            let spun = tool_orientation(down, ahead(&turn, down)) * Vector3::x();
            assert!((spun - expected).norm() < 1e-14, "{angle}");
        }
        let tilt = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.4);
        let axis = Unit::new_unchecked(tilt * -Vector3::z());
        let spun = tool_orientation(axis, ahead(&tilt, axis)) * Vector3::x();
        assert!((spun - tilt * (tool_orientation(down, 0.0) * Vector3::x())).norm() < 1e-14);
    }
}

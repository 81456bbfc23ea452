//! Forward kinematics: joint positions to the frames of the joints and the flange.

use nalgebra::{Point3, Vector3};

use super::model::Robot;
use crate::frame::Isometry;

/// Where every joint and the flange stand. Reused between calls of [`forward_into`] without allocation.
#[derive(Clone, Debug)]
pub struct Frames {
    /// Frame of each joint after its motion, in base.
    pub base_from_joint: Vec<Isometry>,
    /// The flange, in base.
    pub base_from_flange: Isometry,
}

impl Frames {
    /// Room for the frames of `robot`.
    pub fn for_robot(robot: &Robot) -> Frames {
        Frames {
            base_from_joint: vec![Isometry::identity(); robot.joints().len()],
            base_from_flange: Isometry::identity(),
        }
    }

    /// A point on the axis of joint `index`, m, in base.
    pub fn origin(&self, index: usize) -> Point3<f64> {
        self.base_from_joint[index].translation.vector.into()
    }
}

/// The frames of `robot` at joint positions `q` (rad, m; the controller's counting).
///
/// # Panics
/// If `q` has fewer entries than the robot has joints.
pub fn forward(robot: &Robot, q: &[f64]) -> Frames {
    let mut frames = Frames::for_robot(robot);
    forward_into(robot, q, &mut frames);
    frames
}

/// [`forward`] into frames that exist already.
pub fn forward_into(robot: &Robot, q: &[f64], frames: &mut Frames) {
    let mut base_from_here = Isometry::identity();
    for (index, link) in robot.chain().links().iter().enumerate() {
        base_from_here *= link.before * link.motion.displacement(robot.theta(index, q));
        frames.base_from_joint[index] = base_from_here;
    }
    frames.base_from_flange = base_from_here * robot.chain().last_joint_from_flange();
}

/// Unit axis of joint `index` in base.
pub fn joint_axis(robot: &Robot, frames: &Frames, index: usize) -> Vector3<f64> {
    use super::chain::Motion::{About, Along};
    let (Along(axis, _) | About(axis, _)) = robot.chain().links()[index].motion;
    frames.base_from_joint[index].rotation * axis.unit()
}

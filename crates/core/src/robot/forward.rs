//! Forward kinematics: joint positions to the frames of the joints and the flange.

use nalgebra::{IsometryMatrix3, Matrix3, Point3, Rotation3, Vector3};

use super::chain::{Chain, Motion};
use super::model::Robot;

/// Where every joint and the flange stand. Reused between calls of [`forward_into`] without allocation.
///
/// Rotations are matrices here: their columns are what screws are made of.
#[derive(Clone, Debug)]
pub struct Frames {
    /// Frame of each joint after its motion, in base.
    pub base_from_joint: Vec<IsometryMatrix3<f64>>,
    /// The flange, in base.
    pub base_from_flange: IsometryMatrix3<f64>,
}

impl Frames {
    /// Room for the frames of `robot`.
    pub fn for_robot(robot: &Robot) -> Frames {
        Frames::for_joints(robot.joints().len())
    }

    /// Room for the frames of a chain of so many joints.
    pub(super) fn for_joints(count: usize) -> Frames {
        Frames {
            base_from_joint: vec![IsometryMatrix3::identity(); count],
            base_from_flange: IsometryMatrix3::identity(),
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
    chain_forward_into(robot.chain(), |index| robot.theta(index, q), frames);
}

/// The frames of `chain`, with joint `index` at the chain position `theta(index)` (rad, m), into frames that exist
/// already.
pub(super) fn chain_forward_into(chain: &Chain, theta: impl Fn(usize) -> f64, frames: &mut Frames) {
    let (mut axes, mut origin) = (Matrix3::identity(), Vector3::zeros());
    for (index, (link, frame)) in chain.links().iter().zip(&mut frames.base_from_joint).enumerate() {
        link.before.advance(&mut axes, &mut origin);
        link.motion.advance(theta(index), &mut axes, &mut origin);
        *frame = isometry(axes, origin);
    }
    chain.last_joint_from_flange().advance(&mut axes, &mut origin);
    frames.base_from_flange = isometry(axes, origin);
}

fn isometry(axes: Matrix3<f64>, origin: Vector3<f64>) -> IsometryMatrix3<f64> {
    IsometryMatrix3::from_parts(origin.into(), Rotation3::from_matrix_unchecked(axes))
}

/// Unit axis of joint `index` in base.
pub fn joint_axis(robot: &Robot, frames: &Frames, index: usize) -> Vector3<f64> {
    chain_axis(robot.chain(), frames, index)
}

/// [`joint_axis`] of a chain.
pub(super) fn chain_axis(chain: &Chain, frames: &Frames, index: usize) -> Vector3<f64> {
    let (Motion::Along(axis, _) | Motion::About(axis, _)) = chain.links()[index].motion;
    frames.base_from_joint[index]
        .rotation
        .matrix()
        .column(axis.index())
        .into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::{Amount, Axis, Joint};

    #[test]
    fn inner_form_gives_the_same_flange_as_the_product_of_motions() {
        let motions = vec![
            Motion::Along(Axis::Z, Amount::Constant(0.5)),
            Motion::About(Axis::Y, Amount::Constant(0.9)),
            Motion::About(Axis::Z, Amount::Joint(0)),
            Motion::Along(Axis::X, Amount::Constant(0.2)),
            Motion::About(Axis::Y, Amount::Joint(1)),
            Motion::Along(Axis::X, Amount::Joint(2)),
            Motion::About(Axis::X, Amount::Joint(3)),
            Motion::About(Axis::X, Amount::Constant(0.3)),
        ];
        let robot = Robot::new("some", motions, ["a", "b", "c", "d"].map(Joint::plain).to_vec()).unwrap();
        let q = [0.4, -0.7, 0.25, 2.0];
        let product = robot.chain().base_from_flange(&q).to_homogeneous();
        assert!((forward(&robot, &q).base_from_flange.to_homogeneous() - product).norm() < 1e-15);
    }
}

//! Forward kinematics: joint positions to the frames of the joints and the flange.

use nalgebra::{IsometryMatrix3, Matrix3, Point3, Rotation3, UnitQuaternion, Vector3};

use super::chain::{Chain, Motion};
use super::model::Robot;
use crate::frame::Isometry;

/// Frames of every joint and the flange. Reused between calls of [`forward_into`] without allocation.
///
/// Rotations are matrices here: screws use their columns.
#[derive(Clone, Debug)]
pub struct Frames {
    /// Frame of each joint after its motion, in base.
    pub base_from_joint: Vec<IsometryMatrix3<f64>>,
    /// The flange, in base.
    pub base_from_flange: IsometryMatrix3<f64>,
}

impl Frames {
    /// Working memory for the frames of `robot`.
    pub fn for_robot(robot: &Robot) -> Frames {
        Frames::for_joints(robot.joints().len())
    }

    /// Working memory for the frames of a chain with this many joints.
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

/// The frames of `robot` at joint positions `q` (rad, m; controller coordinates).
///
/// # Panics
/// If `q` has fewer entries than the robot has joints.
pub fn forward(robot: &Robot, q: &[f64]) -> Frames {
    let mut frames = Frames::for_robot(robot);
    forward_into(robot, q, &mut frames);
    frames
}

/// The ground ([`Ground`](super::ground::Ground)) in the base at joint positions `q` (rad, m).
///
/// # Panics
/// If `q` has fewer entries than the robot has joints.
pub fn base_from_ground(robot: &Robot, q: &[f64]) -> Isometry {
    let frames = forward(robot, q);
    nalgebra::convert(robot.chain().ground().in_base(&frames.base_from_joint))
}

/// [`forward`] into existing frames.
pub fn forward_into(robot: &Robot, q: &[f64], frames: &mut Frames) {
    chain_forward_into(robot.chain(), |index| robot.theta(index, q), frames);
}

/// The frames of `chain`, with joint `index` at the chain position `theta(index)` (rad, m), into existing
/// frames.
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

/// The tool on this flange.
pub(super) fn tool_at(base_from_flange: &IsometryMatrix3<f64>, flange_from_tool: &Isometry) -> Isometry {
    let rotation = UnitQuaternion::from_rotation_matrix(&base_from_flange.rotation);
    Isometry::from_parts(base_from_flange.translation, rotation) * flange_from_tool
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
    use crate::arms;
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

    #[test]
    fn frames_of_all_arms_end_where_the_product_of_motions_does() {
        let mut stream = arms::Stream(3);
        for robot in arms::all()
            .into_iter()
            .chain([arms::other::on_rail(&arms::mh12()), arms::other::iiwa14()])
        {
            for _ in 0..50 {
                let q = stream.joints(&robot);
                let theta: Vec<f64> = (0..q.len()).map(|i| robot.theta(i, &q)).collect();
                let product = robot.chain().base_from_flange(&theta).to_homogeneous();
                let away = forward(&robot, &q).base_from_flange.to_homogeneous() - product;
                // Some thirty motions, each rounding by an ulp of some metres.
                assert!(away.norm() < 1e-13, "{}", robot.name());
            }
        }
    }

    #[test]
    fn frames_are_rotations_and_axes_unit_vectors() {
        let robot = arms::hung();
        let frames = forward(&robot, &arms::Stream(8).joints(&robot));
        for (index, frame) in frames.base_from_joint.iter().enumerate() {
            let m = frame.rotation.matrix();
            assert!((m * m.transpose() - Matrix3::identity()).norm() < 1e-14);
            assert!((joint_axis(&robot, &frames, index).norm() - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn a_joint_does_not_move_its_own_axis_nor_those_before_it() {
        let robot = arms::kr120();
        let q = arms::Stream(5).joints(&robot);
        let here = forward(&robot, &q);
        for joint in 0..6 {
            let mut moved = q.clone();
            moved[joint] += 0.7;
            let there = forward(&robot, &moved);
            for fixed in 0..=joint {
                assert!((here.origin(fixed) - there.origin(fixed)).norm() < 1e-13);
                let axes = [&here, &there].map(|frames| joint_axis(&robot, frames, fixed));
                assert!((axes[0] - axes[1]).norm() < 1e-13);
            }
        }
    }

    #[test]
    fn reused_frames_contain_nothing_of_earlier_calls() {
        let robot = arms::irb2400();
        let mut stream = arms::Stream(9);
        let (a, b) = (stream.joints(&robot), stream.joints(&robot));
        let mut used = forward(&robot, &a);
        forward_into(&robot, &b, &mut used);
        assert_eq!(used.base_from_flange, forward(&robot, &b).base_from_flange);
        assert_eq!(used.base_from_joint, forward(&robot, &b).base_from_joint);
    }
}

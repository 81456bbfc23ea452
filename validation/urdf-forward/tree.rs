//! Independent forward kinematics of a URDF: 4 x 4 products along its joints, rotations by Rodrigues' formula.
//!
//! It uses no code of armill; of `urdf-rs` it uses only the parsed text.
//!
//! `root_from_tool0 = product over the joints of (origin)(motion)`, from the root to `tool0`.
//! Fixed joints do not move; a mimic joint on this chain is treated as an independent joint.

use nalgebra::{Matrix3, Matrix4, Vector3};
use urdf_rs::{Joint, JointType};

/// `tool0` in the root link, at these positions of the moving joints between them (rad, m).
pub fn root_from_tool0(urdf: &urdf_rs::Robot, positions: &[f64]) -> Matrix4<f64> {
    let mut positions = positions.iter();
    let steps = joints_to_tool0(urdf).into_iter().map(|joint| {
        let axis = Vector3::from(joint.axis.xyz.0).normalize();
        let mut position = || *positions.next().expect("a position for every moving joint");
        let moved = match joint.joint_type {
            JointType::Revolute | JointType::Continuous => {
                matrix(rodrigues(axis, position()), Vector3::zeros())
            }
            JointType::Prismatic => matrix(Matrix3::identity(), axis * position()),
            _ => Matrix4::identity(),
        };
        at(joint) * moved
    });
    steps.fold(Matrix4::identity(), |root_from_here, step| root_from_here * step)
}

/// How many joints between root and `tool0` move.
pub fn moving_joints(urdf: &urdf_rs::Robot) -> usize {
    joints_to_tool0(urdf)
        .iter()
        .filter(|joint| joint.joint_type != JointType::Fixed)
        .count()
}

/// The joints from the root to `tool0`, in this order: found upwards from the link, by child and parent.
fn joints_to_tool0(urdf: &urdf_rs::Robot) -> Vec<&Joint> {
    let parent_of = |link: &str| urdf.joints.iter().find(|joint| joint.child.link == link);
    let mut joints: Vec<&Joint> =
        std::iter::successors(parent_of("tool0"), |joint| parent_of(&joint.parent.link)).collect();
    joints.reverse();
    joints
}

/// The origin of a joint in the frame of its parent: `Rz(yaw) Ry(pitch) Rx(roll)`, then `xyz`.
fn at(joint: &Joint) -> Matrix4<f64> {
    let [roll, pitch, yaw] = joint.origin.rpy.0;
    let rotation =
        rodrigues(Vector3::z(), yaw) * rodrigues(Vector3::y(), pitch) * rodrigues(Vector3::x(), roll);
    matrix(rotation, Vector3::from(joint.origin.xyz.0))
}

/// `R = 1 + sin(a) [k] + (1 - cos(a)) [k]^2` with the cross product matrix `[k]` of a unit axis.
fn rodrigues(k: Vector3<f64>, angle: f64) -> Matrix3<f64> {
    let cross = Matrix3::new(0.0, -k.z, k.y, k.z, 0.0, -k.x, -k.y, k.x, 0.0);
    Matrix3::identity() + cross * angle.sin() + cross * cross * (1.0 - angle.cos())
}

/// Rotation and translation as one 4 x 4 matrix.
fn matrix(rotation: Matrix3<f64>, translation: Vector3<f64>) -> Matrix4<f64> {
    let mut matrix = Matrix4::identity();
    matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&rotation);
    matrix.fixed_view_mut::<3, 1>(0, 3).copy_from(&translation);
    matrix
}

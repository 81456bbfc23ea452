//! k of openrr: forward kinematics and Jacobian of any chain; its inverse is numeric and is left out.

use std::hint::black_box;

use k::nalgebra::{DMatrix, DVector};
use k::{JointType, NodeBuilder, SerialChain, Translation3, Vector3};

use crate::agreement::{relative, worst};
use crate::clock::Candidate;
use crate::work::C66_AT;
use crate::workload::{A1, A2, C1, C2, C3, C4, COMPLIANCE, Pose, SIGNS, TOOL};
use crate::yardstick;

/// J C J^T of given joint positions.
pub fn candidates(poses: &[Pose]) -> Vec<Candidate<'_>> {
    let (arm, angles) = (mh12(), poses.iter().map(yardstick::joints).collect::<Vec<_>>());
    let matrix = move || {
        for joints in &angles {
            black_box(compliance(&arm, joints));
        }
    };
    vec![Candidate::new("openrr k 0.32.0", C66_AT, poses.len(), matrix).note("k::jacobian, then J C J^T")]
}

/// How far its compliance is off.
pub fn difference(poses: &[Pose]) -> f64 {
    let arm = mh12();
    worst(poses.iter().map(|pose| {
        let joints = yardstick::joints(pose);
        relative(compliance(&arm, &joints).as_slice(), &yardstick::c66_at(&joints))
    }))
}

fn compliance(arm: &SerialChain<f64>, joints: &[f64; 6]) -> DMatrix<f64> {
    arm.set_joint_positions_unchecked(joints);
    let jacobian = k::jacobian(arm);
    let diagonal = DMatrix::from_diagonal(&DVector::from_row_slice(&COMPLIANCE));
    &jacobian * diagonal * jacobian.transpose()
}

/// The chain at joint positions zero: upper arm up, forearm to the front.
fn mh12() -> SerialChain<f64> {
    let (x, y, z) = (Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis());
    let joints = [
        ("S", z, [0.0, 0.0, C1]),
        ("L", y, [A1, 0.0, 0.0]),
        ("U", y, [0.0, 0.0, C2]),
        ("R", x, [C3, 0.0, -A2]),
        ("B", y, [0.0; 3]),
        ("T", x, [0.0; 3]),
    ];
    let mut nodes = Vec::with_capacity(7);
    for ((name, axis, [x, y, z]), sign) in joints.into_iter().zip(SIGNS) {
        let axis = if sign < 0.0 { -axis } else { axis };
        let joint = NodeBuilder::new()
            .name(name)
            .translation(Translation3::new(x, y, z));
        nodes.push(joint.joint_type(JointType::Rotational { axis }).into_node());
    }
    let tool = NodeBuilder::new()
        .name("tool")
        .translation(Translation3::new(C4 + TOOL, 0.0, 0.0));
    nodes.push(tool.into_node());
    for pair in nodes.windows(2) {
        pair[1].set_parent(&pair[0]);
    }
    SerialChain::from_end(&nodes[6])
}

//! ik-geo: any six joints by subproblems; here spherical wrist with two parallel axes. Verifies nothing.

use std::hint::black_box;

use ik_geo::inverse_kinematics::auxiliary::{Kinematics, Matrix3x7};
use ik_geo::inverse_kinematics::spherical_two_parallel;
use ik_geo::nalgebra::{Matrix3, Matrix3x6, Vector3};

use super::postures_apart;
use crate::agreement::worst;
use crate::clock::Candidate;
use crate::work::IK8;
use crate::workload::{A1, A2, C1, C2, C3, C4, Pose, SIGNS, TOOL};

/// Rotation and place of the tool.
type Target = (Matrix3<f64>, Vector3<f64>);

/// All postures.
pub fn candidates(poses: &[Pose]) -> Vec<Candidate<'_>> {
    let (arm, targets) = (mh12(), poses.iter().map(target).collect::<Vec<_>>());
    let inverse = move || {
        for (rotation, place) in &targets {
            black_box(spherical_two_parallel(rotation, place, &arm));
        }
    };
    vec![
        Candidate::new("ik-geo 0.1.2", IK8, poses.len(), inverse)
            .note("branches out of reach come as least squares"),
    ]
}

/// How far its postures are off.
pub fn difference(poses: &[Pose]) -> f64 {
    let arm = mh12();
    worst(poses.iter().map(|pose| {
        let (rotation, place) = target(pose);
        let (postures, _) = spherical_two_parallel(&rotation, &place, &arm);
        let found: Vec<[f64; 6]> = postures.iter().map(|q| (*q).into()).collect();
        postures_apart(&found, pose)
    }))
}

/// Axes and steps at joint positions zero: upper arm up, forearm to the front.
fn mh12() -> Kinematics<6, 7> {
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    let axes = [z, y, y, x, y, x];
    let signed: Vec<Vector3<f64>> = axes.iter().zip(SIGNS).map(|(axis, sign)| axis * sign).collect();
    Kinematics {
        h: Matrix3x6::from_columns(&signed),
        p: Matrix3x7::from_columns(&[
            C1 * z,
            A1 * x,
            C2 * z,
            -A2 * z + C3 * x,
            Vector3::zeros(),
            Vector3::zeros(),
            (C4 + TOOL) * x,
        ]),
    }
}

/// The rotation counts from joint positions zero, where the tool's z is base x.
fn target(pose: &Pose) -> Target {
    let [a, b, c, x, d, e, f, y, g, h, i, z] = *pose;
    // The flange at zero: turned by -90 deg about y, then by 180 deg about x.
    let at_zero = Matrix3::new(0.0, 0.0, 1.0, 0.0, -1.0, 0.0, 1.0, 0.0, 0.0);
    (
        Matrix3::new(a, b, c, d, e, f, g, h, i) * at_zero.transpose(),
        Vector3::new(x, y, z),
    )
}

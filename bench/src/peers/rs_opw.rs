//! rs-opw-kinematics: closed form for the same class of arms; verifies every posture by forward kinematics.

use std::hint::black_box;

use rs_opw_kinematics::glam::{DMat3, DQuat, DVec3};
use rs_opw_kinematics::kinematic_traits::{Kinematics, Pose as Glam};
use rs_opw_kinematics::kinematics_impl::OPWKinematics;
use rs_opw_kinematics::parameters::opw_kinematics::Parameters;

use super::postures_apart;
use crate::agreement::{apart, relative, worst};
use crate::clock::Candidate;
use crate::work::{C66, IK8};
use crate::workload::{A1, A2, C1, C2, C3, C4, COMPLIANCE, OFFSETS, Pose, SIGNS, TOOL};
use crate::yardstick;

const WHO: &str = "rs-opw-kinematics 3.0.0";

/// All postures; and the compliance of one of them.
pub fn candidates(poses: &[Pose]) -> Vec<Candidate<'_>> {
    let flanges: Vec<Glam> = poses.iter().map(flange).collect();
    let (one, other) = (flanges.clone(), flanges);
    let inverse = move || {
        let arm = mh12();
        for pose in &one {
            black_box(arm.inverse(pose));
        }
    };
    let matrix = move || {
        let arm = mh12();
        for pose in &other {
            black_box(arm.inverse(pose).first().map(|joints| compliance(&arm, joints)));
        }
    };
    vec![
        Candidate::new(WHO, IK8, poses.len(), inverse).note("verified"),
        Candidate::new(WHO, C66, poses.len(), matrix)
            .note("all postures, then forward_with_joint_poses of the first; sums ours"),
    ]
}

/// How far postures and compliance are off.
pub fn difference(poses: &[Pose]) -> f64 {
    let arm = mh12();
    worst(poses.iter().map(|pose| {
        let found = arm.inverse(&flange(pose));
        let matrices = found
            .iter()
            .map(|joints| relative(&compliance(&arm, joints), &yardstick::c66_at(joints)));
        let front_up = found.iter().map(|joints| apart(joints, &yardstick::joints(pose)));
        worst([
            postures_apart(&found, pose),
            worst(matrices),
            front_up.fold(f64::INFINITY, f64::min),
        ])
    }))
}

fn mh12() -> OPWKinematics {
    OPWKinematics::new(Parameters {
        a1: A1,
        a2: A2,
        b: 0.0,
        c1: C1,
        c2: C2,
        c3: C3,
        c4: C4,
        offsets: OFFSETS,
        sign_corrections: SIGNS.map(|sign| sign as i8),
        dof: 6,
    })
}

fn flange(pose: &Pose) -> Glam {
    let [a, b, c, x, d, e, f, y, g, h, i, z] = *pose;
    let rotation = DMat3::from_cols(DVec3::new(a, d, g), DVec3::new(b, e, h), DVec3::new(c, f, i));
    let at = DVec3::new(x, y, z) - TOOL * rotation.z_axis;
    Glam::from_parts(at, DQuat::from_mat3(&rotation))
}

/// Its frames, our sums.
fn compliance(arm: &OPWKinematics, joints: &[f64; 6]) -> [f64; 36] {
    let frames = arm.forward_with_joint_poses(joints);
    let tcp = frames[5].translation + frames[5].rotation * (TOOL * DVec3::Z);
    let about = [DVec3::Z, DVec3::Y, DVec3::Y, DVec3::Z, DVec3::Y, DVec3::Z];
    let mut sum = [0.0; 36];
    for ((frame, axis), c) in frames.iter().zip(about).zip(COMPLIANCE) {
        let z = frame.rotation * axis;
        let v = z.cross(tcp - frame.translation);
        let s = [v.x, v.y, v.z, z.x, z.y, z.z];
        for row in 0..6 {
            for column in 0..6 {
                sum[6 * row + column] += c * s[row] * s[column];
            }
        }
    }
    sum
}

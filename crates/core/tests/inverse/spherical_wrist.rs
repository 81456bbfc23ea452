//! Arms whose last or first three axes meet: every posture, compared with matrices and with the named closed form.

use armill_core::frame::Isometry;
use armill_core::nalgebra::{Matrix4, UnitQuaternion, Vector3};
use armill_core::robot::Robot;
use armill_core::robot::inverse::{SphericalWrist, posture_at, postures};

use crate::arms::other::{self, DhRow};
use crate::arms::{self, Stream};
use crate::{apart, at, flange_of_rows, round_trips};

/// Arms whose last or first three axes meet, without a named closed form.
fn with_spherical_wrist() -> [(Robot, [DhRow; 6]); 4] {
    [
        ("made-up/puma-like", other::PUMA_LIKE),
        ("made-up/skewed", other::SKEWED),
        ("made-up/tilted-wrist", other::TILTED_WRIST),
        ("made-up/spherical-shoulder", other::SPHERICAL_SHOULDER),
    ]
    .map(|(name, rows)| (other::free(name, &rows), rows))
}

#[test]
fn spherical_wrists_return_the_original_joint_positions() {
    for (robot, _) in with_spherical_wrist() {
        assert_eq!(robot.inverse().word(), "closed_form", "{}", robot.name());
        let trips = round_trips(&robot, 10_000);
        assert!(trips.returned as f64 > 0.9999 * trips.poses as f64, "{trips:?}");
    }
}

#[test]
fn postures_of_spherical_wrists_are_distinct_and_reach_the_pose_by_its_dh_matrices() {
    let tool = Isometry::identity();
    for (robot, rows) in with_spherical_wrist() {
        let (mut stream, mut most) = (Stream(4), 0);
        for _ in 0..2000 {
            let target = flange_of_rows(&rows, &stream.joints(&robot));
            let pose = isometry(&target);
            let found = postures(&robot, &pose, at(&tool)).unwrap();
            for (i, posture) in found.iter().enumerate() {
                // The pose is read off the matrix to rounding, and verified to 1e-9.
                assert!((flange_of_rows(&rows, &posture.joints) - target).norm() < 2e-9);
                assert!(
                    found[..i]
                        .iter()
                        .all(|other| apart(&robot, &posture.joints, &other.joints) > 1e-5)
                );
            }
            most = most.max(found.len());
        }
        assert_eq!(most, 8, "{}", robot.name());
    }
}

/// A matrix as rotation and point.
fn isometry(matrix: &Matrix4<f64>) -> Isometry {
    let axes = matrix.fixed_view::<3, 3>(0, 0).into_owned();
    let rotation = UnitQuaternion::from_matrix(&axes);
    Isometry::from_parts(
        Vector3::new(matrix[(0, 3)], matrix[(1, 3)], matrix[(2, 3)]).into(),
        rotation,
    )
}

#[test]
fn the_spherical_wrist_of_an_ortho_parallel_arm_has_the_postures_of_its_closed_form() {
    for robot in [arms::mh12(), arms::kr120(), other::kr210_l150()] {
        let wrist = SphericalWrist::recognise(robot.chain()).unwrap();
        let tool = Isometry::identity();
        let (mut stream, mut compared) = (Stream(6), 0);
        for _ in 0..10_000 {
            let pose = posture_at(&robot, &stream.joints(&robot), &tool).base_from_tool;
            let named = postures(&robot, &pose, at(&tool)).unwrap();
            // Near a singularity two postures may be nearer than the tolerance for distinct ones.
            if named.iter().any(|posture| posture.singularity.is_some()) {
                continue;
            }
            let general = wrist.chain_positions(&pose, None);
            assert_eq!(general.len(), named.len(), "{}", robot.name());
            for posture in &named {
                let theta: Vec<f64> = (0..6).map(|i| robot.theta(i, &posture.joints)).collect();
                // A degree from a singularity 1e-10 of the pose is at most 1e-8 of a joint.
                let nearest = general.iter().map(|other| apart(&robot, other, &theta));
                assert!(nearest.fold(f64::INFINITY, f64::min) < 1e-8, "{}", robot.name());
            }
            compared += 1;
        }
        assert!(compared > 8000, "{}: {compared}", robot.name());
    }
}

#[test]
fn calibrated_spherical_wrists_return_the_original_joint_positions() {
    for (ideal, _) in with_spherical_wrist() {
        let robot = other::calibrated(&ideal, 5e-4);
        assert_eq!(robot.inverse().word(), "polished", "{}", robot.name());
        let trips = round_trips(&robot, 10_000);
        assert!(trips.returned as f64 > 0.999 * trips.poses as f64, "{trips:?}");
    }
}

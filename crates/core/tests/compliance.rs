//! Properties of compliance and deviation for any arm, posture and load.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used)]

mod arms;

use armill_core::compliance::{
    by_force, compliance_at_tool, permissible_force, permissible_force_in_worst_direction,
    principal_compliances, stiffness_at_tool,
};
use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::nalgebra::{Matrix3, Matrix6, Point3, Rotation3, Unit, Vector3};
use armill_core::robot::inverse::{ToolAt, posture_at, postures};
use armill_core::robot::{Amount, Axis, Motion, Posture, Robot};
use armill_core::source::elastic::predict;
use armill_core::spatial::{Wrench, adjoint};
use proptest::prelude::*;

fn arm() -> impl Strategy<Value = (usize, [f64; 6])> {
    (0..arms::ALL.len(), prop::array::uniform6(0.0..1.0_f64))
}

fn wrench() -> impl Strategy<Value = Wrench> {
    prop::array::uniform6(-1.0..1.0_f64).prop_map(|[a, b, c, d, e, f]| Wrench {
        force: Vector3::new(a, b, c) * 100.0,
        moment: Vector3::new(d, e, f) * 10.0,
    })
}

fn random_posture(robot: &Robot, unit: &[f64; 6]) -> Posture {
    let q = arms::positions(robot, unit);
    posture_at(robot, &q, &arms::bent_tool())
}

fn compliance(robot: &Robot, posture: &Posture) -> Matrix6<f64> {
    compliance_at_tool(&posture.screws, robot.compliance().unwrap())
}

/// Rounding of six products of three factors each.
const ROUNDING: f64 = 100.0 * f64::EPSILON;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn compliance_is_symmetric_and_positive_semidefinite((arm, unit) in arm()) {
        let robot = &arms::ALL[arm];
        let c = compliance(robot, &random_posture(robot, &unit));
        prop_assert!((c - c.transpose()).norm() <= ROUNDING * c.norm());
        let least = c.symmetric_eigenvalues().min();
        prop_assert!(least > -ROUNDING * c.norm(), "eigenvalue {least}");
    }

    #[test]
    fn deviation_is_compliance_times_wrench((arm, unit) in arm(), load in wrench()) {
        let robot = &arms::ALL[arm];
        let posture = random_posture(robot, &unit);
        let given = predict(&posture, robot.compliance().unwrap(), &load).twist.to_vector();
        let c = compliance(robot, &posture);
        let product = c * load.to_vector();
        prop_assert!((given - product).norm() <= ROUNDING * c.norm() * load.to_vector().norm());
    }

    #[test]
    fn deviation_is_linear_in_force_and_in_compliance((arm, unit) in arm(), load in wrench(), factor in 0.1..10.0_f64) {
        let robot = &arms::ALL[arm];
        let (posture, joints) = (random_posture(robot, &unit), robot.compliance().unwrap());
        let once = predict(&posture, joints, &load);
        let scaled = load * factor;
        let softer: Vec<_> = joints
            .iter()
            .map(|c| armill_core::robot::JointCompliance { value: c.value * factor, ..*c })
            .collect();
        for other in [predict(&posture, joints, &scaled), predict(&posture, &softer, &load)] {
            let away = other.twist.to_vector() - once.twist.to_vector() * factor;
            let size: f64 = once.shares.iter().map(|s| s.to_vector().norm()).sum();
            prop_assert!(away.norm() <= ROUNDING * size * factor);
        }
    }

    #[test]
    fn shares_of_the_joints_add_up_to_the_deviation((arm, unit) in arm(), load in wrench()) {
        let robot = &arms::ALL[arm];
        let given = predict(&random_posture(robot, &unit), robot.compliance().unwrap(), &load);
        let sum: armill_core::spatial::Twist = given.shares.iter().copied().sum();
        prop_assert_eq!(sum, given.twist);
    }

    #[test]
    fn uncertainty_agrees_with_moving_each_compliance_by_its_own((arm, unit) in arm(), load in wrench()) {
        let robot = &arms::ALL[arm];
        let (posture, joints) = (random_posture(robot, &unit), robot.compliance().unwrap());
        let given = predict(&posture, joints, &load);
        let mut variance = Vector3::zeros();
        for i in 0..joints.len() {
            let mut moved = joints.to_vec();
            moved[i].value += moved[i].standard_uncertainty;
            let by = predict(&posture, &moved, &load).twist.linear - given.twist.linear;
            variance += by.component_mul(&by);
        }
        let size: f64 = given.shares.iter().map(|s| s.linear.norm_squared()).sum();
        // The difference of two nearly equal numbers keeps half the digits that matter here.
        prop_assert!((variance - given.covariance.diagonal()).amax() <= 1e-9 * size);
    }

    /// Turning and moving the whole cell changes nothing but the names of the axes.
    #[test]
    fn compliance_follows_the_base_frame((arm, unit) in arm(), angles in prop::array::uniform3(-3.0..3.0_f64)) {
        let robot = &arms::ALL[arm];
        let here = random_posture(robot, &unit);
        let shift = Vector3::new(0.7, -1.1, 0.4);
        let mut motions = vec![
            Motion::Along(Axis::X, Amount::Constant(shift.x)),
            Motion::Along(Axis::Y, Amount::Constant(shift.y)),
            Motion::Along(Axis::Z, Amount::Constant(shift.z)),
            Motion::About(Axis::Z, Amount::Constant(angles[2])),
            Motion::About(Axis::Y, Amount::Constant(angles[1])),
            Motion::About(Axis::X, Amount::Constant(angles[0])),
        ];
        motions.extend_from_slice(robot.chain().motions());
        let moved = Robot::new("moved", motions, robot.joints().to_vec())
            .unwrap()
            .with_compliance(robot.compliance().unwrap().to_vec())
            .unwrap();
        let there = posture_at(&moved, &here.joints, &arms::bent_tool());
        let world_from_base = from_xyz_and_fixed_angles(shift, Vector3::from(angles));
        let turned = Isometry::from_parts(here.base_from_tool.translation, world_from_base.rotation);
        let ad = adjoint(&turned, &Point3::from(here.base_from_tool.translation.vector));
        let expected = ad * compliance(robot, &here) * ad.transpose();
        let found = compliance(&moved, &there);
        prop_assert!((found - expected).norm() <= 1e-12 * expected.norm());
    }

    #[test]
    fn the_wrist_flip_leaves_the_compliance_unchanged((arm, unit) in arm()) {
        let robot = &arms::ALL[arm];
        let here = random_posture(robot, &unit);
        prop_assume!(here.singularity.is_none());
        let tool = arms::bent_tool();
        let found = postures(robot, &here.base_from_tool, ToolAt::on(&tool)).unwrap();
        for pair in found.chunks(2) {
            let [a, b] = pair else { continue };
            let (a, b) = (compliance(robot, a), compliance(robot, b));
            prop_assert!((a - b).norm() <= 1e-9 * a.norm());
        }
    }

    #[test]
    fn a_rigid_arm_with_one_soft_joint_turns_about_that_joint((arm, unit) in arm(), soft in 0..6usize, load in wrench()) {
        let robot = &arms::ALL[arm];
        let posture = random_posture(robot, &unit);
        let mut joints = robot.compliance().unwrap().to_vec();
        for (i, joint) in joints.iter_mut().enumerate() {
            joint.value = if i == soft { 1e-6 } else { 0.0 };
        }
        let given = predict(&posture, &joints, &load);
        let stiffness = stiffness_at_tool(&compliance_at_tool(&posture.screws, &joints), 1.0);
        prop_assert!(stiffness.rank <= 1);
        let along = posture.screws[soft] * (1e-6 * posture.screws[soft].dot(&load));
        let away = given.twist.to_vector() - along.to_vector();
        prop_assert!(away.norm() <= ROUNDING * along.to_vector().norm());
    }
}

/// The force block of some posture of every arm.
fn blocks() -> Vec<Matrix3<f64>> {
    let mut stream = arms::Stream(91);
    let of = |robot: &Robot| {
        let posture = posture_at(robot, &stream.joints(robot), &arms::bent_tool());
        by_force(&compliance(robot, &posture))
    };
    arms::ALL.iter().map(of).collect()
}

#[test]
fn principal_compliances_turn_with_the_base_and_add_up_to_the_trace() {
    let turn = Rotation3::from_euler_angles(0.4, -1.1, 2.0);
    for block in blocks() {
        let turned = turn.matrix() * block * turn.matrix().transpose();
        let (here, there) = (principal_compliances(&block), principal_compliances(&turned));
        let sum: f64 = here.iter().map(|p| p.value).sum();
        assert!((sum - block.trace()).abs() < ROUNDING * block.norm());
        for (a, b) in here.iter().zip(&there) {
            assert!((a.value - b.value).abs() < ROUNDING * block.norm());
            // The sign of a direction has no meaning; values of some arms are close to each other.
            let along = (turn * a.direction).dot(&b.direction).abs();
            let alone = here
                .iter()
                .all(|p| p == a || (p.value / a.value - 1.0).abs() > 0.01);
            assert!(!alone || (along - 1.0).abs() < 1e-10, "{along}");
        }
    }
}

#[test]
fn permissible_forces_grow_with_the_limit_and_fall_with_the_compliance() {
    let normal = Unit::new_normalize(Vector3::new(0.2, -0.4, 1.0));
    let f = Unit::new_normalize(Vector3::new(1.0, 2.0, -0.5));
    for block in blocks() {
        let force = permissible_force(&block, normal, f, 50e-6);
        let (worst, _) = permissible_force_in_worst_direction(&block, normal, 50e-6);
        assert!(worst <= force * (1.0 + ROUNDING));
        for factor in [0.5, 3.0] {
            let of_limit = permissible_force(&block, normal, f, 50e-6 * factor);
            let of_softer = permissible_force(&(block * factor), normal, f, 50e-6);
            assert!((of_limit / force - factor).abs() < ROUNDING * factor);
            assert!((of_softer * factor / force - 1.0).abs() < ROUNDING);
            let (worst_of_limit, _) = permissible_force_in_worst_direction(&block, normal, 50e-6 * factor);
            assert!((worst_of_limit / worst - factor).abs() < 1e-9);
        }
        // The side from which the plane is seen does not count, nor the sign of the force.
        let seen = permissible_force(&block, -normal, -f, 50e-6);
        assert!((seen / force - 1.0).abs() < ROUNDING);
    }
}

#[test]
fn what_moves_nothing_in_the_plane_has_no_bound() {
    // Soft along z alone: on the plane across z nothing moves.
    let block = Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, 1e-6));
    let z = Vector3::z_axis();
    assert_eq!(permissible_force(&block, z, z, 50e-6), f64::INFINITY);
    assert_eq!(
        permissible_force_in_worst_direction(&block, z, 50e-6).0,
        f64::INFINITY
    );
    let (force, direction) = permissible_force_in_worst_direction(&block, Vector3::x_axis(), 50e-6);
    assert!((force - 50.0).abs() < 1e-9 && direction.cross(&Vector3::z()).norm() < 1e-9);
}

#[test]
fn the_force_block_gives_the_displacement_of_a_pure_force() {
    let mut stream = arms::Stream(92);
    for robot in arms::ALL.iter() {
        let posture = posture_at(robot, &stream.joints(robot), &arms::bent_tool());
        let c = compliance(robot, &posture);
        let force = stream.vector(100.0);
        let given = predict(&posture, robot.compliance().unwrap(), &Wrench::from_force(force)).twist;
        assert!((by_force(&c) * force - given.linear).norm() < ROUNDING * c.norm() * force.norm());
    }
}

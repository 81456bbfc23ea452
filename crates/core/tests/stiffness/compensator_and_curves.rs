//! Joints other than linear springs: a compensator in addition to the drive, or a torque curve instead of it.

use armill_core::frame::Isometry;
use armill_core::nalgebra::Vector3;
use armill_core::robot::inverse::posture_at;
use armill_core::robot::{Compensator, JointCurve, Mass, Structure, TorqueCurve};
use armill_core::source::elastic::predict;
use armill_core::source::{ArmState, StiffnessModel, Unstable};
use armill_core::spatial::Wrench;

use crate::{arms, fanuc_masses, full_arm, weighing};

#[test]
fn a_compensator_takes_its_slope_from_the_joint_and_its_torque_from_gravity() {
    let (robot, tool) = (arms::r2000ic(), Isometry::identity());
    let compensator = Compensator {
        joint: 1,
        fixed_radius: 0.69,
        arm_radius: 0.185,
        angle: 0.17,
        free_length: 0.458,
        stiffness: 4e6,
    };
    let structure = Structure {
        compensator: Some(compensator),
        ..Structure::EMPTY
    };
    let model = StiffnessModel {
        structure,
        ..StiffnessModel::DRIVES.clone()
    };
    let q = [0.1, 0.4, -0.3, 0.4, 0.5, -0.6];
    let push = Wrench::from_force(Vector3::new(100.0, 50.0, -300.0));
    let found = arms::predicted(&full_arm(&robot, &model, &tool), &q, &push)
        .unwrap()
        .twist
        .linear;
    // The simple model with the joint's compliance 1/(k - dM/dtheta), dM/dtheta from the energy of the spring.
    let theta = robot.theta(1, &q);
    let h = 1e-4;
    let e = |by: f64| arms::spring_energy(&compensator, theta + by);
    let slope = -(e(h) - 2.0 * e(0.0) + e(-h)) / (h * h);
    let mut drives = robot.compliance().unwrap().to_vec();
    drives[1].value = 1.0 / (1.0 / drives[1].value - slope);
    let witness = predict(&posture_at(&robot, &q, &tool), &drives, &push)
        .twist
        .linear;
    assert!(slope.abs() > 1e4, "{slope} N m/rad");
    assert!((found - witness).norm() < 1e-7 * witness.norm());
    // The same from the equilibrium, for a load that barely moves the arm.
    let soft = StiffnessModel {
        load_dependent: true,
        ..model.clone()
    };
    let small = Wrench::from_force(push.force * 1e-3);
    let loaded = arms::predicted(&full_arm(&robot, &soft, &tool), &q, &small)
        .unwrap()
        .twist
        .linear;
    assert!((loaded - witness * 1e-3).norm() < 1e-5 * witness.norm() * 1e-3);
    // Under gravity its torque is added to that of the masses.
    let mut weighed = weighing(model.structure.clone());
    weighed.gravity.as_mut().unwrap().reference = q.to_vec();
    let mut arm_state = ArmState::new(full_arm(&robot, &weighed, &tool));
    arm_state.set_joints(&q);
    let torque = -(e(h) - e(-h)) / (2.0 * h);
    assert!((arm_state.gravity_torques()[1] - torque).abs() < 1e-2, "{torque}");
    // A compensator stiffer than its joint lets the arm fall: an outcome, not a number.
    let mut strong = weighed.clone();
    strong.structure.compensator.as_mut().unwrap().stiffness = 1e12;
    let fallen = arms::predicted(&full_arm(&robot, &strong, &tool), &q, &push);
    assert_eq!(fallen.unwrap_err(), Unstable::Buckles);
}

#[test]
fn a_straight_torque_curve_is_a_compliance_and_a_bent_one_depends_on_gravity() {
    let (robot, tool) = (arms::r2000ic(), Isometry::identity());
    let c = robot.compliance().unwrap()[1].value;
    let curve = |points: Vec<[f64; 2]>| {
        let rising = TorqueCurve::new(points).unwrap();
        vec![
            None,
            Some(JointCurve {
                rising,
                falling: None,
            }),
        ]
    };
    let straight = curve(vec![[-1e4, -1e4 * c], [1e4, 1e4 * c]]);
    let q = [0.1, 0.4, -0.3, 0.4, 0.5, -0.6];
    let push = Wrench::from_force(Vector3::new(100.0, 50.0, -300.0));
    let given = |curves: Vec<Option<JointCurve>>, masses: Vec<Mass>, load_dependent: bool| {
        let mut model = weighing(Structure {
            curves,
            masses,
            ..Structure::EMPTY
        });
        model.gravity.as_mut().unwrap().reference = q.to_vec();
        model.load_dependent = load_dependent;
        arms::predicted(&full_arm(&robot, &model, &tool), &q, &push)
            .unwrap()
            .twist
            .linear
    };
    let simple = predict(&posture_at(&robot, &q, &tool), robot.compliance().unwrap(), &push)
        .twist
        .linear;
    assert!((given(straight.clone(), Vec::new(), false) - simple).norm() < 1e-13 * simple.norm());
    assert!((given(straight.clone(), fanuc_masses(), false) - simple).norm() < 1e-12 * simple.norm());
    let loaded = given(Vec::new(), fanuc_masses(), true);
    assert!((given(straight, fanuc_masses(), true) - loaded).norm() < 1e-11 * simple.norm());
    // Stiff beyond 500 N m: gravity (some kN m at this posture) takes the joint there, the load finds it stiff.
    let knee = curve(vec![[-500.0, -500.0 * c], [500.0, 500.0 * c], [1e5, 500.0 * c]]);
    let freely = given(knee.clone(), Vec::new(), false);
    let under_gravity = given(knee, fanuc_masses(), false);
    let rigid = {
        let mut drives = robot.compliance().unwrap().to_vec();
        drives[1].value = 0.0;
        predict(&posture_at(&robot, &q, &tool), &drives, &push)
            .twist
            .linear
    };
    // Without gravity it is soft up to the knee, and stiff beyond it under a larger load.
    let screw = posture_at(&robot, &q, &tool).screws[1];
    let soft = rigid + screw.linear * (screw.dot(&push).clamp(-500.0, 500.0) * c);
    assert!((freely - soft).norm() < 1e-12 * simple.norm(), "{freely} {soft}");
    assert!(
        (under_gravity - rigid).norm() < 1e-12 * rigid.norm(),
        "{under_gravity} {rigid}"
    );
}

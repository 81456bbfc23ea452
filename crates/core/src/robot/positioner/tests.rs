use nalgebra::{Point3, UnitQuaternion, Vector3};

use super::*;
use crate::arms::{self, Stream};
use crate::frame::from_xyz_and_fixed_angles;
use crate::kernel::postures_at;
use crate::robot::forward::forward;
use crate::robot::inverse::{ToolAt, postures, tool_on};
use crate::robot::{BacklashSide, Limits};
use crate::source::{Arm, ArmState, Gravity, StiffnessModel, ThermalGrowth};
use crate::spatial::Wrench;
use crate::watch::Watch;

/// Tilts about x, against the right hand, then turns about z; both soft, the tilt with backlash.
fn two_axes() -> Robot {
    let constant = |axis, value| Motion::Along(axis, Amount::Constant(value));
    let motions = vec![
        constant(Axis::Z, 0.4),
        Motion::About(Axis::Y, Amount::Constant(0.1)),
        Motion::About(Axis::X, Amount::Joint(0)),
        constant(Axis::Z, 0.1),
        constant(Axis::Y, -0.03),
        Motion::About(Axis::Z, Amount::Joint(1)),
        constant(Axis::Z, 0.05),
    ];
    let mut joints = [Joint::plain("tilt"), Joint::plain("turn")].to_vec();
    joints[0].sign = Sign::Negative;
    joints[0].zero_offset = 0.2;
    joints[0].limits = Some(Limits {
        lower: -1.6,
        upper: 1.6,
    });
    let compliance = [2e-6, 3e-6].map(|value| JointCompliance {
        value,
        standard_uncertainty: 0.1 * value,
    });
    let mass = |attachment, mass, x| Mass {
        attachment,
        mass,
        centre: Point3::new(x, 0.02, 0.07),
        inertia: None,
        relative_uncertainty: 0.0,
    };
    let structure = Structure {
        masses: vec![
            mass(Attachment::Base, 500.0, 0.0),
            mass(Attachment::Joint(0), 80.0, 0.1),
            mass(Attachment::Joint(1), 40.0, -0.05),
            mass(Attachment::Flange, 120.0, 0.2),
        ],
        backlash: vec![Some(Backlash {
            gap: 1e-4,
            standard_uncertainty: 1e-5,
            side: BacklashSide::Torque,
        })],
        ..Structure::EMPTY
    };
    let robot = Robot::new("positioner", motions, joints).unwrap();
    let robot = robot.with_compliance(compliance.to_vec()).unwrap();
    robot.with_structure(structure).unwrap()
}

fn root() -> Isometry {
    from_xyz_and_fixed_angles(Vector3::new(1.2, -0.1, -0.3), Vector3::new(0.05, -0.1, 0.7))
}

/// The FANUC arm with springs, masses, a compensator and a torque curve.
fn arm() -> Robot {
    let arm = arms::r2000ic();
    let mass = |attachment, mass| Mass {
        attachment,
        mass,
        centre: Point3::new(0.05, -0.1, 0.2),
        inertia: None,
        relative_uncertainty: 0.0,
    };
    let structure = Structure {
        springs: vec![
            Spring::about(Attachment::Base, Vector3::y(), RIGID_ENOUGH),
            Spring::along(Attachment::Base, Vector3::x(), RIGID_ENOUGH),
            Spring::about(Attachment::Joint(1), Vector3::z(), RIGID_ENOUGH),
            Spring::about(Attachment::Flange, Vector3::x(), RIGID_ENOUGH),
        ],
        masses: vec![
            mass(Attachment::Base, 300.0),
            mass(Attachment::Joint(1), 150.0),
            mass(Attachment::Joint(2), 90.0),
            mass(Attachment::Tool, 30.0),
        ],
        compensator: Some(arms::compensator(1)),
        curves: vec![None, None, Some(arms::curves(2))],
        ..Structure::EMPTY
    };
    arm.with_structure(structure).unwrap()
}

const RIGID_ENOUGH: JointCompliance = JointCompliance {
    value: 4e-8,
    standard_uncertainty: 0.0,
};

const HOME: [f64; 2] = [0.3, -0.8];

/// The arm and positioner as one chain.
fn both(arm: &Robot, positioner: &Robot) -> Robot {
    let standing = Positioner {
        robot: positioner,
        base_from_root: &root(),
        home: &HOME,
    };
    arm.on_positioner(&standing, "ground").unwrap()
}

/// The table in the base of the arm, from the forward kinematics of the positioner.
fn base_from_table(positioner: &Robot, q: &[f64]) -> Isometry {
    root() * tool_on(&forward(positioner, q), &Isometry::identity())
}

/// Joint positions of the whole chain.
fn joined(of_positioner: &[f64], of_arm: &[f64]) -> Vec<f64> {
    of_positioner.iter().rev().chain(of_arm).copied().collect()
}

#[test]
fn the_chain_goes_from_the_table_to_the_flange() {
    let (arm, positioner) = (arm(), two_axes());
    let whole = both(&arm, &positioner);
    let mut stream = Stream(5);
    for _ in 0..100 {
        let (a, p) = (
            stream.joints(&arm),
            [stream.between(-1.5, 1.5), stream.between(-3.0, 3.0)],
        );
        let flange = |robot: &Robot, q: &[f64]| tool_on(&forward(robot, q), &Isometry::identity());
        let expected = base_from_table(&positioner, &p).inverse() * flange(&arm, &a);
        let q = joined(&p, &a);
        let found = flange(&whole, &q);
        assert!((found.to_homogeneous() - expected.to_homogeneous()).norm() < 1e-13);
        let ground = whole
            .chain()
            .ground()
            .in_base(&forward(&whole, &q).base_from_joint);
        let expected = base_from_table(&positioner, &p).inverse();
        assert!((ground.to_homogeneous() - expected.to_homogeneous()).norm() < 1e-13);
    }
    let names: Vec<&str> = whole
        .external_axes()
        .map(|axis| whole.joints()[axis].name.as_str())
        .collect();
    assert_eq!(names, ["tilt", "turn"], "in the order of a controller");
    assert!(whole.is_external(1) && !whole.is_external(2));
    assert_eq!(whole.joints()[1].limits, positioner.joints()[0].limits);
}

#[test]
fn frames_of_the_arm_are_relative_to_the_table_at_home() {
    let (arm, positioner) = (arm(), two_axes());
    let whole = both(&arm, &positioner);
    let ground = &whole.frames()[0];
    assert_eq!(ground.name, "ground");
    let expected = base_from_table(&positioner, &HOME).inverse();
    assert!((ground.base_from_frame.to_homogeneous() - expected.to_homogeneous()).norm() < 1e-14);
}

#[test]
fn postures_are_those_of_the_arm_at_the_pose_on_the_turned_table() {
    let tool = arms::bent_tool();
    // A closed form, and an arm that is searched, of fewer joints than six.
    for arm in [arms::mh12(), arms::other::ur10(), arms::other::five_joints()] {
        let positioner = two_axes();
        let whole = both(&arm, &positioner);
        let mut stream = Stream(11);
        for _ in 0..20 {
            let p = [stream.between(-1.0, 1.0), stream.between(-3.0, 3.0)];
            let a: Vec<f64> = stream.joints(&arm).iter().map(|q| 0.3 * q + 0.2).collect();
            let table_from_tool = tool_on(&forward(&whole, &joined(&p, &a)), &tool);
            let home = joined(&p, &a);
            let at = ToolAt {
                flange_from_tool: &tool,
                near: None,
                home: Some(&home),
            };
            let found = postures(&whole, &table_from_tool, at).unwrap();
            let alone = ToolAt { home: Some(&a), ..at };
            let base_from_tool = base_from_table(&positioner, &p) * table_from_tool;
            let expected = postures(&arm, &base_from_tool, alone).unwrap();
            assert_eq!(found.len(), expected.len(), "{}", arm.name());
            for (found, expected) in found.iter().zip(&expected) {
                assert_eq!(found.joints[..2], [p[1], p[0]]);
                // Without branch names the name has the sides of all joints.
                assert!(found.name == expected.name || !arm.inverse().has_branches());
                for (found, expected) in found.joints[2..].iter().zip(&expected.joints) {
                    assert!(
                        (found - expected).abs() < 1e-9,
                        "{found} {expected} of {}",
                        arm.name()
                    );
                }
            }
        }
    }
}

/// A model with the structure of this robot, gravity and thermal growth.
pub(in crate::robot) fn model(robot: &Robot, reference: &[f64]) -> StiffnessModel {
    StiffnessModel {
        structure: robot.structure().clone(),
        gravity: Some(Gravity {
            acceleration: Vector3::new(0.5, -0.3, -9.7),
            reference: reference.to_vec(),
        }),
        thermal: Some(ThermalGrowth::new(12e-6, 8.0, 1.0)),
        ..StiffnessModel::DRIVES.clone()
    }
}

pub(in crate::robot) fn state<'a>(
    robot: &'a Robot,
    model: &'a StiffnessModel,
    tool: &'a Isometry,
) -> ArmState<'a> {
    ArmState::new(Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        model,
        flange_from_tool: tool,
    })
}

fn near(found: &Vector3<f64>, expected: &Vector3<f64>) -> bool {
    (found - expected).norm() <= 1e-9 * expected.norm() + 1e-15
}

#[test]
fn on_a_rigid_positioner_the_arm_deflects_sags_and_grows_as_it_does_alone() {
    let (arm, mut positioner, tool) = (arm(), two_axes(), arms::bent_tool());
    positioner = positioner.with_compliance(vec![RIGID; 2]).unwrap();
    let whole = both(&arm, &positioner);
    let mut stream = Stream(21);
    let (ref_a, ref_p) = (stream.joints(&arm), [0.2, -0.9]);
    let (alone, joint) = (model(&arm, &ref_a), model(&whole, &joined(&ref_p, &ref_a)));
    for _ in 0..20 {
        let (a, p) = (
            stream.joints(&arm),
            [stream.between(-1.5, 1.5), stream.between(-3.0, 3.0)],
        );
        let turn: UnitQuaternion<f64> = base_from_table(&positioner, &p).rotation;
        let (force, moment) = (stream.vector(400.0), stream.vector(60.0));
        let [mut of_arm, mut of_whole] = [state(&arm, &alone, &tool), state(&whole, &joint, &tool)];
        of_arm.set_joints(&a);
        of_whole.set_joints(&joined(&p, &a));
        let on_table = Wrench {
            force: turn.inverse() * force,
            moment: turn.inverse() * moment,
        };
        let expected = of_arm.elastic(&Wrench { force, moment }).unwrap();
        let found = of_whole.elastic(&on_table).unwrap();
        assert!(near(&(turn * found.linear), &expected.linear));
        let (expected, found) = (
            of_arm.gravity().unwrap().unwrap(),
            of_whole.gravity().unwrap().unwrap(),
        );
        assert!(
            near(&(turn * found.linear), &expected.linear),
            "{found:?} {expected:?}"
        );
        assert!(near(&(turn * found.angular), &expected.angular));
        assert!(near(
            &(turn * of_whole.thermal().linear),
            &of_arm.thermal().linear
        ));
        for k in 0..6 {
            assert!(
                near(&(turn * of_whole.part(k + 2).linear), &of_arm.part(k).linear),
                "{k}"
            );
            assert!(
                near(&(turn * of_whole.sensitivity(k + 2)), &of_arm.sensitivity(k)),
                "{k}"
            );
        }
    }
}

/// Potential energy of the masses of positioner and part at these joint positions, J, from its forward kinematics.
fn energy(positioner: &Robot, q: &[f64], g: &Vector3<f64>) -> f64 {
    let frames = forward(positioner, q);
    let masses = positioner.structure().masses.iter();
    masses
        .map(|mass| {
            let centre = match mass.attachment {
                Attachment::Base => mass.centre,
                Attachment::Joint(joint) => frames.base_from_joint[joint] * mass.centre,
                _ => frames.base_from_flange * mass.centre,
            };
            -mass.mass * g.dot(&(root() * centre).coords)
        })
        .sum()
}

#[test]
fn weight_loads_the_joints_of_the_positioner_as_the_derivative_of_its_energy() {
    let (arm, positioner, tool) = (arm(), two_axes(), arms::bent_tool());
    let whole = both(&arm, &positioner);
    let mut stream = Stream(31);
    let a = stream.joints(&arm);
    let model = model(&whole, &joined(&[0.0, 0.0], &a));
    let g = model.gravity.as_ref().unwrap().acceleration;
    for _ in 0..20 {
        let (a, p) = (
            stream.joints(&arm),
            [stream.between(-1.5, 1.5), stream.between(-3.0, 3.0)],
        );
        let mut of_whole = state(&whole, &model, &tool);
        of_whole.set_joints(&joined(&p, &a));
        for joint in 0..2 {
            let at = |step: f64| {
                let mut q = p;
                q[joint] += step;
                energy(&positioner, &q, &g)
            };
            let step = 1e-4;
            // The torque refers to the chain position, which has the opposite sign of that of the positioner's chain.
            let expected = -(at(step) - at(-step)) / (2.0 * step);
            let sign = -positioner.joints()[joint].sign.factor();
            let found = of_whole.gravity_torques()[1 - joint] * sign;
            // Of some 500 N m: the truncation of the difference is 1e-8 of it, its rounding less.
            assert!(
                (found - expected).abs() < 1e-5 * 500.0,
                "joint {joint}: {found} {expected} N m"
            );
        }
    }
}

#[test]
fn soft_joints_of_the_positioner_add_the_displacement_of_the_part() {
    let (positioner, tool) = (two_axes(), arms::bent_tool());
    let arm = arms::r2000ic();
    let rigid_arm = arm.clone().with_compliance(vec![RIGID; 6]).unwrap();
    let whole = both(&rigid_arm, &positioner);
    let plain = StiffnessModel::DRIVES.clone();
    let mut stream = Stream(41);
    for _ in 0..20 {
        let (a, p) = (
            stream.joints(&arm),
            [stream.between(-1.5, 1.5), stream.between(-3.0, 3.0)],
        );
        let mut of_whole = state(&whole, &plain, &tool);
        let q = joined(&p, &a);
        of_whole.set_joints(&q);
        let force = stream.vector(400.0);
        let found = of_whole.elastic(&Wrench::from_force(force)).unwrap().linear;
        // By hand: the part turns by -c tau about each axis, found by small turns of the positioner.
        let tip = tool_on(&forward(&whole, &q), &tool).translation.vector;
        let in_base = base_from_table(&positioner, &p) * Point3::from(tip);
        let on_table = |q: &[f64]| base_from_table(&positioner, q).inverse() * in_base;
        let mut expected = Vector3::zeros();
        for joint in 0..2 {
            let moved = |step: f64| {
                let mut q = p;
                q[joint] += step;
                on_table(&q).coords
            };
            let per_turn = (moved(1e-5) - moved(-1e-5)) / 2e-5;
            let c = positioner.compliance().unwrap()[joint].value;
            expected += per_turn * (c * per_turn.dot(&force));
        }
        assert!(
            (found - expected).norm() < 1e-7 * expected.norm(),
            "{found} {expected}"
        );
    }
}

#[test]
fn postures_in_lanes_are_those_of_the_arm_too() {
    let (arm, positioner) = (arms::mh12(), two_axes());
    let whole = both(&arm, &positioner);
    let mut stream = Stream(51);
    let a: Vec<Vec<f64>> = (0..100).map(|_| stream.joints(&arm)).collect();
    let home = joined(&HOME, &[0.0; 6]);
    let poses: Vec<Isometry> = a
        .iter()
        .map(|a| tool_on(&forward(&whole, &joined(&HOME, a)), &Isometry::identity()))
        .collect();
    let found = postures_at(&whole, poses.len(), |i| poses[i], Some(&home), Watch::NONE).unwrap();
    let table = base_from_table(&positioner, &HOME);
    let alone = postures_at(&arm, poses.len(), |i| table * poses[i], None, Watch::NONE).unwrap();
    assert_eq!(found.names, alone.names);
    assert_eq!(found.within_limits, alone.within_limits);
    let width = whole.joints().len();
    for (found, alone) in found.joints.chunks(width).zip(alone.joints.chunks(width - 2)) {
        assert_eq!(found[..2], home[..2]);
        let apart = found[2..].iter().zip(alone).map(|(a, b)| (a - b).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-9);
    }
}

#[test]
fn a_positioner_with_coupled_joints_is_refused() {
    let mut joints = two_axes().joints().to_vec();
    joints[1].coupling.push(crate::robot::joint::Coupling {
        joint: 0,
        factor: 1.0,
    });
    let coupled = Robot::new("coupled", two_axes().chain().motions().to_vec(), joints).unwrap();
    let standing = Positioner {
        robot: &coupled,
        base_from_root: &root(),
        home: &HOME,
    };
    let error = arms::mh12().on_positioner(&standing, "ground").unwrap_err();
    assert_eq!(
        error,
        RobotError::CoupledPositioner {
            joint: "turn".to_owned()
        }
    );
}

#[test]
fn a_turntable_may_carry_the_arm() {
    // A revolute joint in front of six, stated to be external: seven joints, none of them redundant.
    let motions = [
        vec![
            Motion::About(Axis::Z, Amount::Joint(0)),
            Motion::Along(Axis::X, Amount::Constant(0.6)),
        ],
        arms::mh12()
            .chain()
            .motions()
            .iter()
            .map(|motion| after(motion, 1))
            .collect(),
    ];
    let joints: Vec<Joint> = [Joint::plain("swing")]
        .into_iter()
        .chain(arms::mh12().joints().to_vec())
        .collect();
    let robot = Robot::new("swinging", motions.concat(), joints).unwrap();
    assert!(!robot.is_external(0));
    let robot = robot.with_external_joints(1).unwrap();
    assert!(robot.is_external(0) && robot.inverse().has_branches());
    // On a positioner it stays an external axis, behind those of the positioner.
    let positioner = two_axes();
    let whole = both(&robot, &positioner);
    let names: Vec<&str> = whole
        .external_axes()
        .map(|axis| whole.joints()[axis].name.as_str())
        .collect();
    assert_eq!(names, ["swing", "tilt", "turn"]);
    let error = robot.with_external_joints(7).unwrap_err();
    assert_eq!(error, RobotError::AllExternal { joints: 7 });
}

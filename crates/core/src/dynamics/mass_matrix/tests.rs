//! Mass matrices against kinetic energies by finite differences of the motion of each body.

use nalgebra::{DVector, IsometryMatrix3, Matrix3, Point3, Rotation3, Vector3};

use super::*;
use crate::arms::{self, Stream};
use crate::frame::{Isometry, from_xyz_and_fixed_angles};
use crate::robot::deflected_arm::{DeflectedArm, FlexibleArm, attachment_frame, deflect_into};
use crate::robot::forward::{Frames, forward};
use crate::robot::positioner::Positioner;
use crate::robot::{Attachment, JointCompliance, Mass, Spring, Structure};
use crate::source::{Arm, ArmState, StiffnessModel};

const RIGID: JointCompliance = JointCompliance {
    value: 0.0,
    standard_uncertainty: 0.0,
};

/// A body at every attachment of an arm of this many joints, each with another inertia.
fn bodies(joints: usize, stream: &mut Stream) -> Vec<Mass> {
    let attachments = (0..joints).map(Attachment::Joint);
    attachments
        .chain([Attachment::Base, Attachment::Flange])
        .map(|attachment| {
            let turn = Rotation3::from_scaled_axis(stream.vector(2.0));
            let principal = Vector3::from_fn(|_, _| stream.between(1.0, 2.0));
            Mass {
                attachment,
                mass: stream.between(1.0, 100.0),
                centre: Point3::from(stream.vector(0.4)),
                inertia: Some(turn.matrix() * Matrix3::from_diagonal(&principal) * turn.matrix().transpose()),
                relative_uncertainty: 0.0,
            }
        })
        .collect()
}

/// Kinetic energy (J) of these bodies, each with its attachment at two times `2 h` (s) apart in the ground.
fn energy(masses: &[Mass], h: f64, frames: impl Fn(Attachment) -> [IsometryMatrix3<f64>; 2]) -> f64 {
    masses
        .iter()
        .map(|mass| {
            let [before, after] = frames(mass.attachment);
            let velocity = (after * mass.centre - before * mass.centre) / (2.0 * h);
            // The skew part of a small rotation: its angle by the arc cosine would lose half of the digits.
            let turn = before.rotation.matrix().transpose() * after.rotation.matrix();
            let skew = Vector3::new(
                turn[(2, 1)] - turn[(1, 2)],
                turn[(0, 2)] - turn[(2, 0)],
                turn[(1, 0)] - turn[(0, 1)],
            );
            let turned = skew / (4.0 * h);
            let inertia = mass.inertia.unwrap_or_else(Matrix3::zeros);
            0.5 * mass.mass * velocity.norm_squared() + 0.5 * turned.dot(&(inertia * turned))
        })
        .sum()
}

fn with_bodies(robot: &Robot, stream: &mut Stream) -> Robot {
    let joints = robot.joints().len();
    let motors = (0..joints).step_by(2).map(|joint| Motor {
        joint,
        rotor_inertia: 2e-3,
        ratio: stream.between(-150.0, 150.0),
    });
    let structure = Structure {
        motors: motors.collect(),
        masses: bodies(joints, stream),
        ..Structure::EMPTY
    };
    robot.clone().with_structure(structure).unwrap()
}

/// Plain arms, coupled ones, a rail, a sliding joint, a positioner of two joints, and an arm that holds the part.
fn robots(stream: &mut Stream) -> Vec<Robot> {
    let mut plain = vec![
        arms::r2000ic(),
        arms::hung(),
        arms::other::on_rail(&arms::r2000ic()),
        arms::other::sliding(),
        arms::other::iiwa14(),
    ];
    plain.extend(arms::ALL.iter().cloned());
    let mut all: Vec<Robot> = plain.iter().map(|robot| with_bodies(robot, stream)).collect();
    let stand = from_xyz_and_fixed_angles([1.5, 0.2, 0.3].into(), [0.1, -0.2, 0.7].into());
    let two = with_bodies(&arms::other::five_joints(), stream);
    let positioner = Positioner {
        robot: &two,
        base_from_root: &stand,
        home: &[0.0; 5],
    };
    all.push(all[0].on_positioner(&positioner, "ground").unwrap());
    all.push(all[0].holding_part(&stand).unwrap());
    all
}

#[test]
fn kinetic_energy_is_that_of_the_moving_bodies() {
    let mut stream = Stream(7);
    for robot in robots(&mut stream) {
        let joints = robot.joints().len();
        let model = StiffnessModel {
            structure: robot.structure().clone(),
            ..StiffnessModel::DRIVES.clone()
        };
        let (rigid, tool) = (vec![RIGID; joints], Isometry::identity());
        let mut state = ArmState::new(Arm {
            robot: &robot,
            compliance: &rigid,
            model: &model,
            flange_from_tool: &tool,
        });
        for _ in 0..10 {
            let q: Vec<f64> = (0..joints).map(|_| stream.between(-1.5, 1.5)).collect();
            let speed: Vec<f64> = (0..joints).map(|_| stream.between(-1.0, 1.0)).collect();
            let h = 1e-5;
            let at = |t: f64| {
                let q: Vec<f64> = q.iter().zip(&speed).map(|(q, v)| q + v * t).collect();
                forward(&robot, &q)
            };
            let (before, after) = (at(-h), at(h));
            let in_ground = |frames: &Frames, attachment| {
                let ground = robot.chain().ground().in_base(&frames.base_from_joint);
                ground.inverse() * attachment_frame(attachment, frames, &frames.base_from_flange)
            };
            let mut expected = energy(&robot.structure().masses, h, |attachment| {
                [in_ground(&before, attachment), in_ground(&after, attachment)]
            });
            for motor in &robot.structure().motors {
                let theta = robot.theta(motor.joint, &speed) - robot.joints()[motor.joint].zero_offset;
                expected += 0.5 * motor.rotor_inertia * (motor.ratio * theta).powi(2);
            }
            let speed = DVector::from_vec(speed);
            state.set_joints(&q);
            let found = 0.5 * speed.dot(&(over_joint_positions(&robot, &state.mass_matrix()) * &speed));
            // h^2 of the third derivative, and rounding of some metres over h.
            assert!(
                (found / expected - 1.0).abs() < 1e-7,
                "{}: {found} {expected}",
                robot.name()
            );
        }
    }
}

#[test]
fn springs_move_their_own_attachment_and_all_behind_it() {
    let mut stream = Stream(11);
    let robot = with_bodies(&arms::ALL[0], &mut stream);
    let compliance = JointCompliance {
        value: 1e-7,
        standard_uncertainty: 0.0,
    };
    let mut model = StiffnessModel::DRIVES.clone();
    model.structure = robot.structure().clone();
    model.structure.masses.push(Mass {
        attachment: Attachment::Tool,
        mass: 8.0,
        centre: Point3::new(0.01, -0.02, -0.1),
        inertia: None,
        relative_uncertainty: 0.0,
    });
    model.structure.springs = vec![
        Spring::about(Attachment::Joint(2), Vector3::x(), compliance),
        Spring::along(Attachment::Tool, Vector3::y(), compliance),
        Spring::about(Attachment::Base, Vector3::y(), compliance),
        Spring::along(Attachment::Flange, Vector3::z(), compliance),
    ];
    let tool = arms::bent_tool();
    let arm = Arm {
        robot: &robot,
        compliance: robot.compliance().unwrap(),
        model: &model,
        flange_from_tool: &tool,
    };
    let flexible = FlexibleArm {
        robot: &robot,
        springs: &model.structure.springs,
        flange_from_tool: &tool,
    };
    let mut state = ArmState::new(arm);
    for _ in 0..20 {
        let q = stream.joints(&robot);
        state.set_joints(&q);
        let theta: Vec<f64> = (0..6).map(|joint| robot.theta(joint, &q)).collect();
        let speed = DVector::from_fn(10, |_, _| stream.between(-1.0, 1.0));
        let h = 1e-5;
        let at = |t: f64| {
            let mut out = DeflectedArm::for_robot(&robot, 4);
            deflect_into(&flexible, &theta, (&speed * t).as_slice(), &mut out);
            out.attachments
        };
        let (before, after) = (at(-h), at(h));
        let mut expected = energy(&model.structure.masses, h, |attachment| {
            let rank = attachment.rank(6);
            [before[rank], after[rank]]
        });
        for motor in &model.structure.motors {
            expected += 0.5 * motor.inertia_at_joint() * speed[motor.joint].powi(2);
        }
        let found = 0.5 * speed.dot(&(state.mass_matrix() * &speed));
        assert!((found / expected - 1.0).abs() < 1e-7, "{found} {expected}");
    }
}

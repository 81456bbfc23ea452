use nalgebra::{Point3, Vector3};

use super::WholeModel;
use crate::arms;
use crate::kernel::lanes::numbers::{BLOCK, Backend, planes};
use crate::predict::deviation_of;
use crate::robot::{Attachment, JointCompliance, Mass, Spring};
use crate::source::stiffness_model::Gravity;
use crate::source::thermal::ThermalGrowth;
use crate::source::{Arm, ArmState, Links, StiffnessModel};
use crate::spatial::Wrench;

/// Springs everywhere, masses, gravity and thermal growth.
fn model(joints: usize) -> StiffnessModel {
    let c = JointCompliance {
        value: 3e-7,
        standard_uncertainty: 1e-8,
    };
    let mut model = StiffnessModel::DRIVES.clone();
    for joint in 0..joints {
        for axis in [Vector3::x(), Vector3::y()] {
            model.structure.springs.push(Spring::about(Attachment::Joint(joint), axis, c));
        }
    }
    model.structure.springs.push(Spring::about(Attachment::Base, Vector3::y(), c));
    model.structure.springs.push(Spring::along(Attachment::Tool, Vector3::x(), c));
    model.structure.masses = [Attachment::Joint(1), Attachment::Joint(2), Attachment::Flange]
        .map(|attachment| Mass {
            attachment,
            mass: 30.0,
            centre: Point3::new(0.1, 0.02, 0.2),
        })
        .to_vec();
    model.gravity = Some(Gravity {
        acceleration: Vector3::new(0.0, 0.0, -9.81),
        reference: vec![0.2; joints],
    });
    model.thermal = Some(ThermalGrowth::new(12e-6, 8.0, 2.0));
    model
}

/// Witness: the plain row of `predict.rs`.
#[test]
fn the_whole_model_in_lanes_is_that_of_the_plain_row() {
    let tool = arms::bent_tool();
    let wrench = Wrench {
        force: Vector3::new(60.0, -35.0, 20.0),
        moment: Vector3::new(1.0, 2.0, -3.0),
    };
    for robot in arms::ALL.iter() {
        let model = model(robot.joints().len());
        let compliance = vec![
            JointCompliance {
                value: 2e-6,
                standard_uncertainty: 2e-7
            };
            robot.joints().len()
        ];
        let arm = Arm {
            robot,
            compliance: &compliance,
            model: &model,
            flange_from_tool: &tool,
        };
        let mut stream = arms::Stream(17);
        let q: Vec<Vec<f64>> = (0..BLOCK).map(|_| stream.joints(robot)).collect();
        let joints: Vec<[f64; BLOCK]> = (0..robot.joints().len())
            .map(|joint| std::array::from_fn(|i| q[i][joint]))
            .collect();
        let mut plain = ArmState::new(arm);
        let mut positions = vec![0.0; robot.joints().len()];
        let expected: Vec<Vector3<f64>> = q
            .iter()
            .map(|q| {
                plain.set_joints(q);
                let mut links = Links::Farthest([Vector3::x(), Vector3::y()], &mut positions);
                deviation_of(&mut plain, &wrench, &mut links).unwrap().linear
            })
            .collect();
        for backend in Backend::available() {
            let mut lanes = WholeModel::of(&arm, backend).unwrap();
            lanes.set_joints(&joints);
            let mut found = planes();
            lanes.deviate(&wrench, &mut found);
            for (i, expected) in expected.iter().enumerate() {
                let found = Vector3::new(found[0][i], found[1][i], found[2][i]);
                let away = (found - expected).norm() / expected.norm();
                assert!(away < 1e-12, "{} {backend} {i}: {away:e}", robot.name());
            }
        }
    }
}

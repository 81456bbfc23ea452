//! Every point of a program against the plain model, in every frame of the load and with every part of the arm.

use armill_core::kernel::BranchChoice;
use armill_core::load::{LoadFrame, PathLoad};
use armill_core::nalgebra::{Point3, Unit, Vector3};
use armill_core::robot::{Attachment, BranchPattern, JointCompliance, Mass, Robot, Spring, Structure};
use armill_core::source::stiffness_model::FREE_FALL;
use armill_core::source::{Arm, Gravity, StiffnessModel};
use armill_core::spatial::Wrench;

use crate::{arms, cases, followed, track};

/// Every point against [`arms::predicted`] at its joint positions, with wrenches turned here.
fn agrees(robot: &Robot, model: &StiffnessModel, frame: LoadFrame, tolerance: f64) {
    let choice = BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP);
    let found = followed(robot, model, choice, cases(frame));
    let arm = Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        model,
        flange_from_tool: &arms::bent_tool(),
    };
    let PathLoad::Cases(given) = cases(frame) else {
        unreachable!()
    };
    let track = track();
    assert!(found.answers.points.len() > 200);
    for (i, evaluation) in found.answers.evaluations() {
        let point = &track.path.points[i];
        let part = track.base_from_part.rotation;
        let z = part * point.axis.map_or(Vector3::z(), Unit::into_inner);
        let feed = part * point.direction.into_inner();
        let x = feed - z * feed.dot(&z);
        for (case, wrench) in given.cases.iter().enumerate() {
            let turn = |v: Vector3<f64>| match frame {
                LoadFrame::Base => v,
                LoadFrame::Part => part * v,
                // In the plunge x comes from the tool: any direction across it will do here.
                LoadFrame::Feed if x.norm() < 1e-6 => track.base_from_feed(i) * v,
                LoadFrame::Feed => x.normalize() * v.x + z.cross(&x.normalize()) * v.y + z * v.z,
            };
            let turned = Wrench {
                force: turn(wrench.force),
                moment: turn(wrench.moment),
            };
            let predicted = arms::predicted(&arm, found.answers.joints_at(i), &turned).unwrap();
            let away = found.answers.deviations_at(i)[case] - predicted.twist.linear;
            assert!(
                away.norm() < tolerance * predicted.twist.linear.norm(),
                "point {i}: {away}"
            );
        }
        let split = |d: &Vector3<f64>| (d - z * d.dot(&z)).norm();
        let largest = found
            .answers
            .deviations_at(i)
            .iter()
            .map(split)
            .fold(0.0, f64::max);
        assert!((evaluation.in_plane - largest).abs() < 1e-9 * largest);
    }
    assert_eq!(found.answers.evaluations().count(), found.answers.points.len());
}

/// Springs in the arm and at the tool, and a mass behind the last joint.
fn heavy(robot: &Robot) -> Structure {
    let compliance = |value| JointCompliance {
        value,
        standard_uncertainty: 0.0,
    };
    Structure {
        springs: vec![
            Spring::about(Attachment::Joint(1), Vector3::x(), compliance(2.4e-7)),
            Spring::along(Attachment::Tool, Vector3::x(), compliance(9e-7)),
        ],
        masses: vec![Mass {
            attachment: Attachment::Joint(robot.joints().len() - 1),
            mass: 12.0,
            centre: Point3::new(0.02, 0.01, 0.1),
            inertia: None,
            relative_uncertainty: 0.0,
        }],
        ..Structure::EMPTY
    }
}

#[test]
fn drives_alone_agree_with_the_plain_model_at_every_point_and_in_every_frame() {
    for robot in [arms::mh12(), arms::kr120()] {
        for frame in [LoadFrame::Base, LoadFrame::Part, LoadFrame::Feed] {
            agrees(&robot, StiffnessModel::DRIVES, frame, 1e-11);
        }
    }
}

#[test]
fn springs_and_gravity_add_what_they_add_to_one_point() {
    let robot = arms::mh12();
    let gravity = Gravity {
        acceleration: Vector3::new(0.0, 0.0, -FREE_FALL),
        reference: vec![0.0; 6],
    };
    let model = StiffnessModel {
        structure: heavy(&robot),
        gravity: Some(gravity),
        load_dependent: false,
        ..StiffnessModel::DRIVES.clone()
    };
    agrees(&robot, &model, LoadFrame::Feed, 1e-10);
}

#[test]
fn a_load_dependent_model_is_evaluated_under_each_wrench() {
    let robot = arms::mh12();
    let model = StiffnessModel {
        structure: heavy(&robot),
        gravity: None,
        load_dependent: true,
        ..StiffnessModel::DRIVES.clone()
    };
    // Both find the rest of the arm by iteration.
    agrees(&robot, &model, LoadFrame::Feed, 1e-8);
}

//! Deviation along a tool path program against the plain model, one point at a time.
#![allow(clippy::unwrap_used)]

mod arms;

use std::f64::consts::TAU;

use armill_core::frame::Isometry;
use armill_core::kernel::{BranchChoice, Question};
use armill_core::load::{Doubt, LoadCases, LoadFrame, PathLoad};
use armill_core::map::{ProgramAnswer, Track, along_program};
use armill_core::nalgebra::{Point3, Unit, Vector3};
use armill_core::path::{Arc, Course, Move, Pace, Placing, Sampler, Sampling, Spin};
use armill_core::predict::predict_in_full;
use armill_core::robot::{BranchPattern, JointCompliance, Mass, Robot, Seat, Spring, Structure};
use armill_core::source::stiffness_model::FREE_FALL;
use armill_core::source::{Arm, Gravity, StiffnessModel};
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;

fn moves() -> Vec<Move> {
    let to = |x: f64, y: f64, z: f64, pace| Move {
        end: Point3::new(x, y, z),
        axis: None,
        course: Course::Line,
        pace,
        line: 1,
    };
    let feed = Pace::Feed(0.02);
    let round = Arc {
        centre: Point3::new(0.0, 0.0, 0.0),
        axis: -Vector3::z_axis(),
        sweep: TAU,
    };
    vec![
        to(0.05, 0.0, 0.02, Pace::Rapid),
        to(0.05, 0.0, -0.001, feed),
        Move {
            course: Course::Arc(round),
            ..to(0.05, 0.0, -0.001, feed)
        },
        Move {
            axis: Some(Unit::new_normalize(Vector3::new(0.3, -0.2, 1.0))),
            ..to(-0.05, 0.03, 0.004, feed)
        },
    ]
}

fn track(load: PathLoad) -> Track {
    let sampling = Sampling {
        chord_error: 1e-5,
        step: 2e-3,
    };
    let (mut sampler, mut points) = (Sampler::new(sampling), Vec::new());
    for next in moves() {
        sampler.points(&next, |point| points.push(point));
    }
    let base_from_part = Isometry::new(Vector3::new(0.9, 0.1, 0.6), Vector3::new(0.1, -0.4, 0.3));
    Track {
        points,
        placing: Placing {
            base_from_path: base_from_part,
            axis: Vector3::z_axis(),
            keeps_axis: false,
            spin: Spin::AlongFeed(0.3),
        },
        load,
        base_from_part,
    }
}

fn cases(frame: LoadFrame) -> PathLoad {
    let wrench = |f: [f64; 3], m: [f64; 3]| Wrench {
        force: f.into(),
        moment: m.into(),
    };
    PathLoad::Cases(LoadCases {
        frame,
        cases: vec![
            wrench([-150.0, 36.0, 14.0], [0.1, -0.3, 2.0]),
            wrench([39.0, 150.0, 14.0], [0.0; 3]),
        ],
    })
}

fn followed(robot: &Robot, model: &StiffnessModel, choice: BranchChoice, load: PathLoad) -> ProgramAnswer {
    let question = Question {
        robot,
        compliance: robot.compliance().unwrap(),
        model,
        flange_from_tool: &arms::bent_tool(),
        home: None,
        cases: &[],
        doubt: Doubt::NONE,
        normal: Vector3::z_axis(),
        choice,
    };
    along_program(&question, &track(load), Watch::NONE).unwrap()
}

/// Every point against [`predict_in_full`] at its joint positions, with wrenches turned here.
fn agrees(robot: &Robot, model: &StiffnessModel, frame: LoadFrame, tolerance: f64) {
    let choice = BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP);
    let found = followed(robot, model, choice, cases(frame));
    let arm = Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        model,
        flange_from_tool: &arms::bent_tool(),
    };
    let PathLoad::Cases(told) = cases(frame) else {
        unreachable!()
    };
    let track = track(cases(frame));
    assert!(found.answers.points.len() > 200);
    for (i, held) in found.answers.held() {
        let point = &track.points[i];
        let part = track.base_from_part.rotation;
        let z = part * point.axis.map_or(Vector3::z(), Unit::into_inner);
        let feed = part * point.direction.into_inner();
        let x = feed - z * feed.dot(&z);
        for (case, wrench) in told.cases.iter().enumerate() {
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
            let predicted = predict_in_full(&arm, found.answers.joints_at(i), &turned).unwrap();
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
        assert!((held.in_plane - largest).abs() < 1e-9 * largest);
    }
    assert_eq!(found.answers.held().count(), found.answers.points.len());
}

fn heavy(robot: &Robot) -> Structure {
    let yields = |value| JointCompliance {
        value,
        standard_uncertainty: 0.0,
    };
    Structure {
        springs: vec![
            Spring::about(Seat::Joint(1), Vector3::x(), yields(2.4e-7)),
            Spring::along(Seat::Tool, Vector3::x(), yields(9e-7)),
        ],
        masses: vec![Mass {
            seat: Seat::Joint(robot.joints().len() - 1),
            mass: 12.0,
            centre: Point3::new(0.02, 0.01, 0.1),
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
    };
    agrees(&robot, &model, LoadFrame::Feed, 1e-10);
}

#[test]
fn a_load_that_changes_the_arm_is_asked_as_it_is() {
    let robot = arms::mh12();
    let model = StiffnessModel {
        structure: heavy(&robot),
        gravity: None,
        load_dependent: true,
    };
    // Both find the rest of the arm by iteration.
    agrees(&robot, &model, LoadFrame::Feed, 1e-8);
}

#[test]
fn the_arm_keeps_one_branch_and_the_best_one_deviates_least() {
    let robot = arms::mh12();
    let largest = |choice| {
        let found = followed(&robot, StiffnessModel::DRIVES, choice, cases(LoadFrame::Feed));
        let mut names: Vec<_> = found.answers.held().map(|(_, held)| held.name).collect();
        names.dedup();
        assert_eq!(names.len(), 1);
        found.answers.worst().unwrap().1.in_plane
    };
    let (best, nominal) = (
        largest(BranchChoice::Best),
        largest(BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP)),
    );
    assert!(best <= nominal, "{best} and {nominal}");
}

#[test]
fn parts_seen_from_the_path_add_up_to_the_whole() {
    let robot = arms::mh12();
    let found = followed(
        &robot,
        StiffnessModel::DRIVES,
        BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP),
        cases(LoadFrame::Feed),
    );
    let track = track(cases(LoadFrame::Feed));
    for (i, held) in found.answers.held() {
        let deviation = found.answers.deviations_at(i)[held.deciding_case];
        let (parts, whole) = (track.parts(i, &deviation), deviation.norm());
        assert!((parts.along.hypot(parts.cross).hypot(parts.normal) - whole).abs() < 1e-12 * whole);
        assert!((parts.along.hypot(parts.cross) - held.in_plane).abs() < 1e-10 * whole);
    }
}

#[test]
fn wrenches_of_each_point_may_be_told_in_any_frame() {
    let robot = arms::mh12();
    let choice = BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP);
    for frame in [LoadFrame::Base, LoadFrame::Part, LoadFrame::Feed] {
        let given = cases(frame);
        let PathLoad::Cases(told) = &given else {
            unreachable!()
        };
        let count = track(given.clone()).points.len();
        let each = PathLoad::OfEach {
            cases: told.cases.len(),
            frame,
            wrenches: told
                .cases
                .iter()
                .copied()
                .cycle()
                .take(count * told.cases.len())
                .collect(),
        };
        let [each, given] =
            [each, given].map(|load| followed(&robot, StiffnessModel::DRIVES, choice, load).answers);
        for i in 0..count {
            assert_eq!(each.deviations_at(i), given.deviations_at(i), "{frame:?}");
        }
    }
}

#[test]
fn each_point_may_have_a_wrench_of_its_own() {
    let robot = arms::mh12();
    let choice = BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP);
    let count = track(cases(LoadFrame::Feed)).points.len();
    let PathLoad::Cases(told) = cases(LoadFrame::Feed) else {
        unreachable!()
    };
    let scaled = |i: usize| {
        let k = i as f64 / count as f64;
        Wrench {
            force: told.cases[0].force * k,
            moment: told.cases[0].moment * k,
        }
    };
    let own = PathLoad::OfEach {
        cases: 1,
        frame: LoadFrame::Feed,
        wrenches: (0..count).map(scaled).collect(),
    };
    let (own, same) = (
        followed(&robot, StiffnessModel::DRIVES, choice, own),
        followed(&robot, StiffnessModel::DRIVES, choice, cases(LoadFrame::Feed)),
    );
    for i in 0..count {
        let expected = same.answers.deviations_at(i)[0] * (i as f64 / count as f64);
        assert!((own.answers.deviations_at(i)[0] - expected).norm() < 1e-15 + 1e-12 * expected.norm());
    }
}

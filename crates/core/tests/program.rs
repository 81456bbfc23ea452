//! Deviation along a tool path program against the plain model, one point at a time.
#![allow(clippy::unwrap_used)]

mod arms;

use std::f64::consts::TAU;

use armill_core::frame::Isometry;
use armill_core::kernel::{BranchChoice, Question};
use armill_core::load::{
    Cutter, CuttingLaw, Doubt, Immersion, LoadCases, LoadFrame, Mechanistic, Milling, PathLoad,
};
use armill_core::map::{AlongPath, CutLimits, Permitted, ProgramLimits, along_path, program_limits};
use armill_core::nalgebra::{Point3, Unit, Vector2, Vector3};
use armill_core::path::{
    Arc, Course, Cutting, Greatest, Move, Pace, PathBuilder, Placing, Sampling, Spin, Step, Track,
};
use armill_core::robot::{BranchPattern, JointCompliance, Mass, Robot, Seat, Spring, Structure};
use armill_core::source::stiffness_model::FREE_FALL;
use armill_core::source::{Arm, Gravity, StiffnessModel};
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;

fn moves() -> Vec<Move> {
    let to = |x: f64, y: f64, z: f64, pace| Move {
        end: Point3::new(x, y, z),
        axis: None,
        spin: None,
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

fn track() -> Track {
    let sampling = Sampling {
        chord_error: 1e-5,
        step: 2e-3,
    };
    let mut builder = PathBuilder::new(sampling, 100_000);
    for next in moves() {
        builder.take(Step::Move(next));
    }
    let base_from_part = Isometry::new(Vector3::new(0.9, 0.1, 0.6), Vector3::new(0.1, -0.4, 0.3));
    Track {
        path: builder.finish().unwrap(),
        placing: Placing {
            base_from_path: base_from_part,
            axis: Vector3::z_axis(),
            keeps_axis: false,
            spin: Spin::AlongFeed(0.3),
        },
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

fn question<'a>(
    robot: &'a Robot,
    model: &'a StiffnessModel,
    tool: &'a Isometry,
    choice: BranchChoice,
) -> Question<'a> {
    Question {
        arm: Arm {
            robot,
            compliance: robot.compliance().unwrap(),
            model,
            flange_from_tool: tool,
        },
        home: None,
        cases: &[],
        doubt: Doubt::NONE,
        normal: Vector3::z_axis(),
        choice,
    }
}

fn followed(robot: &Robot, model: &StiffnessModel, choice: BranchChoice, load: PathLoad) -> AlongPath {
    let tool = arms::bent_tool();
    let question = question(robot, model, &tool, choice);
    along_path(&question, &track(), load, Watch::NONE).unwrap()
}

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
    let PathLoad::Cases(told) = cases(frame) else {
        unreachable!()
    };
    let track = track();
    assert!(found.answers.points.len() > 200);
    for (i, held) in found.answers.held() {
        let point = &track.path.points[i];
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
    let track = track();
    for (i, held) in found.answers.held() {
        let deviation = found.answers.deviations_at(i)[held.deciding_case];
        let (parts, whole) = (track.parts(i, &deviation), deviation.norm());
        assert!((parts.along.hypot(parts.cross).hypot(parts.axial) - whole).abs() < 1e-12 * whole);
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
        let count = track().path.points.len();
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
    let count = track().path.points.len();
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

fn cutting() -> Cutting {
    let law = Mechanistic::new(Vector3::new(796e6, 168e6, 222e6), Vector3::new(27e3, 30e3, 5e3)).unwrap();
    Cutting {
        cutter: Cutter::flat(10e-3, 2).unwrap(),
        law: CuttingLaw::Mechanistic(law),
        depth: 1e-3,
        immersion: Immersion::Down(3e-3),
        feed: None,
        spindle: Some(SPINDLE),
        greatest: Greatest::SecondCase,
    }
}

const SPINDLE: f64 = 8000.0 * TAU / 60.0;

fn cut_along(cutting: &Cutting, track: &Track) -> PathLoad {
    let forces = cutting.along(&track.path, &track.placing, None, Watch::NONE);
    PathLoad::Cuts(forces.unwrap().cuts)
}

/// A cut that permits a value at a point deviates there by just the limit.
fn permits(
    found: &ProgramLimits,
    limit: f64,
    value: impl Fn(&CutLimits) -> Permitted,
    cutting_at: impl Fn(f64) -> Cutting,
) {
    let robot = arms::mh12();
    let choice = BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP);
    let mut asked = 0;
    for point in found
        .points
        .iter()
        .filter(|point| point.cut.is_some())
        .step_by(40)
    {
        let Permitted::UpTo(value) = value(&point.cut.unwrap()) else {
            continue;
        };
        // As wide as the tool a cut has no free edge any more that straying would move: the deviation jumps there.
        if value > 0.98 * cutting().cutter.diameter() {
            continue;
        }
        let load = cut_along(&cutting_at(value), &track());
        let there = followed(&robot, StiffnessModel::DRIVES, choice, load);
        let deviation = there.answers.points[point.index].as_ref().unwrap().in_plane;
        assert!((deviation / limit - 1.0).abs() < 2e-3, "{value}: {deviation}");
        asked += 1;
    }
    assert!(asked > 2, "{asked}");
}

#[test]
fn at_the_depth_width_or_feed_that_is_permitted_the_tool_deviates_by_the_limit() {
    let robot = arms::mh12();
    let choice = BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP);
    let mean_alone = Cutting {
        greatest: Greatest::LeftOut,
        ..cutting()
    };
    let load = cut_along(&mean_alone, &track());
    let followed = followed(&robot, StiffnessModel::DRIVES, choice, load);
    let limit = 0.7 * followed.answers.worst().unwrap().1.in_plane;
    let tool = arms::bent_tool();
    let question = question(&robot, StiffnessModel::DRIVES, &tool, followed.choice);
    let found = program_limits(&question, &track(), &followed, limit, Watch::NONE);
    let found = found.unwrap().unwrap();
    let feed_speed = 0.02;
    permits(
        &found,
        limit,
        |cut| cut.depth,
        |depth| Cutting { depth, ..mean_alone },
    );
    permits(
        &found,
        limit,
        |cut| cut.width.unwrap(),
        |width| Cutting {
            immersion: Immersion::Down(width),
            ..mean_alone
        },
    );
    permits(
        &found,
        limit,
        |cut| cut.feed_per_tooth,
        |thick| Cutting {
            // The program tells the feed: the same chip at another speed of the spindle.
            spindle: Some(feed_speed * TAU / (2.0 * thick)),
            ..mean_alone
        },
    );
    // Where depth and feed as drawn meet, the sheet has the largest deviation of the path.
    let sheet = found.depth_by_feed.unwrap();
    let nearest = |all: &[f64], value: f64| {
        let off = |i: &usize| (all[*i] - value).abs();
        (0..all.len()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap()
    };
    let (row, column) = (
        nearest(&sheet.depths, 1e-3),
        nearest(&sheet.feeds_per_tooth, feed_speed * TAU / (SPINDLE * 2.0)),
    );
    let there = sheet.deviations[row * sheet.feeds_per_tooth.len() + column];
    assert!((there / (limit / 0.7) - 1.0).abs() < 0.15, "{there} {limit}");
    let thinner = sheet.deviations[column];
    assert!(thinner < there && sheet.deviations.iter().all(|deviation| *deviation > 0.0));
}

#[test]
fn a_force_that_is_permitted_deviates_by_the_limit() {
    let robot = arms::mh12();
    let choice = BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP);
    let unit = |force: Vector3<f64>| {
        PathLoad::Cases(LoadCases {
            frame: LoadFrame::Feed,
            cases: vec![Wrench::from_force(force)],
        })
    };
    let along = |force| followed(&robot, StiffnessModel::DRIVES, choice, unit(force));
    let under_x = along(Vector3::x());
    let tool = arms::bent_tool();
    let question = question(&robot, StiffnessModel::DRIVES, &tool, under_x.choice);
    let limit = 50e-6;
    let found = program_limits(&question, &track(), &under_x, limit, Watch::NONE);
    let found = found.unwrap().unwrap();
    assert!(found.depth_by_feed.is_none() && found.points.len() > 100);
    for (axis, direction) in [Vector3::x(), Vector3::y(), Vector3::z()].into_iter().enumerate() {
        let under = along(direction);
        for point in &found.points {
            let deviation = under.answers.points[point.index].as_ref().unwrap().in_plane;
            let forces = point.forces;
            let permitted = [forces.along, forces.across, forces.normal][axis];
            assert!((permitted * deviation / limit - 1.0).abs() < 1e-9);
            assert!(forces.weakest <= permitted * (1.0 + 1e-12));
            assert_eq!(point.cut, None);
        }
    }
    let soft = StiffnessModel {
        load_dependent: true,
        ..StiffnessModel::DRIVES.clone()
    };
    let question = self::question(&robot, &soft, &tool, under_x.choice);
    let none = program_limits(&question, &track(), &under_x, limit, Watch::NONE);
    assert_eq!(none, Ok(None));
}

#[test]
fn where_a_tool_cuts_the_force_is_that_of_the_cut_of_the_tool_that_strayed() {
    let robot = arms::mh12();
    let cutting = cutting();
    let track = track();
    let load = cut_along(&cutting, &track);
    let PathLoad::Cuts(drawn) = load.clone() else {
        panic!("cuts are cut")
    };
    let choice = BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP);
    let found = followed(&robot, StiffnessModel::DRIVES, choice, load);
    let rested = found.rested.unwrap();
    assert_eq!((rested.unsettled, rested.first_unsettled), (0, None));
    let PathLoad::Cuts(at_rest) = &found.load else {
        panic!("cuts stay cuts")
    };
    let mut gave_way = 0.0_f64;
    for (i, _) in found.answers.held() {
        let (here, before) = (&at_rest.points[i], &drawn.points[i]);
        let parts = track.parts(i, &found.answers.deviations_at(i)[0]);
        let strayed = Vector2::new(parts.cross, parts.axial);
        let Some(cut) = before.cut else {
            assert_eq!(here.mean, Vector3::zeros());
            continue;
        };
        let met = cut.strayed(strayed, 5e-3).map(|cut| {
            let milling = Milling::new(cutting.cutter, cutting.law, cut);
            milling.unwrap().mean().force
        });
        let missing = (met.unwrap_or_default() - here.mean).norm();
        assert!(missing < 1e-4 * before.mean.norm(), "{i}: {missing}");
        let share = here.mean.norm() / before.mean.norm();
        assert!((here.greatest - before.greatest * share).norm() < 1e-9 * before.greatest.norm());
        gave_way = gave_way.max((1.0 - share).abs());
    }
    assert!(gave_way > 0.02, "the arm is soft enough to see it: {gave_way}");
    let worst = found.answers.worst().unwrap().1.in_plane;
    assert!(
        (rested.largest_if_drawn / worst - 1.0).abs() > 5e-3,
        "{rested:?} {worst}"
    );
}

#[test]
fn joints_go_on_past_half_a_turn_as_far_as_their_limits_let_them() {
    for robot in [arms::mh12(), arms::kr120()] {
        let level = Isometry::translation(1.0, 0.0, 0.6);
        let mut track = track();
        track.placing.base_from_path = level;
        let tool = Isometry::translation(0.0, 0.0, 0.2);
        let choice = BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP);
        let question = question(&robot, StiffnessModel::DRIVES, &tool, choice);
        let found = along_path(&question, &track, cases(LoadFrame::Feed), Watch::NONE)
            .unwrap()
            .answers;
        let (mut range, mut steps) = ((f64::MAX, f64::MIN), 0);
        for (i, held) in found.held() {
            let last = found.joints_at(i)[5];
            range = (range.0.min(last), range.1.max(last));
            let (joint, margin) = robot.limit_margin(found.joints_at(i)).unwrap();
            assert!(held.limit_joint == joint && (held.limit_margin - margin).abs() < 1e-12);
            assert!(held.within_limits(), "point {i}");
            let smooth = |i: usize| {
                let [before, here] = [&track.path.points[i - 1], &track.path.points[i]];
                here.along > before.along && before.direction.angle(&here.direction) < 0.1
            };
            if i > 0 && smooth(i) {
                steps += 1;
                let by = last - found.joints_at(i - 1)[5];
                assert!(by.abs() < 0.5, "point {i} turns by {by}");
            }
        }
        // The feed turns once about the upright tool, and the last joint with it.
        assert!(range.1 - range.0 > 0.9 * TAU && steps > 200, "{range:?} {steps}");
    }
}

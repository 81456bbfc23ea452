//! A path that is followed: one branch, parts that add up, wrenches of each point, continuous joints.

use std::f64::consts::TAU;

use armill_core::frame::Isometry;
use armill_core::kernel::BranchChoice;
use armill_core::load::{LoadFrame, PathLoad};
use armill_core::map::along_path;
use armill_core::robot::BranchPattern;
use armill_core::source::StiffnessModel;
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;

use crate::{arms, cases, followed, question, track};

#[test]
fn the_arm_keeps_one_branch_and_the_best_one_deviates_least() {
    let robot = arms::mh12();
    let largest = |choice| {
        let found = followed(&robot, StiffnessModel::DRIVES, choice, cases(LoadFrame::Feed));
        let mut names: Vec<_> = found
            .answers
            .evaluations()
            .map(|(_, evaluation)| evaluation.name)
            .collect();
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
    for (i, evaluation) in found.answers.evaluations() {
        let deviation = found.answers.deviations_at(i)[evaluation.worst_case];
        let (parts, whole) = (track.parts(i, &deviation), deviation.norm());
        assert!((parts.along.hypot(parts.cross).hypot(parts.axial) - whole).abs() < 1e-12 * whole);
        assert!((parts.along.hypot(parts.cross) - evaluation.in_plane).abs() < 1e-10 * whole);
    }
}

#[test]
fn wrenches_of_each_point_may_be_given_in_any_frame() {
    let robot = arms::mh12();
    let choice = BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP);
    for frame in [LoadFrame::Base, LoadFrame::Part, LoadFrame::Feed] {
        let given = cases(frame);
        let PathLoad::Cases(reported) = &given else {
            unreachable!()
        };
        let count = track().path.points.len();
        let each = PathLoad::OfEach {
            cases: reported.cases.len(),
            frame,
            wrenches: reported
                .cases
                .iter()
                .copied()
                .cycle()
                .take(count * reported.cases.len())
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
fn each_point_may_have_a_separate_wrench() {
    let robot = arms::mh12();
    let choice = BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP);
    let count = track().path.points.len();
    let PathLoad::Cases(reported) = cases(LoadFrame::Feed) else {
        unreachable!()
    };
    let scaled = |i: usize| {
        let k = i as f64 / count as f64;
        Wrench {
            force: reported.cases[0].force * k,
            moment: reported.cases[0].moment * k,
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
        for (i, evaluation) in found.evaluations() {
            let last = found.joints_at(i)[5];
            range = (range.0.min(last), range.1.max(last));
            let (joint, margin) = robot.limit_margin(found.joints_at(i)).unwrap();
            assert!(evaluation.limit_joint == joint && (evaluation.limit_margin - margin).abs() < 1e-12);
            assert!(evaluation.within_limits(), "point {i}");
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

//! Results of the lanes against the same points one after the other.

use super::super::tests::{NOMINAL, analysis, poses};
use super::*;
use crate::arms;
use crate::kernel::Answers;
use crate::robot::inverse::Inverse;
use crate::robot::joint::Coupling;
use crate::source::StiffnessModel;

/// The answers at these poses, with or without lanes.
fn answered(question: &Question<'_>, poses: &[Isometry], lanes: bool) -> Answers {
    let mut answers = Answers::new(question, poses.len(), AnswerDetail::Shares);
    let mut solver = Solver::new(question, Order::Any, AnswerDetail::Shares);
    assert!(solver.lanes.is_some(), "{}", question.arm.robot.name());
    if !lanes {
        solver.lanes = None;
    }
    for (block, slots) in answers.blocks(BLOCK).into_iter().enumerate() {
        solver
            .answer(|i| poses[block * BLOCK + i], slots, Watch::NONE)
            .unwrap();
    }
    answers
}

#[test]
fn lanes_and_single_points_agree_for_every_arm() {
    let calibrated = |most| arms::all().map(|arm| arms::other::calibrated(&arm, most));
    let collaborative = [arms::other::ur10(), arms::other::ur10e()];
    let off = collaborative
        .each_ref()
        .map(|arm| arms::other::calibrated(arm, 1e-3));
    let all = arms::all()
        .into_iter()
        .chain(calibrated(1e-6))
        .chain(calibrated(3e-3));
    let railed = [
        arms::kr120(),
        arms::hung(),
        arms::other::ur10e(),
        arms::other::calibrated(&arms::tx2_90(), 1e-4),
    ];
    let railed = railed.each_ref().map(arms::other::on_rail);
    let twice = arms::other::on_rail(&railed[0]);
    for robot in all.chain(collaborative).chain(off).chain(railed).chain([twice]) {
        let poses = poses(&robot, 190, 11);
        // A descent ends within 1e-12 of the pose, which the condition of the Jacobian multiplies.
        let exact = matches!(robot.inverse().of_arm(), Inverse::Closed(_));
        let accuracy = if exact { 1e-11 } else { 2e-10 };
        for choice in [NOMINAL, BranchChoice::Best] {
            analysis(&robot, StiffnessModel::DRIVES, choice, |question| {
                let (lanes, single) = (
                    answered(question, &poses, true),
                    answered(question, &poses, false),
                );
                let mut compared = 0;
                for i in 0..poses.len() {
                    let (Ok(a), Ok(b)) = (lanes.points[i], single.points[i]) else {
                        assert_eq!(lanes.points[i], single.points[i]);
                        continue;
                    };
                    // Near a singularity a posture is accurate to the square root of rounding; of two equally good
                    // postures either may be selected.
                    if a.singularity.is_some() || a.name != b.name {
                        assert!(
                            (a.in_plane / b.in_plane - 1.0).abs() < 1e-5,
                            "{}: {a:?} {b:?}",
                            robot.name()
                        );
                        continue;
                    }
                    compared += 1;
                    assert_eq!(a.in_plane_uncertainty.is_some(), b.in_plane_uncertainty.is_some());
                    let size = b.full;
                    for (a, b) in [
                        (a.in_plane, b.in_plane),
                        (a.full, b.full),
                        (a.normal.abs(), b.normal.abs()),
                        (
                            a.in_plane_uncertainty.unwrap_or(0.0),
                            b.in_plane_uncertainty.unwrap_or(0.0),
                        ),
                    ] {
                        assert!((a - b).abs() < accuracy * size, "{}: {a} {b}", robot.name());
                    }
                    assert!((a.limit_margin - b.limit_margin).abs() < 1e-9);
                    assert_eq!((a.limit_joint, a.worst_case), (b.limit_joint, b.worst_case));
                    for (a, b) in lanes.joints_at(i).iter().zip(single.joints_at(i)) {
                        assert!((a - b).abs() < 1e-9);
                    }
                    for (a, b) in lanes.deviations_at(i).iter().zip(single.deviations_at(i)) {
                        assert!((a - b).norm() < accuracy * size);
                    }
                    for (a, b) in lanes.shares_at(i).iter().zip(single.shares_at(i)) {
                        assert!((a - b).abs() < accuracy * size);
                    }
                }
                assert!(compared > 40, "{}: {compared}", robot.name());
            });
        }
    }
}

#[test]
fn what_lanes_do_not_know_goes_the_general_way() {
    let springy = super::super::tests::springy();
    let mut loaded = springy.clone();
    loaded.load_dependent = true;
    for (model, in_lanes) in [(&springy, true), (&loaded, false)] {
        analysis(&arms::ALL[0], model, NOMINAL, |question| {
            let solver = Solver::new(question, Order::Any, AnswerDetail::Shares);
            assert_eq!(solver.lanes.is_some(), in_lanes);
        });
    }
    // The branches of the first have no names, those of the second depend on where its rail is.
    let coupled = arms::other::on_rail(&arms::ALL[0]);
    let mut joints = coupled.joints().to_vec();
    joints[2].coupling.push(Coupling {
        joint: 0,
        factor: 0.1,
    });
    let coupled = Robot::new("coupled", coupled.chain().motions().to_vec(), joints).unwrap();
    let compliance = vec![arms::ALL[0].compliance().unwrap()[0]; 7];
    let coupled = coupled.with_compliance(compliance).unwrap();
    for robot in [&arms::other::iiwa14(), &coupled] {
        analysis(robot, StiffnessModel::DRIVES, NOMINAL, |question| {
            assert!(
                Solver::new(question, Order::Any, AnswerDetail::Shares)
                    .lanes
                    .is_none()
            );
        });
    }
}

#[test]
fn a_rail_outside_its_range_and_one_at_home_agree_with_single_points() {
    let robot = arms::other::on_rail(&arms::mh12());
    let mut home = robot.home(None);
    for at in [0.3, 5.5] {
        home[0] = at;
        let poses = poses(&robot, 190, 5);
        let moved: Vec<Isometry> = poses
            .iter()
            .map(|pose| Isometry::translation(0.0, at - 2.0, 0.0) * pose)
            .collect();
        for choice in [NOMINAL, BranchChoice::Best] {
            analysis(&robot, StiffnessModel::DRIVES, choice, |question| {
                let question = Question {
                    home: Some(&home),
                    ..*question
                };
                let found =
                    crate::kernel::evaluate(&question, moved.len(), |i| moved[i], Watch::NONE).unwrap();
                let mut general = General::new(&question, AnswerDetail::Shares);
                let mut reached = 0;
                for (pose, found) in moved.iter().zip(&found.points) {
                    let expected = general.answer(&question, pose, None);
                    general.forget();
                    let (Ok(a), Ok(b)) = (found, &expected) else {
                        assert_eq!(*found, expected);
                        continue;
                    };
                    reached += 1;
                    assert_eq!((a.name, a.limit_joint), (b.name, b.limit_joint), "{at}");
                    assert!((a.limit_margin - b.limit_margin).abs() < 1e-9, "{at}");
                    assert!((a.in_plane - b.in_plane).abs() < 1e-9 * b.full, "{at}");
                }
                assert_eq!(reached > 100, at < 5.0 || choice == NOMINAL, "{at} {reached}");
            });
        }
    }
}

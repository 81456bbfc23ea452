use std::sync::Arc;

use nalgebra::{Point2, Point3};

use super::*;
use crate::arms;
use crate::frame::Isometry;
use crate::kernel::{BranchChoice, OnPath, Question, evaluate, evaluate_posture};
use crate::load::{LoadCases, LoadFrame, PathLoad};
use crate::map::{AlongPath, along_path};
use crate::path::{Placing, Shape, Spin};
use crate::robot::forward::forward;
use crate::robot::inverse::tool_on;
use crate::robot::{Amount, Backlash, BacklashSide, Motion, Robot};
use crate::source::StiffnessModel;
use crate::watch::Watch;
use crate::workpiece::Plane;

const GAP: f64 = 2e-4;

/// A circle of 0.1 m off the middle of a tilted plate, so that all joints move.
fn track(backwards: bool) -> Track {
    let plane = Plane::tilted(Point3::new(0.9, 0.15, 0.5), 0.6);
    let mut path = Shape::Circle {
        centre: Point2::origin(),
        radius: 0.1,
    }
    .sampled(1e-3);
    if backwards {
        let at: Vec<_> = path.points.iter().rev().map(|point| point.at).collect();
        for (point, at) in path.points.iter_mut().zip(at) {
            point.at = at;
            point.direction = -point.direction;
        }
    }
    Track {
        path,
        placing: Placing {
            spin: Spin::Fixed(0.3),
            ..Placing::on_plane(&plane)
        },
        base_from_part: plane.base_from_part,
        spins: None,
        homes: None,
    }
}

fn model(side: BacklashSide, gap: f64) -> StiffnessModel {
    let mut model = StiffnessModel::DRIVES.clone();
    model.structure.backlash = vec![
        Some(Backlash {
            gap,
            standard_uncertainty: 0.1 * gap,
            side,
        });
        6
    ];
    model
}

fn push(force: [f64; 3]) -> PathLoad {
    PathLoad::Cases(LoadCases {
        frame: LoadFrame::Base,
        cases: vec![
            Wrench::from_force(force.into()),
            Wrench::from_force(-Vector3::from(force)),
        ],
    })
}

fn along(robot: &Robot, model: &StiffnessModel, backwards: bool, load: PathLoad) -> AlongPath {
    let tool = arms::bent_tool();
    let question = question(robot, model, &tool);
    along_path(&question, &track(backwards), load, Watch::NONE).unwrap()
}

fn question<'a>(robot: &'a Robot, model: &'a StiffnessModel, tool: &'a Isometry) -> Question<'a> {
    let arm = Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        model,
        flange_from_tool: tool,
    };
    Question {
        choice: BranchChoice::Of(robot.nominal_branch()),
        ..Question::unloaded(arm, None)
    }
}

/// Position of the tip at these joint positions of the chain, m.
fn tip(robot: &Robot, q: &[f64]) -> Vector3<f64> {
    tool_on(&forward(robot, q), &arms::bent_tool()).translation.vector
}

#[test]
fn links_behind_by_half_the_backlash_agree_with_forward_kinematics() {
    let robot = arms::mh12();
    let along = along(&robot, &model(BacklashSide::Motion, GAP), false, push([0.0; 3]));
    let moved = &along.backlash_geometry.as_ref().unwrap().displacements;
    let last = along.answers.points.len() - 2;
    let mut given = 0;
    for index in 1..last {
        let q = along.answers.joints_at(index);
        let motor = |joint, at: usize| robot.theta(joint, along.answers.joints_at(at));
        let (mut lags, mut clear) = (q.to_vec(), true);
        for joint in 0..6 {
            // Far enough from the reversal: the link has crossed its backlash.
            let before = index.saturating_sub(30);
            let ways = (before..index).map(|at| motor(joint, at + 1) - motor(joint, at));
            let up = ways.clone().all(|by| by > 0.0) && index > 30;
            let down = ways.clone().all(|by| by < 0.0) && index > 30;
            clear &= (up || down) && (motor(joint, index) - motor(joint, before)).abs() > GAP;
            let lag = if up { -0.5 * GAP } else { 0.5 * GAP };
            lags[joint] = robot.joint_position(joint, motor(joint, index) + lag, &lags);
        }
        if clear {
            given += 1;
            let by = tip(&robot, &lags) - tip(&robot, q);
            // To first order: backlash squared, times a reach of 1 m and six joints.
            assert!(
                (moved[2 * index] - by).norm() < 10.0 * GAP * GAP,
                "{index}: {} {by}",
                moved[2 * index]
            );
            assert!(by.norm() > 2e-5, "{by}");
        }
    }
    assert!(given > 100, "{given}");
    // Without load: all of the deviation is backlash.
    assert_eq!(along.answers.deviations, *moved);
}

#[test]
fn in_the_opposite_direction_links_are_on_the_opposite_side() {
    let robot = arms::mh12();
    let [one, other] = [false, true].map(|backwards| {
        along(
            &robot,
            &model(BacklashSide::Motion, GAP),
            backwards,
            push([0.0; 3]),
        )
        .backlash_geometry
        .unwrap()
        .displacements
    });
    let count = one.len() / 2;
    let opposite = (0..count)
        .filter(|i| (one[2 * i] + other[2 * (count - 1 - i)]).norm() < 1e-9)
        .count();
    // All points except those where links cross their backlash: after the reversal, on either side of it.
    assert!(opposite * 10 > count * 7, "{opposite} of {count}");
}

#[test]
fn a_torque_keeps_its_side_of_the_backlash_and_changes_it_with_the_load() {
    let robot = arms::mh12();
    let along = along(
        &robot,
        &model(BacklashSide::Torque, GAP),
        false,
        push([30.0, -20.0, -80.0]),
    );
    for pair in along.backlash_geometry.unwrap().displacements.chunks(2) {
        // The second case pushes the other way.
        assert!((pair[0] + pair[1]).norm() < 1e-18 && pair[0].norm() > 2e-5);
    }
}

#[test]
fn an_arm_with_geometry_errors_agrees_with_its_actual_chain() {
    let robot = arms::mh12();
    let mut motions = robot.chain().motions().to_vec();
    for motion in &mut motions {
        if let Motion::Along(_, Amount::Constant(length)) = motion {
            *length += 2e-4;
        }
    }
    let actual = Robot::new("actual", motions, robot.joints().to_vec()).unwrap();
    let mut model = StiffnessModel::DRIVES.clone();
    model.actual = Some(Arc::new(actual.clone()));
    let along = along(&robot, &model, false, push([40.0, 10.0, -60.0]));
    let without = self::along(&robot, StiffnessModel::DRIVES, false, push([40.0, 10.0, -60.0]));
    for index in 0..along.answers.points.len() {
        let q = along.answers.joints_at(index);
        let by = tip(&actual, q) - tip(&robot, q);
        let given = along.answers.deviations_at(index)[0] - without.answers.deviations_at(index)[0];
        assert!((given - by).norm() < 1e-12 && by.norm() > 1e-4, "{given} {by}");
    }
}

#[test]
fn a_single_point_deviates_as_on_the_path_and_its_shares_add_up() {
    let robot = arms::mh12();
    let model = model(BacklashSide::Motion, GAP);
    let load = push([40.0, 10.0, -60.0]);
    let along = along(&robot, &model, false, load.clone());
    let tool = arms::bent_tool();
    for index in [0, 17, 230] {
        let track = track(false);
        let stop = track.stop(index);
        let mut cases = vec![Wrench::ZERO; 2];
        track.wrenches(&load, index, &mut cases);
        let requested = Question {
            cases: &cases,
            normal: stop.normal,
            ..question(&robot, &model, &tool)
        };
        let link_offsets = along
            .backlash_geometry
            .as_ref()
            .unwrap()
            .link_offsets_at(index, 6);
        let joints = along.answers.joints_at(index);
        let alone = evaluate_posture(&requested, joints, OnPath::with_link_offsets(link_offsets));
        let (evaluation, there) = (alone.points[0].unwrap(), along.answers.points[index].unwrap());
        assert!((evaluation.in_plane - there.in_plane).abs() < 1e-12);
        assert!((alone.shares_at(0).iter().sum::<f64>() - evaluation.in_plane).abs() < 1e-15);
        // Backlash known to a tenth.
        let exact = StiffnessModel {
            structure: crate::robot::Structure {
                backlash: model
                    .structure
                    .backlash
                    .iter()
                    .map(|gap| {
                        gap.map(|gap| Backlash {
                            standard_uncertainty: 0.0,
                            ..gap
                        })
                    })
                    .collect(),
                ..model.structure.clone()
            },
            ..model.clone()
        };
        let exact = Question {
            arm: Arm {
                model: &exact,
                ..requested.arm
            },
            ..requested
        };
        let exact =
            evaluate_posture(&exact, joints, OnPath::with_link_offsets(link_offsets)).points[0].unwrap();
        assert!(evaluation.in_plane_uncertainty.unwrap() > exact.in_plane_uncertainty.unwrap());
    }
}

#[test]
fn the_motion_of_a_single_point_is_that_of_the_path_and_has_shares() {
    let robot = arms::mh12();
    let model = model(BacklashSide::Motion, GAP);
    let load = push([40.0, 10.0, -60.0]);
    let without = along(&robot, &model, false, load.clone());
    let track = track(false);
    let count = track.len();
    let motion = crate::motion::Motion {
        blending: vec![Vector3::new(2e-5, 0.0, -1e-5); count],
        servo: (0..count)
            .map(|index| Vector3::new(0.0, 1e-7 * index as f64, 3e-5))
            .collect(),
        ..crate::motion::Motion::default()
    };
    let mut along = without.clone();
    along.add_motion(&track, &motion);
    let tool = arms::bent_tool();
    for index in [3, 200] {
        let total = motion.blending[index] + motion.servo[index];
        for (with, without) in along
            .answers
            .deviations_at(index)
            .iter()
            .zip(without.answers.deviations_at(index))
        {
            assert!((with - without - total).norm() < 1e-18);
        }
        let stop = track.stop(index);
        let mut cases = vec![Wrench::ZERO; 2];
        track.wrenches(&load, index, &mut cases);
        let requested = Question {
            cases: &cases,
            normal: stop.normal,
            ..question(&robot, &model, &tool)
        };
        let offsets = along
            .backlash_geometry
            .as_ref()
            .unwrap()
            .link_offsets_at(index, 6);
        let at_point = |motion| {
            let on_path = OnPath {
                motion,
                ..OnPath::with_link_offsets(offsets)
            };
            evaluate_posture(&requested, along.answers.joints_at(index), on_path)
        };
        let alone = at_point(Some(motion.displacement_at(index, 0.3)));
        let evaluation = alone.points[0].unwrap();
        let there = along.answers.points[index].unwrap();
        assert!((evaluation.in_plane - there.in_plane).abs() < 1e-12);
        assert_eq!(alone.share_count, at_point(None).share_count + 2);
        let shares = alone.shares_at(0);
        assert!((shares.iter().sum::<f64>() - evaluation.in_plane).abs() < 1e-15);
        let deviation = alone.deviations_at(0)[evaluation.worst_case];
        let across = (deviation - stop.normal.into_inner() * deviation.dot(&stop.normal)).normalize();
        let last = &shares[shares.len() - 2..];
        assert!((last[0] - motion.blending[index].dot(&across)).abs() < 1e-18);
        assert!((last[1] - motion.servo[index].dot(&across)).abs() < 1e-18);
        let exact = at_point(Some(motion.displacement_at(index, 0.0))).points[0].unwrap();
        let by_lag =
            evaluation.in_plane_uncertainty.unwrap().powi(2) - exact.in_plane_uncertainty.unwrap().powi(2);
        assert!(
            (by_lag.sqrt() / (0.3 * last[1].abs()) - 1.0).abs() < 1e-6,
            "{by_lag}"
        );
    }
}

/// Reference: links on every combination of sides, each evaluated as on a path.
#[test]
fn a_single_point_uses_the_side_of_the_backlash_with_the_largest_deviation() {
    let robot = arms::mh12();
    let mut model = model(BacklashSide::Motion, GAP);
    model.structure.backlash[1].as_mut().unwrap().side = BacklashSide::Torque;
    model.structure.backlash[4] = None;
    let tool = arms::bent_tool();
    for index in [0, 60, 230] {
        let (track, load) = (track(false), push([0.4, 0.1, -0.6]));
        let stop = track.stop(index);
        let mut cases = vec![Wrench::ZERO; 2];
        track.wrenches(&load, index, &mut cases);
        let requested = Question {
            cases: &cases,
            normal: stop.normal,
            ..question(&robot, &model, &tool)
        };
        let given = evaluate(&requested, 1, |_| stop.base_from_tool, Watch::NONE).unwrap();
        let evaluation = given.points[0].unwrap();
        let by_sides = (0..64).map(|sides: usize| {
            let placements = |joint: usize| {
                if sides >> joint & 1 == 0 {
                    0.5 * GAP
                } else {
                    -0.5 * GAP
                }
            };
            let link_offsets: Vec<f64> = (0..6).map(placements).collect();
            evaluate_posture(
                &requested,
                given.joints_at(0),
                OnPath::with_link_offsets(&link_offsets),
            )
            .points[0]
                .unwrap()
                .in_plane
        });
        let all: Vec<f64> = by_sides.collect();
        let farthest = all.iter().copied().fold(0.0, f64::max);
        let nearest = all.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(
            (evaluation.in_plane - farthest).abs() < 1e-12,
            "{} {farthest}",
            evaluation.in_plane
        );
        assert!(nearest < 0.9 * farthest, "the side matters: {nearest} {farthest}");
        assert!((given.shares_at(0).iter().sum::<f64>() - evaluation.in_plane).abs() < 1e-15);
    }
}

#[test]
fn an_arm_without_backlash_and_geometry_errors_is_moved_only_by_its_load() {
    let robot = arms::mh12();
    assert!(
        along(&robot, StiffnessModel::DRIVES, false, push([1.0, 2.0, 3.0]))
            .backlash_geometry
            .is_none()
    );
    // Zero backlash has no effect.
    assert!(
        along(
            &robot,
            &model(BacklashSide::Motion, 0.0),
            false,
            push([1.0, 2.0, 3.0])
        )
        .backlash_geometry
        .is_none()
    );
}

use nalgebra::{Rotation3, Translation3};

use super::*;
use crate::arms::{self, Stream};
use crate::source::StiffnessModel;

fn arm<'a>(robot: &'a crate::robot::Robot, tool: &'a Isometry) -> Arm<'a> {
    Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        flange_from_tool: tool,
        model: StiffnessModel::DRIVES,
    }
}

/// Points on a part of 0.2 m; the same orientation, directions and wrenches everywhere, or each its own.
fn path(random: &mut Stream, [turned, each]: [bool; 2], told_in: ToldIn) -> PlacedPath {
    let count = 100;
    let orientation = UnitQuaternion::from_scaled_axis(random.vector(3.0));
    let along = {
        let axes = Rotation3::from_scaled_axis(random.vector(3.0));
        [axes * Vector3::x(), axes * Vector3::y()]
    };
    let points = (0..count).map(|_| {
        let lean = match turned {
            true => UnitQuaternion::from_scaled_axis(random.vector(0.3)),
            false => UnitQuaternion::identity(),
        };
        Sighted {
            part_from_tool: Isometry::from_parts(Translation3::from(random.vector(0.1)), orientation * lean),
            along: along.map(|along| lean * along),
        }
    });
    let points: Vec<Sighted> = points.collect();
    let wrenches = (0..if each { 3 * count } else { 3 }).map(|k| Wrench {
        force: random.vector(200.0),
        moment: random.vector(if k % 3 == 1 && turned { 5.0 } else { 0.0 }),
    });
    let wrenches = wrenches.collect();
    let pushes = Pushes {
        told_in,
        cases: 3,
        wrenches,
    };
    PlacedPath::new(points, pushes)
}

/// A place whose first point is held by joints within their limits.
fn within_reach(random: &mut Stream, robot: &crate::robot::Robot, tool: &Isometry, path: &PlacedPath) -> PartPlacement {
    let joints = random.joints(robot);
    let stands = crate::robot::forward::forward(robot, &joints).base_from_flange;
    let base_from_flange = Isometry::from_parts(
        stands.translation,
        UnitQuaternion::from_rotation_matrix(&stands.rotation),
    );
    PartPlacement {
        base_from_part: base_from_flange * tool * path.points[0].part_from_tool.inverse(),
        spin: 0.0,
        rail: None,
    }
}

#[test]
fn lanes_judge_as_one_pose_after_the_other_does() {
    let mut random = Stream(4);
    let tool = Isometry::from_parts(
        Translation3::new(0.03, -0.02, 0.15),
        UnitQuaternion::from_scaled_axis(Vector3::new(0.2, 0.4, -0.1)),
    );
    let mut evaluation = 0;
    for robot in arms::all() {
        let arm = arm(&robot, &tool);
        for (margin, wrist) in [(0.0, 0.05), (0.2, 0.05)] {
            let keeping = Keeping {
                margin,
                wrist,
                limit: 2e-4,
            };
            let mut lanes = Judge::new(arm, None, keeping);
            assert!(matches!(lanes.way, Way::Lanes(_)));
            let mut plain = Judge {
                way: Judge::general(arm, None, keeping),
                ..Judge::new(arm, None, keeping)
            };
            for round in 0..12 {
                let path = path(
                    &mut random,
                    [round % 2 == 1, round % 4 > 1],
                    [ToldIn::Base, ToldIn::Part][round / 6],
                );
                let placement = PartPlacement {
                    spin: 0.3 * round as f64,
                    ..within_reach(&mut random, &robot, &tool, &path)
                };
                let open = match round {
                    3 => BranchPattern::from(Branch::ALL[1]),
                    _ => BranchPattern::default(),
                };
                let spins = [0.0, 1.0, -0.6];
                let [a, b] = [
                    lanes.judge_each(&path, &placement, open, &spins),
                    plain.judge_each(&path, &placement, open, &spins),
                ];
                assert_eq!(a.lost, b.lost, "{} {round} {margin}", robot.name());
                for (a, b) in [(a.worst, b.worst), (a.sum, b.sum), (a.above, b.above)] {
                    assert!(
                        (a - b).abs() < 1e-10 * (b + 1e-4),
                        "{} {round}: {a} {b}",
                        robot.name()
                    );
                }
                let one = lanes.judge(&path, &placement, open, |_| true);
                let other = plain.judge(&path, &placement, open, |_| true);
                for slot in 0..SLOTS {
                    let name = robot.name();
                    assert_eq!(one[slot].is_some(), open.matches(Branch::ALL[slot]));
                    let (Some(a), Some(b)) = (one[slot], other[slot]) else {
                        assert_eq!(one[slot], other[slot], "{name} {round} {slot}");
                        continue;
                    };
                    assert_eq!(a.lost, b.lost, "{name} {round} {slot} {margin}");
                    if a.lost > 0 {
                        continue;
                    }
                    evaluation += 1;
                    for (a, b) in [(a.worst, b.worst), (a.sum, b.sum), (a.above, b.above)] {
                        assert!(
                            (a - b).abs() < 1e-10 * (b + 1e-4),
                            "{name} {round} {slot}: {a} {b}"
                        );
                    }
                }
            }
        }
    }
    assert!(evaluation > 100, "{evaluation}");
}

#[test]
fn branches_that_are_not_worth_it_are_given_up() {
    let robot = arms::mh12();
    let tool = Isometry::translation(0.0, 0.0, 0.2);
    let mut random = Stream(9);
    let path = path(&mut random, [false, false], ToldIn::Part);
    let placement = PartPlacement {
        base_from_part: Isometry::translation(1.0, 0.0, 0.5),
        spin: 0.0,
        rail: None,
    };
    let keeping = Keeping {
        margin: 0.0,
        wrist: 0.0,
        limit: 0.0,
    };
    let mut judge = Judge::new(arm(&robot, &tool), None, keeping);
    let all = judge.judge(&path, &placement, BranchPattern::default(), |_| true);
    assert!(all.iter().all(Option::is_some));
    let none = judge.judge(&path, &placement, BranchPattern::default(), |_| false);
    assert_eq!(none, [None; SLOTS]);
    // A judge keeps nothing from one place to the next.
    assert_eq!(judge.judge(&path, &placement, BranchPattern::default(), |_| true), all);
}

#[test]
fn a_glance_loses_no_place_that_is_worth_it() {
    let mut random = Stream(11);
    let tool = Isometry::from_parts(
        Translation3::new(0.03, -0.02, 0.15),
        UnitQuaternion::from_scaled_axis(Vector3::new(0.2, 0.4, -0.1)),
    );
    let (mut alike, mut farthest) = (0, 0.0_f64);
    for robot in arms::all() {
        let arm = arm(&robot, &tool);
        for (margin, wrist) in [(0.0, 0.0), (0.1, 0.05)] {
            let keeping = Keeping {
                margin,
                wrist,
                limit: 2e-4,
            };
            let mut judge = Judge::new(arm, None, keeping);
            let mut glance = Glance::new(arm, keeping).unwrap();
            for round in 0..200 {
                let path = path(
                    &mut random,
                    [round % 2 == 1, round % 4 > 1],
                    [ToldIn::Base, ToldIn::Part][round / 100],
                );
                let placement = within_reach(&mut random, &robot, &tool, &path);
                let strays = glance.strays(&path);
                let truly = judge.judge(&path, &placement, BranchPattern::default(), |_| true);
                let seen = by_lanes(&mut glance.0, (&path.single, &placement), [true; SLOTS], |_| true);
                for (truly, seen) in truly.into_iter().flatten().zip(seen.into_iter().flatten()) {
                    assert!(seen.lost <= truly.lost, "{}: {seen:?} {truly:?}", robot.name());
                    if truly.lost > 0 {
                        continue;
                    }
                    let evaluation = path.len() as f64;
                    let off = [
                        seen.worst - truly.worst,
                        (seen.sum - truly.sum) / evaluation,
                        (seen.above - truly.above) / evaluation,
                    ];
                    let off = off.map(f64::abs).into_iter().fold(0.0, f64::max);
                    assert!(off <= strays, "{}: {off} {strays}", robot.name());
                    alike += usize::from(truly.worst > 0.0);
                    farthest = farthest.max(off / strays);
                }
            }
        }
    }
    // Neither never asked nor a bound that could not be broken.
    assert!(alike > 2000 && farthest > 3e-4, "{alike} {farthest}");
}

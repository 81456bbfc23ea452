use nalgebra::{Rotation3, Translation3, UnitQuaternion, Vector3};

use super::*;
use crate::arms::{self, Stream};
use crate::frame::Isometry;
use crate::kernel::path_on_part::{PathWrenches, PlacedPoint, WrenchAxes};
use crate::kernel::tests::{joints, subjects};
use crate::source::StiffnessModel;
use crate::spatial::Wrench;

fn arm<'a>(robot: &'a crate::robot::Robot, tool: &'a Isometry, model: &'a StiffnessModel) -> Arm<'a> {
    Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        flange_from_tool: tool,
        model,
    }
}

/// Points on a part of 0.2 m; orientation, directions and wrenches the same everywhere, or different at each.
fn path(random: &mut Stream, [turned, each]: [bool; 2], wrench_axes: WrenchAxes) -> PlacedPath {
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
        PlacedPoint {
            part_from_tool: Isometry::from_parts(Translation3::from(random.vector(0.1)), orientation * lean),
            along: along.map(|along| lean * along),
        }
    });
    let points: Vec<PlacedPoint> = points.collect();
    let wrenches = (0..if each { 3 * count } else { 3 }).map(|k| Wrench {
        force: random.vector(200.0),
        moment: random.vector(if k % 3 == 1 && turned { 5.0 } else { 0.0 }),
    });
    let wrenches = wrenches.collect();
    let pushes = PathWrenches {
        wrench_axes,
        cases: 3,
        wrenches,
    };
    PlacedPath::new(points, pushes)
}

/// A placement whose first point has joint positions within their limits, that of a rail included.
fn within_reach(
    random: &mut Stream,
    robot: &crate::robot::Robot,
    tool: &Isometry,
    path: &PlacedPath,
) -> PartPlacement {
    let mut joints = joints(random, robot);
    let rail = robot.slides(0).then(|| random.between(-1.0, 5.0));
    if let Some(rail) = rail {
        joints[0] = rail;
    }
    let pose = crate::robot::forward::forward(robot, &joints).base_from_flange;
    let base_from_flange = Isometry::from_parts(
        pose.translation,
        UnitQuaternion::from_rotation_matrix(&pose.rotation),
    );
    PartPlacement {
        base_from_part: base_from_flange * tool * path.points[0].part_from_tool.inverse(),
        spin: 0.0,
        rail,
    }
}

#[test]
fn lanes_agree_with_one_pose_after_the_other() {
    let mut random = Stream(4);
    let tool = Isometry::from_parts(
        Translation3::new(0.03, -0.02, 0.15),
        UnitQuaternion::from_scaled_axis(Vector3::new(0.2, 0.4, -0.1)),
    );
    let mut compared = 0;
    for (robot, model) in subjects() {
        let arm = arm(&robot, &tool, &model);
        let drives = model.is_drives_alone() && robot.ortho_parallel().is_some();
        for (margin, wrist) in [(0.0, 0.05), (0.2, 0.05)] {
            let margins = PostureMargins {
                margin,
                wrist,
                tolerance: 2e-4,
            };
            let mut lanes = PlacementEvaluator::new(arm, None, margins);
            match &lanes.method {
                PlacementMethod::Lanes(_) => assert!(drives),
                PlacementMethod::General(placer) => assert!(!drives && placer.lanes.is_some()),
            }
            let mut plain = PlacementEvaluator {
                method: PlacementMethod::General(Box::new(GeneralPlacer {
                    columns: Columns::one_by_one(arm, None, [margins.wrist, margins.margin]),
                    lanes: None,
                    tolerance: margins.tolerance,
                })),
                margins,
            };
            for round in 0..12 {
                let path = path(
                    &mut random,
                    [round % 2 == 1, round % 4 > 1],
                    [WrenchAxes::Base, WrenchAxes::Part][round / 6],
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
                    lanes.evaluate_each(&path, &placement, open, &spins),
                    plain.evaluate_each(&path, &placement, open, &spins),
                ];
                assert_eq!(a.unreachable, b.unreachable, "{} {round} {margin}", robot.name());
                for (a, b) in [(a.worst, b.worst), (a.sum, b.sum), (a.above, b.above)] {
                    assert!(
                        (a - b).abs() < 1e-9 * (b + 1e-4),
                        "{} {round}: {a} {b}",
                        robot.name()
                    );
                }
                let one = lanes.evaluate(&path, &placement, open, |_| true);
                let other = plain.evaluate(&path, &placement, open, |_| true);
                for slot in 0..SLOTS {
                    let name = robot.name();
                    assert_eq!(one[slot].is_some(), open.matches(Branch::ALL[slot]));
                    let (Some(a), Some(b)) = (one[slot], other[slot]) else {
                        assert_eq!(one[slot], other[slot], "{name} {round} {slot}");
                        continue;
                    };
                    assert_eq!(a.unreachable, b.unreachable, "{name} {round} {slot} {margin}");
                    if a.unreachable > 0 {
                        continue;
                    }
                    compared += 1;
                    for (a, b) in [(a.worst, b.worst), (a.sum, b.sum), (a.above, b.above)] {
                        assert!(
                            (a - b).abs() < 1e-9 * (b + 1e-4),
                            "{name} {round} {slot}: {a} {b}"
                        );
                    }
                }
            }
        }
    }
    assert!(compared > 100, "{compared}");
}

#[test]
fn branches_that_keep_rejects_are_dropped() {
    let robot = arms::mh12();
    let tool = Isometry::translation(0.0, 0.0, 0.2);
    let mut random = Stream(9);
    let path = path(&mut random, [false, false], WrenchAxes::Part);
    let placement = PartPlacement {
        base_from_part: Isometry::translation(1.0, 0.0, 0.5),
        spin: 0.0,
        rail: None,
    };
    let margins = PostureMargins {
        margin: 0.0,
        wrist: 0.0,
        tolerance: 0.0,
    };
    let mut evaluator = PlacementEvaluator::new(arm(&robot, &tool, StiffnessModel::DRIVES), None, margins);
    let all = evaluator.evaluate(&path, &placement, BranchPattern::default(), |_| true);
    assert!(all.iter().all(Option::is_some));
    let none = evaluator.evaluate(&path, &placement, BranchPattern::default(), |_| false);
    assert_eq!(none, [None; SLOTS]);
    // An evaluator keeps no state between placements.
    assert_eq!(
        evaluator.evaluate(&path, &placement, BranchPattern::default(), |_| true),
        all
    );
}

#[test]
fn screening_never_rejects_a_good_placement() {
    let mut random = Stream(11);
    let tool = Isometry::from_parts(
        Translation3::new(0.03, -0.02, 0.15),
        UnitQuaternion::from_scaled_axis(Vector3::new(0.2, 0.4, -0.1)),
    );
    let (mut alike, mut farthest) = (0, 0.0_f64);
    for robot in arms::all() {
        let arm = arm(&robot, &tool, StiffnessModel::DRIVES);
        for (margin, wrist) in [(0.0, 0.0), (0.1, 0.05)] {
            let margins = PostureMargins {
                margin,
                wrist,
                tolerance: 2e-4,
            };
            let mut evaluator = PlacementEvaluator::new(arm, None, margins);
            let mut screen = PlacementScreen::new(arm, margins).unwrap();
            for round in 0..200 {
                let path = path(
                    &mut random,
                    [round % 2 == 1, round % 4 > 1],
                    [WrenchAxes::Base, WrenchAxes::Part][round / 100],
                );
                let placement = within_reach(&mut random, &robot, &tool, &path);
                let bound = screen.rounding_error(&path);
                let truly = evaluator.evaluate(&path, &placement, BranchPattern::default(), |_| true);
                let seen = by_lanes(&mut screen.0, &path.single, &placement, [true; SLOTS], |_| true);
                for (truly, seen) in truly.into_iter().flatten().zip(seen.into_iter().flatten()) {
                    assert!(
                        seen.unreachable <= truly.unreachable,
                        "{}: {seen:?} {truly:?}",
                        robot.name()
                    );
                    if truly.unreachable > 0 {
                        continue;
                    }
                    let count = path.len() as f64;
                    let off = [
                        seen.worst - truly.worst,
                        (seen.sum - truly.sum) / count,
                        (seen.above - truly.above) / count,
                    ];
                    let off = off.map(f64::abs).into_iter().fold(0.0, f64::max);
                    assert!(off <= bound, "{}: {off} {bound}", robot.name());
                    alike += usize::from(truly.worst > 0.0);
                    farthest = farthest.max(off / bound);
                }
            }
        }
    }
    // The comparison took place, and the bound is not far too wide.
    assert!(alike > 2000 && farthest > 3e-4, "{alike} {farthest}");
}

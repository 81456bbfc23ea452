use std::f64::consts::PI;

use nalgebra::{Point2, Point3, Vector3};

use super::*;
use crate::arms;
use crate::frame::{Isometry, from_xyz_and_fixed_angles};
use crate::load::{LoadCases, LoadFrame, PathLoad};
use crate::map::AlongPath;
use crate::path::{Pace, Placing, Shape, Spin, SpinCurve, SpinKnot, Track};
use crate::robot::Robot;
use crate::source::{Arm, StiffnessModel};
use crate::spatial::Wrench;
use crate::workpiece::Plane;

/// An arm with speed limits and a spindle across its flange, so that the wrist moves where the tool turns.
struct Cell {
    robot: Robot,
    tool: Isometry,
}

impl Cell {
    fn new(max_speed: f64) -> Cell {
        let arm = arms::mh12();
        let mut joints = arm.joints().to_vec();
        for joint in &mut joints {
            joint.max_speed = Some(max_speed);
        }
        let robot = Robot::new("mh12", arm.chain().motions().to_vec(), joints).unwrap();
        Cell {
            robot: robot.with_compliance(arm.compliance().unwrap().to_vec()).unwrap(),
            tool: from_xyz_and_fixed_angles(Vector3::new(0.1, 0.0, 0.15), Vector3::new(0.0, PI / 2.0, 0.0)),
        }
    }

    fn question(&self) -> Question<'_> {
        let arm = Arm {
            robot: &self.robot,
            compliance: self.robot.compliance().unwrap(),
            flange_from_tool: &self.tool,
            model: StiffnessModel::DRIVES,
        };
        Question::unloaded(arm, None)
    }

    fn map(&self, track: &Track, spins: &[f64], columns: usize) -> SpinMap {
        let path = LoadedTrack { track, load: &load() };
        spin_map(&self.question(), path, spins, columns, Watch::NONE).unwrap()
    }

    fn along(&self, track: &Track) -> AlongPath {
        along_path(&self.question(), track, load(), Watch::NONE).unwrap()
    }
}

fn load() -> PathLoad {
    PathLoad::Cases(LoadCases {
        frame: LoadFrame::Feed,
        cases: [[-80.0, 30.0, 10.0], [20.0, 60.0, -25.0]]
            .map(|force| Wrench::from_force(force.into()))
            .to_vec(),
    })
}

/// A line of 0.4 m on a horizontal plate, cut at 40 mm/s.
fn line(spin: f64, step: f64) -> Track {
    let shape = Shape::Polyline(vec![Point2::new(-0.2, 0.05), Point2::new(0.2, -0.05)]);
    let mut path = shape.sampled(step);
    for point in &mut path.points {
        point.pace = Pace::Feed(0.04);
    }
    let plane = Plane::tilted(Point3::new(0.85, 0.0, 0.3), PI / 2.0);
    Track {
        path,
        placing: Placing {
            spin: Spin::Fixed(spin),
            ..Placing::on_plane(&plane)
        },
        base_from_part: plane.base_from_part,
        spins: None,
        homes: None,
    }
}

/// All turns, 10 deg apart.
fn turns() -> Vec<f64> {
    (0..37).map(|k| -PI + f64::from(k) * PI / 18.0).collect()
}

#[test]
fn each_row_is_the_answer_of_the_path_with_that_spin() {
    let cell = Cell::new(7.0);
    let spins = turns();
    let map = cell.map(&line(0.4, 0.005), &spins, 40);
    assert!(map.is_complete && map.points.len() == 40);
    assert_eq!(map.cells.len(), 40 * spins.len());
    let (mut reached, mut lost) = (0, 0);
    for (row, spin) in spins.iter().enumerate() {
        let along = cell.along(&line(0.4 + spin, 0.005));
        for (column, index) in map.points.iter().enumerate() {
            let of_map = map.cell(row, column).evaluation;
            let Ok(plain) = &along.answers.points[*index] else {
                assert_eq!(of_map, None);
                lost += 1;
                continue;
            };
            let of_map = of_map.unwrap();
            // The spin reaches the pose by one turn or by two: rounding, times the condition of the inverse kinematics.
            assert!((of_map.in_plane - plain.in_plane).abs() <= 1e-9 * plain.in_plane);
            assert!((of_map.limit_margin - plain.limit_margin).abs() < 1e-9);
            assert_eq!(of_map.name, plain.name);
            assert_eq!(of_map.singularity, plain.singularity);
            reached += 1;
        }
    }
    assert!(reached > 500, "{reached} reached, {lost} out of reach");
}

#[test]
fn jumps_are_those_of_the_path_and_belong_to_the_column_that_they_lead_to() {
    // So slow that some moves of the wrist are too fast.
    let cell = Cell::new(0.12);
    let spins = turns();
    let map = cell.map(&line(0.0, 0.005), &spins, 20);
    let mut marked = 0;
    for (row, spin) in spins.iter().enumerate() {
        let track = line(*spin, 0.005);
        let along = cell.along(&track);
        let mut expected = [false; 20];
        for obstacle in obstacles(&cell.robot, &track.path, &along.answers, 0.0) {
            let is_move = matches!(
                obstacle.kind,
                ObstacleKind::Jump { .. } | ObstacleKind::TooSlow { .. }
            );
            expected[map.points.partition_point(|point| *point < obstacle.index)] |= is_move;
        }
        for (column, expected) in expected.into_iter().enumerate() {
            assert_eq!(
                map.cell(row, column).on_move.is_some(),
                expected,
                "{row} {column}"
            );
            marked += usize::from(expected);
        }
    }
    assert!(marked > 0 && marked < map.cells.len(), "{marked}");
}

#[test]
fn a_long_path_has_the_same_deviations_at_the_points_of_its_columns() {
    let cell = Cell::new(7.0);
    let fine = line(0.4, 1e-5);
    let all = turns();
    let spins = &all[18..];
    assert!(fine.len() * spins.len() > MOST_EVALUATED / 2);
    let many: Vec<f64> = spins.iter().chain(spins).chain(spins).copied().collect();
    let map = cell.map(&fine, &many, 12);
    assert!(!map.is_complete);
    assert_eq!((map.points[0], *map.points.last().unwrap()), (0, fine.len() - 1));
    for (row, spin) in spins.iter().enumerate().step_by(6) {
        let along = cell.along(&fine.spun(*spin));
        for (column, index) in map.points.iter().enumerate() {
            let plain = along.answers.points[*index].ok().map(|plain| plain.in_plane);
            let of_map = map.cell(row, column).evaluation.map(|found| found.in_plane);
            assert_eq!(of_map.is_some(), plain.is_some());
            if let (Some(of_map), Some(plain)) = (of_map, plain) {
                assert!((of_map - plain).abs() <= 1e-9 * plain);
            }
        }
    }
}

#[test]
fn a_curve_through_one_spin_gives_the_row_of_that_spin() {
    let cell = Cell::new(7.0);
    let track = line(0.4, 0.005);
    let length = track.path.length();
    let knot = |along: f64| SpinKnot { along, spin: 0.3 };
    let curve = SpinCurve::new(vec![knot(0.0), knot(0.4 * length), knot(length)]).unwrap();
    let spins = Some(curve.along(&track.path));
    let along = cell.along(&Track {
        spins,
        ..track.clone()
    });
    let map = cell.map(&track, &[0.3], usize::MAX);
    for (column, index) in map.points.iter().enumerate() {
        assert_eq!(
            map.cell(0, column).evaluation,
            along.answers.points[*index].ok(),
            "{column}"
        );
    }
}

#[test]
fn columns_are_spread_from_the_first_point_to_the_last() {
    assert_eq!(spread(5, 10), [0, 1, 2, 3, 4]);
    assert_eq!(spread(101, 3), [0, 50, 100]);
    assert_eq!(spread(1, 10), [0]);
    assert!(spread(0, 10).is_empty());
    assert_eq!(with_points_before(&[0, 1, 5, 6, 9]), [0, 1, 4, 5, 6, 8, 9]);
}

//! Several axes that move along a path together: a gantry, a rail with a turntable, a tilting turntable.

use std::f64::consts::PI;

use nalgebra::{Point2, Point3, UnitQuaternion, Vector3};

use super::tests::{load, question, tool};
use super::*;
use crate::arms;
use crate::frame::Isometry;
use crate::map::{along_postures, obstacles};
use crate::optimize::posture::tests::{FEED, search, track};
use crate::optimize::{MovingAxis, Steps, postures_along};
use crate::path::Shape;
use crate::robot::forward::forward;
use crate::robot::positioner::Positioner;
use crate::robot::{Amount, Axis, Joint, JointCompliance, Motion, Robot};

const STIFF: JointCompliance = JointCompliance {
    value: 0.0,
    standard_uncertainty: 0.0,
};

/// The robot behind further joints, in front of which nothing is.
fn behind(robot: &Robot, own: Vec<(Motion, &str)>) -> Robot {
    let count = own.len();
    let moved = |amount: Amount| match amount {
        Amount::Joint(joint) => Amount::Joint(joint + count),
        constant => constant,
    };
    let motions = robot.chain().motions().iter().map(|motion| match *motion {
        Motion::Along(axis, amount) => Motion::Along(axis, moved(amount)),
        Motion::About(axis, amount) => Motion::About(axis, moved(amount)),
    });
    let joints = own.iter().map(|(_, name)| Joint::plain(*name));
    let joints = joints.chain(robot.joints().iter().cloned());
    let compliance = vec![STIFF; count].into_iter();
    let compliance = compliance.chain(robot.compliance().unwrap().to_vec());
    let all = own.iter().map(|(motion, _)| *motion).chain(motions).collect();
    let whole = Robot::new("whole", all, joints.collect()).unwrap();
    whole.with_compliance(compliance.collect()).unwrap()
}

fn axis(joint: usize, [first, last]: [f64; 2], (step, rate): (f64, f64)) -> MovingAxis {
    MovingAxis {
        joint,
        positions: Steps {
            first,
            step,
            count: ((last - first) / step).round() as usize + 1,
        },
        rate,
        still: false,
    }
}

/// Follows a path that the arm alone cannot; the least and greatest position of each axis. Checked are the position of the tool at every point,
/// and the speeds of the axes.
fn followed(robot: &Robot, track: &Track, axes: Vec<MovingAxis>) -> Vec<[f64; 2]> {
    let tool = tool();
    let question = question(robot, &tool);
    let loaded = LoadedTrack { track, load: &load() };
    let still = postures_along(&question, loaded, &search(Objective::Mean), Watch::NONE).unwrap();
    assert!(!still.unreachable.is_empty());
    let moving = PostureSearch {
        axes,
        ..search(Objective::Mean)
    };
    let found = postures_along(&question, loaded, &moving, Watch::NONE).unwrap();
    assert_eq!((&found.unreachable[..], &found.breaks[..]), (&[][..], &[][..]));
    let turned = found.turned(track);
    let along = along_postures(&question, &turned, load(), found.choices(), Watch::NONE).unwrap();
    assert_eq!(obstacles(robot, &track.path, &along.answers, 0.0).count(), 0);
    for index in 0..turned.len() {
        let frames = forward(robot, along.answers.joints_at(index));
        let base_from_flange: Isometry = nalgebra::convert(frames.base_from_flange);
        let tip = base_from_flange * tool;
        let wanted = turned.stop(index).base_from_tool;
        assert!(
            (tip.translation.vector - wanted.translation.vector).norm() < 1e-9,
            "point {index}"
        );
        assert!(tip.rotation.angle_to(&wanted.rotation) < 1e-7, "point {index}");
    }
    let position = |index: usize, axis: &MovingAxis| along.answers.joints_at(index)[axis.joint];
    for index in 1..track.len() {
        let way = track.path.points[index].along - track.path.points[index - 1].along;
        for axis in &moving.axes {
            let by = (position(index, axis) - position(index - 1, axis)).abs();
            // The rate is that of the steps; between the middles of two steps it is up to twice that.
            assert!(by <= 2.0 * axis.rate * way, "point {index}");
            let most = robot.joints()[axis.joint].max_speed.unwrap_or(f64::INFINITY);
            assert!(by <= most * way / FEED * (1.0 + 1e-9), "point {index}");
        }
    }
    moving
        .axes
        .iter()
        .map(|axis| {
            let all = (0..track.len()).map(|index| position(index, axis));
            all.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], at| {
                [least.min(at), most.max(at)]
            })
        })
        .collect()
}

/// On a horizontal plate.
fn polyline(points: &[[f64; 2]], step: f64, centre: Point3<f64>) -> Track {
    let points = points.iter().map(|point| Point2::from(*point)).collect();
    track(Shape::Polyline(points).sampled(step), centre)
}

fn wide(ranges: &[[f64; 2]], least: f64) -> bool {
    ranges.iter().all(|[first, last]| last - first > least)
}

#[test]
fn a_plate_of_four_by_three_metres_is_milled_from_a_gantry() {
    let own = vec![
        (Motion::Along(Axis::X, Amount::Joint(0)), "bridge"),
        (Motion::Along(Axis::Y, Amount::Joint(1)), "trolley"),
    ];
    let robot = behind(&arms::mh12(), own);
    let corner = [[-2.0, -1.5], [2.0, -1.5], [2.0, 1.5]];
    let track = polyline(&corner, 0.02, Point3::new(1.0, 0.0, 0.2));
    let axes = (0..2).map(|joint| axis(joint, [-3.0, 3.0], (0.1, 2.0))).collect();
    let ranges = followed(&robot, &track, axes);
    assert!(wide(&ranges, 1.0), "{ranges:?}");
}

#[test]
fn a_ring_is_milled_on_a_turntable_at_the_end_of_a_rail() {
    let railed = arms::other::on_rail(&arms::mh12());
    let table = Robot::new(
        "table",
        vec![Motion::About(Axis::Z, Amount::Joint(0))],
        vec![Joint::plain("turn")],
    );
    let table = table.unwrap().with_compliance(vec![STIFF]).unwrap();
    let standing = Positioner {
        robot: &table,
        base_from_root: &Isometry::translation(1.3, 4.5, 0.3),
        home: &[0.0],
    };
    let robot = railed.on_positioner(&standing, "base_link").unwrap();
    let circle = Shape::Circle {
        centre: Point2::origin(),
        radius: 0.8,
    };
    let track = track(circle.sampled(0.05), Point3::new(0.0, 0.0, 0.1));
    let axes = vec![axis(0, [-6.4, 6.4], (0.25, 4.0)), axis(1, [0.0, 5.0], (0.5, 4.0))];
    let ranges = followed(&robot, &track, axes);
    let [table, rail] = ranges[..] else {
        panic!("two axes")
    };
    assert!(table[1] - table[0] > 2.0 && rail[0] > 3.0, "{ranges:?}");
}

#[test]
fn a_face_away_from_the_robot_is_milled_on_a_tilting_turntable() {
    let motions = vec![
        Motion::About(Axis::Y, Amount::Joint(0)),
        Motion::About(Axis::Z, Amount::Joint(1)),
    ];
    let table = Robot::new("table", motions, vec![Joint::plain("tilt"), Joint::plain("turn")]);
    let table = table.unwrap().with_compliance(vec![STIFF; 2]).unwrap();
    let standing = Positioner {
        robot: &table,
        base_from_root: &Isometry::translation(1.4, 0.0, 0.4),
        home: &[0.0, 0.0],
    };
    let robot = arms::mh12().on_positioner(&standing, "base_link").unwrap();
    let square = [[-0.2, -0.1], [0.2, -0.1], [0.2, 0.1], [-0.2, 0.1], [-0.2, -0.1]];
    let flat = polyline(&square, 0.02, Point3::new(0.0, 0.0, 0.2));
    let away = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), PI / 2.0);
    let track = flat.moved(
        Isometry::from_parts(Default::default(), away) * flat.base_from_part,
        0.0,
    );
    // The joints of the positioner from the table back.
    let axes = vec![axis(0, [-1.6, 1.6], (0.1, 4.0)), axis(1, [-1.2, 1.2], (0.1, 4.0))];
    let ranges = followed(&robot, &track, axes);
    let farthest = ranges.iter().map(|[first, last]| first.abs().max(last.abs()));
    assert!(farthest.fold(0.0, f64::max) > 0.5, "{ranges:?}");
}

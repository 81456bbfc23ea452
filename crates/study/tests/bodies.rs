//! Bodies of the library: are all links enclosed, and is the arm free of itself where it should be?

// A panic is how a test says that its claim is false.
#![allow(clippy::unwrap_used, clippy::panic)]

use armill_core::clearance::{Cell, CellState, PlacedCell, Shape};
use armill_core::frame::{Isometry, tool_orientation};
use armill_core::nalgebra::{IsometryMatrix3, Point3, Translation3, Vector3};
use armill_core::robot::forward::{forward, joint_axis};
use armill_core::robot::inverse::{ToolAt, postures};
use armill_core::robot::{Attachment, Robot, reach};
use armill_formats::robot::RobotDescription;
use armill_study::library;

fn arm(name: &str) -> RobotDescription {
    library::robot(name).unwrap().unwrap()
}

/// The bodies of an arm alone.
fn cell_of(found: &RobotDescription) -> Cell {
    Cell::new(
        &found.robot,
        &Isometry::identity(),
        found.bodies.clone(),
        &found.apart,
        &[],
    )
}

/// Name of the pair in contact at these joint positions, rad.
fn contact(found: &RobotDescription, joints: &[f64]) -> Option<String> {
    let cell = cell_of(found);
    let here = Isometry::identity();
    let placed = PlacedCell {
        cell: &cell,
        base_from_part: &here,
    };
    let mut state = CellState::new(placed, &found.robot, &here);
    state.set_joints(joints);
    let [first, second] = state.clearance(0.0)?.bodies;
    Some(format!("{} and {}", cell.name(first), cell.name(second)))
}

#[test]
fn the_base_and_every_moving_link_have_bodies_with_an_accuracy() {
    for entry in library::ROBOTS {
        let found = arm(entry.name);
        let has = |at: Attachment| found.bodies.iter().any(|body| body.attachment == at);
        assert!(has(Attachment::Base), "{}: base", entry.name);
        for (index, joint) in found.robot.joints().iter().enumerate() {
            assert!(has(Attachment::Joint(index)), "{}: {}", entry.name, joint.name);
        }
        assert!(
            found.body_notes.iter().all(|note| note.accuracy_mm.is_some()),
            "{}",
            entry.name
        );
    }
}

#[test]
fn no_arm_touches_itself_with_all_joints_at_zero() {
    for entry in library::ROBOTS {
        let found = arm(entry.name);
        let zero = vec![0.0; found.robot.joints().len()];
        assert_eq!(contact(&found, &zero), None, "{}", entry.name);
    }
}

#[test]
fn no_arm_touches_itself_in_its_nominal_branch_before_the_robot() {
    for entry in library::ROBOTS {
        let found = arm(entry.name);
        let robot = &found.robot;
        let (Some(_), Some(reach)) = (robot.ortho_parallel(), reach(robot)) else {
            continue;
        };
        // A tool that points down, at a few places in front of the robot, where parts are milled.
        for [x, y, z] in [[0.65, 0.0, 0.4], [0.6, 0.25, 0.3], [0.75, -0.2, 0.5]] {
            let tool = ToolAt {
                flange_from_tool: &Isometry::identity(),
                near: None,
                home: None,
            };
            let down = tool_orientation(-Vector3::z_axis(), 0.0);
            let pose = Isometry::from_parts(Translation3::new(x * reach, y * reach, z * reach), down);
            for posture in postures(robot, &pose, tool).unwrap_or_default() {
                let is_nominal =
                    (posture.name.branch()).is_some_and(|branch| robot.nominal_branch().matches(branch));
                let is_inside = robot
                    .limit_margin(&posture.joints)
                    .is_none_or(|(_, margin)| margin > 0.0);
                if is_nominal && is_inside {
                    let at = format!("{} at {x} {y} {z} of its reach", entry.name);
                    assert_eq!(contact(&found, &posture.joints), None, "{at}");
                }
            }
        }
    }
}

/// Distance of a point from the nearest body of this link, m.
fn distance_from_link(found: &RobotDescription, at: Attachment, point: Point3<f64>) -> f64 {
    let own = found.bodies.iter().filter(|body| body.attachment == at);
    let identity = IsometryMatrix3::identity();
    own.map(|body| body.shape.placed(&identity).distance_of(&point, f64::INFINITY))
        .fold(f64::INFINITY, f64::min)
}

/// The axis of a joint passes through the links on both sides of it: its frame is on the axis, so that bodies in a wrong frame
/// would be far from it.
#[test]
fn bodies_reach_the_axis_of_the_next_joint() {
    for entry in library::ROBOTS {
        let found = arm(entry.name);
        let robot: &Robot = &found.robot;
        let frames = forward(robot, &vec![0.0; robot.joints().len()]);
        for next in 1..robot.joints().len() {
            let to_link = frames.base_from_joint[next - 1].inverse();
            let axis = joint_axis(robot, &frames, next);
            let origin = frames.origin(next);
            // Somewhere along the axis: the frame of a wrist joint may be at the other end of the forearm.
            let nearest = (-30..=30)
                .map(|step| to_link * (origin + axis * (0.05 * f64::from(step))))
                .map(|point| distance_from_link(&found, Attachment::Joint(next - 1), point))
                .fold(f64::INFINITY, f64::min);
            assert!(
                nearest < 0.02,
                "{}: joint {} is {nearest} m off the link before it",
                entry.name,
                next + 1
            );
        }
    }
}

#[test]
fn a_folded_arm_touches_itself() {
    // The forearm of the MH12 folded back against its base: what a wrong frame or an empty pair would miss.
    let found = arm("yaskawa/mh12");
    let upper = |index: usize| found.robot.joints()[index].limits.unwrap();
    let joints = [0.0, upper(1).upper, upper(2).lower, 0.0, 0.0, 0.0];
    assert!(contact(&found, &joints).is_some());
    assert!(
        found
            .bodies
            .iter()
            .all(|body| !matches!(body.shape, Shape::Mesh(_)))
    );
}

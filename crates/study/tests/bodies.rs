//! Bodies of the library: are all links enclosed, and is the arm free of itself where it should be?

// A panic is how a test says that its claim is false.
#![allow(clippy::unwrap_used, clippy::panic)]

use armill_core::clearance::{Cell, CellState, PlacedCell, Shape};
use armill_core::frame::{Isometry, tool_orientation};
use armill_core::nalgebra::{IsometryMatrix3, Point3, Translation3, Vector3};
use armill_core::robot::forward::{forward, joint_axis};
use armill_core::robot::inverse::{ToolAt, postures};
use armill_core::robot::{Attachment, Robot, reach};
use armill_formats::robot::format::RobotReadOptions;
use armill_formats::robot::{RobotDescription, armill};
use armill_study::enclosed_links::EnclosedLinks;
use armill_study::{library, robots};

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

/// A plate with a post at one end, in mm: two boxes of triangles in STL.
fn angle_stl() -> String {
    let boxes = [
        [[0.0, -40.0, -40.0], [500.0, 40.0, 40.0]],
        [[420.0, -40.0, 40.0], [500.0, 40.0, 400.0]],
    ];
    let mut text = "solid angle\n".to_owned();
    for corners in boxes {
        let corner = |bits: usize| [0, 1, 2].map(|axis| corners[bits >> axis & 1][axis]);
        let quads = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        for [a, b, c, d] in &quads {
            for triangle in [[a, b, c], [a, c, d]] {
                text += "facet normal 0 0 0\nouter loop\n";
                for bits in triangle {
                    let [x, y, z] = corner(*bits);
                    text += &format!("vertex {x} {y} {z}\n");
                }
                text += "endloop\nendfacet\n";
            }
        }
    }
    text + "endsolid angle\n"
}

/// A base with one lever, whose mesh is displaced and turned in its link.
const LEVER: &str = r#"<?xml version="1.0"?>
<robot name="lever"><link name="base"/>
  <link name="arm"><collision><origin xyz="0.1 0 0.05" rpy="0 0 1.5707963267948966"/>
    <geometry><mesh filename="angle.stl" scale="0.001 0.001 0.001"/></geometry></collision></link>
  <link name="end"/>
  <joint name="A" type="revolute"><parent link="base"/><child link="arm"/>
    <origin xyz="0 0 0.3" rpy="0 0 0"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="0" velocity="1"/></joint>
  <joint name="B" type="revolute"><parent link="arm"/><child link="end"/>
    <origin xyz="0.5 0 0" rpy="0 0 0"/><axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="0" velocity="1"/></joint>
</robot>
"#;

#[test]
fn capsules_around_the_meshes_of_a_urdf_contain_every_corner_when_they_are_read_again() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("angle.stl"), angle_stl()).unwrap();
    let urdf = folder.path().join("arm.urdf");
    std::fs::write(&urdf, LEVER).unwrap();
    let mut volumes = Vec::new();
    for most in [1, 3] {
        let found = EnclosedLinks::of(urdf.to_str().unwrap(), most).unwrap();
        let imported = robots::import(&urdf, &RobotReadOptions::default()).unwrap();
        let text = armill::write(&imported) + &armill::body_tables(&found.robot);
        let read = armill::read("arm.toml", "arm", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert!(!read.bodies.is_empty() && read.bodies.len() <= most);
        let capsules: Vec<_> = read
            .bodies
            .iter()
            .map(|body| match &body.shape {
                Shape::Capsule(capsule) if body.attachment == Attachment::Joint(0) => *capsule,
                other => panic!("{other:?} at {:?}", body.attachment),
            })
            .collect();
        // A quarter turn about z: (x, y) becomes (-y, x).
        for line in angle_stl()
            .lines()
            .filter_map(|line| line.strip_prefix("vertex "))
        {
            let at: Vec<f64> = line
                .split(' ')
                .map(|word| word.parse::<f64>().unwrap() / 1000.0)
                .collect();
            let corner = Point3::new(0.1 - at[1], at[0], 0.05 + at[2]);
            let outside = |capsule: &armill_core::clearance::Capsule| {
                (capsule.axis.nearest_to_point(&corner) - corner).norm() - capsule.radius
            };
            let least = capsules.iter().map(outside).fold(f64::INFINITY, f64::min);
            assert!(least <= 1e-6, "{corner} is {least} m outside");
        }
        for (note, capsule) in read.body_notes.iter().zip(&capsules) {
            let accuracy_mm = note.accuracy_mm.unwrap();
            // The middle of a face of a bar of 80 mm is at least this far from the capsule around its edges.
            assert!(
                accuracy_mm >= 1000.0 * capsule.radius - 40.0 && accuracy_mm < 400.0,
                "{accuracy_mm}"
            );
            assert_eq!(note.source, "collision meshes");
        }
        volumes.push(found.volume_ratio.unwrap());
    }
    assert!(volumes[0] > volumes[1] && volumes[1] > 1.0, "{volumes:?}");
}

#[test]
fn a_robot_without_meshes_is_refused_with_what_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let urdf = folder.path().join("arm.urdf");
    std::fs::write(&urdf, LEVER).unwrap();
    for (robot, expected) in [
        (urdf.to_str().unwrap(), "The mesh `angle.stl` of lever"),
        (
            "yaskawa/mh12",
            "The shapes of the links of Yaskawa MH12 are not known",
        ),
    ] {
        let message = EnclosedLinks::of(robot, 3).unwrap_err().to_string();
        assert!(
            message.contains(expected) && message.contains("collision meshes"),
            "{message}"
        );
    }
}

//! The cell of an arm that holds the part. The witness is the same arm with the part as its tool, and the standing tool as an obstacle.

use nalgebra::{Point3, Vector3};

use super::*;
use crate::arms::{self, Stream};
use crate::clearance::along::tests::tessellated;
use crate::clearance::cell::Clearance;
use crate::clearance::nearest::Segment;
use crate::clearance::{Bounds, ClearanceAlong, ClearanceCheck, DemandedClearance, Floor, Shape};
use crate::frame::from_xyz_and_fixed_angles;
use crate::robot::forward::forward;
use crate::robot::positioner::Positioner;

const FLOOR: f64 = -0.3;

fn capsule(from: [f64; 3], to: [f64; 3], radius: f64) -> Shape {
    Shape::Capsule(Capsule {
        axis: Segment {
            from: from.into(),
            to: to.into(),
        },
        radius,
    })
}

fn body(name: &str, attachment: Attachment, shape: Shape, role: Role) -> ArmBody {
    ArmBody {
        name: name.to_owned(),
        attachment,
        attachment_from_body: Isometry::identity(),
        shape,
        role,
    }
}

/// Slim capsules from axis to axis of an MH12 or an R-2000iC, which differ in size.
fn links(length: f64) -> Vec<ArmBody> {
    let link = |name: &str, attachment, from, to, radius| {
        body(name, attachment, capsule(from, to, radius), Role::Link)
    };
    vec![
        link("base", Attachment::Base, [0.0, 0.0, 0.05], [0.0, 0.0, 0.15], 0.1),
        link("shoulder", Attachment::Joint(0), [0.0; 3], [0.1, 0.0, 0.1], 0.08),
        link(
            "upper arm",
            Attachment::Joint(1),
            [0.0; 3],
            [0.0, 0.0, length],
            0.08,
        ),
        link("elbow", Attachment::Joint(2), [0.0; 3], [0.1, 0.0, 0.05], 0.06),
        link(
            "forearm",
            Attachment::Joint(3),
            [0.1, 0.0, 0.0],
            [0.5, 0.0, 0.0],
            0.05,
        ),
        link(
            "wrist",
            Attachment::Joint(4),
            [-0.03, 0.0, 0.0],
            [0.03, 0.0, 0.0],
            0.04,
        ),
        link("hand", Attachment::Joint(5), [0.0; 3], [0.0, 0.0, 0.02], 0.04),
    ]
}

fn base_from_mount() -> Isometry {
    from_xyz_and_fixed_angles(Vector3::new(1.1, -0.2, 0.7), Vector3::new(0.1, -1.4, 0.3))
}

fn flange_from_part() -> Isometry {
    from_xyz_and_fixed_angles(Vector3::new(0.02, -0.05, 0.25), Vector3::new(0.3, 0.1, 0.4))
}

/// A mesh of 300 mm by 200 mm by 100 mm, in its own frame.
fn part() -> Shape {
    let corners = [Point3::new(-0.15, -0.1, -0.05), Point3::new(0.15, 0.1, 0.05)];
    tessellated(&Shape::Box(Bounds::of(corners)))
}

/// Spindle and cutter, from the mount on.
fn spindle() -> Shape {
    Shape::Cylinder(
        Segment {
            from: Point3::new(0.0, 0.0, -0.3),
            to: Point3::new(0.0, 0.0, 0.1),
        },
        0.06,
    )
}

fn cutter() -> Shape {
    capsule([0.0, 0.0, 0.1], [0.0, 0.0, 0.2], 0.005)
}

/// A wall behind the arm, in its base.
fn wall() -> Shape {
    Shape::Box(Bounds::of([
        Point3::new(-0.9, -1.5, -0.3),
        Point3::new(-0.8, 1.5, 1.5),
    ]))
}

fn fixed(name: &str, shape: Shape, frame_from_body: Isometry, is_part: bool) -> FixedBody {
    FixedBody {
        name: name.to_owned(),
        shape,
        frame_from_body,
        is_part,
    }
}

/// The cell of the arm that holds the part, as the chain from its flange back; the part is at its own frame.
fn of_hand(arm: &Robot, hand: &Robot, length: f64) -> Cell {
    let stand = Isometry::identity();
    let read_back = Positioner {
        robot: arm,
        base_from_root: &stand,
        home: &[],
    };
    let ground = hand.chain().ground();
    let on_ground = |name: &str, shape: Shape, ground_from_body: Isometry| ArmBody {
        attachment_from_body: ground.joint_from_ground * ground_from_body,
        ..body(name, ground.attachment(), shape, Role::Obstacle)
    };
    let mut bodies: Vec<ArmBody> = links(length)
        .into_iter()
        .map(|body| {
            let (attachment, new_from_old) = read_back.attached(body.attachment);
            ArmBody {
                attachment,
                attachment_from_body: new_from_old * body.attachment_from_body,
                ..body
            }
        })
        .collect();
    bodies.push(body("spindle", Attachment::Flange, spindle(), Role::Holder));
    bodies.push(body("cutter", Attachment::Flange, cutter(), Role::Cutter));
    bodies.push(on_ground("wall", wall(), Isometry::identity()));
    let slab = Bounds::of([Point3::new(-9.0, -9.0, FLOOR - 1.0), Point3::new(9.0, 9.0, FLOOR)]);
    bodies.push(on_ground("floor", Shape::Box(slab), Isometry::identity()));
    let near_the_floor = [[0, 10], [1, 10]];
    let part = fixed("part", part(), Isometry::identity(), true);
    Cell::new(hand, &Isometry::identity(), bodies, &near_the_floor, &[part])
}

/// The cell of the arm with the part as its tool: spindle, wall and floor stand still. Without the cutter.
fn of_tool(arm: &Robot, length: f64) -> Cell {
    let mut bodies = links(length);
    bodies.push(ArmBody {
        attachment_from_body: flange_from_part(),
        ..body("part", Attachment::Flange, part(), Role::Holder)
    });
    let still = [
        fixed("spindle", spindle(), base_from_mount(), false),
        fixed("wall", wall(), Isometry::identity(), false),
    ];
    let plane = Isometry::translation(0.0, 0.0, FLOOR);
    Cell::new(arm, &Isometry::identity(), bodies, &[], &still).with_floor(Floor::below("floor", &plane, arm))
}

/// Distance of the cutter from the links, but for the base.
fn from_cutter(arm: &Robot, links: &[ArmBody], q: &[f64]) -> f64 {
    let frames = forward(arm, q);
    let cutter = cutter().placed(&matrix(&base_from_mount()));
    let distance = |body: &ArmBody| match body.attachment {
        Attachment::Joint(joint) => {
            let placed = body.shape.placed(&frames.base_from_joint[joint]);
            placed.nearest(&cutter, 10.0).map_or(10.0, |found| found.distance)
        }
        _ => 10.0,
    };
    links.iter().map(distance).fold(10.0, f64::min)
}

fn placed<'a>(cell: &'a Cell, base_from_part: &'a Isometry) -> PlacedCell<'a> {
    PlacedCell { cell, base_from_part }
}

fn back(q: &[f64]) -> Vec<f64> {
    q.iter().rev().copied().collect()
}

#[test]
fn clearance_is_that_of_the_arm_with_the_part_as_its_tool() {
    let here = Isometry::identity();
    let mut nearest: Vec<String> = Vec::new();
    for (arm, length) in [(arms::mh12(), 0.614), (arms::r2000ic(), 1.0)] {
        let hand = arm.holding_part(&base_from_mount()).unwrap();
        let (of_hand, of_tool) = (of_hand(&arm, &hand, length), of_tool(&arm, length));
        assert_eq!(of_hand.always_in_contact.len(), of_tool.always_in_contact.len());
        let part = flange_from_part();
        let mut hand_state = CellState::new(placed(&of_hand, &part), &hand, &here);
        let mut tool_state = CellState::new(placed(&of_tool, &here), &arm, &here);
        let own = links(length);
        let mut stream = Stream(17);
        let mut apart = 0;
        for _ in 0..1500 {
            let q = stream.joints(&arm);
            hand_state.set_joints(&back(&q));
            tool_state.set_joints(&q);
            let distance = |found: Option<Clearance>| found.map_or(10.0, |found| found.nearest.distance);
            let found = hand_state.clearance(10.0);
            let expected = distance(tool_state.clearance(10.0)).min(from_cutter(&arm, &own, &q));
            assert!(
                (distance(found) - expected).abs() < 1e-9,
                "{} against {expected} m at {q:?}",
                distance(found)
            );
            let bodies = found.unwrap().bodies.map(|body| of_hand.name(body));
            nearest.push(bodies.join(" and "));
            apart += usize::from(expected > 0.0);
        }
        assert!(apart > 500, "{apart}");
    }
    // Every kind of pair is the nearest one somewhere.
    for pair in [
        "spindle and part",
        "wall and part",
        "floor and part",
        "base and part",
        "forearm and spindle",
        "forearm and cutter",
        "upper arm and forearm",
    ] {
        assert!(nearest.iter().any(|found| found == pair), "{pair}");
    }
}

#[test]
fn demanded_clearances_are_decided_as_measured_and_along_small_steps() {
    let (here, part) = (Isometry::identity(), flange_from_part());
    let arm = arms::mh12();
    let hand = arm.holding_part(&base_from_mount()).unwrap();
    let least = 0.02;
    let cell = of_hand(&arm, &hand, 0.614)
        .for_clearance(&hand, &here, least)
        .with_part_in_hand(&hand, &part, least);
    assert!(cell.near_part.is_empty() && cell.always_near.is_empty());
    let demanded = DemandedClearance {
        placed: placed(&cell, &part),
        least,
    };
    let mut check = ClearanceCheck::new(demanded, &hand, &here);
    let mut along = ClearanceAlong::new(ClearanceCheck::new(demanded, &hand, &here));
    let mut stream = Stream(29);
    let (mut kept, mut lost) = (0, 0);
    for _ in 0..60 {
        let (from, to) = (stream.joints(&hand), stream.joints(&hand));
        for i in 0..40 {
            let part = f64::from(i) / 400.0;
            let q: Vec<f64> = from.iter().zip(&to).map(|(a, b)| a + (b - a) * part).collect();
            let is_kept = check.conflict(&q).is_none();
            assert_eq!(along.is_kept(&q), is_kept);
            kept += usize::from(is_kept);
            lost += usize::from(!is_kept);
        }
    }
    assert!(kept > 300 && lost > 300, "{kept} {lost}");
}

#[test]
fn a_link_that_is_always_near_the_part_only_must_not_touch_it() {
    let here = Isometry::identity();
    let arm = arms::mh12();
    let hand = arm.holding_part(&base_from_mount()).unwrap();
    // 100 mm in front of the wrist.
    let part = Isometry::translation(0.0, 0.0, 0.1);
    let least = 0.5;
    let plain = of_hand(&arm, &hand, 0.614).for_clearance(&hand, &here, least);
    let cell = plain.clone().with_part_in_hand(&hand, &part, least);
    let near: Vec<&str> = cell.near_part.iter().map(|body| cell.name(*body)).collect();
    assert!(near.contains(&"wrist"), "{near:?}");
    assert!(!near.contains(&"spindle"));
    // The wrist keeps what is demanded from the part, although it is nearer: only its contact counts.
    let wrist = 5;
    let mut state = CellState::new(placed(&cell, &part), &hand, &here);
    state.set_joints(&[0.0; 6]);
    let mut bare = CellState::new(placed(&plain, &part), &hand, &here);
    bare.set_joints(&[0.0; 6]);
    let near_part = |found: Option<(Clearance, f64)>| found.filter(|(found, _)| found.bodies[0] == wrist);
    assert!(near_part(state.demanded_clearance(least, least)).is_none());
    assert_eq!(cell.name(bare.clearance(least).unwrap().bodies[0]), "wrist");
}

#[test]
fn bodies_apart_from_the_part_are_not_checked_against_it() {
    let (here, part) = (Isometry::identity(), Isometry::translation(0.0, 0.0, -0.05));
    let arm = arms::mh12();
    let hand = arm.holding_part(&base_from_mount()).unwrap();
    let cell = of_hand(&arm, &hand, 0.614);
    let wrist = 5;
    assert_eq!(cell.always_near_part(&hand, &part, 0.0), [wrist]);
    let without = cell.clone().apart_from_part(vec![wrist]);
    assert!(without.always_near_part(&hand, &part, 0.0).is_empty());
    let touching = |cell: &Cell| {
        let mut state = CellState::new(placed(cell, &part), &hand, &here);
        state.set_joints(&[0.1; 6]);
        state.clearance(10.0).unwrap().nearest.distance == 0.0
    };
    assert!(touching(&cell) && !touching(&without));
}

use std::sync::Arc;

use nalgebra::Point3;

use super::*;
use crate::arms::{self, Stream, other};
use crate::clearance::{
    ArmBody, Bounds, Capsule, Cell, CellState, DemandedClearance, FixedBody, Floor, Mesh, PlacedCell, Role,
    Segment, Shape,
};
use crate::robot::{Attachment, Robot};

const LEAST: f64 = 0.02;

fn rod(name: &str, attachment: Attachment, from: [f64; 3], to: [f64; 3]) -> ArmBody {
    ArmBody {
        name: name.to_owned(),
        attachment,
        attachment_from_body: Isometry::identity(),
        shape: Shape::Capsule(Capsule {
            axis: Segment {
                from: from.into(),
                to: to.into(),
            },
            radius: 0.05,
        }),
        role: Role::Link,
    }
}

fn block(name: &str, from: [f64; 3], to: [f64; 3], is_part: bool) -> FixedBody {
    FixedBody {
        name: name.to_owned(),
        shape: Shape::Box(Bounds::of([Point3::from(from), Point3::from(to)])),
        frame_from_body: Isometry::identity(),
        is_part,
    }
}

/// An arm between two posts with a part; `tail` is always nearer to the forearm than demanded, and touches it in some postures.
fn cell(robot: &Robot) -> Cell {
    let arm = vec![
        rod("upper arm", Attachment::Joint(1), [0.0; 3], [0.0, 0.0, 0.614]),
        rod("forearm", Attachment::Joint(3), [0.2, 0.0, 0.0], [0.6, 0.0, 0.0]),
        rod("tool", Attachment::Flange, [0.0, 0.0, 0.05], [0.0, 0.0, 0.2]),
        rod(
            "tail",
            Attachment::Joint(4),
            [-0.14, 0.0, 0.1],
            [-0.14, 0.0, 0.11],
        ),
    ];
    let still = [
        block("post", [0.5, 0.3, 0.0], [0.6, 0.4, 1.2], false),
        block("beam", [0.4, -0.6, 1.0], [1.4, -0.4, 1.1], false),
        block("part", [-0.2, -0.2, -0.3], [0.2, 0.2, -0.1], true),
    ];
    let none = Isometry::identity();
    Cell::new(robot, &none, arm, &[], &still).for_clearance(robot, &none, LEAST)
}

/// Compares the decisions along `ways` motions of `postures` each with those of measured distances, of which both occur at least `often` times.
fn assert_decided_as_measured(
    cell: &Cell,
    robot: &Robot,
    least: f64,
    [ways, postures]: [u32; 2],
    often: usize,
) {
    let part = Isometry::translation(0.9, 0.1, 0.5);
    let placed = PlacedCell {
        cell,
        base_from_part: &part,
    };
    let demanded = DemandedClearance { placed, least };
    let mut alone = ClearanceCheck::new(demanded, robot, &Isometry::identity());
    let mut along = ClearanceAlong::new(alone.clone());
    let mut stream = Stream(71);
    let (mut kept, mut lost) = (0, 0);
    for way in 0..ways {
        let (from, to) = (stream.joints(robot), stream.joints(robot));
        // From hops to steps of a millimetre.
        let step = [1.0, 0.05, 0.001][way as usize % 3];
        for i in 0..postures {
            let part = step * f64::from(i) / f64::from(postures);
            let q: Vec<f64> = from.iter().zip(&to).map(|(a, b)| a + (b - a) * part).collect();
            let is_kept = alone.conflict(&q).is_none();
            assert_eq!(
                along.is_kept(&q),
                is_kept,
                "least {least}, way {way}, posture {i}"
            );
            *(if is_kept { &mut kept } else { &mut lost }) += 1;
        }
    }
    assert!(kept > often && lost > often, "least {least}: {kept} {lost}");
}

#[test]
fn postures_near_each_other_are_decided_as_one_by_one() {
    let robot = arms::mh12();
    assert_decided_as_measured(&cell(&robot), &robot, LEAST, [60, 120], 1000);
}

#[test]
fn above_a_floor_and_on_a_rail_they_are_too() {
    let robot = other::on_rail(&arms::mh12());
    let arm = vec![
        rod(
            "carriage",
            Attachment::Joint(0),
            [-0.3, 0.0, 0.0],
            [0.3, 0.0, 0.0],
        ),
        rod("upper arm", Attachment::Joint(2), [0.0; 3], [0.0, 0.0, 0.614]),
        ArmBody {
            shape: tessellated(&rod("", Attachment::Base, [0.2, 0.0, 0.0], [0.6, 0.0, 0.0]).shape),
            ..rod("forearm", Attachment::Joint(4), [0.0; 3], [0.0; 3])
        },
    ];
    let still = [
        block("bed", [-20.0, -0.2, -0.3], [20.0, 0.2, 0.1], false),
        block("post", [0.6, 0.3, -0.3], [0.7, 0.4, 1.2], false),
    ];
    let none = Isometry::identity();
    let floor = Floor::below("floor", &Isometry::translation(0.0, 0.0, -0.2), &robot);
    let cell = Cell::new(&robot, &none, arm, &[], &still)
        .with_floor(floor)
        .for_clearance(&robot, &none, LEAST);
    let mut alone = CellState::new(PlacedCell::at_base(&cell), &robot, &none);
    let mut stream = Stream(73);
    let mut nearest_to = std::collections::BTreeSet::new();
    for _ in 0..300 {
        alone.set_joints(&stream.joints(&robot));
        let found = alone.clearance(f64::INFINITY).unwrap();
        nearest_to.insert(cell.name(found.bodies[1]).to_owned());
    }
    assert!(
        ["floor", "post"].iter().all(|name| nearest_to.contains(*name)),
        "{nearest_to:?}"
    );
    for least in [0.0, LEAST] {
        assert_decided_as_measured(&cell, &robot, least, [60, 120], 300);
    }
}

/// The box around a shape, as twelve long triangles.
pub(in crate::clearance) fn tessellated(shape: &Shape) -> Shape {
    let corners = shape.bounds().corners();
    // Corner `k` has the greatest x, y, z where bit 0, 1, 2 of `k` is set.
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = faces.into_iter().flat_map(|[a, b, c, d]| {
        [[a, b, c], [a, c, d]].map(|triangle| triangle.map(|index: usize| corners[index]))
    });
    Shape::Mesh(Arc::new(Mesh::new(triangles.collect(), true).unwrap()))
}

/// The same cell with arm bodies and bodies that stand still of other shapes.
fn cell_of(
    robot: &Robot,
    arm_shape: impl Fn(&Shape) -> Shape,
    still_shape: impl Fn(&Shape) -> Shape,
) -> Cell {
    let rods = cell(robot);
    let arm = rods.arm().iter().map(|body| ArmBody {
        shape: arm_shape(&body.shape),
        ..body.clone()
    });
    let still = [
        block("post", [0.5, 0.3, 0.0], [0.6, 0.4, 1.2], false),
        block("beam", [0.4, -0.6, 1.0], [1.4, -0.4, 1.1], false),
        block("part", [-0.2, -0.2, -0.3], [0.2, 0.2, -0.1], true),
    ]
    .map(|body| FixedBody {
        shape: still_shape(&body.shape),
        ..body
    });
    let none = Isometry::identity();
    Cell::new(robot, &none, arm.collect(), &[], &still).for_clearance(robot, &none, LEAST)
}

#[test]
fn bodies_of_every_shape_are_decided_as_measured() {
    let robot = arms::mh12();
    let boxed = |shape: &Shape| Shape::Box(shape.bounds());
    let cylinder = |shape: &Shape| match shape {
        Shape::Capsule(capsule) => Shape::Cylinder(capsule.axis, capsule.radius),
        other => other.clone(),
    };
    let cells = [
        cell_of(&robot, Shape::clone, tessellated),
        cell_of(&robot, cylinder, tessellated),
        cell_of(&robot, boxed, tessellated),
        cell_of(&robot, tessellated, tessellated),
        cell_of(&robot, tessellated, Shape::clone),
    ];
    for cell in &cells {
        for least in [0.0, LEAST] {
            assert_decided_as_measured(cell, &robot, least, [30, 40], 100);
        }
    }
}

#[test]
fn with_the_part_elsewhere_nothing_is_remembered() {
    let robot = arms::mh12();
    let cell = cell(&robot);
    let far = Isometry::translation(5.0, 0.0, 0.0);
    let demanded = DemandedClearance {
        placed: PlacedCell {
            cell: &cell,
            base_from_part: &far,
        },
        least: LEAST,
    };
    let mut along = ClearanceAlong::new(ClearanceCheck::new(demanded, &robot, &far));
    let q = [0.0; 6];
    assert!(along.is_kept(&q));
    let tool = along.check.state.hulls()[2].axis.middle();
    along.set_part(&Isometry::translation(tool.x, tool.y, tool.z + 0.2));
    assert!(!along.is_kept(&q));
    along.set_part(&far);
    assert!(along.is_kept(&q));
}

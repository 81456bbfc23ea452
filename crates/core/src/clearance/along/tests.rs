use std::sync::Arc;

use nalgebra::Point3;

use super::*;
use crate::arms::{self, Stream};
use crate::clearance::{
    ArmBody, Bounds, Capsule, Cell, DemandedClearance, FixedBody, Mesh, PlacedCell, Role, Segment, Shape,
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

#[test]
fn postures_near_each_other_are_decided_as_one_by_one() {
    let robot = arms::mh12();
    let cell = cell(&robot);
    let part = Isometry::translation(0.9, 0.1, 0.5);
    let demanded = DemandedClearance {
        placed: PlacedCell {
            cell: &cell,
            base_from_part: &part,
        },
        least: LEAST,
    };
    let mut alone = ClearanceCheck::new(demanded, &robot, &Isometry::identity());
    let mut along = ClearanceAlong::new(alone.clone());
    let mut stream = Stream(71);
    let (mut kept, mut lost) = (0, 0);
    for way in 0..60 {
        let (from, to) = (stream.joints(&robot), stream.joints(&robot));
        // From hops to steps of a millimetre.
        let step = [1.0, 0.05, 0.001][way % 3];
        for i in 0..120 {
            let part = step * f64::from(i) / 120.0;
            let q: Vec<f64> = from.iter().zip(&to).map(|(a, b)| a + (b - a) * part).collect();
            let is_kept = alone.conflict(&q).is_none();
            assert_eq!(along.is_kept(&q), is_kept, "way {way}, posture {i}");
            *(if is_kept { &mut kept } else { &mut lost }) += 1;
        }
    }
    assert!(kept > 1000 && lost > 1000, "{kept} {lost}");
}

/// The box around a shape, as twelve long triangles.
fn tessellated(shape: &Shape) -> Shape {
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
    let part = Isometry::translation(0.9, 0.1, 0.5);
    for (index, cell) in cells.iter().enumerate() {
        for least in [0.0, LEAST] {
            let placed = PlacedCell {
                cell,
                base_from_part: &part,
            };
            let demanded = DemandedClearance { placed, least };
            let mut alone = ClearanceCheck::new(demanded, &robot, &Isometry::identity());
            let mut along = ClearanceAlong::new(alone.clone());
            let mut stream = Stream(72);
            let (mut kept, mut lost) = (0, 0);
            for way in 0..30 {
                let (from, to) = (stream.joints(&robot), stream.joints(&robot));
                let step = [1.0, 0.05][way % 2];
                for i in 0..40 {
                    let part = step * f64::from(i) / 40.0;
                    let q: Vec<f64> = from.iter().zip(&to).map(|(a, b)| a + (b - a) * part).collect();
                    let is_kept = alone.conflict(&q).is_none();
                    assert_eq!(along.is_kept(&q), is_kept, "cell {index}, way {way}, posture {i}");
                    *(if is_kept { &mut kept } else { &mut lost }) += 1;
                }
            }
            assert!(kept > 100 && lost > 100, "cell {index}: {kept} {lost}");
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

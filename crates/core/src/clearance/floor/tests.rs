//! Heights above the floor: those above a large box, found without this code; what is checked; riding on an obstacle.

use nalgebra::Point3;

use super::*;
use crate::arms::{self, Stream, other};
use crate::clearance::{
    ArmBody, Bounds, Capsule, Cell, CellState, FixedBody, Mesh, PlacedCell, Role, Segment, Shape,
};

fn body(name: &str, attachment: Attachment, shape: Shape) -> ArmBody {
    ArmBody {
        name: name.to_owned(),
        attachment,
        attachment_from_body: Isometry::identity(),
        shape,
        role: if attachment == Attachment::Flange {
            Role::Holder
        } else {
            Role::Link
        },
    }
}

fn segment(from: [f64; 3], to: [f64; 3]) -> Segment {
    Segment {
        from: from.into(),
        to: to.into(),
    }
}

fn rod(from: [f64; 3], to: [f64; 3], radius: f64) -> Shape {
    Shape::Capsule(Capsule {
        axis: segment(from, to),
        radius,
    })
}

fn tetrahedron(size: f64) -> Shape {
    let [o, x, y, z] = [[0.0; 3], [size, 0.0, 0.0], [0.0, size, 0.0], [0.0, 0.0, size]].map(Point3::from);
    let mesh = Mesh::new(vec![[o, y, x], [o, x, z], [o, z, y], [x, y, z]], true).unwrap();
    Shape::Mesh(std::sync::Arc::new(mesh))
}

/// One body of every shape, from the second link on.
fn bodies() -> Vec<ArmBody> {
    vec![
        body("base", Attachment::Base, rod([0.0; 3], [0.0, 0.0, 0.3], 0.2)),
        body(
            "turret",
            Attachment::Joint(0),
            rod([0.0, 0.0, -0.4], [0.0; 3], 0.2),
        ),
        body(
            "upper arm",
            Attachment::Joint(1),
            rod([0.0; 3], [0.0, 0.0, 0.614], 0.08),
        ),
        body("forearm", Attachment::Joint(3), tetrahedron(0.2)),
        body(
            "motor",
            Attachment::Joint(4),
            Shape::Box(Bounds::of([
                Point3::new(-0.05, -0.1, 0.0),
                Point3::new(0.1, 0.05, 0.2),
            ])),
        ),
        body(
            "spindle",
            Attachment::Flange,
            Shape::Cylinder(segment([0.0, 0.0, 0.02], [0.0, 0.0, 0.3]), 0.06),
        ),
    ]
}

/// A floor that slopes a little, 0.35 m under the base.
fn plane() -> Isometry {
    Isometry::from_parts(
        nalgebra::Translation3::new(0.1, -0.2, -0.35),
        nalgebra::UnitQuaternion::from_euler_angles(0.05, -0.03, 0.7),
    )
}

fn least(cell: &Cell, robot: &Robot, q: &[f64]) -> Option<(f64, String)> {
    let mut state = CellState::new(PlacedCell::at_base(cell), robot, &Isometry::identity());
    state.set_joints(q);
    let found = state.clearance(f64::INFINITY)?;
    let name = cell.name(found.bodies[0]).to_owned();
    Some((found.nearest.distance, name))
}

#[test]
fn heights_above_the_floor_are_distances_from_a_large_box() {
    let robot = arms::mh12();
    let box_below = FixedBody {
        name: "box".to_owned(),
        shape: Shape::Box(Bounds::of([
            Point3::new(-20.0, -20.0, -20.0),
            Point3::new(20.0, 20.0, 0.0),
        ])),
        frame_from_body: plane(),
        is_part: false,
    };
    let checked: Vec<ArmBody> = bodies().into_iter().skip(2).collect();
    let all_apart: Vec<[usize; 2]> = (0..6).flat_map(|a| (0..a).map(move |b| [b, a])).collect();
    let boxed = Cell::new(&robot, &Isometry::identity(), checked, &all_apart, &[box_below]);
    let floored = Cell::new(&robot, &Isometry::identity(), bodies(), &all_apart, &[])
        .with_floor(Floor::below("floor", &plane(), &robot));
    assert_eq!(floored.name(bodies().len()), "floor");
    let mut stream = Stream(71);
    let mut touching = 0;
    for _ in 0..2_000 {
        let q = stream.joints(&robot);
        let (expected, found) = (
            least(&boxed, &robot, &q).unwrap(),
            least(&floored, &robot, &q).unwrap(),
        );
        touching += usize::from(found.0 == 0.0);
        // GJK of boxes and cylinders of some metres: see `convex`.
        assert!(
            (found.0 - expected.0).abs() < 1e-6,
            "{q:?}: {found:?}, {expected:?}"
        );
        assert!(found.0 == 0.0 || found.1 == expected.1);
    }
    assert!(touching > 100 && touching < 1_900, "{touching}");
}

#[test]
fn base_and_first_link_are_not_checked_against_the_floor() {
    let robot = arms::mh12();
    // The turret reaches below the floor in every posture.
    let two: Vec<ArmBody> = bodies().into_iter().take(2).collect();
    let at_base = Floor::below("floor", &Isometry::translation(0.0, 0.0, 0.1), &robot);
    let cell = Cell::new(&robot, &Isometry::identity(), two, &[], &[]).with_floor(at_base);
    assert_eq!(least(&cell, &robot, &[0.0; 6]), None);
    assert_eq!(cell.always_on_floor(&robot, &Isometry::identity()), []);
}

#[test]
fn a_floor_around_a_link_is_found() {
    let robot = arms::mh12();
    let high = Floor::below("floor", &Isometry::translation(0.0, 0.0, 3.0), &robot);
    let cell = Cell::new(&robot, &Isometry::identity(), bodies(), &[], &[]).with_floor(high);
    assert_eq!(cell.always_on_floor(&robot, &Isometry::identity()), [2, 3, 4, 5]);
}

#[test]
fn a_carriage_may_ride_on_its_bed_and_is_checked_against_what_stands_next_to_it() {
    let robot = other::on_rail(&arms::mh12());
    let carriage = body(
        "carriage",
        Attachment::Joint(0),
        rod([-0.3, 0.0, 0.0], [0.3, 0.0, 0.0], 0.2),
    );
    let upper_arm = body(
        "upper arm",
        Attachment::Joint(2),
        rod([0.0; 3], [0.0, 0.0, 0.614], 0.08),
    );
    let block = |name: &str, from: [f64; 3], to: [f64; 3]| FixedBody {
        name: name.to_owned(),
        shape: Shape::Box(Bounds::of([from.into(), to.into()])),
        frame_from_body: Isometry::identity(),
        is_part: false,
    };
    let still = [
        block("bed", [-20.0, -20.0, -1.0], [20.0, 20.0, -0.1]),
        block("post", [0.9, -20.0, -1.0], [1.0, 20.0, 0.0]),
    ];
    let tool = Isometry::identity();
    let cell = Cell::new(&robot, &tool, vec![carriage, upper_arm], &[], &still);
    assert!(cell.permanent_obstacles(&robot, &tool).is_empty());
    let mut state = CellState::new(PlacedCell::at_base(&cell), &robot, &tool);
    state.set_joints(&[0.0; 7]);
    let found = state.clearance(f64::INFINITY).unwrap();
    assert_eq!(found.bodies.map(|body| cell.name(body)), ["carriage", "post"]);
    assert!((found.nearest.distance - 0.4).abs() < 1e-12, "{found:?}");
}

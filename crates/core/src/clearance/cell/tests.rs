use nalgebra::Point3;

use super::*;
use crate::arms::{self, Stream};
use crate::clearance::along::tests::tessellated;
use crate::clearance::demanded::{ClearanceCheck, DemandedClearance};
use crate::clearance::nearest::Segment;
use crate::clearance::state::CellState;
use crate::robot::Robot;

fn capsule(from: [f64; 3], to: [f64; 3], radius: f64) -> Shape {
    Shape::Capsule(Capsule {
        axis: Segment {
            from: from.into(),
            to: to.into(),
        },
        radius,
    })
}

fn link(name: &str, attachment: Attachment, shape: Shape) -> ArmBody {
    ArmBody {
        name: name.to_owned(),
        attachment,
        attachment_from_body: Isometry::identity(),
        shape,
        role: Role::Link,
    }
}

/// The MH12 with slim capsules from axis to axis, a spindle and a cutter.
fn bodies() -> Vec<ArmBody> {
    let tool = |name: &str, role: Role, to: f64, from: f64, radius: f64| ArmBody {
        name: name.to_owned(),
        attachment: Attachment::Flange,
        attachment_from_body: Isometry::identity(),
        shape: Shape::Cylinder(
            Segment {
                from: Point3::new(0.0, 0.0, from),
                to: Point3::new(0.0, 0.0, to),
            },
            radius,
        ),
        role,
    };
    vec![
        link(
            "base",
            Attachment::Base,
            capsule([0.0, 0.0, 0.1], [0.0, 0.0, 0.2], 0.1),
        ),
        link(
            "upper arm",
            Attachment::Joint(1),
            capsule([0.0; 3], [0.0, 0.0, 0.614], 0.08),
        ),
        link(
            "forearm",
            Attachment::Joint(3),
            capsule([0.2, 0.0, 0.0], [0.5, 0.0, 0.0], 0.06),
        ),
        tool("spindle", Role::Holder, 0.2, 0.02, 0.06),
        tool("cutter", Role::Cutter, 0.28, 0.2, 0.005),
    ]
}

fn block(name: &str, from: [f64; 3], to: [f64; 3], is_part: bool) -> FixedBody {
    FixedBody {
        name: name.to_owned(),
        shape: Shape::Box(Bounds::of([from.into(), to.into()])),
        frame_from_body: Isometry::identity(),
        is_part,
    }
}

fn flange_from_tool() -> Isometry {
    Isometry::translation(0.0, 0.0, 0.28)
}

fn still() -> [FixedBody; 3] {
    [
        block("floor", [-2.0, -2.0, -0.1], [2.0, 2.0, 0.0], false),
        block("fence", [-2.0, 0.8, 0.0], [2.0, 0.9, 2.0], false),
        block("part", [0.6, -0.3, 0.0], [1.2, 0.3, 0.6], true),
    ]
}

fn cell(robot: &Robot) -> Cell {
    Cell::new(robot, &flange_from_tool(), bodies(), &[], &still())
}

/// All pairs of bodies by hand, without bounds.
fn least_of_all(cell: &Cell, robot: &Robot, q: &[f64]) -> (f64, [String; 2]) {
    let mut state = CellState::new(PlacedCell::at_base(cell), robot, &flange_from_tool());
    state.set_joints(q);
    let mut best = (f64::INFINITY, [String::new(), String::new()]);
    let mut take = |distance: f64, names: [&str; 2]| {
        if distance < best.0 {
            best = (distance, names.map(str::to_owned));
        }
    };
    for pair in &cell.pairs {
        let found = state.nearest_of_arm(*pair, f64::INFINITY).unwrap();
        take(found.distance, pair.map(|index| cell.name(index)));
    }
    for (index, body) in cell.arm().iter().enumerate() {
        for fixed in still() {
            let checked =
                body.attachment != Attachment::Base && !(fixed.is_part && body.role == Role::Cutter);
            if checked {
                let other = fixed.shape.placed(&matrix(&fixed.frame_from_body));
                let found = state.placed(index).nearest(&other, f64::INFINITY).unwrap();
                take(found.distance, [&body.name, &fixed.name]);
            }
        }
    }
    best
}

#[test]
fn the_least_of_all_pairs_is_found_with_its_names() {
    let robot = arms::mh12();
    let cell = cell(&robot);
    let mut state = CellState::new(PlacedCell::at_base(&cell), &robot, &flange_from_tool());
    let mut stream = Stream(51);
    let mut collisions = 0;
    for _ in 0..2_000 {
        let q = stream.joints(&robot);
        state.set_joints(&q);
        let (distance, names) = least_of_all(&cell, &robot, &q);
        let found = state.clearance(f64::INFINITY).unwrap();
        assert!((found.nearest.distance - distance).abs() < 1e-12);
        if distance > 0.0 {
            assert_eq!(found.bodies.map(|index| cell.name(index).to_owned()), names);
        } else {
            collisions += 1;
        }
        for least in [0.0, 0.01, 0.1] {
            let demanded = DemandedClearance {
                placed: PlacedCell::at_base(&cell),
                least,
            };
            let conflict = ClearanceCheck::new(demanded, &robot, &flange_from_tool()).conflict(&q);
            assert_eq!(conflict.is_none(), distance > 0.0 && distance >= least);
            if let Some(conflict) = conflict {
                assert!((conflict.missing - (least - distance)).abs() < 1e-12);
            }
        }
        // A limit below the distance finds nothing.
        if distance > 0.0 {
            assert!(state.clearance(0.99 * distance).is_none());
        }
    }
    assert!((200..1_900).contains(&collisions), "{collisions}");
}

#[test]
fn the_distance_by_hand_of_a_stretched_arm() {
    // At zero the spindle points along x at the height of the wrist: 450 + 614 + 200 mm; the
    // flange is 155 + 640 + 100 mm out, the end of the cutter 280 mm more.
    let robot = arms::mh12();
    let wall = block("wall", [1.3, -1.0, 0.0], [1.4, 1.0, 2.0], false);
    let cell = Cell::new(&robot, &flange_from_tool(), bodies().split_off(1), &[], &[wall]);
    let mut state = CellState::new(PlacedCell::at_base(&cell), &robot, &flange_from_tool());
    let found = state.clearance(f64::INFINITY).unwrap();
    assert_eq!(found.bodies.map(|index| cell.name(index)), ["cutter", "wall"]);
    assert!((found.nearest.distance - (1.3 - 1.175)).abs() < 1e-9, "{found:?}");
}

#[test]
fn the_cutter_may_touch_the_part_and_the_holder_may_not() {
    let robot = arms::mh12();
    // 1.10 m out the cutter is inside of the part, the end of the spindle (1.095 m) is 5 mm away from it.
    let part = block("part", [1.1, -0.2, 1.0], [1.4, 0.2, 1.5], true);
    let cell = Cell::new(&robot, &flange_from_tool(), bodies(), &[], &[part]);
    let mut state = CellState::new(PlacedCell::at_base(&cell), &robot, &flange_from_tool());
    let found = state.clearance(f64::INFINITY).unwrap();
    assert_eq!(found.bodies.map(|index| cell.name(index)), ["spindle", "part"]);
    assert!((found.nearest.distance - 0.005).abs() < 1e-9);
    // The same part 20 mm nearer.
    state.set_part(&Isometry::translation(-0.02, 0.0, 0.0));
    assert_eq!(state.clearance(f64::INFINITY).unwrap().nearest.distance, 0.0);
}

#[test]
fn bodies_in_contact_in_every_posture_are_not_checked() {
    let robot = arms::mh12();
    // Around the wrist both reach over the axes of B and T.
    let mut all = bodies();
    all.push(link(
        "wrist",
        Attachment::Joint(5),
        capsule([-0.1, 0.0, 0.0], [0.05, 0.0, 0.0], 0.05),
    ));
    all[2] = link(
        "forearm",
        Attachment::Joint(3),
        capsule([0.2, 0.0, 0.0], [0.64, 0.0, 0.0], 0.06),
    );
    let cell = Cell::new(&robot, &flange_from_tool(), all.clone(), &[], &[]);
    let names: Vec<_> = cell
        .always_in_contact()
        .iter()
        .map(|pair| pair.map(|index| cell.name(index)))
        .collect();
    assert_eq!(names, [["forearm", "wrist"]]);
    let apart = Cell::new(&robot, &flange_from_tool(), all, &[[1, 3], [5, 2]], &[]);
    assert!(apart.always_in_contact().is_empty());
    assert!(!apart.pairs.contains(&[1, 3]) && !apart.pairs.contains(&[2, 5]));
}

#[test]
fn bodies_that_never_keep_the_clearance_only_must_not_touch() {
    let robot = arms::mh12();
    // A plate on the flange, 20 mm in front of a ball around the axis of B: as near in every posture, within the turn of T.
    let mut near = bodies().split_off(1);
    near.push(link(
        "wrist",
        Attachment::Joint(4),
        capsule([0.02, 0.0, 0.0], [0.02, 0.0, 0.0], 0.06),
    ));
    let cell = Cell::new(&robot, &flange_from_tool(), near, &[], &[]);
    let cell = cell.for_clearance(&robot, &flange_from_tool(), 0.05);
    let names: Vec<_> = (cell.always_near().iter())
        .map(|pair| pair.map(|index| cell.name(index)))
        .collect();
    assert_eq!(names, [["spindle", "wrist"]]);
    let demanded = DemandedClearance {
        placed: PlacedCell::at_base(&cell),
        least: 0.05,
    };
    let mut check = ClearanceCheck::new(demanded, &robot, &flange_from_tool());
    let mut state = CellState::new(PlacedCell::at_base(&cell), &robot, &flange_from_tool());
    // The true distance is reported, and is no conflict: 100 mm + 20 mm from axis to spindle, less 80 mm.
    let found = state.clearance(f64::INFINITY).unwrap();
    assert!((found.nearest.distance - 0.04).abs() < 1e-9, "{found:?}");
    assert_eq!(check.conflict(&[0.0; 6]), None);
    // Bent by 120 deg the spindle is at the forearm.
    let bent = [0.0, 0.0, 0.0, 0.0, 2.1, 0.0];
    assert!(check.conflict(&bent).is_some());
}

#[test]
fn links_next_to_each_other_are_not_checked() {
    let robot = arms::mh12();
    let near = vec![
        link(
            "shoulder",
            Attachment::Joint(0),
            capsule([0.0; 3], [0.1, 0.0, 0.0], 0.2),
        ),
        link(
            "upper arm",
            Attachment::Joint(1),
            capsule([0.0; 3], [0.0, 0.0, 0.3], 0.2),
        ),
    ];
    let cell = Cell::new(&robot, &flange_from_tool(), near, &[], &[]);
    assert!(
        CellState::new(PlacedCell::at_base(&cell), &robot, &flange_from_tool())
            .clearance(f64::INFINITY)
            .is_none()
    );
}

#[test]
fn a_box_and_its_mesh_give_the_same_clearance() {
    let robot = arms::mh12();
    let bounds = Bounds::of([Point3::new(0.5, 0.2, 0.0), Point3::new(0.9, 0.5, 1.4)]);
    let of = |shape: Shape| {
        let post = FixedBody {
            name: "post".to_owned(),
            shape,
            frame_from_body: Isometry::translation(0.1, 0.0, 0.0),
            is_part: false,
        };
        Cell::new(&robot, &flange_from_tool(), bodies(), &[], &[post])
    };
    let shape = Shape::Box(bounds);
    let cells = [of(shape.clone()), of(tessellated(&shape))];
    let mut states = cells
        .each_ref()
        .map(|cell| CellState::new(PlacedCell::at_base(cell), &robot, &flange_from_tool()));
    let mut stream = Stream(52);
    for _ in 0..1_000 {
        let q = stream.joints(&robot);
        let [one, other] = states.each_mut().map(|state| {
            state.set_joints(&q);
            state.clearance(f64::INFINITY).unwrap().nearest.distance
        });
        assert!((one - other).abs() < 1e-9, "{one} {other}");
    }
}

use std::sync::Arc;

use nalgebra::{Isometry3, UnitQuaternion};

use super::*;
use crate::arms::Stream;
use crate::clearance::{Mesh, Segment};

const MM: f64 = 1e-3;

/// A block of 40 mm by 30 mm by 20 mm below z = 0, in cells of a millimetre.
fn block() -> Stock {
    let corners = [Point3::new(-20.0, -15.0, -20.0), Point3::new(20.0, 15.0, 0.0)];
    Stock::new(corners.map(|corner| corner * MM), MM).unwrap()
}

fn cutter_mm(diameter: f64, corner: f64) -> EndMillBody {
    EndMillBody::new(diameter * MM, corner * MM).unwrap()
}

/// The block with a slot along y, 10 mm wide and 6 mm deep, whose walls are at x = -5 mm and x = 5 mm.
fn slotted() -> RemainingStock {
    let mut remaining = RemainingStock::new(block());
    let step = [[0.0, -30.0, -6.0], [0.0, 30.0, -6.0]].map(|at| Point3::from(at) * MM);
    remaining.remove(step, &cutter_mm(10.0, 0.0));
    remaining
}

/// A cylinder of this diameter about z at (x, 0), from `z` on; mm.
fn holder(diameter: f64, [x, z]: [f64; 2]) -> BodyNearStock {
    let axis = Segment {
        from: Point3::new(x, 0.0, z) * MM,
        to: Point3::new(x, 0.0, z + 50.0) * MM,
    };
    let shape = Shape::Cylinder(axis, diameter / 2.0 * MM);
    BodyNearStock::new(&shape, &IsometryMatrix3::identity())
}

fn distance_mm(remaining: &RemainingStock, body: &BodyNearStock) -> f64 {
    let found = remaining.nearest(body, f64::INFINITY, None);
    found.map_or(f64::INFINITY, |found| found.nearest.distance / MM)
}

#[test]
fn distances_of_a_holder_over_a_slot_are_those_of_plane_geometry() {
    let remaining = slotted();
    // Tolerance: heights are single precision, 20 mm to 1e-6 mm.
    let check = |diameter: f64, at: [f64; 2], expected: f64| {
        let found = distance_mm(&remaining, &holder(diameter, at));
        assert!(
            (found - expected).abs() < 2e-6,
            "{diameter} {at:?}: {found} {expected}"
        );
    };
    // Wider than the slot: above its banks. A cutter that is 8 mm long in a slot 6 mm deep leaves 2 mm.
    check(16.0, [0.0, -6.0 + 8.0], 2.0);
    // Narrower, in the slot: from the nearer wall, and from the floor.
    check(6.0, [0.5, -4.0], 1.5);
    check(6.0, [0.0, -5.5], 0.5);
    // Narrower, above the slot: from the edge of the wall, (5 - 3) mm across and 1.5 mm above.
    check(6.0, [0.0, 1.5], 2.5);
    // Wider than the slot and in it: contact.
    check(16.0, [0.0, -1.0], 0.0);
}

#[test]
fn a_stock_that_is_cut_through_is_no_longer_in_the_way() {
    let mut remaining = slotted();
    let through = [[0.0, -30.0, -20.0], [0.0, 30.0, -20.0]].map(|at| Point3::from(at) * MM);
    remaining.remove(through, &cutter_mm(10.0, 0.0));
    assert!((distance_mm(&remaining, &holder(6.0, [0.0, -19.0])) - 2.0).abs() < 2e-6);
    let wider = [[0.0, 0.0, -20.0]; 2].map(|at| Point3::from(at) * MM);
    remaining.remove(wider, &cutter_mm(100.0, 0.0));
    assert!(distance_mm(&remaining, &holder(6.0, [0.0, -19.0])).is_infinite());
}

/// The surface of a tetrahedron that leans, normals outwards.
fn wedge() -> Vec<[Point3<f64>; 3]> {
    let corners = [
        [-4.0, -3.0, -6.0],
        [4.0, -2.0, -5.0],
        [0.0, 5.0, -6.0],
        [2.0, 1.0, 12.0],
    ];
    let at = |index: usize| Point3::from(corners[index]) * MM;
    [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
        .map(|face| face.map(at))
        .to_vec()
}

/// The least distance of all columns, m.
fn of_all_columns(remaining: &RemainingStock, body: &BodyNearStock) -> f64 {
    let [columns, rows] = remaining.stock.cells();
    let mut least = f64::INFINITY;
    for at in (0..rows).flat_map(|y| (0..columns).map(move |x| [x, y])) {
        if let Some(column) = remaining.bounds(0, at) {
            let column = Shape::Box(column).placed(&IsometryMatrix3::identity());
            let found = body.placed.nearest(&column, f64::INFINITY).unwrap();
            least = least.min(found.distance);
        }
    }
    least
}

#[test]
fn the_nearest_column_is_that_of_all_columns_for_bodies_of_every_shape() {
    let axis = Segment {
        from: Point3::new(0.0, 0.0, -6.0) * MM,
        to: Point3::new(1.0, 0.0, 9.0) * MM,
    };
    let capsule = Capsule {
        axis,
        radius: 3.0 * MM,
    };
    let corners = [[-4.0, -2.0, -6.0], [3.0, 5.0, 9.0]].map(|corner| Point3::from(corner) * MM);
    let shapes = [
        Shape::Capsule(capsule),
        Shape::Cylinder(axis, 4.0 * MM),
        Shape::Box(Bounds::of(corners)),
        Shape::Mesh(Arc::new(Mesh::new(wedge(), true).unwrap())),
    ];
    let mut stream = Stream(77);
    let mut remaining = RemainingStock::new(block());
    let (mut apart, mut touching) = (0, 0);
    for round in 0..40 {
        let mut place = |z: [f64; 2]| {
            let [x, y, part] = [(); 3].map(|()| stream.next());
            Point3::new(40.0 * x - 20.0, 30.0 * y - 15.0, z[0] + (z[1] - z[0]) * part) * MM
        };
        let step = [place([-18.0, 2.0]), place([-18.0, 2.0])];
        let at = place([-12.0, 25.0]);
        remaining.remove(step, &cutter_mm(6.0, [0.0, 1.0, 3.0][round % 3]));
        let turn = [(); 3].map(|()| 6.0 * stream.next());
        let turn = UnitQuaternion::from_euler_angles(turn[0], turn[1], turn[2]);
        let frame = nalgebra::convert(Isometry3::from_parts(at.coords.into(), turn));
        for shape in &shapes {
            let body = BodyNearStock::new(shape, &frame);
            let all = of_all_columns(&remaining, &body);
            // Also from a column that is far away.
            for likely in [None, Some([0, 0])] {
                let found = remaining.nearest(&body, f64::INFINITY, likely);
                let found = found.map_or(f64::INFINITY, |found| found.nearest.distance);
                assert!((found - all).abs() <= ROUNDING, "{shape:?}: {found:e} {all:e}");
            }
            // Columns nearer than demanded: those of all columns decide, from any first column.
            let beyond = if all.is_finite() { all } else { MM };
            for least in [
                0.0,
                0.5 * beyond,
                beyond * (1.0 - 1e-9),
                beyond * (1.0 + 1e-9),
                2.0 * beyond,
            ] {
                for likely in [None, Some([0, 0]), Some([20, 15])] {
                    let found = remaining.conflict(&body, least, likely);
                    let is_expected = all < least || all == 0.0;
                    assert_eq!(found.is_some(), is_expected, "{shape:?}: {least:e} {all:e}");
                }
            }
            let none = remaining.nearest(&body, all, None);
            assert!(none.is_none_or(|found| found.nearest.distance >= all - ROUNDING));
            (apart, touching) = match all > 0.0 {
                true => (apart + 1, touching),
                false => (apart, touching + 1),
            };
        }
    }
    assert!(apart > 50 && touching > 20, "{apart} {touching}");
}

#[test]
fn the_pyramid_of_a_cut_stock_is_that_of_a_new_one_of_the_same_heights() {
    let mut remaining = RemainingStock::new(block());
    let mut stream = Stream(5);
    for _ in 0..30 {
        let step = [(); 2].map(|()| {
            let [x, y, z] = [(); 3].map(|()| stream.next());
            Point3::new(50.0 * x - 25.0, 40.0 * y - 20.0, -15.0 * z) * MM
        });
        remaining.remove(step, &cutter_mm(4.0, 1.0));
        let again = RemainingStock::new(remaining.stock.clone());
        for (level, again) in remaining.levels.iter().zip(&again.levels) {
            assert_eq!(level.greatest, again.greatest);
        }
    }
    // 40 by 30 cells, 10 by 8, 3 by 2 and 1 by 1 squares.
    let squares: Vec<[usize; 2]> = remaining.levels.iter().map(|level| level.squares).collect();
    assert_eq!(squares, [[10, 8], [3, 2], [1, 1]]);
}

//! Stock: boxes, cylinders and meshes.

use std::f64::consts::{PI, TAU};

use armill_core::clearance::Triangle;
use armill_core::nalgebra::{Point3, Vector3};
use armill_core::removal::{DexelDirections, DexelPart, EndOrigin, RemovalError, StockSolid};

use super::{MM, at, cut, end_mill, moves};

/// Two triangles of each face of a box, corners in any order.
fn box_of_triangles(low: Point3<f64>, high: Point3<f64>) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    for axis in 0..3 {
        for end in [low[axis], high[axis]] {
            let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
            let corner = |a: f64, b: f64| {
                let mut corner = Point3::origin();
                (corner[axis], corner[i], corner[j]) = (end, a, b);
                corner
            };
            let [a, b, c, d] = [
                corner(low[i], low[j]),
                corner(high[i], low[j]),
                corner(high[i], high[j]),
                corner(low[i], high[j]),
            ];
            triangles.extend([Triangle([a, b, c]), Triangle([a, c, d])]);
        }
    }
    triangles
}

/// A ball of triangles between circles of latitude.
fn ball(centre: Point3<f64>, radius: f64, rows: u32) -> Vec<Triangle> {
    let point = |row: u32, column: u32| {
        let (tilt, turn) = (
            PI * f64::from(row) / f64::from(rows),
            TAU * f64::from(column % (2 * rows)) / f64::from(2 * rows),
        );
        // The poles are one point each.
        let across = if row == 0 || row == rows { 0.0 } else { tilt.sin() };
        centre + Vector3::new(across * turn.cos(), across * turn.sin(), tilt.cos()) * radius
    };
    let mut triangles = Vec::new();
    for row in 0..rows {
        for column in 0..2 * rows {
            let [a, b, c, d] = [
                point(row, column),
                point(row + 1, column),
                point(row + 1, column + 1),
                point(row, column + 1),
            ];
            triangles.extend([Triangle([a, b, c]), Triangle([a, c, d])]);
        }
    }
    triangles
}

#[test]
fn a_cylinder_has_its_volume_in_all_directions_and_its_normals() {
    let stock = StockSolid::Cylinder {
        base: at(1.0, 2.0, 3.0),
        radius: 10.0 * MM,
        height: 15.0 * MM,
    };
    let part = DexelPart::new(&stock, 0.1 * MM, DexelDirections::All).unwrap();
    for grid in part.grids() {
        let volume = grid.volume() / MM.powi(3);
        assert!(
            (volume / (PI * 100.0 * 15.0) - 1.0).abs() < 1e-3,
            "{} {volume}",
            grid.direction()
        );
    }
    for point in part.surface() {
        let EndOrigin::Stock(face) = point.origin else {
            unreachable!("nothing was cut");
        };
        let normal = stock.normal(face, &point.position).unwrap();
        let off = point.position / MM - Vector3::new(1.0, 2.0, 3.0);
        let expected = match point.direction {
            2 => Vector3::z() * if point.begins { -1.0 } else { 1.0 },
            _ => Vector3::new(off.x, off.y, 0.0) / 10.0,
        };
        assert!((normal.into_inner() - expected).norm() < 1e-6, "{point:?}");
    }
}

#[test]
fn a_mesh_of_a_box_is_the_box() {
    let corners = [at(-3.0, 1.0, 0.5), at(17.0, 21.0, 9.5)];
    let triangles = box_of_triangles(corners[0], corners[1]);
    let stocks = [StockSolid::Box(corners), StockSolid::Mesh(&triangles)];
    let parts = stocks.map(|stock| {
        let part = DexelPart::new(&stock, 0.5 * MM, DexelDirections::All).unwrap();
        let path = moves(&[at(0.0, 0.0, 5.0), at(20.0, 20.0, 5.0)], Vector3::z_axis());
        cut(part, &path, &end_mill(6.0, 3.0, 20.0)).0
    });
    let [one, other] = parts.map(|part| {
        let positions: Vec<(Point3<f64>, bool)> = part
            .surface()
            .map(|point| (point.position, point.begins))
            .collect();
        positions
    });
    assert_eq!(one, other);
    // The triangle of an end has the direction of the dexel as its normal, inwards or outwards.
    let part = DexelPart::new(&stocks[1], 0.5 * MM, DexelDirections::All).unwrap();
    for point in part.surface() {
        let EndOrigin::Stock(face) = point.origin else {
            unreachable!("nothing was cut");
        };
        let normal = stocks[1].normal(face, &point.position).unwrap();
        assert!((normal[point.direction].abs() - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_ball_of_triangles_has_its_volume() {
    let triangles = ball(at(5.0, 5.0, 5.0), 8.0 * MM, 60);
    let part = DexelPart::new(&StockSolid::Mesh(&triangles), 0.1 * MM, DexelDirections::All).unwrap();
    // The volume enclosed by the triangles: a sixth of the triple products.
    let enclosed: f64 = triangles
        .iter()
        .map(|triangle| {
            let [a, b, c] = triangle.0.map(|corner| corner - at(5.0, 5.0, 5.0));
            a.dot(&b.cross(&c)) / 6.0
        })
        .sum();
    for grid in part.grids() {
        assert!(
            (grid.volume() / enclosed - 1.0).abs() < 1e-4,
            "{}",
            grid.volume() / enclosed
        );
    }
}

#[test]
fn a_hollow_body_has_material_on_both_sides_of_its_cavity() {
    let mut triangles = box_of_triangles(at(0.0, 0.0, 0.0), at(10.0, 10.0, 10.0));
    triangles.extend(box_of_triangles(at(3.0, 3.0, 4.0), at(7.0, 7.0, 6.0)));
    let part = DexelPart::new(&StockSolid::Mesh(&triangles), 0.5 * MM, DexelDirections::All).unwrap();
    let spans: Vec<[f64; 2]> = part.grids()[2].material([10, 10]).map(|span| span.ends).collect();
    let expected = [[0.0, 4.0], [6.0, 10.0]];
    for (span, expected) in spans.iter().zip(&expected) {
        assert!((span[0] / MM - expected[0]).abs() < 1e-6 && (span[1] / MM - expected[1]).abs() < 1e-6);
    }
    assert_eq!(spans.len(), 2);
    assert!((part.volume() / MM.powi(3) - 968.0).abs() < 1e-3);
}

#[test]
fn an_open_mesh_is_refused_with_a_place() {
    let mut triangles = box_of_triangles(at(0.0, 0.0, 0.0), at(10.0, 10.0, 10.0));
    // A face across z loses one of its triangles: half of the dexels along z cross one triangle.
    let lost = triangles
        .iter()
        .position(|triangle| triangle.0.iter().all(|corner| corner.z == 0.0))
        .unwrap();
    triangles.remove(lost);
    let error = DexelPart::new(&StockSolid::Mesh(&triangles), 1.0 * MM, DexelDirections::All).unwrap_err();
    let RemovalError::OpenMesh { lines, axis, .. } = error else {
        unreachable!("{error}");
    };
    assert!(axis == 'z' && (45..=55).contains(&lines), "{lines} along {axis}");
    assert!(error.to_string().contains("close its holes"), "{error}");
    let empty = DexelPart::new(&StockSolid::Mesh(&[]), 1.0 * MM, DexelDirections::All).unwrap_err();
    assert_eq!(empty, RemovalError::NoTriangles);
}

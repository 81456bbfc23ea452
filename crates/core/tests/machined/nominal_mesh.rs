//! A nominal part that is given as triangles: material that a tool cannot reach, and a pocket that is too deep.

use armill_core::clearance::Triangle;
use armill_core::frame::Isometry;
use armill_core::machined::{
    CutBy, MachiningPath, MadePart, PartComparison, SearchReach, material_difference,
};
use armill_core::nalgebra::Point3;
use armill_core::removal::StockSolid;
use armill_core::watch::Watch;

use crate::{CELL, MM, at, block, end_mill, everywhere, track};

/// A quadrilateral as two triangles.
fn quad(corners: [[f64; 3]; 4]) -> [Triangle; 2] {
    let [a, b, c, d]: [Point3<f64>; 4] = corners.map(|[x, y, z]| at(x, y, z));
    [Triangle([a, b, c]), Triangle([a, c, d])]
}

/// A step: the block of 60 x 40 x 10 mm without the corner x < 30, y < 20 above z = -4: faces of it and of the block.
fn stepped() -> Vec<Triangle> {
    let mut faces = Vec::new();
    // Bottom, and the side walls around; all seen from outside counter-clockwise.
    faces.extend(quad([
        [0., 0., -10.],
        [0., 40., -10.],
        [60., 40., -10.],
        [60., 0., -10.],
    ]));
    faces.extend(quad([
        [60., 0., -10.],
        [60., 40., -10.],
        [60., 40., 0.],
        [60., 0., 0.],
    ]));
    faces.extend(quad([
        [60., 40., -10.],
        [0., 40., -10.],
        [0., 40., 0.],
        [60., 40., 0.],
    ]));
    faces.extend(quad([
        [0., 40., -10.],
        [0., 0., -10.],
        [0., 0., -4.],
        [0., 40., -4.],
    ]));
    faces.extend(quad([
        [0., 40., -4.],
        [0., 20., -4.],
        [0., 20., 0.],
        [0., 40., 0.],
    ]));
    faces.extend(quad([
        [0., 0., -10.],
        [60., 0., -10.],
        [60., 0., -4.],
        [0., 0., -4.],
    ]));
    faces.extend(quad([
        [30., 0., -4.],
        [60., 0., -4.],
        [60., 0., 0.],
        [30., 0., 0.],
    ]));
    // The step: floor, and its walls at x = 30 and y = 20.
    faces.extend(quad([
        [0., 0., -4.],
        [30., 0., -4.],
        [30., 20., -4.],
        [0., 20., -4.],
    ]));
    faces.extend(quad([
        [30., 20., -4.],
        [30., 0., -4.],
        [30., 0., 0.],
        [30., 20., 0.],
    ]));
    faces.extend(quad([
        [0., 20., -4.],
        [30., 20., -4.],
        [30., 20., 0.],
        [0., 20., 0.],
    ]));
    // The top in two pieces.
    faces.extend(quad([
        [30., 0., 0.],
        [60., 0., 0.],
        [60., 20., 0.],
        [30., 20., 0.],
    ]));
    faces.extend(quad([
        [0., 20., 0.],
        [60., 20., 0.],
        [60., 40., 0.],
        [0., 40., 0.],
    ]));
    faces
}

#[test]
fn rest_material_in_a_corner_and_a_floor_that_is_too_deep() {
    let places: Vec<[f64; 3]> = (0..5)
        .flat_map(|row| {
            let y = -1.0 + 4.0 * f64::from(row);
            [[-10.0, y, -4.0], [25.0, y, -4.0]]
        })
        .chain([[25.0, -1.0, -4.0]])
        .collect();
    let track = track(Isometry::identity(), &places);
    let stock = block([0.0, 0.0, -10.0], [60.0, 40.0, 0.0]);
    let tools = [end_mill(10.0, 0.0)];
    let path = MachiningPath {
        track: &track,
        tools: &tools,
        turn_tolerance: 1e-7,
    };
    let deep = 0.05;
    let stages = path.stages(Some(&everywhere(&track, [0.0, 0.0, -deep], [0.0; 3])));
    let (part, _) = path.cut(stock.clone(), &stages, Watch::NONE).unwrap();
    let triangles = stepped();
    let nominal = stock.on_same_raster(&StockSolid::Mesh(&triangles), CELL).unwrap();
    let reach = SearchReach {
        most: 5.0 * MM,
        cell: CELL,
    };
    let made = MadePart {
        dexels: &part,
        stock: StockSolid::Box(stock.corners()),
        cut_by: Some(CutBy {
            stages: &stages,
            tools: &tools,
            turn_tolerance: 1e-7,
        }),
    };
    let wanted = MadePart {
        dexels: &nominal,
        stock: StockSolid::Mesh(&triangles),
        cut_by: None,
    };
    let found = PartComparison::new(made, wanted, reach)
        .surface(Watch::NONE)
        .unwrap();
    let (mut floor, mut corner) = (0, 0);
    for point in &found.points {
        let [x, y, z] = [point.position.x, point.position.y, point.position.z].map(|m| m / MM);
        let e = point.deviation / MM;
        // Floor away from the corner: too deep.
        if point.normal.z > 0.9 && z < -1.0 && x < 24.0 && y < 14.0 {
            floor += 1;
            assert!((e + deep).abs() < 2e-5, "{point:?}");
        }
        // Wall at x = 30, near the corner (30, 20), nearer to the rounding of the tool about (25, 15) than to the top.
        if point.normal.x < -0.9 && (15.2..19.8).contains(&y) && (-3.9..-2.3).contains(&z) {
            corner += 1;
            let left = ((y - 15.0).powi(2) + 25.0_f64).sqrt() - 5.0;
            assert!((e - left).abs() < 0.06, "{point:?}: {left}");
        }
        // What nothing has cut is where it should be.
        if point.normal.z > 0.9 && z > -0.1 {
            assert!(e.abs() < 1e-9, "{point:?}");
        }
    }
    assert!(floor > 1000 && corner > 20, "{floor} {corner}");
    let difference = material_difference(&part, &nominal);
    let in_corner = 4.0 * 25.0 * (1.0 - std::f64::consts::FRAC_PI_4);
    // The rounding stays above the floor, as high as the step.
    assert!(
        (difference.left / MM.powi(3) / in_corner - 1.0).abs() < 0.05,
        "{} mm3 of {in_corner}",
        difference.left / MM.powi(3)
    );
    assert!(difference.gouged > 0.0);
}

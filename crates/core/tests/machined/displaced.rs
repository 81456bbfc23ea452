//! A displaced tool: the surface is that of the tool, displaced by the same.

use armill_core::frame::Isometry;
use armill_core::machined::{SurfaceDeviation, material_difference, worst_places};
use armill_core::nalgebra::{Translation3, UnitQuaternion, Vector3};

use crate::{MM, at, block, end_mill, everywhere, surface, track};

/// Points that are farther than a cell from the ends and edges of the slot below.
fn inside(point: &&SurfaceDeviation) -> bool {
    let [x, y, z] = [point.position.x, point.position.y, point.position.z].map(|m| m / MM);
    let is_wall = point.normal.z.abs() < 0.5;
    x > 11.0
        && x < 69.0
        && if is_wall {
            z > -1.4 && z < -0.6
        } else {
            y.abs() < 4.4
        }
}

#[test]
fn floor_and_walls_of_a_slot_are_off_by_the_displacement_along_their_normals() {
    let track = track(Isometry::identity(), &[[5.0, 0.0, -2.0], [75.0, 0.0, -2.0]]);
    let stock = block([0.0, -20.0, -10.0], [80.0, 20.0, 0.0]);
    let deviations = everywhere(&track, [0.04, 0.05, 0.03], [0.0; 3]);
    let found = surface(&track, end_mill(10.0, 0.0), &stock, &deviations);
    let (mut floor, mut left, mut right) = (0, 0, 0);
    for point in found.points.iter().filter(inside) {
        let expected = if point.normal.z > 0.9 {
            floor += 1;
            0.03
        } else if point.normal.y < -0.9 {
            left += 1;
            -0.05
        } else {
            right += 1;
            0.05
        };
        assert!(
            (point.deviation - expected * MM).abs() < 2e-8,
            "{point:?}: {expected} mm"
        );
    }
    assert!(
        floor > 1000 && left > 100 && right > 100,
        "{floor} {left} {right}"
    );
    // Areas: floor 70 x 10 and the ends of the tool, walls 2 x 70 x 2 and its round ends.
    let area: f64 = found.points.iter().map(|point| point.area).sum::<f64>() / MM.powi(2);
    let round = std::f64::consts::PI;
    let expected = 700.0 + 25.0 * round + 2.0 * 140.0 + 2.0 * 10.0 * round;
    assert!((area / expected - 1.0).abs() < 0.01, "{area} mm2 of {expected}");
    assert!(found.missing_area < 1e-3 * area * MM.powi(2));
}

#[test]
fn a_strip_of_the_floor_next_to_a_displaced_wall_is_no_farther_off_than_the_wall() {
    let track = track(Isometry::identity(), &[[5.0, 0.0, -4.0], [75.0, 0.0, -4.0]]);
    let stock = block([0.0, -20.0, -10.0], [80.0, 20.0, 0.0]);
    // More than a cell: dexels along z through the floor end in the wall that is left, 4 mm above.
    let deviations = everywhere(&track, [0.0, 0.7, 0.0], [0.0; 3]);
    let found = surface(&track, end_mill(10.0, 0.0), &stock, &deviations);
    let largest = found.points.iter().map(|point| point.deviation.abs());
    let largest = largest.fold(0.0, f64::max) / MM;
    assert!((0.69..0.95).contains(&largest), "{largest} mm");
}

#[test]
fn a_ball_nose_leaves_its_displacement_along_every_normal_of_its_groove() {
    let base_from_path = Isometry::from_parts(
        Translation3::new(1.2, -0.3, 0.8),
        UnitQuaternion::from_euler_angles(0.4, -0.7, 2.0),
    );
    let track = track(base_from_path, &[[5.0, 0.0, -4.0], [75.0, 0.0, -4.0]]);
    let stock = block([0.0, -20.0, -10.0], [80.0, 20.0, 0.0]);
    let by = Vector3::new(0.003, -0.005, 0.002);
    let in_base = base_from_path.rotation * by;
    let deviations = everywhere(&track, in_base.into(), [0.0; 3]);
    let found = surface(&track, end_mill(10.0, 5.0), &stock, &deviations);
    let mut number = 0;
    for point in &found.points {
        let [x, y, z] = [point.position.x, point.position.y, point.position.z].map(|m| m / MM);
        if !(11.0..69.0).contains(&x) || z > -0.5 || y.abs() > 4.4 {
            continue;
        }
        number += 1;
        // Closed form of the normal: towards the axis of the groove.
        let normal = Vector3::new(0.0, -y, 1.0 - z).normalize();
        assert!((point.normal.into_inner() - normal).norm() < 1e-3, "{point:?}");
        let expected = by.dot(&normal);
        // e^2 tan^2(54.7 deg) / (2 R) of the comparison along a dexel.
        assert!(
            (point.deviation / MM - expected).abs() < 2.0 * 3.8e-5 / 10.0 + 2e-5,
            "{point:?}: {expected} mm"
        );
    }
    assert!(number > 1500, "{number}");
}

#[test]
fn a_rotated_tool_leans_the_walls_and_a_growing_displacement_tilts_the_floor() {
    let track = track(Isometry::identity(), &[[5.0, 0.0, -5.0], [75.0, 0.0, -5.0]]);
    let stock = block([0.0, -20.0, -10.0], [80.0, 20.0, 0.0]);
    // About x: at the height h above the tip the tool is displaced by -omega h along y.
    let omega = 2e-3;
    let mut deviations = everywhere(&track, [0.0; 3], [omega, 0.0, 0.0]);
    for (deviation, point) in deviations.iter_mut().zip(&track.path.points) {
        deviation.as_mut().unwrap().twist.linear.z = 1e-3 * (point.at.x - 5.0 * MM);
    }
    let found = surface(&track, end_mill(10.0, 0.0), &stock, &deviations);
    let mut walls = 0;
    for point in &found.points {
        let [x, y, z] = [point.position.x, point.position.y, point.position.z].map(|m| m / MM);
        if !(11.0..69.0).contains(&x) {
            continue;
        }
        let sagged = 1e-3 * (x - 5.0);
        if point.normal.y.abs() > 0.9 && (-4.5..-0.5).contains(&z) {
            walls += 1;
            let expected = -omega * (z + 5.0 - sagged) * point.normal.y;
            assert!(
                (point.deviation / MM - expected).abs() < 5e-5,
                "{point:?}: {expected}"
            );
        }
        // The end face leans as well, and the lowest of it passes where the displacement was least: behind the tool.
        if point.normal.z > 0.9 && y.abs() < 4.5 {
            let behind = x - (25.0 - y * y).sqrt();
            let expected = 1e-3 * (behind - 5.0) + omega * y;
            assert!(
                (point.deviation / MM - expected).abs() < 5e-5,
                "{point:?}: {expected}"
            );
        }
    }
    assert!(walls > 500, "{walls}");
}

#[test]
fn a_drilled_hole_is_beside_its_place() {
    let track = track(Isometry::identity(), &[[20.0, 20.0, 5.0], [20.0, 20.0, -12.0]]);
    let stock = block([0.0, 0.0, -10.0], [40.0, 40.0, 0.0]);
    let deviations = everywhere(&track, [0.06, -0.08, 0.0], [0.0; 3]);
    let mut tool = end_mill(8.0, 0.0);
    tool.cutting = armill_core::removal::ToolSolid::drill(8.0 * MM, 118_f64.to_radians(), 40.0 * MM).unwrap();
    let found = surface(&track, tool, &stock, &deviations);
    // The point of the drill ends 2 mm below: the cone through its shoulder is 2.4 mm high.
    let wall = found.points.iter().filter(|point| point.normal.z.abs() < 0.1);
    let centre = at(20.06, 19.92, 0.0);
    let mut number = 0;
    for point in wall {
        number += 1;
        let radius = (point.on_part.xy() - centre.xy()).norm() / MM;
        assert!((radius - 4.0).abs() < 2e-5, "{radius} mm");
        let expected = 0.06 * point.normal.x - 0.08 * point.normal.y;
        assert!((point.deviation / MM - expected).abs() < 0.01 / 4.0, "{point:?}");
    }
    assert!(number > 500, "{number}");
    let worst = worst_places(&found.points, 2, 3.0 * MM);
    assert_eq!(worst.len(), 2);
    let largest = found.points[worst[0]];
    assert!((largest.deviation.abs() / MM - 0.1).abs() < 2e-3, "{largest:?}");
}

#[test]
fn points_without_a_known_deviation_are_cut_as_programmed_and_volumes_are_those_of_the_difference() {
    let track = track(Isometry::identity(), &[[5.0, 0.0, -2.0], [75.0, 0.0, -2.0]]);
    let stock = block([0.0, -20.0, -10.0], [80.0, 20.0, 0.0]);
    let unknown = vec![None; track.len()];
    let found = surface(&track, end_mill(10.0, 0.0), &stock, &unknown);
    assert!(found.points.iter().all(|point| point.deviation == 0.0));

    let tools = [end_mill(10.0, 0.0)];
    let path = armill_core::machined::MachiningPath {
        track: &track,
        tools: &tools,
        turn_tolerance: 1e-7,
    };
    let cut = |deviations: &[_]| {
        let stages = path.stages(Some(deviations));
        path.cut(stock.clone(), &stages, armill_core::watch::Watch::NONE)
            .unwrap()
            .0
    };
    let deep = cut(&everywhere(&track, [0.0, 0.0, -0.1], [0.0; 3]));
    let difference = material_difference(&deep, &cut(&unknown));
    let gouged = 0.1 * (700.0 + 25.0 * std::f64::consts::PI);
    assert!((difference.gouged / MM.powi(3) / gouged - 1.0).abs() < 0.01);
    assert_eq!(difference.left, 0.0);
    let back = material_difference(&cut(&unknown), &deep);
    assert_eq!([back.left, back.gouged], [difference.gouged, difference.left]);
}

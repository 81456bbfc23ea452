//! Tilted tools and axes that turn.

use armill_core::load::EndMillBody;
use armill_core::nalgebra::{Point3, Rotation3, Unit, Vector3};
use armill_core::removal::{DexelDirections, EndOrigin, RotatingTool, ToolMove, ToolSolid};
use armill_core::watch::Watch;

use super::{MM, at, block, cut, end_mill, moves};

#[test]
fn a_cut_with_a_tilted_tool_is_the_same_cut_in_a_turned_frame() {
    let body = EndMillBody::new(10.0 * MM, 2.0 * MM).unwrap();
    let tool = ToolSolid::tapered(&body, 0.1, 60.0 * MM).unwrap();
    let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), 0.5)
        * Rotation3::from_axis_angle(&Vector3::x_axis(), 0.2);
    let axis = Unit::new_normalize(turn * Vector3::z());
    // In the frame of the tool the path is level: along its x.
    let along = turn * Vector3::x();
    let (middle, tip) = (at(15.0, 15.0, 12.0), 40.0 * MM);
    let part = block([30.0, 30.0, 20.0], 0.2, DexelDirections::All);
    let path = moves(&[middle - along * tip, middle + along * tip], axis);
    let (part, removals) = cut(part, &path, &tool);
    assert!(removals[0].volume > 0.0);
    let mut seen = [0; 3];
    for point in part.surface().filter(|point| point.origin == EndOrigin::Move(0)) {
        let own = turn.inverse() * (point.position - middle) / MM;
        let (off, h) = (own.y.abs(), own.z);
        // The profile of the upright tool: floor, corner, flank.
        let (sin, cos) = 0.1_f64.sin_cos();
        let distance = if h < 2.0 * (1.0 - sin) {
            if off < 3.0 {
                h
            } else {
                2.0 - (off - 3.0).hypot(h - 2.0)
            }
        } else {
            (3.0 + 2.0 * cos + (h - 2.0 * (1.0 - sin)) * 0.1_f64.tan() - off) * cos
        };
        assert!(distance.abs() < 2e-5, "{own:?}: {distance}");
        seen[point.direction] += 1;
    }
    assert!(seen.iter().all(|count| *count > 1000), "{seen:?}");
}

/// The tool at an angle around a cone about the z axis at (30, 30) mm, with its flank on the cone: half angle 20 deg, radius 20 mm at z = 0.
fn around_cone(turn: f64, radius: f64) -> (Point3<f64>, Unit<Vector3<f64>>) {
    let (sin, cos) = 20_f64.to_radians().sin_cos();
    let about = Rotation3::from_axis_angle(&Vector3::z_axis(), turn);
    let flank = Vector3::new(-sin, 0.0, cos);
    let normal = Vector3::new(cos, 0.0, sin);
    // 3 mm below the lower face of the block along the flank, so that the bottom of the tool is out of it.
    let tip = Vector3::new(20.0, 0.0, 0.0) + normal * radius - flank * 3.0;
    (
        at(30.0, 30.0, 0.0) + about * tip * MM,
        Unit::new_normalize(about * flank),
    )
}

#[test]
fn swarf_milling_of_a_cone_is_within_the_stated_bound() {
    let (radius, step) = (5.0, 2.0_f64);
    let tool = end_mill(2.0 * radius, 0.0, 30.0);
    let path: Vec<ToolMove> = (0..180)
        .map(|n| {
            let [from, to] = [n, n + 1].map(|n| around_cone((f64::from(n) * step).to_radians(), radius));
            ToolMove {
                ends: [from.0, to.0],
                axes: [from.1, to.1],
                index: n as u32,
                is_rapid: false,
            }
        })
        .collect();
    for tolerance in [0.05, 0.01] {
        let pieces: usize = path
            .iter()
            .map(|motion| motion.pieces(&tool, tolerance * MM))
            .sum();
        let cutting = RotatingTool {
            cutting: &tool,
            clear: &[],
        };
        let part = block([60.0, 60.0, 15.0], 0.5, DexelDirections::All);
        let (part, _) = part.cut(&path, &cutting, tolerance * MM, Watch::NONE).unwrap();
        // The tip goes along chords of a circle of at most 26 mm, of 2 deg: 26 (1 - cos 1 deg) = 4 um; the axis on great circles instead of
        // the cone: 30 mm sin 20 deg cos 20 deg (2 deg)^2 / 8 = 1.5 um.
        let bound = tolerance + 0.004 + 0.0015;
        let (mut worst, mut seen) = (0.0_f64, 0);
        for point in part.surface() {
            let place = (point.position - at(30.0, 30.0, 0.0)) / MM;
            let rho = place.xy().norm();
            let distance = (rho - 20.0 + place.z * 20_f64.to_radians().tan()) * 20_f64.to_radians().cos();
            // The other side of the groove is 10 mm away.
            if matches!(point.origin, EndOrigin::Move(_)) && distance < radius {
                worst = worst.max(distance.abs());
                seen += 1;
            }
        }
        assert!(
            seen > 10_000 && worst <= bound,
            "{tolerance} mm, {pieces} pieces: {worst} mm"
        );
    }
}

#[test]
fn a_turn_about_the_tip_ends_within_the_tolerance_of_its_last_axis() {
    let tool = end_mill(6.0, 0.0, 30.0);
    let axis = |turn: f64| Unit::new_normalize(Vector3::new(turn.sin(), 0.0, turn.cos()));
    let (tip, last) = (at(30.0, 10.0, 5.0), 30_f64.to_radians());
    let motion = ToolMove {
        ends: [tip; 2],
        axes: [axis(-last), axis(last)],
        index: 0,
        is_rapid: false,
    };
    let cutting = RotatingTool {
        cutting: &tool,
        clear: &[],
    };
    for tolerance in [0.2, 0.02] {
        let part = block([60.0, 20.0, 40.0], 0.25, DexelDirections::All);
        let (part, _) = part
            .cut(&[motion], &cutting, tolerance * MM, Watch::NONE)
            .unwrap();
        let (mut worst, mut seen) = (0.0_f64, 0);
        for point in part.surface().filter(|point| point.origin == EndOrigin::Move(0)) {
            let off = (point.position - tip) / MM;
            let (sin, cos) = last.sin_cos();
            // In the frame of the tool at its end: in front of the flank.
            let (out, h) = (off.x * cos - off.z * sin, off.x * sin + off.z * cos);
            let distance = out.hypot(off.y) - 3.0;
            if out > 1.0 && h > 3.0 && h < 27.0 {
                worst = worst.max(distance.abs());
                seen += 1;
            }
        }
        // The bound is used up to a part: a step is half a turn of a piece away from the end.
        assert!(
            seen > 1000 && worst <= tolerance && worst > 0.3 * tolerance,
            "{tolerance}: {worst}"
        );
    }
}

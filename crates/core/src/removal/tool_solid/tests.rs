use std::f64::consts::PI;

use super::*;

const MM: f64 = 1e-3;

#[test]
fn an_end_mill_has_the_radius_of_its_body_at_every_height() {
    for (diameter, corner) in [(10.0, 0.0), (10.0, 5.0), (16.0, 2.5)] {
        let body = EndMillBody::new(diameter * MM, corner * MM).unwrap();
        let solid = ToolSolid::end_mill(&body, 30.0 * MM).unwrap();
        for k in 0..=60 {
            let height = 0.5 * MM * f64::from(k);
            let radius = solid.radius_at(height).unwrap();
            // The root at the tip doubles the digits that are lost.
            assert!(
                (radius - body.radius_at(height)).abs() < 1e-9,
                "{diameter} {corner} {height}"
            );
        }
        assert_eq!((solid.radius_at(-1e-9), solid.radius_at(30.1 * MM)), (None, None));
        assert_eq!(solid.heights(), [0.0, 30.0 * MM]);
        assert!((solid.radius() - 0.5 * diameter * MM).abs() < 1e-17);
    }
}

#[test]
fn a_tapered_flank_touches_its_corner() {
    let angle = 10_f64.to_radians();
    let body = EndMillBody::new(8.0 * MM, 3.0 * MM).unwrap();
    let solid = ToolSolid::tapered(&body, angle, 40.0 * MM).unwrap();
    // The corner ends at 80 deg from its lowest point: 3 (1 - sin 10 deg) above the tip.
    let begins = 3.0 * MM * (1.0 - angle.sin());
    let radius = 1.0 * MM + 3.0 * MM * angle.cos();
    assert!((solid.radius_at(begins).unwrap() - radius).abs() < 1e-12);
    let slope = |at: f64| {
        let step = 1e-7;
        (solid.radius_at(at + step).unwrap() - solid.radius_at(at - step).unwrap()) / (2.0 * step)
    };
    // Both sides of the joint have the slope of the flank, to a step over the corner radius.
    for at in [begins - 2e-7, begins + 2e-7] {
        assert!((slope(at) - angle.tan()).abs() < 1e-3, "{at}");
    }
    let end = radius + (40.0 * MM - begins) * angle.tan();
    assert!((solid.radius() - end).abs() < 1e-15);
}

#[test]
fn the_point_of_a_drill_of_118_deg_is_as_high_as_its_angle_demands() {
    let drill = ToolSolid::drill(10.0 * MM, 118_f64.to_radians(), 60.0 * MM).unwrap();
    let point = 5.0 * MM / 59_f64.to_radians().tan();
    assert!((drill.radius_at(0.5 * point).unwrap() - 2.5 * MM).abs() < 1e-15);
    assert_eq!(drill.radius_at(point + 1e-9), Some(5.0 * MM));
    // A point of 180 deg is flat.
    let flat = ToolSolid::drill(10.0 * MM, PI, 60.0 * MM).unwrap();
    assert_eq!((flat.bands().len(), flat.radius_at(0.0)), (1, Some(5.0 * MM)));
}

#[test]
fn the_radius_is_concave_in_the_height() {
    let body = EndMillBody::new(8.0 * MM, 3.0 * MM).unwrap();
    let solids = [
        ToolSolid::tapered(&body, 0.3, 30.0 * MM).unwrap(),
        ToolSolid::end_mill(&body, 30.0 * MM).unwrap(),
        ToolSolid::drill(8.0 * MM, 2.0, 30.0 * MM).unwrap(),
    ];
    for solid in solids {
        for k in 1..299 {
            let at = |k: i32| solid.radius_at(0.1 * MM * f64::from(k)).unwrap();
            assert!(2.0 * at(k) - at(k - 1) - at(k + 1) > -1e-15, "{k}");
        }
    }
}

#[test]
fn the_extent_is_that_of_sampled_points() {
    let axis = Unit::new_normalize(Vector3::new(0.3, -0.2, 0.9));
    let direction = Vector3::new(0.6, 0.0, -0.8);
    let solid = ToolSolid::cone([0.0, 30.0 * MM], [2.0 * MM, 4.0 * MM]).unwrap();
    let across = axis.cross(&Vector3::x()).normalize();
    let other = axis.cross(&across);
    let mut sampled = [f64::INFINITY, f64::NEG_INFINITY];
    for k in 0..=300 {
        let height = 0.1 * MM * f64::from(k);
        let radius = solid.radius_at(height.min(30.0 * MM)).unwrap();
        for turn in 0..360 {
            let (sin, cos) = f64::from(turn).to_radians().sin_cos();
            let point = axis.into_inner() * height + (across * cos + other * sin) * radius;
            let along = point.dot(&direction);
            sampled = [sampled[0].min(along), sampled[1].max(along)];
        }
    }
    let extent = solid.extent(&axis, &direction);
    // Half a degree of a circle of 4 mm: 0.15 um.
    assert!((extent[0] - sampled[0]).abs() < 1e-6 && (extent[1] - sampled[1]).abs() < 1e-6);
    assert!(extent[0] <= sampled[0] && extent[1] >= sampled[1]);
}

#[test]
fn invalid_tools_are_refused() {
    let body = EndMillBody::new(10.0 * MM, 5.0 * MM).unwrap();
    for length in [0.0, 5.0 * MM, f64::NAN, f64::INFINITY, 11.0] {
        assert!(ToolSolid::end_mill(&body, length).is_err(), "{length}");
    }
    for angle in [-0.1, 1.5, f64::NAN] {
        assert!(ToolSolid::tapered(&body, angle, 0.03).is_err(), "{angle}");
    }
    assert!(ToolSolid::drill(0.01, 0.1, 0.1).is_err() && ToolSolid::drill(0.01, 2.0, 1e-4).is_err());
    for (heights, radii) in [
        ([0.1, 0.1], [0.01, 0.01]),
        ([-0.1, 0.1], [0.01, 0.01]),
        ([0.0, 0.1], [-0.01, 0.01]),
        ([0.0, 0.1], [0.01, f64::NAN]),
        ([0.0, f64::INFINITY], [0.01, 0.01]),
    ] {
        assert!(ToolSolid::cone(heights, radii).is_err(), "{heights:?} {radii:?}");
    }
    let error = ToolSolid::end_mill(&body, 5.0 * MM).unwrap_err().to_string();
    assert_eq!(
        error,
        "length of the cutting part is 5 mm: must be between 5.001 mm and 10000 mm"
    );
}

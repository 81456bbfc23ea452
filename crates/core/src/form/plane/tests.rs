use nalgebra::Rotation3;

use super::*;
use crate::arms::Stream;

/// The points of the witness: a wavy plane, turned and shifted.
fn wavy() -> Vec<Point3<f64>> {
    let turn = Rotation3::new(Vector3::new(0.3, -0.2, 1.1));
    let mut points = Vec::new();
    for a in 0..13 {
        for c in 0..9 {
            let (a, c) = (f64::from(a), f64::from(c));
            let z = 20e-6 * (1.3 * a + 0.4 * c * c).sin() + 8e-6 * (2.1 * c).cos();
            points.push(
                Point3::new(1.0, 2.0, -0.5) + turn * Vector3::new(0.02 * (a - 6.0), 0.015 * (c - 4.0), z),
            );
        }
    }
    points
}

/// Witness: numpy for LSPL; for the minimum zone scipy linprog, and Nelder and Mead over the tilt from 20 starts.
#[test]
fn flatness_is_that_of_another_program() {
    let found = flatness(&wavy()).unwrap();
    assert!(
        (found.least_squares.flatness - 5.273_712_382_113_191e-5).abs() < 2e-15,
        "{found:?}"
    );
    assert!(
        (found.minimum_zone - 5.169_638_971_903_851e-5).abs() < 2e-15,
        "{found:?}"
    );
    // All points are in the zone about its middle.
    let off = wavy()
        .iter()
        .map(|p| (p - found.zone_middle).dot(&found.zone_normal).abs())
        .fold(0.0, f64::max);
    assert!((2.0 * off - found.minimum_zone).abs() < 1e-15);
}

/// A saddle of height h at the corners of a square is 2 h wide: no tilt lowers two corners without raising the others.
#[test]
fn a_saddle_is_as_wide_as_its_corners_are_apart() {
    let saddle = |k: i32| {
        let (x, y) = (f64::from(k % 21 - 10) / 10.0, f64::from(k / 21 - 10) / 10.0);
        Point3::new(x, y, 1e-5 * x * y)
    };
    let found = flatness(&(0..441).map(saddle).collect::<Vec<_>>()).unwrap();
    assert!((found.minimum_zone - 2e-5).abs() < 1e-15, "{found:?}");
}

#[test]
fn rigid_motion_and_scale_do_not_change_flatness_and_the_zone_is_never_wider_than_lspl() {
    for seed in 0..30 {
        let mut stream = Stream(seed);
        let flat: Vec<Point3<f64>> = (0..50)
            .map(|_| {
                Point3::new(
                    stream.between(-1.0, 1.0),
                    stream.between(-0.5, 0.5),
                    1e-4 * stream.normal(),
                )
            })
            .collect();
        let here = flatness(&flat).unwrap();
        assert!(here.minimum_zone <= here.least_squares.flatness);
        let turn = Rotation3::new(stream.vector(2.0));
        let moved: Vec<Point3<f64>> = flat
            .iter()
            .map(|p| Point3::from(turn * p.coords * 0.1 + Vector3::new(1.0, -2.0, 3.0)))
            .collect();
        let there = flatness(&moved).unwrap();
        // Coordinates of 3 m are rounded to 4e-16 m.
        assert!(
            (there.minimum_zone - 0.1 * here.minimum_zone).abs() < 3e-15,
            "{seed}"
        );
        assert!(
            (there.least_squares.flatness - 0.1 * here.least_squares.flatness).abs() < 3e-15,
            "{seed}"
        );
    }
}

#[test]
fn orientation_zones_are_those_of_a_tilted_plane() {
    // 1 mrad over 0.2 m is 0.2 mm; perpendicular to the datum x-z it is seen edge on.
    let points: Vec<Point3<f64>> = (0..21)
        .flat_map(|i| {
            (0..5).map(move |j| {
                let (x, y) = (0.01 * f64::from(i), 0.01 * f64::from(j));
                Point3::new(x, y, 1e-3 * x + if i == 10 { 4e-6 } else { 0.0 })
            })
        })
        .collect();
    let z = Vector3::z_axis();
    assert!((parallelism(&points, &z).unwrap() - 0.2e-3).abs() < 1e-15);
    // Across y: the section x-z is a line with one row 4 um high.
    let width = perpendicularity(&points, &Vector3::y_axis()).unwrap();
    assert!((width - 4e-6).abs() < 1e-11, "{width}");
}

#[test]
fn departure_has_the_offset_and_the_tilt_of_the_plane() {
    let turn = Rotation3::new(Vector3::new(2e-3, -1e-3, 0.0));
    let points: Vec<Point3<f64>> = (0..25)
        .map(|k| {
            let (x, y) = (f64::from(k % 5 - 2), f64::from(k / 5 - 2));
            Point3::new(0.0, 0.0, 5e-6) + turn * Vector3::new(x, y, 0.0)
        })
        .collect();
    let plane = least_squares_plane(&points).unwrap();
    for (normal, sign) in [(Vector3::z_axis(), 1.0), (-Vector3::z_axis(), -1.0)] {
        let found = departure(&plane, &Point3::origin(), &normal);
        assert!((found.offset - sign * 5e-6).abs() < 1e-15);
        assert!(
            (found.tilt - Vector3::new(2e-3, -1e-3, 0.0)).norm() < 1e-12,
            "{}",
            found.tilt
        );
    }
}

#[test]
fn points_without_a_plane_are_refused() {
    let line: Vec<Point3<f64>> = (0..5).map(|i| Point3::new(f64::from(i), 0.0, 0.0)).collect();
    assert_eq!(flatness(&line), Err(FormError::Undetermined));
    assert_eq!(
        flatness(&line[..2]),
        Err(FormError::TooFew { needed: 3, given: 2 })
    );
    let far = [Point3::origin(), Point3::new(0.0, 1e7, 0.0), Point3::origin()];
    assert_eq!(flatness(&far), Err(FormError::NotFinite { index: 1 }));
    assert_eq!(
        parallelism(&[], &Vector3::z_axis()),
        Err(FormError::TooFew { needed: 1, given: 0 })
    );
}

use nalgebra::Rotation3;

use super::*;
use crate::arms::Stream;

const NOMINAL: f64 = 0.025;

/// Points of a cylinder with waves over the angle `phi`, the height `z` and the number of the point.
fn points(
    turn: &Rotation3<f64>,
    at: Vector3<f64>,
    mut radius: impl FnMut(i32, i32) -> f64,
) -> Vec<Point3<f64>> {
    let mut points = Vec::new();
    for a in 0..12 {
        for k in 0..36 {
            let phi = f64::from(10 * k + 3 * a).to_radians();
            let (r, z) = (radius(a, k), 0.005 * (f64::from(a) - 5.5));
            points.push(Point3::from(
                at + turn * Vector3::new(r * phi.cos(), r * phi.sin(), z),
            ));
        }
    }
    points
}

/// The cylinder of the witness.
fn wavy() -> Vec<Point3<f64>> {
    let turn = Rotation3::new(Vector3::new(0.02, 0.015, 0.4));
    points(&turn, Vector3::new(0.3, -0.2, 0.1), |a, k| {
        let phi = f64::from(10 * k + 3 * a).to_radians();
        let z = 0.005 * (f64::from(a) - 5.5);
        let by_point = (1.7 * f64::from(a) + 0.9 * f64::from(k * k)).sin();
        NOMINAL + 6e-6 * (3.0 * phi + 0.5).cos() + 4e-6 * (2.0 * phi + 40.0 * z).sin() + 3e-6 * by_point
    })
}

fn nominal() -> Cylinder {
    Cylinder {
        at: Point3::new(0.3, -0.2, 0.1),
        axis: Vector3::z_axis(),
        radius: NOMINAL,
    }
}

/// Witness: scipy.optimize.least_squares; for the others linear programs (scipy linprog) with numerical derivatives from 12
/// starts.
#[test]
fn all_four_cylinders_are_those_of_another_program() {
    let found = cylinder_form(&wavy(), &nominal()).unwrap();
    assert!(
        (found.least_squares.radius - 0.025_000_038_585_162_032).abs() < 1e-12,
        "{found:?}"
    );
    // The witness ends its steps at 1e-15 of the sum of squares: the axis is known to 1e-10 m.
    assert!(
        (found.peak_to_valley - 2.502_411_115_484_423_6e-5).abs() < 1e-10,
        "{found:?}"
    );
    assert!(
        (found.cylindricity - 2.306_297_431_821_022_2e-5).abs() < 1e-13,
        "{found:?}"
    );
    assert!(
        (found.inscribed.unwrap().radius - 0.024_990_399_764_074_2).abs() < 1e-13,
        "{found:?}"
    );
    assert!(
        (found.circumscribed.unwrap().radius - 0.025_009_628_513_017_676).abs() < 1e-13,
        "{found:?}"
    );
    let segment = AxisSegment {
        from: Point3::new(0.3, -0.2, 0.07),
        to: Point3::new(0.3, -0.2, 0.13),
    };
    let position = found.least_squares.position(&segment).unwrap();
    assert!(
        (position - 0.001_490_654_655_905_508_6).abs() < 1e-9,
        "{position}"
    );
}

/// n lobes of height h: the least-squares cylinder is the nominal one, the zone 2 h wide, inscribed R - h, circumscribed R + h.
#[test]
fn lobes_have_their_closed_form() {
    for lobes in [3, 4, 6, 9] {
        let turn = Rotation3::new(Vector3::new(0.01, -0.02, 0.0));
        let lobed = points(&turn, nominal().at.coords, |a, k| {
            // In steps of 10 deg, turned by 3 deg from slice to slice: the crests are at all heights only without the turn.
            let phi = f64::from(10 * k + 3 * a).to_radians();
            NOMINAL + 5e-6 * (f64::from(lobes) * (phi - f64::from(3 * a).to_radians())).cos()
        });
        let found = cylinder_form(&lobed, &nominal()).unwrap();
        // The second order of a shift by h is h^2/R = 1e-9 m; the least-squares radius is off by a quarter of it.
        assert!(
            (found.least_squares.radius - NOMINAL).abs() < 1e-9,
            "{lobes}: {found:?}"
        );
        let direction = found.least_squares.axis.cross(&(turn * Vector3::z())).norm();
        assert!(direction < 1e-5, "{lobes}: {direction}");
        // The valleys of odd lobes are between points: as deep as their nearest point.
        let phases = (0..36).map(|k| (f64::from(lobes * 10 * k)).to_radians().cos());
        let deepest = phases.fold(1.0, f64::min);
        let width = 5e-6 * (1.0 - deepest);
        assert!((found.cylindricity - width).abs() < 2e-9, "{lobes}: {found:?}");
        let [inner, outer] = [
            found.inscribed.unwrap().radius,
            found.circumscribed.unwrap().radius,
        ];
        assert!(
            (inner - NOMINAL - 5e-6 * deepest).abs() < 2e-9,
            "{lobes}: {inner}"
        );
        assert!((outer - NOMINAL - 5e-6).abs() < 2e-9, "{lobes}: {outer}");
    }
}

#[test]
fn sizes_are_in_order_and_motion_does_not_change_them() {
    for seed in 0..6 {
        let mut stream = Stream(seed);
        let noisy = points(&Rotation3::identity(), nominal().at.coords, |_, _| {
            NOMINAL + 2e-6 * stream.normal()
        });
        let here = cylinder_form(&noisy, &nominal()).unwrap();
        let [inner, outer] = [here.inscribed.unwrap().radius, here.circumscribed.unwrap().radius];
        assert!(inner <= here.least_squares.radius && here.least_squares.radius <= outer);
        assert!(here.cylindricity <= here.peak_to_valley);
        assert!(inner >= here.minimum_zone.radius - 0.5 * here.cylindricity - 1e-15);
        assert!(outer <= here.minimum_zone.radius + 0.5 * here.cylindricity + 1e-15);
        let turn = Rotation3::new(stream.vector(2.0));
        let moved: Vec<Point3<f64>> = noisy.iter().map(|p| turn * p).collect();
        let start = Cylinder {
            at: turn * nominal().at,
            axis: UnitVector3::new_normalize(turn * Vector3::new(1e-3, -1e-3, 1.0)),
            radius: 0.9 * NOMINAL,
        };
        let there = cylinder_form(&moved, &start).unwrap();
        for (here, there) in [
            (here.least_squares.radius, there.least_squares.radius),
            (here.cylindricity, there.cylindricity),
            (inner, there.inscribed.unwrap().radius),
            (outer, there.circumscribed.unwrap().radius),
        ] {
            assert!((here - there).abs() < 1e-12, "{seed}: {here} {there}");
        }
    }
}

#[test]
fn half_a_cylinder_has_a_zone_but_no_enclosed_cylinder() {
    let half: Vec<Point3<f64>> = wavy().into_iter().filter(|p| p.y > -0.195).collect();
    let found = cylinder_form(&half, &nominal()).unwrap();
    assert_eq!((found.inscribed, found.circumscribed), (None, None));
    assert!((found.least_squares.radius - NOMINAL).abs() < 20e-6 && found.cylindricity < 30e-6);
}

#[test]
fn points_without_a_cylinder_are_refused() {
    let all = wavy();
    assert_eq!(
        cylinder_form(&all[..4], &nominal()),
        Err(FormError::TooFew { needed: 5, given: 4 })
    );
    assert_eq!(
        cylinder_form(&[all[0]; 9], &nominal()),
        Err(FormError::Undetermined)
    );
    let mut bad = all;
    bad[7].x = f64::INFINITY;
    assert_eq!(
        cylinder_form(&bad, &nominal()),
        Err(FormError::NotFinite { index: 7 })
    );
    let crosswise = AxisSegment {
        from: Point3::origin(),
        to: Point3::new(1.0, 0.0, 0.0),
    };
    assert_eq!(nominal().position(&crosswise), None);
}

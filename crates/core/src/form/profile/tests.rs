use super::*;

fn on_plane(deviation: impl Fn(f64, f64) -> f64) -> Vec<NormalDeviation> {
    let point = |k: i32| {
        let (x, y) = (f64::from(k % 11 - 5) / 50.0, f64::from(k / 11 - 5) / 50.0);
        NormalDeviation {
            at: Point3::new(2.0 + x, y, 0.3),
            normal: Vector3::z(),
            deviation: deviation(x, y),
        }
    };
    (0..121).map(point).collect()
}

#[test]
fn the_zone_about_a_fixed_nominal_is_twice_the_largest_deviation() {
    let found = surface_profile(&[1e-6, -3e-6, 2e-6]).unwrap();
    assert_eq!((found.width, found.least, found.largest), (6e-6, -3e-6, 2e-6));
    assert_eq!(
        surface_profile(&[]),
        Err(FormError::TooFew { needed: 1, given: 0 })
    );
    assert_eq!(
        surface_profile(&[0.0, f64::NAN]),
        Err(FormError::NotFinite { index: 1 })
    );
}

#[test]
fn an_offset_and_a_tilt_are_removed_and_a_saddle_stays() {
    let tilted = on_plane(|x, y| 5e-6 + 1e-4 * x - 2e-4 * y);
    let found = fitted_surface_profile(&tilted, MotionFreedom::Plane).unwrap();
    assert!(found.width < 1e-18, "{found:?}");
    // The corners of a saddle of 1e-3 x y at 0.1 m are 10 um up and down.
    let saddle = on_plane(|x, y| 5e-6 + 1e-4 * x + 1e-3 * x * y);
    let found = fitted_surface_profile(&saddle, MotionFreedom::Plane).unwrap();
    assert!((found.width - 20e-6).abs() < 1e-15, "{found:?}");
}

/// Any small motion of the six faces of a cube is removed; a plane alone does not determine six unknowns.
#[test]
fn a_motion_of_a_cube_is_removed_and_a_plane_does_not_determine_it() {
    let (shift, turn) = (Vector3::new(1e-5, -2e-5, 3e-5), Vector3::new(1e-4, 2e-4, -1e-4));
    let mut points = Vec::new();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            for k in 0..9 {
                let (a, b) = (f64::from(k % 3 - 1), f64::from(k / 3 - 1));
                let mut at = Vector3::zeros();
                at[axis] = side;
                at[(axis + 1) % 3] = a;
                at[(axis + 2) % 3] = b;
                let normal = Vector3::ith(axis, side);
                points.push(NormalDeviation {
                    at: (at * 0.05 + Vector3::new(0.0, 0.0, 1.0)).into(),
                    normal,
                    deviation: normal.dot(&(shift + turn.cross(&(at * 0.05)))),
                });
            }
        }
    }
    let found = fitted_surface_profile(&points, MotionFreedom::Rigid).unwrap();
    assert!(found.width < 1e-18, "{found:?}");
    let plane = on_plane(|x, y| x * y);
    assert_eq!(
        fitted_surface_profile(&plane, MotionFreedom::Rigid),
        Err(FormError::Undetermined)
    );
}

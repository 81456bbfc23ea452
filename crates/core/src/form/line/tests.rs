use super::*;

/// Witness: numpy (singular value decomposition) and scipy linprog on the same section.
#[test]
fn both_lines_are_those_of_another_program() {
    let point = |i: i32| {
        let (k, t) = (f64::from(i), 0.01 * f64::from(i));
        Point2::new(t, 5e-6 * (0.7 * k).sin() + 30e-6 * (t / 0.4).powi(2) + 1e-3 * t)
    };
    let points: Vec<_> = (0..41).map(point).collect();
    let found = straightness(&points).unwrap();
    assert!(
        (found.least_squares - 1.562_569_738_722_899e-5).abs() < 1e-15,
        "{found:?}"
    );
    assert!(
        (found.minimum_zone - 1.561_600_752_244_029e-5).abs() < 1e-14,
        "{found:?}"
    );
}

/// A parabola of height h over its chord is h wide, between the chord and the tangent parallel to it, at any orientation.
#[test]
fn a_bow_is_as_wide_as_high_at_any_orientation_and_size() {
    for (turn, size) in [(0.0_f64, 1.0), (1.0, 1.0), (2.5, 0.01), (-1.5, 100.0)] {
        let bow = |i: i32| {
            let t = f64::from(i) / 100.0;
            let (x, y) = (t, 1e-4 * (1.0 - t * t));
            Point2::new(
                3.0 + size * (x * turn.cos() - y * turn.sin()),
                size * (x * turn.sin() + y * turn.cos()),
            )
        };
        let found = straightness(&(-100..=100).map(bow).collect::<Vec<_>>()).unwrap();
        assert!(
            (found.minimum_zone / size - 1e-4).abs() < 1e-11,
            "{turn}: {found:?}"
        );
        assert!(found.minimum_zone <= found.least_squares);
    }
}

#[test]
fn points_without_a_line_are_refused() {
    assert_eq!(
        straightness(&[Point2::origin(); 2]),
        Err(FormError::TooFew { needed: 3, given: 2 })
    );
    assert_eq!(straightness(&[Point2::origin(); 5]), Err(FormError::Undetermined));
    let bad = [
        Point2::origin(),
        Point2::new(f64::NAN, 0.0),
        Point2::new(1.0, 0.0),
    ];
    assert_eq!(straightness(&bad), Err(FormError::NotFinite { index: 1 }));
}

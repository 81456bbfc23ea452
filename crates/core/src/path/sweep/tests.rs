use super::*;
use nalgebra::Point2;
use proptest::prelude::*;

const MM: f64 = 1e-3;

/// The row of bottoms starts this far below all cuts, m.
const FLOOR: f64 = -20.0 * MM;

fn cutter_mm(diameter: f64, corner: f64) -> EndMillBody {
    EndMillBody::new(diameter * MM, corner * MM).unwrap()
}

/// Path z of the lowest point over one position, m; `None` where the cutter does not pass.
fn bottom(sweep: &Sweep, at: Point2<f64>) -> Option<f64> {
    let mut row = [0.0];
    sweep.pass(Row {
        first: Point3::new(at.x, at.y, FLOOR),
        side: MM,
        bottoms: &mut row,
    });
    row[0].is_finite().then(|| FLOOR + f64::from(row[0]))
}

#[test]
fn the_lowest_point_of_a_step_is_that_of_many_stamps() {
    let stamps = 4000;
    for (diameter, corner) in [(10.0, 0.0), (10.0, 5.0), (10.0, 2.0)] {
        let cutter = cutter_mm(diameter, corner);
        for rise in [-9.0, -1.0, 0.0, 0.5, 6.0] {
            let (from, to) = (Point3::new(0.0, 0.0, 0.0), Point3::new(7.0, 3.0, rise) * MM);
            let sweep = Sweep::of(from, to, &cutter, 1e-6 * MM);
            let space = (to - from).norm() / f64::from(stamps);
            for (x, y) in [
                (1.0, 1.0),
                (3.5, -1.5),
                (-2.0, 3.0),
                (6.9, 6.0),
                (11.0, 3.0),
                (4.0, 1.7),
            ] {
                let at = Point2::new(x, y) * MM;
                let heights = (0..=stamps).filter_map(|k| {
                    let tip = from + (to - from) * (f64::from(k) / f64::from(stamps));
                    let rho = (at - tip.xy()).norm();
                    (rho <= cutter.radius()).then(|| tip.z + cutter.height(rho))
                });
                let stamped = heights.fold(f64::INFINITY, f64::min);
                let swept = bottom(&sweep, at).unwrap();
                // Heights of up to 26 mm are rounded to 6e-8 of themselves. Half a space away from the lowest tip a
                // flat one is higher by the slope, at most 9/7.6; rounded ones are as good unless the rim itself is
                // there, whose wall is upright.
                assert!(swept <= stamped + 2e-9, "{corner} {rise} {at}");
                assert!(
                    stamped - swept < 2.0 * space,
                    "{corner} {rise} {at}: {stamped} {swept}"
                );
            }
            assert_eq!(bottom(&sweep, Point2::new(-5.1, 0.0) * MM), None);
            assert_eq!(bottom(&sweep, Point2::new(12.1, 3.0) * MM), None);
        }
    }
}

/// The definition itself, by search: the height along the step is convex.
fn searched(from: Point3<f64>, to: Point3<f64>, cutter: &EndMillBody, at: Point2<f64>) -> Option<f64> {
    let (off, chord) = (at - from.xy(), (to - from).xy());
    let along = chord / chord.norm();
    let (a, b) = (off.dot(&along), off.perp(&along));
    let half = (cutter.radius() * cutter.radius() - b * b).sqrt();
    let (mut first, mut last) = ((a - half).max(0.0), (a + half).min(chord.norm()));
    let stretch = [first, last];
    if half.is_nan() || first > last {
        return None;
    }
    let height = |t: f64| from.z + (to.z - from.z) * (t / chord.norm()) + cutter.height((a - t).hypot(b));
    // Each iteration leaves two thirds, all of them 1e-16.
    for _ in 0..90 {
        let third = (last - first) / 3.0;
        if height(first + third) <= height(last - third) {
            last -= third;
        } else {
            first += third;
        }
    }
    // At the rim the bottom is vertical: the ends of the interval are tried too.
    let places = [0.5 * (first + last), stretch[0], stretch[1]];
    places.into_iter().map(height).min_by(f64::total_cmp)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn the_closed_lowest_point_is_that_of_a_search(
        corner in prop_oneof![Just(0.0), Just(5.0), 0.01..4.99],
        step in (-8.0..8.0, -8.0..8.0, prop_oneof![Just(0.0), -0.01..0.01, -6.0..6.0]),
        at in (-12.0..12.0, -12.0..12.0),
    ) {
        let cutter = cutter_mm(10.0, corner);
        let (from, to) = (Point3::origin(), Point3::new(step.0, step.1, step.2) * MM);
        prop_assume!(to.xy().coords.norm() > 0.01 * MM);
        let at = Point2::new(at.0, at.1) * MM;
        // Near the rim rounding of the position decides: 1e-9 of it is as much as the square root makes of that.
        let expected = searched(from, to, &cutter, at);
        let near = |way: f64| searched(from, to, &cutter, Point2::from(at.coords * (1.0 + way)));
        prop_assume!(near(1e-12).is_some() == near(-1e-12).is_some());
        for (from, to) in [(from, to), (to, from)] {
            let found = bottom(&Sweep::of(from, to, &cutter, 1e-6 * MM), at);
            prop_assert_eq!(found.is_some(), expected.is_some());
            if let (Some(found), Some(expected)) = (found, expected) {
                // Single precision of 31 mm at most, 6e-8 of it; the search stops where heights round to the same.
                prop_assert!((found - expected).abs() < 3e-9, "{} {}", found, expected);
            }
        }
    }

    #[test]
    fn a_row_reaches_as_far_as_the_cutter_passes(
        step in (-8.0..8.0, prop_oneof![Just(0.0), -8.0..8.0]),
        y in -14.0..14.0,
    ) {
        let cutter = cutter_mm(10.0, 2.0);
        let sweep = Sweep::of(Point3::origin(), Point3::new(step.0, step.1, 1.0) * MM, &cutter, 1e-3 * MM);
        let [left, right] = sweep.reach_along_x(y * MM);
        let [lower, upper] = sweep.reach_along_y();
        prop_assert_eq!(left <= right, (lower..=upper).contains(&(y * MM)));
        // A nanometre to either side of each end: inside and outside.
        let passes = |x: f64| bottom(&sweep, Point2::new(x, y * MM)).is_some();
        if right - left > 3e-9 {
            prop_assert!(passes(left + 1e-9) && passes(right - 1e-9));
        }
        if left <= right {
            prop_assert!(!passes(left - 1e-9) && !passes(right + 1e-9));
        }
    }
}

#[test]
fn a_step_straight_down_is_the_cutter_where_it_ends() {
    let cutter = cutter_mm(10.0, 2.0);
    let sweep = Sweep::of(
        Point3::new(1.0, 2.0, 5.0) * MM,
        Point3::new(1.0, 2.0, -3.0) * MM,
        &cutter,
        1e-3 * MM,
    );
    for (out, height) in [(0.0, 0.0), (3.0, 0.0), (4.2, 0.4)] {
        let found = bottom(&sweep, Point2::new(1.0 + out, 2.0) * MM).unwrap();
        // Single precision of 20 mm.
        assert!((found - (-3.0 + height) * MM).abs() < 2e-9, "{out} {found}");
    }
    assert_eq!(bottom(&sweep, Point2::new(6.1, 2.0) * MM), None);
}

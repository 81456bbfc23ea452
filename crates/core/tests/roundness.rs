//! The four reference circles of a profile against all candidates, and invariances.

use std::f64::consts::{PI, TAU};

use armill_core::nalgebra::{Matrix2, Point2, Rotation2, Vector2};
use armill_core::roundness::{Profile, ReferenceCircle, RoundnessError};
use proptest::prelude::*;

type Points = Vec<Point2<f64>>;

/// The point as far from `a` as from `b`, and as far from `c` as from `d`: where two bisectors meet.
fn equally_far([a, b]: [Point2<f64>; 2], [c, d]: [Point2<f64>; 2]) -> Option<Point2<f64>> {
    let sides = Matrix2::from_rows(&[(b - a).transpose(), (d - c).transpose()]);
    let squares = |a: Point2<f64>, b: Point2<f64>| (b.coords.norm_squared() - a.coords.norm_squared()) / 2.0;
    Some((sides.try_inverse()? * Vector2::new(squares(a, b), squares(c, d))).into())
}

fn pairs(points: &[Point2<f64>]) -> Vec<[Point2<f64>; 2]> {
    (0..points.len())
        .flat_map(|i| (0..i).map(move |j| [points[i], points[j]]))
        .collect()
}

fn nearest_and_farthest(points: &[Point2<f64>], centre: &Point2<f64>) -> [f64; 2] {
    let distances = points.iter().map(|p| (p - centre).norm());
    distances.fold([f64::MAX, 0.0], |[near, far], d| [near.min(d), far.max(d)])
}

fn width(points: &[Point2<f64>], centre: &Point2<f64>) -> f64 {
    let [near, far] = nearest_and_farthest(points, centre);
    far - near
}

/// Every centre with four points touching two and two, or three and one: all that a narrowest zone can have.
fn narrowest_by_trying_all(points: &[Point2<f64>]) -> f64 {
    let pairs = pairs(points);
    let centres = pairs.iter().enumerate().flat_map(|(i, first)| {
        pairs[..i]
            .iter()
            .filter_map(move |second| equally_far(*first, *second))
    });
    centres.map(|c| width(points, &c)).fold(f64::MAX, f64::min)
}

/// The width of the narrowest strip between two lines: one of them goes through two points.
fn narrowest_strip(points: &[Point2<f64>]) -> f64 {
    let across = |[a, b]: [Point2<f64>; 2]| {
        let normal = Rotation2::new(PI / 2.0) * (b - a).normalize();
        let along = points.iter().map(|p| normal.dot(&p.coords));
        let [low, high] = along.fold([f64::MAX, f64::MIN], |[low, high], d| [low.min(d), high.max(d)]);
        high - low
    };
    pairs(points).into_iter().map(across).fold(f64::MAX, f64::min)
}

/// The smallest circle about two or three points that encloses all.
fn smallest_by_trying_all(points: &[Point2<f64>]) -> f64 {
    let pairs = pairs(points);
    let middles = pairs
        .iter()
        .map(|[a, b]| Point2::from((a.coords + b.coords) / 2.0));
    let through_three = pairs
        .iter()
        .flat_map(|[a, b]| points.iter().filter_map(move |c| equally_far([*a, *b], [*a, *c])));
    let outer = |c: Point2<f64>| nearest_and_farthest(points, &c)[1];
    middles.chain(through_three).map(outer).fold(f64::MAX, f64::min)
}

/// Whether `centre` has points on all sides, so that it is in their convex hull.
fn is_within(points: &[Point2<f64>], centre: &Point2<f64>) -> bool {
    let mut angles: Vec<f64> = points
        .iter()
        .map(|p| p - centre)
        .map(|v| v.y.atan2(v.x))
        .collect();
    angles.sort_by(f64::total_cmp);
    let next = angles.iter().skip(1).copied().chain([angles[0] + TAU]);
    angles.iter().zip(next).all(|(a, b)| b - a <= PI)
}

/// The largest circle without a point about a centre in the hull: through three points, or through two, about a point
/// of a side of the hull. Reported separately.
fn largest_by_trying_all(points: &[Point2<f64>]) -> [f64; 2] {
    let pairs = pairs(points);
    let inner = |c: &Point2<f64>| nearest_and_farthest(points, c)[0];
    let through_three = pairs
        .iter()
        .flat_map(|[a, b]| points.iter().filter_map(move |c| equally_far([*a, *b], [*a, *c])));
    let three = through_three.filter(|c| is_within(points, c)).map(|c| inner(&c));
    let on_sides = pairs.iter().flat_map(|[a, b]| {
        let side = b - a;
        pairs.iter().filter_map(move |[c, d]| {
            // Along the line through a and b to where c and d are as far.
            let slope = (d - c).dot(&side);
            let part =
                ((d.coords.norm_squared() - c.coords.norm_squared()) / 2.0 - (d - c).dot(&a.coords)) / slope;
            (0.0..=1.0).contains(&part).then(|| a + side * part)
        })
    });
    let is_side = |[a, b]: &[Point2<f64>; 2]| {
        let beyond = |p: &Point2<f64>| (b - a).perp(&(p - a));
        points.iter().all(|p| beyond(p) <= 1e-12) || points.iter().all(|p| beyond(p) >= -1e-12)
    };
    let sides: Vec<_> = pairs.iter().filter(|pair| is_side(pair)).collect();
    let on_hull = on_sides
        .filter(|c| {
            sides.iter().any(|[a, b]| {
                let along = (c - a).dot(&(b - a)) / (b - a).norm_squared();
                (0.0..=1.0).contains(&along) && (b - a).perp(&(c - a)).abs() < 1e-12
            })
        })
        .map(|c| inner(&c));
    [three.fold(0.0, f64::max), on_hull.fold(0.0, f64::max)]
}

/// Points about a circle of one metre, each off it by up to `noise`.
fn near_circle(count: std::ops::Range<usize>, noise: f64) -> impl Strategy<Value = Points> {
    prop::collection::vec((-PI..PI, -noise..noise), count).prop_map(|polar| {
        let at = |(angle, by): (f64, f64)| Point2::new(angle.cos(), angle.sin()) * (1.0 + by);
        polar.into_iter().map(at).collect()
    })
}

/// From hardly off a circle to anywhere, and repeated points.
fn any_profile() -> impl Strategy<Value = Points> {
    let all = prop_oneof![
        near_circle(3..9, 1e-4),
        near_circle(4..9, 0.05),
        near_circle(4..8, 0.9),
    ];
    (all, any::<bool>()).prop_map(|(mut points, is_repeated)| {
        if is_repeated {
            points.push(points[0]);
        }
        points
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn no_candidate_makes_a_narrower_zone(points in any_profile()) {
        let Ok(profile) = Profile::new(points.clone()) else { return Ok(()) };
        let tried = narrowest_by_trying_all(&points);
        match profile.minimum_zone() {
            Ok(zone) => {
                // The result is accurate to rounding of the candidate circles.
                let good = 1e-13 * profile.least_squares().radius.max(zone.outer).max(1.0);
                prop_assert!((width(&points, &zone.centre) - zone.peak_to_valley()).abs() < good);
                prop_assert!(zone.peak_to_valley() <= tried + good, "{} above {tried}", zone.peak_to_valley());
                prop_assert!(zone.peak_to_valley() >= tried.min(narrowest_strip(&points)) - 1e-11, "{} below {tried}", zone.peak_to_valley());
            }
            // Centres beyond 500 radii are as good as lines.
            Err(RoundnessError::Straight) => prop_assert!(narrowest_strip(&points) < tried + 1e-2),
            Err(error) => prop_assert!(false, "{error}"),
        }
    }

    #[test]
    fn no_candidate_makes_a_smaller_circle_about_all(points in any_profile()) {
        let Ok(profile) = Profile::new(points.clone()) else { return Ok(()) };
        let circle = profile.minimum_circumscribed();
        let [near, far] = nearest_and_farthest(&points, &circle.centre);
        let good = 1e-14 * profile.least_squares().radius.max(1.0);
        prop_assert!((far - circle.radius).abs() < good && (far - near - circle.peak_to_valley).abs() < good);
        let tried = smallest_by_trying_all(&points);
        prop_assert!((circle.radius - tried).abs() < 10.0 * good, "{} not {tried}", circle.radius);
    }

    #[test]
    fn no_candidate_makes_a_larger_circle_between(points in any_profile()) {
        let Ok(profile) = Profile::new(points.clone()) else { return Ok(()) };
        let [largest, on_hull] = largest_by_trying_all(&points);
        match profile.maximum_inscribed() {
            Ok(circle) => {
                prop_assert!((nearest_and_farthest(&points, &circle.centre)[0] - circle.radius).abs() < 1e-14);
                prop_assert!(is_within(&points, &circle.centre));
                prop_assert!((circle.radius - largest).abs() < 1e-12, "{} not {largest}", circle.radius);
                prop_assert!(on_hull < circle.radius + 1e-12);
            }
            Err(RoundnessError::OneSided) => prop_assert!(on_hull > largest - 1e-9, "{on_hull} {largest}"),
            Err(RoundnessError::Open { gap_deg, .. }) => prop_assert!(gap_deg >= 179.0),
            Err(error) => prop_assert!(false, "{error}"),
        }
    }

    #[test]
    fn shift_turn_scale_and_order_change_nothing_else(
        points in near_circle(12..60, 1e-3),
        shift in prop::array::uniform2(-3.0..3.0f64),
        turn in -PI..PI,
        scale in 0.01..100.0f64,
    ) {
        let shift = Vector2::from(shift);
        let moved = |p: &Point2<f64>| Rotation2::new(turn) * p * scale + shift;
        let mut elsewhere: Points = points.iter().map(moved).collect();
        elsewhere.reverse();
        let (here, there) = (Profile::new(points).unwrap(), Profile::new(elsewhere).unwrap());
        // Places are rounded to 1e-16 of how far they are; a centre is as good as that over the slope of its optimum.
        let good = 1e-13 * (scale + shift.norm());
        let same = |here: ReferenceCircle, there: ReferenceCircle| {
            (moved(&here.centre) - there.centre).norm() < 1e3 * good
                && (here.radius * scale - there.radius).abs() < good.max(1e-12 * there.radius)
                && (here.peak_to_valley * scale - there.peak_to_valley).abs() < 1e3 * good
        };
        prop_assert!(same(here.least_squares(), there.least_squares()));
        prop_assert!(same(here.minimum_circumscribed(), there.minimum_circumscribed()));
        if let (Ok(here), Ok(there)) = (here.minimum_zone(), there.minimum_zone()) {
            prop_assert!((here.peak_to_valley() * scale - there.peak_to_valley()).abs() < good);
        }
        match (here.maximum_inscribed(), there.maximum_inscribed()) {
            (Ok(here), Ok(there)) => prop_assert!((here.radius * scale - there.radius).abs() < good),
            (here, there) => prop_assert!(here.is_err() && there.is_err()),
        }
    }
}

/// `count` even points about (0.3, -0.1) m with deviations `by(angle)` from 50 mm.
fn even(count: usize, by: impl Fn(f64) -> f64) -> Points {
    let at = |i: usize| {
        let angle = TAU * i as f64 / count as f64;
        Point2::new(0.3, -0.1) + Vector2::new(angle.cos(), angle.sin()) * (0.05 + by(angle))
    };
    (0..count).map(at).collect()
}

#[test]
fn the_minimum_zone_has_the_least_roundness_of_the_four() {
    for lobes in 2..9 {
        let wave = |a: f64| 20e-6 * (f64::from(lobes) * a).cos() + 7e-6 * (2.6 * a).sin();
        let profile = Profile::new(even(500, wave)).unwrap();
        let least = profile.minimum_zone().unwrap().peak_to_valley();
        let others = [
            profile.least_squares(),
            profile.minimum_circumscribed(),
            profile.maximum_inscribed().unwrap(),
        ];
        for other in others {
            assert!(least <= other.peak_to_valley + 1e-15, "{lobes} {other:?}");
        }
        let [inner, outer] = [others[2].radius, others[1].radius];
        assert!(inner < profile.least_squares().radius && profile.least_squares().radius < outer);
    }
}

#[test]
fn an_ellipse_has_circles_of_its_half_axes() {
    let at = |i: i32| {
        let angle = f64::from(i).to_radians();
        Point2::new(0.052 * angle.cos(), 0.048 * angle.sin())
    };
    let profile = Profile::new((0..360).map(at).collect()).unwrap();
    let zone = profile.minimum_zone().unwrap();
    assert!((zone.inner - 0.048).abs() < 1e-14 && (zone.outer - 0.052).abs() < 1e-14);
    assert!(zone.centre.coords.norm() < 1e-14, "{zone:?}");
    let [out, inside] = [
        profile.minimum_circumscribed(),
        profile.maximum_inscribed().unwrap(),
    ];
    assert!((out.radius - 0.052).abs() < 1e-15 && (out.peak_to_valley - 0.004).abs() < 1e-14);
    // Between the points of the flat sides the circle moves along by 0.07 mm, and grows by the square of it.
    assert!(
        inside.radius > 0.048 && inside.radius < 0.048 + 60e-9,
        "{inside:?}"
    );
}

#[test]
fn three_points_are_on_all_four_circles() {
    let three = vec![
        Point2::new(1.0, 0.0),
        Point2::new(-0.5, 0.8),
        Point2::new(-0.4, -0.9),
    ];
    let profile = Profile::new(three).unwrap();
    let circle = profile.least_squares();
    let zone = profile.minimum_zone().unwrap();
    assert!(zone.peak_to_valley() < 1e-14 && (zone.inner - circle.radius).abs() < 1e-14);
    for other in [
        profile.minimum_circumscribed(),
        profile.maximum_inscribed().unwrap(),
    ] {
        assert!((other.radius - circle.radius).abs() < 1e-14 && other.peak_to_valley < 1e-13);
    }
}

#[test]
fn an_exact_circle_has_no_zone_but_rounding_whatever_its_size() {
    for size in [1e-3, 1.0, 1e3] {
        let points: Points = even(1000, |_| 0.0).iter().map(|p| p * size).collect();
        let zone = Profile::new(points).unwrap().minimum_zone().unwrap();
        assert!(zone.peak_to_valley() < 1e-14 * size);
    }
}

#[test]
fn arcs_have_a_zone_and_no_inscribed_circle() {
    for sweep in [40.0_f64, 90.0, 170.0] {
        // Five half waves along the arc: out and in alternate six times, so that no centre does better.
        let at = |i: i32| {
            let along = f64::from(i) / 500.0;
            let angle = (20.0 + sweep * along).to_radians();
            Point2::new(angle.cos(), angle.sin()) * (0.05 + 4e-6 * (5.0 * PI * along).cos())
        };
        let profile = Profile::new((0..=500).map(at).collect()).unwrap();
        let given = profile.minimum_zone().unwrap().peak_to_valley();
        assert!((given - 8e-6).abs() < 1e-9, "{sweep}: {given}");
        let refused = profile.maximum_inscribed().unwrap_err();
        assert!(
            matches!(refused, RoundnessError::Open { gap_deg, .. } if (gap_deg - (360.0 - sweep)).abs() < 0.01),
            "{refused}"
        );
    }
}

#[test]
fn a_cloud_of_points_is_answered_or_refused_in_time() {
    // No profile at all: points all over a disc, by a sequence that fills it evenly.
    let at = |i: i32| {
        let (turn, out) = (f64::from(i) * 2.399_963, (f64::from(i) * 0.754_877_666).fract());
        Point2::new(turn.cos(), turn.sin()) * out.sqrt()
    };
    let profile = Profile::new((0..20_000).map(at).collect()).unwrap();
    for refused in [profile.minimum_zone().err(), profile.maximum_inscribed().err()] {
        assert!(
            matches!(refused, None | Some(RoundnessError::NotProven { .. })),
            "{refused:?}"
        );
    }
}

#[test]
fn points_without_a_circle_are_refused_with_their_reason() {
    let line: Points = (0..7)
        .map(|i| Point2::new(f64::from(i), 2.0 * f64::from(i)))
        .collect();
    for none in [line, vec![Point2::new(1.0, 2.0); 5], even(2, |_| 0.0), Vec::new()] {
        assert_eq!(Profile::new(none).unwrap_err(), RoundnessError::NoCircle);
    }
    for bad in [f64::NAN, f64::INFINITY, 1e7] {
        let mut points = even(9, |_| 0.0);
        points[4].y = bad;
        assert_eq!(
            Profile::new(points).unwrap_err(),
            RoundnessError::NotFinite { index: 4 }
        );
    }
}

#[test]
fn a_local_optimum_does_not_pass_for_the_largest_inscribed_circle() {
    // Four points in, at 10, 170, 190 and 350 deg, limit one circle left and one right of the middle; the right is
    // larger.
    let at = |i: i32| {
        let angle = f64::from(i * 5).to_radians();
        let waist = 3e-3 * (2.0 * angle).cos() - 1e-3 * (4.0 * angle).cos();
        Point2::new(angle.cos(), angle.sin()) * (0.05 + waist + 1e-4 * angle.cos())
    };
    let points: Points = (0..72).map(at).collect();
    let circle = Profile::new(points.clone()).unwrap().maximum_inscribed().unwrap();
    // By trying each pair that may limit it, on a fine grid of centres.
    let mut best = 0.0_f64;
    for i in -200..=200 {
        for j in -200..=200 {
            let centre = Point2::new(f64::from(i), f64::from(j)) * 25e-6;
            best = best.max(nearest_and_farthest(&points, &centre)[0]);
        }
    }
    assert!(
        circle.radius >= best && circle.radius < best + 25e-6,
        "{circle:?} {best}"
    );
}

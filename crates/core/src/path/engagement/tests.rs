use nalgebra::{Point3, Unit, Vector3};

use super::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const MM: f64 = 1e-3;
const PITCH: f64 = 0.25 * MM;
const RADIUS: f64 = 5.0 * MM;
/// Depth of the floor below the top of the stock.
const DEPTH: f64 = 3.0 * MM;

/// Largest error of an edge of a strip: half a pitch for its cells, a quarter for the strips.
const EDGE: f64 = 0.75;

fn stock(pitch: f64) -> Stock {
    let corner = Point3::new(60.0, 60.0, 0.0) * MM;
    Stock::new(
        [Point3::from(-corner.coords) - Vector3::z() * 20.0 * MM, corner],
        pitch,
    )
    .unwrap()
}

fn flat() -> EndMillBody {
    EndMillBody::new(2.0 * RADIUS, 0.0).unwrap()
}

fn ball() -> EndMillBody {
    EndMillBody::new(2.0 * RADIUS, RADIUS).unwrap()
}

fn pass(from: Point3<f64>, to: Point3<f64>, direction: Vector3<f64>) -> Pass {
    Pass {
        from,
        to,
        direction: Unit::new_normalize(direction),
        axis: Vector3::z_axis(),
    }
}

/// Immersion angles of an engagement where the cutter has the radius `rho`.
fn arc_at(engagement: &PassEngagement, rho: f64) -> [f64; 2] {
    let arc = engagement.strip.and_then(|strip| strip.arc_at(rho)).unwrap();
    [arc.entry, arc.exit]
}

/// Engagements along a line in steps no longer than `step`, its start first.
fn line(
    stock: &mut Stock,
    from: Point3<f64>,
    to: Point3<f64>,
    step: f64,
    cutter: &EndMillBody,
) -> Vec<PassEngagement> {
    let way = to - from;
    let pieces = (way.norm() / step).ceil();
    let mut before = from;
    (0..=pieces as usize)
        .map(|k| {
            let at = from + way * (k as f64 / pieces);
            let engagement = stock.cut(&pass(before, at, way), cutter).unwrap();
            before = at;
            engagement
        })
        .collect()
}

/// A position relative to a feed at `angle` from x through the origin, to its left and up.
fn place(angle: f64, along: f64, left: f64, up: f64) -> Point3<f64> {
    let (sin, cos) = angle.sin_cos();
    Point3::new(along * cos - left * sin, along * sin + left * cos, up)
}

/// Whether the rim at `phi` is within `pitches` pitches, laterally, of the rim at `expected`.
fn is_at(phi: f64, expected: f64, pitches: f64) -> bool {
    RADIUS * (phi.cos() - expected.cos()).abs() <= pitches * PITCH
}

const ANGLES: [f64; 6] = [0.0, FRAC_PI_2, 0.3, 0.785, 2.5, -1.9];

#[test]
fn a_first_pass_is_a_slot_from_0_to_180_deg_whatever_its_direction() {
    for angle in ANGLES {
        let mut stock = stock(PITCH);
        let (from, to) = (
            place(angle, -20.0 * MM, 0.0, -DEPTH),
            place(angle, 20.0 * MM, 0.0, -DEPTH),
        );
        for engagement in line(&mut stock, from, to, 0.7 * MM, &flat()) {
            assert_eq!(engagement.kind, EngagementKind::Slot);
            assert_eq!(arc_at(&engagement, RADIUS), [0.0, PI]);
            assert!((engagement.depth - DEPTH).abs() < 1e-9 && engagement.width == 2.0 * RADIUS);
        }
    }
}

#[test]
fn a_pass_next_to_another_has_the_closed_form_immersion_of_its_width() {
    for angle in ANGLES {
        for ae in [0.8, 2.0, 5.0, 7.3].map(|ae| ae * MM) {
            for step in [0.05, 0.3, 1.0].map(|step| step * MM) {
                for side in [1.0, -1.0] {
                    let mut stock = stock(PITCH);
                    let end = |along: f64, left: f64| place(angle, along * MM, left, -DEPTH);
                    line(&mut stock, end(-20.0, 0.0), end(20.0, 0.0), 40.0 * MM, &flat());
                    let next_to = end(-5.0, side * ae);
                    // In the slot, still before the start of the tested pass.
                    line(&mut stock, end(-8.0, side * ae), next_to, MM, &flat());
                    for engagement in line(&mut stock, next_to, end(-3.0, side * ae), step, &flat()) {
                        let immersion = (1.0 - ae / RADIUS).acos();
                        let expected = if side > 0.0 {
                            [0.0, immersion]
                        } else {
                            [PI - immersion, PI]
                        };
                        let [entry, exit] = arc_at(&engagement, RADIUS);
                        let given = format!("{angle} {ae} {step} {engagement:?}");
                        assert_eq!(engagement.kind, EngagementKind::Strip, "{given}");
                        assert!(
                            is_at(entry, expected[0], EDGE) && is_at(exit, expected[1], EDGE),
                            "{given}"
                        );
                        assert!((engagement.width - ae).abs() <= EDGE * PITCH, "{given}");
                        let away = if side > 0.0 { entry } else { PI - exit };
                        assert!(
                            away == 0.0 && engagement.width == engagement.strip.unwrap().width(),
                            "{given}"
                        );
                        assert!((engagement.depth - DEPTH).abs() < 1e-9, "{given}");
                    }
                }
            }
        }
    }
}

#[test]
fn the_volume_of_a_step_is_its_section_times_its_length() {
    let mut stock = stock(PITCH);
    let at = |x: f64, y: f64| Point3::new(x, y, -3.0) * MM;
    line(&mut stock, at(-50.0, 0.0), at(50.0, 0.0), 100.0 * MM, &flat());
    let engagements = line(&mut stock, at(-40.0, 2.0), at(40.0, 2.0), MM, &flat());
    let sum: f64 = engagements[20..].iter().map(|engagement| engagement.volume).sum();
    let steps = (engagements.len() - 20) as f64;
    // The wall is on a row of cells: what is left is the start and the end of the stretch, a pitch each.
    let section = 2.0 * MM * DEPTH;
    assert!(
        (sum - section * steps * MM).abs() < section * 2.0 * PITCH,
        "{sum}"
    );
}

#[test]
fn a_pass_where_all_is_removed_already_is_air() {
    for cutter in [flat(), ball(), EndMillBody::new(2.0 * RADIUS, 1.5 * MM).unwrap()] {
        for angle in ANGLES {
            for rise in [-2.0, 0.0, 2.0] {
                let mut stock = stock(PITCH);
                let from = place(angle, -20.3 * MM, 1.07 * MM, -DEPTH);
                let to = place(angle, 17.1 * MM, 1.07 * MM, -DEPTH + rise * MM);
                line(&mut stock, from, to, 0.6 * MM, &cutter);
                for engagement in line(&mut stock, from, to, 0.6 * MM, &cutter) {
                    assert_eq!(
                        (engagement.kind, engagement.strip),
                        (EngagementKind::Air, None),
                        "{angle} {rise}"
                    );
                    assert_eq!(
                        [engagement.width, engagement.depth, engagement.volume],
                        [0.0; 3],
                        "{angle} {rise}"
                    );
                }
            }
        }
    }
}

/// Engagements round a circle about the origin, counterclockwise.
fn round(stock: &mut Stock, radius: f64, steps: u32, cutter: &EndMillBody) -> Vec<PassEngagement> {
    let at = |k: u32| place(f64::from(k) / f64::from(steps) * TAU, radius, 0.0, -DEPTH);
    (1..=steps)
        .map(|k| {
            let feed = Vector3::z().cross(&at(k).coords.xy().push(0.0));
            stock.cut(&pass(at(k - 1), at(k), feed), cutter).unwrap()
        })
        .collect()
}

#[test]
fn the_wall_of_a_round_pocket_has_the_closed_form_arc() {
    let mut stock = stock(PITCH);
    // A pocket of 15 mm radius, cleared from within; then rings of 1.5 mm outwards: part on the right.
    for ring in [1.0, 4.0, 8.0, 10.0] {
        round(&mut stock, ring * MM, 400, &flat());
    }
    let mut wall = 15.0 * MM;
    for ring in [11.5 * MM, 13.0 * MM] {
        let engagements = round(&mut stock, ring, 150, &flat());
        // Where a point of the rim is as far from the centre as the wall: law of cosines.
        let half = ((wall * wall - ring * ring - RADIUS * RADIUS) / (2.0 * ring * RADIUS)).acos();
        // Not near the start, whose disc is cut already when the ring closes.
        for engagement in &engagements[60..110] {
            assert_eq!(engagement.kind, EngagementKind::Strip);
            let [entry, exit] = arc_at(engagement, RADIUS);
            assert_eq!(exit, PI);
            // The arc leaves its chord within the window by another part of a pitch.
            assert!(is_at(entry, PI - half, 1.2), "{} {engagement:?}", PI - half);
        }
        // A straight wall would have a smaller arc: the test can distinguish them.
        let straight = (1.0 - (ring + RADIUS - wall) / RADIUS).acos();
        assert!(!is_at(PI - straight, PI - half, 1.2));
        wall = ring + RADIUS;
    }
    let again = round(&mut stock, 13.0 * MM, 150, &flat());
    assert!(
        again
            .iter()
            .all(|engagement| engagement.kind == EngagementKind::Air && engagement.volume == 0.0)
    );
}

#[test]
fn entering_and_leaving_a_face_follow_the_rim() {
    let mut stock = stock(PITCH);
    let at = |x: f64| Point3::new(x * MM, 0.0, -DEPTH);
    let engagements = line(&mut stock, at(-70.0), at(70.0), MM, &flat());
    for (k, engagement) in engagements.iter().enumerate() {
        // From the centre of the tool to the face at -60 mm.
        let short = -60.0 * MM - (-70.0 + k as f64) * MM;
        if short >= RADIUS + 2.0 * PITCH || short <= -120.0 * MM {
            assert_eq!(engagement.kind, EngagementKind::Air, "{k}");
            continue;
        }
        if (0.2 * RADIUS..0.9 * RADIUS).contains(&short) {
            let entry = (short / RADIUS).asin();
            // The face is across the feed: a pitch along the feed is a pitch times tan(phi) along the rim's y.
            let off = 1.5 * entry.tan() + EDGE;
            let [enters, leaves] = arc_at(engagement, RADIUS);
            assert!(is_at(enters, entry, off), "{k} {engagement:?}");
            assert!(is_at(leaves, PI - entry, off), "{k} {engagement:?}");
        }
        if (-115.0 * MM..0.0).contains(&short) {
            assert_eq!(engagement.kind, EngagementKind::Slot, "{k}");
        }
    }
}

/// Clears a rectangle with a thin cutter.
fn clear(stock: &mut Stock, low: [f64; 2], high: [f64; 2]) {
    let thin = EndMillBody::new(0.5 * MM, 0.0).unwrap();
    let mut y = low[1] + 0.25;
    while y < high[1] - 0.2 {
        let at = |x: f64| Point3::new(x * MM, y * MM, -DEPTH);
        line(stock, at(low[0]), at(high[0] - 0.25), 200.0 * MM, &thin);
        y += 0.25;
    }
}

#[test]
fn engagement_rises_towards_an_inner_corner() {
    let mut stock = stock(PITCH);
    clear(&mut stock, [-60.0, -60.0], [20.0, 10.0]);
    // The wall y = 10 mm is engaged with 2 mm, the wall x = 20 mm is ahead.
    let at = |x: f64| Point3::new(x * MM, 7.0 * MM, -DEPTH);
    let engagements = line(&mut stock, at(-30.0), at(20.0), 0.5 * MM, &flat());
    let side = (1.0 - 2.0 / 5.0_f64).acos();
    let mut exits = Vec::new();
    for (k, engagement) in engagements.iter().enumerate().skip(30) {
        let away = (50.0 - 0.5 * k as f64) * MM;
        if away > RADIUS + 2.0 * PITCH {
            assert_eq!(engagement.kind, EngagementKind::Strip);
            assert!(
                is_at(arc_at(engagement, RADIUS)[1], side, EDGE),
                "{k} {engagement:?}"
            );
        } else if away < 0.75 * RADIUS {
            // The rim passes x = 20 mm at sin(phi) = away/R, on the side of the free part.
            let exit = PI - (away / RADIUS).asin();
            // A pitch along the feed and one of the corner that the thin cutter leaves.
            let off = 2.0 * (away / RADIUS).asin().tan() + EDGE;
            let [enters, leaves] = arc_at(engagement, RADIUS);
            assert!(
                enters == 0.0 && is_at(leaves, exit, off),
                "{k} {exit} {engagement:?}"
            );
            exits.push(leaves);
        }
    }
    assert!(
        exits.len() > 6 && exits.windows(2).all(|pair| pair[1] >= pair[0] - 1e-12),
        "{exits:?}"
    );
    assert_eq!(engagements.last().unwrap().kind, EngagementKind::Slot);
}

#[test]
fn of_two_strips_on_both_sides_of_a_channel_only_one_is_reported() {
    let mut stock = stock(PITCH);
    let at = |x: f64| Point3::new(x * MM, 0.0, -DEPTH);
    let channel = EndMillBody::new(5.0 * MM, 0.0).unwrap();
    line(&mut stock, at(-50.0), at(50.0), 100.0 * MM, &channel);
    let engagements = line(&mut stock, at(-20.0), at(0.0), MM, &flat());
    for engagement in &engagements {
        let [entry, exit] = arc_at(engagement, RADIUS);
        let upper = entry == 0.0 && is_at(exit, PI / 3.0, EDGE);
        let lower = exit == PI && is_at(entry, 2.0 * PI / 3.0, EDGE);
        assert!(upper || lower, "{engagement:?}");
    }
}

#[test]
fn a_rib_narrower_than_the_cutter_is_engaged_in_the_middle() {
    let mut stock = stock(PITCH);
    clear(&mut stock, [-60.0, -20.0], [60.0, -2.0]);
    clear(&mut stock, [-60.0, 3.0], [60.0, 20.0]);
    let at = |x: f64| Point3::new(x * MM, 0.0, -DEPTH);
    for engagement in line(&mut stock, at(-20.0), at(0.0), MM, &flat()) {
        assert_eq!(engagement.kind, EngagementKind::Strip);
        let [entry, exit] = arc_at(&engagement, RADIUS);
        assert!(is_at(entry, 0.6_f64.acos(), 2.0 * EDGE), "{engagement:?}");
        assert!(is_at(exit, (-0.4_f64).acos(), 2.0 * EDGE), "{engagement:?}");
    }
}

#[test]
fn a_ramp_engages_deeper_step_by_step_and_a_plunge_all_round() {
    let mut stock = stock(PITCH);
    let (from, to) = (
        Point3::new(-20.0, 0.0, 0.0) * MM,
        Point3::new(20.0, 0.0, -4.0) * MM,
    );
    let engagements = line(&mut stock, from, to, MM, &flat());
    let steps = (engagements.len() - 1) as f64;
    for (k, engagement) in engagements.iter().enumerate().skip(1) {
        assert_eq!(engagement.kind, EngagementKind::Slot, "{k}");
        assert_eq!(arc_at(engagement, RADIUS), [0.0, PI], "{k}");
        assert!(
            (engagement.depth - 4.0 * MM * k as f64 / steps).abs() < 1e-8,
            "{k} {engagement:?}"
        );
    }
    let down = [
        Point3::new(0.0, 30.0, 1.0) * MM,
        Point3::new(0.0, 30.0, -2.0) * MM,
    ];
    let plunge = line(&mut stock, down[0], down[1], MM, &flat());
    let kinds: Vec<EngagementKind> = plunge.iter().map(|engagement| engagement.kind).collect();
    let (air, dive) = (EngagementKind::Air, EngagementKind::Plunge);
    assert_eq!(kinds, [air, air, dive, dive]);
    assert!((plunge[3].depth - MM).abs() < 1e-8);
    assert_eq!((plunge[3].strip, plunge[3].width), (None, 2.0 * RADIUS));
    let up = line(&mut stock, down[1], down[0], MM, &flat());
    assert!(
        up.iter()
            .all(|engagement| engagement.kind == air && engagement.volume == 0.0)
    );
}

#[test]
fn a_ball_is_engaged_up_to_the_height_of_the_material() {
    for depth in [0.3, 1.0, 3.0, 8.0].map(|depth| depth * MM) {
        let mut stock = stock(PITCH);
        let (from, to) = (
            place(0.4, -9.0 * MM, 0.0, -depth),
            place(0.4, 9.0 * MM, 0.0, -depth),
        );
        let wide = ball().radius_at(depth);
        for engagement in line(&mut stock, from, to, MM, &ball()) {
            assert_eq!(engagement.kind, EngagementKind::Slot, "{depth}");
            assert_eq!(arc_at(&engagement, wide), [0.0, PI], "{depth}");
            // It continues beyond the circle that cuts.
            assert_eq!(engagement.strip.unwrap().edges(), [-RADIUS, RADIUS]);
            // Heights are rounded to 1e-9 m; a ball of 5 mm is 2.8 times as wide per height at 0.3 mm, on two sides.
            assert!(
                (engagement.width - 2.0 * wide).abs() < 1e-8,
                "{depth} {engagement:?}"
            );
            assert!((engagement.depth - depth).abs() < 1e-8, "{depth} {engagement:?}");
        }
    }
}

#[test]
fn a_ball_next_to_its_own_groove_engages_the_ridge_between() {
    let (depth, apart) = (2.0 * MM, 1.5 * MM);
    let mut stock = stock(PITCH);
    let at = |x: f64, y: f64| Point3::new(x * MM, y, -depth);
    line(&mut stock, at(-40.0, 0.0), at(40.0, 0.0), 80.0 * MM, &ball());
    line(&mut stock, at(-40.0, apart), at(-10.0, apart), 30.0 * MM, &ball());
    // Left of the middle between both grooves the ball reaches below the first one.
    let (left, right) = (ball().radius_at(depth), -apart / 2.0);
    for engagement in line(&mut stock, at(-10.0, apart), at(10.0, apart), MM, &ball()) {
        assert_eq!(engagement.kind, EngagementKind::Strip);
        let off = engagement.width - (left - right);
        // The stack has discs of a sixth of the engaged radius: the lowest one at the ridge defines its start.
        assert!(off.abs() < left / 6.0 + EDGE * PITCH, "{off} {engagement:?}");
        // The ridge continues beyond the point where the ball has its height; the width is reported at that height.
        let [right, beyond] = engagement.strip.unwrap().edges();
        assert!(
            beyond == RADIUS && (engagement.width - (left - right)).abs() < 1e-8,
            "{engagement:?}"
        );
    }
}

#[test]
fn the_immersion_converges_with_the_pitch() {
    let worst = |pitch: f64| {
        let errors = (0..10).map(|k| {
            let mut stock = stock(pitch);
            let (angle, ae) = (0.3 * f64::from(k), (1.5 + 0.17 * f64::from(k)) * MM);
            let end = |along: f64, left: f64| place(angle, along * MM, left, -DEPTH);
            line(&mut stock, end(-20.0, 0.0), end(20.0, 0.0), 40.0 * MM, &flat());
            line(&mut stock, end(-8.0, ae), end(-5.0, ae), 3.0 * MM, &flat());
            let engagements = line(&mut stock, end(-5.0, ae), end(-4.0, ae), 0.5 * MM, &flat());
            let errors = engagements.iter().map(|engagement| (engagement.width - ae).abs());
            errors.fold(0.0, f64::max)
        });
        errors.fold(0.0, f64::max)
    };
    let errors = [0.8, 0.4, 0.2, 0.1].map(|pitch| worst(pitch * MM));
    for (error, pitch) in errors.iter().zip([0.8, 0.4, 0.2, 0.1]) {
        assert!(*error <= EDGE * pitch * MM, "{errors:?}");
    }
    assert!(errors[3] < errors[0] / 3.0, "{errors:?}");
}

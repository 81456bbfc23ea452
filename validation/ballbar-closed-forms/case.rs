//! Circular tests of ellipses, shifted circles and machines with backlash, compared with closed forms. See README.md.
//!
//! | symbol | meaning |
//! |---|---|
//! | `p`, `q` | half axes of an ellipse, m |
//! | `e` | offset of a circle from the centre of the bar, m |
//! | `sigma`, `gap` | squareness (rad) and backlash (m) of a machine |

use std::f64::consts::TAU;

use armill_core::measure::ballbar::parts::{Parts, PartsOptions, Term, of_axes, parts};
use armill_core::measure::ballbar::{CircularTest, Direction, Run, least_squares_centre, quantities};

use crate::check::{Check, ErrorBound, worst};
use crate::random::Random;

const GEOMETRY: &str = "closed form";
const RADIUS: f64 = 0.1;
const SEED: u64 = 12;
const CIRCLES: usize = 50;
const SAMPLES: u32 = 720;

/// A turn of `radius` at even angles from `first` of a step on.
fn run(direction: Direction, first: f64, radius: impl Fn(f64) -> f64) -> Run {
    let angle: Vec<f64> = (0..SAMPLES)
        .map(|k| TAU * (f64::from(k) + first) / f64::from(SAMPLES))
        .collect();
    let deviation = angle.iter().map(|a| radius(*a) - RADIUS).collect();
    Run::new(direction, angle, deviation).expect("even angles and finite radii")
}

fn test(runs: Vec<Run>) -> CircularTest {
    CircularTest::new(RADIUS, runs).expect("radii near the nominal one")
}

/// Circular deviation, smallest and largest radial deviation.
fn shown(test: &CircularTest) -> [f64; 3] {
    let all: Vec<&Run> = test.runs().iter().collect();
    let shown = quantities(test, &all).expect("there are runs");
    let [least, greatest] = shown.radial;
    [
        shown.circular.unwrap_or(f64::NAN),
        least.deviation,
        greatest.deviation,
    ]
}

/// A machine with inclined axes and backlash, in both directions.
fn machine(sigma: f64, gap: [f64; 2]) -> CircularTest {
    let radius = |a: f64, sign: f64| {
        let speed = [-sign * a.sin(), sign * a.cos()];
        let lag = [0, 1].map(|k| 0.5 * gap[k] * speed[k].signum());
        let [x, y] = [RADIUS * a.cos() - lag[0], RADIUS * a.sin() - lag[1]];
        (x - sigma * y).hypot(y)
    };
    test(
        Direction::BOTH
            .map(|way| run(way, 0.5, |a| radius(a, way.sign())))
            .to_vec(),
    )
}

/// Squareness by the radii at 45, 135, 225 and 315 deg, of the mean of both directions.
fn by_four_radii(test: &CircularTest) -> f64 {
    let at = |deg: f64| {
        let of = test
            .runs()
            .iter()
            .map(|run| armill_core::measure::ballbar::Profile::of(run).at(deg.to_radians()));
        of.flatten().sum::<f64>() / 2.0
    };
    -(at(45.0) + at(225.0) - at(135.0) - at(315.0)) / (2.0 * RADIUS)
}

/// Quantities and parts of circles whose errors are known.
pub fn checks() -> Vec<Check> {
    let mut random = Random::seeded(SEED);
    let (mut ring, mut round, mut radial, mut centre) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut square, mut four, mut gaps) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..CIRCLES {
        let [p, q] = [0.0, 0.0].map(|_: f64| RADIUS + random.between(-200e-6, 200e-6));
        let ellipse = run(Direction::Clockwise, 0.0, |a| {
            (a.cos() / p).hypot(a.sin() / q).recip()
        });
        ring.push(shown(&test(vec![ellipse]))[0] - (p - q).abs());

        let e = random.between(10e-6, 200e-6);
        let offset = |a: f64| e * a.cos() + (RADIUS.powi(2) - (e * a.sin()).powi(2)).sqrt();
        let offset = test(vec![run(Direction::Anticlockwise, 0.0, offset)]);
        let [g, least, greatest] = shown(&offset);
        round.push(g);
        radial.extend([least + e, greatest - e]);
        centre.push(least_squares_centre(&offset).map_or(f64::NAN, |found| found.offset.x - e));

        let (sigma, gap) = (
            random.between(-5e-4, 5e-4),
            [0.0, 0.0].map(|_: f64| random.between(1e-6, 50e-6)),
        );
        let made = machine(sigma, gap);
        let requested = PartsOptions {
            reversals: of_axes(["X", "Y"]),
            most_lobes: 2,
            period: None,
        };
        let found: Option<Parts> = parts(&made, &requested);
        let value = |term: Term| {
            found
                .as_ref()
                .and_then(|parts| parts.of(term))
                .map_or(f64::NAN, |part| part.value)
        };
        square.push(value(Term::Squareness) * 2.0 / RADIUS - sigma);
        four.push(value(Term::Squareness) * 2.0 / RADIUS - by_four_radii(&made));
        gaps.extend((0..4).map(|end| value(Term::Reversal(end)) - gap[end / 2]));
    }
    let rounding = |what: &str, errors: Vec<f64>| {
        let gap = ErrorBound {
            worst: worst(errors),
            tolerance: 1e-12,
            unit: "m",
        };
        Check::computed(format!("{what}, {CIRCLES} circles"), GEOMETRY, gap)
    };
    let second_order = |what: &str, errors: Vec<f64>, (factor, unit)| {
        let gap = ErrorBound {
            worst: worst(errors) * factor,
            tolerance: 0.1,
            unit,
        };
        Check::printed(format!("{what}, {CIRCLES} machines"), GEOMETRY, gap, 2)
    };
    vec![
        rounding("G of an ellipse", ring),
        rounding("G of a circle with an offset centre", round),
        rounding("F of a circle with an offset centre", radial),
        rounding("least-squares centre", centre),
        second_order("squareness", square, (1e6, "urad")),
        second_order(
            "squareness compared with the formula of four radii",
            four,
            (1e6, "urad"),
        ),
        second_order("steps at reversals", gaps, (1e6, "um")),
    ]
}

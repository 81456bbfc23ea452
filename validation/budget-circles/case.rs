//! Sums, shares and waves of budgets against closed forms. See README.md.
//!
//! | symbol | meaning |
//! |---|---|
//! | `A`, `phi` | amplitude (m) and phase (rad) of a wave `A cos(n a - phi)` |

use std::f64::consts::TAU;

use armill_core::budget::turn::Turn;
use armill_core::budget::{Balance, Contribution, Origin, Removed, balance};

use crate::check::{Check, ErrorBound, worst};
use crate::random::Random;

const CLOSED: &str = "closed form";
const PAPER: &str = "published numbers";
const SEED: u64 = 41;
const CIRCLES: usize = 50;
const MOST_WAVES: usize = 8;

/// A wave: how many a turn, amplitude (m), phase (rad).
#[derive(Clone, Copy)]
struct Wave {
    n: f64,
    amplitude: f64,
    phase: f64,
}

impl Wave {
    fn at(&self, a: f64) -> f64 {
        self.amplitude * (self.n * a - self.phase).cos()
    }
}

fn turn() -> Turn {
    Turn::new((0..720).map(|k| TAU * f64::from(k) / 720.0).collect()).expect("even angles")
}

fn curve(turn: &Turn, of: impl Fn(f64) -> f64) -> Vec<f64> {
    turn.angle().iter().map(|a| of(*a)).collect()
}

fn contribution(origin: Origin, bias: Vec<f64>) -> Contribution {
    Contribution {
        name: String::new(),
        origin,
        scatter: vec![0.0; bias.len()],
        bias,
        u: None,
    }
}

fn of(turn: &Turn, parts: Vec<Contribution>, part: Option<&[f64]>) -> Balance {
    let removed = Removed {
        centre: true,
        radius: true,
    };
    balance(turn, parts, part.map(|curve| (curve, 0.0)), removed, MOST_WAVES)
}

/// The paper's 60 and 140 um, as waves a quarter of a wave apart.
fn paper() -> [f64; 3] {
    let turn = turn();
    let wave = |amplitude: f64, phase: f64| curve(&turn, |a| amplitude * (2.0 * a - phase).cos());
    let load = contribution(Origin::Load, wave(60e-6, 0.0));
    let unloaded = contribution(Origin::Unloaded, wave(140e-6, 0.25 * TAU));
    let sums = of(&turn, vec![load, unloaded], None).sums;
    [sums.plain, sums.root_sum_square, sums.largest]
}

/// Sums, shares and waves whose values are known.
pub fn checks() -> Vec<Check> {
    let [plain, squares, together] = paper();
    let mut random = Random::seeded(SEED);
    let turn = turn();
    let (mut sums, mut shares, mut likeness) = (Vec::new(), Vec::new(), Vec::new());
    let (mut amplitudes, mut phases, mut datums) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..CIRCLES {
        let mut wave = |n: f64| Wave {
            n,
            amplitude: random.between(20e-6, 150e-6),
            phase: random.between(0.0, TAU),
        };
        // Load and path without load of the same number of waves, and one wave more that each has alone.
        let n = 2.0 + (sums.len() % 4) as f64;
        let [load, path, of_load, of_part] = [wave(n), wave(n), wave(n + 1.0), wave(n + 2.0)];
        let [x, y, radius] = [0.0; 3].map(|_: f64| random.between(-200e-6, 200e-6));
        let offset = |a: f64| x * a.cos() + y * a.sin() + radius;
        let third = |between: f64| {
            let [p, q] = [load.amplitude, path.amplitude];
            (p * p + q * q + 2.0 * p * q * between.cos()).sqrt()
        };
        let both = third(load.phase - path.phase);
        // A single harmonic: its maximum is its amplitude.
        let alone = of(
            &turn,
            vec![
                contribution(Origin::Load, curve(&turn, |a| load.at(a) + offset(a))),
                contribution(Origin::Unloaded, curve(&turn, |a| path.at(a))),
            ],
            None,
        );
        sums.push(alone.sums.largest - both);
        datums.extend([
            alone.datums[0].centre.x - x,
            alone.datums[0].centre.y - y,
            alone.datums[0].radius - radius,
        ]);
        // The part has both, one harmonic that is not predicted, and lacks one that is predicted.
        let part = curve(&turn, |a| load.at(a) + path.at(a) + of_part.at(a) + offset(a));
        let whole = of(
            &turn,
            vec![
                contribution(Origin::Load, curve(&turn, |a| load.at(a) + of_load.at(a))),
                contribution(Origin::Unloaded, curve(&turn, |a| path.at(a) - offset(a))),
            ],
            Some(&part),
        );
        let Some(given) = whole.comparison else {
            shares.push(f64::NAN);
            continue;
        };
        let square = |wave: &Wave| wave.amplitude.powi(2);
        let measured = both * both + square(&of_part);
        let predicted = both * both + square(&of_load);
        shares.push(given.together.explained - (1.0 - (square(&of_part) + square(&of_load)) / measured));
        let alike = both * both / (measured * predicted).sqrt();
        likeness.push(given.together.likeness.map_or(f64::NAN, |found| found - alike));
        let at = |number: f64| given.waves[number as usize - 1];
        amplitudes.extend([
            at(n).measured.amplitude - both,
            at(n).predicted.amplitude - both,
            at(n + 2.0).measured.amplitude - of_part.amplitude,
            at(n + 2.0).predicted.amplitude,
            at(n + 1.0).predicted.amplitude - of_load.amplitude,
        ]);
        let turned = |found: f64, expected: f64| (found - expected + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
        phases.extend([
            turned(at(n + 2.0).measured.phase, of_part.phase),
            turned(at(n + 1.0).predicted.phase, of_load.phase),
            at(n).phase_difference(),
        ]);
    }
    let rounding = |what: &str, reference, errors: Vec<f64>, (tolerance, unit)| {
        let gap = ErrorBound {
            worst: worst(errors),
            tolerance,
            unit,
        };
        Check::computed(what, reference, gap)
    };
    vec![
        rounding(
            "plain sum of 60 and 140 um: 200 um",
            PAPER,
            vec![plain - 200e-6],
            (1e-12, "m"),
        ),
        Check::printed(
            "root of their squares: 152.3155 um",
            CLOSED,
            ErrorBound {
                worst: (squares * 1e6 - 152.3155).abs(),
                tolerance: 5e-5,
                unit: "um",
            },
            6,
        ),
        Check::printed(
            "the same with a phase shift of a quarter period",
            CLOSED,
            ErrorBound {
                worst: (together * 1e6 - 152.3155).abs(),
                tolerance: 0.006,
                unit: "um",
            },
            4,
        ),
        Check::printed(
            format!("harmonics of one order, sum with signs, {CIRCLES} circles"),
            "law of cosines",
            ErrorBound {
                worst: worst(sums) * 1e6,
                tolerance: 0.08,
                unit: "um",
            },
            3,
        ),
        rounding("centre and radius removed", CLOSED, datums, (1e-12, "m")),
        rounding("explained fraction", CLOSED, shares, (1e-9, "")),
        rounding("likeness of the shapes", CLOSED, likeness, (1e-9, "")),
        rounding("amplitudes of harmonics", CLOSED, amplitudes, (1e-12, "m")),
        rounding("their phases", CLOSED, phases, (1e-9, "rad")),
    ]
}

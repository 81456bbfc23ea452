//! Limits of stability of a milling benchmark against a solution by Chebyshev collocation. See README.md.
//!
//! | symbol | value | unit |
//! |---|---|---|
//! | frequency, damping ratio, modal mass | 922, 0.011, 0.03993 | Hz, -, kg |
//! | teeth, Ktc, Krc | 2, 600, 200 | -, N/mm2 |
//! | radial depth over the diameter | 0.05 and 0.5, up- and down-milling | - |

use std::f64::consts::TAU;

use nalgebra::{Vector3, Vector6};

use armill_core::dynamics::Mode;
use armill_core::load::{Cut, Cutter, CuttingLaw, Engagement, Immersion, LeanInCut, Mechanistic, Milling};
use armill_core::stability::{CutOfAnyDepth, StabilityLobes, ZerothOrder, discretisation};

use crate::check::{Check, ErrorBound, worst};

/// The separate program.
const COLLOCATION: &str = "collocation, independent";
/// The closed form of one mode.
const CLOSED: &str = "closed form";

/// Diameter of the cutter, m; limits do not depend on it at a given immersion.
const DIAMETER: f64 = 20e-3;
/// Spindle speeds, rpm.
const SPEEDS_RPM: [f64; 8] = [5e3, 8e3, 10e3, 12e3, 15e3, 18e3, 20e3, 22e3];
/// Limits of the depth at these speeds, mm, to five digits after the point.
const UP_LOW_MM: [f64; 8] = [
    2.14623, 3.49558, 1.65770, 6.23324, 1.88796, 4.43188, 3.77405, 12.00651,
];
/// The same, down-milling of low immersion.
const DOWN_LOW_MM: [f64; 8] = [
    2.20692, 2.16316, 4.09071, 1.68052, 8.21248, 1.29514, 2.29868, 1.74137,
];
/// The same, up-milling of half immersion.
const UP_HALF_MM: [f64; 8] = [
    0.26028, 0.40604, 0.21353, 1.06027, 0.25887, 0.39724, 1.18530, 1.88267,
];
/// The same, down-milling of half immersion.
const DOWN_HALF_MM: [f64; 8] = [
    0.84720, 0.79793, 2.10469, 0.61309, 2.59624, 1.61970, 0.71964, 0.60182,
];
/// Deepest limit sought, m.
const DEEPEST: f64 = 30e-3;

fn mode() -> Mode {
    Mode {
        angular_frequency: 922.0 * TAU,
        damping_ratio: 0.011,
        shape: Vector6::x() / 0.03993_f64.sqrt(),
    }
}

fn cut(immersion: Immersion) -> CutOfAnyDepth {
    let cutter = Cutter::flat(DIAMETER, 2).expect("a cutter of 20 mm exists");
    let law = Mechanistic::new(Vector3::new(600e6, 200e6, 0.0), Vector3::zeros());
    let cut = Cut {
        depth: 1e-3,
        engagement: Engagement::of(immersion, DIAMETER).expect("immersion within the diameter"),
        feed: 1e-4,
        rise: 0.0,
        lean: LeanInCut::default(),
    };
    let law = CuttingLaw::Mechanistic(law.expect("numbers are finite"));
    CutOfAnyDepth::new(&Milling::new(cutter, law, cut).expect("the cut can be made"))
}

/// Limits by semi-discretisation against collocation, and the zeroth-order solution against its closed form.
pub fn checks() -> Vec<Check> {
    let mut checks: Vec<Check> = [
        (
            "up-milling, 0.05 of the diameter",
            Immersion::Up(0.05 * DIAMETER),
            UP_LOW_MM,
        ),
        (
            "down-milling, 0.05 of the diameter",
            Immersion::Down(0.05 * DIAMETER),
            DOWN_LOW_MM,
        ),
        (
            "up-milling, half the diameter",
            Immersion::Up(0.5 * DIAMETER),
            UP_HALF_MM,
        ),
        (
            "down-milling, half the diameter",
            Immersion::Down(0.5 * DIAMETER),
            DOWN_HALF_MM,
        ),
    ]
    .into_iter()
    .map(|(what, immersion, limits)| discretised(what, &cut(immersion), limits))
    .collect();
    checks.push(zeroth_order());
    checks
}

fn discretised(what: &str, cut: &CutOfAnyDepth, limits_mm: [f64; 8]) -> Check {
    let error = |(rpm, limit_mm): (f64, f64)| {
        let found = discretisation::boundary(&[mode()], cut, rpm * TAU / 60.0, DEEPEST);
        match found {
            Ok(Some((boundary, _))) => boundary.depth / (limit_mm * 1e-3) - 1.0,
            _ => f64::INFINITY,
        }
    };
    Check::printed(
        format!("limit of the depth at eight speeds, {what}"),
        COLLOCATION,
        ErrorBound {
            worst: worst(SPEEDS_RPM.into_iter().zip(limits_mm).map(error)),
            tolerance: 0.01,
            unit: "",
        },
        4,
    )
}

/// `2 k zeta (1 + zeta)/K` at any speed, and at the speed of the lobe that has it.
fn zeroth_order() -> Check {
    let cut = cut(Immersion::Slot);
    let per_depth = cut.per_depth(1e-3).expect("the cut can be made");
    let (omega, zeta) = (mode().angular_frequency, 0.011);
    let closed = 2.0 * 0.03993 * omega * omega * zeta * (1.0 + zeta) / -per_depth.m11;
    let solution = ZerothOrder::new(&[mode()], &per_depth, cut.pitch(), DEEPEST);
    let lowest = solution
        .critical()
        .map_or(f64::INFINITY, |boundary| boundary.depth);
    // w T = 2 (theta + k pi) with tan(theta) = Re x/Im x, at w = omega sqrt(1 + 2 zeta).
    let w = omega * (1.0 + 2.0 * zeta).sqrt();
    let theta = (2.0 * zeta * omega * omega).atan2(-2.0 * zeta * omega * w);
    let at_lobes = [1.0, 2.0, 5.0].map(|turns| {
        let period = 2.0 * (theta + turns * std::f64::consts::PI) / w;
        let lobes = StabilityLobes::new(&[mode()], &cut, DEEPEST).expect("the cut can be made");
        let found = lobes.at_speed(cut.pitch() / period);
        found.map_or(f64::INFINITY, |boundary| boundary.depth / closed - 1.0)
    });
    Check::computed(
        "lowest limit of one mode, mean directional factors",
        CLOSED,
        ErrorBound {
            worst: worst(at_lobes.into_iter().chain([lowest / closed - 1.0])),
            tolerance: 1e-9,
            unit: "",
        },
    )
}

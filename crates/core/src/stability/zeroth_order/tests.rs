use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use super::*;
use crate::load::{Cutter, Immersion};
use crate::stability::examples::{arm_and_cutter, benchmark, benchmark_mode, cutting, mode, rpm};

fn half_down() -> (Matrix3<f64>, f64) {
    let cut = benchmark(Immersion::Down(0.01));
    (cut.per_depth(1e-3).unwrap(), cut.pitch())
}

/// `phi^T A_0 phi/b` of the benchmark mode, 1/(kg) N/m^2.
fn directed(per_depth: &Matrix3<f64>) -> f64 {
    per_depth[(0, 0)] / 0.03993
}

#[test]
fn one_mode_has_the_closed_lobes_and_the_closed_lowest_depth() {
    for immersion in [Immersion::Down(0.01), Immersion::Up(0.01), Immersion::Slot] {
        let cut = benchmark(immersion);
        let (per_depth, pitch) = (cut.per_depth(1e-3).unwrap(), cut.pitch());
        let mode = benchmark_mode();
        let solution = ZerothOrder::new(&[mode], &per_depth, pitch, 0.1);
        let alpha = directed(&per_depth);
        let (omega, zeta) = (mode.angular_frequency, mode.damping_ratio);
        if alpha < 0.0 {
            // Tobias, Tlusty: b = 2 k zeta (1 + zeta)/K at w = omega sqrt(1 + 2 zeta).
            let lowest = solution.critical().unwrap();
            let closed = 2.0 * omega * omega * zeta * (1.0 + zeta) / -alpha;
            assert!((lowest.depth / closed - 1.0).abs() < 1e-12, "{immersion:?}");
            let w = omega * (1.0 + 2.0 * zeta).sqrt();
            assert!((lowest.angular_frequency / w - 1.0).abs() < 1e-6);
        }
        let mut on_boundary = 0;
        for step in 1..200 {
            // Frequencies on the side of the resonance where the real part has the sign that the directional factor needs.
            let part = f64::from(step) / 200.0;
            let w = omega * (1.0 - part.powi(2) * 0.5 * alpha.signum());
            let x = Complex::new(omega * omega - w * w, 2.0 * zeta * omega * w) / alpha;
            let depth = x.norm_sqr() / (2.0 * x.re);
            assert!(depth > 0.0);
            for lobe in 0..6 {
                let period = 2.0 * (x.re.atan2(x.im) + f64::from(lobe) * PI) / w;
                if period <= 0.0 || depth > 0.09 {
                    continue;
                }
                let found = solution.at_speed(pitch / period).unwrap();
                assert!(found.depth <= depth * (1.0 + 1e-9), "{} {depth}", found.depth);
                if (found.depth / depth - 1.0).abs() < 1e-9 {
                    on_boundary += 1;
                    assert!((found.angular_frequency / w - 1.0).abs() < 1e-9);
                }
            }
        }
        assert!(on_boundary > 100, "{immersion:?}: {on_boundary}");
    }
}

/// The least depth of all sign changes of a fine scan, without tables, bounds or branches carried from place to place.
fn scanned(gain: &LoopGain, period: Option<f64>, deepest: f64) -> f64 {
    let places = 400_000;
    let end = 3.0 * gain.frequencies().map(|[w, _]| w).fold(0.0, f64::max);
    let mut least = deepest;
    let mut before: Option<[Complex<f64>; 3]> = None;
    for place in 1..=places {
        // Denser at low frequencies, where the arm is.
        let w = end * (f64::from(place) / f64::from(places)).powi(2);
        let turn = period.map_or(Complex::new(1.0, 0.0), |period| {
            (Complex::new(1.0, 0.0) - Complex::from_polar(1.0, -w * period)).inv()
        });
        let depths = gain.depths(w).map(|x| x * turn);
        if let Some(before) = before {
            for y in depths {
                let closest = before
                    .iter()
                    .min_by(|a, b| (*a - y).norm_sqr().total_cmp(&(*b - y).norm_sqr()))
                    .unwrap();
                let is_root = (closest.im > 0.0) != (y.im > 0.0) && (closest - y).norm() < 0.2 * y.norm();
                if is_root && y.re > 0.0 {
                    least = least.min(y.re);
                }
            }
        }
        before = Some(depths);
    }
    least
}

#[test]
fn no_lobe_is_missed_next_to_a_scan_of_400_000_frequencies() {
    let modes = arm_and_cutter();
    let deepest = 0.2;
    let flat = Cutter::flat(0.016, 4).unwrap();
    for immersion in [Immersion::Slot, Immersion::Down(0.004), Immersion::Up(0.003)] {
        let cut = cutting(flat, immersion, [700e6, 250e6, 100e6]);
        let per_depth = cut.per_depth(1e-3).unwrap();
        let solution = ZerothOrder::new(&modes, &per_depth, cut.pitch(), deepest);
        for speed in [900.0, 3100.0, 6000.0, 9650.0, 15_200.0, 21_000.0] {
            let found = solution
                .at_speed(rpm(speed))
                .map_or(deepest, |boundary| boundary.depth);
            let fine = scanned(&solution.gain, Some(cut.pitch() / rpm(speed)), deepest);
            // The scan takes the place after the root: some 1e-3 of the slope of a curve at low frequencies.
            assert!(
                (found / fine - 1.0).abs() < 5e-3,
                "{immersion:?} {speed}: {found} {fine}"
            );
        }
        let found = solution
            .mode_coupling()
            .map_or(deepest, |boundary| boundary.depth);
        let still = |x: Complex<f64>| {
            if x.re > 0.0 && x.im.abs() < 1e-12 * x.re {
                x.re
            } else {
                deepest
            }
        };
        let divergence = solution
            .gain
            .depths(0.0)
            .map(still)
            .into_iter()
            .fold(deepest, f64::min);
        let fine = scanned(&solution.gain, None, deepest).min(divergence);
        assert!((found / fine - 1.0).abs() < 5e-3, "{immersion:?}: {found} {fine}");
    }
}

#[test]
fn two_modes_at_right_angles_couple_at_the_closed_depth() {
    // Tlusty; Pan et al. 2006: two modes along directions u1, u2 of one mass, a force F = b K (n.u) f without regeneration. The
    // characteristic polynomial is s^4 + ... with equal damping rates c = 2 zeta omega: in s' = s^2 + c s its roots are real or a pair
    //   s'^2 + s' (O1 + O2) + O1 O2 - g12 g21 = 0,  O = omega^2 - g_mm,
    // and a complex pair s' = -p +- i q is unstable where q > c sqrt(p).
    let mass = 12.0;
    let rate = 1.5;
    let (f1, f2) = (14.0 * TAU, 16.0 * TAU);
    let directions = [20_f64, 110.0].map(|degrees| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        Vector3::new(cos, sin, 0.0)
    });
    let modes = [(f1, directions[0]), (f2, directions[1])]
        .map(|(omega, direction)| mode([omega / TAU, rate / (2.0 * omega)], direction / f64::sqrt(mass)));
    let normal = Vector3::new(1.0, 0.0, 0.0);
    let mut coupled = 0;
    for degrees in [15.0, 60.0, 75.0, 120.0, 200.0, 250.0, 290.0] {
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        let force = Vector3::new(cos, sin, 0.0) * 8e8;
        let per_depth = force * normal.transpose();
        let solution = ZerothOrder::new(&modes, &per_depth, PI, 1.0);
        let g = |m: usize, n: usize| directions[m].dot(&force) * normal.dot(&directions[n]) / mass;
        let unstable = |b: f64| {
            let [o1, o2] = [f1 * f1 - b * g(0, 0), f2 * f2 - b * g(1, 1)];
            let (half, product) = (0.5 * (o1 + o2), o1 * o2 - b * b * g(0, 1) * g(1, 0));
            let discriminant = half * half - product;
            if discriminant >= 0.0 {
                // Real s': stable while both are negative.
                discriminant.sqrt() >= half
            } else {
                (-discriminant).sqrt() > rate * half.max(0.0).sqrt() || half < 0.0
            }
        };
        let steps = 2_000_000;
        let closed = (1..steps)
            .map(|k| f64::from(k) * 1e-6 * 0.5)
            .find(|b| unstable(*b));
        let found = solution.mode_coupling().map(|boundary| boundary.depth);
        match (found, closed) {
            (Some(found), Some(closed)) => {
                coupled += 1;
                // The closed criterion is tried in steps of half a micrometre.
                assert!((found - closed).abs() < 1e-6, "{degrees}: {found} {closed}");
            }
            (None, None) => {}
            other => assert!(other.0.unwrap_or(1.0) > 0.99, "{degrees}: {other:?}"),
        }
    }
    assert!(coupled >= 4, "{coupled}");
}

#[test]
fn a_stiffer_system_or_a_softer_material_has_a_deeper_boundary_in_proportion() {
    let (per_depth, pitch) = half_down();
    let at = |factor: f64| {
        ZerothOrder::new(&[benchmark_mode()], &(per_depth * factor), pitch, 0.5)
            .at_speed(rpm(9000.0))
            .unwrap()
            .depth
    };
    assert!((at(0.5) / at(1.0) - 2.0).abs() < 1e-9);
}

#[test]
fn a_boundary_deeper_than_the_deepest_and_no_mode_at_all_give_none() {
    let (per_depth, pitch) = half_down();
    let shallow = ZerothOrder::new(&[benchmark_mode()], &per_depth, pitch, 1e-6);
    assert_eq!(shallow.at_speed(rpm(9000.0)), None);
    assert_eq!(shallow.critical(), None);
    let rigid = ZerothOrder::new(&[], &per_depth, pitch, 1.0);
    assert_eq!((rigid.at_speed(100.0), rigid.mode_coupling()), (None, None));
}

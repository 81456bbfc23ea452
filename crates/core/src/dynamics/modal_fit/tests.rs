//! Synthetic FRFs with noise of a fixed sequence.

use std::f64::consts::TAU;

use nalgebra::{Complex, DMatrix, Vector6};

use super::*;
use crate::dynamics::{Mode, receptance};

/// A fixed sequence of numbers with mean 0 and variance 1: sums of four uniform numbers.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = (self.0)
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn next(&mut self) -> f64 {
        let sum: f64 = (0..4).map(|_| self.uniform()).sum();
        (sum - 2.0) * 3.0_f64.sqrt()
    }
}

fn dof(axis: usize) -> Dof {
    Dof { point: 1, axis }
}

fn mode(frequency_hz: f64, damping_ratio: f64, shape: [f64; 3]) -> Mode {
    Mode {
        angular_frequency: frequency_hz * TAU,
        damping_ratio,
        shape: Vector6::new(shape[0], shape[1], shape[2], 0.0, 0.0, 0.0),
    }
}

/// Frequencies from `low` to `high` in steps, Hz.
struct Lines {
    low: f64,
    high: f64,
    step: f64,
}

impl Lines {
    fn angular(&self) -> Vec<f64> {
        let count = ((self.high - self.low) / self.step).round() as usize;
        (0..=count)
            .map(|k| TAU * (self.low + self.step * k as f64))
            .collect()
    }

    fn band(&self) -> [f64; 2] {
        [TAU * self.low, TAU * self.high]
    }
}

/// FRFs of these modes from force along `pairs[k][1]` to displacement along `pairs[k][0]`, with noise (m/N) on both parts.
fn frfs(modes: &[Mode], lines: &Lines, pairs: &[[usize; 2]], noise: f64) -> Vec<Frf> {
    let mut sequence = Noise(2026);
    let mut of_pair = |pair: &[usize; 2]| {
        let angular = lines.angular();
        let exact = angular.iter().map(|w| receptance(modes, *w)[(pair[0], pair[1])]);
        let values: Vec<Complex<f64>> = exact
            .map(|h| h + Complex::new(noise * sequence.next(), noise * sequence.next()))
            .collect();
        Frf {
            response: dof(pair[0]),
            reference: dof(pair[1]),
            weights: vec![1.0; values.len()],
            receptance: values,
            angular_frequencies: angular,
        }
    };
    pairs.iter().map(&mut of_pair).collect()
}

fn fitted(frfs: &[Frf], lines: &Lines, modes: Option<usize>) -> ModalFit {
    let options = FitOptions {
        band: lines.band(),
        modes,
        seeks_weak: true,
    };
    fit(frfs, &options).unwrap()
}

/// Four modes of a cutter, two of them 1 % apart.
fn cutter() -> Vec<Mode> {
    vec![
        mode(420.0, 0.02, [0.5, 0.1, 0.0]),
        mode(1150.0, 0.012, [4.0, 1.0, 0.0]),
        mode(1161.5, 0.013, [-1.0, 3.5, 0.0]),
        mode(2300.0, 0.03, [2.0, -2.0, 0.0]),
    ]
}

const LINES: Lines = Lines {
    low: 200.0,
    high: 3000.0,
    step: 2.0,
};

fn is_within(found: f64, expected: f64, u: f64) {
    assert!((found - expected).abs() <= 3.0 * u, "{found} {expected} {u}");
}

#[test]
fn modes_without_noise_are_found_exactly() {
    let modes = cutter();
    let measured = frfs(&modes, &LINES, &[[0, 0], [1, 0]], 0.0);
    let found = fitted(&measured, &LINES, None);
    assert_eq!(found.modes.len(), 4, "{found:?}");
    for (own, expected) in found.modes.iter().zip(&modes) {
        assert!((own.angular_frequency / expected.angular_frequency - 1.0).abs() < 1e-8);
        assert!((own.damping_ratio / expected.damping_ratio - 1.0).abs() < 1e-6);
        let shape = shape_of(own, &measured).unwrap();
        let sign = expected.shape[0].signum();
        for (phi, axis) in shape.shape.iter().zip([0, 1]) {
            let either = [sign, -sign].map(|sign| (phi - sign * expected.shape[axis]).abs());
            assert!(either[0].min(either[1]) < 1e-5, "{shape:?}");
        }
        assert!(own.phase_deviation.unwrap() < 1e-5);
        assert!((own.collinearity.unwrap() - 1.0).abs() < 1e-9);
    }
}

#[test]
fn modes_with_noise_are_within_their_uncertainty_and_close_ones_are_distinguished() {
    let modes = cutter();
    let measured = frfs(&modes, &LINES, &[[0, 0], [1, 0], [1, 1]], 3e-9);
    let found = fitted(&measured, &LINES, None);
    assert_eq!(found.modes.len(), 4, "{found:?}");
    for (own, expected) in found.modes.iter().zip(&modes) {
        is_within(
            own.angular_frequency,
            expected.angular_frequency,
            own.angular_frequency_u,
        );
        is_within(own.damping_ratio, expected.damping_ratio, own.damping_ratio_u);
        assert!(own.angular_frequency_u < 2e-3 * own.angular_frequency);
        let shape = shape_of(own, &measured).unwrap();
        let same = shape.shape[0] * expected.shape[0] + shape.shape[1] * expected.shape[1];
        let sign = same.signum();
        for axis in 0..2 {
            let u = shape.covariance[(axis, axis)].sqrt();
            is_within(sign * shape.shape[axis], expected.shape[axis], u);
            assert!(u < 0.1 * expected.shape.norm(), "{u}");
        }
    }
    // Receptance from the modes is the input without noise.
    for (k, pair) in [[0, 0], [1, 0], [1, 1]].iter().enumerate() {
        assert!(found.frfs[k].explained > 0.99, "{:?}", found.frfs[k]);
        assert!((found.frfs[k].residual / (3e-9 * 2.0_f64.sqrt()) - 1.0).abs() < 0.05);
        for w in LINES.angular() {
            let exact = receptance(&modes, w)[(pair[0], pair[1])];
            assert!((found.receptance(k, w) - exact).norm() < 3e-9, "{w}");
        }
    }
}

#[test]
fn modes_are_those_of_another_program() {
    // scipy 1.17.1, least_squares(method="lm") over all 8 + 18 parameters at once with numerical derivatives, on the same FRFs (the same
    // sequence of noise, made in Python): frequency in Hz, damping ratio, residues of xx, yx, yy in 1/kg; standard uncertainties from its
    // Jacobian.
    let expected = [
        [420.0103455, 0.0199639113, 0.24984039, 0.04992304, 0.0101645],
        [1150.0026811, 0.0120030999, 16.0047508, 3.9978785, 1.0059117],
        [1161.5042320, 0.0129964638, 0.9974686, -3.4975551, 12.2431201],
        [2299.9659733, 0.0300434567, 4.0005322, -3.9983210, 4.0033959],
    ];
    let uncertainties = [
        [1.062_949e-2, 3.654_136e-5],
        [2.557_293e-3, 2.218_936e-6],
        [4.463_374e-3, 3.065_974e-6],
        [5.069_322e-2, 3.195_643e-5],
    ];
    let measured = frfs(&cutter(), &LINES, &[[0, 0], [1, 0], [1, 1]], 3e-9);
    let found = fitted(&measured, &LINES, Some(4));
    for ((own, expected), [u_frequency, u_damping]) in found.modes.iter().zip(&expected).zip(&uncertainties) {
        // Its weights of the three FRFs are equal, ours are from their residuals: within a tenth of the uncertainty.
        assert!(
            (own.angular_frequency / TAU - expected[0]).abs() < 0.1 * u_frequency,
            "{own:?}"
        );
        assert!(
            (own.damping_ratio - expected[1]).abs() < 0.1 * u_damping,
            "{own:?}"
        );
        assert!(
            (own.angular_frequency_u / TAU / u_frequency - 1.0).abs() < 0.1,
            "{own:?}"
        );
        assert!((own.damping_ratio_u / u_damping - 1.0).abs() < 0.1, "{own:?}");
        for k in 0..3 {
            let u = own.residues_covariance[(k, k)].sqrt();
            assert!((own.residues[k] - expected[2 + k]).abs() < 0.1 * u, "{k} {own:?}");
        }
    }
}

#[test]
fn uncertainties_are_the_scatter_of_repeated_measurements() {
    let modes = [
        mode(150.0, 0.02, [0.3, 0.0, 0.0]),
        mode(166.0, 0.025, [0.25, 0.0, 0.0]),
    ];
    let lines = Lines {
        low: 100.0,
        high: 220.0,
        step: 0.5,
    };
    let exact = frfs(&modes, &lines, &[[0, 0]], 0.0);
    let mut sequence = Noise(7);
    let mut squares = [0.0; 6];
    let runs = 60;
    for _ in 0..runs {
        let mut noisy = exact.clone();
        for h in &mut noisy[0].receptance {
            *h += Complex::new(2e-9 * sequence.next(), 2e-9 * sequence.next());
        }
        let found = fitted(&noisy, &lines, Some(2));
        for (k, (own, expected)) in found.modes.iter().zip(&modes).enumerate() {
            let residue_u = own.residues_covariance[(0, 0)].sqrt();
            for (part, ratio) in [
                (own.angular_frequency - expected.angular_frequency) / own.angular_frequency_u,
                (own.damping_ratio - expected.damping_ratio) / own.damping_ratio_u,
                (own.residues[0] - expected.shape[0].powi(2)) / residue_u,
            ]
            .into_iter()
            .enumerate()
            {
                squares[3 * k + part] += ratio * ratio / f64::from(runs);
            }
        }
    }
    // Of 60 runs the mean square of a normalised error has the standard deviation sqrt(2/60) = 0.18.
    assert!(
        squares.iter().all(|square| (0.45..1.6).contains(square)),
        "{squares:?}"
    );
}

#[test]
fn residuals_describe_modes_outside_the_band_and_narrow_bands_are_fitted() {
    let mut modes = cutter();
    modes.push(mode(9000.0, 0.02, [5.0, 1.0, 0.0]));
    let lines = Lines {
        low: 2000.0,
        high: 2600.0,
        step: 2.0,
    };
    let measured = frfs(&modes, &lines, &[[0, 0]], 1e-10);
    let found = fitted(&measured, &lines, Some(1));
    assert_eq!(found.modes.len(), 1);
    let own = &found.modes[0];
    assert!(
        (own.angular_frequency / (TAU * 2300.0) - 1.0).abs() < 1e-3,
        "{own:?}"
    );
    assert!((own.damping_ratio - 0.03).abs() < 5e-4, "{own:?}");
    assert!((own.residues[0] - 4.0).abs() < 0.15, "{own:?}");
    // Receptance with the two residuals; without them the modes below and above are missing: 7.8e-9 m/N by the one above alone.
    for w in lines.angular() {
        let exact = receptance(&modes, w)[(0, 0)];
        assert!((found.receptance(0, w) - exact).norm() < 5e-9, "{w}");
    }
}

#[test]
fn a_complex_mode_is_reported() {
    let lines = Lines {
        low: 50.0,
        high: 150.0,
        step: 0.25,
    };
    let mut measured = frfs(
        &[mode(100.0, 0.02, [0.2, 0.1, 0.0])],
        &lines,
        &[[0, 0], [1, 0]],
        1e-10,
    );
    // The residue of the second FRF turned by 30 degrees: R e^(i 30 deg) in place of R.
    let (omega, zeta) = (TAU * 100.0, 0.02);
    let damped = omega * (1.0_f64 - zeta * zeta).sqrt();
    let pole = Complex::new(-zeta * omega, damped);
    let residue = Complex::new(0.0, -0.02 / (2.0 * damped)) * Complex::from_polar(1.0, 30.0_f64.to_radians());
    let values = measured[1].angular_frequencies.iter().map(|w| {
        let s = Complex::new(0.0, *w);
        residue / (s - pole) + residue.conj() / (s - pole.conj())
    });
    measured[1].receptance = values.collect();
    let found = fitted(&measured, &lines, Some(1));
    // |R| of the FRFs is 0.04 and 0.02 in the same unit: a mean of 10 degrees.
    let deviation = found.modes[0].phase_deviation.unwrap().to_degrees();
    assert!((deviation - 10.0).abs() < 1.5, "{deviation}");
    assert!(found.modes[0].collinearity.unwrap() < 0.95);
}

#[test]
fn too_few_frequencies_no_frfs_and_noise_alone_are_refused() {
    let options = FitOptions {
        band: LINES.band(),
        modes: None,
        seeks_weak: true,
    };
    assert_eq!(fit(&[], &options), Err(FitError::NoFrfs));
    let measured = frfs(&cutter(), &LINES, &[[0, 0]], 0.0);
    let narrow = FitOptions {
        band: [TAU * 300.0, TAU * 310.0],
        modes: None,
        seeks_weak: true,
    };
    assert_eq!(fit(&measured, &narrow), Err(FitError::TooFew(6)));
    let mut zero = measured.clone();
    zero[0].receptance.fill(Complex::new(0.0, 0.0));
    assert_eq!(fit(&zero, &options), Err(FitError::NoMode));
}

#[test]
fn noise_alone_has_no_modes() {
    for pairs in [&[[0, 0]][..], &[[0, 0], [1, 0], [1, 1]]] {
        let options = FitOptions {
            band: LINES.band(),
            modes: None,
            seeks_weak: true,
        };
        assert_eq!(
            fit(&frfs(&[], &LINES, pairs, 3e-9), &options),
            Err(FitError::NoMode)
        );
    }
}

/// A strong mode, and one whose peak is a thousandth of it: three times the noise.
fn strong_and_weak() -> Vec<Mode> {
    vec![
        mode(1150.0, 0.012, [4.0, 1.0, 0.0]),
        mode(1700.0, 0.01, [0.14, 0.1, 0.0]),
    ]
}

#[test]
fn a_weak_mode_is_found_in_the_residuals_of_a_strong_one() {
    let modes = strong_and_weak();
    let measured = frfs(&modes, &LINES, &[[0, 0], [1, 0]], 3e-9);
    let found = fitted(&measured, &LINES, None);
    assert_eq!(found.modes.len(), 2, "{found:?}");
    for (own, expected) in found.modes.iter().zip(&modes) {
        is_within(
            own.angular_frequency,
            expected.angular_frequency,
            own.angular_frequency_u,
        );
        is_within(own.damping_ratio, expected.damping_ratio, own.damping_ratio_u);
        is_within(
            own.residues[0],
            expected.shape[0].powi(2),
            own.residues_covariance[(0, 0)].sqrt(),
        );
    }
}

#[test]
fn noise_in_the_residuals_is_no_mode() {
    // Twenty sequences of noise on a strong mode: one mode each.
    let exact = frfs(&strong_and_weak()[..1], &LINES, &[[0, 0]], 0.0);
    let mut sequence = Noise(11);
    for run in 0..20 {
        let mut noisy = exact.clone();
        for h in &mut noisy[0].receptance {
            *h += Complex::new(3e-9 * sequence.next(), 3e-9 * sequence.next());
        }
        let found = fitted(&noisy, &LINES, None);
        assert_eq!(found.modes.len(), 1, "{run}: {:?}", found.modes);
    }
}

#[test]
fn correlated_noise_in_the_residuals_is_no_mode() {
    // Averages of five neighbours: what an exponential window makes of noise.
    let exact = frfs(&strong_and_weak()[..1], &LINES, &[[0, 0]], 0.0);
    let mut sequence = Noise(13);
    for run in 0..10 {
        let count = exact[0].receptance.len();
        let noise: Vec<Complex<f64>> = (0..count + 4)
            .map(|_| Complex::new(3e-9 * sequence.next(), 3e-9 * sequence.next()))
            .collect();
        let mut noisy = exact.clone();
        for (k, h) in noisy[0].receptance.iter_mut().enumerate() {
            *h += noise[k..k + 5].iter().sum::<Complex<f64>>() / 5.0_f64.sqrt();
        }
        let found = fitted(&noisy, &LINES, None);
        assert_eq!(found.modes.len(), 1, "{run}: {:?}", found.modes);
    }
}

fn with_residues(residues: &[f64]) -> FittedMode {
    FittedMode {
        angular_frequency: 1.0,
        angular_frequency_u: 0.0,
        damping_ratio: 0.01,
        damping_ratio_u: 0.0,
        residues: residues.to_vec(),
        residues_covariance: DMatrix::identity(residues.len(), residues.len()) * 0.01,
        phase_deviation: None,
        collinearity: None,
    }
}

#[test]
fn the_drive_point_gives_the_scale_of_a_shape_and_its_uncertainty() {
    let measured = frfs(&cutter(), &LINES, &[[0, 0], [1, 0]], 0.0);
    let shape = shape_of(&with_residues(&[4.0, -6.0]), &measured).unwrap();
    // The larger part is positive: phi = (-2, 3).
    assert!(
        (shape.shape[0] + 2.0).abs() < 1e-12 && (shape.shape[1] - 3.0).abs() < 1e-12,
        "{shape:?}"
    );
    // u(phi_x) = u(a) / (2 phi_x); u(phi_y)^2 = (u(a)/phi_x)^2 + (phi_y u(phi_x)/phi_x)^2
    assert!((shape.covariance[(0, 0)] - 0.01 / 16.0).abs() < 1e-12);
    let expected = 0.01 / 4.0 + (1.5_f64).powi(2) * 0.01 / 16.0;
    assert!((shape.covariance[(1, 1)] - expected).abs() < 1e-12);

    let off = frfs(&cutter(), &LINES, &[[1, 0]], 0.0);
    assert_eq!(shape_of(&with_residues(&[1.0]), &off), Err(NoShape::NoDrivePoint));
    assert_eq!(
        shape_of(&with_residues(&[-4.0, 6.0]), &measured),
        Err(NoShape::NotVisible)
    );
    let apart = frfs(&cutter(), &LINES, &[[0, 0], [2, 1]], 0.0);
    assert_eq!(
        shape_of(&with_residues(&[4.0, 1.0]), &apart),
        Err(NoShape::NotDetermined)
    );
    assert_eq!(connected(&apart), [vec![0], vec![1]]);
    assert_eq!(
        connected(&frfs(&cutter(), &LINES, &[[0, 0], [1, 1], [1, 0]], 0.0)),
        [vec![0, 1, 2]]
    );
}

//! Release of a force: the motion of the tool when a load on it stops at once, as the thrust of a drill at breakthrough.
//!
//! ```text
//! s(t) = F sum of (phi.n)^2/omega^2 (1 - e^(-zeta omega t) (cos(omega_d t) + zeta omega/omega_d sin(omega_d t)))
//! ds/dt = F sum of (phi.n)^2/omega_d e^(-zeta omega t) sin(omega_d t)        omega_d = omega sqrt(1 - zeta^2)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `F`, `n` | force that stops, and the unit vector against it: where the tool moves | N, - |
//! | `s` | way of the tool along `n` from where it was loaded | m |
//! | `phi`, `omega`, `zeta` | modes as in [`super::mode`], translation of the tool | |
//!
//! The loaded tool is at rest before. One mode moves by `e^(-pi zeta/sqrt(1 - zeta^2))` of its deflection beyond its place without load, and its speed is at most
//! `F |phi.n|^2/omega`, or `F/sqrt(k m)`, without damping. Source: step response of damped oscillators, any text on vibration.

use nalgebra::Vector3;

use super::mode::Mode;

/// Times in a period of the fastest mode.
const PER_PERIOD: f64 = 24.0;
/// Periods of the slowest mode that are searched: its first two, in which sums of modes with some damping are largest.
const PERIODS: f64 = 2.0;
/// Times at most.
const MOST_TIMES: f64 = 20_000.0;
/// Modes with a smaller part of the greatest speed of all together are too small to set the steps of time.
const SMALL: f64 = 1e-3;
/// Halvings of a step around the largest value.
const REFINEMENTS: usize = 30;

/// The motion of the tool after a force has stopped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Release {
    /// Elastic deflection that is released: the way from the loaded place to the one without load, m.
    pub deflection: f64,
    /// Largest way beyond the place without load, m.
    pub overshoot: f64,
    /// Greatest speed along the way, m/s.
    pub peak_speed: f64,
    /// When it has this speed after the release, s.
    pub peak_time: f64,
}

/// The motion along `n`, a unit vector, after a `force` (N) against it has stopped.
pub fn release(modes: &[Mode], n: &Vector3<f64>, force: f64) -> Release {
    // Of each mode that moves along n: (phi.n)^2, omega, zeta, omega_d.
    let moving: Vec<[f64; 4]> = modes
        .iter()
        .map(|mode| {
            let along = mode.shape.fixed_rows::<3>(0).dot(n);
            let (omega, zeta) = (mode.angular_frequency, mode.damping_ratio);
            [along * along, omega, zeta, omega * (1.0 - zeta * zeta).sqrt()]
        })
        .filter(|[square, ..]| *square > 0.0)
        .collect();
    let deflection = force
        * moving
            .iter()
            .map(|[square, omega, ..]| square / (omega * omega))
            .sum::<f64>();
    let speed = |time: f64| {
        let parts = moving.iter().map(|[square, omega, zeta, damped]| {
            square / damped * (-zeta * omega * time).exp() * (damped * time).sin()
        });
        force * parts.sum::<f64>()
    };
    let beyond = |time: f64| {
        let parts = moving.iter().map(|[square, omega, zeta, damped]| {
            let (sin, cos) = (damped * time).sin_cos();
            square / (omega * omega) * (-zeta * omega * time).exp() * (cos + zeta * omega / damped * sin)
        });
        -force * parts.sum::<f64>()
    };
    let (peak_time, peak_speed) = largest(&moving, &speed);
    let (_, overshoot) = largest(&moving, &beyond);
    Release {
        deflection,
        overshoot: overshoot.max(0.0),
        peak_speed,
        peak_time,
    }
}

/// The largest value of a function of time after the release, and its time, s; zero without modes.
fn largest(moving: &[[f64; 4]], value: &dyn Fn(f64) -> f64) -> (f64, f64) {
    let all: f64 = moving.iter().map(|[square, omega, ..]| square / omega).sum();
    let counts = |mode: &&[f64; 4]| mode[0] / mode[1] > SMALL * all;
    let damped = || moving.iter().filter(counts).map(|mode| mode[3]);
    let (slowest, fastest) = (
        damped().fold(f64::INFINITY, f64::min),
        damped().fold(0.0, f64::max),
    );
    if !(fastest > 0.0 && slowest.is_finite()) {
        return (0.0, 0.0);
    }
    let end = PERIODS * std::f64::consts::TAU / slowest;
    let count = (end * fastest / std::f64::consts::TAU * PER_PERIOD)
        .ceil()
        .min(MOST_TIMES);
    let step = end / count;
    let times = (0..=count as usize).map(|k| k as f64 * step);
    let best = times
        .map(|time| (time, value(time)))
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .unwrap_or((0.0, 0.0));
    // By thirds around it.
    let (mut low, mut high) = ((best.0 - step).max(0.0), best.0 + step);
    for _ in 0..REFINEMENTS {
        let [a, b] = [1.0 / 3.0, 2.0 / 3.0].map(|part| low + part * (high - low));
        if value(a) < value(b) {
            low = a;
        } else {
            high = b;
        }
    }
    let time = 0.5 * (low + high);
    (time, value(time).max(best.1))
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector6;

    use super::*;

    fn mode(frequency_hz: f64, damping_ratio: f64, along: f64) -> Mode {
        Mode {
            angular_frequency: frequency_hz * std::f64::consts::TAU,
            damping_ratio,
            shape: Vector6::new(0.0, 0.0, along, 0.0, 0.0, 0.0),
        }
    }

    #[test]
    fn one_mode_has_the_closed_form() {
        // 200 kg on 1e6 N/m, 500 N.
        let (mass, stiffness, force) = (200.0_f64, 1e6_f64, 500.0);
        for zeta in [0.001_f64, 0.05, 0.4] {
            let hz = (stiffness / mass).sqrt() / std::f64::consts::TAU;
            let found = release(&[mode(hz, zeta, mass.sqrt().recip())], &Vector3::z(), force);
            let root = (1.0 - zeta * zeta).sqrt();
            let omega = (stiffness / mass).sqrt();
            let speed = force / (stiffness * mass).sqrt() * (-zeta / root * (root / zeta).atan()).exp();
            assert!((found.deflection / (force / stiffness) - 1.0).abs() < 1e-12);
            assert!(
                (found.peak_speed / speed - 1.0).abs() < 1e-6,
                "{zeta} {found:?} {speed}"
            );
            assert!((found.peak_time - (root / zeta).atan() / (omega * root)).abs() < 1e-5);
            let overshoot = force / stiffness * (-zeta * std::f64::consts::PI / root).exp();
            assert!(
                (found.overshoot / overshoot - 1.0).abs() < 1e-6,
                "{zeta} {found:?}"
            );
        }
    }

    #[test]
    fn two_modes_move_as_their_equations_summed_in_small_steps() {
        let modes = [mode(8.0, 0.03, 0.06), mode(31.0, 0.02, 0.09)];
        let force = 300.0;
        let found = release(&modes, &Vector3::z(), force);
        // Semi-implicit Euler steps of each modal coordinate from its static deflection against z.
        let mut states: Vec<[f64; 2]> = modes
            .iter()
            .map(|mode| [-mode.shape[2] * force / mode.angular_frequency.powi(2), 0.0])
            .collect();
        let (step, mut speed, mut beyond) = (1e-6, 0.0_f64, 0.0_f64);
        for _ in 0..250_000 {
            let (mut x, mut v) = (0.0, 0.0);
            for (mode, state) in modes.iter().zip(&mut states) {
                let omega = mode.angular_frequency;
                state[1] -= step * (omega * omega * state[0] + 2.0 * mode.damping_ratio * omega * state[1]);
                state[0] += step * state[1];
                x += mode.shape[2] * state[0];
                v += mode.shape[2] * state[1];
            }
            (speed, beyond) = (speed.max(v), beyond.max(x));
        }
        assert!((found.peak_speed / speed - 1.0).abs() < 1e-3, "{found:?} {speed}");
        assert!(
            (found.overshoot / beyond - 1.0).abs() < 1e-3,
            "{found:?} {beyond}"
        );
    }

    #[test]
    fn modes_across_do_not_move_and_none_is_no_motion() {
        let across = release(&[mode(8.0, 0.03, 0.06)], &Vector3::x(), 300.0);
        assert_eq!([across.deflection, across.overshoot, across.peak_speed], [0.0; 3]);
        assert_eq!(release(&[], &Vector3::z(), 300.0).peak_speed, 0.0);
    }
}

//! One step of a mode in closed form, under a force that is linear in time within the step.
//!
//! ```text
//! d2eta/dt2 + 2 zeta omega deta/dt + omega^2 eta = f_0 (1 - s/h) + f_1 s/h        0 <= s <= h
//! (eta, v/omega) at h = E (eta, v/omega) at 0 + a f_0 + b f_1        v = deta/dt
//! g(s) = e^(-zeta omega s) sin(omega_d s)/omega_d        omega_d = omega sqrt(1 - zeta^2)
//! a = integral of (g, g'/omega)(h - s) (1 - s/h) ds      b = integral of (g, g'/omega)(h - s) s/h ds
//! ```
//!
//! The integrals are in closed form (a particular solution that is linear in time), and by three-point Gauss quadrature
//! where `omega h` is so small that the closed form would lose its digits: `g` is then a polynomial up to rounding.

use crate::dynamics::Mode;

/// Transition of a mode over one step.
#[derive(Clone, Copy, Debug)]
pub(super) struct ModalStep {
    /// `E`, on `(eta, v/omega)`.
    pub(super) free: [[f64; 2]; 2],
    /// `a`: of the force at the begin of the step, s²
    pub(super) first: [f64; 2],
    /// `b`: of the force at its end, s²
    pub(super) last: [f64; 2],
}

/// Turn of a mode within a step below which integrals are by quadrature.
const SMALL_TURN: f64 = 0.02;
/// Gauss-Legendre nodes and weights on (0, 1).
const NODES: [[f64; 2]; 3] = [
    [0.112_701_665_379_258_31, 5.0 / 18.0],
    [0.5, 8.0 / 18.0],
    [0.887_298_334_620_741_7, 5.0 / 18.0],
];

impl ModalStep {
    /// Of this mode (damping ratio below 1) over the time `h` (s).
    pub(super) fn new(mode: &Mode, h: f64) -> ModalStep {
        let (omega, zeta) = (mode.angular_frequency, mode.damping_ratio);
        let damped = (1.0 - zeta * zeta).sqrt();
        // Of unit velocity/omega and of its rate, over omega.
        let impulse = |s: f64| {
            let (sin, cos) = (omega * damped * s).sin_cos();
            let decay = (-zeta * omega * s).exp();
            let g = decay * sin / damped;
            [g, decay * cos - zeta * g]
        };
        let [g, rate] = impulse(h);
        let free = [[rate + 2.0 * zeta * g, g], [-g, rate]];
        let (first, last) = if omega * h < SMALL_TURN {
            let mut sums = [[0.0; 2]; 2];
            for [node, weight] in NODES {
                let value = impulse(h * (1.0 - node));
                for (sum, shape) in sums.iter_mut().zip([1.0 - node, node]) {
                    for (part, value) in sum.iter_mut().zip(value) {
                        *part += weight * h * shape * value / omega;
                    }
                }
            }
            (sums[0], sums[1])
        } else {
            let (static_gain, turn) = (1.0 / (omega * omega), omega * h);
            // Particular solution of (f_0, f_1): slope (per omega) and value at the begin.
            let response = |f: [f64; 2]| {
                let slope = static_gain * (f[1] - f[0]) / turn;
                let value = static_gain * f[0] - 2.0 * zeta * slope;
                [
                    value + slope * turn - free[0][0] * value - free[0][1] * slope,
                    slope - free[1][0] * value - free[1][1] * slope,
                ]
            };
            (response([1.0, 0.0]), response([0.0, 1.0]))
        };
        ModalStep { free, first, last }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector6;

    use super::*;

    fn mode(omega: f64, zeta: f64) -> Mode {
        Mode {
            angular_frequency: omega,
            damping_ratio: zeta,
            shape: Vector6::zeros(),
        }
    }

    #[test]
    fn a_step_is_many_small_ones() {
        // One large step (closed form) against thousands of small ones (quadrature), under the same linear force.
        let mode = mode(50.0, 0.05);
        let (h, pieces) = (0.05, 4000);
        let [f0, f1] = [2.0, -3.0];
        let whole = ModalStep::new(&mode, h);
        let small = ModalStep::new(&mode, h / f64::from(pieces));
        let start = [0.3, -0.2];
        let apply = |step: &ModalStep, x: [f64; 2], f: [f64; 2]| {
            [0, 1].map(|r| {
                step.free[r][0] * x[0] + step.free[r][1] * x[1] + step.first[r] * f[0] + step.last[r] * f[1]
            })
        };
        let at_once = apply(&whole, start, [f0, f1]);
        let mut x = start;
        for piece in 0..pieces {
            let [a, b] = [piece, piece + 1].map(|k| f0 + (f1 - f0) * f64::from(k) / f64::from(pieces));
            x = apply(&small, x, [a, b]);
        }
        for (one, many) in at_once.iter().zip(x) {
            assert!((one - many).abs() < 1e-11, "{one} {many}");
        }
    }

    #[test]
    fn both_ways_agree_at_their_limit_and_a_constant_force_keeps_the_static_displacement() {
        let omega = 100.0;
        let [below, above] = [0.999_999, 1.000_001].map(|part| {
            let step = ModalStep::new(&mode(omega, 0.02), part * SMALL_TURN / omega);
            [step.first, step.last]
        });
        for (below, above) in below.iter().flatten().zip(above.iter().flatten()) {
            // The steps differ by 2e-6, integrals of at most the second power by twice that.
            assert!((below - above).abs() < 1e-5 * above.abs(), "{below} {above}");
        }
        let step = ModalStep::new(&mode(omega, 0.02), 0.01);
        let still = 1.0 / (omega * omega);
        let after = step.free[0][0] * still + step.first[0] + step.last[0];
        assert!((after - still).abs() < 1e-15);
    }
}

//! Stability of milling by the multi-frequency solution: harmonics of the directional factors.
//!
//! ```text
//! u_p = b (1 - e^(-i w T)) G(w + p w_T) sum over q of A_(p-q)/b u_q        |p|, |q| <= r
//! A_r = 1/T integral over T of A(t) e^(-i r w_T t) dt
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `u_p` | amplitude of the displacement at `w + p w_T` | m |
//! | `w_T`, `T` | tooth passing frequency, period of the teeth | rad/s, s |
//! | `A_r`, `b` | harmonic of the directional matrix, depth of cut | N/m, m |
//!
//! `w` and `w + w_T` are the same motion, so `w` from 0 to `w_T/2` has all boundaries; at `w_T/2`, evaluated with `p`
//! from `-r - 1` so that frequencies are in pairs, they are period doublings (not sought with `r = 0`). The
//! depth is found as in [`super::zeroth_order`]: a reciprocal eigenvalue `x` with `Im(x e^(i (w T/2 - pi/2))) = 0`. The frequency is
//! scanned at [`SCAN`] places and halved where an eigenvalue changes by more than a third of itself, at most [`MOST_HALVINGS`] times.
//!
//! With a helix the matrix is not proportional to the depth: it is that of the given milling, and the result the depth at which the matrix
//! of the given cut, scaled, is at the boundary.
//!
//! Source: Budak, Altintas, J. Dyn. Syst. Meas. Control 120 (1998) 22; Merdol, Altintas, J. Manuf. Sci. Eng. 126 (2004) 459 \[both
//! recalled\].

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Complex, DMatrix, Matrix3, Schur};

use crate::dynamics::{Mode, receptance};
use crate::load::Milling;

/// First places of the frequency from 0 to half the tooth passing frequency.
pub const SCAN: usize = 128;
/// Most halvings between two of them.
pub const MOST_HALVINGS: u32 = 8;
/// Largest change of an eigenvalue from place to place, in parts of itself.
const STEP: f64 = 0.33;
/// PeriodSteps of a pitch from which harmonics are computed.
const STEPS: usize = 512;
/// Iterations of the Schur decomposition per dimension.
const ITERATIONS: usize = 100;
/// Imaginary part over modulus up to which an eigenvalue at half the tooth passing frequency is real.
const REAL: f64 = 1e-7;

/// The system at one spindle speed.
struct System<'a> {
    modes: &'a [Mode],
    /// `A_r` over the depth, from `-2 r - 1` to `2 r + 1`.
    harmonics: Vec<Matrix3<Complex<f64>>>,
    order: usize,
    period: f64,
}

/// The lowest boundary at this spindle speed (rad/s, above zero) with harmonics up to `order`: depth (m) and angular frequency (rad/s,
/// below half the tooth passing frequency); `None` if it is deeper than `deepest` (m).
pub fn boundary(
    modes: &[Mode],
    milling: &Milling,
    spindle: f64,
    order: usize,
    deepest: f64,
) -> Option<(f64, f64)> {
    let system = System::new(modes, milling, spindle, order);
    let half = PI / system.period;
    let mut best: Option<(f64, f64)> = None;
    let mut consider = |depth: f64, w: f64| {
        if depth > 0.0 && depth <= deepest && best.is_none_or(|(least, _)| depth < least) {
            best = Some((depth, w));
        }
    };
    let mut before = (0.0, system.depths(0.0));
    for place in 1..=SCAN {
        let w = half * place as f64 / SCAN as f64;
        let here = (w, system.depths(w));
        system.roots_between([&before, &here], MOST_HALVINGS, &mut consider);
        before = here;
    }
    if order > 0 {
        // With frequencies in pairs about zero, where period doubling has real eigenvalues.
        let depths = system.depths_of(half, order + 1);
        for x in depths.iter().filter(|x| x.im.abs() <= REAL * x.norm()) {
            consider(0.5 * x.re, half);
        }
    }
    best
}

impl System<'_> {
    fn new<'a>(modes: &'a [Mode], milling: &Milling, spindle: f64, order: usize) -> System<'a> {
        let steps = milling.directional_over_pitch(STEPS);
        let depth = milling.cut().depth;
        let harmonic = |r: isize| {
            let mut sum = Matrix3::zeros();
            for (index, step) in steps.iter().enumerate() {
                let angle = -2.0 * PI * r as f64 * (index as f64 + 0.5) / STEPS as f64;
                let turn = Complex::from_polar(1.0 / (STEPS as f64 * depth), angle);
                sum += step.map(|value| turn * value);
            }
            sum
        };
        let most = 2 * order as isize + 1;
        System {
            modes,
            harmonics: (-most..=most).map(harmonic).collect(),
            order,
            period: milling.cutter().pitch() / spindle,
        }
    }

    /// Reciprocal eigenvalues at `w`, the smaller moduli first.
    fn depths(&self, w: f64) -> Vec<Complex<f64>> {
        self.depths_of(w, self.order)
    }

    /// The same with orders of the tooth passing frequency from `-below` upwards.
    fn depths_of(&self, w: f64, below: usize) -> Vec<Complex<f64>> {
        let blocks = below + self.order + 1;
        let passing = 2.0 * PI / self.period;
        let mut matrix = DMatrix::<Complex<f64>>::zeros(3 * blocks, 3 * blocks);
        for p in 0..blocks {
            let at_tip = receptance(self.modes, w + (p as f64 - below as f64) * passing);
            let at_tip: Matrix3<Complex<f64>> = at_tip.fixed_view::<3, 3>(0, 0).into();
            for q in 0..blocks {
                let harmonic = self.harmonics[p + 2 * self.order + 1 - q];
                matrix
                    .fixed_view_mut::<3, 3>(3 * p, 3 * q)
                    .copy_from(&(at_tip * harmonic));
            }
        }
        let largest = matrix.iter().map(|entry| entry.norm()).fold(0.0, f64::max);
        if largest == 0.0 {
            return Vec::new();
        }
        let scaled = matrix.map(|entry| entry / largest);
        let Some(schur) = Schur::try_new(scaled, f64::EPSILON, ITERATIONS * 3 * blocks) else {
            return Vec::new();
        };
        let (_, triangular) = schur.unpack();
        let mut depths: Vec<Complex<f64>> = triangular
            .diagonal()
            .iter()
            .filter(|value| value.norm() > 1e-9)
            .map(|value| (value * largest).inv())
            .collect();
        depths.sort_by(|a, b| a.norm_sqr().total_cmp(&b.norm_sqr()));
        depths
    }

    fn roots_between(
        &self,
        [from, to]: [&(f64, Vec<Complex<f64>>); 2],
        left: u32,
        consider: &mut impl FnMut(f64, f64),
    ) {
        let pairs = pairs(&from.1, &to.1);
        let jumps = |(a, b): &(Complex<f64>, Complex<f64>)| (a - b).norm() > STEP * a.norm().min(b.norm());
        if left > 0 && pairs.iter().any(jumps) {
            let w = 0.5 * (from.0 + to.0);
            let middle = (w, self.depths(w));
            self.roots_between([from, &middle], left - 1, consider);
            self.roots_between([&middle, to], left - 1, consider);
            return;
        }
        for (a, b) in pairs {
            let at =
                |w: f64, x: Complex<f64>| x * Complex::from_polar(1.0, 0.5 * w * self.period - FRAC_PI_2);
            let [low, high] = [at(from.0, a), at(to.0, b)];
            if (low.im > 0.0) == (high.im > 0.0) {
                continue;
            }
            let part = low.im / (low.im - high.im);
            let w = from.0 + (to.0 - from.0) * part;
            let z = at(w, a + (b - a) * part);
            consider(z.re / (2.0 * (0.5 * w * self.period).sin()), w);
        }
    }
}

/// Values of two neighbouring places that belong together: the closest first.
fn pairs(a: &[Complex<f64>], b: &[Complex<f64>]) -> Vec<(Complex<f64>, Complex<f64>)> {
    let mut free: Vec<Complex<f64>> = b.to_vec();
    let mut found = Vec::with_capacity(a.len());
    for x in a {
        let distance = |y: &Complex<f64>| (y - x).norm_sqr() / (y.norm_sqr() + x.norm_sqr());
        let closest = (0..free.len()).min_by(|i, j| distance(&free[*i]).total_cmp(&distance(&free[*j])));
        if let Some(index) = closest {
            found.push((*x, free.swap_remove(index)));
        }
    }
    found
}

#[cfg(test)]
mod tests;

//! Poles of several FRFs by least squares with a common denominator (LSCF).
//!
//! ```text
//! H_k(w) ~ B_k(z) / A(z)      z = exp(-i (w - w_0) dt)      sum over k, w of  g^2 |B_k(z) - H_k A(z)|^2 -> least,  a_n = 1
//! M = sum_k ( T_k - S_k^H R_k^-1 S_k )      M a = 0 in its first n rows      p = -ln(z)/dt + i w_0,  A(z) = 0
//! R_ij = sum g^2 z^(j-i)      S_ij = -sum g^2 H z^(j-i)      T_ij = sum g^2 |H|^2 z^(j-i)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `H_k`, `g` | FRF k and its weight at one frequency | m/N, N/m |
//! | `A`, `B_k` | denominator, numerator of FRF k: polynomials of order n with complex coefficients | -, m/N |
//! | `w`, `w_0` | angular frequency, lower end of the band | rad/s |
//! | `dt` | step of time: the band covers [`COVERED`] of the unit circle | s |
//! | `p` | pole: `-zeta omega + i omega sqrt(1 - zeta^2)` | 1/s |
//!
//! The band begins at angle 0, so that narrow bands at high frequencies are as well conditioned as wide ones; conjugate poles are outside the
//! band, and the coefficients are complex therefore. With `a_n = 1` poles that only describe noise have negative damping. Source: Guillaume,
//! Verboven, Vanlanduit, Van der Auweraer, Peeters, IMAC XXI (2003); Cauberghe, Guillaume, Verboven, Parloo (2004) on the
//! constraint (both recalled).

use nalgebra::{Complex, DMatrix, DVector, Schur};

use super::frf::Frf;

/// Part of the unit circle that the band covers.
const COVERED: f64 = 0.8;
/// Sweeps of the QR algorithm for the roots of a polynomial.
const SWEEPS: usize = 2000;

/// A pole with positive damping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pole {
    /// `omega`: undamped angular frequency, rad/s.
    pub angular_frequency: f64,
    /// `zeta`: damping ratio.
    pub damping_ratio: f64,
}

/// Sums over the frequencies of one FRF, by lag from `-order` to `order`.
struct Sums {
    order: usize,
    plain: Vec<Complex<f64>>,
    once: Vec<Complex<f64>>,
    twice: Vec<Complex<f64>>,
}

impl Sums {
    fn of(frf: &Frf, start: f64, step: f64, order: usize) -> Sums {
        let zero = vec![Complex::new(0.0, 0.0); 2 * order + 1];
        let mut sums = Sums {
            order,
            plain: zero.clone(),
            once: zero.clone(),
            twice: zero,
        };
        let scale = 1.0 / frf.energy().max(f64::MIN_POSITIVE);
        for (index, omega) in frf.angular_frequencies.iter().enumerate() {
            let (h, g) = (frf.receptance[index], frf.weights[index]);
            let g = g * g * scale;
            for lag in 0..=2 * order {
                let exponent = lag as f64 - order as f64;
                let turn = Complex::from_polar(g, -(omega - start) * step * exponent);
                sums.plain[lag] += turn;
                sums.once[lag] += turn * h;
                sums.twice[lag] += turn * h.norm_sqr();
            }
        }
        sums
    }

    fn matrix(&self, of: &[Complex<f64>], size: usize) -> DMatrix<Complex<f64>> {
        DMatrix::from_fn(size, size, |i, j| of[self.order + j - i])
    }

    /// `T - S^H R^-1 S` of one order; `None` if `R` is singular.
    fn reduced(&self, order: usize) -> Option<DMatrix<Complex<f64>>> {
        let size = order + 1;
        let once = self.matrix(&self.once, size);
        let solved = self.matrix(&self.plain, size).lu().solve(&once)?;
        Some(self.matrix(&self.twice, size) - once.adjoint() * solved)
    }
}

/// Poles inside the band (rad/s) with positive damping, of each order from 1 to `highest`; none of an order whose equations are singular.
pub(super) fn poles_by_order(frfs: &[Frf], band: [f64; 2], highest: usize) -> Vec<Vec<Pole>> {
    let step = COVERED * std::f64::consts::TAU / (band[1] - band[0]);
    let sums: Vec<Sums> = frfs
        .iter()
        .map(|frf| Sums::of(frf, band[0], step, highest))
        .collect();
    let of_order = |order: usize| -> Option<Vec<Pole>> {
        let mut matrix = DMatrix::zeros(order + 1, order + 1);
        for own in &sums {
            matrix += own.reduced(order)?;
        }
        let last: DVector<Complex<f64>> = -matrix.view((0, order), (order, 1)).column(0).into_owned();
        let lower = matrix
            .view((0, 0), (order, order))
            .into_owned()
            .lu()
            .solve(&last)?;
        let found = roots(&lower)?.into_iter().filter_map(|z| {
            let mut pole = -z.ln() / step + Complex::new(0.0, band[0]);
            // The logarithm has angles of half a turn to both sides; those of the band are all above it.
            if pole.im < band[0] - 0.1 * (band[1] - band[0]) {
                pole.im += std::f64::consts::TAU / step;
            }
            let omega = pole.norm();
            let pole = Pole {
                angular_frequency: omega,
                damping_ratio: -pole.re / omega,
            };
            let is_inside = (band[0]..=band[1]).contains(&omega);
            (is_inside && pole.damping_ratio > 0.0).then_some(pole)
        });
        Some(found.collect())
    };
    (1..=highest)
        .map(|order| of_order(order).unwrap_or_default())
        .collect()
}

/// Roots of `z^n + c_(n-1) z^(n-1) + ... + c_0`; `None` if they are not found.
fn roots(coefficients: &DVector<Complex<f64>>) -> Option<Vec<Complex<f64>>> {
    let order = coefficients.len();
    if coefficients
        .iter()
        .any(|c| !(c.re.is_finite() && c.im.is_finite()))
    {
        return None;
    }
    let mut companion = DMatrix::<Complex<f64>>::zeros(order, order);
    for row in 1..order {
        companion[(row, row - 1)] = Complex::new(1.0, 0.0);
    }
    for row in 0..order {
        companion[(row, order - 1)] = -coefficients[row];
    }
    let triangular = Schur::try_new(companion, f64::EPSILON, SWEEPS)?.unpack().1;
    Some(triangular.diagonal().iter().copied().collect())
}

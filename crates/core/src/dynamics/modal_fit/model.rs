//! Receptance of given poles, and its coefficients by linear least squares.
//!
//! ```text
//! H_k(w) = sum_r a_kr q_r(w) - l_k / w^2 + u_k        q_r = 1/(omega_r^2 - w^2 + 2 i zeta_r omega_r w)
//! sum over w of g^2 |H_k - H_k(w)|^2 -> least over a, l, u
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `a_kr` | residue of FRF k in mode r: the product of the shapes at response and reference | 1/kg |
//! | `l_k`, `u_k` | lower and upper residual: modes below the band as mass, modes above it as compliance | 1/kg, m/N |
//! | `omega_r`, `zeta_r` | undamped angular frequency, damping ratio | rad/s, - |
//! | `g` | weight | N/m |
//!
//! Real and imaginary parts are rows of their own; columns have unit length while they are solved. Source: Ewins, Modal testing, on residual terms
//! (recalled).

use nalgebra::{Complex, DMatrix, DVector};

use super::denominator::Pole;
use super::frf::Frf;

/// Residual terms of each FRF.
pub(super) const RESIDUALS: usize = 2;

/// `q` of a pole at the angular frequency `w`.
pub(super) fn dynamic(pole: &Pole, w: f64) -> Complex<f64> {
    let omega = pole.angular_frequency;
    Complex::new(omega * omega - w * w, 2.0 * pole.damping_ratio * omega * w).inv()
}

/// Terms of an FRF at `w` for these poles: `q` of each, lower, upper residual.
pub(super) fn terms(poles: &[Pole], w: f64) -> Vec<Complex<f64>> {
    let mut all: Vec<Complex<f64>> = poles.iter().map(|pole| dynamic(pole, w)).collect();
    all.push(Complex::new(-1.0 / (w * w), 0.0));
    all.push(Complex::new(1.0, 0.0));
    all
}

/// The linear least squares of one FRF.
pub(super) struct Solved {
    /// `a` of each pole, `l`, `u`.
    pub coefficients: DVector<f64>,
    /// Weighted measured less fitted values: real and imaginary part of each frequency in turn.
    pub residuals: DVector<f64>,
    /// Orthonormal columns that span the weighted terms.
    pub basis: DMatrix<f64>,
    /// Coefficients per weighted value: pseudo-inverse of the weighted terms.
    pub inverse: DMatrix<f64>,
}

/// Solves for the coefficients of `columns` (complex, one per frequency each); `None` if they are dependent or more than the values.
pub(super) fn solve(frf: &Frf, columns: &[Vec<Complex<f64>>]) -> Option<Solved> {
    let rows = 2 * frf.receptance.len();
    if rows < columns.len() {
        return None;
    }
    let weighted = |values: &[Complex<f64>]| weighted(frf, values);
    let mut matrix = DMatrix::zeros(rows, columns.len());
    let mut lengths = Vec::with_capacity(columns.len());
    for (index, column) in columns.iter().enumerate() {
        let column = weighted(column);
        let length = column.norm();
        if !(length > 0.0 && length.is_finite()) {
            return None;
        }
        lengths.push(length);
        matrix.set_column(index, &(column / length));
    }
    let values = weighted(&frf.receptance);
    let (basis, triangle) = matrix.qr().unpack();
    let least = triangle
        .diagonal()
        .iter()
        .fold(f64::INFINITY, |a, b| a.min(b.abs()));
    if least.is_nan() || least <= f64::EPSILON {
        return None;
    }
    let mut inverse = triangle.solve_upper_triangular(&basis.transpose())?;
    for (mut row, length) in inverse.row_iter_mut().zip(&lengths) {
        row /= *length;
    }
    let residuals = &values - &basis * (basis.transpose() * &values);
    Some(Solved {
        coefficients: &inverse * &values,
        residuals,
        basis,
        inverse,
    })
}

/// Weighted real and imaginary parts of one value per frequency.
pub(super) fn weighted(frf: &Frf, values: &[Complex<f64>]) -> DVector<f64> {
    let parts = values.iter().zip(&frf.weights);
    DVector::from_iterator(2 * values.len(), parts.flat_map(|(h, g)| [h.re * g, h.im * g]))
}

/// The columns of the terms of these poles.
pub(super) fn columns(frf: &Frf, poles: &[Pole]) -> Vec<Vec<Complex<f64>>> {
    let mut all = vec![Vec::with_capacity(frf.receptance.len()); poles.len() + RESIDUALS];
    for w in &frf.angular_frequencies {
        for (column, term) in all.iter_mut().zip(terms(poles, *w)) {
            column.push(term);
        }
    }
    all
}

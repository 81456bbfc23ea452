//! Parts of the radius that are not backlash: position and size of each circle, and its lobes, equal in both
//! directions.
//!
//! ```text
//! radius_c + sum over n of  p_cn cos n a + q_cn sin n a        n = 1: the place; n = 2: scale and squareness
//! ```
//!
//! It is removed from columns and samples alike, circle by circle (Frisch and Waugh), so that the result is that of a
//! fit of all unknowns at once.

use nalgebra::{DMatrix, DVector};

/// Sums whose variance is below this part of the greatest are not observable.
const UNSEEN: f64 = 1e-10;

/// Orthonormal columns of the nuisance, at the samples of one circle.
pub(super) fn basis(angles: &[f64], most_lobes: usize) -> DMatrix<f64> {
    let rows = DMatrix::from_fn(angles.len(), 1 + 2 * most_lobes, |row, column| {
        let phase = column.div_ceil(2) as f64 * angles[row];
        if column % 2 == 0 { phase.cos() } else { phase.sin() }
    });
    let eigen = rows.tr_mul(&rows).symmetric_eigen();
    let most = eigen.eigenvalues.max();
    let kept: Vec<usize> = (0..eigen.eigenvalues.len())
        .filter(|k| eigen.eigenvalues[*k] > UNSEEN * most)
        .collect();
    let scale = DVector::from_iterator(
        kept.len(),
        kept.iter().map(|k| eigen.eigenvalues[*k].sqrt().recip()),
    );
    rows * eigen.eigenvectors.select_columns(&kept) * DMatrix::from_diagonal(&scale)
}

/// `columns` without their projection on `basis`.
pub(super) fn without(basis: &DMatrix<f64>, columns: &DMatrix<f64>) -> DMatrix<f64> {
    columns - basis * basis.tr_mul(columns)
}

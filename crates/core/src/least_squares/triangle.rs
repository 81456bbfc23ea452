//! Least squares of any number of rows in the memory of one triangle.
//!
//! Rows come in blocks; after each the QR decomposition of the triangle and the block leaves a triangle with the same
//! columns' lengths and angles, and so the same solution: `min |J x - r| = min |R x - z|`.

use nalgebra::{DMatrix, DVector};

/// Rows that are gathered before a decomposition.
const BLOCK: usize = 256;

/// The triangle of all rows.
#[derive(Clone, Debug)]
pub(crate) struct Triangle {
    /// Square, one column per unknown and the right-hand side last.
    matrix: DMatrix<f64>,
    block: DMatrix<f64>,
    filled: usize,
}

impl Triangle {
    /// Without rows, for this number of unknowns.
    pub fn new(unknowns: usize) -> Triangle {
        Triangle {
            matrix: DMatrix::zeros(unknowns + 1, unknowns + 1),
            block: DMatrix::zeros(BLOCK, unknowns + 1),
            filled: 0,
        }
    }

    /// Adds rows: unknowns, and the right-hand side last.
    pub fn take(&mut self, rows: &DMatrix<f64>) {
        for row in rows.row_iter() {
            if self.filled == BLOCK {
                self.fold();
            }
            self.block.row_mut(self.filled).copy_from(&row);
            self.filled += 1;
        }
    }

    fn fold(&mut self) {
        let width = self.matrix.ncols();
        let mut whole = DMatrix::zeros(width + self.filled, width);
        whole.rows_mut(0, width).copy_from(&self.matrix);
        whole
            .rows_mut(width, self.filled)
            .copy_from(&self.block.rows(0, self.filled));
        self.matrix = whole.qr().r();
        self.filled = 0;
    }

    /// The matrix of the unknowns and the right-hand side.
    pub fn whole(mut self) -> (DMatrix<f64>, DVector<f64>) {
        self.fold();
        let width = self.matrix.ncols() - 1;
        (
            self.matrix.columns(0, width).into_owned(),
            self.matrix.column(width).into_owned(),
        )
    }
}

/// The least-squares solution of `J x = r` with `damping` (0: none), and the inverse of `J'J`; columns are
/// scaled to length one first. `None` where the columns are not independent.
pub(crate) fn solve(
    j: &DMatrix<f64>,
    r: &DVector<f64>,
    damping: f64,
) -> Option<(DVector<f64>, DMatrix<f64>)> {
    let count = j.ncols();
    let scale = DVector::from_fn(count, |k, _| j.column(k).norm());
    if scale.iter().any(|length| *length == 0.0) {
        return None;
    }
    let mut whole = DMatrix::zeros(j.nrows() + count, count);
    let mut right = DVector::zeros(j.nrows() + count);
    right.rows_mut(0, j.nrows()).copy_from(r);
    for k in 0..count {
        whole
            .view_mut((0, k), (j.nrows(), 1))
            .copy_from(&(j.column(k) / scale[k]));
        whole[(j.nrows() + k, k)] = damping.sqrt();
    }
    let qr = whole.qr();
    let upper = qr.r();
    qr.q_tr_mul(&mut right);
    let mut solution = right.rows(0, count).into_owned();
    if !upper.solve_upper_triangular_mut(&mut solution) {
        return None;
    }
    let inverse = upper.solve_upper_triangular(&DMatrix::identity(count, count))?;
    let covariance = &inverse * inverse.transpose();
    Some((
        solution.component_div(&scale),
        DMatrix::from_fn(count, count, |a, b| covariance[(a, b)] / (scale[a] * scale[b])),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_give_the_solution_of_all_rows_at_once() {
        let rows = DMatrix::from_fn(1000, 4, |i, k| ((i * (k + 3) + 7 * k) as f64 * 0.37).sin());
        let mut triangle = Triangle::new(3);
        triangle.take(&rows.rows(0, 100).into_owned());
        triangle.take(&rows.rows(100, 900).into_owned());
        let (r, z) = triangle.whole();
        let (x, inverse) = solve(&r, &z, 0.0).unwrap();
        let j = rows.columns(0, 3).into_owned();
        let normal = j.transpose() * &j;
        let direct = normal
            .clone()
            .cholesky()
            .unwrap()
            .solve(&(j.transpose() * rows.column(3)));
        assert!((x - direct).norm() < 1e-13);
        assert!((normal * inverse - DMatrix::identity(3, 3)).norm() < 1e-12);
    }

    #[test]
    fn a_column_of_zeros_has_no_solution_and_damping_shortens() {
        let j = DMatrix::from_row_slice(3, 2, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        assert!(solve(&j, &DVector::zeros(3), 0.0).is_none());
        let j = DMatrix::from_row_slice(3, 1, &[1.0, 0.0, 1.0]);
        let r = DVector::from_vec(vec![1.0, 0.0, 1.0]);
        let [free, damped] = [0.0, 1.0].map(|damping| solve(&j, &r, damping).unwrap().0[0]);
        assert!(
            (free - 1.0).abs() < 1e-15 && (damped - 0.5).abs() < 1e-15,
            "{free} {damped}"
        );
    }
}

//! Solving `A X = B` in place: elimination with partial pivoting (Golub & Van Loan, section 3.4), without allocation.

use nalgebra::DMatrix;

/// Puts `A^-1 B` in place of `b`; `a` is used up. False where `A` is singular or not finite.
pub(super) fn solve(a: &mut DMatrix<f64>, b: &mut DMatrix<f64>) -> bool {
    let size = a.nrows();
    for column in 0..size {
        let below = a.view((column, column), (size - column, 1));
        let pivot = column + below.iamax_full().0;
        if !(a[(pivot, column)].abs() > 0.0 && a[(pivot, column)].is_finite()) {
            return false;
        }
        a.swap_rows(column, pivot);
        b.swap_rows(column, pivot);
        for row in column + 1..size {
            let factor = a[(row, column)] / a[(column, column)];
            for after in column..size {
                a[(row, after)] -= factor * a[(column, after)];
            }
            for after in 0..b.ncols() {
                b[(row, after)] -= factor * b[(column, after)];
            }
        }
    }
    for column in 0..b.ncols() {
        for row in (0..size).rev() {
            let known: f64 = (row + 1..size).map(|k| a[(row, k)] * b[(k, column)]).sum();
            b[(row, column)] = (b[(row, column)] - known) / a[(row, row)];
        }
    }
    true
}

/// Whether the symmetric part of `a` is positive definite; `a` is used up (Cholesky).
pub(super) fn is_positive_definite(a: &mut DMatrix<f64>) -> bool {
    let size = a.nrows();
    for row in 0..size {
        for column in 0..row {
            a[(row, column)] = 0.5 * (a[(row, column)] + a[(column, row)]);
        }
    }
    for column in 0..size {
        let squares: f64 = (0..column).map(|k| a[(column, k)] * a[(column, k)]).sum();
        let rest = a[(column, column)] - squares;
        if !(rest > 0.0 && rest.is_finite()) {
            return false;
        }
        let root = rest.sqrt();
        a[(column, column)] = root;
        for row in column + 1..size {
            let products: f64 = (0..column).map(|k| a[(row, k)] * a[(column, k)]).sum();
            a[(row, column)] = (a[(row, column)] - products) / root;
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    fn some(size: usize) -> DMatrix<f64> {
        DMatrix::from_fn(size, size, |i, j| ((7 * i + 3 * j + i * j) % 11) as f64 - 4.5)
    }

    #[test]
    fn a_solution_put_back_gives_the_right_side() {
        let a = some(7);
        let b = DMatrix::from_fn(7, 2, |i, j| i as f64 - 3.0 * j as f64);
        let mut x = b.clone();
        assert!(solve(&mut a.clone(), &mut x));
        assert!((&a * x - b).amax() < 1e-12);
    }

    #[test]
    fn a_singular_matrix_has_no_solution() {
        let mut flat = DMatrix::zeros(3, 3);
        flat[(0, 0)] = 1.0;
        assert!(!solve(&mut flat, &mut DMatrix::zeros(3, 1)));
    }

    #[test]
    fn definiteness_is_that_of_the_symmetric_part() {
        let a = some(5);
        let square = &a * a.transpose() + DMatrix::identity(5, 5);
        assert!(is_positive_definite(&mut square.clone()));
        let twisted = square + DMatrix::from_fn(5, 5, |i, j| (i as f64 - j as f64) * 100.0);
        assert!(is_positive_definite(&mut twisted.clone()));
        assert!(!is_positive_definite(
            &mut (twisted - DMatrix::identity(5, 5) * 500.0)
        ));
    }
}

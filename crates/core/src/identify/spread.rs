//! Uncertainty of the unknowns, and which of them are not distinguishable by the tests.
//!
//! With `D` the weighted rows of the tests and `P` those of the prior (both over their standard uncertainties):
//!
//! - covariance `(D^T D + P^T P)^-1`;
//! - share known from the tests, not the prior: `1 - [(D^T D + P^T P)^-1 P^T P]_kk`, from 0 to 1 (MacKay 1992);
//! - a direction with `D v = 0` is not observable.
//!
//! All by symmetric eigenvalues of matrices with unit diagonal.

use nalgebra::{DMatrix, DVector};

/// Eigenvalues below this, of a matrix with unit diagonal, are rounding: such directions are not observable.
const UNSEEN: f64 = 1e-11;
/// Parts of a direction that are smaller than this share of its largest are rounding.
const NAMED: f64 = 1e-3;

/// Covariance and the information by the tests.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spread {
    /// Of the active unknowns; zero rows for the others.
    pub covariance: DMatrix<f64>,
    /// Share of the information from the tests, 0 to 1, one per unknown.
    pub known: Vec<f64>,
    /// Sets of unknowns of which only a sum is identifiable; a single one has no effect on any test.
    pub together: Vec<Vec<usize>>,
}

impl Spread {
    /// From the rows of tests and prior; unknowns that are not active are at their bound.
    pub fn of(tests: &DMatrix<f64>, prior: &DMatrix<f64>, active: &[bool]) -> Spread {
        let count = tests.ncols();
        let seen_by_tests = tests.tr_mul(tests);
        let known_before = prior.tr_mul(prior);
        let places: Vec<usize> = (0..count).filter(|j| active[*j]).collect();
        let of_active = |m: &DMatrix<f64>| m.select_columns(&places).select_rows(&places);
        let inverse = pseudo_inverse(&of_active(&(&seen_by_tests + &known_before)));
        let from_prior = &inverse * of_active(&known_before);
        let mut covariance = DMatrix::zeros(count, count);
        let mut known = vec![0.0; count];
        for (a, j) in places.iter().enumerate() {
            for (b, k) in places.iter().enumerate() {
                covariance[(*j, *k)] = inverse[(a, b)];
            }
            if seen_by_tests[(*j, *j)] > 0.0 {
                known[*j] = (1.0 - from_prior[(a, a)]).clamp(0.0, 1.0);
            }
        }
        Spread {
            covariance,
            known,
            together: unseen(&seen_by_tests),
        }
    }
}

/// Scaled to unit diagonal: the matrix and its scales.
fn unit_diagonal(matrix: &DMatrix<f64>) -> (DMatrix<f64>, DVector<f64>) {
    let scale = matrix
        .diagonal()
        .map(|d| if d > 0.0 { d.sqrt().recip() } else { 0.0 });
    let scaled = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
        matrix[(i, j)] * scale[i] * scale[j]
    });
    (scaled, scale)
}

fn pseudo_inverse(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    if matrix.is_empty() {
        return matrix.clone();
    }
    let (scaled, scale) = unit_diagonal(matrix);
    let eigen = scaled.symmetric_eigen();
    // A direction that neither tests nor prior determine has the largest uncertainty, not zero.
    let zero = UNSEEN * 1e-3;
    let inverse = eigen.eigenvalues.map(|v| 1.0 / v.max(zero));
    let whole = &eigen.eigenvectors * DMatrix::from_diagonal(&inverse) * eigen.eigenvectors.transpose();
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
        whole[(i, j)] * scale[i] * scale[j]
    })
}

/// Directions that are not observable: first single unknowns, then sets.
fn unseen(seen: &DMatrix<f64>) -> Vec<Vec<usize>> {
    let count = seen.nrows();
    let mut found: Vec<Vec<usize>> = (0..count)
        .filter(|j| seen[(*j, *j)] == 0.0)
        .map(|j| vec![j])
        .collect();
    let places: Vec<usize> = (0..count).filter(|j| seen[(*j, *j)] > 0.0).collect();
    if places.is_empty() {
        return found;
    }
    let (scaled, _) = unit_diagonal(&seen.select_columns(&places).select_rows(&places));
    let eigen = scaled.symmetric_eigen();
    for (place, value) in eigen.eigenvalues.iter().enumerate() {
        if *value < UNSEEN {
            let direction = eigen.eigenvectors.column(place);
            let least = direction.amax() * NAMED;
            let parts = places.iter().zip(direction.iter());
            found.push(parts.filter(|(_, v)| v.abs() > least).map(|(j, _)| *j).collect());
        }
    }
    found.sort();
    // With several directions in one set each shows the whole set.
    found.dedup();
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_equal_columns_are_known_only_together_and_a_zero_column_not_at_all() {
        let tests = DMatrix::from_row_slice(
            4,
            4,
            &[
                1.0, 2.0, 2.0, 0.0, //
                0.5, 1.0, 1.0, 0.0, //
                3.0, -1.0, -1.0, 0.0, //
                0.1, 0.4, 0.4, 0.0,
            ],
        );
        let spread = Spread::of(&tests, &DMatrix::identity(4, 4), &[true; 4]);
        assert_eq!(spread.together, [vec![1, 2], vec![3]]);
        assert_eq!(spread.known[3], 0.0);
        // One sum of the two is known, one difference is not.
        assert!(
            (spread.known[1] + spread.known[2] - 1.0).abs() < 0.1,
            "{:?}",
            spread.known
        );
    }

    #[test]
    fn without_prior_the_covariance_is_that_of_least_squares() {
        let tests = DMatrix::from_row_slice(3, 2, &[1.0, 0.0, 1.0, 1.0, 1.0, 2.0]);
        let spread = Spread::of(&tests, &DMatrix::zeros(0, 2), &[true; 2]);
        // Line through three points at 0, 1, 2: variances 5/6 and 1/2.
        assert!((spread.covariance[(0, 0)] - 5.0 / 6.0).abs() < 1e-12);
        assert!((spread.covariance[(1, 1)] - 0.5).abs() < 1e-12);
        assert!(spread.known.iter().all(|k| (k - 1.0).abs() < 1e-12));
        assert!(spread.together.is_empty());
    }

    #[test]
    fn other_units_of_an_unknown_change_only_its_own_rows() {
        let tests = DMatrix::from_row_slice(
            4,
            3,
            &[1.0, 2.0, 0.5, 0.5, 1.0, -1.0, 3.0, -1.0, 2.0, 0.1, 0.4, 7.0],
        );
        let prior = DMatrix::identity(3, 3) * 0.3;
        let here = Spread::of(&tests, &prior, &[true; 3]);
        let units = DMatrix::from_diagonal(&DVector::from_vec(vec![1e-6, 1.0, 1e3]));
        let there = Spread::of(&(&tests * &units), &(&prior * &units), &[true; 3]);
        for i in 0..3 {
            assert!((here.known[i] - there.known[i]).abs() < 1e-12);
            for j in 0..3 {
                let back = there.covariance[(i, j)] * units[(i, i)] * units[(j, j)];
                assert!((back - here.covariance[(i, j)]).abs() < 1e-12, "{i} {j}");
            }
        }
    }

    #[test]
    fn an_unknown_at_its_bound_is_fixed_and_reduces_the_uncertainty_of_the_others() {
        let tests = DMatrix::from_row_slice(3, 2, &[1.0, 0.0, 1.0, 1.0, 1.0, 2.0]);
        let none = DMatrix::zeros(0, 2);
        let both = Spread::of(&tests, &none, &[true; 2]);
        let one = Spread::of(&tests, &none, &[true, false]);
        assert_eq!((one.covariance[(1, 1)], one.known[1]), (0.0, 0.0));
        // The mean of three readings.
        assert!((one.covariance[(0, 0)] - 1.0 / 3.0).abs() < 1e-12);
        assert!(one.covariance[(0, 0)] < both.covariance[(0, 0)]);
    }

    #[test]
    fn shares_known_from_tests_rise_with_the_tests_from_none_to_all() {
        let tests = DMatrix::from_row_slice(3, 2, &[1.0, 0.0, 1.0, 1.0, 1.0, 2.0]);
        let prior = DMatrix::identity(2, 2);
        let mut before = [0.0; 2];
        for size in [1e-4, 1e-2, 1.0, 1e2, 1e4] {
            let known = Spread::of(&(&tests * size), &prior, &[true; 2]).known;
            assert!(known[0] > before[0] && known[1] > before[1], "{size}: {known:?}");
            before = [known[0], known[1]];
        }
        assert!(before.iter().all(|known| *known > 1.0 - 1e-6));
    }
}

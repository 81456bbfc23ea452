//! Eigenvalue of largest modulus of a linear map, by Arnoldi's method without restart.
//!
//! The map of one period with delay is compact: almost all of its eigenvalues are close to zero, so a space of some tens of dimensions
//! more than twice the number of modes contains the rest up to rounding. The start vector is the same in every call. The space grows until
//! the largest modulus and its eigenvalue stay the same over two enlargements, or has the dimension of the map, where the result is exact.
//!
//! Source: Saad, Numerical Methods for Large Eigenvalue Problems \[recalled\].

use nalgebra::{Complex, DMatrix, DVector, Schur};

/// Dimensions of the first space and of each enlargement.
const FIRST: usize = 24;
const MORE: usize = 12;
/// Most dimensions.
const MOST: usize = 400;
/// Change of the eigenvalue at which it is final.
const CONVERGED: f64 = 1e-10;
/// Part of a vector that is left after projection below which the space is invariant.
const INVARIANT: f64 = 1e-13;
/// Most iterations of the Schur decomposition per dimension.
const ITERATIONS: usize = 100;
/// Fractional part of the golden ratio: its multiples are spread evenly, and no eigenvector is perpendicular to them.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The eigenvalue of largest modulus of `map` on vectors of this dimension; with a nonnegative imaginary part.
pub(super) fn dominant(dimension: usize, map: impl Fn(&DVector<f64>) -> DVector<f64>) -> Complex<f64> {
    let start = DVector::from_fn(dimension, |index, _| ((index + 1) as f64 * GOLDEN).fract() - 0.5);
    let most = dimension.min(MOST);
    let mut basis = vec![start.normalize()];
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let (mut last, mut unchanged) = (Complex::new(f64::NAN, 0.0), 0);
    let mut check = FIRST.min(most);
    while columns.len() < most {
        let mut next = map(&basis[columns.len()]);
        let size = next.norm();
        let mut column = vec![0.0; basis.len()];
        // Twice: the second pass removes what rounding of the first left.
        for _ in 0..2 {
            for (entry, vector) in column.iter_mut().zip(&basis) {
                let along = vector.dot(&next);
                *entry += along;
                next.axpy(-along, vector, 1.0);
            }
        }
        let rest = next.norm();
        column.push(rest);
        columns.push(column);
        let is_invariant = rest <= INVARIANT * size || rest == 0.0;
        if columns.len() == check || is_invariant || columns.len() == most {
            let found = largest(&columns).unwrap_or(last);
            unchanged = if (found - last).norm() <= CONVERGED * found.norm().max(CONVERGED) {
                unchanged + 1
            } else {
                0
            };
            last = found;
            if is_invariant || unchanged >= 2 {
                break;
            }
            check += MORE;
        }
        basis.push(next / rest);
    }
    last
}

/// The eigenvalue of largest modulus of the Hessenberg matrix of these columns; `None` if its decomposition does not converge.
fn largest(columns: &[Vec<f64>]) -> Option<Complex<f64>> {
    let size = columns.len();
    let matrix = DMatrix::from_fn(size, size, |row, column| {
        columns[column].get(row).copied().unwrap_or(0.0)
    });
    let schur = Schur::try_new(matrix, f64::EPSILON, ITERATIONS * size)?;
    let found = schur.complex_eigenvalues().iter().copied().max_by(|a, b| {
        // Of a pair the one with positive imaginary part.
        (a.norm_sqr(), a.im)
            .partial_cmp(&(b.norm_sqr(), b.im))
            .unwrap_or(std::cmp::Ordering::Equal)
    })?;
    Some(Complex::new(found.re, found.im.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Block diagonal with the pair `radius e^(+- i angle)` and many small values, in a basis that is not orthogonal.
    fn matrix(size: usize, pair: [f64; 2], real: f64) -> DMatrix<f64> {
        let (sin, cos) = pair[1].sin_cos();
        let mut blocks =
            DMatrix::from_diagonal(&DVector::from_fn(size, |index, _| 0.5 / (1.0 + index as f64)));
        blocks[(0, 0)] = pair[0] * cos;
        blocks[(1, 1)] = pair[0] * cos;
        blocks[(0, 1)] = -pair[0] * sin;
        blocks[(1, 0)] = pair[0] * sin;
        blocks[(2, 2)] = real;
        let basis = DMatrix::from_fn(size, size, |r, c| {
            f64::from(u8::from(r == c)) + 0.3 * (((r * 7 + c * 3) % 11) as f64 / 11.0 - 0.5)
        });
        &basis * blocks * basis.clone().try_inverse().unwrap()
    }

    #[test]
    fn the_largest_of_known_eigenvalues_is_found_whatever_its_kind() {
        for (pair, real, expected) in [
            ([1.02, 0.3], 0.97, Complex::from_polar(1.02, 0.3)),
            ([0.99, 2.0], -1.001, Complex::new(-1.001, 0.0)),
            ([0.99, 2.0], 1.0005, Complex::new(1.0005, 0.0)),
        ] {
            let matrix = matrix(150, pair, real);
            let found = dominant(150, |x| &matrix * x);
            assert!((found - expected).norm() < 1e-8, "{found} {expected}");
        }
    }

    #[test]
    fn a_small_map_is_exact_and_zero_has_zero() {
        let matrix = DMatrix::from_row_slice(3, 3, &[0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0]);
        assert!((dominant(3, |x| &matrix * x).norm() - 1.0).abs() < 1e-12);
        assert_eq!(dominant(4, |x| x * 0.0).norm(), 0.0);
    }
}

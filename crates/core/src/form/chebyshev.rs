//! Linear minimax approximation with proof: the unknowns that make the largest residual least.
//!
//! ```text
//! min over x of  max over i of |b_i - a_i x|          (both sides)
//! min over x of  max over i of  b_i - a_i x           (one side)
//! proof:  l >= 0, sum l = 1, sum l s a = 0   =>   sum l s b <= least level <= max (s (b - a x))
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `a_i`, `b_i` | row and right-hand side | any; residuals in that of `b` |
//! | `x` | unknowns | |
//! | `s` | sign of a residual: 1 or -1, on one side always 1 | - |
//! | `l` | multipliers of the `M + 1` rows of the support | - |
//!
//! Exchange of rows: the solution is that of `M + 1` rows with equal residuals; the row with the largest residual
//! enters, and the row leaves that keeps all multipliers at or above 0. The level never decreases. Where multipliers are
//! 0 (four points of a grid in one line), the leaving row is the lexicographically least one, so that no support is
//! repeated and the method ends. This is the revised simplex method for the dual linear program. Unknowns are first
//! transformed to those in which the columns are orthonormal, about the least-squares solution: there the optimum is
//! within twice the largest residual.
//!
//! Each exchange reads all rows once. Exact but for rounding of the residuals (1e-15 of a row's largest term): both sides of the
//! proof are returned.
//! Source: E. Stiefel, Uber diskrete und lineare Tschebyscheff-Approximationen, Numerische Mathematik 1, 1959; G. Dantzig,
//! A. Orden, P. Wolfe, The generalized simplex method, Pacific Journal of Mathematics 5, 1955 (lexicographic rule).

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::FormError;
use crate::least_squares::{Triangle, solve};

/// Maximum number of exchanges; ten to fifty are usual.
const MOST_EXCHANGES: usize = 5_000;
/// Rows that one thread reads at a time.
const ROWS_AT_ONCE: usize = 16_384;
/// Columns whose part across all earlier ones is below this part of their length are not independent.
const DEPENDENT: f64 = 1e-11;
/// Ratios and multipliers that differ by less are equal: rounding of matrices of at most eight rows.
const EQUAL: f64 = 1e-12;
/// The largest residual is that of the support but for this part of the sum of a row's terms.
const ROUNDING: f64 = 8.0 * f64::EPSILON;
/// Bounds of the transformed unknowns, in units of the largest residual: no optimum of both sides is beyond 2, and the
/// optimum of one side of points all around a feature is far within the second.
const BOUNDS: [f64; 2] = [4.0, 1e4];

/// Which residuals are made small.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResidualSide {
    /// `|b - a x|`
    Both,
    /// `b - a x`
    Above,
}

/// A row of the support: its residual is at the level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupportRow {
    /// Index of the row.
    pub row: usize,
    /// Sign of its residual.
    pub sign: f64,
    /// Its multiplier, at or above 0; all add up to 1.
    pub multiplier: f64,
}

/// A minimax solution with its proof.
#[derive(Clone, Debug, PartialEq)]
pub struct Minimax<const M: usize> {
    /// The unknowns.
    pub unknowns: [f64; M],
    /// Largest residual there.
    // unit: that of the right-hand side
    pub level: f64,
    /// No unknowns have a lower level than this: the sum of the support.
    // unit: that of the right-hand side
    pub proven: f64,
    /// The rows that determine the solution.
    pub support: Vec<SupportRow>,
    /// Number of exchanges.
    pub exchanges: usize,
}

/// The unknowns with the least largest residual of `rows` and `right`.
///
/// # Errors
/// Fewer rows than unknowns, values that are not finite, dependent columns; one-sided residuals without limit.
pub fn minimax<const M: usize>(
    rows: &[[f64; M]],
    right: &[f64],
    side: ResidualSide,
) -> Result<Minimax<M>, FormError> {
    let transformed = Transformed::of(rows, right)?;
    let rounding = ROUNDING * transformed.largest;
    // Residuals that are rounding alone have no optimum.
    if side == ResidualSide::Both && transformed.scale <= rounding {
        return Ok(Minimax {
            unknowns: transformed.middle,
            level: transformed.scale,
            proven: 0.0,
            support: Vec::new(),
            exchanges: 0,
        });
    }
    let mut basis = Basis::at_bounds::<M>(side);
    for exchanges in 0..MOST_EXCHANGES {
        let vertex = basis.vertex().ok_or(FormError::Undetermined)?;
        let unknowns = transformed.unknowns(&vertex);
        let worst = worst(rows, right, &unknowns, side);
        let level = vertex[M] * transformed.scale;
        let entering = transformed.constraint(rows, right, &worst);
        if worst.residual - level <= rounding || basis.contains(&entering) {
            return basis.proof(&transformed, unknowns, worst.residual, exchanges);
        }
        basis.exchange(entering).ok_or(FormError::OneSided)?;
    }
    Err(FormError::NotFound {
        rounds: MOST_EXCHANGES,
    })
}

/// A row with its sign, and its residual.
#[derive(Clone, Copy)]
struct Worst {
    row: usize,
    sign: f64,
    residual: f64,
}

impl Worst {
    /// The larger one; the earlier of equal ones, whichever thread found it.
    fn or_worse(self, other: Worst) -> Worst {
        let is_later = other.residual == self.residual && other.row > self.row;
        match other.residual < self.residual || is_later {
            true => self,
            false => other,
        }
    }
}

/// The row with the largest residual.
fn worst<const M: usize>(rows: &[[f64; M]], right: &[f64], x: &[f64; M], side: ResidualSide) -> Worst {
    let none = Worst {
        row: usize::MAX,
        sign: 1.0,
        residual: f64::NEG_INFINITY,
    };
    let blocks = rows
        .par_chunks(ROWS_AT_ONCE)
        .zip(right.par_chunks(ROWS_AT_ONCE))
        .enumerate();
    let of_block = |(block, (rows, right)): (usize, (&[[f64; M]], &[f64]))| {
        let mut found = none;
        for (k, (row, right)) in rows.iter().zip(right).enumerate() {
            let residual = residual(row, *right, x);
            let size = match side {
                ResidualSide::Both => residual.abs(),
                ResidualSide::Above => residual,
            };
            if size > found.residual {
                found = Worst {
                    row: block * ROWS_AT_ONCE + k,
                    sign: if size == residual { 1.0 } else { -1.0 },
                    residual: size,
                };
            }
        }
        found
    };
    blocks.map(of_block).reduce(|| none, Worst::or_worse)
}

fn residual<const M: usize>(row: &[f64; M], right: f64, x: &[f64; M]) -> f64 {
    row.iter().zip(x).fold(right, |left, (a, x)| left - a * x)
}

/// The rows in unknowns in which the columns are orthonormal, about the least-squares solution.
struct Transformed<const M: usize> {
    /// Least-squares solution.
    middle: [f64; M],
    /// Unknowns per transformed unknown.
    from_transformed: DMatrix<f64>,
    /// Largest residual of the least-squares solution.
    scale: f64,
    /// Largest sum of the sizes of a row's terms.
    largest: f64,
}

impl<const M: usize> Transformed<M> {
    fn of(rows: &[[f64; M]], right: &[f64]) -> Result<Transformed<M>, FormError> {
        let count = rows.len();
        if right.len() != count {
            return Err(FormError::Lengths {
                needed: count,
                given: right.len(),
            });
        }
        if count < M {
            return Err(FormError::TooFew {
                needed: M,
                given: count,
            });
        }
        let is_bad =
            |(row, right): (&[f64; M], &f64)| !row.iter().chain([right]).all(|value| value.is_finite());
        if let Some(index) = rows.iter().zip(right).position(is_bad) {
            return Err(FormError::NotFinite { index });
        }
        let mut triangle = Triangle::new(M);
        for (rows, right) in rows.chunks(ROWS_AT_ONCE).zip(right.chunks(ROWS_AT_ONCE)) {
            triangle.take(&DMatrix::from_fn(rows.len(), M + 1, |i, k| match k < M {
                true => rows[i][k],
                false => right[i],
            }));
        }
        let (r, z) = triangle.whole();
        // Of at most eight rows and columns.
        let upper = DMatrix::from_fn(M, M, |i, k| r[(i, k)]);
        let is_dependent = |k: usize| upper[(k, k)].abs() <= DEPENDENT * upper.column(k).norm();
        if (0..M).any(is_dependent) {
            return Err(FormError::Undetermined);
        }
        let (solution, _) = solve(&r, &z, 0.0).ok_or(FormError::Undetermined)?;
        let inverse = upper
            .solve_upper_triangular(&DMatrix::identity(M, M))
            .ok_or(FormError::Undetermined)?;
        let middle: [f64; M] = std::array::from_fn(|k| solution[k]);
        Ok(Transformed {
            middle,
            from_transformed: inverse * (count as f64).sqrt(),
            scale: worst(rows, right, &middle, ResidualSide::Both).residual,
            largest: rows.iter().zip(right).fold(0.0, |most, (row, right)| {
                let terms = row.iter().zip(&middle).map(|(a, x)| (a * x).abs());
                (terms.sum::<f64>() + right.abs()).max(most)
            }),
        })
    }

    /// The unknowns of a vertex.
    fn unknowns(&self, vertex: &DVector<f64>) -> [f64; M] {
        let step = &self.from_transformed * vertex.rows(0, M) * self.scale;
        std::array::from_fn(|k| self.middle[k] + step[k])
    }

    /// `s a x + h >= s b` of a row.
    fn constraint(&self, rows: &[[f64; M]], right: &[f64], worst: &Worst) -> Constraint {
        let row = &rows[worst.row];
        let across = DVector::from_row_slice(row).transpose() * &self.from_transformed;
        Constraint {
            row: Some(worst.row),
            sign: worst.sign,
            factors: DVector::from_fn(M + 1, |k, _| if k < M { worst.sign * across[k] } else { 1.0 }),
            least: worst.sign * residual(row, right[worst.row], &self.middle) / self.scale,
        }
    }
}

/// `factors y >= least`, `y` the transformed unknowns and the level.
#[derive(Clone, Debug)]
struct Constraint {
    /// `None`: a bound of an unknown.
    row: Option<usize>,
    sign: f64,
    factors: DVector<f64>,
    least: f64,
}

/// As many constraints as there are unknowns and level.
struct Basis(Vec<Constraint>);

impl Basis {
    /// All unknowns at their lower bounds: valid multipliers.
    fn at_bounds<const M: usize>(side: ResidualSide) -> Basis {
        let bound = BOUNDS[usize::from(side == ResidualSide::Above)];
        let of = |k: usize| Constraint {
            row: None,
            sign: 1.0,
            factors: DVector::from_fn(M + 1, |axis, _| f64::from(u8::from(axis == k))),
            // On both sides the level is not negative.
            least: if k == M && side == ResidualSide::Both {
                0.0
            } else {
                -bound
            },
        };
        Basis((0..=M).map(of).collect())
    }

    fn matrix(&self) -> DMatrix<f64> {
        DMatrix::from_fn(self.0.len(), self.0.len(), |i, k| self.0[i].factors[k])
    }

    /// Where all constraints of the basis are equations.
    fn vertex(&self) -> Option<DVector<f64>> {
        let least = DVector::from_fn(self.0.len(), |i, _| self.0[i].least);
        self.matrix().lu().solve(&least)
    }

    fn contains(&self, constraint: &Constraint) -> bool {
        let is_same = |own: &Constraint| own.row == constraint.row && own.sign == constraint.sign;
        self.0.iter().any(is_same)
    }

    /// Takes a constraint in; `None` where no other can leave.
    fn exchange(&mut self, entering: Constraint) -> Option<()> {
        let size = self.0.len();
        // Row j: how the multiplier j depends on the gradient of the level, and on perturbations of it.
        let inverse = self.matrix().transpose().try_inverse()?;
        let falls = &inverse * &entering.factors;
        let least_fall = EQUAL * falls.amax();
        // The multiplier itself first, then the columns of the perturbations.
        let ratio = |j: usize, k: usize| {
            let column = if k == 0 { size - 1 } else { k - 1 };
            inverse[(j, column)] / falls[j]
        };
        let mut leaving: Option<usize> = None;
        for j in (0..size).filter(|j| falls[*j] > least_fall) {
            let Some(best) = leaving else {
                leaving = Some(j);
                continue;
            };
            let differs = (0..=size)
                .map(|k| ratio(j, k) - ratio(best, k))
                .find(|d| d.abs() > EQUAL);
            if differs.is_some_and(|difference| difference < 0.0) {
                leaving = Some(j);
            }
        }
        self.0[leaving?] = entering;
        Some(())
    }

    /// The solution with its multipliers.
    fn proof<const M: usize>(
        &self,
        transformed: &Transformed<M>,
        unknowns: [f64; M],
        level: f64,
        exchanges: usize,
    ) -> Result<Minimax<M>, FormError> {
        let inverse = self
            .matrix()
            .transpose()
            .try_inverse()
            .ok_or(FormError::Undetermined)?;
        let mut support = Vec::new();
        let mut proven = 0.0;
        for (j, constraint) in self.0.iter().enumerate() {
            let multiplier = inverse[(j, M)].max(0.0);
            proven += multiplier * constraint.least;
            match constraint.row {
                Some(row) => support.push(SupportRow {
                    row,
                    sign: constraint.sign,
                    multiplier,
                }),
                None if multiplier > EQUAL => return Err(FormError::OneSided),
                None => {}
            }
        }
        Ok(Minimax {
            unknowns,
            level,
            proven: proven * transformed.scale,
            support,
            exchanges,
        })
    }
}

#[cfg(test)]
mod tests;

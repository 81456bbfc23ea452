//! Poles by nonlinear least squares over all FRFs, with residues eliminated (variable projection).
//!
//! ```text
//! F(theta) = sum_k |r_k|^2 / s_k^2        r_k = P_k y_k        J_k = -P_k (d Phi_k / d theta) c_k
//! (J^T J + mu D) d theta = -J^T r         dq/domega = -(2 omega + 2 i zeta w) q^2       dq/dzeta = -2 i omega w q^2
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `theta` | `omega` and `zeta` of each pole, relative to its start | - |
//! | `y_k`, `Phi_k`, `c_k` | weighted FRF, its weighted terms, their coefficients ([`super::model`]) | -, -, - |
//! | `P_k` | projection on what the terms do not reach | - |
//! | `s_k` | standard deviation of `r_k`, from the fit before | - |
//! | `mu`, `D` | damping of the step (Levenberg, Marquardt), diagonal of `J^T J` | - |
//!
//! Source: Golub & Pereyra 1973, with the simplified derivative of Kaufman 1975 (recalled).

use nalgebra::{Complex, DMatrix, DVector};

use super::denominator::Pole;
use super::frf::Frf;
use super::model::{RESIDUALS, Solved, columns, dynamic, solve, weighted};

/// Steps at most.
const MOST_STEPS: usize = 60;
/// The relative change of the sum of squares that ends the search.
const END: f64 = 1e-13;
/// The greatest damping of a step that is tried.
const MOST_DAMPING: f64 = 1e8;
/// Times that the standard deviations of the FRFs are determined.
const ROUNDS: usize = 3;
/// Residuals below this part of the FRF are rounding errors.
const ROUNDING: f64 = 1e-10;
/// Range of damping ratios.
const DAMPING: [f64; 2] = [1e-6, 0.9];

/// Poles that fit all FRFs best.
pub(super) struct Refined {
    /// The poles, in the order of the start.
    pub poles: Vec<Pole>,
    /// The linear least squares of each FRF.
    pub solved: Vec<Solved>,
    /// `s_k`: standard deviation of the weighted residuals of each FRF.
    pub deviations: Vec<f64>,
    /// `J^T J` over `omega`, `zeta` of each pole, in s/rad and 1.
    pub information: DMatrix<f64>,
    /// `d Phi / d theta c` of each FRF: the change of its weighted values.
    pub slopes: Vec<DMatrix<f64>>,
}

/// Refines `start`; `None` if the FRFs do not determine the coefficients.
pub(super) fn refine(frfs: &[Frf], start: &[Pole]) -> Option<Refined> {
    let mut poles = start.to_vec();
    let mut solved = solve_all(frfs, &poles)?;
    let mut deviations = vec![];
    for _ in 0..ROUNDS {
        deviations = deviations_of(frfs, &solved, poles.len());
        (poles, solved) = descend(frfs, poles, solved, &deviations)?;
    }
    let slopes = slopes(frfs, &poles, &solved);
    let information = information(&solved, &slopes, &deviations).0;
    Some(Refined {
        deviations: deviations_of(frfs, &solved, poles.len()),
        poles,
        solved,
        information,
        slopes,
    })
}

/// The sum of squares of the weighted residuals of an FRF, at least that of rounding errors.
pub(super) fn squares(frf: &Frf, solved: &Solved) -> f64 {
    solved
        .residuals
        .norm_squared()
        .max(ROUNDING * ROUNDING * frf.energy())
}

fn solve_all(frfs: &[Frf], poles: &[Pole]) -> Option<Vec<Solved>> {
    frfs.iter().map(|frf| solve(frf, &columns(frf, poles))).collect()
}

fn deviations_of(frfs: &[Frf], solved: &[Solved], poles: usize) -> Vec<f64> {
    // Each pole takes two parameters from all FRFs together.
    let own = RESIDUALS as f64 + poles as f64 * (1.0 + 2.0 / frfs.len() as f64);
    let pairs = frfs.iter().zip(solved);
    pairs
        .map(|(frf, solved)| {
            let free = (solved.residuals.len() as f64 - own).max(1.0);
            (squares(frf, solved) / free).sqrt()
        })
        .collect()
}

/// One search with fixed standard deviations.
fn descend(
    frfs: &[Frf],
    mut poles: Vec<Pole>,
    mut solved: Vec<Solved>,
    deviations: &[f64],
) -> Option<(Vec<Pole>, Vec<Solved>)> {
    let total = |solved: &[Solved]| -> f64 {
        let pairs = solved.iter().zip(deviations);
        pairs.map(|(own, s)| own.residuals.norm_squared() / (s * s)).sum()
    };
    let mut sum = total(&solved);
    let mut mu = 1e-3;
    for _ in 0..MOST_STEPS {
        let slopes = slopes(frfs, &poles, &solved);
        let (matrix, gradient) = information(&solved, &slopes, deviations);
        let mut better = None;
        while mu < MOST_DAMPING && better.is_none() {
            let mut damped = matrix.clone();
            for k in 0..damped.nrows() {
                damped[(k, k)] *= 1.0 + mu;
            }
            let step = scaled_solve(&damped, &gradient)?;
            if let Some(next) = moved(&poles, &step)
                && let Some(solved) = solve_all(frfs, &next)
                && total(&solved) <= sum
            {
                better = Some((next, solved));
            } else {
                mu *= 4.0;
            }
        }
        let Some((next, next_solved)) = better else { break };
        (poles, solved) = (next, next_solved);
        mu = (mu / 6.0).max(1e-12);
        let before = std::mem::replace(&mut sum, total(&solved));
        if before - sum <= END * before {
            break;
        }
    }
    Some((poles, solved))
}

/// The poles after a step; `None` if one leaves its range.
fn moved(poles: &[Pole], step: &DVector<f64>) -> Option<Vec<Pole>> {
    let moved = poles.iter().enumerate().map(|(k, pole)| {
        let next = Pole {
            angular_frequency: pole.angular_frequency + step[2 * k],
            damping_ratio: pole.damping_ratio + step[2 * k + 1],
        };
        let ratio = next.angular_frequency / pole.angular_frequency;
        let is_valid = (0.5..2.0).contains(&ratio) && (DAMPING[0]..DAMPING[1]).contains(&next.damping_ratio);
        is_valid.then_some(next)
    });
    moved.collect()
}

/// The solution of a symmetric system, with its diagonal scaled to one.
pub(super) fn scaled_solve(matrix: &DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    let scale = matrix.diagonal().map(|d| 1.0 / d.max(f64::MIN_POSITIVE).sqrt());
    let scaled = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
        matrix[(i, j)] * scale[i] * scale[j]
    });
    let solution = scaled.cholesky()?.solve(&right.component_mul(&scale));
    Some(solution.component_mul(&scale))
}

/// Change of the weighted values of each FRF by `omega` and `zeta` of each pole.
fn slopes(frfs: &[Frf], poles: &[Pole], solved: &[Solved]) -> Vec<DMatrix<f64>> {
    let pairs = frfs.iter().zip(solved);
    pairs
        .map(|(frf, solved)| {
            let mut all = DMatrix::zeros(solved.residuals.len(), 2 * poles.len());
            for (k, pole) in poles.iter().enumerate() {
                let (omega, zeta) = (pole.angular_frequency, pole.damping_ratio);
                let a = solved.coefficients[k];
                let slope = |of: &dyn Fn(f64) -> Complex<f64>| -> DVector<f64> {
                    let values: Vec<Complex<f64>> = (frf.angular_frequencies.iter())
                        .map(|w| {
                            let q = dynamic(pole, *w);
                            -of(*w) * q * q * a
                        })
                        .collect();
                    weighted(frf, &values)
                };
                all.set_column(2 * k, &slope(&|w| Complex::new(2.0 * omega, 2.0 * zeta * w)));
                all.set_column(2 * k + 1, &slope(&|w| Complex::new(0.0, 2.0 * omega * w)));
            }
            all
        })
        .collect()
}

/// `J^T J` and `-J^T r`.
fn information(
    solved: &[Solved],
    slopes: &[DMatrix<f64>],
    deviations: &[f64],
) -> (DMatrix<f64>, DVector<f64>) {
    let size = slopes.first().map_or(0, DMatrix::ncols);
    let (mut matrix, mut gradient) = (DMatrix::zeros(size, size), DVector::zeros(size));
    for ((own, slope), s) in solved.iter().zip(slopes).zip(deviations) {
        let beyond = slope - &own.basis * (own.basis.transpose() * slope);
        matrix += beyond.transpose() * &beyond / (s * s);
        gradient += beyond.transpose() * &own.residuals / (s * s);
    }
    (matrix, gradient)
}

//! Uncertainty of each part: from the residuals, and from repeated runs.
//!
//! | from | standard uncertainty |
//! |---|---|
//! | residuals | `sqrt(C_jj sigma^2 tau)`, `C` the inverse of the normal matrix, `sigma^2` the mean square left |
//! | repeated runs | each run adds its part to a value; the scatter of these among runs of one direction |
//!
//! Residuals along a circle are correlated: `tau = 1 + 2 sum rho_k` is the number of samples with the information of
//! one, `rho_k` their correlation `k` samples apart, up to the first that is not positive. Where runs scatter more than
//! the residuals indicate, in the mean over all parts, all uncertainties are increased; and no part has less than its
//! own scatter.

use nalgebra::{DMatrix, DVector};

use super::super::run::Direction;
use super::samples::Samples;

/// Covariance of the values of the columns of `rows`, from the residuals and the inverse of their normal matrix; the
/// degrees of freedom are those of this many samples.
pub(in super::super) fn covariance(
    samples: &Samples,
    rows: &DMatrix<f64>,
    rest: &DVector<f64>,
    inverse: &DMatrix<f64>,
    freedom: usize,
) -> DMatrix<f64> {
    let variance = rest.norm_squared() / freedom as f64 * hanging_together(samples, rest);
    let of_rest = inverse * variance;
    let Some(of_runs) = between_runs(samples, rows, rest, inverse) else {
        return of_rest;
    };
    let known = of_rest.diagonal();
    let ratios = of_runs.iter().zip(&known);
    let ratio: f64 = ratios
        .map(|(runs, rest)| if *rest > 0.0 { runs / rest } else { 0.0 })
        .sum();
    let wider = (ratio / known.len() as f64).max(1.0);
    // Correlated parts stay correlated: each grows as its own uncertainty does.
    let grown = |k: usize| match known[k] > 0.0 {
        true => (known[k] * wider).max(of_runs[k]).sqrt() / known[k].sqrt(),
        false => 1.0,
    };
    DMatrix::from_fn(known.len(), known.len(), |i, k| {
        of_rest[(i, k)] * grown(i) * grown(k)
    })
}

/// `tau`: the variance of a sum of residuals over that of uncorrelated ones.
fn hanging_together(samples: &Samples, rest: &DVector<f64>) -> f64 {
    let runs: Vec<&[f64]> = samples
        .begins
        .windows(2)
        .map(|ends| &rest.as_slice()[ends[0]..ends[1]])
        .collect();
    let product = |lag: usize| -> f64 {
        let of = |run: &&[f64]| -> f64 { (0..run.len()).map(|k| run[k] * run[(k + lag) % run.len()]).sum() };
        runs.iter().filter(|run| run.len() > lag).map(of).sum()
    };
    let square = product(0);
    let longest = runs.iter().map(|run| run.len()).max().unwrap_or(0) / 4;
    if square <= 0.0 {
        return 1.0;
    }
    let correlations = (1..longest).map(|lag| product(lag) / square);
    1.0 + 2.0 * correlations.take_while(|rho| *rho > 0.0).sum::<f64>()
}

/// Variance of each value by the scatter among runs of one direction, of all circles; `None` where a circle has no
/// direction with two.
fn between_runs(
    samples: &Samples,
    rows: &DMatrix<f64>,
    rest: &DVector<f64>,
    inverse: &DMatrix<f64>,
) -> Option<Vec<f64>> {
    let mut sum = vec![0.0; rows.ncols()];
    let mut first = 0;
    for runs in &samples.runs {
        let begins = &samples.begins[first..=first + runs];
        let added: Vec<(Direction, DVector<f64>)> = begins
            .windows(2)
            .filter(|ends| ends[1] > ends[0])
            .map(|ends| {
                let count = ends[1] - ends[0];
                let of_run = rows.rows(ends[0], count).tr_mul(&rest.rows(ends[0], count));
                (samples.at[ends[0]].1, inverse * of_run)
            })
            .collect();
        let variances = between_runs_of_one_circle(&added, rows.ncols())?;
        for (sum, variance) in sum.iter_mut().zip(variances) {
            *sum += variance;
        }
        first += runs;
    }
    Some(sum)
}

/// The same of one circle, from the additions of each run.
fn between_runs_of_one_circle(added: &[(Direction, DVector<f64>)], values: usize) -> Option<Vec<f64>> {
    let of = |direction: Direction| -> Vec<&DVector<f64>> {
        let runs = added.iter().filter(|(of, _)| *of == direction);
        runs.map(|(_, added)| added).collect()
    };
    let scatter = |runs: &[&DVector<f64>], index: usize| -> f64 {
        let mean = runs.iter().map(|run| run[index]).sum::<f64>() / runs.len() as f64;
        let squares: f64 = runs.iter().map(|run| (run[index] - mean).powi(2)).sum();
        squares / (runs.len() - 1) as f64
    };
    let [clockwise, anticlockwise] = Direction::BOTH.map(of);
    let variance = |index: usize| -> f64 {
        let sides = [(&clockwise, &anticlockwise), (&anticlockwise, &clockwise)];
        // A single run is given the scatter of the other direction.
        let of = |(own, other): (&Vec<&DVector<f64>>, &Vec<&DVector<f64>>)| {
            let repeated = if own.len() > 1 { own } else { other };
            own.len() as f64 * scatter(repeated, index)
        };
        sides.into_iter().filter(|(own, _)| !own.is_empty()).map(of).sum()
    };
    (clockwise.len().max(anticlockwise.len()) > 1).then(|| (0..values).map(variance).collect())
}

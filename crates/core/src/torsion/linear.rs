//! Linear estimation with instruments, and the covariance for residuals that are correlated in time.
//!
//! ```text
//! beta = (Z'X)^-1 Z'y,  cov = s^2 g (Z'X)^-1 Z'Z (X'Z)^-1,  g = 1 + 2 sum r_k
//! ```
//!
//! A column that the columns before it describe is left out: it is not determined.

use nalgebra::{DMatrix, DVector};

/// Part of the norm of a column that has to remain next to the columns before it.
const INDEPENDENT: f64 = 1e-6;

/// A regressor, with the values of its instrument.
#[derive(Clone, Debug)]
pub(crate) struct Column {
    pub values: Vec<f64>,
    pub instrument: Vec<f64>,
}

impl Column {
    /// A regressor without noise.
    pub(crate) fn exact(values: Vec<f64>) -> Column {
        Column {
            instrument: values.clone(),
            values,
        }
    }
}

/// Estimated coefficients.
#[derive(Clone, Debug)]
pub(crate) struct Estimated {
    /// Coefficient of each column; `None` if it is not determined.
    pub values: Vec<Option<f64>>,
    /// Standard uncertainty of each; 0 where there is no coefficient.
    pub u: Vec<f64>,
    /// Correlation of each pair; 0 where there is no coefficient.
    pub correlation: DMatrix<f64>,
    /// Residuals.
    pub residuals: Vec<f64>,
    /// Number of samples that are as good as one independent one.
    pub inflation: f64,
}

/// Estimates the coefficients of the columns for `target`; `None` if there are fewer independent samples than columns, or no solution.
pub(crate) fn estimate(columns: &[Column], target: &[f64]) -> Option<Estimated> {
    let kept = independent(columns);
    let rows = target.len();
    if kept.is_empty() || rows <= kept.len() {
        return None;
    }
    let scales: Vec<f64> = kept.iter().map(|index| norm(&columns[*index].values)).collect();
    let x = DMatrix::from_fn(rows, kept.len(), |row, k| {
        columns[kept[k]].values[row] / scales[k]
    });
    let z = DMatrix::from_fn(rows, kept.len(), |row, k| {
        columns[kept[k]].instrument[row] / scales[k]
    });
    let y = DVector::from_column_slice(target);
    let inverse = (z.transpose() * &x).try_inverse()?;
    let beta = &inverse * (z.transpose() * &y);
    let residuals: Vec<f64> = (y - &x * &beta).iter().copied().collect();
    let inflation = inflation(&residuals);
    let free = rows as f64 / inflation - kept.len() as f64;
    if free <= 0.0 || beta.iter().any(|value| !value.is_finite()) {
        return None;
    }
    let sum: f64 = residuals.iter().map(|residual| residual * residual).sum();
    // s^2 g, with the degrees of freedom of the independent samples.
    let variance = sum / free;
    let covariance = &inverse * (z.transpose() * &z) * inverse.transpose() * variance;
    let mut estimated = Estimated {
        values: vec![None; columns.len()],
        u: vec![0.0; columns.len()],
        correlation: DMatrix::identity(columns.len(), columns.len()),
        residuals,
        inflation,
    };
    for (k, index) in kept.iter().enumerate() {
        estimated.values[*index] = Some(beta[k] / scales[k]);
        estimated.u[*index] = covariance[(k, k)].max(0.0).sqrt() / scales[k];
        for (other, second) in kept.iter().enumerate() {
            let both = (covariance[(k, k)] * covariance[(other, other)]).sqrt();
            if k != other && both > 0.0 {
                estimated.correlation[(*index, *second)] = covariance[(k, other)] / both;
            }
        }
    }
    Some(estimated)
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// Columns that those before them do not describe (Gram and Schmidt).
fn independent(columns: &[Column]) -> Vec<usize> {
    let mut basis: Vec<DVector<f64>> = Vec::new();
    let mut kept = Vec::new();
    for (index, column) in columns.iter().enumerate() {
        let mut rest = DVector::from_column_slice(&column.values);
        let whole = rest.norm();
        for direction in &basis {
            rest -= direction * direction.dot(&rest);
        }
        let left = rest.norm();
        if left > INDEPENDENT * whole {
            basis.push(rest / left);
            kept.push(index);
        }
    }
    kept
}

/// Number of samples that are as good as one: `1 + 2 sum r_k` up to the first autocorrelation that is not positive.
pub(crate) fn inflation(residuals: &[f64]) -> f64 {
    let mean = residuals.iter().sum::<f64>() / residuals.len().max(1) as f64;
    let centred: Vec<f64> = residuals.iter().map(|residual| residual - mean).collect();
    let power: f64 = centred.iter().map(|value| value * value).sum();
    if power <= 0.0 {
        return 1.0;
    }
    let mut sum = 1.0;
    for lag in 1..centred.len() / 2 {
        let product: f64 = centred.iter().zip(&centred[lag..]).map(|(a, b)| a * b).sum();
        if product <= 0.0 {
            break;
        }
        sum += 2.0 * product / power;
    }
    sum
}

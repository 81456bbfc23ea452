//! Non-linear least squares with bounds from below, by Levenberg and Marquardt, with standard uncertainties of residuals that are correlated in time.
//!
//! ```text
//! u^2 = diag((J^T J)^-1) s^2 (1 + rho)/(1 - rho)
//! ```
//!
//! `s` is the standard deviation of the residuals, `rho` the correlation of neighbours: as of a process of first order, n residuals are as good
//! as `n (1 - rho)/(1 + rho)` independent ones.

use armill_core::nalgebra::{DMatrix, DVector};

/// Iterations at most.
const MOST: usize = 60;
/// A relative change of the sum of squares below this ends it.
const PRECISION: f64 = 1e-9;
/// Greatest correlation of neighbours that is used.
const MOST_CORRELATED: f64 = 0.98;

/// A parameter: where it begins, the step of its derivative, and its least value.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parameter {
    pub start: f64,
    pub step: f64,
    pub least: f64,
}

/// Fitted parameters.
#[derive(Clone, Debug)]
pub(super) struct Fitted {
    pub values: Vec<f64>,
    /// Standard uncertainty of each; infinite where it is not determined.
    pub u: Vec<f64>,
    /// Correlation of each pair; 0 where it is not known.
    pub correlation: DMatrix<f64>,
    /// Root mean square of the residuals.
    pub rms: f64,
}

/// The parameters with the least sum of squares of these residuals.
pub(super) fn least_squares(parameters: &[Parameter], residuals: impl Fn(&[f64]) -> Vec<f64>) -> Fitted {
    let count = parameters.len();
    let mut values: Vec<f64> = parameters.iter().map(|parameter| parameter.start).collect();
    let mut here = DVector::from_vec(residuals(&values));
    let mut damping = 1e-3;
    for _ in 0..MOST {
        let jacobian = jacobian(parameters, &values, &here, &residuals);
        let normal = jacobian.transpose() * &jacobian;
        let gradient = jacobian.transpose() * &here;
        let before = here.norm_squared();
        let mut improved = false;
        while damping < 1e8 && !improved {
            let mut damped = normal.clone();
            for k in 0..count {
                damped[(k, k)] += damping * normal[(k, k)].max(f64::MIN_POSITIVE);
            }
            let Some(step) = damped.lu().solve(&gradient) else {
                break;
            };
            let next: Vec<f64> = (values.iter().zip(parameters).zip(step.iter()))
                .map(|((value, parameter), step)| (value - step).max(parameter.least))
                .collect();
            let there = DVector::from_vec(residuals(&next));
            if there.norm_squared() < before {
                (values, here, improved) = (next, there, true);
                damping *= 0.2;
            } else {
                damping *= 5.0;
            }
        }
        if !improved || before - here.norm_squared() < PRECISION * before {
            break;
        }
    }
    let last = jacobian(parameters, &values, &here, &residuals);
    uncertain(values, &last, &here)
}

fn jacobian(
    parameters: &[Parameter],
    values: &[f64],
    here: &DVector<f64>,
    residuals: &impl Fn(&[f64]) -> Vec<f64>,
) -> DMatrix<f64> {
    let columns: Vec<DVector<f64>> = (0..parameters.len())
        .map(|k| {
            let mut moved = values.to_vec();
            moved[k] += parameters[k].step;
            (DVector::from_vec(residuals(&moved)) - here) / parameters[k].step
        })
        .collect();
    DMatrix::from_columns(&columns)
}

fn uncertain(values: Vec<f64>, jacobian: &DMatrix<f64>, residuals: &DVector<f64>) -> Fitted {
    let (n, count) = (residuals.len(), values.len());
    let free = n.saturating_sub(count).max(1) as f64;
    let variance = residuals.norm_squared() / free;
    let rho = correlation_of_neighbours(residuals.as_slice()).clamp(0.0, MOST_CORRELATED);
    let scale = variance * (1.0 + rho) / (1.0 - rho);
    // Columns of length 1, so that the units do not matter.
    let norms: Vec<f64> = jacobian.column_iter().map(|column| column.norm()).collect();
    let unit = |k: usize| if norms[k] > 0.0 { 1.0 / norms[k] } else { 1.0 };
    let scaled = DMatrix::from_fn(n, count, |row, k| jacobian[(row, k)] * unit(k));
    let inverse = (scaled.transpose() * &scaled).try_inverse();
    let covariance = |a: usize, b: usize| {
        let inverse = inverse.as_ref()?;
        Some(inverse[(a, b)] * unit(a) * unit(b) * scale).filter(|value| value.is_finite())
    };
    let u: Vec<f64> = (0..count)
        .map(|k| {
            let own = covariance(k, k).filter(|value| *value >= 0.0 && norms[k] > 0.0);
            own.map_or(f64::INFINITY, f64::sqrt)
        })
        .collect();
    let correlation = DMatrix::from_fn(count, count, |a, b| {
        let both = u[a] * u[b];
        covariance(a, b)
            .filter(|_| both > 0.0 && both.is_finite())
            .map_or(0.0, |value| value / both)
    });
    Fitted {
        values,
        u,
        correlation,
        rms: (residuals.norm_squared() / n.max(1) as f64).sqrt(),
    }
}

fn correlation_of_neighbours(residuals: &[f64]) -> f64 {
    let all: f64 = residuals.iter().map(|r| r * r).sum();
    let pairs: f64 = residuals.windows(2).map(|pair| pair[0] * pair[1]).sum();
    if all > 0.0 { pairs / all } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Noise of a fixed sequence, uniform in -1 to 1.
    fn noise(count: usize) -> Vec<f64> {
        let mut state = 12345_u64;
        (0..count)
            .map(|_| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                (state >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
            })
            .collect()
    }

    #[test]
    fn a_line_is_fitted_with_the_uncertainty_of_linear_regression() {
        let noise = noise(400);
        let parameter = |start| Parameter {
            start,
            step: 1e-3,
            least: f64::NEG_INFINITY,
        };
        let found = least_squares(&[parameter(0.0), parameter(5.0)], |p| {
            (0..400)
                .map(|i| p[0] + p[1] * f64::from(i) - 2.0 - 0.03 * f64::from(i) - noise[i as usize])
                .collect()
        });
        // u(slope) = s / sqrt(sum (x - mean)^2), s^2 = 1/3.
        let u = (1.0_f64 / 3.0).sqrt() / (400.0_f64 * (400.0 * 400.0 - 1.0) / 12.0).sqrt();
        assert!((found.values[1] - 0.03).abs() < 3.0 * u, "{found:?}");
        assert!((found.u[1] / u - 1.0).abs() < 0.15, "{} {u}", found.u[1]);
    }

    #[test]
    fn what_has_no_effect_is_not_determined_and_bounds_are_kept() {
        let parameter = |start| Parameter {
            start,
            step: 1e-3,
            least: 0.0,
        };
        let found = least_squares(&[parameter(1.0), parameter(1.0)], |p| {
            vec![p[0] + 1.0, p[0] + 2.0, p[0]]
        });
        assert_eq!(found.values[0], 0.0);
        assert!(found.u[1].is_infinite());
    }
}

//! Uncertainty of the boundary of stability, and the probability that a cut is stable.
//!
//! ```text
//! l = ln b        d_i = (l(p_i + u_i) - l(p_i - u_i))/2        u(l)^2 = sum of d_i^2
//! P(stable at the depth a) = Phi((l - ln a)/u(l))
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `b`, `a` | depth at the boundary, depth of the cut | m |
//! | `p_i`, `u_i` | frequency, damping ratio and stiffness of each mode, parameters of the cutting law; their standard uncertainty | |
//! | `Phi` | distribution function of the standard normal distribution | - |
//!
//! Correlated parameters of the law are changed along the columns of the Cholesky factor of their covariance. The differences span two standard
//! uncertainties, so that a speed near the edge of a lobe has the depth on both sides of it; the distribution of `l` is taken as normal.
//!
//! Source: JCGM 100 (GUM), 5.1.3, with differences in place of derivatives (note 2 there) \[recalled\].

use nalgebra::Vector6;

use super::cut_of_any_depth::CutOfAnyDepth;
use super::lobes::StabilityLobes;
use super::named_mode::{Factors, NamedMode, modes};
use super::zeroth_order::Boundary;
use crate::load::CuttingError;

/// The boundary with its uncertainty.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundaryUncertainty {
    /// At the best estimates.
    pub boundary: Boundary,
    /// Standard uncertainty of the logarithm of its depth: relative, if it is small.
    pub of_log_depth: f64,
    /// Part of the variance by each mode, in their order, and by the cutting law; their sum is 1, or all are 0.
    pub shares: Vec<f64>,
}

/// Least factor on a parameter, where its uncertainty is nearly as large as itself.
const LEAST_FACTOR: f64 = 0.05;

impl BoundaryUncertainty {
    /// Of the boundary at this spindle speed (rad/s); `None` if it is deeper than `deepest` (m), at the best estimates. Where it is so
    /// only at changed parameters, `deepest` takes its place.
    ///
    /// # Errors
    /// As [`crate::load::Milling::new`].
    pub fn at_speed(
        named: &[NamedMode],
        cutting: &CutOfAnyDepth,
        spindle: f64,
        deepest: f64,
    ) -> Result<Option<BoundaryUncertainty>, CuttingError> {
        let best = modes(named);
        let depth_of =
            |modes: &[crate::dynamics::Mode], cutting: &CutOfAnyDepth| -> Result<f64, CuttingError> {
                let found = StabilityLobes::new(modes, cutting, deepest)?.at_speed(spindle);
                Ok(found.map_or(deepest, |boundary| boundary.depth).ln())
            };
        let Some(boundary) = StabilityLobes::new(&best, cutting, deepest)?.at_speed(spindle) else {
            return Ok(None);
        };
        let mut variances = Vec::with_capacity(named.len() + 1);
        for (index, mode) in named.iter().enumerate() {
            let mut variance = 0.0;
            for (parameter, u) in mode.uncertainty.as_array().into_iter().enumerate() {
                if u == 0.0 {
                    continue;
                }
                let changed = |sign: f64| {
                    let mut factors = Factors([1.0; 3]);
                    factors.0[parameter] = (1.0 + sign * u).max(LEAST_FACTOR);
                    let mut others = best.clone();
                    others[index] = factors.on(&mode.mode);
                    depth_of(&others, cutting)
                };
                variance += half_difference(changed(1.0)?, changed(-1.0)?).powi(2);
            }
            variances.push(variance);
        }
        let law = cutting.milling().law();
        let mut of_law = 0.0;
        for column in columns(law.covariance()) {
            let changed = |sign: f64| -> Result<f64, CuttingError> {
                depth_of(&best, &cutting.with_law(law.changed(&(column * sign)))?)
            };
            of_law += half_difference(changed(1.0)?, changed(-1.0)?).powi(2);
        }
        variances.push(of_law);
        let total: f64 = variances.iter().sum();
        let share = |variance: &f64| if total > 0.0 { variance / total } else { 0.0 };
        Ok(Some(BoundaryUncertainty {
            boundary,
            of_log_depth: total.sqrt(),
            shares: variances.iter().map(share).collect(),
        }))
    }

    /// The same relative uncertainty about another boundary, such as that of a more accurate solution.
    #[must_use]
    pub fn about(self, boundary: Boundary) -> BoundaryUncertainty {
        BoundaryUncertainty { boundary, ..self }
    }

    /// Probability that a cut of this depth (m, above zero) is stable, from 0 to 1.
    pub fn probability_stable(&self, depth: f64) -> f64 {
        let distance = (self.boundary.depth / depth).ln();
        if self.of_log_depth == 0.0 {
            return if distance > 0.0 { 1.0 } else { 0.0 };
        }
        0.5 * libm::erfc(-distance / (self.of_log_depth * std::f64::consts::SQRT_2))
    }
}

fn half_difference(above: f64, below: f64) -> f64 {
    0.5 * (above - below)
}

/// Columns of the Cholesky factor of a covariance that may be singular, without those that are zero.
fn columns(covariance: nalgebra::Matrix6<f64>) -> Vec<Vector6<f64>> {
    let mut rest = covariance;
    let mut columns = Vec::new();
    for pivot in 0..6 {
        let variance = rest[(pivot, pivot)];
        if variance <= 1e-12 * covariance[(pivot, pivot)] || variance <= 0.0 {
            continue;
        }
        let column: Vector6<f64> = rest.column(pivot) / variance.sqrt();
        rest -= column * column.transpose();
        columns.push(column);
    }
    columns
}

#[cfg(test)]
mod tests;

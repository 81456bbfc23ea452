//! Prior knowledge of an arm: its small motions are near zero.
//!
//! Each small motion of the chain is drawn from a normal distribution about zero; readings have the unknown standard
//! deviation `s`. The most likely geometry is the least of
//!
//! ```text
//! |r|^2 + sum over k of (s x_k / sigma_k)^2          s^2 = |r|^2 / (m - g)
//! g = p - sum over k of (s / sigma_k)^2 C_kk          C = (J'J + diag (s / sigma_k)^2)^-1        cov = s^2 C
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `x_k`, `sigma_k` | small motion of the chain, its standard deviation for arms of this kind | m, rad |
//! | `r`, `m` | residuals, their number | m |
//! | `p`, `g` | unknowns, effective number of parameters | |
//!
//! Well determined unknowns are the same as without a prior; others stay near the nominal values instead of
//! compensating model errors. Base and point have no prior. `s` and the geometry are iterated until `s` is constant.
//!
//! Source: D. MacKay, Bayesian interpolation, Neural Computation 4, 1992 (`g`: the effective number of parameters).

use nalgebra::DMatrix;

use super::arm::Arm;
use super::unknown::{ParameterLocation, Unknown};

/// Standard deviations of the small motions of the chain about zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// Of those along an axis, m.
    pub length: f64,
    /// Of those about an axis, rad.
    pub angle: f64,
}

impl Prior {
    /// Whether both are valid.
    pub(super) fn is_sound(&self) -> bool {
        let sound = |sigma: f64| sigma > 0.0 && sigma.is_finite();
        sound(self.length) && sound(self.angle)
    }
}

/// Weights of the prior of small motions: `s / sigma`, 1 and m; 0 for no prior.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PriorWeights {
    length: f64,
    angle: f64,
}

impl PriorWeights {
    /// No prior.
    pub const NONE: PriorWeights = PriorWeights {
        length: 0.0,
        angle: 0.0,
    };

    /// The weights of `prior`, with readings of the standard deviation `s`, m.
    pub fn of(prior: &Prior, s: f64) -> PriorWeights {
        PriorWeights {
            length: s / prior.length,
            angle: s / prior.angle,
        }
    }

    fn weight(self, unknown: &Unknown) -> f64 {
        match unknown.place {
            ParameterLocation::Base | ParameterLocation::Tool => 0.0,
            ParameterLocation::After(_) if unknown.turns() => self.angle,
            ParameterLocation::After(_) => self.length,
        }
    }

    /// A row for each of `unknowns` that has a prior: its weight, and its distance from zero.
    pub fn rows(self, arm: &Arm<'_>, unknowns: &[Unknown]) -> DMatrix<f64> {
        let weights = self.weights_of(unknowns);
        let mut rows = DMatrix::zeros(weights.len(), unknowns.len() + 1);
        for (row, (column, weight)) in weights.into_iter().enumerate() {
            rows[(row, column)] = weight;
            rows[(row, unknowns.len())] = -weight * arm.value(&unknowns[column]);
        }
        rows
    }

    /// What this adds to the sum of squares, m^2.
    pub fn cost(self, arm: &Arm<'_>, unknowns: &[Unknown]) -> f64 {
        let square = |unknown: &Unknown| (self.weight(unknown) * arm.value(unknown)).powi(2);
        unknowns.iter().map(square).sum()
    }

    /// Effective number of parameters among `unknowns`; `inverse` is `C`.
    pub fn effective_parameters(self, unknowns: &[Unknown], inverse: &DMatrix<f64>) -> f64 {
        let by_prior = |(column, weight): (usize, f64)| weight * weight * inverse[(column, column)];
        let weights = self.weights_of(unknowns);
        unknowns.len() as f64 - weights.into_iter().map(by_prior).sum::<f64>()
    }

    fn weights_of(self, unknowns: &[Unknown]) -> Vec<(usize, f64)> {
        let weights = unknowns.iter().map(|unknown| self.weight(unknown)).enumerate();
        weights.filter(|(_, weight)| *weight > 0.0).collect()
    }
}

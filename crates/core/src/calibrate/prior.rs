//! What is known of an arm before it is measured: its small motions are near zero.
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
//! | `x_k`, `sigma_k` | small motion of the chain, standard deviation that arms of its kind have of it | m, rad |
//! | `r`, `m` | residuals, how many | m |
//! | `p`, `g` | unknowns, and how many of them the poses tell rather than the prior | |
//!
//! What poses tell well is as without it; what they hardly tell stays near the drawing in place of taking up what the
//! model lacks. Base and point are not held. `s` and the geometry are found in turn until `s` stays as it is.
//!
//! Source: D. MacKay, Bayesian interpolation, Neural Computation 4, 1992 (`g`: the effective number of parameters).

use nalgebra::DMatrix;

use super::arm::Arm;
use super::unknown::{Place, Unknown};

/// Standard deviations of the small motions of the chain about zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// Of those along an axis, m.
    pub length: f64,
    /// Of those about an axis, rad.
    pub angle: f64,
}

impl Prior {
    /// Whether both can be.
    pub(super) fn is_sound(&self) -> bool {
        let sound = |sigma: f64| sigma > 0.0 && sigma.is_finite();
        sound(self.length) && sound(self.angle)
    }
}

/// How strongly small motions are held to zero: weights `s / sigma`, 1 and m; 0 holds nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hold {
    length: f64,
    angle: f64,
}

impl Hold {
    /// Nothing is held.
    pub const NOTHING: Hold = Hold {
        length: 0.0,
        angle: 0.0,
    };

    /// Of `prior`, with readings of the standard deviation `s`, m.
    pub fn of(prior: &Prior, s: f64) -> Hold {
        Hold {
            length: s / prior.length,
            angle: s / prior.angle,
        }
    }

    fn weight(self, unknown: &Unknown) -> f64 {
        match unknown.place {
            Place::Base | Place::Tool => 0.0,
            Place::After(_) if unknown.turns() => self.angle,
            Place::After(_) => self.length,
        }
    }

    /// A row for each of `unknowns` that is held: its weight, and what it is short of zero.
    pub fn rows(self, arm: &Arm<'_>, unknowns: &[Unknown]) -> DMatrix<f64> {
        let evaluation = self.evaluation(unknowns);
        let mut rows = DMatrix::zeros(evaluation.len(), unknowns.len() + 1);
        for (row, (column, weight)) in evaluation.into_iter().enumerate() {
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

    /// How many of `unknowns` the poses tell; `inverse` is `C`.
    pub fn reported(self, unknowns: &[Unknown], inverse: &DMatrix<f64>) -> f64 {
        let by_prior = |(column, weight): (usize, f64)| weight * weight * inverse[(column, column)];
        let evaluation = self.evaluation(unknowns);
        unknowns.len() as f64 - evaluation.into_iter().map(by_prior).sum::<f64>()
    }

    fn evaluation(self, unknowns: &[Unknown]) -> Vec<(usize, f64)> {
        let weights = unknowns.iter().map(|unknown| self.weight(unknown)).enumerate();
        weights.filter(|(_, weight)| *weight > 0.0).collect()
    }
}

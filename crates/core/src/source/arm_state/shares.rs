//! Contributions to the displacement of an arm under its last load, and their uncertainty.
//!
//! `cov(delta) = A S A^T + m^2 delta delta^T + sum_j l_j l_j^T`, columns `a_k`: displacement per unit of compliance k; `l_j`: by one standard
//! uncertainty of mass j (`uncertain_masses`). `S` is the
//! covariance of the structure; compliances outside it are independent. `m` is its model error: the part that no
//! compliance explains, as a fraction of the displacement by all of them (a discrepancy as of Kennedy and O'Hagan,
//! Bayesian calibration of computer models, J. R. Stat. Soc. B 63, 2001, in proportion to the prediction).

use nalgebra::{Matrix3, Vector3};

use super::ArmState;
use crate::source::Contributor;
use crate::spatial::Twist;

impl ArmState<'_> {
    /// Part of drive or spring `k` in the displacement under the last load, gravity included.
    pub fn part(&self, k: usize) -> Twist {
        let elastic = self.screws[k] * self.turns[k];
        match self.sagged(k) {
            Some((sag, (there, _))) => elastic + self.screws[k] * sag - there,
            None => elastic,
        }
    }

    /// Displacement of the TCP per unit of compliance of drive or spring `k`, under the last load and gravity.
    pub fn sensitivity(&self, k: usize) -> Vector3<f64> {
        let grown = self
            .stiffness_factor(k)
            .map_or(1.0, |factor| 1.0 / (factor * factor));
        let elastic = self.screws[k].linear * self.torques[k];
        match self.sagged(k) {
            Some((_, (_, there))) => (elastic + self.screws[k].linear * self.before[k]) * grown - there,
            None => elastic * grown,
        }
    }

    /// Parts by contributor ([`crate::source::StiffnessModel::contributors`]): the drive of a joint with the springs of
    /// its attachment, then the others.
    pub fn shares(&self) -> Vec<Twist> {
        let contributors = self.arm.model.contributors(self.theta.len());
        let of = |contributor: &Contributor| {
            let own =
                (0..self.attachments.len()).filter(|k| Contributor::At(self.attachments[*k]) == *contributor);
            own.map(|k| self.part(k)).sum()
        };
        contributors.iter().map(of).collect()
    }

    /// Writes the part of each contributor along the unit vector `along` (m) into `shares`, one per contributor.
    pub fn share_along(&self, along: &Vector3<f64>, contributors: &[Contributor], shares: &mut [f64]) {
        shares.fill(0.0);
        for (k, attachment) in self.attachments.iter().enumerate() {
            if let Some(share) = contributors
                .iter()
                .position(|contributor| *contributor == Contributor::At(*attachment))
            {
                shares[share] += self.part(k).linear.dot(along);
            }
        }
    }

    /// Variance (m^2) of the displacement along the unit vector `along`, from the compliances, the masses and the model error.
    pub fn variance_along(&self, along: &Vector3<f64>) -> f64 {
        let a = |k: usize| self.sensitivity(k).dot(along);
        let by_masses: f64 = self.by_masses().map(|by_mass| by_mass.dot(along).powi(2)).sum();
        self.variances(a, |a, b| a * b, self.model_error().dot(along).powi(2) + by_masses)
    }

    /// Model error of the displacement under the last load, one standard deviation along it, m.
    pub fn model_error(&self) -> Vector3<f64> {
        match self.arm.model.structure.model_error {
            0.0 => Vector3::zeros(),
            fraction => {
                (0..self.attachments.len())
                    .map(|k| self.part(k).linear)
                    .sum::<Vector3<f64>>()
                    * fraction
            }
        }
    }

    /// Standard deviation (m) of the attained tool position, along any axis.
    pub fn scatter(&self) -> f64 {
        self.arm.model.structure.repeatability
    }

    /// Covariance (m^2) of the displacement, from the compliances, the masses and the model error.
    pub fn covariance(&self) -> Matrix3<f64> {
        let (a, missed) = (|k: usize| self.sensitivity(k), self.model_error());
        let by_masses = self.by_masses().map(|by_mass| by_mass * by_mass.transpose());
        let first = missed * missed.transpose() + by_masses.sum::<Matrix3<f64>>();
        self.variances(a, |a, b| a * b.transpose(), first)
    }

    /// Displacement by gravity due to one standard uncertainty of each uncertain mass, m, base.
    fn by_masses(&self) -> impl Iterator<Item = Vector3<f64>> + '_ {
        let weight = self.weight.iter();
        weight.flat_map(|weight| weight.uncertain.changes(&self.base_from_ground.rotation))
    }

    /// `first + sum_kl S_kl a_k a_l`, with independent compliances where no covariance is known.
    fn variances<A, S>(&self, a: impl Fn(usize) -> A, times: impl Fn(A, A) -> S, first: S) -> S
    where
        S: std::ops::Add<Output = S> + std::ops::Mul<f64, Output = S>,
    {
        let known = self.arm.model.structure.covariance.as_ref();
        let size = known.map_or(0, nalgebra::DMatrix::nrows);
        let mut sum = first;
        if let Some(s) = known {
            for i in 0..size {
                for j in 0..size {
                    sum = sum + times(a(i), a(j)) * s[(i, j)];
                }
            }
        }
        for (k, compliance) in self.compliances.iter().enumerate().skip(size) {
            let u = compliance.standard_uncertainty;
            sum = sum + times(a(k), a(k)) * (u * u);
        }
        sum
    }
}

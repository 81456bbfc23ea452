//! How likely the settings of a Gaussian process are, given the residuals.
//!
//! ```text
//! E(l, n) = 3/2 ln |C| + N/2 sum_c ln s_c^2 + 1/2 sum_j (ln (l_j / l0_j))^2 + 1/2 (ln (n / n0))^2
//! dE/dp = tr (G dC/dp) + prior      G = 3/2 C^-1 - 1/2 sum_c a_c a_c' / s_c^2      a_c = C^-1 y_c
//! ```
//!
//! The negative logarithm of the marginal likelihood of three components with a common `C`, each with its most likely variance
//! `s_c^2`, less constants; and a wide normal prior of the logarithms about `l0` = 1.65 rad (prismatic joints: the range that was
//! measured) and `n0` = 1/2, with standard deviation 1: a joint that was never moved keeps `l0`.
//!
//! Source: Rasmussen and Williams 2006, equations 5.8 and 5.9; `s_c` maximised in closed form.

use nalgebra::{DMatrix, DVector, Vector3};

use crate::robot::Robot;
use crate::robot::learnt::ResidualAt;

/// Logarithm of the prior length scale of a revolute joint, rad.
const LN_ANGLE: f64 = 0.5;
/// Prior scatter.
const SCATTER: f64 = 0.5;
/// Shortest prior length scale of a prismatic joint, m.
const SHORTEST: f64 = 1e-2;
/// Added to the diagonal, as in the process.
const JITTER: f64 = 1e-10;
/// Variance below which residuals are rounding, m^2.
const NOTHING: f64 = 1e-24;

/// Residuals, ready to compare settings.
pub(super) struct Evidence {
    /// Squared distances of all pairs of poses, joint by joint.
    distances: Vec<DMatrix<f64>>,
    y: DMatrix<f64>,
    /// Logarithms of `l0` and `n0`.
    prior: DVector<f64>,
}

impl Evidence {
    /// Of these poses of `robot`, whose residuals have these components.
    pub fn new(robot: &Robot, poses: &[&ResidualAt], components: &[Vector3<f64>]) -> Evidence {
        let count = poses.len();
        let pair = |joint: usize, i: usize, k: usize| {
            let apart = poses[i].joints[joint] - poses[k].joints[joint];
            match robot.slides(joint) {
                true => apart * apart,
                false => (2.0 * (0.5 * apart).sin()).powi(2),
            }
        };
        let joints = robot.joints().len();
        let range = |joint: usize| {
            let all = poses.iter().map(|pose| pose.joints[joint]);
            let [low, high] = all.fold([f64::MAX, f64::MIN], |[low, high], q| [low.min(q), high.max(q)]);
            high - low
        };
        let center = |joint: usize| match robot.slides(joint) {
            true => range(joint).max(SHORTEST).ln(),
            false => LN_ANGLE,
        };
        let prior = (0..joints).map(center).chain([SCATTER.ln()]);
        Evidence {
            distances: (0..joints)
                .map(|joint| DMatrix::from_fn(count, count, |i, k| pair(joint, i, k)))
                .collect(),
            y: DMatrix::from_fn(count, 3, |i, c| components[i][c]),
            prior: DVector::from_iterator(joints + 1, prior),
        }
    }

    /// Where a search starts: the prior.
    pub fn prior(&self) -> &DVector<f64> {
        &self.prior
    }

    /// `E` and its slope at the logarithms of the length scales and of the scatter; `None` where `C` is not positive definite.
    pub fn at(&self, logarithms: &DVector<f64>) -> Option<(f64, DVector<f64>)> {
        let (count, joints) = (self.y.nrows(), self.distances.len());
        let scale = |joint: usize| (-2.0 * logarithms[joint]).exp();
        let scatter = (2.0 * logarithms[joints]).exp();
        let mut kernel = DMatrix::zeros(count, count);
        for (joint, distances) in self.distances.iter().enumerate() {
            kernel += distances * (-0.5 * scale(joint));
        }
        kernel.apply(|k| *k = k.exp());
        let mut c = kernel.clone();
        for i in 0..count {
            c[(i, i)] += scatter + JITTER;
        }
        let factor = c.cholesky()?;
        let a = factor.solve(&self.y);
        let variance: Vec<f64> = (0..3)
            .map(|k| (self.y.column(k).dot(&a.column(k)) / count as f64).max(NOTHING))
            .collect();
        let half_ln_determinant: f64 = factor.l_dirty().diagonal().iter().map(|l| l.ln()).sum();
        let off = logarithms - &self.prior;
        let value = 3.0 * half_ln_determinant
            + 0.5 * count as f64 * variance.iter().map(|v| v.ln()).sum::<f64>()
            + 0.5 * off.norm_squared();
        let mut g = factor.inverse() * 1.5;
        for (k, variance) in variance.iter().enumerate() {
            let column = a.column(k);
            g.ger(-0.5 / variance, &column, &column, 1.0);
        }
        let mut slope = off;
        for (joint, distances) in self.distances.iter().enumerate() {
            let each = g.iter().zip(kernel.iter()).zip(distances.iter());
            slope[joint] += scale(joint) * each.map(|((g, k), d)| g * k * d).sum::<f64>();
        }
        slope[joints] += 2.0 * scatter * g.trace();
        value.is_finite().then_some((value, slope))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arms;

    fn poses() -> Vec<ResidualAt> {
        let residual = |i: f64| Vector3::new(i.cos(), (2.0 * i).sin(), 0.3 * i - 1.0) * 1e-4;
        let pose = |i: usize| ResidualAt {
            joints: (0..6)
                .map(|j| (1.7 * i as f64 + 0.9 * f64::from(j)).sin())
                .collect(),
            residual: residual(i as f64),
        };
        (0..8).map(pose).collect()
    }

    fn evidence(robot: &Robot, poses: &[ResidualAt]) -> Evidence {
        let all: Vec<&ResidualAt> = poses.iter().collect();
        let y: Vec<Vector3<f64>> = poses.iter().map(|pose| pose.residual).collect();
        Evidence::new(robot, &all, &y)
    }

    fn logarithms() -> DVector<f64> {
        DVector::from_fn(7, |j, _| match j {
            6 => 0.4_f64.ln(),
            _ => (1.0 + 0.2 * j as f64).ln(),
        })
    }

    /// numpy: `3 sum ln diag L + 4 sum ln s_c^2` of the same poses.
    #[test]
    fn is_that_of_numpy() {
        let evidence = evidence(&arms::mh12(), &poses());
        let (value, _) = evidence.at(&logarithms()).unwrap();
        let prior = 0.5 * (logarithms() - evidence.prior()).norm_squared();
        assert!(
            (value - prior + 219.950_707_148_7).abs() < 1e-6,
            "{}",
            value - prior
        );
    }

    #[test]
    fn slope_matches_finite_differences() {
        let rail = arms::other::on_rail(&arms::mh12());
        let mut on_rail = poses();
        for pose in &mut on_rail {
            pose.joints.insert(0, 0.7 * pose.joints[2]);
        }
        for (robot, poses) in [(arms::mh12(), poses()), (rail, on_rail)] {
            let evidence = evidence(&robot, &poses);
            let at = evidence.prior() * 0.8;
            let (_, slope) = evidence.at(&at).unwrap();
            for k in 0..at.len() {
                let side = |step: f64| {
                    let mut there = at.clone();
                    there[k] += step;
                    evidence.at(&there).unwrap().0
                };
                let difference = (side(1e-5) - side(-1e-5)) / 2e-5;
                assert!(
                    (slope[k] - difference).abs() < 1e-6 * (1.0 + difference.abs()),
                    "{k}"
                );
            }
        }
    }
}

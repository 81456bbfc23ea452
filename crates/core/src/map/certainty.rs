//! Uncertainty of a map: the probability that the tolerance is met.
//!
//! The in-plane deviation of a point is assumed to be normally distributed about its value, with its standard
//! uncertainty. Only the worst case is used: all load cases share the uncertainties of the same joints. If another case
//! is nearly as large in another direction, the probability is too high by up to about 0.1.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `m`, `u` | in-plane deviation of the worst case, its standard uncertainty | m |
//! | `e` | tolerance | m |
//!
//! `P(within) = Phi((e - m) / u)`; robustly within where `m + 2 u <= e`, possibly where `m - 2 u <= e`: coverage about
//! 95 % (JCGM 100:2008, 6.3). Where `u` is not known there is neither a probability nor a robust region.

use super::plane::PlaneMap;
use super::region::{Region, region_within};
use crate::kernel::Evaluation;

/// Coverage factor.
pub const COVERAGE: f64 = 2.0;

/// Probability that the in-plane deviation of a point is at most `tolerance` (m); `None` where its uncertainty is not
/// known.
pub fn probability_within(evaluation: &Evaluation, tolerance: f64) -> Option<f64> {
    let room = tolerance - evaluation.in_plane;
    match evaluation.in_plane_uncertainty? {
        // Such as at a point without load.
        0.0 => Some(if room >= 0.0 { 1.0 } else { 0.0 }),
        u => Some(0.5 * libm::erfc(-room / (u * std::f64::consts::SQRT_2))),
    }
}

/// Robust and possible region of a map; only points inside the joint limits.
#[derive(Clone, Debug)]
pub struct Certainty {
    /// Where the deviation plus [`COVERAGE`] standard uncertainties is within the tolerance.
    pub robust: Region,
    /// Where the deviation minus [`COVERAGE`] standard uncertainties is within the tolerance.
    pub possibly: Region,
    /// Fraction of all points in the first region.
    pub fraction_robust: f64,
    /// Fraction of all points in the second region.
    pub fraction_possibly: f64,
    /// Mean probability of all points to be within; zero for a point without a posture inside the joint limits.
    pub expected_fraction: f64,
}

impl PlaneMap {
    /// Robust and possible region for `tolerance` (m); `None` where the uncertainty of a reached point is not known.
    pub fn certainty(&self, tolerance: f64) -> Option<Certainty> {
        let points = self.answers.points.len().max(1) as f64;
        let reached = self.answers.points.iter().flatten();
        let mut uncertainties = reached.map(|evaluation| evaluation.in_plane_uncertainty);
        if uncertainties.any(|u| u.is_none()) {
            return None;
        }
        let away = |multiple: f64| {
            self.inside_joint_limits(|evaluation| {
                evaluation.in_plane + multiple * evaluation.in_plane_uncertainty.unwrap_or_default()
            })
        };
        let (most, least) = (away(COVERAGE), away(-COVERAGE));
        let fraction = |values: &[Option<f64>]| {
            let within = values
                .iter()
                .filter(|value| value.is_some_and(|v| v <= tolerance))
                .count();
            within as f64 / points
        };
        let probabilities = self
            .inside_joint_limits(|evaluation| probability_within(evaluation, tolerance).unwrap_or_default());
        Some(Certainty {
            fraction_robust: fraction(&most),
            fraction_possibly: fraction(&least),
            expected_fraction: probabilities.iter().flatten().sum::<f64>() / points,
            robust: region_within(&self.grid, &most, tolerance),
            possibly: region_within(&self.grid, &least, tolerance),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::{Branch, PostureName};

    fn evaluation(in_plane: f64, in_plane_uncertainty: Option<f64>) -> Evaluation {
        Evaluation {
            name: PostureName::Branch(Branch::ALL[0]),
            limit_margin: f64::INFINITY,
            limit_joint: 0,
            singularity: None,
            worst_case: 0,
            in_plane,
            in_plane_uncertainty,
            normal: 0.0,
            full: in_plane,
        }
    }

    #[test]
    fn probabilities_are_those_of_the_normal_distribution() {
        // Phi(1), Phi(1.96), Phi(-2) as printed in tables of the standard normal distribution.
        for (in_plane, printed) in [(40e-6, 0.841_345), (30.4e-6, 0.975_002), (70e-6, 0.022_750)] {
            let p = probability_within(&evaluation(in_plane, Some(10e-6)), 50e-6).unwrap();
            assert!((p - printed).abs() < 5e-7, "{p} against {printed}");
        }
    }

    #[test]
    fn an_exact_point_is_within_or_not_and_unknown_is_not_exact() {
        let of = |um: f64, u| probability_within(&evaluation(um * 1e-6, u), 50e-6);
        assert_eq!(of(50.0, Some(0.0)), Some(1.0));
        assert_eq!(of(50.1, Some(0.0)), Some(0.0));
        assert_eq!(of(10.0, None), None);
    }
}

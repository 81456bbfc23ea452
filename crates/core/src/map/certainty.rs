//! How sure is it that the limit holds?
//!
//! A point's in-plane deviation is taken as normally distributed about its value, with its standard uncertainty.
//! The deciding case stands for all: they share the uncertainties of the same joints. Where another is nearly as large
//! in another direction, the probability is told too high, by up to about 0.1.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `m`, `u` | in-plane deviation of the deciding case, its standard uncertainty | m |
//! | `e` | limit | m |
//!
//! `P(within) = Phi((e - m) / u)`; surely within where `m + 2 u <= e`, possibly where `m - 2 u <= e`: about 95 %
//! (JCGM 100:2008, 6.3).

use super::plane::PlaneMap;
use super::region::{Region, region_within};
use crate::kernel::Held;

/// Multiple of the standard uncertainty that counts as sure.
pub const COVERAGE: f64 = 2.0;

/// Probability that the in-plane deviation of a point is at most `limit` (m).
pub fn probability_within(evaluation: &Held, limit: f64) -> f64 {
    let room = limit - evaluation.in_plane;
    if evaluation.in_plane_uncertainty == 0.0 {
        return if room >= 0.0 { 1.0 } else { 0.0 };
    }
    0.5 * libm::erfc(-room / (evaluation.in_plane_uncertainty * std::f64::consts::SQRT_2))
}

/// How sure a map is of its region: of points inside the joint limits alone.
#[derive(Clone, Debug)]
pub struct Certainty {
    /// Where the deviation holds the limit with [`COVERAGE`] uncertainties to spare.
    pub surely: Region,
    /// Where it would hold it with so many taken away.
    pub possibly: Region,
    /// Points in the first over all points.
    pub fraction_surely: f64,
    /// Points in the second over all points.
    pub fraction_possibly: f64,
    /// Mean probability of all points to be within; a point without posture inside the joint limits is not.
    pub expected_fraction: f64,
}

impl PlaneMap {
    /// How sure the map is of what holds `limit` (m).
    pub fn certainty(&self, limit: f64) -> Certainty {
        let points = self.answers.points.len().max(1) as f64;
        let away = |uncertainties: f64| {
            self.inside_joint_limits(|evaluation| evaluation.in_plane + uncertainties * evaluation.in_plane_uncertainty)
        };
        let (most, least) = (away(COVERAGE), away(-COVERAGE));
        let fraction = |values: &[Option<f64>]| {
            let within = values
                .iter()
                .filter(|value| value.is_some_and(|v| v <= limit))
                .count();
            within as f64 / points
        };
        let probabilities = self.inside_joint_limits(|evaluation| probability_within(evaluation, limit));
        Certainty {
            fraction_surely: fraction(&most),
            fraction_possibly: fraction(&least),
            expected_fraction: probabilities.iter().flatten().sum::<f64>() / points,
            surely: region_within(&self.grid, &most, limit),
            possibly: region_within(&self.grid, &least, limit),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::{Branch, PostureName};

    fn evaluation(in_plane: f64, in_plane_uncertainty: f64) -> Held {
        Held {
            name: PostureName::Branch(Branch::ALL[0]),
            limit_margin: f64::INFINITY,
            limit_joint: 0,
            singularity: None,
            deciding_case: 0,
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
            let p = probability_within(&evaluation(in_plane, 10e-6), 50e-6);
            assert!((p - printed).abs() < 5e-7, "{p} against {printed}");
        }
    }

    #[test]
    fn without_uncertainty_a_point_is_within_or_not() {
        assert_eq!(probability_within(&evaluation(50e-6, 0.0), 50e-6), 1.0);
        assert_eq!(probability_within(&evaluation(50.1e-6, 0.0), 50e-6), 0.0);
    }
}

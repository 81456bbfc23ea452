//! Several sets of coefficients of one material: their mean, and the scatter of a set among them.
//!
//! ```text
//! mean = sum x_i / n        C = sum (x_i - mean) (x_i - mean)^T / (n - 1)
//! ```
//!
//! `x_i` are the numbers of one law (six coefficients, or `kc1` and `mc`) as one source identified them. `C`
//! is the spread of tools that were not measured; the correlation of the coefficients is kept.

use nalgebra::{SMatrix, SVector};

/// Mean and scatter of all sets of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SetStatistics<const N: usize> {
    /// Their mean, in their order and units.
    pub mean: SVector<f64, N>,
    /// Covariance of one set among them; `None` of a single set, which has no scatter.
    pub covariance: Option<SMatrix<f64, N, N>>,
    /// Number of sets.
    pub sets: usize,
}

impl<const N: usize> SetStatistics<N> {
    /// Mean and covariance of these sets; `None` without a set.
    pub fn of(sets: &[SVector<f64, N>]) -> Option<SetStatistics<N>> {
        let count = sets.len();
        if count == 0 {
            return None;
        }
        let mean = sets.iter().sum::<SVector<f64, N>>() / count as f64;
        let covariance = (count > 1).then(|| {
            let mut covariance = SMatrix::zeros();
            for set in sets {
                let from_mean = set - mean;
                covariance += from_mean * from_mean.transpose() / (count - 1) as f64;
            }
            covariance
        });
        Some(SetStatistics {
            mean,
            covariance,
            sets: count,
        })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;

    #[test]
    fn sets_that_rise_together_covary_and_what_is_the_same_does_not() {
        let sets = [Vector3::new(100.0, 40.0, 10.0), Vector3::new(140.0, 60.0, 10.0)];
        let both = SetStatistics::of(&sets).unwrap();
        assert_eq!((both.sets, both.mean), (2, Vector3::new(120.0, 50.0, 10.0)));
        // 20 and 10 to either side of the mean, over one.
        let covariance = both.covariance.unwrap();
        assert_eq!(covariance.diagonal(), Vector3::new(800.0, 200.0, 0.0));
        assert_eq!((covariance[(0, 1)], covariance[(1, 0)]), (400.0, 400.0));
    }

    #[test]
    fn one_set_has_no_covariance_and_none_no_mean() {
        let one = SetStatistics::of(&[Vector3::new(1.0, 2.0, 3.0)]).unwrap();
        assert_eq!((one.sets, one.covariance), (1, None));
        assert_eq!(one.mean.z, 3.0);
        assert_eq!(SetStatistics::<3>::of(&[]), None);
    }
}

//! Several sets of one material's numbers together: their mean, and how one set among them scatters.
//!
//! ```text
//! mean = sum x_i / n        C = sum (x_i - mean) (x_i - mean)^T / (n - 1)
//! ```
//!
//! `x_i` are the numbers of one law (six coefficients, or `kc1` and `mc`) as one source identified them. `C` says how far
//! a tool that was not measured may lie from the mean; numbers that rise together keep that.

use nalgebra::{SMatrix, SVector};

/// What all sets of a material say together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Together<const N: usize> {
    /// Their mean, in their order and units.
    pub mean: SVector<f64, N>,
    /// Covariance of one set among them; `None` of a single set, which tells nothing of others.
    pub covariance: Option<SMatrix<f64, N, N>>,
    /// How many sets.
    pub sets: usize,
}

impl<const N: usize> Together<N> {
    /// Mean and covariance of these sets; `None` without a set.
    pub fn of(sets: &[SVector<f64, N>]) -> Option<Together<N>> {
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
        Some(Together {
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
        let together = Together::of(&sets).unwrap();
        assert_eq!(
            (together.sets, together.mean),
            (2, Vector3::new(120.0, 50.0, 10.0))
        );
        // 20 and 10 to either side of the mean, over one.
        let covariance = together.covariance.unwrap();
        assert_eq!(covariance.diagonal(), Vector3::new(800.0, 200.0, 0.0));
        assert_eq!((covariance[(0, 1)], covariance[(1, 0)]), (400.0, 400.0));
    }

    #[test]
    fn one_set_has_no_covariance_and_none_no_mean() {
        let one = Together::of(&[Vector3::new(1.0, 2.0, 3.0)]).unwrap();
        assert_eq!((one.sets, one.covariance), (1, None));
        assert_eq!(one.mean.z, 3.0);
        assert_eq!(Together::<3>::of(&[]), None);
    }
}

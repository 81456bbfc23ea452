//! Repeatability: scatter of the tool between repetitions of a pose.
//!
//! ```text
//! cov(delta) = sigma^2 I                                        equal along every axis
//! RP = l + 3 S_l,   l = 2 sqrt(2/pi) sigma,   S_l = sqrt(3 - 8/pi) sigma
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `sigma` | standard deviation of the tool position along any axis | m |
//! | `RP` | pose repeatability of a data sheet or a test | m |
//! | `l`, `S_l` | mean distance of the attained positions from their barycentre, and its standard deviation | m |
//!
//! Distances of positions with an isotropic normal distribution have Maxwell's distribution. Source: ISO 9283:1998,
//! 7.2.2 \[recalled\] for `RP`; the moments of that distribution are those of any textbook of probability.

use nalgebra::Matrix3;

/// `RP / sigma`: `2 sqrt(2/pi) + 3 sqrt(3 - 8/pi)`.
const POSE_BY_DEVIATION: f64 = 3.616_087_956_534_285;

/// The standard deviation `sigma` (m) along any axis of an arm of pose repeatability `pose` (`RP`, m).
pub fn deviation_of(pose: f64) -> f64 {
    pose / POSE_BY_DEVIATION
}

/// The covariance (m^2) of the tool position.
pub fn covariance(deviation: f64) -> Matrix3<f64> {
    Matrix3::from_diagonal_element(deviation * deviation)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn pose_repeatability_is_mean_distance_and_three_deviations() {
        let by_moments = 2.0 * (2.0 / PI).sqrt() + 3.0 * (3.0 - 8.0 / PI).sqrt();
        assert!((POSE_BY_DEVIATION - by_moments).abs() < 1e-9, "{by_moments}");
        assert!((deviation_of(80e-6) - 22.123_355_67e-6).abs() < 1e-15);
        assert_eq!(covariance(2.0)[(1, 1)], 4.0);
        assert_eq!(covariance(2.0)[(0, 1)], 0.0);
    }
}

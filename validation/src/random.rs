//! Seeded random numbers that are the same on every machine: splitmix64.
//!
//! Source: Steele, Lea, Flood 2014, "Fast splittable pseudorandom number generators", and the public-domain
//! code of Vigna, `prng.di.unimi.it/splitmix64.c`; its three constants.
//!
//! ```text
//! state += 0x9e3779b97f4a7c15;  z = state
//! z = (z ^ z >> 30) 0xbf58476d1ce4e5b9;  z = (z ^ z >> 27) 0x94d049bb133111eb;  z ^ z >> 31        modulo 2^64
//! ```
//!
//! Only sums, products and shifts of whole numbers, so that the stream is the same everywhere; orientations go
//! through sines, which may differ in the last bit.

use std::f64::consts::PI;

use nalgebra::{UnitQuaternion, Vector3};

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The stream of this seed.
    pub fn seeded(seed: u64) -> Random {
        Random(seed)
    }

    /// The next 64 random bits.
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in `lower .. upper`, evenly spread.
    pub fn between(&mut self, lower: f64, upper: f64) -> f64 {
        // The upper 53 bits fill the mantissa of a number in 0 .. 1.
        let unit = (self.bits() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64);
        lower + unit * (upper - lower)
    }

    /// Positions of `N` joints that turn, each in -pi to pi rad.
    pub fn joints<const N: usize>(&mut self) -> [f64; N] {
        [0.0; N].map(|_| self.between(-PI, PI))
    }

    /// A point in the cube about the origin of this half side, in its unit; its length goes to sqrt(3) times
    /// that.
    pub fn vector(&mut self, half_side: f64) -> Vector3<f64> {
        Vector3::zeros().map(|_: f64| self.between(-half_side, half_side))
    }

    /// An orientation, each as likely as any: roll and yaw even over a turn, the sine of pitch even in -1 to 1.
    pub fn orientation(&mut self) -> UnitQuaternion<f64> {
        let [roll, yaw, _] = self.joints::<3>();
        UnitQuaternion::from_euler_angles(roll, self.between(-1.0, 1.0).asin(), yaw)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stream_is_that_of_the_published_code() {
        // First outputs of splitmix64.c for seed 1234567.
        let mut random = Random::seeded(1_234_567);
        assert_eq!(
            [random.bits(), random.bits()],
            [6_457_827_717_110_365_317, 3_203_168_211_198_807_973]
        );
    }

    #[test]
    fn numbers_stay_in_their_range() {
        let mut random = Random::seeded(1);
        assert!((0..1000).all(|_| (2.0..3.0).contains(&random.between(2.0, 3.0))));
    }
}

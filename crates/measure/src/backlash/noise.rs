//! Seeded noise that is the same on every machine but for the last bit: splitmix64, and two even numbers into a
//! normal one.
//!
//! Source: Steele, Lea, Flood 2014, Fast splittable pseudorandom number generators; Box and Muller 1958 \[recalled\].

use std::f64::consts::TAU;

/// A stream of normal numbers.
#[derive(Clone, Debug)]
pub(super) struct Noise(u64);

impl Noise {
    /// The stream of this seed.
    pub fn seeded(seed: u64) -> Noise {
        Noise(seed)
    }

    /// A number in 0 to below 1.
    fn even(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number of mean 0 and standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.even()).ln()).sqrt();
        radius * (TAU * self.even()).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_has_mean_0_and_deviation_1_and_the_seed_decides() {
        let many: Vec<f64> = {
            let mut noise = Noise::seeded(5);
            (0..10_000).map(|_| noise.normal()).collect()
        };
        let mean = many.iter().sum::<f64>() / 1e4;
        let square = many.iter().map(|x| x * x).sum::<f64>() / 1e4;
        // Four standard deviations of either.
        assert!(
            mean.abs() < 0.04 && (square - 1.0).abs() < 0.06,
            "{mean} {square}"
        );
        assert_eq!(Noise::seeded(5).normal(), many[0]);
        assert_ne!(Noise::seeded(6).normal(), many[0]);
    }
}

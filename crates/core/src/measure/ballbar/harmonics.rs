//! The lobes of a profile: how much of it goes round once, twice, n times a turn.
//!
//! ```text
//! dr(a) = mean + sum over n of  A_n cos(n (a - a_n))
//! ```
//!
//! The first is where the circle lies, not how round it is; the second is the ellipse of scale and squareness; three
//! lobes are what bent guideways make.

use std::f64::consts::TAU;

use super::profile::station;
use super::run::CircularTest;
use super::{Direction, difference::mean_of};

/// One number of lobes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonic {
    /// Lobes a turn; 0 is the mean.
    pub order: usize,
    /// `A_n`, not negative, m; of order 0 the mean, of either sign.
    pub amplitude: f64,
    /// `a_n`, where the first crest is, from 0 to below a turn over the order, rad; 0 of order 0.
    pub crest: f64,
}

impl Harmonic {
    /// What it adds to the radius at an angle, m.
    pub fn at(&self, angle: f64) -> f64 {
        self.amplitude * (self.order as f64 * (angle - self.crest)).cos()
    }
}

/// The harmonics 0 to `most` of radii at every station, m; `None` where one is unknown.
pub fn harmonics(stations: &[Option<f64>], most: usize) -> Option<Vec<Harmonic>> {
    let radii: Vec<f64> = stations.iter().copied().collect::<Option<_>>()?;
    let count = radii.len() as f64;
    let of = |order: usize| {
        let (mut cosine, mut sine) = (0.0, 0.0);
        for (index, radius) in radii.iter().enumerate() {
            let (s, c) = (order as f64 * station(index)).sin_cos();
            cosine += radius * c / count;
            sine += radius * s / count;
        }
        match order {
            0 => Harmonic {
                order,
                amplitude: cosine,
                crest: 0.0,
            },
            _ => Harmonic {
                order,
                amplitude: 2.0 * cosine.hypot(sine),
                crest: sine.atan2(cosine).rem_euclid(TAU) / order as f64,
            },
        }
    };
    Some((0..=most).map(of).collect())
}

/// What both directions have in common at every station, m: the mean of their means; of one direction, its mean.
pub fn common(test: &CircularTest) -> Vec<Option<f64>> {
    let measured = Direction::BOTH.iter().filter(|d| test.of(**d).next().is_some());
    let means: Vec<_> = measured.map(|direction| mean_of(test, *direction)).collect();
    let count = means.len() as f64;
    let sum = |index: usize| -> Option<f64> { means.iter().map(|mean| mean[index]).sum() };
    let stations = means.first().map_or(0, Vec::len);
    (0..stations).map(|index| Some(sum(index)? / count)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::profile::STATIONS;
    use super::*;

    #[test]
    fn lobes_come_out_with_their_height_and_crest() {
        let wave = |a: f64| 4e-6 + 3e-6 * (2.0 * (a - 0.3)).cos() + 1e-6 * (5.0 * (a - 1.0)).cos();
        let stations: Vec<_> = (0..STATIONS).map(|index| Some(wave(station(index)))).collect();
        let found = harmonics(&stations, 6).unwrap();
        let amplitudes = [4e-6, 0.0, 3e-6, 0.0, 0.0, 1e-6, 0.0];
        for (harmonic, amplitude) in found.iter().zip(amplitudes) {
            assert!((harmonic.amplitude - amplitude).abs() < 1e-18, "{harmonic:?}");
        }
        assert!((found[2].crest - 0.3).abs() < 1e-9 && (found[5].crest - 1.0).abs() < 1e-9);
        for a in [0.0, 1.0, 4.0] {
            let sum: f64 = found.iter().map(|harmonic| harmonic.at(a)).sum();
            assert!((sum - wave(a)).abs() < 1e-17);
        }
    }

    #[test]
    fn a_gap_leaves_no_lobes() {
        let mut stations = vec![Some(0.0); STATIONS];
        stations[7] = None;
        assert_eq!(harmonics(&stations, 3), None);
    }
}

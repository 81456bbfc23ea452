//! The lobes of a profile: how much of it goes round once, twice, n times a turn.
//!
//! ```text
//! dr(a) = mean + sum over n of  A_n cos(n a - phi_n)
//! ```
//!
//! The first is where the circle lies, not how round it is; the second is the ellipse of scale and squareness; three
//! lobes are what bent guideways make.

use super::profile::station;
use super::run::CircularTest;
use super::{Direction, difference::mean_of};
use crate::roundness::Harmonic;

/// A mean and its lobes.
#[derive(Clone, Debug, PartialEq)]
pub struct Lobes {
    /// m
    pub mean: f64,
    /// 1 lobe a turn, 2, ...
    pub harmonics: Vec<Harmonic>,
}

impl Lobes {
    /// What all of them make of the radius at an angle, m.
    pub fn at(&self, angle: f64) -> f64 {
        let lobe = |lobe: &Harmonic| lobe.amplitude * (lobe.waves as f64 * angle - lobe.phase).cos();
        self.mean + self.harmonics.iter().map(lobe).sum::<f64>()
    }
}

/// The mean and the lobes 1 to `most` of radii at every station, m; `None` where one is unknown.
pub fn lobes(stations: &[Option<f64>], most: usize) -> Option<Lobes> {
    let radii: Vec<f64> = stations.iter().copied().collect::<Option<_>>()?;
    let count = radii.len() as f64;
    let of = |waves: usize| {
        let (mut cosine, mut sine) = (0.0, 0.0);
        for (index, radius) in radii.iter().enumerate() {
            let (s, c) = (waves as f64 * station(index)).sin_cos();
            cosine += 2.0 * radius * c / count;
            sine += 2.0 * radius * s / count;
        }
        Harmonic {
            waves,
            amplitude: cosine.hypot(sine),
            phase: sine.atan2(cosine),
        }
    };
    Some(Lobes {
        mean: radii.iter().sum::<f64>() / count,
        harmonics: (1..=most).map(of).collect(),
    })
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
        let found = lobes(&stations, 6).unwrap();
        assert!((found.mean - 4e-6).abs() < 1e-18);
        for (lobe, amplitude) in found.harmonics.iter().zip([0.0, 3e-6, 0.0, 0.0, 1e-6, 0.0]) {
            assert!((lobe.amplitude - amplitude).abs() < 1e-18, "{lobe:?}");
        }
        assert!((found.harmonics[1].phase - 0.6).abs() < 1e-9);
        for a in [0.0, 1.0, 4.0] {
            assert!((found.at(a) - wave(a)).abs() < 1e-17);
        }
    }

    #[test]
    fn a_gap_leaves_no_lobes() {
        let mut stations = vec![Some(0.0); STATIONS];
        stations[7] = None;
        assert_eq!(lobes(&stations, 3), None);
    }
}

//! Samples that do not belong to the path: dirt on a ball, a pulling cable.
//!
//! The rule is that of [`crate::roundness::outlier`], for the samples of a run and again for the profile of the rest,
//! so that dirt over several samples is also found in a dense run.
//!
//! A spike where an axis reverses is real: friction stops the axis for a moment. Such samples are reported as
//! reversals.

use super::profile::{Profile, wrapped};
use super::run::Run;
use crate::roundness::outlier::{Ends, outlying};

/// A spike within this of a reversal belongs to it, rad: 3 degrees.
const NEAR: f64 = std::f64::consts::TAU / 120.0;
/// A sample that deviates from its neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outlier {
    /// Index in its run, from 0.
    pub sample: usize,
    /// rad, from 0 to below a turn.
    pub angle: f64,
    /// Deviation from the prediction by its neighbours, m.
    pub off: f64,
    /// Whether an axis reverses there.
    pub at_reversal: bool,
}

/// The outliers of a run in the order of its samples; `reversals` are angles where an axis reverses, rad.
pub fn outliers(run: &Run, reversals: &[f64]) -> Vec<Outlier> {
    let mut off: Vec<Option<f64>> = outlying(run.deviation(), Ends::Open);
    let alone: Vec<usize> = (0..off.len()).filter(|at| off[*at].is_some()).collect();
    let profile = run.without(&alone).map(|run| Profile::of(&run));
    let (angles, deviations): (Vec<f64>, Vec<f64>) = profile.iter().flat_map(Profile::samples).unzip();
    let cells = outlying(&deviations, Ends::Open);
    // In a run that is not denser than its profile, the cells are the samples.
    if run.angle().len() > 2 * angles.len() && cells.iter().any(Option::is_some) {
        for (at, angle) in run.angle().iter().enumerate() {
            let angle = wrapped(*angle);
            let near = angles.partition_point(|a| *a < angle).min(angles.len() - 1);
            let cell = match near > 0 && angle - angles[near - 1] < (angles[near] - angle).abs() {
                true => near - 1,
                false => near,
            };
            off[at] = off[at].or(cells[cell]);
        }
    }
    let found = off.into_iter().enumerate();
    found
        .filter_map(|(sample, off)| {
            let angle = wrapped(run.angle()[sample]);
            let near = |reversal: &f64| {
                let apart = wrapped(angle - reversal);
                apart.min(std::f64::consts::TAU - apart) <= NEAR
            };
            Some(Outlier {
                sample,
                angle,
                off: off?,
                at_reversal: reversals.iter().any(near),
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::run::Direction;
    use super::*;

    /// An ellipse with a step of 40 um at 180 degrees and noise of a um, and dirt of 60 um on some samples.
    fn dirty(count: usize, dirt: std::ops::Range<usize>) -> Run {
        let angle: Vec<f64> = (0..count)
            .map(|k| std::f64::consts::TAU * k as f64 / count as f64)
            .collect();
        let deviation = angle.iter().enumerate().map(|(k, a)| {
            // Hashed, so that neighbours are independent.
            let hashed = (k as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let hashed = (hashed ^ (hashed >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let noise = ((hashed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5) * 2e-6;
            let step = if *a > std::f64::consts::PI { 40e-6 } else { 0.0 };
            noise + step + 50e-6 * (2.0 * a).cos() + if dirt.contains(&k) { 60e-6 } else { 0.0 }
        });
        let deviation = deviation.collect();
        Run::new(Direction::Anticlockwise, angle, deviation).unwrap()
    }

    #[test]
    fn dirt_is_found_and_steps_and_ellipses_are_not_dirt() {
        for (count, dirt) in [(360, 30..31), (1440, 700..703), (100_000, 5000..5003)] {
            let places: Vec<usize> = outliers(&dirty(count, dirt.clone()), &[])
                .iter()
                .map(|outlier| outlier.sample)
                .collect();
            assert_eq!(places, dirt.collect::<Vec<_>>(), "{count}");
            assert!(outliers(&dirty(count, 0..0), &[]).is_empty(), "{count}");
        }
        assert!(outliers(&dirty(72, 0..0), &[]).is_empty());
    }

    #[test]
    fn dirt_over_many_samples_of_a_dense_run_is_found_in_its_profile() {
        // 200 samples of 100000 are 0.72 degrees: three cells.
        let found = outliers(&dirty(100_000, 20_000..20_200), &[]);
        assert!(found.len() >= 200, "{}", found.len());
        let off = |outlier: &Outlier| outlier.angle.to_degrees() - 72.36;
        assert!(found.iter().all(|outlier| off(outlier).abs() < 0.8));
    }

    #[test]
    fn a_spike_at_a_reversal_is_reported_as_a_reversal() {
        let found = outliers(&dirty(360, 91..92), &[std::f64::consts::FRAC_PI_2, 0.0]);
        assert!(found.len() == 1 && found[0].at_reversal, "{found:?}");
        let found = outliers(&dirty(360, 96..97), &[std::f64::consts::FRAC_PI_2, 0.0]);
        assert!(found.len() == 1 && !found[0].at_reversal, "{found:?}");
        let across = outliers(&dirty(360, 358..359), &[0.0]);
        assert!(across.len() == 1 && across[0].at_reversal, "{across:?}");
    }

    #[test]
    fn rounding_of_a_run_without_noise_is_not_an_outlier() {
        let angle: Vec<f64> = (0..360).map(|deg| f64::from(deg).to_radians()).collect();
        let run = Run::new(Direction::Clockwise, angle, vec![0.1; 360]).unwrap();
        assert!(outliers(&run, &[]).is_empty());
    }
}

//! A run as radial deviations over one turn: samples by angle, dense ones averaged.
//!
//! Samples within a cell of a quarter of a degree become one, the mean of their angles and of their deviations:
//! straight parts do not change. A bar that was at rest for a while has no more weight than a moving one, and a million
//! samples cost as much as a thousand. Between samples a profile is linear; where they leave a gap ([`is_gap`]) it is
//! unknown.

use std::f64::consts::TAU;

use super::run::Run;

/// Cells of a turn: their edges are at multiples of a quarter of a degree, so that no reversal of an axis falls into
/// one.
const CELLS: usize = 1440;

/// Samples farther apart than this leave a gap, rad: 15 degrees.
pub const GAP: f64 = TAU / 24.0;

/// Tolerance so that steps of just [`GAP`] leave none, rad: half a degree for rounding, and for a change of the centre.
const SLACK: f64 = TAU / 720.0;

/// Whether neighbours with this distance (rad) leave a gap between them.
pub fn is_gap(apart: f64) -> bool {
    apart > GAP + SLACK
}

/// Angles of a turn at which profiles are compared: every half degree.
pub const STATIONS: usize = 720;

/// Radial deviation over one turn.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// From 0 to below a turn, rising, rad.
    angle: Vec<f64>,
    /// At each angle, m.
    deviation: Vec<f64>,
}

/// The angle of a station, rad.
pub fn station(index: usize) -> f64 {
    TAU * index as f64 / STATIONS as f64
}

impl Profile {
    /// Of the samples of a run.
    pub fn of(run: &Run) -> Profile {
        let mut cells = vec![(0.0, 0.0, 0.0); CELLS];
        for (angle, deviation) in run.samples() {
            let angle = wrapped(angle);
            let cell = (angle / TAU * CELLS as f64) as usize;
            // An angle just below a turn may be rounded up to it.
            let (count, sum, height) = &mut cells[cell.min(CELLS - 1)];
            *count += 1.0;
            *sum += angle;
            *height += deviation;
        }
        let filled = cells.iter().filter(|(count, ..)| *count > 0.0);
        let (angle, deviation) = filled
            .map(|(count, angle, deviation)| (angle / count, deviation / count))
            .unzip();
        Profile { angle, deviation }
    }

    /// Angle (rad, rising within a turn) and radial deviation (m) of each remaining sample.
    pub fn samples(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.angle.iter().copied().zip(self.deviation.iter().copied())
    }

    /// Radial deviation at an angle, m; `None` within a gap.
    pub fn at(&self, angle: f64) -> Option<f64> {
        let angle = wrapped(angle);
        let count = self.angle.len();
        let next = self.angle.partition_point(|a| *a <= angle);
        let [before, after] = [(next + count - 1) % count, next % count];
        let behind = wrapped(angle - self.angle[before]);
        let apart = if count == 1 {
            TAU
        } else {
            wrapped(self.angle[after] - self.angle[before])
        };
        if behind == 0.0 {
            return Some(self.deviation[before]);
        }
        if is_gap(apart) {
            return None;
        }
        let share = behind / apart;
        Some(self.deviation[before] * (1.0 - share) + self.deviation[after] * share)
    }

    /// Radial deviation at every station; `None` within a gap.
    pub fn stations(&self) -> Vec<Option<f64>> {
        (0..STATIONS).map(|index| self.at(station(index))).collect()
    }

    /// Gaps without samples: first and last angle, rad, the second beyond the first and perhaps beyond a turn.
    pub fn gaps(&self) -> Vec<[f64; 2]> {
        self.steps().filter(|[from, to]| is_gap(to - from)).collect()
    }

    /// The widest step from one sample to the next that is not a gap, rad; 0 of none.
    pub fn widest_step(&self) -> f64 {
        let widths = self.steps().map(|[from, to]| to - from);
        widths.filter(|width| !is_gap(*width)).fold(0.0, f64::max)
    }

    /// From each sample to the next, the last to the first a turn on, rad.
    fn steps(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        let count = self.angle.len();
        (0..count).map(move |k| {
            let turn = if k + 1 == count { TAU } else { 0.0 };
            [self.angle[k], self.angle[(k + 1) % count] + turn]
        })
    }

    /// Part of a turn that has samples, rad.
    pub fn arc(&self) -> f64 {
        TAU - self.gaps().iter().map(|[from, to]| to - from).sum::<f64>()
    }
}

/// The mean of profiles at every station; `None` where one of them has a gap, or where there is none.
pub fn mean(profiles: &[Profile]) -> Vec<Option<f64>> {
    let count = profiles.len() as f64;
    let at = |index: usize| -> Option<f64> {
        let angle = station(index);
        let sum: Option<f64> = profiles.iter().map(|profile| profile.at(angle)).sum();
        sum.filter(|_| count > 0.0).map(|sum| sum / count)
    };
    (0..STATIONS).map(at).collect()
}

/// An angle from 0 to below a turn, rad.
pub(super) fn wrapped(angle: f64) -> f64 {
    let wrapped = angle.rem_euclid(TAU);
    // A tiny negative angle is rounded to a whole turn.
    if wrapped < TAU { wrapped } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::super::run::Direction;
    use super::*;

    fn of(samples: impl Iterator<Item = (f64, f64)>) -> Profile {
        let (angle, deviation) = samples.unzip();
        Profile::of(&Run::new(Direction::Clockwise, angle, deviation).unwrap())
    }

    #[test]
    fn a_profile_does_not_depend_on_the_start_and_direction_of_its_run() {
        let wave = |deg: i32| {
            let a = f64::from(deg).to_radians();
            (a, 1e-5 * (3.0 * a).cos())
        };
        let forth = of((0..360).map(wave));
        let back = of((-500..-140).rev().map(wave));
        for deg in 0..720 {
            let a = f64::from(deg).to_radians() / 2.0;
            let [one, other] = [&forth, &back].map(|profile| profile.at(a).unwrap());
            assert!((one - other).abs() < 1e-15, "{deg}");
        }
    }

    #[test]
    fn dense_samples_are_averaged_without_a_change_of_straight_parts() {
        let dense = of((0..100_000).map(|k| {
            let a = TAU * f64::from(k) / 1e5;
            (a, 1e-6 * a)
        }));
        assert_eq!(dense.samples().count(), CELLS);
        for a in [0.1, 1.0, 3.0, 6.0] {
            assert!((dense.at(a).unwrap() - 1e-6 * a).abs() < 1e-15);
        }
    }

    #[test]
    fn gaps_are_where_no_samples_are_and_across_the_end_of_the_turn_too() {
        // 20 to 239 degrees, every degree.
        let arc = of((20..240).map(|deg| (f64::from(deg).to_radians(), 0.0)));
        let gaps = arc.gaps();
        assert_eq!(gaps.len(), 1);
        assert!(
            (gaps[0][0].to_degrees() - 239.0).abs() < 1e-9 && (gaps[0][1].to_degrees() - 380.0).abs() < 1e-9
        );
        assert!((arc.arc().to_degrees() - 219.0).abs() < 1e-9);
        assert_eq!(arc.at(0.0), None);
        assert_eq!(arc.at(100_f64.to_radians()), Some(0.0));
        let every_15 = of((0..24).map(|k| (f64::from(15 * k).to_radians(), 0.0)));
        assert_eq!((every_15.gaps().len(), every_15.arc()), (0, TAU));
    }

    #[test]
    fn samples_every_15_degrees_are_known_in_between_and_from_another_centre_too() {
        // A millimetre of 100 moves angles by up to 0.6 degrees, neighbours from each other by a tenth.
        let seen = |k: i32, e: f64| {
            let a = f64::from(15 * k).to_radians();
            (a + e * a.sin(), 1e-5)
        };
        for e in [0.0, 0.01] {
            let profile = of((0..24).map(|k| seen(k, e)));
            assert!(
                profile.gaps().is_empty() && profile.stations().iter().all(Option::is_some),
                "{e}"
            );
            assert!((profile.widest_step() - GAP).abs() <= 0.3 * e + 1e-12, "{e}");
        }
    }

    #[test]
    fn samples_at_one_angle_are_a_gap_of_a_turn() {
        let one = of((0..30).map(|_| (1.0, 0.5)));
        assert!((one.arc()).abs() < 1e-12);
        assert_eq!((one.at(1.0), one.at(2.0)), (Some(0.5), None));
    }

    #[test]
    fn a_mean_is_unknown_where_one_profile_is() {
        let whole = of((0..360).map(|deg| (f64::from(deg).to_radians(), 2e-6)));
        let half = of((0..180).map(|deg| (f64::from(deg).to_radians(), 4e-6)));
        let mean = mean(&[whole, half]);
        assert!((mean[100].unwrap() - 3e-6).abs() < 1e-18);
        assert_eq!(mean[500], None);
        assert!(super::mean(&[]).iter().all(Option::is_none));
    }
}

//! Outliers of a profile: dirt on a ball or a probe, a scratch, a pulling cable. One rule for circular tests and
//! for measured parts.
//!
//! A value is compared with the prediction by its neighbours, in three ways: the middle between the medians of the five
//! before it and the five after it, and the line through the medians of two fives on either side. `d` is the least of
//! the three differences. A value is an outlier where
//!
//! ```text
//! |d| > max(12 * 1.4826 * median |d|, range / 20, 2 q)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `d` | difference from the prediction by the neighbours | m |
//! | range | greatest less least value | m |
//! | `q` | least difference between two values: the rounding of the file | m |
//!
//! Why three ways: real profiles have steps, where an axis reverses or a face begins. A value next to a step is
//! predicted by its own side, so neither steps nor slopes are outliers; dirt differs from both sides. Why medians of
//! five: two bad values in a row do not hide each other. Why 12: `d` is the least of three, and its tail is longer than
//! that of noise (12 scatters were exceeded by none of 100 000 values of noise on an ellipse with a step). Why a
//! twentieth: less changes no reported quantity of a profile, and a profile as smooth as its rounding has no dirt.

use crate::statistics::{median, robust_scatter};

/// Number of values in a row whose median is used.
const ROW: usize = 5;
/// More than this multiple of the scatter is not noise.
const FACTOR: f64 = 12.0;
/// Less than this part of the range is not relevant.
const LITTLE: f64 = 0.05;
/// Multiple of the rounding that rounding alone may make.
const ROUNDED: f64 = 2.0;
/// Less than this is never an outlier, m: a nanometre.
const NOTHING: f64 = 1e-9;
/// With fewer values the scatter is not known.
const LEAST_COUNT: usize = 4 * ROW;

/// Values before the first one and after the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// None.
    Open,
    /// Closed: values round a circle.
    Closed,
}

/// Difference of each of these values (m), in their order, from the prediction by its neighbours,
/// where it is too large.
pub fn outlying(values: &[f64], ends: Ends) -> Vec<Option<f64>> {
    let count = values.len();
    if count < LEAST_COUNT {
        return vec![None; count];
    }
    let beyond = match ends {
        Ends::Open => 0,
        Ends::Closed => 2 * ROW,
    };
    let round: Vec<f64> = (0..count + 2 * beyond)
        .map(|at| values[(at + count - beyond) % count])
        .collect();
    let off = &differences(&round)[beyond..beyond + count];
    let scatter = robust_scatter(off);
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let range = sorted[count - 1] - sorted[0];
    let steps = sorted.windows(2).map(|pair| pair[1] - pair[0]);
    let rounding = steps.filter(|by| *by > 0.0).fold(f64::MAX, f64::min);
    let rounding = if range > 0.0 { rounding } else { 0.0 };
    let most = [FACTOR * scatter, LITTLE * range, ROUNDED * rounding, NOTHING];
    let most = most.into_iter().fold(0.0, f64::max);
    off.iter().map(|off| (off.abs() > most).then_some(*off)).collect()
}

/// Difference of each value from the nearest prediction by its neighbours.
fn differences(values: &[f64]) -> Vec<f64> {
    // Medians of five in a row, by the place of the first.
    let rows: Vec<f64> = values.windows(ROW).map(median).collect();
    let row = |from: Option<usize>| from.and_then(|from| rows.get(from)).copied();
    let difference = |at: usize| {
        let [before, earlier] = [row(at.checked_sub(ROW)), row(at.checked_sub(2 * ROW))];
        let [behind, later] = [row(Some(at + 1)), row(Some(at + 1 + ROW))];
        // The middle of a row is three values away, that of the next five more.
        let line = |near: Option<f64>, far: Option<f64>| Some(near? + 0.6 * (near? - far?));
        let between = before.zip(behind).map(|(before, behind)| 0.5 * (before + behind));
        let predicted = [between, line(before, earlier), line(behind, later)];
        let differences = predicted.into_iter().flatten().map(|given| values[at] - given);
        differences
            .min_by(|a, b| a.abs().total_cmp(&b.abs()))
            .unwrap_or(0.0)
    };
    (0..values.len()).map(difference).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// Noise of a um, hashed, so that neighbours are independent.
    fn noise(k: usize) -> f64 {
        let hashed = (k as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let hashed = (hashed ^ (hashed >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        ((hashed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5) * 2e-6
    }

    /// An ellipse with two steps of 40 um, plus `dirt`.
    fn profile(count: usize, dirt: impl Fn(usize) -> f64) -> Vec<f64> {
        let at = |k: usize| {
            let a = TAU * k as f64 / count as f64;
            let step = if a > 0.5 * TAU { 40e-6 } else { 0.0 };
            noise(k) + step + 50e-6 * (2.0 * a).cos() + dirt(k)
        };
        (0..count).map(at).collect()
    }

    fn found(values: &[f64], ends: Ends) -> Vec<usize> {
        let off = outlying(values, ends);
        (0..off.len()).filter(|at| off[*at].is_some()).collect()
    }

    #[test]
    fn two_bad_values_are_found_but_not_steps_slopes_or_noise() {
        for ends in [Ends::Open, Ends::Closed] {
            for count in [72, 360, 3600] {
                assert!(found(&profile(count, |_| 0.0), ends).is_empty(), "{count}");
                let bad = |k: usize| if k / 2 == 10 { 60e-6 } else { 0.0 };
                assert_eq!(found(&profile(count, bad), ends), [20, 21], "{count}");
            }
            assert!(found(&profile(100_000, |_| 0.0), ends).is_empty());
        }
    }

    #[test]
    fn the_start_of_a_closed_profile_has_no_effect() {
        let values = profile(360, |k| if k == 100 { -60e-6 } else { 0.0 });
        for by in [0, 98, 100, 101, 250] {
            let turned: Vec<f64> = (0..360).map(|k| values[(k + by) % 360]).collect();
            assert_eq!(found(&turned, Ends::Closed), [(100 + 360 - by) % 360], "{by}");
        }
    }

    #[test]
    fn scaled_dirt_has_a_scaled_difference_and_no_other_value_is_bad() {
        let values = profile(360, |k| if k == 100 { 60e-6 } else { 0.0 });
        let twice: Vec<f64> = values.iter().map(|value| 2.0 * value + 1e-3).collect();
        let [one, other] = [&values, &twice].map(|values| outlying(values, Ends::Closed));
        for (one, other) in one.iter().zip(&other) {
            assert_eq!(one.is_some(), other.is_some());
            let apart = one.zip(*other).map_or(0.0, |(one, other)| other - 2.0 * one);
            assert!(apart.abs() < 1e-15);
        }
    }

    #[test]
    fn rounding_is_not_dirt_nor_are_small_values_or_short_profiles() {
        // All the same but for single steps of the last digit.
        let rounded: Vec<f64> = (0..360)
            .map(|k| if k % 60 == 7 { 1.001e-3 } else { 1e-3 })
            .collect();
        assert!(found(&rounded, Ends::Closed).is_empty());
        assert!(found(&vec![0.1; 360], Ends::Open).is_empty());
        // A 25th of the range.
        let small: Vec<f64> = (0..3600)
            .map(|k| 50e-6 * (TAU * f64::from(k) / 1800.0).cos() + if k == 900 { 4e-6 } else { 0.0 })
            .collect();
        assert!(found(&small, Ends::Closed).is_empty());
        assert!(
            found(
                &[0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
                Ends::Closed
            )
            .is_empty()
        );
    }
}

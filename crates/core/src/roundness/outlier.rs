//! What is not of the profile: dirt on a ball or a probe, a scratch, a cable that pulled. One rule for circular tests and
//! for measured parts.
//!
//! A value is compared with what its neighbours foretell, in three ways: the middle between the medians of the five before
//! it and the five behind, and the line through the medians of two fives on either side alone. `d` is the least of the
//! three differences. A value is an outlier where
//!
//! ```text
//! |d| > max(12 * 1.4826 * median |d|, range / 20, 2 q)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `d` | from what neighbours foretell | m |
//! | range | greatest less least value | m |
//! | `q` | least difference between two values: what the file is rounded to | m |
//!
//! Why three ways: real profiles have steps, where an axis turns back or a face begins. A value beside a step is foretold by its
//! own side, so neither steps nor slopes are dirt; dirt is off from both sides. Why medians of five: two bad values in a row
//! do not hide each other. Why 12: `d` is the least of three, and its tail is longer than that of noise (12 scatters were
//! passed by none of 100 000 values of noise on an ellipse with a step). Why a twentieth: less changes no number that is
//! told of a profile, and one as smooth as its rounding has no dirt.

/// Values in a row whose median is taken.
const ROW: usize = 5;
/// More than this many times the scatter is no noise.
const FACTOR: f64 = 12.0;
/// Less than this part of the range is of no matter.
const LITTLE: f64 = 0.05;
/// Times the rounding that rounding alone may make.
const ROUNDED: f64 = 2.0;
/// Less than this is never an outlier, m: a nanometre.
const NOTHING: f64 = 1e-9;
/// From median size to standard deviation, of a normal distribution.
const NORMAL: f64 = 1.4826;
/// Fewer do not tell what is usual.
const LEAST_COUNT: usize = 4 * ROW;

/// What comes before the first value and behind the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// Nothing.
    Open,
    /// The last and the first: values round a circle.
    Closed,
}

/// How far each of these values (m), in the order in which they follow each other, is from what its neighbours foretell,
/// where that is too much.
pub fn strange(values: &[f64], ends: Ends) -> Vec<Option<f64>> {
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
    let mut sizes: Vec<f64> = off.iter().map(|off| off.abs()).collect();
    let scatter = NORMAL * median(&mut sizes);
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

/// How far each value is from the nearest of what its neighbours foretell.
fn differences(values: &[f64]) -> Vec<f64> {
    // Medians of five in a row, by the place of the first.
    let rows: Vec<f64> = values.windows(ROW).map(|row| median(&mut row.to_vec())).collect();
    let row = |from: Option<usize>| from.and_then(|from| rows.get(from)).copied();
    let difference = |at: usize| {
        let [before, earlier] = [row(at.checked_sub(ROW)), row(at.checked_sub(2 * ROW))];
        let [behind, later] = [row(Some(at + 1)), row(Some(at + 1 + ROW))];
        // The middle of a row is three values away, that of the next five more.
        let line = |near: Option<f64>, far: Option<f64>| Some(near? + 0.6 * (near? - far?));
        let between = before.zip(behind).map(|(before, behind)| 0.5 * (before + behind));
        let foretold = [between, line(before, earlier), line(behind, later)];
        let differences = foretold.into_iter().flatten().map(|given| values[at] - given);
        differences
            .min_by(|a, b| a.abs().total_cmp(&b.abs()))
            .unwrap_or(0.0)
    };
    (0..values.len()).map(difference).collect()
}

/// The middle value; 0 of none.
fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    if values.is_empty() {
        return 0.0;
    }
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// Noise of a um, hashed, so that neighbours have nothing to do with each other.
    fn noise(k: usize) -> f64 {
        let hashed = (k as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let hashed = (hashed ^ (hashed >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        ((hashed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5) * 2e-6
    }

    /// An ellipse with two steps of 40 um, and what `dirt` adds.
    fn profile(count: usize, dirt: impl Fn(usize) -> f64) -> Vec<f64> {
        let at = |k: usize| {
            let a = TAU * k as f64 / count as f64;
            let step = if a > 0.5 * TAU { 40e-6 } else { 0.0 };
            noise(k) + step + 50e-6 * (2.0 * a).cos() + dirt(k)
        };
        (0..count).map(at).collect()
    }

    fn found(values: &[f64], ends: Ends) -> Vec<usize> {
        let off = strange(values, ends);
        (0..off.len()).filter(|at| off[*at].is_some()).collect()
    }

    #[test]
    fn two_bad_values_are_found_and_neither_steps_nor_slopes_nor_noise_are_bad() {
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
    fn a_closed_profile_may_be_cut_anywhere() {
        let values = profile(360, |k| if k == 100 { -60e-6 } else { 0.0 });
        for by in [0, 98, 100, 101, 250] {
            let turned: Vec<f64> = (0..360).map(|k| values[(k + by) % 360]).collect();
            assert_eq!(found(&turned, Ends::Closed), [(100 + 360 - by) % 360], "{by}");
        }
    }

    #[test]
    fn twice_the_size_is_twice_as_far_off_and_no_other_is_bad() {
        let values = profile(360, |k| if k == 100 { 60e-6 } else { 0.0 });
        let twice: Vec<f64> = values.iter().map(|value| 2.0 * value + 1e-3).collect();
        let [one, other] = [&values, &twice].map(|values| strange(values, Ends::Closed));
        for (one, other) in one.iter().zip(&other) {
            assert_eq!(one.is_some(), other.is_some());
            let apart = one.zip(*other).map_or(0.0, |(one, other)| other - 2.0 * one);
            assert!(apart.abs() < 1e-15);
        }
    }

    #[test]
    fn rounding_is_no_dirt_and_neither_is_what_is_too_small_or_too_short_to_tell() {
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

//! A logarithmic axis: which values are marked, and what is written at them.
//!
//! ```text
//! decades 3 or more    1, 10, 100, ...           and thin lines at 2 ... 9 times
//! fewer                1, 2, 5, 10, 20, 50, ...  and thin lines between
//! ```
//!
//! Values are positive; positions on the picture are those of their common logarithm.

use crate::axis::number;

/// From this number of decades on only powers of ten have a number.
const MANY: f64 = 3.0;
/// Marks at most.
const MOST: usize = 400;

/// A marked value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LogTick {
    /// The common logarithm of the value.
    pub(crate) exponent: f64,
    /// The number at it; none at a thin line.
    pub(crate) label: Option<String>,
}

/// Marks from `low` to `high`, both positive, with numbers at intervals by how many decades they cover.
pub(crate) fn log_ticks([low, high]: [f64; 2]) -> Vec<LogTick> {
    let [first, last] = [low, high].map(f64::log10);
    if !(first.is_finite() && last.is_finite() && last > first) {
        return Vec::new();
    }
    let numbered: &[i32] = if last - first >= MANY { &[1] } else { &[1, 2, 5] };
    let slack = 1e-9;
    let mut ticks = Vec::new();
    let mut decade = first.floor();
    while decade <= last && ticks.len() < MOST {
        for digit in 1..10 {
            let exponent = decade + f64::from(digit).log10();
            if exponent >= first - slack && exponent <= last + slack {
                let is_numbered = numbered.contains(&digit);
                ticks.push(LogTick {
                    exponent,
                    label: is_numbered.then(|| label(digit, decade)),
                });
            }
        }
        decade += 1.0;
    }
    ticks
}

/// `digit` times ten to the power `decade`, with the decimals that it needs.
fn label(digit: i32, decade: f64) -> String {
    // unit: none, the number of decimals
    let decimals = (-decade).clamp(0.0, 12.0) as usize;
    number(f64::from(digit) * 10_f64.powf(decade), decimals)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(range: [f64; 2]) -> Vec<String> {
        log_ticks(range)
            .into_iter()
            .filter_map(|tick| tick.label)
            .collect()
    }

    #[test]
    fn a_few_decades_have_one_two_and_five_and_many_have_powers_of_ten() {
        assert_eq!(labels([8.0, 120.0]), ["10", "20", "50", "100"]);
        assert_eq!(labels([0.009, 20.0]), ["0.01", "0.1", "1", "10"]);
        assert_eq!(labels([0.01, 0.05]), ["0.01", "0.02", "0.05"], "both ends");
        assert!((log_ticks([8.0, 120.0])[0].exponent - 8_f64.log10()).abs() < 1e-12);
    }

    #[test]
    fn what_is_no_range_has_no_marks() {
        for range in [
            [0.0, 1.0],
            [2.0, 1.0],
            [1.0, f64::NAN],
            [-1.0, 1.0],
            [1.0, f64::INFINITY],
        ] {
            assert!(log_ticks(range).is_empty(), "{range:?}");
        }
    }
}

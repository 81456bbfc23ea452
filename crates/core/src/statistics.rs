//! Median and scatter of values that outliers do not change.
//!
//! ```text
//! median    the middle one of the sorted values, of an even number the mean of the two in the middle
//! scatter   1.4826 median |d|
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `d` | differences from a middle or a prediction | that of the values |
//!
//! The scatter is the standard deviation of a normal distribution. Half of the values may be wrong.
//! Source: Rousseeuw, Croux, "Alternatives to the median absolute deviation", J. Am. Stat. Assoc. 88 (1993) 1273-1283.

/// From the median size to the standard deviation, of a normal distribution: 1 / inverse of the distribution at 3/4.
const NORMAL: f64 = 1.4826;

/// The median of values that are not NaN; 0 of none.
// unit: that of the values
pub(crate) fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let half = sorted.len() / 2;
    match (sorted.len() % 2, sorted.len()) {
        (_, 0) => 0.0,
        (1, _) => sorted[half],
        _ => 0.5 * (sorted[half - 1] + sorted[half]),
    }
}

/// Standard deviation of these differences, from the median of their sizes; 0 of none.
// unit: that of the differences
pub(crate) fn robust_scatter(differences: &[f64]) -> f64 {
    let sizes: Vec<f64> = differences.iter().map(|difference| difference.abs()).collect();
    NORMAL * median(&sizes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arms::Stream;

    #[test]
    fn the_median_is_the_middle_or_the_mean_of_two() {
        assert_eq!(median(&[]), 0.0);
        assert_eq!(median(&[3.0]), 3.0);
        assert_eq!(median(&[9.0, -1.0, 2.0]), 2.0);
        assert_eq!(median(&[9.0, -1.0, 2.0, 5.0]), 3.5);
    }

    /// The standard error of the scatter of n values is 1.17/sqrt(n) (efficiency of 37 %): 0.4 % of 100 000.
    #[test]
    fn the_scatter_is_the_standard_deviation_and_outliers_do_not_change_it() {
        let mut stream = Stream(5);
        let mut values: Vec<f64> = (0..100_000).map(|_| 2.0 * stream.normal()).collect();
        assert!((robust_scatter(&values) / 2.0 - 1.0).abs() < 0.015);
        values[..100].fill(1e9);
        assert!((robust_scatter(&values) / 2.0 - 1.0).abs() < 0.015);
    }
}

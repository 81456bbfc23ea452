//! Nice numbers: tick positions and their labels.
//!
//! A step is 1, 2, 2.5 or 5 times a power of ten; labels carry the decimals that the step needs and a true minus sign.
//!
//! | function | 0.0123 | 45.678 | 1234.5 |
//! |---|---|---|---|
//! | `three_digits` | 0.0123 | 45.7 | 1234 |
//! | `plain` | 0.0123 | 45.68 | 1234 |
//!
//! A value that is not finite is written as a dash; a negative value that rounds to zero is written without its
//! sign.

/// Longest list of ticks; more cannot be read, and none are drawn then.
const MOST_TICKS: usize = 60;

/// The smallest nice step that is not below `span / count`; 1 for a span of nothing or one that is not finite.
/// A `count` below 1 counts as 1.
pub(crate) fn nice_step(span: f64, count: f64) -> f64 {
    let raw = span.abs() / count.max(1.0);
    if !raw.is_finite() || raw <= f64::MIN_POSITIVE {
        return 1.0;
    }
    let decade = 10f64.powf(raw.log10().floor());
    let fraction = raw / decade;
    // A small tolerance: 0.2 / 0.1 may give 2.0000000000000004.
    let nice = [1.0, 2.0, 2.5, 5.0]
        .into_iter()
        .find(|n| fraction <= n * (1.0 + 1e-9))
        .unwrap_or(10.0);
    nice * decade
}

/// The greatest number 1, 2 or 5 times a power of ten that is not above `value`; 1 for a value that is not positive.
pub(crate) fn nice_below(value: f64) -> f64 {
    if !value.is_finite() || value <= f64::MIN_POSITIVE {
        return 1.0;
    }
    let decade = 10f64.powf(value.log10().floor());
    let fraction = value / decade * (1.0 + 1e-9);
    let nice = [5.0, 2.0].into_iter().find(|n| fraction >= *n).unwrap_or(1.0);
    nice * decade
}

/// Multiples of `step` from `low` to `high` in rising order, both ends included, whichever of them is larger.
/// An end that misses a multiple by a millionth of a step counts as on it. Empty where an end is not finite,
/// the step is not positive, or there would be more than 60.
pub(crate) fn multiples(low: f64, high: f64, step: f64) -> Vec<f64> {
    if !(low.is_finite() && high.is_finite() && step > 0.0) {
        return Vec::new();
    }
    let (low, high) = (low.min(high), low.max(high));
    let slack = 1e-6;
    let first = (low / step - slack).ceil();
    let last = (high / step + slack).floor();
    let count = (last - first).max(-1.0) + 1.0;
    if count > MOST_TICKS as f64 {
        return Vec::new();
    }
    (0..count as usize).map(|k| (first + k as f64) * step).collect()
}

/// `value` with the decimals that `step` needs, at most six: `0.25` for a step of 0.25, `3` for a step of 1.
pub(crate) fn tick_label(value: f64, step: f64) -> String {
    let decimals = (0..6).find(|d| {
        let scaled = step.abs() * 10f64.powi(*d);
        (scaled - scaled.round()).abs() < 1e-6 * scaled.max(1e-300)
    });
    number(value, decimals.unwrap_or(6).unsigned_abs() as usize)
}

/// `value` with three significant digits, whole from 100 on, and six decimals at most; for labels next to a drawing.
pub(crate) fn three_digits(value: f64) -> String {
    let size = value.abs();
    let decimals = if size == 0.0 {
        0
    } else {
        (2.0 - size.log10().floor()).clamp(0.0, 6.0) as usize
    };
    number(value, decimals)
}

/// `value` with four significant digits, six decimals at most, without trailing zeros after the decimal point;
/// whole from 1000 on.
pub(crate) fn plain(value: f64) -> String {
    let size = value.abs();
    let decimals = if size >= 1000.0 {
        0
    } else {
        (3.0 - size.max(1e-3).log10().floor()).clamp(0.0, 6.0) as usize
    };
    let text = number(value, decimals);
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// `value` with `decimals` decimals, a true minus sign, and never a minus before zero; a dash where it is not
/// finite.
pub(crate) fn number(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|b| b == b'0' || b == b'.') => rest.to_owned(),
        Some(rest) => format!("\u{2212}{rest}"),
        None => text,
    }
}

/// Smallest and largest finite value; `None` where no value is finite.
pub(crate) fn extent(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    values
        .into_iter()
        .filter(|v| v.is_finite())
        .fold(None, |range, v| match range {
            None => Some((v, v)),
            Some((low, high)) => Some((v.min(low), v.max(high))),
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_multiples_of_a_nice_step_inside_the_range() {
        let step = nice_step(410.0 - -430.0, 6.0);
        assert!((step - 200.0).abs() < 1e-9);
        assert_eq!(
            multiples(-430.0, 410.0, step),
            [-400.0, -200.0, 0.0, 200.0, 400.0]
        );
    }

    #[test]
    fn labels_carry_the_decimals_of_the_step() {
        assert_eq!(tick_label(-2.5, 2.5), "\u{2212}2.5");
        assert_eq!(tick_label(100.0, 50.0), "100");
        assert_eq!(tick_label(-1e-12, 0.1), "0.0");
        assert_eq!(tick_label(0.25, 0.05), "0.25");
    }

    #[test]
    fn invalid_ranges_do_not_cause_endless_loops() {
        assert!(multiples(f64::NAN, 1.0, 1.0).is_empty());
        assert!(multiples(0.0, 1e300, 1.0).is_empty());
        assert!(multiples(3.0, 3.0, nice_step(0.0, 5.0)).len() <= 1);
        let endless = [f64::NEG_INFINITY, f64::INFINITY];
        assert!(multiples(endless[0], endless[1], nice_step(f64::INFINITY, 5.0)).is_empty());
    }

    #[test]
    fn three_digits_mean_something_on_every_scale() {
        let given = [1234.4, 123.4, 12.34, 1.234, 0.4, 0.0456, 0.001234, -0.05, 0.0].map(three_digits);
        let expected = [
            "1234",
            "123",
            "12.3",
            "1.23",
            "0.400",
            "0.0456",
            "0.00123",
            "\u{2212}0.0500",
            "0",
        ];
        assert_eq!(given, expected);
        assert_eq!(three_digits(f64::NAN), "–");
    }

    #[test]
    fn nice_below_is_not_above() {
        for v in [0.3, 1.0, 4.9, 5.0, 73.0, 1999.0] {
            let n = nice_below(v);
            assert!(n <= v * (1.0 + 1e-9) && n > v / 2.6, "{v} {n}");
        }
    }
}

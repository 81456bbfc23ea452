//! Numbers in robot programs: a fixed number of decimals, a point, and no minus sign before zero.

use std::fmt::Write;
use std::ops::Range;

/// Writes `value` with this number of decimals.
pub(super) fn write_fixed(out: &mut String, value: f64, decimals: usize) {
    let start = out.len();
    // Writing to a string cannot fail.
    let _ = write!(out, "{value:.decimals$}");
    let written = &out[start..];
    if written.starts_with('-') && written[1..].bytes().all(|byte| matches!(byte, b'0' | b'.')) {
        out.remove(start);
    }
}

/// `value` with this number of decimals.
pub(super) fn fixed(value: f64, decimals: usize) -> String {
    let mut out = String::new();
    write_fixed(&mut out, value, decimals);
    out
}

/// Number of decimals of a number, within this range.
pub(super) fn decimals(number: &str, least: usize, most: usize) -> usize {
    let written = number.split_once('.').map_or(0, |(_, behind)| {
        behind.bytes().take_while(u8::is_ascii_digit).count()
    });
    written.clamp(least, most)
}

/// `before` with the numbers in these byte ranges replaced, each with its number of decimals within this range.
pub(super) fn replace_numbers(
    before: &str,
    numbers: impl IntoIterator<Item = (Range<usize>, f64)>,
    decimals: [usize; 2],
    out: &mut String,
) {
    let [least, most] = decimals;
    let mut done = 0;
    for (place, number) in numbers {
        out.push_str(&before[done..place.start]);
        write_fixed(out, number, self::decimals(&before[place.clone()], least, most));
        done = place.end;
    }
    out.push_str(&before[done..]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_has_no_minus_sign_and_other_values_keep_theirs() {
        assert_eq!(fixed(-0.0, 3), "0.000");
        assert_eq!(fixed(-0.000_4, 3), "0.000");
        assert_eq!(fixed(-0.000_6, 3), "-0.001");
        assert_eq!(fixed(-10.0, 0), "-10");
        assert_eq!(fixed(-0.3, 0), "0");
    }

    #[test]
    fn decimals_are_those_written_within_the_range() {
        for (number, requested) in [
            ("1", 3),
            ("1.25", 3),
            ("1.23456", 5),
            ("1.5E3", 3),
            ("1.0123456789012", 9),
        ] {
            assert_eq!(decimals(number, 3, 9), requested);
        }
    }
}

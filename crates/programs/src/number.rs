//! Numbers in robot programs: a fixed number of decimals, a point, and no minus sign before zero.

use std::fmt::Write;

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
}

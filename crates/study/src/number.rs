//! Numbers for output: without rounding errors of computation, with their significant digits.
//!
//! None of them is -0.

/// `value` without rounding of unit and frame changes beyond the tenth decimal: as it was given.
pub fn without_rounding(value: f64) -> f64 {
    decimals(value, 10)
}

/// `value` to so many decimals.
pub fn decimals(value: f64, places: i32) -> f64 {
    let unit = 10_f64.powi(places);
    without_minus((value * unit).round() / unit)
}

/// `value` to so many significant digits.
///
/// Zero stays zero.
pub fn digits(value: f64, digits: i32) -> f64 {
    let unit = 10_f64.powf(value.abs().log10().floor() - f64::from(digits - 1));
    without_minus(if unit > 0.0 {
        (value / unit).round() * unit
    } else {
        value
    })
}

/// 0 in place of -0.
fn without_minus(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value }
}

/// A deviation with its significant digits.
pub fn micrometres(um: f64) -> String {
    if um == um.round() && um < 1e6 {
        format!("{um:.0}")
    } else if um.abs() < 10.0 {
        format!("{um:.2}")
    } else {
        format!("{um:.1}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_shown_as_given() {
        assert_eq!(without_rounding(0.1 + 0.2), 0.3);
        assert_eq!(without_rounding((-170f64).to_radians().to_degrees()), -170.0);
        assert!(without_rounding(-1e-12).is_sign_positive());
    }

    #[test]
    fn decimals_count_from_the_point_and_digits_from_the_first() {
        assert_eq!(decimals(1012.5954, 2), 1012.6);
        assert_eq!(digits(1012.5954, 4), 1013.0);
        assert_eq!(decimals(digits(0.024_58, 2), 6), 0.025);
        assert_eq!(digits(0.0, 4), 0.0);
    }
}

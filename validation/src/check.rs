//! One comparison: the quantity, its reference, the tolerance and the error.
//!
//! The text of a check is the same on every machine: errors at the level of rounding are reported as a power of ten
//! well above them, errors against printed numbers with fixed decimals.
//!
//! | constructor | reported | used for |
//! |---|---|---|
//! | `Check::printed` | the error with fixed decimals | printed numbers: error of half of the last digit |
//! | `Check::computed` | `below 1e-12` | two computations that differ by rounding |
//! | `Check::none_wrong` | a count | items that must not occur |
//!
//! A check passes if the largest error is not above the tolerance, which is derived on the page of its case.

/// Smallest exponent that is reported: below it results differ between machines by a few bits.
const LEAST_EXPONENT: i32 = -14;
/// Sines of another library round differently: an error larger by this factor must not change the text.
const MORE_ERROR: f64 = 3.0;

/// The largest error found and the tolerance, in the same unit.
#[derive(Clone, Copy, Debug)]
pub struct ErrorBound {
    /// Largest error, never negative; infinite if nothing was compared, or if a value is not a number.
    pub worst: f64,
    /// Permitted error.
    pub tolerance: f64,
    /// Unit of both; empty for ratios.
    pub unit: &'static str,
}

/// One comparison, in text that does not depend on the machine.
#[derive(Clone, Debug)]
pub struct Check {
    /// What was compared.
    pub what: String,
    /// With what.
    pub reference: &'static str,
    /// Permitted error.
    pub tolerance: String,
    /// Error found.
    pub reached: String,
    /// Whether the error is within the tolerance.
    pub passed: bool,
}

impl Check {
    /// A comparison with printed numbers: the error is reported with this number of decimals, chosen so that the
    /// text shows which part of the tolerance is used.
    pub fn printed(
        what: impl Into<String>,
        reference: &'static str,
        bound: ErrorBound,
        decimals: usize,
    ) -> Check {
        let reached = format!("{:.decimals$}", bound.worst);
        Check::new(what.into(), reference, bound, reached)
    }

    /// A comparison of two computations: the error is reported as the first power of ten above three times its value,
    /// never less than 1e-14.
    pub fn computed(what: impl Into<String>, reference: &'static str, bound: ErrorBound) -> Check {
        let reached = format!("below {}", power_of_ten_above(MORE_ERROR * bound.worst));
        Check::new(what.into(), reference, bound, reached)
    }

    /// A count of items that must not occur; passes only at 0.
    pub fn none_wrong(what: impl Into<String>, reference: &'static str, wrong: usize) -> Check {
        Check {
            what: what.into(),
            reference,
            tolerance: "0".to_owned(),
            reached: wrong.to_string(),
            passed: wrong == 0,
        }
    }

    /// The tolerance is written as a decimal number from 1e-5 on, below as a power of ten.
    fn new(what: String, reference: &'static str, bound: ErrorBound, reached: String) -> Check {
        let with_unit = |number: String| format!("{number} {}", bound.unit).trim_end().to_owned();
        let plain = bound.tolerance >= 1e-5;
        let tolerance = if plain {
            bound.tolerance.to_string()
        } else {
            format!("{:e}", bound.tolerance)
        };
        let passed = bound.worst <= bound.tolerance;
        Check {
            what,
            reference,
            tolerance: with_unit(tolerance),
            reached: with_unit(reached),
            passed,
        }
    }
}

/// The largest absolute value of these errors; infinite if one is not a number or there is none.
pub fn worst(errors: impl IntoIterator<Item = f64>) -> f64 {
    let size = |error: f64| {
        if error.is_nan() {
            f64::INFINITY
        } else {
            error.abs()
        }
    };
    errors
        .into_iter()
        .map(size)
        .reduce(f64::max)
        .unwrap_or(f64::INFINITY)
}

/// The largest difference between these numbers, one by one; infinite if their counts differ, or if there are
/// none.
pub fn worst_difference(found: &[f64], expected: &[f64]) -> f64 {
    if found.len() != expected.len() {
        return f64::INFINITY;
    }
    worst(found.iter().zip(expected).map(|(a, b)| a - b))
}

/// `1e-9` for 3e-10: the first power of ten above, not below [`LEAST_EXPONENT`].
fn power_of_ten_above(error: f64) -> String {
    if !error.is_finite() {
        return "infinity".to_owned();
    }
    let exponent = (error.log10().floor() as i32).saturating_add(1);
    format!("1e{}", exponent.max(LEAST_EXPONENT))
}

/// Fails with every check that does not pass.
#[cfg(test)]
pub fn assert_all_pass(checks: &[Check]) {
    let wrong: Vec<&Check> = checks.iter().filter(|check| !check.passed).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(!checks.is_empty(), "a case without checks");
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bound(worst: f64) -> ErrorBound {
        ErrorBound {
            worst,
            tolerance: 1e-12,
            unit: "m",
        }
    }

    #[test]
    fn reports_rounding_as_a_power_of_ten_above_three_times_the_error() {
        let given = |error| Check::computed("", "", bound(error)).reached;
        assert_eq!(given(3.1e-14), "below 1e-13 m");
        assert_eq!(given(3.5e-14), "below 1e-12 m");
        assert_eq!(
            (given(0.0), given(1e-17)),
            ("below 1e-14 m".to_owned(), "below 1e-14 m".to_owned())
        );
        assert_eq!(given(f64::INFINITY), "below infinity m");
    }

    #[test]
    fn a_value_that_is_not_a_number_never_passes() {
        assert_eq!(worst([0.5, f64::NAN, 0.1]), f64::INFINITY);
        assert!(!Check::computed("", "", bound(f64::NAN)).passed);
        assert!(!Check::printed("", "", bound(worst([f64::NAN])), 3).passed);
    }

    #[test]
    fn an_empty_comparison_never_passes() {
        assert!(!Check::computed("", "", bound(worst([]))).passed);
        assert_eq!(worst_difference(&[1.0, 2.0], &[1.0]), f64::INFINITY);
    }

    #[test]
    fn reports_small_tolerances_as_powers() {
        let check = Check::printed(
            "",
            "",
            ErrorBound {
                worst: 0.024,
                tolerance: 0.05,
                unit: "um",
            },
            3,
        );
        assert_eq!(
            (check.tolerance.as_str(), check.reached.as_str()),
            ("0.05 um", "0.024 um")
        );
        assert_eq!(Check::computed("", "", bound(0.0)).tolerance, "1e-12 m");
    }
}

//! One comparison: what was compared, with which witness, how near it must come and how near it came.
//!
//! The words of a check are the same on every machine: errors at the level of rounding are told as a power of ten
//! well above them, errors against printed numbers with fixed decimals.
//!
//! | made by | told | for |
//! |---|---|---|
//! | `Check::printed` | the error with fixed decimals | numbers that a source prints: off by half of the last digit |
//! | `Check::computed` | `below 1e-12` | two computations that differ by rounding |
//! | `Check::none_wrong` | a count | things that must not be |
//!
//! A check holds where the greatest error is not above the tolerance, which the page of its case derives.

/// Smallest exponent that is told: below it one machine finds zero where another finds a few bits.
const LEAST_EXPONENT: i32 = -14;
/// Sines of another library round otherwise: this much more error must not change what is told.
const MORE_ERROR: f64 = 3.0;

/// The greatest error found and the greatest that may be, in the same unit.
#[derive(Clone, Copy, Debug)]
pub struct Gap {
    /// As found, never negative; infinite where there was nothing to compare, or where a number is none.
    pub worst: f64,
    /// As permitted.
    pub tolerance: f64,
    /// Unit of both; empty for ratios.
    pub unit: &'static str,
}

/// One comparison, in words that do not depend on the machine.
#[derive(Clone, Debug)]
pub struct Check {
    /// What was compared.
    pub what: String,
    /// With what.
    pub witness: &'static str,
    /// How near it must come.
    pub tolerance: String,
    /// How near it came.
    pub reached: String,
    /// Whether that is near enough.
    pub holds: bool,
}

impl Check {
    /// A comparison with printed numbers: the error is told with this many decimals. Take so many that the
    /// words show how much of the tolerance is used.
    pub fn printed(what: impl Into<String>, witness: &'static str, gap: Gap, decimals: usize) -> Check {
        let reached = format!("{:.decimals$}", gap.worst);
        Check::new(what.into(), witness, gap, reached)
    }

    /// A comparison of two computations: the error is told as the first power of ten above three times it,
    /// never less than 1e-14.
    pub fn computed(what: impl Into<String>, witness: &'static str, gap: Gap) -> Check {
        let reached = format!("below {}", power_of_ten_above(MORE_ERROR * gap.worst));
        Check::new(what.into(), witness, gap, reached)
    }

    /// A count of things that must not be; holds at 0 alone.
    pub fn none_wrong(what: impl Into<String>, witness: &'static str, wrong: usize) -> Check {
        Check {
            what: what.into(),
            witness,
            tolerance: "0".to_owned(),
            reached: wrong.to_string(),
            holds: wrong == 0,
        }
    }

    /// The tolerance is told plainly from 1e-5 on, below as a power.
    ///
    /// The tolerance is told plainly from 1e-5 on, below as a power of ten.
    fn new(what: String, witness: &'static str, gap: Gap, reached: String) -> Check {
        let with_unit = |number: String| format!("{number} {}", gap.unit).trim_end().to_owned();
        let plain = gap.tolerance >= 1e-5;
        let tolerance = if plain {
            gap.tolerance.to_string()
        } else {
            format!("{:e}", gap.tolerance)
        };
        let holds = gap.worst <= gap.tolerance;
        Check {
            what,
            witness,
            tolerance: with_unit(tolerance),
            reached: with_unit(reached),
            holds,
        }
    }
}

/// The greatest of these errors by size; infinite if one is not a number or there is none.
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

/// The greatest difference between these numbers, one by one; infinite if there are not as many of both, or
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

/// Fails, telling every check that does not hold.
#[cfg(test)]
pub fn assert_all_hold(checks: &[Check]) {
    let wrong: Vec<&Check> = checks.iter().filter(|check| !check.holds).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(!checks.is_empty(), "a case without checks");
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gap(worst: f64) -> Gap {
        Gap {
            worst,
            tolerance: 1e-12,
            unit: "m",
        }
    }

    #[test]
    fn rounding_is_told_as_a_power_of_ten_above_three_times_the_error() {
        let given = |error| Check::computed("", "", gap(error)).reached;
        assert_eq!(given(3.1e-14), "below 1e-13 m");
        assert_eq!(given(3.5e-14), "below 1e-12 m");
        assert_eq!(
            (given(0.0), given(1e-17)),
            ("below 1e-14 m".to_owned(), "below 1e-14 m".to_owned())
        );
        assert_eq!(given(f64::INFINITY), "below infinity m");
    }

    #[test]
    fn what_is_not_a_number_never_holds() {
        assert_eq!(worst([0.5, f64::NAN, 0.1]), f64::INFINITY);
        assert!(!Check::computed("", "", gap(f64::NAN)).holds);
        assert!(!Check::printed("", "", gap(worst([f64::NAN])), 3).holds);
    }

    #[test]
    fn nothing_compared_never_holds() {
        assert!(!Check::computed("", "", gap(worst([]))).holds);
        assert_eq!(worst_difference(&[1.0, 2.0], &[1.0]), f64::INFINITY);
    }

    #[test]
    fn small_tolerances_are_told_as_powers() {
        let check = Check::printed(
            "",
            "",
            Gap {
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
        assert_eq!(Check::computed("", "", gap(0.0)).tolerance, "1e-12 m");
    }
}

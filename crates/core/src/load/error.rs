//! Errors of cutting force inputs.

/// An input from which no cutting force can be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CuttingError {
    /// A quantity out of its range.
    #[error("{what} is {}: must be {}", reported(*.value, .unit), allowed([*.least, *.most], .unit))]
    OutOfRange {
        /// Which quantity.
        what: &'static str,
        /// The value given.
        value: f64,
        /// Least valid value.
        least: f64,
        /// Greatest valid value.
        most: f64,
        /// Unit of the three.
        unit: &'static str,
    },
    /// A number that is not finite.
    #[error("{0} is not a finite number")]
    NotFinite(&'static str),
    /// Not a valid covariance: not symmetric, or a negative variance.
    #[error("{0} is not valid: it must be symmetric, with variances of at least 0")]
    NoCovariance(&'static str),
    /// A feed along the tool axis towards the part: the bottom edges cut, which milling forces leave out.
    #[error(
        "the feed descends {angle_deg:.1} deg along the tool axis: milling forces are valid up to {most_deg:.0} deg"
    )]
    Plunge {
        /// Descent angle of the feed.
        angle_deg: f64,
        /// Steepest descent that the model covers.
        most_deg: f64,
    },
    /// A feed straight along the tool axis away from the part: nothing is cut.
    #[error("the tool retracts along its axis: nothing is cut")]
    Withdrawal,
}

/// A number with its unit: lengths in mm, rounded to nine decimals.
fn reported(value: f64, unit: &str) -> String {
    let (value, unit) = match unit {
        "m" => (value * 1e3, "mm"),
        _ => (value, unit),
    };
    let rounded = (value * 1e9).round() / 1e9;
    let shown = if rounded == 0.0 || rounded.abs() > 1e15 {
        value
    } else {
        rounded
    };
    format!("{shown} {unit}").trim_end().to_owned()
}

/// A range in words: its finite ends.
fn allowed([least, most]: [f64; 2], unit: &str) -> String {
    let upper = reported(most, unit);
    match (least == f64::MIN_POSITIVE, most == f64::MAX) {
        (true, true) => "above 0".to_owned(),
        (true, false) => format!("above 0 and at most {upper}"),
        (false, true) => format!("at least {}", reported(least, unit)),
        (false, false) => format!("between {} and {upper}", reported(least, unit)),
    }
}

/// `value` if it is between `least` and `most`.
pub(crate) fn checked(
    what: &'static str,
    value: f64,
    [least, most]: [f64; 2],
    unit: &'static str,
) -> Result<f64, CuttingError> {
    if !value.is_finite() {
        return Err(CuttingError::NotFinite(what));
    }
    if value < least || value > most {
        return Err(CuttingError::OutOfRange {
            what,
            value,
            least,
            most,
            unit,
        });
    }
    Ok(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_is_reported_in_millimetres_and_by_its_finite_ends() {
        let reported = |value, ends, unit| checked("depth", value, ends, unit).unwrap_err().to_string();
        assert_eq!(
            reported(9e-3, [f64::MIN_POSITIVE, 6e-3], "m"),
            "depth is 9 mm: must be above 0 and at most 6 mm"
        );
        assert_eq!(
            reported(0.0, [f64::MIN_POSITIVE, f64::MAX], "rad/s"),
            "depth is 0 rad/s: must be above 0"
        );
        assert_eq!(
            reported(20e-3, [0.0, 5e-3], "m"),
            "depth is 20 mm: must be between 0 mm and 5 mm"
        );
    }

    #[test]
    fn every_message_names_the_quantity_its_value_and_its_limit() {
        let reported = [
            (
                CuttingError::OutOfRange {
                    what: "number of flutes",
                    value: 0.0,
                    least: 1.0,
                    most: 100.0,
                    unit: "",
                },
                "number of flutes is 0: must be between 1 and 100",
            ),
            (
                CuttingError::OutOfRange {
                    what: "feed speed",
                    value: -0.02,
                    least: 0.0,
                    most: f64::MAX,
                    unit: "m/s",
                },
                "feed speed is -0.02 m/s: must be at least 0 m/s",
            ),
            (CuttingError::NotFinite("kc1"), "kc1 is not a finite number"),
            (
                CuttingError::NoCovariance("the covariance of the cutting coefficients"),
                "the covariance of the cutting coefficients is not valid: it must be symmetric, with variances of \
                 at least 0",
            ),
            (
                CuttingError::Plunge {
                    angle_deg: 41.25,
                    most_deg: 30.0,
                },
                "the feed descends 41.2 deg along the tool axis: milling forces are valid up to 30 deg",
            ),
            (
                CuttingError::Withdrawal,
                "the tool retracts along its axis: nothing is cut",
            ),
        ];
        for (error, text) in reported {
            assert_eq!(error.to_string(), text);
        }
    }

    #[test]
    fn a_value_is_checked_at_both_ends_which_are_valid() {
        let ends = [-1.0, 2.0];
        for value in [-1.0, 0.0, 2.0] {
            assert_eq!(checked("depth", value, ends, "m"), Ok(value));
        }
        for value in [-1.0 - 1e-15, 2.0 + 1e-15] {
            let refused = checked("depth", value, ends, "m");
            assert!(matches!(refused, Err(CuttingError::OutOfRange { .. })), "{value}");
        }
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(
                checked("depth", value, ends, "m"),
                Err(CuttingError::NotFinite("depth"))
            );
        }
        // Digits beyond the ninth decimal are not reported, unless the whole number is smaller than that.
        let reported = |value| checked("depth", value, [0.0, 1e-20], "").unwrap_err().to_string();
        assert!(
            reported(0.1 + 0.2).starts_with("depth is 0.3:"),
            "{}",
            reported(0.1 + 0.2)
        );
        assert!(
            reported(1e-12).starts_with("depth is 0.000000000001:"),
            "{}",
            reported(1e-12)
        );
    }
}

//! What a cutting force cannot be computed from.

/// An input of a cutting force that has no meaning.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CuttingError {
    /// A quantity outside what it can be.
    #[error("{what} is {value} {unit}: must be between {least} and {most} {unit}")]
    OutOfRange {
        /// Which quantity.
        what: &'static str,
        /// As given.
        value: f64,
        /// Least that it can be.
        least: f64,
        /// Most that it can be.
        most: f64,
        /// Unit of the three.
        unit: &'static str,
    },
    /// A number that is not finite.
    #[error("{0} is not a finite number")]
    NotFinite(&'static str),
    /// A covariance that no numbers can have: not symmetric, or a negative variance.
    #[error("{0} is no covariance: it must be symmetric, with variances that are not negative")]
    NoCovariance(&'static str),
    /// A feed along the tool axis towards the part: the bottom edges cut, which milling forces leave out.
    #[error(
        "the tool dives {angle_deg:.1} deg below the plane across its axis: milling forces hold to {most_deg:.0} deg"
    )]
    Plunge {
        /// Dive of the feed.
        angle_deg: f64,
        /// Steepest dive that the model takes.
        most_deg: f64,
    },
    /// A feed straight along the tool axis away from the part: nothing is cut.
    #[error("the tool leaves the part along its axis: nothing is cut")]
    Withdrawal,
}

/// `value` if it lies between `least` and `most`.
pub(super) fn within(
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

//! Errors of features.

/// Why an evaluation of form, size or location has no result.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FormError {
    /// Too few points.
    #[error("{given} points: at least {needed} are needed")]
    TooFew {
        /// This number is needed.
        needed: usize,
        /// This number was given.
        given: usize,
    },
    /// A value that is not a number, or larger than any part.
    #[error("point {} has a value that is not finite, or beyond 1e6", .index + 1)]
    NotFinite {
        /// Index of the point, from 0.
        index: usize,
    },
    /// Two lists that belong together differ in length.
    #[error("{given} values for {needed} points")]
    Lengths {
        /// Number of points.
        needed: usize,
        /// Number of values.
        given: usize,
    },
    /// The points do not determine the feature: points on a line for a plane, a narrow strip for a cylinder.
    #[error("the points do not determine the feature: they must be spread over it")]
    Undetermined,
    /// A one-sided fit without limit: the points are on one side only.
    #[error(
        "the points do not enclose the feature: an inscribed or circumscribed feature needs points all around"
    )]
    OneSided,
    /// No proof of the optimum within the number of exchanges, or no convergence of the steps.
    #[error("no optimum found after {rounds} steps: the points hardly determine the feature")]
    NotFound {
        /// Steps done.
        rounds: usize,
    },
    /// A length that must be positive.
    #[error("a length of {value} m: must be greater than 0")]
    Length {
        /// The value given, m.
        value: f64,
    },
}

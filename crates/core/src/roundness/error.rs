//! Errors of circles, filters and harmonics.

/// Why an evaluation of roundness has no result.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RoundnessError {
    /// A coordinate that is not a number, or larger than any part.
    #[error("point {} has a coordinate that is not finite, or beyond 1e6 m", .index + 1)]
    NotFinite {
        /// Index of the point, from 0.
        index: usize,
    },
    /// Too few points, points on a line, all at one position.
    #[error("no circle is nearest to the points: at least 3 that are not on a line are needed")]
    NoCircle,
    /// The points leave half a turn or more open: there is no largest inscribed circle.
    #[error(
        "the points leave {gap_deg:.1} deg open: an inscribed circle needs a gap of less than {most_deg:.0} deg"
    )]
    Open {
        /// The largest angle between neighbours, about the least-squares circle.
        gap_deg: f64,
        /// From this on there is no inscribed circle.
        most_deg: f64,
    },
    /// The largest empty circle about a point inside the profile does not touch three points around it.
    #[error("the largest circle between the points touches them on one side only")]
    OneSided,
    /// The narrowest zone is between circles so large that they are lines.
    #[error(
        "the narrowest zone is between two lines rather than circles: the arc is too short for its form error"
    )]
    Straight,
    /// Too many centres are nearly equivalent.
    #[error("the best centre could not be proven among {cells} areas: the points hardly determine it")]
    NotProven {
        /// Number of areas examined.
        cells: usize,
    },
    /// A cut-off that is not a valid number of waves.
    #[error("a cut-off of {upr} UPR: must be at least 1")]
    CutOff {
        /// The value given.
        upr: f64,
    },
    /// Points too far apart for a filter.
    #[error(
        "the largest step between points is {gap_deg:.3} deg: a filter of {upr} UPR needs {most_deg:.3} deg or less, {least_points} even points per turn"
    )]
    Sparse {
        /// The largest angle between neighbours.
        gap_deg: f64,
        /// The largest that the filter permits.
        most_deg: f64,
        /// Cut-off, waves a turn.
        upr: f64,
        /// This number of even points is sufficient.
        least_points: usize,
    },
}

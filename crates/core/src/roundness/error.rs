//! What keeps a circle, a filter or a harmonic from being told.

/// Points that a question about roundness has no answer for.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RoundnessError {
    /// A coordinate that is no number, or larger than any part.
    #[error("point {} has a coordinate that is not finite, or beyond 1e6 m", .index + 1)]
    NotFinite {
        /// Which point, from 0.
        index: usize,
    },
    /// Too few points, points on a line, all in one place.
    #[error("no circle is nearest to the points: it takes three that lie on no line")]
    NoCircle,
    /// The points leave half a turn or more open: the largest inscribed circle has no end.
    #[error(
        "the points leave {gap_deg:.1} deg open: a circle between them could leave through a gap of {most_deg:.0} deg or more"
    )]
    Open {
        /// The largest angle between neighbours, about the least-squares circle.
        gap_deg: f64,
        /// Beyond this nothing holds an inscribed circle.
        most_deg: f64,
    },
    /// The largest empty circle about a point inside the profile is not held by three points around it.
    #[error("the largest circle between the points is held from one side only")]
    NotHeld,
    /// The narrowest zone lies between circles so large that they are lines.
    #[error(
        "the narrowest zone lies between two lines rather than circles: the arc is too short for its form error"
    )]
    Straight,
    /// Too many centres are about as good as each other.
    #[error("the best centre could not be proven among {cells} areas: the points hardly tell where it is")]
    NotProven {
        /// How many areas were looked at.
        cells: usize,
    },
    /// A cut-off that is no number of waves.
    #[error("a cut-off of {upr} UPR: must be at least 1")]
    CutOff {
        /// As given.
        upr: f64,
    },
    /// Points too far apart for a filter.
    #[error(
        "the largest step between points is {gap_deg:.3} deg: a filter of {upr} UPR needs {most_deg:.3} deg or less, {least_points} even points a turn"
    )]
    Sparse {
        /// The largest angle between neighbours.
        gap_deg: f64,
        /// The largest that the filter takes.
        most_deg: f64,
        /// Cut-off, waves a turn.
        upr: f64,
        /// As many even points would do.
        least_points: usize,
    },
}

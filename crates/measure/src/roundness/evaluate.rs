//! The four circles of a profile, as measured or filtered, its harmonics, and its outliers.
//!
//! The centre of the least-squares circle of the points as they were measured is that of all angles; a filter works on
//! the deviations from that circle, and the circles are then fitted to the filtered profile.

use armill_core::roundness::{Harmonic, Plane, Polar, Profile, ReferenceCircle, RoundnessError, Zone};
use armill_formats::measurement::profile::{MeasuredProfile, Points};
use armill_study::StudyError;

/// Settings of the evaluation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Question {
    /// Cut-off of the Gaussian filter, undulations per revolution; without it the profile is not filtered.
    pub upr: Option<u32>,
    /// Number of harmonics reported, from 1.
    pub harmonics: usize,
}

/// Result of the evaluation. SI.
#[derive(Clone, Debug)]
pub struct RoundnessEvaluation {
    /// The plane of points in space.
    pub plane: Option<Plane>,
    /// Angles and deviations of all points about the least-squares circle of the evaluated profile: filtered, if
    /// requested.
    pub polar: Polar,
    /// LSCI.
    pub least_squares: ReferenceCircle,
    /// MZCI, or the reason why there is none.
    pub zone: Result<Zone, RoundnessError>,
    /// MCCI.
    pub circumscribed: ReferenceCircle,
    /// MICI, or the reason why there is none.
    pub inscribed: Result<ReferenceCircle, RoundnessError>,
    /// Of the points as they were measured.
    pub harmonics: Vec<Harmonic>,
    /// Outliers of the measured points: index and distance.
    pub outliers: Vec<(usize, f64)>,
    /// Deviations of the measured points, if a filter was requested.
    pub measured: Option<Polar>,
}

/// Evaluates the points of `measured`; `shown` is the name of their file in problems.
///
/// # Errors
/// Points that have no plane or no circle; a filter that they are too sparse for.
pub fn evaluate(
    shown: &str,
    measured: &MeasuredProfile,
    question: &Question,
) -> Result<RoundnessEvaluation, StudyError> {
    let (plane, points) = match &measured.points {
        Points::Plane(points) => (None, points.clone()),
        Points::Space(points) => {
            let plane = Plane::nearest(points).ok_or_else(|| no_circle(shown, RoundnessError::NoCircle))?;
            let seen = points.iter().map(|point| plane.seen(point)).collect();
            (Some(plane), seen)
        }
    };
    let refused = |error| no_circle(shown, error);
    let as_measured = Profile::new(points).map_err(refused)?;
    let polar = as_measured.polar();
    let (harmonics, outliers) = (polar.harmonics(question.harmonics), polar.outliers());
    let filtered = question.upr.map(|upr| {
        let left = polar.filtered(f64::from(upr)).map_err(|error| {
            StudyError::value(
                format!("--upr: {shown}: {error}"),
                "measure more points all around, use a lower cut-off, or no filter",
            )
        })?;
        Profile::new(polar.with(&left)).map_err(refused)
    });
    let filtered = filtered.transpose()?;
    let profile = filtered.as_ref().unwrap_or(&as_measured);
    Ok(RoundnessEvaluation {
        plane,
        least_squares: profile.least_squares(),
        zone: profile.minimum_zone(),
        circumscribed: profile.minimum_circumscribed(),
        inscribed: profile.maximum_inscribed(),
        harmonics,
        outliers,
        polar: profile.polar(),
        measured: filtered.is_some().then_some(polar),
    })
}

/// Points that have no circle.
fn no_circle(shown: &str, error: RoundnessError) -> StudyError {
    StudyError::value(
        format!("{shown}: {error}"),
        "three points or more, spread along an arc; points on one line have no circle",
    )
}

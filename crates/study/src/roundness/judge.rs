//! The four circles of a profile, as it was measured or after a filter, its waves, and the points that stand out.
//!
//! The centre of the least-squares circle of the points as they were measured is that of all angles; a filter works on
//! the deviations from that circle, and the circles are then put to what it leaves.

use armill_core::roundness::{Harmonic, Plane, Polar, Profile, ReferenceCircle, RoundnessError, Zone};
use armill_formats::measurement::profile::{MeasuredProfile, Points};

use crate::StudyError;

/// What is asked of a profile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Question {
    /// Cut-off of the Gaussian filter, waves a turn; without it nothing is filtered.
    pub upr: Option<u32>,
    /// Waves a turn that are told, from 1.
    pub harmonics: usize,
}

/// What was found. SI.
#[derive(Clone, Debug)]
pub struct Judged {
    /// The plane of points in space.
    pub plane: Option<Plane>,
    /// Angles and deviations of all points about the least-squares circle of what was judged: filtered, if it was asked.
    pub polar: Polar,
    /// LSCI.
    pub least_squares: ReferenceCircle,
    /// MZCI, or why there is none.
    pub zone: Result<Zone, RoundnessError>,
    /// MCCI.
    pub circumscribed: ReferenceCircle,
    /// MICI, or why there is none.
    pub inscribed: Result<ReferenceCircle, RoundnessError>,
    /// Of the points as they were measured.
    pub harmonics: Vec<Harmonic>,
    /// Points as they were measured that stand out of their neighbours: which, and how far.
    pub outliers: Vec<(usize, f64)>,
    /// Deviations of the points as they were measured, where a filter was asked for.
    pub measured: Option<Polar>,
}

/// Judges the points of `measured`; `shown` is what problems call their file.
///
/// # Errors
/// Points that have no plane or no circle; a filter that they are too sparse for.
pub fn judge(shown: &str, measured: &MeasuredProfile, question: &Question) -> Result<Judged, StudyError> {
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
                "measure more points all round, take a lower cut-off, or leave the filter out",
            )
        })?;
        Profile::new(polar.with(&left)).map_err(refused)
    });
    let filtered = filtered.transpose()?;
    let profile = filtered.as_ref().unwrap_or(&as_measured);
    Ok(Judged {
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

//! The result of a profile.
//!
//! `lsci, mzci, mcci, mici` with `centre_mm`, `radius_mm` or `radii_mm`, and `ront_mm` are a public contract. A centre
//! has two coordinates where the points had two, and three, in the axes of the file, where they had three.

use armill_core::nalgebra::Point2;
use armill_core::roundness::{Plane, ReferenceCircle, Zone};
use armill_core::units::{to_deg, to_mm, to_um};
use armill_formats::measurement::profile::MeasuredProfile;
use serde::Serialize;

use super::{Question, RoundnessEvaluation};

/// A profile in numbers.
#[derive(Clone, Debug, Serialize)]
pub struct RoundnessAnswer {
    /// Its file.
    pub file: String,
    /// The format it is in.
    pub format: &'static str,
    /// How many points it has.
    pub points: usize,
    /// Columns that were passed over.
    pub unused: Vec<String>,
    /// The plane of points in space.
    pub plane: Option<PlaneAnswer>,
    /// The largest angle between neighbours.
    pub largest_gap_deg: f64,
    /// Cut-off of the Gaussian filter, undulations per revolution; none without a filter.
    pub filter_upr: Option<u32>,
    /// Least-squares circle.
    pub lsci: LeastSquaresAnswer,
    /// Minimum zone circles; none if they could not be determined.
    pub mzci: Option<ZoneAnswer>,
    /// Why there are none.
    pub mzci_refused: Option<String>,
    /// Minimum circumscribed circle.
    pub mcci: CircleAnswer,
    /// Maximum inscribed circle; none for an arc.
    pub mici: Option<CircleAnswer>,
    /// Reason why there is none.
    pub mici_refused: Option<String>,
    /// Harmonics of the measured points, from one per revolution.
    pub harmonics: Vec<HarmonicAnswer>,
    /// Outliers; they are included in the numbers.
    pub outliers: Vec<OutlierAnswer>,
    /// What to know of these numbers.
    pub notes: Vec<String>,
    /// Sources of definitions and methods.
    pub sources: Vec<&'static str>,
}

/// A plane in space, axes of the file.
#[derive(Clone, Debug, Serialize)]
pub struct PlaneAnswer {
    /// Its normal.
    pub normal: [f64; 3],
    /// Its first axis: angles are measured from here ...
    pub x_axis: [f64; 3],
    /// ... towards here.
    pub y_axis: [f64; 3],
    /// Peak to valley of the points along the normal.
    pub flatness_mm: f64,
}

/// The least-squares circle.
#[derive(Clone, Debug, Serialize)]
pub struct LeastSquaresAnswer {
    /// Centre.
    pub centre_mm: Vec<f64>,
    /// Radius.
    pub radius_mm: f64,
    /// Peak to valley of the radii.
    pub ront_mm: f64,
    /// Highest peak above the circle.
    pub ronp_mm: f64,
    /// Deepest valley below it.
    pub ronv_mm: f64,
    /// Root mean square of the deviations.
    pub ronq_mm: f64,
}

/// A circle.
#[derive(Clone, Debug, Serialize)]
pub struct CircleAnswer {
    /// Centre.
    pub centre_mm: Vec<f64>,
    /// Radius.
    pub radius_mm: f64,
    /// Peak to valley of the radii about this centre.
    pub ront_mm: f64,
}

/// Two circles of one centre.
#[derive(Clone, Debug, Serialize)]
pub struct ZoneAnswer {
    /// Centre.
    pub centre_mm: Vec<f64>,
    /// Of the smaller and the larger circle.
    pub radii_mm: [f64; 2],
    /// The larger less the smaller.
    pub ront_mm: f64,
}

/// A wave.
#[derive(Clone, Debug, Serialize)]
pub struct HarmonicAnswer {
    /// A turn.
    pub waves: usize,
    /// Half of crest to trough.
    pub amplitude_um: f64,
    /// A crest is at this over `waves`.
    pub phase_deg: f64,
}

/// An outlier.
#[derive(Clone, Debug, Serialize)]
pub struct OutlierAnswer {
    /// Its line in the file.
    pub line: usize,
    /// Its position, relative to the least-squares centre.
    pub angle_deg: f64,
    /// Its distance from its neighbours, positive outwards.
    pub off_um: f64,
}

/// Harmonics that every profile should resolve; with fewer a note is given.
const FEW_WAVES: f64 = 50.0;

const SOURCES: [&str; 4] = [
    "reference circles and parameters: ISO 12181-1",
    "Gaussian filter of a closed profile: ISO 16610-21",
    "minimum zone and maximum inscribed circle: branch and bound over all centres, proven to 1e-14 of the radius, or to the rounding of the centre's distance",
    "theory: docs/theory/roundness.md",
];

/// The profile of `file` in numbers.
pub fn answer(
    file: &str,
    measured: &MeasuredProfile,
    question: &Question,
    evaluation: &RoundnessEvaluation,
) -> RoundnessAnswer {
    let plane = evaluation.plane.as_ref();
    let round = |circle: &ReferenceCircle| CircleAnswer {
        centre_mm: place(plane, &circle.centre),
        radius_mm: to_mm(circle.radius),
        ront_mm: to_mm(circle.peak_to_valley),
    };
    let zone = |zone: &Zone| ZoneAnswer {
        centre_mm: place(plane, &zone.centre),
        radii_mm: [to_mm(zone.inner), to_mm(zone.outer)],
        ront_mm: to_mm(zone.peak_to_valley()),
    };
    let as_measured = evaluation.measured.as_ref().unwrap_or(&evaluation.polar);
    RoundnessAnswer {
        file: file.to_owned(),
        format: measured.format.name(),
        points: measured.points.count(),
        unused: measured.unused.clone(),
        plane: plane.map(|plane| PlaneAnswer {
            normal: plane.normal.into(),
            x_axis: plane.x.into(),
            y_axis: plane.y.into(),
            flatness_mm: to_mm(plane.flatness),
        }),
        largest_gap_deg: to_deg(as_measured.gap.width),
        filter_upr: question.upr,
        lsci: LeastSquaresAnswer {
            centre_mm: place(plane, &evaluation.least_squares.centre),
            radius_mm: to_mm(evaluation.least_squares.radius),
            ront_mm: to_mm(evaluation.least_squares.peak_to_valley),
            ronp_mm: to_mm(evaluation.polar.highest_peak()),
            ronv_mm: to_mm(evaluation.polar.deepest_valley()),
            ronq_mm: to_mm(evaluation.polar.root_mean_square()),
        },
        mzci: evaluation.zone.as_ref().ok().map(zone),
        mzci_refused: evaluation.zone.as_ref().err().map(ToString::to_string),
        mcci: round(&evaluation.circumscribed),
        mici: evaluation.inscribed.as_ref().ok().map(round),
        mici_refused: evaluation.inscribed.as_ref().err().map(ToString::to_string),
        harmonics: evaluation
            .harmonics
            .iter()
            .map(|wave| HarmonicAnswer {
                waves: wave.waves,
                amplitude_um: to_um(wave.amplitude),
                phase_deg: to_deg(wave.phase),
            })
            .collect(),
        outliers: evaluation
            .outliers
            .iter()
            .map(|(index, off)| OutlierAnswer {
                line: measured.lines[*index],
                angle_deg: to_deg(as_measured.angles[*index]),
                off_um: to_um(off),
            })
            .collect(),
        notes: notes(measured, question, evaluation),
        sources: SOURCES.to_vec(),
    }
}

/// A point of the profile in the axes of the file, mm.
fn place(plane: Option<&Plane>, at: &Point2<f64>) -> Vec<f64> {
    match plane {
        Some(plane) => to_mm(plane.at(at)).iter().copied().collect(),
        None => vec![to_mm(at.x), to_mm(at.y)],
    }
}

/// What to know of the numbers.
fn notes(measured: &MeasuredProfile, question: &Question, evaluation: &RoundnessEvaluation) -> Vec<String> {
    let as_measured = evaluation.measured.as_ref().unwrap_or(&evaluation.polar);
    let gap_deg = to_deg(as_measured.gap.width);
    let waves = as_measured.most_waves();
    let mut notes = Vec::new();
    if gap_deg >= 90.0 {
        notes.push(format!(
            "the points leave {gap_deg:.1} deg open: the shorter an arc, the larger the uncertainty of its centre and radius"
        ));
    } else if waves < FEW_WAVES {
        notes.push(format!(
            "{} points, at most {gap_deg:.2} deg apart, resolve up to {waves} undulations per revolution; finer ones \
             appear as coarser ones (aliasing)",
            measured.points.count()
        ));
    }
    if evaluation.harmonics.len() < question.harmonics && gap_deg < 90.0 {
        notes.push(format!(
            "harmonics above {} per revolution cannot be determined from these points",
            evaluation.harmonics.len()
        ));
    }
    if !evaluation.outliers.is_empty() {
        notes.push(format!(
            "{} points differ from their neighbours by more than twelve times the usual difference, perhaps by dirt; they are included",
            evaluation.outliers.len()
        ));
    }
    if question.upr.is_none() {
        notes.push("no filter was used: the numbers include all undulations and noise".to_owned());
    }
    notes
}

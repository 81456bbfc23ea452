//! What was found of a profile, in numbers.
//!
//! `lsci, mzci, mcci, mici` with `centre_mm`, `radius_mm` or `radii_mm`, and `ront_mm` are a public contract. A centre has
//! two coordinates where the points had two, and three, in the axes of the file, where they had three.

use armill_core::nalgebra::Point2;
use armill_core::roundness::{Plane, ReferenceCircle, Zone};
use armill_formats::measurement::profile::MeasuredProfile;
use serde::Serialize;

use super::{Judged, Question};

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
    /// Cut-off of the Gaussian filter, waves a turn; none where nothing was filtered.
    pub filter_upr: Option<u32>,
    /// Least-squares circle.
    pub lsci: LeastSquaresAnswer,
    /// Minimum zone circles; none where they could not be told.
    pub mzci: Option<ZoneAnswer>,
    /// Why there are none.
    pub mzci_refused: Option<String>,
    /// Minimum circumscribed circle.
    pub mcci: CircleAnswer,
    /// Maximum inscribed circle; none for an arc.
    pub mici: Option<CircleAnswer>,
    /// Why there is none.
    pub mici_refused: Option<String>,
    /// Waves of the points as they were measured, from one a turn.
    pub harmonics: Vec<HarmonicAnswer>,
    /// Points that stand out of their neighbours; none is left out of the numbers.
    pub outliers: Vec<OutlierAnswer>,
    /// What to know of these numbers.
    pub notes: Vec<String>,
    /// Where definitions and methods come from.
    pub sources: Vec<&'static str>,
}

/// A plane in space, axes of the file.
#[derive(Clone, Debug, Serialize)]
pub struct PlaneAnswer {
    /// Its normal.
    pub normal: [f64; 3],
    /// Its first axis: angles are told from here ...
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
    /// A crest lies at this over `waves`.
    pub phase_deg: f64,
}

/// A point that stands out.
#[derive(Clone, Debug, Serialize)]
pub struct OutlierAnswer {
    /// Its line in the file.
    pub line: usize,
    /// Where it is, about the least-squares centre.
    pub angle_deg: f64,
    /// How far it is off its neighbours, outwards positive.
    pub off_um: f64,
}

/// Waves that every profile should tell; with fewer a note says so.
const FEW_WAVES: f64 = 50.0;

const SOURCES: [&str; 4] = [
    "reference circles and parameters: ISO 12181-1",
    "Gaussian filter of a closed profile: ISO 16610-21",
    "minimum zone and maximum inscribed circle: branch and bound over all centres, proven to 1e-14 of the radius, or to the rounding of the centre's distance",
    "theory: docs/theory/roundness.md",
];

/// The profile of `file` in numbers.
pub fn answer(file: &str, measured: &MeasuredProfile, question: &Question, judged: &Judged) -> RoundnessAnswer {
    let plane = judged.plane.as_ref();
    let round = |circle: &ReferenceCircle| CircleAnswer {
        centre_mm: place(plane, &circle.centre),
        radius_mm: circle.radius * 1e3,
        ront_mm: circle.peak_to_valley * 1e3,
    };
    let zone = |zone: &Zone| ZoneAnswer {
        centre_mm: place(plane, &zone.centre),
        radii_mm: [zone.inner * 1e3, zone.outer * 1e3],
        ront_mm: zone.peak_to_valley() * 1e3,
    };
    let as_measured = judged.measured.as_ref().unwrap_or(&judged.polar);
    RoundnessAnswer {
        file: file.to_owned(),
        format: measured.format.name(),
        points: measured.points.count(),
        unused: measured.unused.clone(),
        plane: plane.map(|plane| PlaneAnswer {
            normal: plane.normal.into(),
            x_axis: plane.x.into(),
            y_axis: plane.y.into(),
            flatness_mm: plane.flatness * 1e3,
        }),
        largest_gap_deg: as_measured.gap.width.to_degrees(),
        filter_upr: question.upr,
        lsci: LeastSquaresAnswer {
            centre_mm: place(plane, &judged.least_squares.centre),
            radius_mm: judged.least_squares.radius * 1e3,
            ront_mm: judged.least_squares.peak_to_valley * 1e3,
            ronp_mm: judged.polar.highest_peak() * 1e3,
            ronv_mm: judged.polar.deepest_valley() * 1e3,
            ronq_mm: judged.polar.root_mean_square() * 1e3,
        },
        mzci: judged.zone.as_ref().ok().map(zone),
        mzci_refused: judged.zone.as_ref().err().map(ToString::to_string),
        mcci: round(&judged.circumscribed),
        mici: judged.inscribed.as_ref().ok().map(round),
        mici_refused: judged.inscribed.as_ref().err().map(ToString::to_string),
        harmonics: judged
            .harmonics
            .iter()
            .map(|wave| HarmonicAnswer {
                waves: wave.waves,
                amplitude_um: wave.amplitude * 1e6,
                phase_deg: wave.phase.to_degrees(),
            })
            .collect(),
        outliers: judged
            .outliers
            .iter()
            .map(|(index, off)| OutlierAnswer {
                line: measured.lines[*index],
                angle_deg: as_measured.angles[*index].to_degrees(),
                off_um: off * 1e6,
            })
            .collect(),
        notes: notes(measured, question, judged),
        sources: SOURCES.to_vec(),
    }
}

/// A point of the profile in the axes of the file, mm.
fn place(plane: Option<&Plane>, at: &Point2<f64>) -> Vec<f64> {
    match plane {
        Some(plane) => (plane.at(at) * 1e3).iter().copied().collect(),
        None => vec![at.x * 1e3, at.y * 1e3],
    }
}

/// What to know of the numbers.
fn notes(measured: &MeasuredProfile, question: &Question, judged: &Judged) -> Vec<String> {
    let as_measured = judged.measured.as_ref().unwrap_or(&judged.polar);
    let gap_deg = as_measured.gap.width.to_degrees();
    let waves = as_measured.most_waves();
    let mut notes = Vec::new();
    if gap_deg >= 90.0 {
        notes.push(format!(
            "the points leave {gap_deg:.1} deg open: centre and radius of an arc are known the less the shorter it is"
        ));
    } else if waves < FEW_WAVES {
        notes.push(format!(
            "{} points, {gap_deg:.2} deg apart at most, tell waves up to {waves} a turn; finer ones, if there are any, \
             look like coarser ones",
            measured.points.count()
        ));
    }
    if judged.harmonics.len() < question.harmonics && gap_deg < 90.0 {
        notes.push(format!(
            "harmonics above {} a turn cannot be told from these points",
            judged.harmonics.len()
        ));
    }
    if !judged.outliers.is_empty() {
        notes.push(format!(
            "{} of the points stand out of their neighbours by twelve times what others do, perhaps dirt; none was left out",
            judged.outliers.len()
        ));
    }
    if question.upr.is_none() {
        notes.push(
            "no filter was used: the numbers hold all waves that the points show, and noise".to_owned(),
        );
    }
    notes
}

//! The measured part in the answer: measured and predicted deviations of the same points, and how much of the measured ones is explained.

use std::collections::BTreeMap;

use armill_core::form::wavelengths::{DeviationPairs, PredictionAgreement, agreement_by_wavelength};
use armill_core::frame::Isometry;
use armill_core::nalgebra::{Point3, Vector3};
use armill_core::robot::Robot;
use armill_core::units::{to_deg, to_mm, to_um};
use schemars::JsonSchema;
use serde::Serialize;

use super::features::points_of;
use super::run::MachinedPart;
use super::scan::ScanComparison;
use super::scan_contributions::ScanContributionAnswer;
use super::setting::{Align, MachinedSetting};
use crate::analysis::path::PathAnalysis;
use crate::number::without_rounding;

/// Measured points of a part, and the prediction there.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ScanAnswer {
    /// Its file.
    pub file: String,
    /// `none`, `best_fit` or `datums`.
    pub align: &'static str,
    /// Points that are compared.
    pub points: usize,
    /// Points farther from the nominal part than the limit.
    pub too_far: usize,
    /// Points near the nominal part where nothing is predicted.
    pub not_predicted: usize,
    /// What the alignment takes from the measured points.
    pub removed: RemovedMotion,
    /// What the same alignment takes from the prediction.
    pub removed_from_prediction: RemovedMotion,
    /// Measured deviations.
    pub measured: DeviationStatistics,
    /// Predicted deviations at the same points.
    pub predicted: DeviationStatistics,
    /// Measured less predicted.
    pub difference: DeviationStatistics,
    /// How much of the measured deviation is explained.
    pub agreement: AgreementAnswer,
    /// Standard uncertainty of the slope; none with too small a part.
    // unit: dimensionless
    pub slope_u: Option<f64>,
    /// Wavelengths that separate the bands.
    pub wavelengths_mm: [f64; 2],
    /// The same of wavelengths above the first.
    pub long: AgreementAnswer,
    /// Between both.
    pub middle: AgreementAnswer,
    /// Below the second.
    pub short: AgreementAnswer,
    /// What joints, springs and motion contribute to the prediction, after the same alignment.
    pub contributions: Vec<ScanContributionAnswer>,
    /// Each feature of the path with points.
    pub features: Vec<ScanFeatureAnswer>,
    /// What was assumed.
    pub notes: Vec<String>,
}

/// A motion that an alignment removes.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct RemovedMotion {
    /// Displacement at the mean of the points, frame of the program.
    pub translation_mm: [f64; 3],
    /// Rotation vector.
    pub rotation_deg: [f64; 3],
}

/// Deviations of a set of points.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct DeviationStatistics {
    /// Mean.
    pub mean_um: f64,
    /// Root mean square.
    pub rms_um: f64,
    /// Least.
    pub least_um: f64,
    /// Largest.
    pub largest_um: f64,
    /// Fraction within the tolerance by size.
    pub fraction_within: f64,
}

/// How far a prediction agrees with a measurement.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct AgreementAnswer {
    /// Standard deviation of the measured deviations.
    pub measured_sd_um: f64,
    /// Explained share of their variance: 1 of a perfect prediction, below 0 of one that is worse than its mean; none without variance.
    // unit: dimensionless
    pub explained: Option<f64>,
    /// Slope of measured over predicted.
    // unit: dimensionless
    pub slope: Option<f64>,
    /// Correlation.
    // unit: dimensionless
    pub correlation: Option<f64>,
}

/// A feature, measured and predicted.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ScanFeatureAnswer {
    /// Its name.
    pub name: String,
    /// Measured points on it.
    pub points: usize,
    /// Measured deviations.
    pub measured: DeviationStatistics,
    /// Predicted deviations.
    pub predicted: DeviationStatistics,
    /// Measured less predicted.
    pub difference: DeviationStatistics,
    /// Explained share of the variance of the measured deviations on it.
    // unit: dimensionless
    pub explained: Option<f64>,
}

impl ScanAnswer {
    /// That of a part; none if the study names no scan.
    pub fn of(robot: &Robot, analysis: &PathAnalysis, part: &MachinedPart) -> Option<ScanAnswer> {
        let (machined, measured) = (analysis.machined_part.as_deref()?, part.scan.as_ref()?);
        let (scan, found) = (machined.scan.as_ref()?, &measured.comparison);
        let names = analysis.setting.contributor_names(robot);
        let contributions = measured.contributions.answer(&names, found);
        let tolerance = analysis.setting.tolerance;
        let pairs = DeviationPairs {
            points: &found.points,
            measured: &found.measured,
            predicted: &found.predicted,
        };
        let by_wavelength = agreement_by_wavelength(&pairs, scan.wavelengths);
        let mut notes = scan.notes.clone();
        let none = AgreementAnswer {
            measured_sd_um: 0.0,
            explained: None,
            slope: None,
            correlation: None,
        };
        let [overall, long, middle, short] = match &by_wavelength {
            Ok(all) => [all.overall, all.long, all.middle, all.short].map(|found| agreement(&found)),
            Err(error) => {
                notes.push(format!("no agreement by wavelength: {error}"));
                [none; 4]
            }
        };
        let all: Vec<usize> = (0..found.points.len()).collect();
        let [measured, predicted, difference] = statistics(found, &all, tolerance);
        Some(ScanAnswer {
            file: scan.file.clone(),
            align: match scan.align {
                Align::None => "none",
                Align::BestFit => "best_fit",
                Align::Datums(_) => "datums",
            },
            points: found.points.len(),
            too_far: found.too_far,
            not_predicted: found.not_predicted,
            removed: removed(&found.motion, found),
            removed_from_prediction: removed(&found.predicted_motion, found),
            measured,
            predicted,
            difference,
            agreement: overall,
            slope_u: by_wavelength.ok().and_then(|all| all.slope_uncertainty),
            wavelengths_mm: scan.wavelengths.map(|m| without_rounding(to_mm(m))),
            long,
            middle,
            short,
            contributions,
            features: features(analysis, machined, part, found),
            notes,
        })
    }
}

fn agreement(found: &PredictionAgreement) -> AgreementAnswer {
    AgreementAnswer {
        measured_sd_um: to_um(found.variance.sqrt()),
        explained: found.explained,
        slope: found.slope,
        correlation: found.correlation,
    }
}

/// What a motion does to the part, at the mean of its points.
fn removed(motion: &Isometry, found: &ScanComparison) -> RemovedMotion {
    let sum: Vector3<f64> = found.points.iter().map(|point| point.coords).sum();
    let centre = Point3::from(sum / found.points.len().max(1) as f64);
    RemovedMotion {
        translation_mm: (motion * centre - centre).map(to_mm).into(),
        rotation_deg: motion.rotation.scaled_axis().map(to_deg).into(),
    }
}

/// Of measured, predicted, and measured less predicted deviations at these points.
fn statistics(found: &ScanComparison, points: &[usize], tolerance: f64) -> [DeviationStatistics; 3] {
    let of = |value: &dyn Fn(usize) -> f64| {
        let count = points.len().max(1) as f64;
        let values = || points.iter().map(|point| value(*point));
        DeviationStatistics {
            mean_um: to_um(values().sum::<f64>() / count),
            rms_um: to_um((values().map(|m| m * m).sum::<f64>() / count).sqrt()),
            least_um: to_um(values().fold(f64::INFINITY, f64::min)),
            largest_um: to_um(values().fold(f64::NEG_INFINITY, f64::max)),
            fraction_within: values().filter(|m| m.abs() <= tolerance).count() as f64 / count,
        }
    };
    [
        of(&|point| found.measured[point]),
        of(&|point| found.predicted[point]),
        of(&|point| found.measured[point] - found.predicted[point]),
    ]
}

/// Cells of the grid that finds the points of a feature, in cells of the part.
const CELLS: f64 = 2.0;
/// Least cosine of the normals of a point and of the feature there.
const SAME_FACE: f64 = 0.7;

/// Every feature of the path with measured points.
fn features(
    analysis: &PathAnalysis,
    machined: &MachinedSetting,
    part: &MachinedPart,
    found: &ScanComparison,
) -> Vec<ScanFeatureAnswer> {
    let edge = CELLS * machined.cell;
    let cell = |at: &Point3<f64>| [at.x, at.y, at.z].map(|m| (m / edge).floor() as i64);
    let mut all = Vec::new();
    for feature in &analysis.features {
        let mut normals: BTreeMap<[i64; 3], Vector3<f64>> = BTreeMap::new();
        for point in points_of(machined, part, feature) {
            *normals.entry(cell(&point.position)).or_default() += point.normal.into_inner();
        }
        let is_on = |index: &usize| {
            let normal = normals.get(&cell(&found.points[*index]));
            normal.is_some_and(|normal| normal.dot(&found.normals[*index]) > SAME_FACE * normal.norm())
        };
        let points: Vec<usize> = (0..found.points.len()).filter(is_on).collect();
        if points.is_empty() {
            continue;
        }
        let [measured, predicted, difference] = statistics(found, &points, analysis.setting.tolerance);
        let variance = |of: &DeviationStatistics| of.rms_um.powi(2) - of.mean_um.powi(2);
        let of_measured = variance(&measured);
        all.push(ScanFeatureAnswer {
            name: feature.name.clone(),
            points: points.len(),
            explained: (of_measured > 0.0).then(|| 1.0 - variance(&difference) / of_measured),
            measured,
            predicted,
            difference,
        });
    }
    all
}

//! The deviations of the features that a study marks in its program.
//!
//! | kind | what is reported |
//! |---|---|
//! | `circle` | radius as programmed and its change, shift of the centre, roundness |
//! | `line` | straightness across and along the tool, shift without the component along the line |
//! | `plane` | flatness, shift along the tool |
//! | `hole` | shift |
//!
//! Form errors are peak to valley; shifts are in the axes of the program.

use armill_core::nalgebra::Vector3;
use armill_core::path::{DeviatedPoint, FeatureErrors, feature_errors};
use armill_core::units::{to_mm, to_um};
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::path::run::PathResult;
use crate::analysis::path::{FeatureTable, PathAnalysis};
use crate::number::without_rounding;

/// The deviations of a feature under one load case.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct FeatureAnswer {
    /// Its name.
    pub name: String,
    /// `circle`, `line`, `plane` or `hole`.
    pub kind: &'static str,
    /// The case, from 1.
    pub case: usize,
    /// Points that made it.
    pub points: usize,
    /// Circle: radius of the tool's path as programmed.
    pub radius_mm: Option<f64>,
    /// Circle: increase of the radius.
    pub radius_change_um: Option<f64>,
    /// Shift of its centre, axis or middle; path axes. Of a line without the component along it, of a plane along
    /// the tool.
    pub shift_um: Option<[f64; 3]>,
    /// Circle: peak to valley about the least-squares circle.
    pub roundness_um: Option<f64>,
    /// Line: peak to valley across the tool.
    pub straightness_across_um: Option<f64>,
    /// Line: peak to valley along the tool.
    pub straightness_axial_um: Option<f64>,
    /// Plane: peak to valley.
    pub flatness_um: Option<f64>,
    /// Why there is no result.
    pub missing: Option<&'static str>,
}

/// Every feature under every load case, feature by feature, of the points whose lines it names.
pub fn features(analysis: &PathAnalysis, found: &PathResult) -> Vec<FeatureAnswer> {
    let of = |feature: &FeatureTable| {
        let [first, last] = feature.lines;
        let points = &analysis.track.path.points;
        let within = |i: &usize| (first..=last).contains(&points[*i].line);
        let within: Vec<usize> = (0..points.len()).filter(within).collect();
        let cases = 0..found.along.answers.case_count;
        cases
            .map(|case| of_case(feature, case, &within, analysis, found))
            .collect::<Vec<_>>()
    };
    analysis.features.iter().flat_map(of).collect()
}

/// One feature under one case. Without a result, and with the reason, if a point of it is not reached or its points
/// do not define such a feature.
fn of_case(
    feature: &FeatureTable,
    case: usize,
    points: &[usize],
    analysis: &PathAnalysis,
    found: &PathResult,
) -> FeatureAnswer {
    let mut given = FeatureAnswer {
        name: feature.name.clone(),
        kind: feature.kind.word(),
        case: case + 1,
        points: points.len(),
        radius_mm: None,
        radius_change_um: None,
        shift_um: None,
        roundness_um: None,
        straightness_across_um: None,
        straightness_axial_um: None,
        flatness_um: None,
        missing: None,
    };
    let answers = &found.along.answers;
    if points.iter().any(|i| answers.points[*i].is_err()) {
        given.missing = Some("some of its points are out of reach");
        return given;
    }
    let placing = &analysis.track.placing;
    let path_from_base = placing.base_from_path.inverse();
    let deviated = |i: &usize| {
        let point = &analysis.track.path.points[*i];
        DeviatedPoint {
            at: point.at,
            axis: path_from_base.rotation * placing.spindle(point),
            by: path_from_base * answers.deviations_at(*i)[case],
        }
    };
    let deviated: Vec<DeviatedPoint> = points.iter().map(deviated).collect();
    let um = |v: Vector3<f64>| Some(v.map(to_um).into());
    match feature_errors(feature.kind.kind(), &deviated) {
        Some(FeatureErrors::Circle {
            radius,
            radius_change,
            centre_shift,
            roundness,
        }) => {
            given.radius_mm = Some(without_rounding(to_mm(radius)));
            given.radius_change_um = Some(to_um(radius_change));
            given.shift_um = um(centre_shift);
            given.roundness_um = Some(to_um(roundness));
        }
        Some(FeatureErrors::Line {
            straightness_across,
            straightness_normal: straightness_axial,
            offset,
        }) => {
            given.straightness_across_um = Some(to_um(straightness_across));
            given.straightness_axial_um = Some(to_um(straightness_axial));
            given.shift_um = um(offset);
        }
        Some(FeatureErrors::Plane { flatness, offset }) => {
            given.flatness_um = Some(to_um(flatness));
            let normal = deviated.first().map_or_else(Vector3::z, |p| p.axis.into_inner());
            given.shift_um = um(normal * offset);
        }
        Some(FeatureErrors::Hole { shift }) => given.shift_um = um(shift),
        None => given.missing = Some("its points do not define such a feature"),
    }
    given
}

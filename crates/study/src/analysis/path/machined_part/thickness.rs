//! Thickness of walls between two faces of the part, nominal and as it comes out.
//!
//! Two-point sizes (ISO 14405-1, LP) between the faces of two features that face away from each other: material is between them.
//! The uncertainty of the thickness is at most the sum of those of both faces: how far their errors have the same cause is not known.

use armill_core::form::FormError;
use armill_core::form::thickness::{Thickness, thickness};
use armill_core::machined::SurfaceDeviation;
use armill_core::nalgebra::{Point3, Vector3};
use armill_core::units::{to_mm, to_um};
use schemars::JsonSchema;
use serde::Serialize;

use super::features::{points_of, walls};
use super::run::MachinedPart;
use super::setting::{MachinedSetting, WallSetting};
use crate::analysis::path::PathAnalysis;
use crate::analysis::path::feature::{FeatureName, FeatureTable};

/// The thickness of a wall.
#[derive(Clone, Debug, Default, Serialize, JsonSchema)]
pub struct WallThicknessAnswer {
    /// Its name.
    pub name: String,
    /// The features of its faces.
    pub between: [String; 2],
    /// Points of the first face with an opposite one.
    pub points: usize,
    /// Nominal thickness, mean.
    pub nominal_mm: Option<f64>,
    /// Least two-point size that comes out.
    pub least_mm: Option<f64>,
    /// Mean.
    pub mean_mm: Option<f64>,
    /// Largest.
    pub largest_mm: Option<f64>,
    /// Mean less the nominal thickness.
    pub change_um: Option<f64>,
    /// Standard uncertainty of the change, at most; none if it is not known.
    pub u_um: Option<f64>,
    /// Why there is no result.
    pub missing: Option<String>,
}

/// Opposite points are within so many cells of each other across the wall.
const REACH: f64 = 1.5;

/// Every wall that the study names.
pub(super) fn thicknesses(
    analysis: &PathAnalysis,
    machined: &MachinedSetting,
    part: &MachinedPart,
    u: &dyn Fn(&SurfaceDeviation) -> Option<f64>,
) -> Vec<WallThicknessAnswer> {
    let of = |wall: &WallSetting| {
        let answer = WallThicknessAnswer {
            name: wall.name.clone(),
            between: wall.between.clone(),
            ..WallThicknessAnswer::default()
        };
        let faces = wall.between.each_ref().map(|name| {
            let feature = analysis.features.iter().find(|feature| feature.name == *name);
            feature.map_or_else(Vec::new, |feature| face_of(machined, part, feature))
        });
        let faces = [0, 1].map(|face| away_from(&faces[face], &faces[1 - face]));
        let evaluated = || -> Result<WallThicknessAnswer, FormError> {
            let size = |at: fn(&SurfaceDeviation) -> Point3<f64>| -> Result<Thickness, FormError> {
                let points = faces
                    .each_ref()
                    .map(|face| face.iter().map(at).collect::<Vec<_>>());
                thickness(&points[0], &points[1], REACH * machined.cell)
            };
            let (nominal, made) = (size(|point| point.position)?, size(|point| point.on_part)?);
            let mean_u = |face: &[SurfaceDeviation]| {
                let all: Option<Vec<f64>> = face.iter().map(u).collect();
                all.map(|all| all.iter().sum::<f64>() / face.len() as f64)
            };
            Ok(WallThicknessAnswer {
                points: made.sizes.len() - made.unpaired,
                nominal_mm: Some(to_mm(nominal.mean)),
                least_mm: Some(to_mm(made.least)),
                mean_mm: Some(to_mm(made.mean)),
                largest_mm: Some(to_mm(made.largest)),
                change_um: Some(to_um(made.mean - nominal.mean)),
                u_um: mean_u(&faces[0])
                    .zip(mean_u(&faces[1]))
                    .map(|(one, other)| to_um(one + other)),
                ..answer.clone()
            })
        };
        evaluated().unwrap_or_else(|error| WallThicknessAnswer {
            missing: Some(error.to_string()),
            ..answer.clone()
        })
    };
    machined.walls.iter().map(of).collect()
}

/// The points of a plane, or of both sides of a line.
fn face_of(machined: &MachinedSetting, part: &MachinedPart, feature: &FeatureTable) -> Vec<SurfaceDeviation> {
    let points = points_of(machined, part, feature);
    match feature.kind {
        FeatureName::Line => (walls(feature, part, &points).into_iter())
            .flat_map(|(_, points)| points)
            .collect(),
        FeatureName::Plane | FeatureName::Circle | FeatureName::Hole => points,
    }
}

/// The points whose normals point away from the middle of the other face.
fn away_from(face: &[SurfaceDeviation], other: &[SurfaceDeviation]) -> Vec<SurfaceDeviation> {
    let sum: Vector3<f64> = other.iter().map(|point| point.position.coords).sum();
    let middle = Point3::from(sum / other.len().max(1) as f64);
    let is_away = |point: &&SurfaceDeviation| point.normal.dot(&(middle - point.position)) < 0.0;
    face.iter().filter(is_away).copied().collect()
}

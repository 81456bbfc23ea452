//! Stretches of a program that make a feature, as a study marks them.

use armill_core::path::{FeatureKind, PathPoint};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::input::problem_log::ProblemLog;

/// A range of lines of the program that makes a feature.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FeatureTable {
    /// Its name.
    pub name: String,
    /// Its kind.
    pub kind: FeatureName,
    /// First and last line of the program that cut it.
    pub lines: [u32; 2],
}

/// Kind of a feature.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum FeatureName {
    /// Radius, centre, roundness.
    Circle,
    /// Straightness.
    Line,
    /// Flatness.
    Plane,
    /// Position.
    Hole,
}

impl FeatureName {
    /// Its name in the study.
    pub(crate) fn word(self) -> &'static str {
        match self {
            FeatureName::Circle => "circle",
            FeatureName::Line => "line",
            FeatureName::Plane => "plane",
            FeatureName::Hole => "hole",
        }
    }

    /// Its kind in the core.
    pub(crate) fn kind(self) -> FeatureKind {
        match self {
            FeatureName::Circle => FeatureKind::Circle,
            FeatureName::Line => FeatureKind::Line,
            FeatureName::Plane => FeatureKind::Plane,
            FeatureName::Hole => FeatureKind::Hole,
        }
    }
}

/// Whether every feature has points of the program; reports those that have none.
///
/// Lines are those of the program, counted from 1, both ends included.
pub fn features_have_points(
    log: &mut ProblemLog<'_>,
    features: &[FeatureTable],
    points: &[PathPoint],
) -> bool {
    let mut all = true;
    for (index, feature) in features.iter().enumerate() {
        let [first, last] = feature.lines;
        if points.iter().any(|point| (first..=last).contains(&point.line)) {
            continue;
        }
        all = false;
        let lines = || points.iter().map(|point| point.line);
        let (low, high) = (lines().min().unwrap_or(0), lines().max().unwrap_or(0));
        let message = format!("`{}`: lines {first} to {last} contain no cut", feature.name);
        let hint = format!("the cuts of the program are in lines {low} to {high}");
        log.problem(&format!("program.feature[{index}].lines"), message, &hint);
    }
    all
}

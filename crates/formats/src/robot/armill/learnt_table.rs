//! The table `[learnt]` of a robot file, as written.

use schemars::JsonSchema;
use serde::Deserialize;

/// The learnt residual, as written.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LearntTable {
    /// File of the residuals, in the folder of the robot file.
    pub file: String,
    /// Its checksum.
    pub sha256: String,
    /// Axes of the components of the residual.
    pub axes: LearntAxesWord,
    /// Length scale of each joint: deg, of prismatic joints mm.
    #[schemars(length(max = 64))]
    pub length_scales_deg: Vec<f64>,
    /// Scatter between neighbouring poses, relative to the standard deviation over all postures.
    #[schemars(range(min = 1e-3, max = 1e4))]
    // unit: 1
    pub scatter: f64,
    /// Key of the source.
    pub source: String,
}

/// Axes of the components of a learnt residual.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LearntAxesWord {
    /// Of the base.
    Base,
    /// Of the base rotated with the first joint.
    FirstJoint,
}

//! The table `[geometry_covariance]` of a robot file, as written.

use schemars::JsonSchema;
use serde::Deserialize;

/// The uncertainty of the chain, as written.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GeometryCovarianceTable {
    /// The small motions, each `JOINT along AXIS` or `JOINT about AXIS`.
    #[schemars(length(max = 400))]
    pub of: Vec<String>,
    /// Their covariance, one row and column each: mm along an axis, deg about it.
    #[schemars(length(max = 400))]
    // unit: mm^2, mm deg, deg^2
    pub matrix_mm_deg: Vec<Vec<f64>>,
    /// Key of the source.
    pub source: String,
}

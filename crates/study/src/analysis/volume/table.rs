//! `box` of an analysis.

use schemars::JsonSchema;
use serde::Deserialize;

/// A box of points along the axes of the reference frame of the study.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxTable {
    /// Centre; that of the plane if left out.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub centre_mm: Option<[f64; 3]>,
    /// Half the sides along x, y, z.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub half_size_mm: [f64; 3],
    /// Pitch.
    #[schemars(range(max = 1e6))]
    pub step_mm: f64,
}

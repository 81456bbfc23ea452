//! `circle`, `line` and `rectangle` of an analysis.

use schemars::JsonSchema;
use serde::Deserialize;

/// A full circle on the plane, starting at its +y' and turning towards z'.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CircleTable {
    /// Centre (y', z'); the plane's centre if left out.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub centre_mm: Option<[f64; 2]>,
    /// Radius.
    #[schemars(range(max = 1e6))]
    pub radius_mm: f64,
}

/// A straight line on the plane.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LineTable {
    /// Start (y', z').
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub from_mm: [f64; 2],
    /// End (y', z').
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub to_mm: [f64; 2],
}

/// A rectangle on the plane, one turn.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RectangleTable {
    /// Centre (y', z'); the plane's centre if left out.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub centre_mm: Option<[f64; 2]>,
    /// Sides along y' and z'.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub size_mm: [f64; 2],
}

//! `holes` of an analysis.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::analysis::path::drill::DrillTable;

/// A list of holes, here or in a file.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HolesTable {
    /// Position of the tip at the end of each: x, y, z in the part frame (z = outward normal of the plane, origin at
    /// its centre), moved by `part_from_holes_mm_deg`.
    #[schemars(length(max = 100_000), inner(inner(range(min = -1e6, max = 1e6))))]
    pub at_mm: Option<Vec<[f64; 3]>>,
    /// Directions out of the part, same axes, of any length: one a hole or one for all; the normal of the plane if left
    /// out.
    #[schemars(length(max = 100_000), inner(inner(range(min = -1e6, max = 1e6))))]
    // unit: directions, of any length
    pub normals: Option<Vec<[f64; 3]>>,
    /// A CSV of them in place of `at_mm`, relative to the study: columns x_mm, y_mm, z_mm, and i, j, k out of the part.
    pub file: Option<String>,
    /// Their origin in the part frame: x, y, z in mm, then rotations about the fixed axes x, y, z in degrees.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub part_from_holes_mm_deg: Option<[f64; 6]>,
    /// A drill: its thrust and torque are the load.
    pub drill: Option<DrillTable>,
}

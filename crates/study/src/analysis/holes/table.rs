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
    /// Length of a hole from the surface to its end, for robot programs.
    #[schemars(range(min = 0.0, max = 1e4))]
    pub depth_mm: Option<f64>,
    /// Depth of each peck in robot programs; one stroke if left out.
    #[schemars(range(min = 0.01, max = 1e4))]
    pub peck_mm: Option<f64>,
    /// Distance from the surface at which the drilling feed begins and ends, for robot programs; 2 if left out.
    #[schemars(range(min = 0.0, max = 1e4))]
    pub clearance_mm: Option<f64>,
    /// Dwell at the end of a hole in robot programs.
    #[schemars(range(min = 0.0, max = 300.0))]
    pub dwell_s: Option<f64>,
    /// Order of the holes in robot programs: `shortest` (default) joint travel, or as `given`.
    pub order: Option<HoleOrder>,
}

/// Order of the holes in a robot program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum HoleOrder {
    /// The order with the shortest joint travel that was found.
    #[default]
    Shortest,
    /// That of the study or its files.
    Given,
}

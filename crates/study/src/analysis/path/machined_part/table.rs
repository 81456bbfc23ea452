//! `machined_part` of a path: the part that its tool leaves of the stock.

use armill_formats::robot::shape_tables::{BoxTable, RoundTable};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::input::cell::tables::{MeshUnitName, ShapeKeys};

/// The part that comes out, and what it is compared with.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MachinedPartTable {
    /// Distance of the dexels; a fortieth of the smallest cutter if left out, more where that is too many.
    #[schemars(range(min = 1e-3, max = 1e3))]
    pub cell_mm: Option<f64>,
    /// Directions of the dexels: all if left out. `z`: for three axes, faster; walls are then not measured.
    pub dexels: Option<DexelsName>,
    /// The nominal part: what the program leaves (default), or the mesh of `[part]`.
    pub nominal: Option<NominalName>,
    /// The stock, in the frame of the program; that of the cut if left out.
    pub stock: Option<PartStockTable>,
    /// The tool; that of the cut or drill if left out. Sizes in the program take precedence.
    pub tool: Option<PartToolTable>,
    /// Walls whose thickness is evaluated.
    #[serde(default)]
    pub walls: Vec<WallTable>,
    /// Measured points of the real part, to compare with the prediction.
    pub scan: Option<ScanTable>,
}

/// A wall between two features of the program.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WallTable {
    /// Its name.
    pub name: String,
    /// Names of two features of the program: lines or planes that face away from each other.
    pub between: [String; 2],
}

/// Measured points of the real part.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScanTable {
    /// Its file, relative to the study: mesh, points or CMM results.
    pub file: String,
    /// Unit of its lengths, where the file does not give it; mm if left out.
    pub unit: Option<MeshUnitName>,
    /// Frame of its coordinates: `program`, or `part` for the frame of the mesh of `[part]`. The frame of the nominal part if left out.
    pub frame: Option<NominalName>,
    /// How the points are moved onto the nominal part: `none` (they are in its frame), `best_fit` (default), `datums`.
    pub align: Option<AlignName>,
    /// Datum points for `align = "datums"`.
    pub datums: Option<DatumsTable>,
    /// Radius of the probe, where the points are its centres.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub probe_radius_mm: Option<f64>,
    /// Points farther from the nominal part are left out; 2 if not given.
    #[schemars(range(min = 1e-3, max = 1e3))]
    pub farthest_mm: Option<f64>,
    /// Wavelengths that separate long, middle and short ones; 20 and 2 if left out.
    #[schemars(inner(range(min = 1e-3, max = 1e4)))]
    pub wavelengths_mm: Option<[f64; 2]>,
}

/// How measured points are moved onto the nominal part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AlignName {
    /// Not at all.
    None,
    /// By least squares.
    BestFit,
    /// By datum points: three of a primary, two of a secondary, one of a tertiary plane.
    Datums,
}

/// Nominal positions of datum points, in the frame of the scan.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DatumsTable {
    /// Three or more on the primary plane.
    #[schemars(length(min = 3, max = 1000), inner(inner(range(min = -1e6, max = 1e6))))]
    pub primary_mm: Vec<[f64; 3]>,
    /// Two or more on the secondary plane.
    #[schemars(length(min = 2, max = 1000), inner(inner(range(min = -1e6, max = 1e6))))]
    pub secondary_mm: Vec<[f64; 3]>,
    /// One on the tertiary plane.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub tertiary_mm: [f64; 3],
    /// Measured points within this distance of a datum point are averaged; 1 if left out.
    #[schemars(range(min = 1e-3, max = 1e3))]
    pub radius_mm: Option<f64>,
}

/// Directions of dexels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum DexelsName {
    /// Along x, y and z of the program.
    All,
    /// Along its z alone.
    Z,
}

/// What a part is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum NominalName {
    /// What the tool leaves where it is programmed.
    Program,
    /// The mesh of `[part]`.
    Part,
}

/// What a part is cut from, in the frame of the program.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PartStockTable {
    /// A box along the axes, between two opposite corners.
    pub box_mm: Option<BoxTable>,
    /// A cylinder along z with flat ends.
    pub cylinder_mm: Option<RoundTable>,
    /// A closed mesh: STL, OBJ, PLY, 3MF or DAE file relative to the study.
    pub mesh: Option<String>,
    /// Unit of the mesh, where its file does not give it.
    pub mesh_unit: Option<MeshUnitName>,
}

impl PartStockTable {
    /// Its keys that give the shape.
    pub fn shape(&self) -> ShapeKeys<'_> {
        ShapeKeys {
            box_mm: self.box_mm.as_ref(),
            cylinder_mm: self.cylinder_mm.as_ref(),
            capsule_mm: None,
            mesh: self.mesh.as_deref(),
            mesh_unit: self.mesh_unit,
        }
    }
}

/// The shape of a tool that cuts a part.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PartToolTable {
    /// Its diameter; of a tapered tool at its tip.
    #[schemars(range(min = 0.01, max = 1e3))]
    pub diameter_mm: Option<f64>,
    /// Radius of its corner: 0 or left out is flat, half the diameter a ball.
    #[schemars(range(min = 0.0, max = 1e3))]
    pub corner_radius_mm: Option<f64>,
    /// Angle of its flank from its axis; a cylinder if left out.
    #[schemars(range(min = 0.0, max = 80.0))]
    pub taper_deg: Option<f64>,
    /// Full angle of the point of a drill, in place of corner and taper.
    #[schemars(range(min = 30.0, max = 180.0))]
    pub point_deg: Option<f64>,
    /// Length that cuts; all of it if left out.
    #[schemars(range(min = 0.01, max = 1e4))]
    pub flute_length_mm: Option<f64>,
    /// Diameter above the flutes; that of the flutes at their end if left out.
    #[schemars(range(min = 0.01, max = 1e3))]
    pub shank_diameter_mm: Option<f64>,
}

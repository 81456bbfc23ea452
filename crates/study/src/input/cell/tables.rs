//! Tables of bodies: `[[obstacle]]`, `[pedestal]`, `[floor]`, `[[tool.body]]`, `[part]`.
//!
//! Each repeats the five keys of a shape: a table that refuses unknown keys cannot take some of them from another one (`flatten` of serde).

use armill_formats::robot::shape_tables::{BoxTable, RoundTable};
use schemars::JsonSchema;
use serde::Deserialize;

/// A body that stands in the cell.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ObstacleTable {
    /// Its name in results.
    #[schemars(length(min = 1, max = 60))]
    pub name: String,
    /// A box along the axes, between two opposite corners.
    pub box_mm: Option<BoxTable>,
    /// A cylinder with flat ends.
    pub cylinder_mm: Option<RoundTable>,
    /// A cylinder with half balls as ends.
    pub capsule_mm: Option<RoundTable>,
    /// A mesh: STL, OBJ, PLY, 3MF or DAE file relative to the study.
    pub mesh: Option<String>,
    /// Unit of the mesh, where its file does not give it.
    pub mesh_unit: Option<MeshUnitName>,
    /// Its position: reference frame of the study to the frame of its coordinates, x, y, z in mm, then rotations about the fixed
    /// axes x, y, z in degrees. With a part in the hand of the robot, relative to its `base_link`.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub base_from_obstacle_mm_deg: Option<[f64; 6]>,
    /// The joint in front of the arm that moves it, such as that of a rail, by name or number; it stands still if left out. Its position is
    /// that where these joints are at 0.
    #[schemars(length(min = 1, max = 60))]
    pub on: Option<String>,
}

/// What the robot stands on: fixed under its base, and moved with it by a rail.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PedestalTable {
    /// A box along the axes, between two opposite corners.
    pub box_mm: Option<BoxTable>,
    /// A cylinder with flat ends.
    pub cylinder_mm: Option<RoundTable>,
    /// A cylinder with half balls as ends.
    pub capsule_mm: Option<RoundTable>,
    /// A mesh: STL, OBJ, PLY, 3MF or DAE file relative to the study.
    pub mesh: Option<String>,
    /// Unit of the mesh, where its file does not give it.
    pub mesh_unit: Option<MeshUnitName>,
    /// Its position: reference frame of the study to the frame of its coordinates, x, y, z in mm, then rotations about the fixed
    /// axes x, y, z in degrees; of a robot on a rail where the rail is at 0. With a part in the hand of the
    /// robot, relative to its `base_link`.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub base_from_pedestal_mm_deg: Option<[f64; 6]>,
}

/// The floor: all below a height is solid.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FloorTable {
    /// Its z in the reference frame of the study; with a part in the hand of the robot, relative to its `base_link`.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub height_mm: f64,
}

/// A body that moves with the tool.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ToolBodyTable {
    /// Its name in results; `tool`, or `cutter` of a cutter, if left out.
    #[schemars(length(min = 1, max = 60))]
    pub name: Option<String>,
    /// Whether it cuts: a cutter may touch the part, spindle and holder may not.
    #[serde(default)]
    pub cuts: bool,
    /// A box along the axes, between two opposite corners.
    pub box_mm: Option<BoxTable>,
    /// A cylinder with flat ends.
    pub cylinder_mm: Option<RoundTable>,
    /// A cylinder with half balls as ends.
    pub capsule_mm: Option<RoundTable>,
    /// A mesh: STL, OBJ, PLY, 3MF or DAE file relative to the study.
    pub mesh: Option<String>,
    /// Unit of the mesh, where its file does not give it.
    pub mesh_unit: Option<MeshUnitName>,
    /// Its position: flange to the frame of its coordinates, x, y, z in mm, then rotations about the fixed axes x, y, z in
    /// degrees.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub flange_from_body_mm_deg: Option<[f64; 6]>,
}

/// The part, or its stock: what only the cutter may touch.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PartTable {
    /// A box along the axes, between two opposite corners.
    pub box_mm: Option<BoxTable>,
    /// A cylinder with flat ends.
    pub cylinder_mm: Option<RoundTable>,
    /// A cylinder with half balls as ends.
    pub capsule_mm: Option<RoundTable>,
    /// A mesh: STL, OBJ, PLY, 3MF or DAE file relative to the study.
    pub mesh: Option<String>,
    /// Unit of the mesh, where its file does not give it.
    pub mesh_unit: Option<MeshUnitName>,
    /// Its position: frame of the part (centre of the plane, z = outward normal) to the frame of its coordinates, x, y, z in mm,
    /// then rotations about the fixed axes x, y, z in degrees.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub part_from_body_mm_deg: Option<[f64; 6]>,
    /// Three or more points of it and where they were measured, in place of `part_from_body_mm_deg`.
    pub points: Option<PartPointsTable>,
}

/// Points of a body, and where they were measured; pairs in the same order.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PartPointsTable {
    /// In the frame of the body's coordinates.
    #[schemars(length(min = 3, max = 1000), inner(inner(range(min = -1e6, max = 1e6))))]
    pub body_mm: Vec<[f64; 3]>,
    /// In the reference frame of the study.
    #[schemars(length(min = 3, max = 1000), inner(inner(range(min = -1e6, max = 1e6))))]
    pub measured_mm: Vec<[f64; 3]>,
}

/// Unit of the coordinates of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum MeshUnitName {
    /// Millimetre.
    Mm,
    /// Metre.
    M,
    /// Inch.
    Inch,
}

impl MeshUnitName {
    /// Its length, m.
    pub fn metres(self) -> f64 {
        match self {
            MeshUnitName::Mm => 1e-3,
            MeshUnitName::M => 1.0,
            MeshUnitName::Inch => 0.0254,
        }
    }
}

/// The keys of a table that give the shape: exactly one of the first four.
#[derive(Clone, Copy, Debug)]
pub struct ShapeKeys<'a> {
    /// See [`ObstacleTable::box_mm`].
    pub box_mm: Option<&'a BoxTable>,
    /// See [`ObstacleTable::cylinder_mm`].
    pub cylinder_mm: Option<&'a RoundTable>,
    /// See [`ObstacleTable::capsule_mm`].
    pub capsule_mm: Option<&'a RoundTable>,
    /// See [`ObstacleTable::mesh`].
    pub mesh: Option<&'a str>,
    /// See [`ObstacleTable::mesh_unit`].
    pub mesh_unit: Option<MeshUnitName>,
}

/// The keys of the shape of a table.
macro_rules! shape_keys {
    ($($table:ty),*) => {$(
        impl $table {
            /// Its keys that give the shape.
            pub fn shape(&self) -> ShapeKeys<'_> {
                ShapeKeys {
                    box_mm: self.box_mm.as_ref(),
                    cylinder_mm: self.cylinder_mm.as_ref(),
                    capsule_mm: self.capsule_mm.as_ref(),
                    mesh: self.mesh.as_deref(),
                    mesh_unit: self.mesh_unit,
                }
            }
        }
    )*};
}

shape_keys!(ObstacleTable, PedestalTable, ToolBodyTable, PartTable);

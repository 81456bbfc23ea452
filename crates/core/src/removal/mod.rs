//! Material removal: the part that tools leave of their stock.
//!
//! Read in this order: [`tool_solid`] (convex solids of revolution), `conic` and `torus` (slices of them by a plane), `swept` (the part of a
//! line inside of a moving tool), [`turning`] (moves, and the pieces of one whose axis turns), [`dexel`] (material along lines), [`grid`], `mesh_crossings`
//! and [`stock_solid`] (the stock), [`part`], `near` and `apart` (which dexels a move can reach, and change), [`cutting`] (a move in a tile),
//! [`along_moves`] (all moves), `outline` and [`surface`] (points of the surface and their normals). Then the surface as triangles: `lattice` and
//! `lattice_crossings` (where the surface crosses the lines of dexels), `cell_cycles` and `quadratic_error` (vertices), `quadrilateral` (triangles), [`surface_mesh`],
//! [`dual_contour`] (the whole mesh). [`error`]: what is refused.
//!
//! The height map of [`path::stock`](crate::path::stock) gives the engagement of an upright cutter at each point; this module gives the part, for tools in any
//! direction. Both cut with the same [`EndMillBody`](crate::load::EndMillBody).

pub mod along_moves;
mod apart;
mod cell_cycles;
mod conic;
pub mod cutting;
pub mod dexel;
pub mod dual_contour;
pub mod error;
pub mod grid;
mod lattice;
mod lattice_crossings;
mod mesh_crossings;
mod near;
mod outline;
pub mod part;
mod quadratic_error;
mod quadrilateral;
pub mod stock_solid;
pub mod surface;
pub mod surface_mesh;
mod swept;
pub mod tool_solid;
mod torus;
pub mod turning;

pub use along_moves::MoveRemoval;
pub use cutting::RotatingTool;
pub use dexel::EndOrigin;
pub use error::RemovalError;
pub use grid::{DexelGrid, MaterialSpan};
pub use part::{DexelDirections, DexelPart, PartSize};
pub use stock_solid::StockSolid;
pub use surface::SurfacePoint;
pub use surface_mesh::SurfaceMesh;
pub use tool_solid::ToolSolid;
pub use turning::ToolMove;

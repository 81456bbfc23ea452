//! Coloured surfaces with values out: triangle meshes for viewers, metrology software and slicers.
//!
//! | format | content | module |
//! |---|---|---|
//! | PLY, binary | geometry, normals, colours, values; mm | `ply` |
//! | VTK poly data, `.vtp` | geometry, normals, values; mm | `vtp` |
//! | glTF binary, `.glb` | geometry, normals, colours, values; m, y up | `glb` |
//! | STL, binary | geometry; mm | `stl` |
//!
//! Read in this order: [`surface_table`] (what is written, and its checks), `text` (headers that are ASCII), the formats, [`format`](mod@format) (which one). Meshes in: [`mesh`](crate::mesh).

pub mod format;
mod glb;
mod ply;
mod stl;
pub mod surface_table;
mod text;
mod vtp;

pub use format::SurfaceFormat;
pub use surface_table::{SurfaceColumn, SurfaceError, SurfaceTable};

#[cfg(test)]
mod tests;

//! Triangle meshes: the part, its stock, obstacles of a cell, tools, and collision shapes of robot links.
//!
//! | format | module |
//! |---|---|
//! | STL, binary and ASCII | `stl` |
//! | Wavefront OBJ | `obj` |
//! | PLY, ASCII and binary of both byte orders | `ply` |
//! | 3MF | `three_mf` |
//! | COLLADA (DAE) | `dae` |
//!
//! [`read`] recognises the format and gives a [`TriangleMesh`]; [`TriangleMesh::report`] says whether it encloses a
//! volume; [`likely_unit`] guesses the unit of a file that does not give one.
//!
//! Lengths are in the unit of the file. Triangles are counter-clockwise seen from outside, as the formats require.
//!
//! `triangle_mesh`, `unit`, `report`: what the readers give, and what can be said of it. `format`: which reader.
//! `text_lines`: lines and numbers of text formats. `polygon`: triangles of a polygon. `affine`: placement of an
//! object in the model. `scene`: objects with their placements. `assembly`: joins corners at the same place, drops
//! triangles without area, limits the size.

mod affine;
mod assembly;
mod dae;
mod format;
mod obj;
mod ply;
mod polygon;
mod report;
mod scene;
mod stl;
mod text_lines;
mod three_mf;
mod triangle_mesh;
mod unit;

pub use assembly::{LARGEST_COORDINATE, MOST_TRIANGLES};
pub use format::{MeshFormat, endings, read, read_ply_points};
pub use report::MeshReport;
pub use triangle_mesh::{PointCloud, TriangleMesh};
pub use unit::{MeshUnit, likely_unit};

#[cfg(test)]
mod solids;

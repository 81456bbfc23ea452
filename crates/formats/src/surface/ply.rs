//! PLY, binary, little endian, in mm.
//!
//! ```text
//! ply
//! format binary_little_endian 1.0
//! comment title and units
//! element vertex N
//! property float x, y, z, nx, ny, nz        mm, -
//! property uchar red, green, blue
//! property float <name of each column>      NaN where there is no value
//! element face M
//! property list uchar int vertex_indices
//! end_header
//! ```
//!
//! Numbers have 32 bits: 15 nm at 200 mm.
//!
//! Source: G. Turk, The PLY Polygon File Format (1994).

use super::surface_table::{SurfaceError, SurfaceTable, counted};
use super::text::ascii_line;

/// The surface as a PLY file.
pub(super) fn write(surface: &SurfaceTable) -> Result<Vec<u8>, SurfaceError> {
    let most = i32::MAX as u64;
    let vertices = counted("PLY", "vertices", surface.vertices_mm.len() as u64, most)?;
    let triangles = counted("PLY", "triangles", surface.triangles.len() as u64, most)?;
    let mut out = header(surface, [vertices, triangles]).into_bytes();
    let row = 6 * size_of::<f32>() + 3 + surface.columns.len() * size_of::<f32>();
    let face = 1 + 3 * size_of::<i32>();
    out.reserve(surface.vertices_mm.len() * row + surface.triangles.len() * face);
    for (vertex, at_mm) in surface.vertices_mm.iter().enumerate() {
        for value in at_mm.iter().chain(&surface.normals[vertex]) {
            out.extend_from_slice(&(*value as f32).to_le_bytes());
        }
        out.extend_from_slice(&surface.colour(vertex));
        for column in &surface.columns {
            out.extend_from_slice(&(column.values[vertex] as f32).to_le_bytes());
        }
    }
    for triangle in &surface.triangles {
        out.push(3);
        for vertex in triangle {
            out.extend_from_slice(&vertex.to_le_bytes());
        }
    }
    Ok(out)
}

fn header(surface: &SurfaceTable, [vertices, triangles]: [u32; 2]) -> String {
    let mut lines = vec![
        "ply".to_owned(),
        "format binary_little_endian 1.0".to_owned(),
        format!("comment {}", ascii_line(&surface.title)),
        "comment x, y, z in mm".to_owned(),
    ];
    for column in &surface.columns {
        let unit = column.unit.as_deref().unwrap_or("a number");
        lines.push(format!("comment {} in {}", column.name, ascii_line(unit)));
    }
    lines.push(format!("element vertex {vertices}"));
    lines.extend(["x", "y", "z", "nx", "ny", "nz"].map(|name| format!("property float {name}")));
    lines.extend(["red", "green", "blue"].map(|name| format!("property uchar {name}")));
    lines.extend(
        surface
            .columns
            .iter()
            .map(|column| format!("property float {}", column.name)),
    );
    lines.push(format!("element face {triangles}"));
    lines.push("property list uchar int vertex_indices".to_owned());
    lines.push("end_header\n".to_owned());
    lines.join("\n")
}

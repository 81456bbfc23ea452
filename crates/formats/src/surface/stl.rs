//! STL, binary, in mm: the triangles with their own normals, without values and colours.
//!
//! | bytes | content |
//! |---|---|
//! | 0..80 | header: `armill, mm: ` and the title |
//! | 80..84 | number of triangles |
//! | 50 each | normal, three corners of three `f32`, two bytes of attributes, 0 |

use super::surface_table::{SurfaceError, SurfaceTable, counted};
use super::text::ascii_line;

/// Bytes of the text before the number of triangles.
const HEADER_BYTES: usize = 80;
/// Bytes of a triangle.
const TRIANGLE_BYTES: usize = 50;

/// The surface as an STL file.
pub(super) fn write(surface: &SurfaceTable) -> Result<Vec<u8>, SurfaceError> {
    let triangles = surface.triangles.len();
    let count = counted("STL", "triangles", triangles as u64, u64::from(u32::MAX))?;
    let mut out = format!("armill, mm: {}", ascii_line(&surface.title)).into_bytes();
    out.resize(HEADER_BYTES, b' ');
    out.extend_from_slice(&count.to_le_bytes());
    out.reserve(triangles * TRIANGLE_BYTES);
    for triangle in &surface.triangles {
        let corners = triangle.map(|vertex| surface.vertices_mm[vertex as usize]);
        for value in normal(&corners).iter().chain(corners.as_flattened()) {
            out.extend_from_slice(&(*value as f32).to_le_bytes());
        }
        out.extend_from_slice(&[0; 2]);
    }
    Ok(out)
}

/// The unit normal of a triangle; 0 of one without area.
fn normal(corners: &[[f64; 3]; 3]) -> [f64; 3] {
    let side = |n: usize| [0, 1, 2].map(|k| corners[n][k] - corners[0][k]);
    let (u, v) = (side(1), side(2));
    let cross = [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        u[i] * v[j] - u[j] * v[i]
    });
    let length = cross.iter().map(|value| value * value).sum::<f64>().sqrt();
    cross.map(|value| if length > 0.0 { value / length } else { 0.0 })
}

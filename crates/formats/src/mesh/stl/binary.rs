//! Binary STL, little-endian.
//!
//! | bytes | content |
//! |---|---|
//! | 0..80 | header, any text |
//! | 80..84 | number of triangles |
//! | 50 each | normal, three corners of three `f32`, two bytes of attributes |

use super::super::assembly::{Assembly, MOST_TRIANGLES, REDUCE, checked};
use super::super::triangle_mesh::TriangleMesh;
use crate::document::{MOST_PROBLEMS, Problem, Problems};

const HEADER_BYTES: usize = 84;
const TRIANGLE_BYTES: usize = 50;
/// Bytes of the normal, before the corners.
const NORMAL_BYTES: usize = 12;

/// Whether the length is that of the number of triangles in the header.
pub(super) fn has_right_length(bytes: &[u8]) -> bool {
    count(bytes).is_some_and(|count| length(count) == bytes.len() as u64)
}

/// The number of triangles in the header.
fn count(bytes: &[u8]) -> Option<u32> {
    let field = bytes.get(HEADER_BYTES - 4..HEADER_BYTES)?;
    Some(u32::from_le_bytes(field.try_into().ok()?))
}

/// Bytes of a file with this many triangles.
fn length(count: u32) -> u64 {
    HEADER_BYTES as u64 + TRIANGLE_BYTES as u64 * u64::from(count)
}

/// Reads a binary STL file.
///
/// # Errors
/// A file that is too short for its number of triangles, too many triangles, coordinates that are not accepted, a mesh
/// without area.
pub(super) fn read(name: &str, bytes: &[u8]) -> Result<TriangleMesh, Problems> {
    let refused = |message: String, hint: &str| Problems::from(Problem::of_file(name, message, hint));
    let Some(count) = count(bytes) else {
        let message = format!(
            "{} bytes are neither ASCII STL nor the header of a binary one, which has {HEADER_BYTES}",
            bytes.len()
        );
        return Err(refused(message, "export it again as STL"));
    };
    let required = length(count);
    if (bytes.len() as u64) < required {
        let message = format!(
            "the header announces {count} triangles, which need {required} bytes, but the file has {}",
            bytes.len()
        );
        return Err(refused(
            message,
            "the file is cut short, or not STL: export it again",
        ));
    }
    if count as usize > MOST_TRIANGLES {
        return Err(refused(
            format!("{count} triangles exceed the limit of {MOST_TRIANGLES}"),
            REDUCE,
        ));
    }
    let mut assembly = Assembly::default();
    let mut problems = Vec::new();
    let records = bytes[HEADER_BYTES..]
        .chunks_exact(TRIANGLE_BYTES)
        .take(count as usize);
    for (index, record) in records.enumerate() {
        match corners(record) {
            Ok(corners) => {
                let vertices = corners.map(|corner| assembly.vertex(corner));
                // The limit was compared with the header.
                let _ = assembly.triangle(vertices);
            }
            Err(message) => {
                let start = HEADER_BYTES + index * TRIANGLE_BYTES;
                let message = format!("triangle {} of {count}, byte {start}: {message}", index + 1);
                let hint = "coordinates are finite numbers up to 1e9: export it again";
                problems.push(Problem::of_file(name, message, hint).in_file(1, start));
            }
        }
        if problems.len() == MOST_PROBLEMS {
            break;
        }
    }
    Problems::from(problems).into_result()?;
    let mut mesh = assembly.finish(name)?;
    let behind = bytes.len() as u64 - required;
    if behind > 0 {
        mesh.notes
            .push(format!("{behind} bytes behind the last triangle were not used"));
    }
    Ok(mesh)
}

/// The corners of a triangle.
///
/// # Errors
/// A coordinate that is not accepted: what is wrong.
fn corners(record: &[u8]) -> Result<[[f64; 3]; 3], String> {
    let mut corners = [[0.0; 3]; 3];
    let numbers = record[NORMAL_BYTES..].chunks_exact(4);
    for (value, number) in corners.as_flattened_mut().iter_mut().zip(numbers) {
        let number = f32::from_le_bytes([number[0], number[1], number[2], number[3]]);
        *value = checked(f64::from(number))?;
    }
    Ok(corners)
}

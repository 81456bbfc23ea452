//! STL: triangles without shared vertices and without a unit.
//!
//! | file | read as |
//! |---|---|
//! | length 84 + 50 n bytes, n at byte 80 | binary, whatever the header says (some begin with `solid`) |
//! | begins with `solid`, and `facet` or `endsolid` follows | ASCII |
//! | any other | binary that is cut short or has bytes behind its last triangle |
//!
//! `ascii`, `binary`: both forms. Normals and attributes of triangles are not used: the order of corners gives the outside.
//!
//! Source: 3D Systems, Inc., Stereolithography Interface Specification (1989).

mod ascii;
mod binary;

use super::triangle_mesh::TriangleMesh;
use crate::document::Problems;

/// Bytes in which the first facet of an ASCII file is looked for: names of solids may be long.
const HEAD_BYTES: usize = 4096;

/// Reads an STL file; `name` is the path that problems show.
///
/// # Errors
/// See [`read`](super::format::read).
pub(super) fn read(name: &str, bytes: &[u8]) -> Result<TriangleMesh, Problems> {
    match is_ascii(bytes) {
        true => ascii::read(name, bytes),
        false => binary::read(name, bytes),
    }
}

/// Whether the content is clearly STL: ASCII, or binary of exactly the right length.
pub(super) fn is_stl(bytes: &[u8]) -> bool {
    is_ascii(bytes) || binary::has_right_length(bytes)
}

/// Whether the content is ASCII STL.
fn is_ascii(bytes: &[u8]) -> bool {
    let text = bytes
        .strip_prefix(b"\xef\xbb\xbf")
        .unwrap_or(bytes)
        .trim_ascii_start();
    let head = text[..text.len().min(HEAD_BYTES)].to_ascii_lowercase();
    let has = |word: &[u8]| head.windows(word.len()).any(|part| part == word);
    head.starts_with(b"solid") && !binary::has_right_length(bytes) && (has(b"facet") || has(b"endsolid"))
}

#[cfg(test)]
mod tests;

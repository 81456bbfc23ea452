//! Wavefront OBJ: vertices and polygons, one statement a line, without a unit.
//!
//! | statement | read as |
//! |---|---|
//! | `v X Y Z ...` | a vertex; a weight or a colour behind it is not used |
//! | `f V V V ...` | a polygon of at least three corners: `V`, `V/VT`, `V//VN`, `V/VT/VN` |
//! | index above 0 | counts all vertices of the file from 1, also those that follow |
//! | index below 0 | counts back from the last vertex before the line |
//! | `curv`, `surf` and other free forms | refused: they have no triangles |
//! | any other | not used: normals, textures, groups, materials, lines, points |
//!
//! `\` at the end of a line continues it; `#` begins a comment.
//!
//! Source: Alias|Wavefront, Advanced Visualizer Manual, appendix B1 (1995).

use super::assembly::{Assembly, Points, Refusal};
use super::text_lines::{TextLine, TextLines, three};
use super::triangle_mesh::TriangleMesh;
use crate::document::{MOST_PROBLEMS, Problem, Problems};

/// Statements of free-form curves and surfaces.
const FREE_FORMS: [&[u8]; 4] = [b"cstype", b"curv", b"curv2", b"surf"];
/// What to do about a face that is not accepted.
const FACES: &str = "a face is `f` and at least three of V, V/VT, V//VN or V/VT/VN";

/// Reads an OBJ file; `name` is the path that problems show.
///
/// # Errors
/// See [`read`](super::format::read).
pub(super) fn read(name: &str, bytes: &[u8]) -> Result<TriangleMesh, Problems> {
    let mut problems = Vec::new();
    let points = points(name, bytes, &mut problems);
    let mut faces = Faces {
        points: Points::new(&points),
        defined: 0,
        assembly: Assembly::default(),
        corners: Vec::new(),
    };
    let (mut lines, mut joined) = (TextLines::new(bytes), Vec::new());
    while let Some(line) = lines.next() {
        if problems.len() >= MOST_PROBLEMS {
            break;
        }
        let line = continued(line, &mut lines, &mut joined);
        let mut words = line.words();
        match words.next() {
            Some(b"v") => faces.defined += 1,
            Some(b"f") => match faces.face(&line, words, name) {
                Ok(()) => {}
                Err(Fault::Place(wrong)) => problems.extend(wrong),
                Err(Fault::Refusal(refusal)) => {
                    problems.push(line.problem(name, line.bytes, refusal.message(), refusal.hint()));
                    if refusal.is_final() {
                        break;
                    }
                }
            },
            Some(word) if FREE_FORMS.contains(&word) => {
                let message = "a free-form curve or surface has no triangles";
                problems.push(line.problem(name, word, message, "export the mesh with polygons"));
            }
            _ => {}
        }
    }
    Problems::from(problems).into_result()?;
    faces.assembly.finish(name)
}

/// All vertices of the file. One that is wrong is reported and is zero, so that indices of the others remain.
fn points(name: &str, bytes: &[u8], problems: &mut Vec<Problem>) -> Vec<[f64; 3]> {
    let mut points = Vec::new();
    let (mut lines, mut joined) = (TextLines::new(bytes), Vec::new());
    while let Some(line) = lines.next() {
        if problems.len() >= MOST_PROBLEMS {
            break;
        }
        let line = continued(line, &mut lines, &mut joined);
        let mut words = line.words();
        if words.next() == Some(b"v") {
            points.push(three(&line, &mut words, name).unwrap_or_else(|wrong| {
                problems.extend(wrong);
                [0.0; 3]
            }));
        }
    }
    points
}

/// A line with those that continue it, without its comment; `joined` is where they are put together.
fn continued<'b, 'a: 'b>(
    line: TextLine<'a>,
    lines: &mut TextLines<'a>,
    joined: &'b mut Vec<u8>,
) -> TextLine<'b> {
    let mut bytes: &'b [u8] = line.bytes;
    if bytes.last() == Some(&b'\\') {
        joined.clear();
        joined.extend_from_slice(bytes);
        while joined.pop_if(|last| *last == b'\\').is_some() {
            let Some(next) = lines.next() else { break };
            joined.push(b' ');
            joined.extend_from_slice(next.bytes);
        }
        bytes = joined;
    }
    let end = bytes.iter().position(|byte| *byte == b'#');
    line.with_bytes(&bytes[..end.unwrap_or(bytes.len())])
}

/// The faces so far.
struct Faces<'a> {
    points: Points<'a>,
    /// Vertices before the line.
    defined: usize,
    assembly: Assembly,
    /// Vertices of a face; kept so that its memory is used again.
    corners: Vec<u32>,
}

/// Why a face is not accepted.
enum Fault {
    /// At a word of its line.
    Place(Problems),
    /// As a whole.
    Refusal(Refusal),
}

impl Faces<'_> {
    /// Adds the face of a line.
    ///
    /// # Errors
    /// An index without a vertex, fewer than three corners, a polygon without triangles, too many triangles.
    fn face<'a>(
        &mut self,
        line: &TextLine<'a>,
        words: impl Iterator<Item = &'a [u8]>,
        name: &str,
    ) -> Result<(), Fault> {
        self.corners.clear();
        for word in words {
            let vertex = self.index(word).and_then(|index| {
                let found = self.points.vertex(index, &mut self.assembly);
                found.ok_or_else(|| self.no_vertex(word))
            });
            let vertex =
                vertex.map_err(|message| Fault::Place(line.problem(name, word, message, FACES).into()))?;
            self.corners.push(vertex);
        }
        if self.corners.len() < 3 {
            let message = format!("a face with {} corners: at least 3 required", self.corners.len());
            return Err(Fault::Place(
                line.problem(name, line.bytes, message, FACES).into(),
            ));
        }
        self.assembly.polygon(&self.corners).map_err(Fault::Refusal)
    }

    /// The index from 0 that a corner such as `3`, `-1/2` or `4//5` names; not checked: that it is below their number.
    ///
    /// # Errors
    /// Not a whole number, 0, or before the first vertex: what is wrong.
    fn index(&self, word: &[u8]) -> Result<usize, String> {
        let first = word.split(|byte| *byte == b'/').next().unwrap_or_default();
        let number = std::str::from_utf8(first)
            .ok()
            .and_then(|text| text.parse::<i64>().ok());
        let number = number.ok_or_else(|| {
            format!(
                "`{}` does not begin with the index of a vertex",
                String::from_utf8_lossy(word)
            )
        })?;
        let index = match number {
            1.. => usize::try_from(number - 1).ok(),
            0 => None,
            _ => usize::try_from(number.unsigned_abs())
                .ok()
                .and_then(|back| self.defined.checked_sub(back)),
        };
        index.ok_or_else(|| self.no_vertex(word))
    }

    /// The message for an index without a vertex.
    fn no_vertex(&self, word: &[u8]) -> String {
        format!(
            "no vertex has the index of `{}`: the file has {} vertices, {} before this line",
            String::from_utf8_lossy(word),
            self.points.len(),
            self.defined
        )
    }
}

#[cfg(test)]
mod tests;

//! ASCII STL: one statement a line; keywords in small or capital letters.
//!
//! ```text
//! solid NAME
//!   facet normal NX NY NZ
//!     outer loop
//!       vertex X Y Z        three times
//!     endloop
//!   endfacet
//! endsolid NAME             further solids may follow
//! ```

use super::super::assembly::Assembly;
use super::super::text_lines::{TextLine, TextLines, three};
use super::super::triangle_mesh::TriangleMesh;
use crate::document::{MOST_PROBLEMS, Problems};

/// What to do about a line that is not expected.
const STATEMENTS: &str =
    "lines are `facet normal`, `outer loop`, three of `vertex X Y Z`, `endloop`, `endfacet`";

/// The facet so far.
#[derive(Default)]
struct Facet {
    /// Whether the reader is between `facet` and `endfacet`.
    is_open: bool,
    /// Whether a problem of it was reported.
    is_reported: bool,
    corners: Vec<[f64; 3]>,
}

/// Reads an ASCII STL file.
///
/// # Errors
/// All lines that are wrong, at most 200; a file that ends inside a facet; too many triangles; a mesh without area.
pub(super) fn read(name: &str, bytes: &[u8]) -> Result<TriangleMesh, Problems> {
    let mut assembly = Assembly::default();
    let mut problems = Vec::new();
    let mut facet = Facet::default();
    let mut last = None;
    for line in TextLines::new(bytes) {
        last = Some(line);
        match statement(&line, name, &mut facet) {
            Ok(None) => {}
            Ok(Some(end)) => {
                let ended = std::mem::take(&mut facet);
                if let Err(refusal) = ended.add_to(&mut assembly) {
                    problems.push(line.problem(name, end, refusal.0, refusal.1));
                }
            }
            Err(wrong) => {
                facet.is_reported = true;
                problems.extend(wrong);
            }
        }
        if problems.len() == MOST_PROBLEMS {
            break;
        }
    }
    if facet.is_open
        && problems.is_empty()
        && let Some(line) = last
    {
        let message = format!("the file ends inside facet {}", assembly.triangles() + 1);
        problems.push(line.problem(name, line.bytes, message, "it is cut short: export it again"));
    }
    Problems::from(problems).into_result()?;
    assembly.finish(name)
}

impl Facet {
    /// Adds the triangle, unless a problem of it was reported.
    ///
    /// # Errors
    /// Not three corners, too many triangles: what is wrong, and a hint.
    fn add_to(self, assembly: &mut Assembly) -> Result<(), (String, &'static str)> {
        if self.is_reported {
            return Ok(());
        }
        let [a, b, c] = self.corners[..] else {
            let message = format!("a facet with {} vertices: 3 required", self.corners.len());
            return Err((message, STATEMENTS));
        };
        let vertices = [a, b, c].map(|corner| assembly.vertex(corner));
        let added = assembly.triangle(vertices);
        added.map_err(|refusal| (refusal.message(), refusal.hint()))
    }
}

/// Takes the statement of a line; gives its keyword if it ends a facet.
///
/// # Errors
/// A keyword that is unknown or not expected here; a vertex without three coordinates.
fn statement<'a>(line: &TextLine<'a>, name: &str, facet: &mut Facet) -> Result<Option<&'a [u8]>, Problems> {
    let mut words = line.words();
    let Some(keyword) = words.next() else {
        return Ok(None);
    };
    let is = |word: &str| keyword.eq_ignore_ascii_case(word.as_bytes());
    let expected = match facet.is_open {
        true => ["outer", "vertex", "endloop", "endfacet"],
        false => ["facet", "solid", "endsolid", "color"],
    };
    if !expected.into_iter().any(is) {
        let message = format!("`{}` is not expected here", String::from_utf8_lossy(keyword));
        return Err(line.problem(name, keyword, message, STATEMENTS).into());
    }
    if is("vertex") {
        facet.corners.push(three(line, &mut words, name)?);
    }
    facet.is_open |= is("facet");
    Ok(is("endfacet").then_some(keyword))
}

//! The header of a PLY file: its format, its elements and their properties.
//!
//! ```text
//! ply
//! format binary_little_endian 1.0         or ascii, binary_big_endian
//! comment ...
//! element vertex 8
//! property float x                        type, name
//! element face 6
//! property list uchar int vertex_indices  type of the number, type of the values, name
//! end_header
//! ```

use super::super::text_lines::{TextLine, TextLines};
use crate::document::{Problem, Problems};

/// No header has more lines.
const MOST_LINES: usize = 1000;
/// What to do about a line that is not expected.
const LINES: &str = "header lines are format, comment, obj_info, element, property and end_header";

/// What a PLY file contains.
#[derive(Debug)]
pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
}

/// What is required of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Content {
    /// Vertices and faces.
    Mesh,
    /// Vertices, with or without faces.
    Points,
}

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

impl Encoding {
    /// The encoding of this name in the line `format`.
    fn named(name: &[u8]) -> Option<Encoding> {
        match name {
            b"ascii" => Some(Encoding::Ascii),
            b"binary_little_endian" => Some(Encoding::LittleEndian),
            b"binary_big_endian" => Some(Encoding::BigEndian),
            _ => None,
        }
    }
}

/// A table of the file.
#[derive(Debug)]
pub(super) struct Element {
    pub name: String,
    /// Rows by the header; not checked: that the file has them.
    pub count: usize,
    pub properties: Vec<Property>,
}

/// A column of a table.
#[derive(Debug)]
pub(super) struct Property {
    pub name: String,
    /// Type of the value, or of each value of a list.
    pub scalar: Scalar,
    /// Type of the number of values, of a list.
    pub list_count: Option<Scalar>,
}

/// Type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    /// The type of this name, in either of its two spellings.
    fn named(name: &[u8]) -> Option<Scalar> {
        Some(match name {
            b"char" | b"int8" => Scalar::I8,
            b"uchar" | b"uint8" => Scalar::U8,
            b"short" | b"int16" => Scalar::I16,
            b"ushort" | b"uint16" => Scalar::U16,
            b"int" | b"int32" => Scalar::I32,
            b"uint" | b"uint32" => Scalar::U32,
            b"float" | b"float32" => Scalar::F32,
            b"double" | b"float64" => Scalar::F64,
            _ => return None,
        })
    }

    /// Its length in a binary file.
    pub fn bytes(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::F64 => 8,
        }
    }
}

/// The header of a file, and what follows it.
///
/// # Errors
/// The first line that is wrong: the rest could not be read.
pub(super) fn read<'a>(
    name: &str,
    bytes: &'a [u8],
    content: Content,
) -> Result<(Header, TextLines<'a>), Problems> {
    let mut lines = TextLines::new(bytes);
    let mut elements = Vec::new();
    let mut encoding = None;
    let mut first = true;
    while let Some(line) = lines.next() {
        if line.number > MOST_LINES {
            break;
        }
        let words: Vec<&[u8]> = line.words().collect();
        let refused = |message: String| Problems::from(line.problem(name, line.bytes, message, LINES));
        if std::mem::take(&mut first) {
            if words != [b"ply"] {
                return Err(refused("the first line of a PLY file is `ply`".to_owned()));
            }
            continue;
        }
        match words[..] {
            [] | [b"comment" | b"obj_info", ..] => {}
            [b"format", format, _] => {
                encoding = Some(Encoding::named(format).ok_or_else(|| {
                    refused(format!(
                        "the format `{}` is not known",
                        String::from_utf8_lossy(format)
                    ))
                })?);
            }
            [b"element", of, count] => elements.push(element(of, count).ok_or_else(|| {
                refused(format!(
                    "`{}` is not a number of elements",
                    String::from_utf8_lossy(count)
                ))
            })?),
            [b"property", ref words @ ..] => {
                let property = property(words).map_err(refused)?;
                let element = elements.last_mut();
                let element =
                    element.ok_or_else(|| refused("a property before the first element".to_owned()))?;
                element.properties.push(property);
            }
            [b"end_header"] => {
                let encoding =
                    encoding.ok_or_else(|| refused("the header has no line `format`".to_owned()))?;
                check(name, &line, &mut elements, content)?;
                return Ok((Header { encoding, elements }, lines));
            }
            _ => return Err(refused("not a line of the header of a PLY file".to_owned())),
        }
    }
    let message = "the header has no line `end_header`";
    Err(Problem::of_file(
        name,
        message,
        "the file is cut short, or not PLY: export it again",
    )
    .into())
}

/// An element without properties yet; `None` if the count is not a whole number.
fn element(name: &[u8], count: &[u8]) -> Option<Element> {
    Some(Element {
        name: String::from_utf8_lossy(name).into_owned(),
        count: std::str::from_utf8(count).ok()?.parse().ok()?,
        properties: Vec::new(),
    })
}

/// The property of these words.
///
/// # Errors
/// Other words than required, unknown types, a number of values that is not whole.
fn property(words: &[&[u8]]) -> Result<Property, String> {
    let scalar = |name: &[u8]| {
        let found = Scalar::named(name);
        found.ok_or_else(|| format!("the type `{}` is not known", String::from_utf8_lossy(name)))
    };
    let (list_count, of, name) = match *words {
        [b"list", count, of, name] => (Some(scalar(count)?), of, name),
        [of, name] => (None, of, name),
        _ => return Err("a property is a type and a name, or `list`, two types and a name".to_owned()),
    };
    if matches!(list_count, Some(Scalar::F32 | Scalar::F64)) {
        return Err("the number of values of a list is of a whole type".to_owned());
    }
    Ok(Property {
        name: String::from_utf8_lossy(name).into_owned(),
        scalar: scalar(of)?,
        list_count,
    })
}

/// Checks which elements there are; those without properties have no bytes and are dropped.
///
/// # Errors
/// Triangle strips; two elements of one name; no vertices or faces.
fn check(
    name: &str,
    line: &TextLine<'_>,
    elements: &mut Vec<Element>,
    content: Content,
) -> Result<(), Problems> {
    elements.retain(|element| !element.properties.is_empty());
    let refused = |message: String, hint: &str| Err(line.problem(name, line.bytes, message, hint).into());
    let with_name = |of: &str| elements.iter().filter(|element| element.name == of).count();
    if content == Content::Mesh && with_name("tristrips") > 0 && with_name("face") == 0 {
        return refused(
            "triangle strips are not read".to_owned(),
            "export the mesh with faces",
        );
    }
    let required = match content {
        Content::Mesh => &["vertex", "face"][..],
        Content::Points => &["vertex"],
    };
    for required in required {
        let count = with_name(required);
        if count != 1 {
            let message = format!("the header has {count} elements `{required}`: 1 required");
            return refused(message, "export it again as a mesh; a point cloud has no faces");
        }
    }
    Ok(())
}

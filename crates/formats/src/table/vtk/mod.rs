//! Fields in space for ParaView: VTK XML files, little endian, base64, `header_type="UInt64"`.
//!
//! - [`Image`]: a regular grid in three dimensions, `.vti`.
//! - [`PolyData`]: points anywhere, joined to quadrilaterals, triangles and lines, `.vtp`.
//!
//! This module writes the values at the points and the bytes of an array; `image` and `poly_data` have the geometry.
//!
//! Lengths of the geometry are millimetres; arrays carry their unit in their name. Numbers at the points have 32 bits,
//! seven digits: more cannot be seen. VTK has no missing values: they are written as NaN, and a second array
//! `<name>_valid` is 1 where there is a value and 0 where there is none.
//!
//! ```text
//! <VTKFile type="ImageData" or "PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">
//!   geometry
//!   <PointData Scalars="first scalar array">
//!     <DataArray type="Float32" Name="in_plane_um" ...>       base64 of: count of bytes (UInt64), bytes
//!     <DataArray type="UInt8" Name="in_plane_um_valid" ...>
//! ```
//!
//! Source: VTK file formats, section "XML file formats",
//! <https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html>.

mod image;
mod poly_data;

use std::collections::BTreeSet;
use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

pub use self::image::{Image, write_image};
pub use self::poly_data::{PolyData, write_poly_data};

/// Values at the points of a grid or mesh, one for each point.
#[derive(Debug, Clone, PartialEq)]
pub struct PointArray {
    /// The name, with the unit at its end: `in_plane_um`.
    pub name: String,
    /// One value for each point, in the order of the points.
    pub values: PointValues,
}

/// The values of a [`PointArray`]; `None` where there is none.
#[derive(Debug, Clone, PartialEq)]
pub enum PointValues {
    /// Numbers.
    Scalar(Vec<Option<f64>>),
    /// Vectors in the frame of the points.
    Vector(Vec<Option<[f64; 3]>>),
}

/// Why a grid or mesh cannot be written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum VtkError {
    /// A grid has no points in one direction.
    #[error("the grid has {} x {} x {} points: at least 1 is needed in each direction", counts[0], counts[1], counts[2])]
    NoPoints {
        /// Points in x, y and z.
        counts: [usize; 3],
    },
    /// A grid has a distance between points that is not positive and finite.
    #[error("the grid spacing is {} x {} x {} mm: each must be above 0 mm", spacing_mm[0], spacing_mm[1], spacing_mm[2])]
    Spacing {
        /// The distances in x, y and z.
        spacing_mm: [f64; 3],
    },
    /// A position is not finite.
    #[error("point {index} is at ({}, {}, {}) mm: must be finite", at_mm[0], at_mm[1], at_mm[2])]
    Position {
        /// The point, from 0.
        index: usize,
        /// Where it is.
        at_mm: [f64; 3],
    },
    /// Points do not fill the grids that they should make.
    #[error("{points} points do not make grids of {expected}")]
    GridPoints {
        /// How many points there are.
        points: usize,
        /// How many all grids have together.
        expected: usize,
    },
    /// A quadrilateral, triangle or line names a point that does not exist.
    #[error("a cell names point {index}: there are {points}")]
    PointIndex {
        /// The point that is named, from 0.
        index: usize,
        /// How many points there are.
        points: usize,
    },
    /// A line has fewer than two points.
    #[error("line {index} has {points} points: at least 2 are needed")]
    ShortLine {
        /// The line, from 0.
        index: usize,
        /// Its points.
        points: usize,
    },
    /// An array has another length than there are points.
    #[error("array `{array}` has {found} values: there are {points} points")]
    ArrayLength {
        /// The array.
        array: String,
        /// Its values.
        found: usize,
        /// The points.
        points: usize,
    },
    /// Two arrays have the same name, or one has that of another's mask.
    #[error("two arrays are called `{array}`")]
    SameName {
        /// The name.
        array: String,
    },
    /// A value is nan or infinite; a value that is missing is `None`.
    #[error("array `{array}` is not finite at point {index}")]
    NotFinite {
        /// The array.
        array: String,
        /// The point, from 0.
        index: usize,
    },
}

impl PointValues {
    /// Points with or without a value.
    fn len(&self) -> usize {
        match self {
            Self::Scalar(values) => values.len(),
            Self::Vector(values) => values.len(),
        }
    }

    /// The first point with a value that is not finite.
    fn first_not_finite(&self) -> Option<usize> {
        let strange = |vector: [f64; 3]| vector.iter().any(|value| !value.is_finite());
        match self {
            Self::Scalar(values) => values
                .iter()
                .position(|value| value.is_some_and(|v| !v.is_finite())),
            Self::Vector(values) => values.iter().position(|value| value.is_some_and(strange)),
        }
    }

    /// Where there are values.
    fn valid(&self) -> Vec<bool> {
        match self {
            Self::Scalar(values) => values.iter().map(Option::is_some).collect(),
            Self::Vector(values) => values.iter().map(Option::is_some).collect(),
        }
    }
}

/// Refuses arrays of the wrong length, of one name, or with values that are not finite.
///
/// The names of masks are included, so that an array `a_valid` next to `a` is refused.
fn check_arrays(arrays: &[PointArray], points: usize) -> Result<(), VtkError> {
    let mut names = BTreeSet::new();
    for PointArray { name, values } in arrays {
        let array = name.clone();
        if values.len() != points {
            return Err(VtkError::ArrayLength {
                array,
                found: values.len(),
                points,
            });
        }
        if let Some(index) = values.first_not_finite() {
            return Err(VtkError::NotFinite { array, index });
        }
        for name in [array, mask_name(name)] {
            if !names.insert(name.clone()) {
                return Err(VtkError::SameName { array: name });
            }
        }
    }
    Ok(())
}

/// Refuses positions that are not finite.
fn check_positions(points_mm: &[[f64; 3]]) -> Result<(), VtkError> {
    let strange = |at: &[f64; 3]| at.iter().any(|value| !value.is_finite());
    match points_mm.iter().position(strange) {
        Some(index) => Err(VtkError::Position {
            index,
            at_mm: points_mm[index],
        }),
        None => Ok(()),
    }
}

/// Name of the array that says where there are values.
fn mask_name(name: &str) -> String {
    format!("{name}_valid")
}

/// The whole file around its one data set, which `body` writes.
fn file(kind: &str, body: impl FnOnce(&mut String)) -> Vec<u8> {
    let mut out = format!(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
    );
    body(&mut out);
    out += "</VTKFile>\n";
    out.into_bytes()
}

/// The `PointData` element; the first scalar is the one ParaView shows first.
fn point_data(out: &mut String, arrays: &[PointArray]) {
    let scalar = |array: &&PointArray| matches!(array.values, PointValues::Scalar(_));
    let shown = arrays
        .iter()
        .find(scalar)
        .map(|array| format!(" Scalars=\"{}\"", escaped(&array.name)));
    *out += &format!("<PointData{}>\n", shown.unwrap_or_default());
    for PointArray { name, values } in arrays {
        match values {
            PointValues::Scalar(values) => {
                floats(out, name, 1, values.iter().map(|value| value.unwrap_or(f64::NAN)));
            }
            PointValues::Vector(values) => {
                let all = values.iter().flat_map(|value| value.unwrap_or([f64::NAN; 3]));
                floats(out, name, 3, all);
            }
        }
        let valid = values.valid().into_iter().map(|valid| [u8::from(valid)]);
        data_array(out, "UInt8", &mask_name(name), 1, valid);
    }
    *out += "</PointData>\n";
}

/// An array of numbers, rounded to 32 bits; one beyond their range is infinite.
fn floats(out: &mut String, name: &str, components: usize, values: impl Iterator<Item = f64>) {
    let bytes = values.map(|value| (value as f32).to_le_bytes());
    data_array(out, "Float32", name, components, bytes);
}

/// One array: the count of its bytes and the bytes themselves, together in base64.
fn data_array<const BYTES: usize>(
    out: &mut String,
    kind: &str,
    name: &str,
    components: usize,
    values: impl Iterator<Item = [u8; BYTES]>,
) {
    let mut block = vec![0; size_of::<u64>()];
    block.reserve(values.size_hint().0 * BYTES);
    for value in values {
        block.extend_from_slice(&value);
    }
    let count = (block.len() - size_of::<u64>()) as u64;
    block[..size_of::<u64>()].copy_from_slice(&count.to_le_bytes());
    let name = escaped(name);
    *out += &format!(
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"binary\">\n"
    );
    STANDARD.encode_string(block, out);
    *out += "\n</DataArray>\n";
}

/// Text for an XML attribute; characters that XML cannot represent at all become a question mark.
fn escaped(text: &str) -> String {
    let mut out = String::new();
    for character in text.chars() {
        match character {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '"' => out.push_str("&quot;"),
            '\t' | '\n' | '\r' => {
                // Writing to a string does not fail.
                let _ = write!(out, "&#{};", u32::from(character));
            }
            '\u{fffe}' | '\u{ffff}' => out.push('?'),
            other if other.is_control() => out.push('?'),
            other => out.push(other),
        }
    }
    out
}

#[cfg(test)]
mod tests;

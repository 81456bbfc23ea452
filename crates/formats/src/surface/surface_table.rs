//! A triangle mesh with values at its vertices, as plain numbers.

use std::collections::BTreeSet;

use crate::table::vtk::VtkError;

/// A surface, and what is known of its vertices. [`SurfaceFormat::write`](super::SurfaceFormat::write) checks it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceTable {
    /// For people; in the header of a file.
    pub title: String,
    /// In any one frame, z up.
    pub vertices_mm: Vec<[f64; 3]>,
    /// Out of the material, unit vectors; one for each vertex.
    pub normals: Vec<[f64; 3]>,
    /// Three vertices each, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Values at the vertices.
    pub columns: Vec<SurfaceColumn>,
    /// Red, green and blue of each vertex as screens show them (sRGB); grey without.
    pub colours: Option<Vec<[u8; 3]>>,
}

/// Values at the vertices of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceColumn {
    /// Letters, digits and `_`, with the unit at its end: `deviation_um`.
    pub name: String,
    /// The unit as people write it, `um`; none for counts.
    pub unit: Option<String>,
    /// One value for each vertex; NaN where there is none.
    pub values: Vec<f64>,
}

/// Why a surface cannot be written.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// No triangles.
    #[error("the surface has no triangles")]
    NoTriangles,
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} names vertex {vertex}: there are {vertices}")]
    VertexIndex {
        /// The triangle, from 0.
        triangle: usize,
        /// The vertex that is named, from 0.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
    /// A position is not finite, or too large for 32 bits.
    #[error("vertex {index} is at ({}, {}, {}) mm: each must be between -1e9 and 1e9", at_mm[0], at_mm[1], at_mm[2])]
    Position {
        /// The vertex, from 0.
        index: usize,
        /// Where it is.
        at_mm: [f64; 3],
    },
    /// A normal is not a unit vector.
    #[error("the normal of vertex {index} is ({}, {}, {}): must have the length 1", normal[0], normal[1], normal[2])]
    Normal {
        /// The vertex, from 0.
        index: usize,
        /// Its normal.
        normal: [f64; 3],
    },
    /// A list has another length than there are vertices.
    #[error("{list} has {found} entries: there are {vertices} vertices")]
    Length {
        /// The normals, the colours, or the name of a column.
        list: String,
        /// Its entries.
        found: usize,
        /// The vertices.
        vertices: usize,
    },
    /// A name that files cannot have.
    #[error("`{name}` is not a valid name of a column: letters, digits and `_` only, not {RESERVED:?}")]
    Name {
        /// The name.
        name: String,
    },
    /// Two columns have the same name, or one has that of another's mask; capitals do not matter.
    #[error("two columns are called `{name}`")]
    SameName {
        /// The name.
        name: String,
    },
    /// A value is infinite, or too large for 32 bits.
    #[error(
        "column `{name}` is {value} at vertex {index}: each value must be within the range of 32 bits (3.4e38), or NaN where there is none"
    )]
    Value {
        /// The column.
        name: String,
        /// The vertex, from 0.
        index: usize,
        /// The value.
        value: f64,
    },
    /// More than the format can count.
    #[error("the file has {found} {what}: {format} has at most {most}; use a mesh with fewer triangles")]
    TooLarge {
        /// The format.
        format: &'static str,
        /// What is counted.
        what: &'static str,
        /// How many there are.
        found: u64,
        /// How many there may be.
        most: u64,
    },
    /// What VTK refuses.
    #[error(transparent)]
    Vtk(#[from] VtkError),
}

/// Names of the properties of PLY that each surface has.
const RESERVED: [&str; 9] = ["x", "y", "z", "nx", "ny", "nz", "red", "green", "blue"];
/// Largest coordinate, mm: 1000 km; that of meshes that are read.
const LARGEST_MM: f64 = 1e9;
/// Largest difference of the length of a normal from 1.
const UNIT: f64 = 1e-3;
/// Colour of vertices without a colour, and of all without colours.
const GREY: [u8; 3] = [0xb4, 0xb4, 0xb4];

impl SurfaceTable {
    /// The colours of all vertices, grey without.
    pub(super) fn colour(&self, vertex: usize) -> [u8; 3] {
        let given = self.colours.as_ref().and_then(|colours| colours.get(vertex));
        given.copied().unwrap_or(GREY)
    }

    /// Refuses what no format can have.
    pub(super) fn check(&self) -> Result<(), SurfaceError> {
        let vertices = self.vertices_mm.len();
        if self.triangles.is_empty() {
            return Err(SurfaceError::NoTriangles);
        }
        for (triangle, corners) in self.triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|corner| **corner as usize >= vertices) {
                return Err(SurfaceError::VertexIndex {
                    triangle,
                    vertex,
                    vertices,
                });
            }
        }
        let is_far = |at: &[f64; 3]| !at.iter().all(|value| value.abs() <= LARGEST_MM);
        if let Some(index) = self.vertices_mm.iter().position(is_far) {
            let at_mm = self.vertices_mm[index];
            return Err(SurfaceError::Position { index, at_mm });
        }
        let length = |list: &str, found: usize| {
            let list = list.to_owned();
            match found == vertices {
                true => Ok(()),
                false => Err(SurfaceError::Length {
                    list,
                    found,
                    vertices,
                }),
            }
        };
        length("the list of normals", self.normals.len())?;
        if let Some(colours) = &self.colours {
            length("the list of colours", colours.len())?;
        }
        let is_unit = |normal: &[f64; 3]| {
            let square: f64 = normal.iter().map(|value| value * value).sum();
            (square.sqrt() - 1.0).abs() <= UNIT
        };
        if let Some(index) = self.normals.iter().position(|normal| !is_unit(normal)) {
            let normal = self.normals[index];
            return Err(SurfaceError::Normal { index, normal });
        }
        for column in &self.columns {
            length(&format!("column `{}`", column.name), column.values.len())?;
        }
        self.check_columns()
    }

    fn check_columns(&self) -> Result<(), SurfaceError> {
        let mut names = BTreeSet::new();
        for SurfaceColumn { name, values, .. } in &self.columns {
            let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
            let lower = name.to_lowercase();
            if name.is_empty() || !name.bytes().all(is_plain) || RESERVED.contains(&lower.as_str()) {
                return Err(SurfaceError::Name { name: name.clone() });
            }
            let mask = mask_name(&lower);
            if !names.insert(lower) || !names.insert(mask) {
                return Err(SurfaceError::SameName { name: name.clone() });
            }
            let is_large = |value: &f64| value.abs() > f64::from(f32::MAX);
            if let Some(index) = values.iter().position(is_large) {
                return Err(SurfaceError::Value {
                    name: name.clone(),
                    index,
                    value: values[index],
                });
            }
        }
        Ok(())
    }
}

/// Name of the column that says where another one has values.
pub(super) fn mask_name(name: &str) -> String {
    format!("{name}_valid")
}

/// A number that a format writes in fewer bits.
///
/// # Errors
/// More than `most`.
pub(super) fn counted(
    format: &'static str,
    what: &'static str,
    found: u64,
    most: u64,
) -> Result<u32, SurfaceError> {
    match u32::try_from(found) {
        Ok(count) if found <= most => Ok(count),
        _ => Err(SurfaceError::TooLarge {
            format,
            what,
            found,
            most,
        }),
    }
}

//! glTF 2.0, binary: y up, in m, as the format requires.
//!
//! | part | content |
//! |---|---|
//! | header | `glTF`, version 2, length of the file |
//! | chunk `JSON` | what the bytes are, filled with spaces to a multiple of 4 |
//! | chunk `BIN` | the bytes: each list begins at a multiple of 4 |
//!
//! | attribute | content |
//! |---|---|
//! | `POSITION`, `NORMAL` | (x, z, -y) of a frame with z up; m, - |
//! | `COLOR_0` | linear, 16 bits each: sRGB is decoded |
//! | `_<NAME>` | a column, in the unit of its name; 0 where there is no value, because glTF has no NaN |
//! | `_<NAME>_VALID` | 1 where there is a value, else 0; only of columns with missing values |
//!
//! The material is rough and not metallic; its colour is that of the vertices. `asset.extras` has the title, and name, unit and attribute of each
//! column.
//!
//! Source: Khronos Group, glTF 2.0 Specification, sections 3.6 (accessors), 3.7 (meshes), 3.9.2 (vertex colour), 4.4 (GLB)
//! \[recalled\]; IEC 61966-2-1 (sRGB).

use armill_core::units::from_mm;
use serde_json::{Value, json};

use super::surface_table::{SurfaceError, SurfaceTable, counted, mask_name};

/// `glTF`, little endian.
const MAGIC: u32 = 0x4654_6c67;
const VERSION: u32 = 2;
const JSON_CHUNK: u32 = 0x4e4f_534a;
const BIN_CHUNK: u32 = 0x004e_4942;
/// Bytes of the header, and of the header of a chunk.
const HEADER_BYTES: u64 = 12;
const CHUNK_BYTES: u64 = 8;
/// Types of numbers.
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;
/// What a list is for.
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;
/// Roughness of the material: dull, so that colours are seen.
const ROUGHNESS: f64 = 0.9;

/// Lists of numbers: their bytes, and what the JSON says of them.
#[derive(Default)]
struct Lists {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

/// What a list is.
struct Kind {
    /// `SCALAR`, `VEC3`, `VEC4`
    shape: &'static str,
    component: u32,
    target: u32,
}

impl Lists {
    /// Adds a list, whose entries have a multiple of 4 bytes; gives its number.
    fn add<const BYTES: usize>(&mut self, kind: &Kind, values: impl Iterator<Item = [u8; BYTES]>) -> usize {
        let start = self.bytes.len();
        let mut count = 0;
        for value in values {
            self.bytes.extend_from_slice(&value);
            count += 1;
        }
        let number = self.views.len();
        self.views.push(json!({
            "buffer": 0, "byteOffset": start, "byteLength": self.bytes.len() - start, "target": kind.target,
        }));
        self.accessors.push(json!({
            "bufferView": number, "componentType": kind.component, "count": count, "type": kind.shape,
        }));
        number
    }

    fn scalars(&mut self, values: impl Iterator<Item = f32>) -> usize {
        let kind = Kind {
            shape: "SCALAR",
            component: FLOAT,
            target: VERTICES,
        };
        self.add(&kind, values.map(f32::to_le_bytes))
    }

    fn vectors(&mut self, values: impl Iterator<Item = [f32; 3]>) -> usize {
        let kind = Kind {
            shape: "VEC3",
            component: FLOAT,
            target: VERTICES,
        };
        self.add(&kind, values.map(bytes_of))
    }
}

/// The surface as a GLB file.
pub(super) fn write(surface: &SurfaceTable) -> Result<Vec<u8>, SurfaceError> {
    // The largest number marks a restart.
    let most = u64::from(u32::MAX) - 1;
    counted("glTF", "vertices", surface.vertices_mm.len() as u64, most)?;
    // Known before anything is written: 12 bytes of position, normal and triangle, 8 of a colour, 4 of a value and its mask.
    let per_vertex = 32 + 8 * surface.columns.len() as u64;
    let bytes = surface.vertices_mm.len() as u64 * per_vertex + surface.triangles.len() as u64 * 12;
    counted("glTF", "bytes", bytes, most)?;
    let mut lists = Lists::default();
    let mut attributes = serde_json::Map::new();
    let positions = surface.vertices_mm.iter().map(|at_mm| y_up(&at_mm.map(from_mm)));
    let [least, largest] = bounds(positions.clone());
    let position = lists.vectors(positions);
    lists.accessors[position]["min"] = json!(least);
    lists.accessors[position]["max"] = json!(largest);
    attributes.insert("POSITION".to_owned(), json!(position));
    let normal = lists.vectors(surface.normals.iter().map(y_up));
    attributes.insert("NORMAL".to_owned(), json!(normal));
    let colours = Kind {
        shape: "VEC4",
        component: UNSIGNED_SHORT,
        target: VERTICES,
    };
    let colour = lists.add(
        &colours,
        (0..surface.vertices_mm.len()).map(|vertex| linear_colour(surface.colour(vertex))),
    );
    lists.accessors[colour]["normalized"] = json!(true);
    attributes.insert("COLOR_0".to_owned(), json!(colour));
    let mut columns = Vec::new();
    for column in &surface.columns {
        let name = format!("_{}", column.name.to_uppercase());
        let known = |value: &f64| if value.is_nan() { 0.0 } else { *value as f32 };
        let list = lists.scalars(column.values.iter().map(known));
        attributes.insert(name.clone(), json!(list));
        if column.values.iter().any(|value| value.is_nan()) {
            let valid = column
                .values
                .iter()
                .map(|value| f32::from(u8::from(!value.is_nan())));
            let list = lists.scalars(valid);
            attributes.insert(mask_name(&name).to_uppercase(), json!(list));
        }
        columns.push(json!({ "name": column.name, "unit": column.unit, "attribute": name }));
    }
    let indices = Kind {
        shape: "SCALAR",
        component: UNSIGNED_INT,
        target: INDICES,
    };
    let corners = surface.triangles.as_flattened().iter();
    let indices = lists.add(&indices, corners.map(|corner| corner.to_le_bytes()));
    let extras = json!({ "title": surface.title, "length_unit": "m", "up": "+y", "columns": columns });
    let json = json!({
        "asset": { "version": "2.0", "generator": "armill", "extras": extras },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "name": surface.title }],
        "meshes": [{
            "name": surface.title,
            "primitives": [{ "attributes": attributes, "indices": indices, "material": 0, "mode": 4 }],
        }],
        "materials": [{
            "name": "values",
            "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": ROUGHNESS },
        }],
        "accessors": lists.accessors,
        "bufferViews": lists.views,
        "buffers": [{ "byteLength": lists.bytes.len() }],
    });
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    file(&text, &lists.bytes)
}

/// The file of both chunks, whose lengths are multiples of 4.
fn file(json: &[u8], bytes: &[u8]) -> Result<Vec<u8>, SurfaceError> {
    let length = HEADER_BYTES + 2 * CHUNK_BYTES + json.len() as u64 + bytes.len() as u64;
    let most = u64::from(u32::MAX);
    let length = counted("glTF", "bytes", length, most)?;
    let mut out = Vec::with_capacity(length as usize);
    for value in [MAGIC, VERSION, length] {
        out.extend_from_slice(&value.to_le_bytes());
    }
    for (kind, chunk) in [(JSON_CHUNK, json), (BIN_CHUNK, bytes)] {
        let count = counted("glTF", "bytes", chunk.len() as u64, most)?;
        out.extend_from_slice(&count.to_le_bytes());
        out.extend_from_slice(&kind.to_le_bytes());
        out.extend_from_slice(chunk);
    }
    Ok(out)
}

/// A vector of a frame with z up in one with y up.
fn y_up(&[x, y, z]: &[f64; 3]) -> [f32; 3] {
    // The sum makes 0 of -0.
    [x, z, -y].map(|value| value as f32 + 0.0)
}

fn bytes_of(vector: [f32; 3]) -> [u8; 12] {
    let mut bytes = [0; 12];
    for (place, value) in bytes.chunks_exact_mut(4).zip(vector) {
        place.copy_from_slice(&value.to_le_bytes());
    }
    bytes
}

/// Least and largest of each coordinate, as they are written.
fn bounds(vectors: impl Iterator<Item = [f32; 3]>) -> [[f32; 3]; 2] {
    let start = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
    vectors.fold(start, |[least, largest], vector| {
        [
            [0, 1, 2].map(|k| least[k].min(vector[k])),
            [0, 1, 2].map(|k| largest[k].max(vector[k])),
        ]
    })
}

/// A colour of a screen as linear numbers of 16 bits, opaque.
fn linear_colour(colour: [u8; 3]) -> [u8; 8] {
    let most = f64::from(u16::MAX);
    let linear = colour.map(|value| {
        let value = f64::from(value) / f64::from(u8::MAX);
        let linear = if value <= 0.04045 {
            value / 12.92
        } else {
            ((value + 0.055) / 1.055).powf(2.4)
        };
        (linear * most).round() as u16
    });
    let mut bytes = [0xff; 8];
    for (place, value) in bytes.chunks_exact_mut(2).zip(linear) {
        place.copy_from_slice(&value.to_le_bytes());
    }
    bytes
}

use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::Value;

use super::surface_table::counted;
use super::*;
use crate::mesh;

/// A tetrahedron with three right angles at (10, 20, 30) mm; the last vertex has no height.
fn tetrahedron() -> SurfaceTable {
    let third = 1.0 / 3.0_f64.sqrt();
    SurfaceTable {
        title: "Face of a part, \"a\"\u{b5}\n<b>".to_owned(),
        vertices_mm: vec![
            [10.0, 20.0, 30.0],
            [14.0, 20.0, 30.0],
            [10.0, 28.0, 30.0],
            [10.0, 20.0, 46.0],
        ],
        normals: vec![[-third; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        columns: vec![
            SurfaceColumn {
                name: "deviation_um".to_owned(),
                unit: Some("um".to_owned()),
                values: vec![1.5, -2.0, 0.25, f64::NAN],
            },
            SurfaceColumn {
                name: "move".to_owned(),
                unit: None,
                values: vec![0.0, 1.0, 2.0, 3.0],
            },
        ],
        colours: Some(vec![[255, 0, 0], [0, 255, 0], [0, 0, 255], [188, 10, 128]]),
    }
}

fn f32_at(bytes: &[u8], at: usize) -> f32 {
    f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
}

/// The triangles of a mesh by their corners, in any order of triangles and from any corner.
fn corners_of(mesh: &mesh::TriangleMesh) -> Vec<[[f64; 3]; 3]> {
    let of = |triangle: &[u32; 3]| {
        let mut corners = triangle.map(|vertex| mesh.vertices[vertex as usize]);
        let least = (0..3)
            .min_by(|i, j| corners[*i].partial_cmp(&corners[*j]).unwrap())
            .unwrap();
        corners.rotate_left(least);
        corners
    };
    let mut all: Vec<_> = mesh.triangles.iter().map(of).collect();
    all.sort_by(|a, b| a.partial_cmp(b).unwrap());
    all
}

#[test]
fn stl_and_ply_are_read_back_with_the_same_triangles() {
    let surface = tetrahedron();
    let expected = mesh::TriangleMesh {
        vertices: surface.vertices_mm.clone(),
        triangles: surface.triangles.clone(),
        ..mesh::TriangleMesh::default()
    };
    for format in [SurfaceFormat::Stl, SurfaceFormat::Ply] {
        let bytes = format.write(&surface).unwrap();
        let found = mesh::read(&format!("a.{}", format.ending()), &bytes).unwrap();
        assert_eq!(corners_of(&found), corners_of(&expected), "{format:?}");
        assert!(found.notes.is_empty(), "{:?}", found.notes);
        let report = found.report();
        // 4 x 8 x 16 / 6 mm^3, counter-clockwise from outside.
        assert!((report.volume - 512.0 / 6.0).abs() < 1e-9, "{report:?}");
    }
}

#[test]
fn stl_has_the_normals_of_its_triangles_and_no_word_that_marks_text() {
    let bytes = SurfaceFormat::Stl.write(&tetrahedron()).unwrap();
    assert_eq!(bytes.len(), 84 + 4 * 50);
    assert!(bytes.starts_with(b"armill, mm: Face of a part, \"a\"??<b>   "));
    assert_eq!(u32_at(&bytes, 80), 4);
    assert_eq!([0, 4, 8].map(|at| f32_at(&bytes, 84 + at)), [0.0, 0.0, -1.0]);
    // x/4 + y/8 + z/16 = 1: its normal is along (4, 2, 1).
    let length = 21.0_f32.sqrt();
    let last = [0, 4, 8].map(|at| f32_at(&bytes, 84 + 150 + at) * length);
    for (found, expected) in last.into_iter().zip([4.0, 2.0, 1.0]) {
        assert!((found - expected).abs() < 1e-6);
    }
}

#[test]
fn ply_has_normals_colours_and_values_with_their_units() {
    let bytes = SurfaceFormat::Ply.write(&tetrahedron()).unwrap();
    let end = b"end_header\n";
    let start = bytes.windows(end.len()).position(|part| part == end).unwrap() + end.len();
    let header = std::str::from_utf8(&bytes[..start]).unwrap();
    assert_eq!(
        header,
        "ply\nformat binary_little_endian 1.0\ncomment Face of a part, \"a\"??<b>\ncomment x, y, z in mm\ncomment deviation_um in um\n\
         comment move in a number\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\n\
         property float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
         property float deviation_um\nproperty float move\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    );
    let row = 24 + 3 + 8;
    assert_eq!(bytes.len(), start + 4 * row + 4 * 13);
    let vertex = |n: usize| &bytes[start + n * row..][..row];
    assert_eq!([0, 4, 8].map(|at| f32_at(vertex(1), at)), [14.0, 20.0, 30.0]);
    assert_eq!([12, 16, 20].map(|at| f32_at(vertex(1), at)), [1.0, 0.0, 0.0]);
    assert_eq!(vertex(3)[24..27], [188, 10, 128]);
    assert_eq!([27, 31].map(|at| f32_at(vertex(1), at)), [-2.0, 1.0]);
    assert!(f32_at(vertex(3), 27).is_nan());
    let plain = SurfaceTable {
        colours: None,
        ..tetrahedron()
    };
    let bytes = SurfaceFormat::Ply.write(&plain).unwrap();
    assert_eq!(bytes[start + 24..start + 27], [0xb4; 3]);
}

#[test]
fn vtp_has_triangles_normals_values_and_masks() {
    let text = String::from_utf8(SurfaceFormat::Vtp.write(&tetrahedron()).unwrap()).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let piece = document
        .descendants()
        .find(|node| node.has_tag_name("Piece"))
        .unwrap();
    assert_eq!(
        ["NumberOfPoints", "NumberOfPolys"].map(|name| piece.attribute(name)),
        [Some("4"), Some("4")]
    );
    let array = |name: &str, parent: &str| {
        let is_it = |node: &roxmltree::Node| {
            node.attribute("Name") == Some(name)
                && node.parent().is_some_and(|above| above.has_tag_name(parent))
        };
        let node = document.descendants().find(is_it).unwrap();
        STANDARD.decode(node.text().unwrap().trim()).unwrap()[8..].to_vec()
    };
    let connectivity = array("connectivity", "Polys");
    let found: Vec<u32> = (0..12).map(|n| u32_at(&connectivity, 4 * n)).collect();
    assert_eq!(found, tetrahedron().triangles.concat());
    let values = array("deviation_um", "PointData");
    assert_eq!([0, 4, 8].map(|at| f32_at(&values, at)), [1.5, -2.0, 0.25]);
    assert!(f32_at(&values, 12).is_nan());
    assert_eq!(array("deviation_um_valid", "PointData"), [1, 1, 1, 0]);
    let normals = array("normal", "PointData");
    assert_eq!([12, 16, 20].map(|at| f32_at(&normals, at)), [1.0, 0.0, 0.0]);
}

/// JSON and bytes of a GLB file, by its chunks.
fn chunks(bytes: &[u8]) -> (Value, Vec<u8>) {
    assert_eq!(&bytes[..4], b"glTF");
    assert_eq!([u32_at(bytes, 4), u32_at(bytes, 8)], [2, bytes.len() as u32]);
    let json_bytes = u32_at(bytes, 12) as usize;
    assert_eq!((json_bytes % 4, &bytes[16..20]), (0, b"JSON".as_slice()));
    let json = serde_json::from_slice(&bytes[20..20 + json_bytes]).unwrap();
    let rest = &bytes[20 + json_bytes..];
    assert_eq!(
        (rest.len() - 8, &rest[4..8]),
        (u32_at(rest, 0) as usize, b"BIN\0".as_slice())
    );
    assert_eq!(rest.len() % 4, 0);
    (json, rest[8..].to_vec())
}

/// The bytes of an accessor.
fn list<'a>(json: &Value, bytes: &'a [u8], accessor: &Value) -> &'a [u8] {
    let accessor = &json["accessors"][accessor.as_u64().unwrap() as usize];
    let view = &json["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
    let [start, length] = ["byteOffset", "byteLength"].map(|key| view[key].as_u64().unwrap() as usize);
    assert_eq!(start % 4, 0);
    &bytes[start..start + length]
}

#[test]
fn glb_has_metres_with_y_up_linear_colours_and_masks() {
    let (json, bytes) = chunks(&SurfaceFormat::Glb.write(&tetrahedron()).unwrap());
    assert_eq!(json["buffers"][0]["byteLength"], bytes.len());
    let primitive = &json["meshes"][0]["primitives"][0];
    let attribute = |name: &str| list(&json, &bytes, &primitive["attributes"][name]);
    let positions = attribute("POSITION");
    // (14, 20, 30) mm with z up: (14, 30, -20) mm with y up.
    for (at, expected) in [(12, 0.014), (16, 0.030), (20, -0.020)] {
        assert!((f32_at(positions, at) - expected).abs() < 1e-8);
    }
    let accessor = &json["accessors"][primitive["attributes"]["POSITION"].as_u64().unwrap() as usize];
    for (key, expected) in [("min", [0.010, 0.030, -0.028]), ("max", [0.014, 0.046, -0.020])] {
        for (k, expected) in expected.into_iter().enumerate() {
            let found = accessor[key][k].as_f64().unwrap();
            assert!((found - expected).abs() < 1e-8);
            // In 32 bits exactly a number of the list.
            assert!((0..4).any(|vertex| f32_at(positions, 12 * vertex + 4 * k) == found as f32));
        }
    }
    assert_eq!(
        [36, 40, 44].map(|at| f32_at(attribute("NORMAL"), at)),
        [0.0, 1.0, 0.0]
    );
    let colours = attribute("COLOR_0");
    let of = |at: usize| u16::from_le_bytes(colours[at..at + 2].try_into().unwrap());
    assert_eq!([0, 2, 4, 6].map(of), [65535, 0, 0, 65535]);
    // sRGB 188 is 0.50289 linear, 10 is 0.0030353, 128 is 0.21586 (IEC 61966-2-1).
    for (at, expected) in [(24, 0.50289), (26, 0.003_035_3), (28, 0.21586)] {
        assert!(
            (f64::from(of(at)) / 65535.0 - expected).abs() < 1e-5,
            "{}",
            of(at)
        );
    }
    let values = attribute("_DEVIATION_UM");
    assert_eq!([0, 4, 8, 12].map(|at| f32_at(values, at)), [1.5, -2.0, 0.25, 0.0]);
    let valid = attribute("_DEVIATION_UM_VALID");
    assert_eq!([0, 4, 8, 12].map(|at| f32_at(valid, at)), [1.0, 1.0, 1.0, 0.0]);
    assert_eq!(primitive["attributes"]["_MOVE_VALID"], Value::Null);
    let indices = list(&json, &bytes, &primitive["indices"]);
    let found: Vec<u32> = (0..12).map(|n| u32_at(indices, 4 * n)).collect();
    assert_eq!(found, tetrahedron().triangles.concat());
    let extras = &json["asset"]["extras"];
    assert_eq!(extras["title"], tetrahedron().title);
    assert_eq!(extras["columns"][0]["unit"], "um");
    assert_eq!(extras["columns"][0]["attribute"], "_DEVIATION_UM");
}

#[test]
fn surfaces_that_do_not_fit_are_refused() {
    let refused = |change: &dyn Fn(&mut SurfaceTable)| {
        let mut surface = tetrahedron();
        change(&mut surface);
        let messages = SurfaceFormat::ALL.map(|format| format.write(&surface).unwrap_err().to_string());
        assert!(messages.iter().all(|message| *message == messages[0]));
        messages[0].clone()
    };
    assert_eq!(refused(&|s| s.triangles.clear()), "the surface has no triangles");
    assert_eq!(
        refused(&|s| s.triangles[2][1] = 4),
        "triangle 2 names vertex 4: there are 4"
    );
    assert!(refused(&|s| s.vertices_mm[1][2] = f64::NAN).starts_with("vertex 1 is at (14, 20, NaN) mm"));
    assert!(refused(&|s| s.vertices_mm[0][0] = 1e10).contains("between -1e9 and 1e9"));
    assert!(refused(&|s| s.normals[3] = [0.0; 3]).starts_with("the normal of vertex 3 is (0, 0, 0)"));
    assert!(refused(&|s| s.normals[3][0] = f64::NAN).contains("must have the length 1"));
    assert_eq!(
        refused(&|s| s.normals.truncate(1)),
        "the list of normals has 1 entries: there are 4 vertices"
    );
    assert!(refused(&|s| s.colours = Some(vec![[0; 3]])).contains("the list of colours has 1"));
    assert!(refused(&|s| s.columns[1].values.push(0.0)).contains("column `move` has 5 entries"));
    for name in ["", "a b", "\u{b5}", "nx", "Red", "a\n"] {
        let message = refused(&|s| s.columns[0].name = name.to_owned());
        assert!(message.contains("is not a valid name of a column"), "{message}");
    }
    for name in ["MOVE", "move_valid"] {
        let message = refused(&|s| s.columns[0].name = name.to_owned());
        assert!(message.starts_with("two columns are called"), "{message}");
    }
    assert!(
        refused(&|s| s.columns[0].values[2] = f64::INFINITY)
            .contains("column `deviation_um` is inf at vertex 2")
    );
    assert!(refused(&|s| s.columns[0].values[2] = 1e39).contains("at vertex 2"));
}

#[test]
fn more_than_a_format_counts_is_refused() {
    assert_eq!(
        counted("PLY", "vertices", 2_147_483_647, 2_147_483_647),
        Ok(2_147_483_647)
    );
    let message = counted("PLY", "vertices", 2_147_483_648, 2_147_483_647)
        .unwrap_err()
        .to_string();
    assert_eq!(
        message,
        "the file has 2147483648 vertices: PLY has at most 2147483647; use a mesh with fewer triangles"
    );
    // No length of 64 bits is cut to 32.
    assert!(counted("glTF", "bytes", u64::from(u32::MAX) + 5, u64::MAX).is_err());
}

#[test]
fn endings_give_the_format() {
    for format in SurfaceFormat::ALL {
        let path = format!("a/b.{}", format.ending().to_uppercase());
        assert_eq!(SurfaceFormat::of_path(Path::new(&path)), Some(format));
    }
    assert_eq!(SurfaceFormat::of_path(Path::new("a.step")), None);
}

use super::super::report::MeshReport;
use super::super::solids::{cube, tetrahedron};
use super::super::unit::{MeshUnit, likely_unit};
use super::*;

/// A binary file with this header.
fn binary(header: &str, triangles: &[[[f64; 3]; 3]]) -> Vec<u8> {
    let mut bytes = header.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for corners in triangles {
        bytes.extend([0; 12]);
        for value in corners.as_flattened() {
            bytes.extend((*value as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

fn ascii(triangles: &[[[f64; 3]; 3]]) -> String {
    let mut text = "solid a cube\n".to_owned();
    for corners in triangles {
        text += "  facet normal 0 0 0\n    outer loop\n";
        for [x, y, z] in corners {
            text += &format!("      vertex {x:e} {y} {z}\n");
        }
        text += "    endloop\n  endfacet\n";
    }
    text + "endsolid a cube\n"
}

fn report(bytes: &[u8]) -> MeshReport {
    read("a.stl", bytes).unwrap().report()
}

fn refused(bytes: &[u8]) -> String {
    read("a.stl", bytes).unwrap_err().to_string()
}

#[test]
fn a_cube_is_read_from_both_forms_with_its_volume_and_bounds() {
    let faces = cube(2.5, [1.0, -4.0, 0.5]);
    for bytes in [binary("", &faces), ascii(&faces).into_bytes()] {
        let found = report(&bytes);
        assert_eq!((found.min, found.max), ([1.0, -4.0, 0.5], [3.5, -1.5, 3.0]));
        assert!((found.volume - 15.625).abs() < 1e-13 && (found.area - 37.5).abs() < 1e-13);
        assert!(found.is_closed && found.is_oriented && found.triangles == 12);
        assert_eq!(read("a.stl", &bytes).unwrap().vertices.len(), 8);
    }
}

#[test]
fn a_header_that_begins_with_solid_does_not_make_a_binary_file_ascii() {
    for header in ["solid part", "stlbn part", "SOLID facet endsolid"] {
        assert_eq!(
            report(&binary(header, &tetrahedron(3.0))).triangles,
            4,
            "{header}"
        );
    }
}

#[test]
fn all_digits_of_an_ascii_file_are_kept() {
    let text = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0.1 0 0\nvertex 1 0.30000000000000004 0\n\
                vertex 0 1 0\nendloop\nendfacet\nendsolid";
    let mesh = read("a.stl", text.as_bytes()).unwrap();
    assert_eq!(
        mesh.vertices[..2],
        [[0.1, 0.0, 0.0], [1.0, 0.30000000000000004, 0.0]]
    );
}

#[test]
fn several_solids_capitals_and_all_line_ends_are_read() {
    let one = ascii(&cube(1.0, [0.0; 3]));
    let two = one.to_uppercase() + "\r\n" + &ascii(&cube(1.0, [5.0, 0.0, 0.0])).replace('\n', "\r\n");
    let found = report(two.as_bytes());
    assert_eq!((found.triangles, found.max), (24, [6.0, 1.0, 1.0]));
    assert_eq!(report(one.replace('\n', "\r").as_bytes()).triangles, 12);
}

#[test]
fn every_line_that_is_wrong_is_reported() {
    let text = ascii(&cube(1.0, [0.0; 3]));
    let given = refused(text.replacen("vertex 0e0 0 0", "vertex 0e0 0,5 0", 2).as_bytes());
    assert!(given.contains("a.stl:4:18: `0,5` is not a number"), "{given}");
    assert_eq!(given.matches("error:").count(), 2, "{given}");
    let given = refused(text.replacen("vertex 0e0 0 0", "vertex 0e0 nan", 1).as_bytes());
    assert!(
        given.contains("a.stl:4:18: NaN is not a finite number"),
        "{given}"
    );
    let given = refused(text.replacen("vertex 0e0 0 0", "vertex 0e0 0", 1).as_bytes());
    assert!(given.contains("a.stl:4:1: 2 coordinates: 3 required"), "{given}");
    let given = refused(text.replacen("    endloop\n", "vertex 0 0 0\n", 1).as_bytes());
    assert!(
        given.contains("a.stl:8:3: a facet with 4 vertices: 3 required"),
        "{given}"
    );
    let given = refused(text.replacen("  endfacet\n", "", 1).as_bytes());
    assert!(given.contains("`facet` is not expected here"), "{given}");
    let given = refused(text.replacen("outer loop", "outer_loop", 1).as_bytes());
    assert!(
        given.contains("a.stl:3:5: `outer_loop` is not expected here"),
        "{given}"
    );
}

#[test]
fn a_file_that_is_cut_short_says_so() {
    let bytes = binary("part", &cube(1.0, [0.0; 3]));
    let given = refused(&bytes[..300]);
    let expected = "the header announces 12 triangles, which need 684 bytes, but the file has 300";
    assert!(given.contains(expected), "{given}");
    assert!(refused(&bytes[..50]).contains("50 bytes are neither ASCII STL nor the header of a binary one"));
    let text = ascii(&cube(1.0, [0.0; 3]));
    let given = refused(&text.as_bytes()[..400]);
    assert!(
        given.contains("a.stl:23:1: the file ends inside facet 4"),
        "{given}"
    );
}

#[test]
fn a_number_of_triangles_that_is_too_large_takes_no_memory() {
    let mut bytes = binary("part", &cube(1.0, [0.0; 3]));
    bytes[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(refused(&bytes).contains("announces 4294967295 triangles, which need 214748364834 bytes"));
}

#[test]
fn a_coordinate_that_is_not_finite_is_reported_with_its_triangle_and_byte() {
    let mut bytes = binary("part", &cube(1.0, [0.0; 3]));
    for (triangle, value) in [(3, f32::NAN), (7, f32::INFINITY), (9, 1e30)] {
        let at = 84 + 50 * triangle + 12;
        bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
    }
    let given = refused(&bytes);
    assert!(
        given.contains("triangle 4 of 12, byte 234: NaN is not a finite number"),
        "{given}"
    );
    assert!(
        given.contains("triangle 8 of 12, byte 434: inf is not a finite number"),
        "{given}"
    );
    assert!(
        given.contains("triangle 10 of 12, byte 534: 1.0000000150474662e30 exceeds"),
        "{given}"
    );
}

#[test]
fn bytes_behind_the_last_triangle_are_noted() {
    let mut bytes = binary("part", &cube(1.0, [0.0; 3]));
    bytes.extend([0; 7]);
    let mesh = read("a.stl", &bytes).unwrap();
    assert_eq!(mesh.notes, ["7 bytes behind the last triangle were not used"]);
    assert_eq!(
        (mesh.unit, likely_unit(mesh.longest_side())),
        (None, Some(MeshUnit::METRE))
    );
}

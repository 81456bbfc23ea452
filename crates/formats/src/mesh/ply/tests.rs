use super::super::report::MeshReport;
use super::*;

const ASCII: &str = "ply\nformat ascii 1.0\ncomment a cube\nelement vertex 8\nproperty uchar red\nproperty float z\n\
                     property double x\nproperty float32 y\nelement face 6\nproperty list uchar int vertex_indices\n\
                     property list uchar float texture\nelement edge 1\nproperty int first\nend_header\n\
                     255 0 0 0\n255 0 2 0\n255 0 2 2\n255 0 0 2\n255 2 0 0\n255 2 2 0\n255 2 2 2\n255 2 0 2\n\
                     4 0 3 2 1 0\n4 4 5 6 7 1 0.5\n4 0 1 5 4 0\n4 1 2 6 5 0\n4 2 3 7 6 0\n4 3 0 4 7 0\n7\n";

fn report(bytes: &[u8]) -> MeshReport {
    read("a.ply", bytes).unwrap().report()
}

fn refused(bytes: &[u8]) -> String {
    read("a.ply", bytes).unwrap_err().to_string()
}

/// A binary cube of side 2: vertices of shorts behind faces of indices of one byte.
fn binary(is_big: bool) -> Vec<u8> {
    let order = if is_big { "big" } else { "little" };
    let mut bytes = format!(
        "ply\nformat binary_{order}_endian 1.0\nelement face 6\nproperty int16 flag\nproperty list uint32 uint8 vertex_index\n\
         element vertex 8\nproperty double x\nproperty int16 y\nproperty list uchar float64 more\nproperty float z\nend_header\n"
    )
    .into_bytes();
    let mut put = |little: &[u8]| {
        let mut part = little.to_vec();
        if is_big {
            part.reverse();
        }
        bytes.extend(part);
    };
    for face in [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5_u8],
    ] {
        put(&(-7_i16).to_le_bytes());
        put(&4_u32.to_le_bytes());
        face.iter().for_each(|corner| put(&[*corner]));
    }
    for corner in 0..8_u8 {
        put(&(f64::from(corner & 1) * 2.0).to_le_bytes());
        put(&(i16::from(corner >> 1 & 1) * 2 - 1).to_le_bytes());
        put(&[1]);
        put(&f64::NAN.to_le_bytes());
        put(&(f32::from(corner >> 2) * 2.0).to_le_bytes());
    }
    bytes
}

#[test]
fn a_cube_is_read_from_all_encodings() {
    let ascii = ASCII.as_bytes().to_vec();
    let returns = ASCII.replace('\n', "\r\n").into_bytes();
    for (bytes, low) in [
        (ascii, 0.0),
        (returns, 0.0),
        (binary(false), -1.0),
        (binary(true), -1.0),
    ] {
        let found = report(&bytes);
        assert_eq!(
            (found.triangles, found.min, found.max),
            (12, [0.0, low, 0.0], [2.0, low + 2.0, 2.0])
        );
        assert!(found.is_closed && found.is_oriented, "{found:?}");
        assert!((found.volume - 8.0).abs() < 1e-14, "{found:?}");
    }
}

#[test]
fn rows_of_text_that_are_wrong_are_reported_at_their_line() {
    let given = refused(ASCII.replace("4 0 1 5 4 0\n", "4 0 1 8 4 0\n").as_bytes());
    assert!(
        given.contains("a.ply:25:1: face 3 of 6: no vertex has the index 8: the file has 8 vertices"),
        "{given}"
    );
    let given = refused(ASCII.replace("4 0 1 5 4 0\n", "2 0 1 0\n").as_bytes());
    assert!(
        given.contains("face 3 of 6: a face with 2 corners: at least 3 required"),
        "{given}"
    );
    let given = refused(ASCII.replace("255 0 2 2\n", "255 0 2 nan\n").as_bytes());
    assert!(
        given.contains("a.ply:17:1: vertex 3 of 8: NaN is not a finite number"),
        "{given}"
    );
    let given = refused(ASCII.replace("255 0 2 2\n", "255 0 2 2 9\n").as_bytes());
    assert!(
        given.contains("a.ply:17:1: vertex 3 of 8: `9` exceeds the properties of the header"),
        "{given}"
    );
    let given = refused(ASCII.replace("255 0 2 2\n", "255 0 two 2\n").as_bytes());
    assert!(
        given.contains("a.ply:17:1: vertex 3 of 8: `two` is not a number"),
        "{given}"
    );
    let given = refused(ASCII.replace("4 0 1 5 4 0\n", "-4 0 1 5 4 0\n").as_bytes());
    assert!(given.contains("-4 is not a number of values"), "{given}");
    let given = refused(ASCII.strip_suffix("4 3 0 4 7 0\n7\n").unwrap().as_bytes());
    assert!(
        given.contains("a.ply:27:1: the file ends before face 6 of 6"),
        "{given}"
    );
}

#[test]
fn rows_of_bytes_that_are_wrong_are_reported_at_their_byte() {
    let bytes = binary(true);
    let header = bytes
        .windows(11)
        .position(|part| part == b"end_header\n")
        .unwrap()
        + 11;
    let mut wrong = bytes.clone();
    wrong[header + 10 + 6 + 1] = 8;
    let given = refused(&wrong);
    let expected = format!("byte {}: face 2 of 6: no vertex has the index 8", header + 10);
    assert!(given.contains(&expected), "{given}");
    let given = refused(&bytes[..bytes.len() - 1]);
    assert!(given.contains("the file ends before vertex 8 of 8"), "{given}");
    let mut wrong = bytes.clone();
    wrong[header + 2..header + 6].copy_from_slice(&[255; 4]);
    assert!(refused(&wrong).contains("the file ends before face 1 of 6"));
}

#[test]
fn counts_of_a_header_that_are_too_large_end_at_the_end_of_the_file() {
    for (from, to) in [
        ("element vertex 8", "element vertex 18446744073709551615"),
        ("element face 6", "element face 4000000000"),
    ] {
        let given = refused(ASCII.replace(from, to).as_bytes());
        assert!(
            given.contains("is not a number") || given.contains("exceeds") || given.contains("ends before"),
            "{given}"
        );
    }
    // An element without properties has no bytes.
    let empty = ASCII.replace(
        "element vertex",
        "element nothing 18446744073709551615\nelement vertex",
    );
    assert_eq!(report(empty.as_bytes()).triangles, 12);
}

#[test]
fn headers_that_are_wrong_are_reported() {
    for (from, to, expected) in [
        (
            "ply\n",
            "plx\n",
            "a.ply:1:1: the first line of a PLY file is `ply`",
        ),
        ("ascii", "xml", "the format `xml` is not known"),
        (
            "vertex 8",
            "vertex eight",
            "a.ply:4:1: `eight` is not a number of elements",
        ),
        ("double x", "number x", "the type `number` is not known"),
        ("list uchar int", "list float int", "is of a whole type"),
        ("element vertex 8\n", "", "a property before the first element"),
        (
            "property double x",
            "property double w",
            "the vertices have no property `x`",
        ),
        (
            "vertex_indices",
            "indices",
            "the faces have no list `vertex_indices`",
        ),
        (
            "element face",
            "element tristrips",
            "triangle strips are not read",
        ),
        (
            "element face",
            "element faces",
            "the header has 0 elements `face`: 1 required",
        ),
        (
            "element edge",
            "element vertex",
            "the header has 2 elements `vertex`: 1 required",
        ),
        ("end_header", "end", "not a line of the header of a PLY file"),
        ("format ascii 1.0\n", "", "the header has no line `format`"),
    ] {
        let given = refused(ASCII.replacen(from, to, 1).as_bytes());
        assert!(given.contains(expected), "{expected}\n{given}");
    }
    assert!(refused(b"ply\nformat ascii 1.0\n").contains("no line `end_header`"));
}

#[test]
fn what_follows_the_last_element_is_noted() {
    let mesh = read("a.ply", (ASCII.to_owned() + "1 2 3\n").as_bytes()).unwrap();
    assert_eq!(
        mesh.notes,
        ["what follows the last element of the header was not used"]
    );
}

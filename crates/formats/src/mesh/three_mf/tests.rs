use std::io::Write;

use flate2::Compression;
use flate2::write::DeflateEncoder;
use rawzip::{CompressionMethod, ZipArchiveWriter};

use super::super::report::MeshReport;
use super::super::solids::{cube, mesh_of};
use super::*;

const RELATIONSHIPS: &str = "<?xml version='1.0'?><Relationships xmlns='http://schemas.openxmlformats.org/package/2006/relationships'>\
    <Relationship Target='/3D/3dmodel.model' Id='rel0' Type='http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel'/></Relationships>";

/// An archive of these parts.
fn archive(parts: &[(&str, &str)]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut archive = ZipArchiveWriter::new(&mut bytes);
    for (path, text) in parts {
        let new = archive
            .new_file(path)
            .compression_method(CompressionMethod::DEFLATE);
        let (mut entry, config) = new.start().unwrap();
        let mut writer = config.wrap(DeflateEncoder::new(&mut entry, Compression::default()));
        writer.write_all(text.as_bytes()).unwrap();
        let (encoder, descriptor) = writer.finish().unwrap();
        encoder.finish().unwrap();
        entry.finish(descriptor).unwrap();
    }
    archive.finish().unwrap();
    bytes
}

/// A model in this unit with a cube of side 2 as object 1, further objects and the items of its build.
fn model(unit: &str, objects: &str, items: &str) -> String {
    let cube = mesh_of(&cube(2.0, [0.0; 3]));
    let vertex = |[x, y, z]: &[f64; 3]| format!("<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\" />\n");
    let triangle = |[a, b, c]: &[u32; 3]| format!("<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\" p1=\"0\"/>\n");
    let vertices: String = cube.vertices.iter().map(vertex).collect();
    let triangles: String = cube.triangles.iter().map(triangle).collect();
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model {unit} xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" \
         xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" requiredextensions=\"p\">\n\
         <metadata name=\"Title\">cube &amp; more</metadata><resources>\n<object id=\"1\" type=\"model\"><mesh>\n\
         <vertices>\n{vertices}</vertices>\n<triangles>\n{triangles}</triangles>\n</mesh></object>\n{objects}</resources>\n\
         <build>{items}</build></model>"
    )
}

fn one(model: &str) -> Vec<u8> {
    archive(&[
        ("[Content_Types].xml", "<Types/>"),
        ("_rels/.rels", RELATIONSHIPS),
        ("3D/3dmodel.model", model),
    ])
}

fn report(bytes: &[u8]) -> MeshReport {
    read("a.3mf", bytes).unwrap().report()
}

fn refused(bytes: &[u8]) -> String {
    read("a.3mf", bytes).unwrap_err().to_string()
}

const ITEM: &str = "<item objectid=\"1\"/>";

#[test]
fn a_cube_is_read_with_its_unit() {
    for (unit, metres) in [("unit=\"inch\"", 0.0254), ("", 1e-3), ("unit='meter'", 1.0)] {
        let mesh = read("a.3mf", &one(&model(unit, "", ITEM))).unwrap();
        let found = mesh.report();
        assert!(
            found.is_closed && found.is_oriented && (found.volume - 8.0).abs() < 1e-14,
            "{found:?}"
        );
        let given = mesh.unit.unwrap().metres();
        assert!((given - metres).abs() < 1e-15 * metres, "{given}");
    }
}

#[test]
fn items_and_components_are_placed_by_their_transforms() {
    // A quarter turn about z and a shift, within an assembly that is scaled by 3 and mirrored in z.
    let objects = "<object id=\"2\"><components><component objectid=\"1\" transform=\"0 1 0 -1 0 0 0 0 1 10 0 0\"/>\
                   <component objectid=\"1\"/></components></object>";
    let items = "<item objectid=\"2\" transform=\"3 0 0 0 3 0 0 0 -3 0 100 0\"/><item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 -9 0 0\"/>";
    let found = report(&one(&model("", objects, items)));
    // By hand: the turned cube has x 8..10, y 0..2; scaled x 24..30, y 100..106, z -6..0; the other one x 0..6.
    assert_eq!(
        (found.triangles, found.min, found.max),
        (36, [-9.0, 0.0, -6.0], [30.0, 106.0, 2.0])
    );
    let volume = 8.0 + 2.0 * 8.0 * 27.0;
    assert!((found.volume - volume).abs() < volume * 1e-14, "{found:?}");
    assert!(found.is_closed && found.is_oriented);
}

#[test]
fn objects_of_other_models_are_read_and_supports_left_out() {
    let items = "<item objectid=\"1\" p:path=\"/3D/Objects/Part.model\" transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/><item objectid=\"3\"/>";
    let support =
        "<object id=\"3\" type=\"support\"><components><component objectid=\"1\"/></components></object>";
    let main = model("", support, items);
    let other = model("", "", "");
    let parts = [
        ("_rels/.rels", RELATIONSHIPS),
        ("3D/3dmodel.model", main.as_str()),
        ("3D/Objects/Part.model", &other),
    ];
    let mesh = read("a.3mf", &archive(&parts)).unwrap();
    assert_eq!(mesh.bounds(), [[5.0, 0.0, 0.0], [7.0, 2.0, 2.0]]);
    assert_eq!(mesh.notes, ["1 support structures of the file are left out"]);
    assert!(
        refused(&archive(&parts[..2]))
            .contains("part `3d/objects/part.model`: the archive does not contain it")
    );
    let inches = model("unit=\"inch\"", "", "");
    let given = refused(&archive(&[
        parts[0],
        parts[1],
        ("3D/Objects/Part.model", &inches),
    ]));
    assert!(given.contains("has another unit than"), "{given}");
}

#[test]
fn elements_that_are_wrong_are_reported_with_their_line() {
    let good = model("unit=\"inch\"", "", ITEM);
    for (from, to, expected) in [
        (
            "unit=\"inch\"",
            "unit=\"mile\"",
            "`3d/3dmodel.model`, line 2: `mile` is not a unit of 3MF",
        ),
        (
            "x=\"2\" y=\"2\" z=\"0\"",
            "x=\"2\" y=\"nan\" z=\"0\"",
            "line 8: attribute `y`: NaN is not a finite number",
        ),
        (
            "x=\"2\" y=\"2\" z=\"0\"",
            "x=\"2\" y=\"2\"",
            "line 8: <vertex> has no attribute `z`",
        ),
        (
            "v1=\"0\"",
            "v1=\"8\"",
            "triangle 1 of object 1: no vertex has the index 8: the object has 8",
        ),
        (
            "v1=\"0\"",
            "v1=\"-1\"",
            "attribute `v1`: `-1` is not a whole number",
        ),
        (
            "objectid=\"1\"",
            "objectid=\"7\"",
            "object 7: `3d/3dmodel.model` has no such object",
        ),
        (
            "objectid=\"1\"",
            "objectid=\"1\" transform=\"1 0 0\"",
            "a transform of 3 numbers: 12 required",
        ),
        ("</mesh>", "</mash>", "not XML"),
        (
            "<model",
            "<!DOCTYPE a [<!ENTITY b \"c\">]><model",
            "a document type definition is not accepted",
        ),
        (
            "production/2015/06",
            "secure/2019/04",
            "the model requires the extension",
        ),
        (ITEM, "", "the mesh has no triangles"),
    ] {
        let given = refused(&one(&good.replacen(from, to, 1)));
        assert!(given.contains(expected), "{expected}\n{given}");
    }
    assert!(refused(&one("<a/>")).contains("the first element of a 3MF model is <model>"));
    assert!(refused(&one("")).contains("not a 3MF model"));
}

#[test]
fn objects_in_objects_end_at_a_limit() {
    // Each object is ten of the one before: 10^12 cubes.
    let mut objects = String::new();
    for id in 2..14 {
        let component = format!("<component objectid=\"{}\"/>", id - 1).repeat(10);
        objects += &format!("<object id=\"{id}\"><components>{component}</components></object>");
    }
    let given = refused(&one(&model("", &objects, "<item objectid=\"13\"/>")));
    assert!(
        given.contains("more than 100000 placements of objects"),
        "{given}"
    );
    let loops = "<object id=\"2\"><components><component objectid=\"2\"/></components></object>";
    let given = refused(&one(&model("", loops, "<item objectid=\"2\"/>")));
    assert!(
        given.contains("placed in one another over more than 64 levels"),
        "{given}"
    );
}

#[test]
fn an_archive_that_unpacks_to_too_much_is_refused() {
    let bomb = " ".repeat(513 << 20);
    let given = refused(&one(&bomb));
    assert!(
        given.contains("the archive has more than 536870912 bytes when unpacked"),
        "{given}"
    );
}

#[test]
fn a_damaged_archive_is_refused() {
    let bytes = one(&model("", "", ITEM));
    assert!(refused(&bytes[..bytes.len() / 2]).contains("not a zip archive"));
    // A changed byte of the packed model changes its checksum.
    let at = bytes
        .windows(16)
        .position(|part| part == b"3D/3dmodel.model")
        .unwrap()
        + 100;
    let mut changed = bytes.clone();
    changed[at] ^= 0x55;
    let given = refused(&changed);
    assert!(
        given.contains("part `3d/3dmodel.model`: it cannot be unpacked"),
        "{given}"
    );
    let given = refused(&archive(&[("a", "b")]));
    assert!(
        given.contains("part `3d/3dmodel.model`: the archive does not contain it"),
        "{given}"
    );
}

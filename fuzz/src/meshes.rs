//! Requirements on triangle meshes of every format: finite coordinates, indices of vertices, no more triangles than allowed.

use armill_formats::mesh::{LARGEST_COORDINATE, MOST_TRIANGLES, likely_unit, read};
use rawzip::{CompressionMethod, ZipArchiveWriter};

use crate::verdicts::refused;

/// STL of both forms.
pub fn stl(bytes: &[u8]) {
    check("part.stl", bytes);
}

/// Wavefront OBJ.
pub fn obj(bytes: &[u8]) {
    check("part.obj", bytes);
}

/// PLY of all encodings.
pub fn ply(bytes: &[u8]) {
    check("part.ply", bytes);
}

/// A 3MF archive.
pub fn three_mf(bytes: &[u8]) {
    check("part.3mf", bytes);
}

/// The model of a 3MF archive, which has the checksum of these bytes: a changed byte of an archive is found by it.
pub fn three_mf_model(bytes: &[u8]) {
    let packed = archive(bytes).expect("archives in memory can be written");
    check("part.3mf", &packed);
}

/// COLLADA.
pub fn dae(bytes: &[u8]) {
    check("part.dae", bytes);
}

/// An archive with one model, which is not compressed.
fn archive(model: &[u8]) -> Result<Vec<u8>, rawzip::Error> {
    let mut bytes = Vec::new();
    let mut archive = ZipArchiveWriter::new(&mut bytes);
    let new = archive.new_file("3D/3dmodel.model");
    let (mut entry, config) = new.compression_method(CompressionMethod::STORE).start()?;
    let mut writer = config.wrap(&mut entry);
    std::io::Write::write_all(&mut writer, model)?;
    let (_, descriptor) = writer.finish()?;
    entry.finish(descriptor)?;
    archive.finish()?;
    Ok(bytes)
}

/// Reads; a mesh can be evaluated.
fn check(name: &str, bytes: &[u8]) {
    match read(name, bytes) {
        Err(problems) => refused(&problems),
        Ok(mesh) => {
            let coordinates = mesh.vertices.as_flattened().iter();
            let mut small = coordinates.map(|value| value.abs() <= LARGEST_COORDINATE);
            assert!(small.all(|small| small));
            let corners = mesh.triangles.iter().chain(&mesh.without_area).flatten();
            let mut used = vec![false; mesh.vertices.len()];
            corners.for_each(|corner| used[*corner as usize] = true);
            assert!(used.into_iter().all(|used| used));
            assert!((1..=MOST_TRIANGLES).contains(&mesh.triangles.len()));
            assert!(mesh.unit.is_none_or(|unit| unit.metres() > 0.0));
            let report = mesh.report();
            assert!(report.volume.is_finite() && report.area >= 0.0);
            assert!(!report.is_closed || report.open_edges == 0);
            let _ = likely_unit(mesh.longest_side());
        }
    }
}

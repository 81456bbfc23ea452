//! Recognises the format of a mesh and reads it.
//!
//! The ending gives the format; the first bytes must not be those of another one.

use std::path::Path;

use super::triangle_mesh::{PointCloud, TriangleMesh};
use super::{dae, obj, ply, stl, three_mf};
use crate::document::{Problem, Problems};

/// Bytes in which a word that marks a format is looked for.
const HEAD_BYTES: usize = 1024;

/// A format of meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// STL, binary or ASCII.
    Stl,
    /// Wavefront OBJ.
    Obj,
    /// PLY, ASCII or binary.
    Ply,
    /// 3MF.
    ThreeMf,
    /// COLLADA.
    Dae,
}

impl MeshFormat {
    /// Every format.
    pub const ALL: [MeshFormat; 5] = [
        MeshFormat::Stl,
        MeshFormat::Obj,
        MeshFormat::Ply,
        MeshFormat::ThreeMf,
        MeshFormat::Dae,
    ];

    /// The ending of its files.
    pub fn ending(self) -> &'static str {
        match self {
            MeshFormat::Stl => "stl",
            MeshFormat::Obj => "obj",
            MeshFormat::Ply => "ply",
            MeshFormat::ThreeMf => "3mf",
            MeshFormat::Dae => "dae",
        }
    }

    /// The format of a file by its ending; capitals do not matter.
    pub fn of_path(path: &Path) -> Option<MeshFormat> {
        let ending = path.extension()?.to_str()?.to_lowercase();
        MeshFormat::ALL
            .into_iter()
            .find(|format| format.ending() == ending)
    }
}

/// The endings of mesh files, for people: `.stl, .obj, ...`.
pub fn endings() -> String {
    MeshFormat::ALL
        .map(|format| format!(".{}", format.ending()))
        .join(", ")
}

/// The mesh in `bytes`; `shown` is the path that problems show, its ending gives the format.
///
/// # Errors
/// An unknown ending, content of another format, and all problems of the file, at most 200: numbers that are not finite
/// or exceed [`LARGEST_COORDINATE`](super::LARGEST_COORDINATE), indices without a vertex, polygons that cross themselves, a
/// file that is cut short, no triangle with an area, more than [`MOST_TRIANGLES`](super::MOST_TRIANGLES).
pub fn read(shown: &str, bytes: &[u8]) -> Result<TriangleMesh, Problems> {
    let refused = |message: String, hint: String| Problems::from(Problem::of_file(shown, message, &hint));
    let Some(format) = MeshFormat::of_path(Path::new(shown)) else {
        let message = "not a mesh by its ending".to_owned();
        return Err(refused(message, format!("supported are {}", endings())));
    };
    if bytes.is_empty() {
        return Err(refused(
            "the file is empty".to_owned(),
            "export it again".to_owned(),
        ));
    }
    if let Some((found, hint)) = other_content(format, bytes) {
        let message = format!("the content is {found}, not {}", format.ending().to_uppercase());
        return Err(refused(message, hint));
    }
    match format {
        MeshFormat::Stl => stl::read(shown, bytes),
        MeshFormat::Obj => obj::read(shown, bytes),
        MeshFormat::Ply => ply::read(shown, bytes),
        MeshFormat::ThreeMf => three_mf::read(shown, bytes),
        MeshFormat::Dae => dae::read(shown, bytes),
    }
}

/// The points of a PLY file in `bytes`, which need not have faces; `shown` is the path that problems show.
///
/// # Errors
/// All problems of its vertices, at most 200.
pub fn read_ply_points(shown: &str, bytes: &[u8]) -> Result<PointCloud, Problems> {
    ply::read_points(shown, bytes)
}

/// The name of the content if it is clearly of another format, and what to do.
fn other_content(format: MeshFormat, bytes: &[u8]) -> Option<(&'static str, String)> {
    let head = &bytes[..bytes.len().min(HEAD_BYTES)];
    let has = |word: &[u8]| head.windows(word.len()).any(|part| part == word);
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Some(("UTF-16 text", "save it as UTF-8".to_owned()));
    }
    if head.starts_with(b"ISO-10303-21") {
        let hint = "a STEP file has surfaces instead of triangles: export a mesh from CAD".to_owned();
        return Some(("STEP", hint));
    }
    if head.starts_with(&[0x1f, 0x8b]) {
        return Some(("compressed with gzip", "decompress it".to_owned()));
    }
    let (found, name) = if head.starts_with(b"PK\x03\x04") {
        (MeshFormat::ThreeMf, "a zip archive, as 3MF is")
    } else if head.starts_with(b"ply\n") || head.starts_with(b"ply\r") {
        (MeshFormat::Ply, "PLY")
    } else if has(b"<COLLADA") {
        (MeshFormat::Dae, "COLLADA")
    } else if stl::is_stl(bytes) {
        (MeshFormat::Stl, "STL")
    } else {
        return None;
    };
    (found != format).then(|| (name, format!("rename it to end in .{}", found.ending())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ending_gives_the_format_in_small_and_capital_letters() {
        for format in MeshFormat::ALL {
            let path = format!("a.b/part.{}", format.ending().to_uppercase());
            assert_eq!(MeshFormat::of_path(Path::new(&path)), Some(format));
        }
        assert_eq!(endings(), ".stl, .obj, .ply, .3mf, .dae");
    }

    #[test]
    fn unknown_endings_empty_files_and_other_content_are_refused() {
        let given = |name: &str, bytes: &[u8]| read(name, bytes).unwrap_err().to_string();
        assert!(given("part.step", b"x").contains("supported are .stl, .obj"));
        assert!(given("part.stl", b"").contains("the file is empty"));
        assert!(given("part.stl", b"ISO-10303-21;").contains("the content is STEP, not STL"));
        assert!(given("part.obj", b"ply\nformat ascii 1.0\n").contains("the content is PLY, not OBJ"));
        assert!(given("part.stl", b"PK\x03\x04").contains("rename it to end in .3mf"));
        assert!(given("part.obj", b"<?xml?><COLLADA>").contains("the content is COLLADA"));
        assert!(given("part.ply", b"solid a\nfacet normal 0 0 1\n").contains("rename it to end in .stl"));
        assert!(given("part.obj", b"\xff\xfev\0").contains("UTF-16"));
    }
}

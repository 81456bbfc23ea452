//! Which format a surface is written in.

use std::path::Path;

use super::surface_table::{SurfaceError, SurfaceTable};
use super::{glb, ply, stl, vtp};

/// A format of coloured surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfaceFormat {
    /// PLY, binary, little endian.
    Ply,
    /// VTK poly data.
    Vtp,
    /// glTF, binary.
    Glb,
    /// STL, binary: the geometry alone.
    Stl,
}

impl SurfaceFormat {
    /// Every format.
    pub const ALL: [SurfaceFormat; 4] = [
        SurfaceFormat::Ply,
        SurfaceFormat::Vtp,
        SurfaceFormat::Glb,
        SurfaceFormat::Stl,
    ];

    /// The ending of its files.
    pub fn ending(self) -> &'static str {
        match self {
            SurfaceFormat::Ply => "ply",
            SurfaceFormat::Vtp => "vtp",
            SurfaceFormat::Glb => "glb",
            SurfaceFormat::Stl => "stl",
        }
    }

    /// The format of a file by its ending; capitals do not matter.
    pub fn of_path(path: &Path) -> Option<SurfaceFormat> {
        let ending = path.extension()?.to_str()?.to_lowercase();
        SurfaceFormat::ALL
            .into_iter()
            .find(|format| format.ending() == ending)
    }

    /// The bytes of a file with this surface.
    ///
    /// # Errors
    /// A surface without triangles, or whose lists do not fit to each other; numbers that are not finite (a missing value of a column is NaN); names that a
    /// format cannot have; more than the sizes of a format can count.
    pub fn write(self, surface: &SurfaceTable) -> Result<Vec<u8>, SurfaceError> {
        surface.check()?;
        match self {
            SurfaceFormat::Ply => ply::write(surface),
            SurfaceFormat::Vtp => vtp::write(surface),
            SurfaceFormat::Glb => glb::write(surface),
            SurfaceFormat::Stl => stl::write(surface),
        }
    }
}

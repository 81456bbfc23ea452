//! The files of a picture: SVG, and PNG where that is built in.

use armill_formats::file::ResultFolder;
use rayon::prelude::*;

use crate::analysis::picture::Picture;
use crate::error::StudyError;
use crate::output::folder::Folder;

/// Pixels of a raster picture for each of its own: sharp in print.
#[cfg(feature = "png")]
const PNG_SCALE: f64 = 2.0;

/// The files of a picture.
pub fn picture_files(picture: &Picture) -> impl Iterator<Item = String> {
    let png = cfg!(feature = "png").then(|| format!("{}.png", picture.name));
    std::iter::once(format!("{}.svg", picture.name)).chain(png)
}

/// Writes every picture.
///
/// # Errors
/// A picture that cannot be drawn, a file that cannot be written.
pub fn save_pictures(drawn: &[Picture], files: &Folder<'_>) -> Result<(), StudyError> {
    drawn.par_iter().with_max_len(1).try_for_each(|picture| {
        #[cfg(feature = "png")]
        files.save(&format!("{}.png", picture.name), &png(&picture.svg)?)?;
        files.save(&format!("{}.svg", picture.name), picture.svg.as_bytes())
    })
}

/// Writes pictures that are not those of an analysis into `out`.
///
/// # Errors
/// A file cannot be written; a picture cannot be drawn in pixels.
pub fn write_pictures(pictures: &[Picture], out: &ResultFolder) -> Result<(), StudyError> {
    for picture in pictures {
        #[cfg(feature = "png")]
        out.write(&format!("{}.png", picture.name), &png(&picture.svg)?)?;
        out.write(&format!("{}.svg", picture.name), picture.svg.as_bytes())?;
    }
    Ok(())
}

/// A picture in pixels, as it is written in addition to its SVG.
///
/// # Errors
/// A picture that cannot become pixels.
#[cfg(feature = "png")]
pub fn png(svg: &str) -> Result<Vec<u8>, StudyError> {
    Ok(armill_report::raster::png(svg, PNG_SCALE)?)
}

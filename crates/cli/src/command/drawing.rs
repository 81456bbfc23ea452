//! Drawings in files, as SVG or PNG depending on the extension.

use std::path::Path;

use armill_formats::file::Writer;
use armill_study::StudyError;

/// Pixels of a PNG per unit of the SVG, in each direction: sharp in print.
const PIXELS: f64 = 2.0;

/// Writes `svg` to `file`: unchanged for the extension `.svg`, as pixels for `.png`, in upper or
/// lower case. Reports the file on stderr.
///
/// # Errors
/// Another extension; a picture that cannot be converted; a file that cannot be written.
pub(super) fn write(writer: &Writer, file: &Path, svg: &str) -> Result<(), StudyError> {
    writer.write(file, &bytes(file, svg)?)?;
    crate::terminal::say(&format!("drawing in {}", file.display()));
    Ok(())
}

/// The bytes of this file, for commands that write several.
///
/// # Errors
/// Another extension; a picture that cannot be converted.
pub(super) fn bytes(file: &Path, svg: &str) -> Result<Vec<u8>, StudyError> {
    let ends_in = |requested: &str| {
        let ending = file.extension();
        ending.is_some_and(|ending| ending.eq_ignore_ascii_case(requested))
    };
    if ends_in("png") {
        Ok(armill_report::raster::png(svg, PIXELS)?)
    } else if ends_in("svg") {
        Ok(svg.as_bytes().to_vec())
    } else {
        Err(StudyError::value(
            format!("--drawing: {} does not end in .svg or .png", file.display()),
            "use one of these extensions",
        ))
    }
}

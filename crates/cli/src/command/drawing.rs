//! Drawings on disk, as SVG or PNG by the name of the file.

use std::path::Path;

use armill_formats::file::Writer;
use armill_study::StudyError;

/// Pixels of a PNG to one of an SVG, each way: sharp on paper.
const PIXELS: f64 = 2.0;

/// Writes `svg` to `file`: as it is where the name ends in `.svg`, as pixels where it ends in `.png`, in
/// letters of either case. Says on stderr where it is.
///
/// # Errors
/// Another ending; a picture that cannot become pixels; a place where nothing can be written.
pub(super) fn write(writer: &Writer, file: &Path, svg: &str) -> Result<(), StudyError> {
    let ends_in = |requested: &str| {
        let ending = file.extension();
        ending.is_some_and(|ending| ending.eq_ignore_ascii_case(requested))
    };
    let bytes = if ends_in("png") {
        armill_report::raster::png(svg, PIXELS)?
    } else if ends_in("svg") {
        svg.as_bytes().to_vec()
    } else {
        return Err(StudyError::value(
            format!("--drawing: {} is no picture that armill draws", file.display()),
            "a name that ends in .svg or .png",
        ));
    };
    writer.write(file, &bytes)?;
    crate::terminal::say(&format!("drawing in {}", file.display()));
    Ok(())
}

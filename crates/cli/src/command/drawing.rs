//! Drawings on disk, as SVG or PNG by the name of the file.

use std::path::Path;

use armill_formats::file::write_atomically;
use armill_study::StudyError;

/// Writes `svg` to `file`: as it is, or as pixels where the name ends in `.png`.
pub(crate) fn write(file: &Path, svg: &str) -> Result<(), StudyError> {
    let png = file
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
    let bytes = if png {
        armill_report::raster::png(svg, 2.0)?
    } else {
        svg.as_bytes().to_vec()
    };
    write_atomically(file, &bytes)?;
    crate::terminal::say(&format!("drawing in {}", file.display()));
    Ok(())
}

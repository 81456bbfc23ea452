//! From SVG to PNG with the embedded fonts only, so that a picture is the same on every machine.

use std::sync::Arc;

use resvg::{tiny_skia, usvg};

use crate::error::ReportError;

const REGULAR: &[u8] = include_bytes!("../fonts/DejaVuSans.subset.ttf");
const BOLD: &[u8] = include_bytes!("../fonts/DejaVuSans-Bold.subset.ttf");

/// Longest side in pixels; a picture of this size takes 400 MB.
const LARGEST_PX: u32 = 10_000;

/// `svg` as PNG, `scale` pixels to each unit of the SVG (2 or 3 for print).
///
/// # Errors
/// The text is no SVG, or the picture has no pixels or more than 10 000 a side.
pub fn png(svg: &str, scale: f64) -> Result<Vec<u8>, ReportError> {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(REGULAR.to_vec());
    fonts.load_font_data(BOLD.to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    let options = usvg::Options {
        font_family: "DejaVu Sans".to_owned(),
        fontdb: Arc::new(fonts),
        ..Default::default()
    };
    let tree = usvg::Tree::from_str(svg, &options).map_err(|e| ReportError::UnreadableSvg {
        reason: e.to_string(),
    })?;
    let (width_px, height_px) = (
        f64::from(tree.size().width()) * scale,
        f64::from(tree.size().height()) * scale,
    );
    let size_error = || ReportError::Size {
        width_px,
        height_px,
        limit_px: LARGEST_PX,
    };
    let drawable = |side: f64| side >= 1.0 && side <= f64::from(LARGEST_PX);
    if !(drawable(width_px) && drawable(height_px)) {
        return Err(size_error());
    }
    let mut pixels =
        tiny_skia::Pixmap::new(width_px.round() as u32, height_px.round() as u32).ok_or_else(size_error)?;
    let transform = tiny_skia::Transform::from_scale(scale as f32, scale as f32);
    resvg::render(&tree, transform, &mut pixels.as_mut());
    pixels.encode_png().map_err(|e| ReportError::Encoding {
        reason: e.to_string(),
    })
}

//! From SVG to PNG with the embedded fonts only, so that a picture is the same on every machine.
//!
//! Only the two fonts of this crate are known to the renderer: a picture needs none of the machine's. The
//! widths of `crate::font` are those of the same files.

use std::sync::Arc;

use resvg::{tiny_skia, usvg};

use crate::error::ReportError;
use crate::font::{BOLD, REGULAR};

/// Longest side in pixels; a square picture of this size takes 400 MB.
const LARGEST_PX: u32 = 10_000;

/// `svg` as PNG, `scale` pixels to each unit of the SVG (2 or 3 for print). The sides are rounded to whole
/// pixels.
///
/// # Errors
/// The text is not SVG (`UnreadableSvg`); the picture has less than one pixel or more than 10 000 a side, or
/// `scale` is not a number (`Size`); the PNG cannot be written (`Encoding`).
pub fn png(svg: &str, scale: f64) -> Result<Vec<u8>, ReportError> {
    let tree = read(svg)?;
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
    encoded(&pixels).map_err(|e| ReportError::Encoding {
        reason: e.to_string(),
    })
}

/// The pixels as PNG; without alpha where all are opaque, as in every picture of this crate.
fn encoded(pixels: &tiny_skia::Pixmap) -> Result<Vec<u8>, png::EncodingError> {
    /// Takes a sixth of the time of the default, for a third more bytes.
    const LEVEL: png::DeflateCompression = png::DeflateCompression::Level(1);
    if pixels.pixels().iter().any(|pixel| !pixel.is_opaque()) {
        return pixels.encode_png();
    }
    let mut colours = vec![0; 3 * pixels.pixels().len()];
    for (colour, pixel) in colours.chunks_exact_mut(3).zip(pixels.data().chunks_exact(4)) {
        colour.copy_from_slice(&pixel[..3]);
    }
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, pixels.width(), pixels.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_deflate_compression(LEVEL);
    encoder.set_filter(png::Filter::Up);
    encoder.write_header()?.write_image_data(&colours)?;
    Ok(bytes)
}

/// The picture as resvg sees it, with the embedded fonts.
fn read(svg: &str) -> Result<usvg::Tree, ReportError> {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(REGULAR.to_vec());
    fonts.load_font_data(BOLD.to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    let options = usvg::Options {
        font_family: "DejaVu Sans".to_owned(),
        fontdb: Arc::new(fonts),
        ..Default::default()
    };
    usvg::Tree::from_str(svg, &options).map_err(|e| ReportError::UnreadableSvg {
        reason: e.to_string(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::font::{Weight, text_width_px};
    use crate::svg::{Style, Svg, Text};

    /// Where the ink of the last text of a picture ends, px.
    fn right_px(content: &str, text: &Text) -> f64 {
        let mut svg = Svg::new();
        svg.line([0.0, 0.0], [1.0, 0.0], &Style::line("#fff", 1.0));
        svg.text([0.0, 50.0], content, text);
        let tree = read(&svg.finish(4000.0, 100.0, "")).expect("our own SVG");
        f64::from(
            tree.root()
                .children()
                .last()
                .map_or(0.0, |node| node.abs_bounding_box().right()),
        )
    }

    #[test]
    fn a_png_has_the_pixels_of_the_picture_with_and_without_alpha() {
        for ground in ["", r##"<rect width="8" height="5" fill="#fff"/>"##] {
            let text = format!(
                r##"<svg xmlns="http://www.w3.org/2000/svg" width="8" height="5">{ground}<rect x="2" y="1" width="3" height="3" fill="#102030"/></svg>"##
            );
            let bytes = png(&text, 1.0).expect("a small picture");
            let decoded = tiny_skia::Pixmap::decode_png(&bytes).expect("our own PNG");
            let mut drawn = tiny_skia::Pixmap::new(8, 5).expect("a few pixels");
            let tree = read(&text).expect("SVG");
            resvg::render(&tree, tiny_skia::Transform::identity(), &mut drawn.as_mut());
            assert_eq!(decoded, drawn);
            let transparent = drawn.pixels().iter().any(|pixel| !pixel.is_opaque());
            assert_eq!(transparent, ground.is_empty());
        }
    }

    #[test]
    fn texts_are_rendered_in_the_widths_of_the_embedded_fonts() {
        const SIZE_PX: f64 = 40.0;
        for weight in [Weight::Regular, Weight::Bold] {
            let text = match weight {
                Weight::Regular => Text::new(SIZE_PX),
                Weight::Bold => Text::new(SIZE_PX).bold(),
            };
            for content in [
                "deviation (µm)",
                "0123456789",
                "tolerance \u{2212}50 µm ± 2",
                "Ø 270 mm × 3°",
                "αβδ ≤ ‰",
            ] {
                // Ten times the text between two bars: what the second bar ends at grows by their widths alone.
                let bar = |times: usize| right_px(&format!("|{}|", content.repeat(times)), &text);
                let drawn = (bar(10) - bar(0)) / 10.0;
                let given = text_width_px(content, SIZE_PX, weight);
                // Kerning of a few pairs is left out.
                assert!(
                    (drawn - given).abs() < 0.02 * given,
                    "{content} {weight:?}: {drawn} {given}"
                );
            }
        }
    }
}

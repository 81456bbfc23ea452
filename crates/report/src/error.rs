//! What can go wrong when a picture becomes a file: only the step from SVG to pixels can.

/// Why a picture could not be turned into pixels.
///
/// Making an SVG or a report never fails: input that cannot be drawn gives a picture that says so.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// The text is not an SVG document.
    #[error("the picture is not readable as SVG: {reason}")]
    UnreadableSvg {
        /// What the reader said.
        reason: String,
    },
    /// The requested size is not drawable: zero, not finite or too large.
    #[error("a picture of {width_px} x {height_px} px cannot be drawn, the limit is {limit_px} px a side")]
    Size {
        /// Requested width in pixels.
        width_px: f64,
        /// Requested height in pixels.
        height_px: f64,
        /// Largest side that is drawn.
        limit_px: u32,
    },
    /// The pixels were drawn but could not be written as PNG.
    #[error("the PNG could not be written: {reason}")]
    Encoding {
        /// What the writer said.
        reason: String,
    },
}

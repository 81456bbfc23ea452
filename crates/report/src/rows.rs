//! Rows under each other on one value axis, as bars and ranges need them: labels left of it, numbers right.
//!
//! ```text
//!  label │                       │ number
//!  label │                       │ number
//!        0        quantity (µm)
//! ```
//!
//! Values are um, lengths pixels of the picture.

use crate::colour::{GRID, INK};
use crate::font::{BODY_PX, SMALL_PX, Weight, text_width_px};
use crate::page::BORDER_PX;
use crate::svg::{Rect, Style, Svg, Text};
use crate::ticks::Ticks;

/// Longest label in pixels; longer ones are cut. Room for the labels, where all are short.
const LABEL_PX: f64 = 190.0;
const LEAST_LABEL_PX: f64 = 30.0;
/// Between a label and the axis.
const LABEL_GAP_PX: f64 = 10.0;

/// The value axis placed on the picture, rows along it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rows {
    /// Where the rows are drawn, without labels and numbers.
    pub(crate) area: Rect,
    /// Values at the left and at the right edge.
    pub(crate) range: [f64; 2],
}

/// Where the axis begins so that these labels have room left of it.
pub(crate) fn left_px<'a>(labels: impl Iterator<Item = &'a str>) -> f64 {
    let widths = labels.map(|label| text_width_px(label, BODY_PX, Weight::Regular));
    BORDER_PX + widths.fold(LEAST_LABEL_PX, f64::max).min(LABEL_PX) + LABEL_GAP_PX + 2.0
}

impl Rows {
    /// The position of a value across the picture.
    pub(crate) fn x(&self, um: f64) -> f64 {
        self.area.x + (um - self.range[0]) / (self.range[1] - self.range[0]) * self.area.w
    }

    /// Grid lines, numbers and the label below.
    pub(crate) fn draw_axis(&self, svg: &mut Svg, quantity: &str) {
        let area = self.area;
        let ticks = Ticks::about(6.0, self.range);
        for um in &ticks.at {
            let x = self.x(*um);
            svg.line([x, area.y], [x, area.bottom()], &Style::line(GRID, 1.0));
            svg.text(
                [x, area.bottom() + 16.0],
                &ticks.label(*um),
                &Text::new(SMALL_PX).middle(),
            );
        }
        let c = area.centre()[0];
        svg.text([c, area.bottom() + 36.0], quantity, &Text::new(BODY_PX).middle());
    }

    /// A label left of the axis, no longer than the room for it; one that is cut ends in an ellipsis.
    pub(crate) fn draw_label(&self, svg: &mut Svg, label: &str, middle: f64) {
        let at = [self.area.x - LABEL_GAP_PX, middle + 4.0];
        svg.text(at, &cut(label), &Text::new(BODY_PX).end());
    }

    /// A line between two values with a stroke across each end, on a white ground.
    pub(crate) fn draw_whisker(&self, svg: &mut Svg, ends_um: [f64; 2], y: f64, half_px: f64) {
        let [a, b] = ends_um.map(|um| self.x(um));
        for style in [Style::line("#fff", 3.2).opacity(0.8), Style::line(INK, 1.3)] {
            svg.line([a, y], [b, y], &style);
            for x in [a, b] {
                svg.line([x, y - half_px], [x, y + half_px], &style);
            }
        }
    }
}

fn cut(label: &str) -> String {
    if text_width_px(label, BODY_PX, Weight::Regular) <= LABEL_PX {
        return label.to_owned();
    }
    let mut short = String::new();
    for c in label.chars() {
        short.push(c);
        if text_width_px(&short, BODY_PX, Weight::Regular) > LABEL_PX - 12.0 {
            break;
        }
    }
    short.push('…');
    short
}

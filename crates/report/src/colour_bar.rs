//! The colour bar of a filled map: one box a band, numbers at the edges, the tolerance as a line across.
//!
//! ```text
//!  ┌──┐─ 200         q
//!  │  │              u
//!  ╞══╡ tolerance    a     bar 16 px; numbers at the edges of bands; the tolerance in place of the numbers near it;
//!  │  │─ 100         n     the quantity with its unit, reading upwards
//!  └──┘─ 50          t
//! ```
//!
//! Where edges are closer than 16 px, only every second, third, ... has its number. A tolerance outside the bands
//! has no line here: the legend of the map states it.

use crate::axis::plain;
use crate::colour::{ColourScale, INK};
use crate::font::{BODY_PX, SMALL_PX, Weight, text_width_px, wrap};
use crate::levels::Levels;
use crate::svg::{Rect, Style, Svg, Text};
use crate::tolerance;

/// Width of the bar itself.
const BAR_PX: f64 = 16.0;
/// From a drawing to its bar, and the least height of the bar.
const GAP_PX: f64 = 22.0;
const LEAST_PX: f64 = 150.0;
/// From line to line of a quantity that does not fit into one.
const QUANTITY_LINE_PX: f64 = 15.0;

/// A colour bar with its quantity and tolerance.
pub(crate) struct ColourBar<'a> {
    /// The bands, as they are drawn on the map.
    pub(crate) levels: &'a Levels,
    pub(crate) scale: ColourScale,
    /// What the colours mean, with its unit.
    pub(crate) quantity: &'a str,
    /// The tolerance in um, marked where it is within the bands.
    pub(crate) tolerance_um: Option<f64>,
}

impl ColourBar<'_> {
    /// Width that a bar of this height takes up with its numbers and quantity.
    pub(crate) fn width_px(&self, height_px: f64) -> f64 {
        self.numbers_px() + 10.0 + QUANTITY_LINE_PX * self.quantity_lines(height_px).len() as f64
    }

    /// The area of the bar: right of the drawing, from its upper edge.
    pub(crate) fn right_of(&self, drawing: Rect) -> Rect {
        let h = drawing.h.max(LEAST_PX);
        Rect {
            x: drawing.right() + GAP_PX,
            y: drawing.y,
            w: self.width_px(h),
            h,
        }
    }

    /// Draws the bar at the left of `area`, as high as `area`; its quantity reads upwards along the right side.
    pub(crate) fn draw(&self, svg: &mut Svg, area: Rect) {
        let edges = &self.levels.edge_um;
        let (Some(low), Some(high)) = (edges.first(), edges.last()) else {
            return;
        };
        let y = |v: f64| area.bottom() - (v - low) / (high - low) * area.h;
        for band in 0..self.levels.bands() {
            let (top, bottom) = (y(edges[band + 1]), y(edges[band]));
            // One pixel of overlap: no seam between boxes.
            let extra = if band == 0 { 0.0 } else { 0.6 };
            let cell = Rect {
                x: area.x,
                y: top,
                w: BAR_PX,
                h: bottom - top + extra,
            };
            svg.rect(cell, &Style::fill(self.levels.colour(band, self.scale)));
        }
        svg.rect(Rect { w: BAR_PX, ..area }, &Style::line(INK, 1.0));
        let tolerance = self.tolerance_inside();
        let every = (edges.len() as f64 * 16.0 / area.h.max(1.0)).ceil().max(1.0) as usize;
        for v in edges.iter().step_by(every) {
            let x = area.x + BAR_PX;
            svg.line([x, y(*v)], [x + 4.0, y(*v)], &Style::line(INK, 1.0));
            if tolerance.is_none_or(|l| (y(l) - y(*v)).abs() > 13.0) {
                svg.text(
                    [x + 8.0, y(*v) + 4.0],
                    &self.levels.label(*v),
                    &Text::new(SMALL_PX),
                );
            }
        }
        if let Some(l) = tolerance {
            let (a, b) = ([area.x - 3.0, y(l)], [area.x + BAR_PX + 6.0, y(l)]);
            svg.line(a, b, &tolerance::ground_style());
            svg.line(a, b, &tolerance::style());
            svg.text([b[0] + 4.0, y(l) + 4.0], &tolerance_number(l), &tolerance::text());
        }
        let lines = self.quantity_lines(area.h);
        for (k, line) in lines.iter().enumerate() {
            let x = area.x + self.numbers_px() + 22.0 + QUANTITY_LINE_PX * k as f64;
            svg.text(
                [x, area.centre()[1]],
                line,
                &Text::new(BODY_PX).middle().turned(-90.0),
            );
        }
    }

    /// The quantity, broken where the bar is too low for it.
    fn quantity_lines(&self, height_px: f64) -> Vec<String> {
        wrap(self.quantity, BODY_PX, Weight::Regular, height_px.max(60.0))
    }

    /// Width of bar, ticks and numbers, the tolerance's number among them.
    fn numbers_px(&self) -> f64 {
        let numbers = self
            .levels
            .edge_um
            .iter()
            .map(|v| text_width_px(&self.levels.label(*v), SMALL_PX, Weight::Regular))
            .fold(0.0, f64::max);
        let tolerance = self.tolerance_inside().map_or(0.0, |l| {
            text_width_px(&tolerance_number(l), SMALL_PX, Weight::Bold) + 4.0
        });
        BAR_PX + 8.0 + numbers.max(tolerance)
    }

    /// The tolerance, if it is within the bands.
    fn tolerance_inside(&self) -> Option<f64> {
        let (low, high) = (self.levels.edge_um.first()?, self.levels.edge_um.last()?);
        self.tolerance_um.filter(|l| l >= low && l <= high)
    }
}

/// The tolerance among the numbers of the bar, whose unit is in its quantity.
fn tolerance_number(tolerance_um: f64) -> String {
    format!("tolerance {}", plain(tolerance_um))
}

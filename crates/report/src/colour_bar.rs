//! The colour bar of a filled map: one box a band, numbers at the edges, the limit as a line across.
//!
//! ```text
//!  ┌──┐─ 200   q
//!  │  │        u
//!  ╞══╡ limit  a     bar 16 px; numbers at the edges of bands; the limit in place of the numbers near it;
//!  │  │─ 100   n     the quantity with its unit, reading upwards
//!  └──┘─ 50    t
//! ```
//!
//! Where edges stand closer than 16 px, only every second, third, ... has its number. A limit outside the bands
//! has no line here: the legend of the map tells it.

use crate::axis::plain;
use crate::colour::{ColourScale, INK};
use crate::font::{Weight, text_width_px, wrap};
use crate::levels::Levels;
use crate::limit;
use crate::page::{BODY_PX, SMALL_PX};
use crate::svg::{Rect, Style, Svg, Text};

/// Width of the bar itself.
const BAR_PX: f64 = 16.0;
/// From a drawing to the bar beside it, and the least height that such a bar has.
const GAP_PX: f64 = 22.0;
const LEAST_PX: f64 = 150.0;
/// From line to line of a quantity that does not fit into one.
const QUANTITY_LINE_PX: f64 = 15.0;

/// A colour bar with its quantity and limit.
pub(crate) struct ColourBar<'a> {
    /// The bands, as they are drawn on the map.
    pub(crate) levels: &'a Levels,
    pub(crate) scale: ColourScale,
    /// What the colours mean, with its unit.
    pub(crate) quantity: &'a str,
    /// The limit in um, marked where it lies within the bands.
    pub(crate) tolerance_um: Option<f64>,
}

impl ColourBar<'_> {
    /// Width that a bar of this height takes up with its numbers and quantity.
    pub(crate) fn width_px(&self, height_px: f64) -> f64 {
        self.numbers_px() + 10.0 + QUANTITY_LINE_PX * self.quantity_lines(height_px).len() as f64
    }

    /// Where the bar stands beside a drawing: right of it, from its upper edge.
    pub(crate) fn beside(&self, drawing: Rect) -> Rect {
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
        let limit = self.limit_inside();
        let every = (edges.len() as f64 * 16.0 / area.h.max(1.0)).ceil().max(1.0) as usize;
        for v in edges.iter().step_by(every) {
            let x = area.x + BAR_PX;
            svg.line([x, y(*v)], [x + 4.0, y(*v)], &Style::line(INK, 1.0));
            if limit.is_none_or(|l| (y(l) - y(*v)).abs() > 13.0) {
                svg.text(
                    [x + 8.0, y(*v) + 4.0],
                    &self.levels.label(*v),
                    &Text::new(SMALL_PX),
                );
            }
        }
        if let Some(l) = limit {
            let (a, b) = ([area.x - 3.0, y(l)], [area.x + BAR_PX + 6.0, y(l)]);
            svg.line(a, b, &limit::ground_style());
            svg.line(a, b, &limit::style());
            svg.text([b[0] + 4.0, y(l) + 4.0], &limit_number(l), &limit::text());
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

    /// Width of bar, ticks and numbers, the limit's number among them.
    fn numbers_px(&self) -> f64 {
        let numbers = self
            .levels
            .edge_um
            .iter()
            .map(|v| text_width_px(&self.levels.label(*v), SMALL_PX, Weight::Regular))
            .fold(0.0, f64::max);
        let limit = self.limit_inside().map_or(0.0, |l| {
            text_width_px(&limit_number(l), SMALL_PX, Weight::Bold) + 4.0
        });
        BAR_PX + 8.0 + numbers.max(limit)
    }

    /// The limit, if it lies within the bands.
    fn limit_inside(&self) -> Option<f64> {
        let (low, high) = (self.levels.edge_um.first()?, self.levels.edge_um.last()?);
        self.tolerance_um.filter(|l| l >= low && l <= high)
    }
}

/// The limit among the numbers of the bar, whose unit is in its quantity.
fn limit_number(tolerance_um: f64) -> String {
    format!("limit {}", plain(tolerance_um))
}

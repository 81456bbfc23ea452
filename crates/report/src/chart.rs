//! A chart with two independent axes: frame, ticks, grid lines, and lines broken where a value is missing.

use crate::axis::{extent, tick_label, ticks};
use crate::colour::{GRID, INK};
use crate::font::{Weight, text_width_px};
use crate::page::{BODY_PX, SMALL_PX};
use crate::svg::{Point, Rect, Style, Svg, Text};

/// A chart placed on the picture; `low` and `high` are left and right, bottom and top.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chart {
    pub(crate) area: Rect,
    pub(crate) low: [f64; 2],
    pub(crate) high: [f64; 2],
}

impl Chart {
    pub(crate) fn at(&self, v: [f64; 2]) -> Point {
        let t = |k: usize| (v[k] - self.low[k]) / (self.high[k] - self.low[k]);
        [
            self.area.x + t(0) * self.area.w,
            self.area.bottom() - t(1) * self.area.h,
        ]
    }

    /// Grid lines, ticks, numbers and frame; axis labels below and left.
    pub(crate) fn draw(&self, svg: &mut Svg, horizontal: &str, vertical: &str) {
        let (at_x, step_x) = self.ticks(0);
        let (at_y, step_y) = self.ticks(1);
        let (ink, grid) = (Style::line(INK, 1.0), Style::line(GRID, 1.0));
        let bottom = self.area.bottom();
        for v in at_x {
            let x = self.at([v, 0.0])[0];
            svg.line([x, self.area.y], [x, bottom], &grid);
            svg.line([x, bottom], [x, bottom + 5.0], &ink);
            svg.text(
                [x, bottom + 17.0],
                &tick_label(v, step_x),
                &Text::new(SMALL_PX).middle(),
            );
        }
        for v in at_y {
            let y = self.at([0.0, v])[1];
            svg.line([self.area.x, y], [self.area.right(), y], &grid);
            svg.line([self.area.x - 5.0, y], [self.area.x, y], &ink);
            svg.text(
                [self.area.x - 8.0, y + 4.0],
                &tick_label(v, step_y),
                &Text::new(SMALL_PX).end(),
            );
        }
        svg.rect(self.area, &ink);
        let c = self.area.centre();
        let text = Text::new(BODY_PX).middle();
        svg.text([c[0], bottom + 36.0], horizontal, &text);
        let x = self.area.x - self.left_room_px() + 14.0;
        svg.text([x, c[1]], vertical, &text.turned(-90.0));
    }

    /// Room left of the chart for numbers and label.
    pub(crate) fn left_room_px(&self) -> f64 {
        let (at, step) = self.ticks(1);
        let widths = at
            .iter()
            .map(|v| text_width_px(&tick_label(*v, step), SMALL_PX, Weight::Regular));
        widths.fold(0.0, f64::max) + 36.0
    }

    fn ticks(&self, k: usize) -> (Vec<f64>, f64) {
        let count = if k == 0 {
            self.area.w / 75.0
        } else {
            self.area.h / 42.0
        };
        ticks(self.low[k], self.high[k], count.max(2.0))
    }
}

/// The range of some values, widened by `margin` of itself and never empty.
pub(crate) fn range(values: impl IntoIterator<Item = f64>, margin: f64) -> Option<[f64; 2]> {
    let (low, high) = extent(values)?;
    let span = high - low;
    if span <= 1e-12 * low.abs().max(high.abs()).max(1e-300) {
        let half = if low == 0.0 { 1.0 } else { low.abs() * 0.1 };
        return Some([low - half, high + half]);
    }
    Some([low - margin * span, high + margin * span])
}

/// The runs of finite points: a line is broken where a value is missing.
pub(crate) fn runs(points: impl IntoIterator<Item = Point>) -> Vec<Vec<Point>> {
    let mut runs: Vec<Vec<Point>> = vec![Vec::new()];
    for p in points {
        if p[0].is_finite() && p[1].is_finite() {
            if let Some(run) = runs.last_mut() {
                run.push(p);
            }
        } else {
            runs.push(Vec::new());
        }
    }
    runs.retain(|run| !run.is_empty());
    runs
}

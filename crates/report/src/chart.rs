//! A chart with two independent axes: frame, ticks, grid lines, and lines broken where a value is missing.
//!
//! ```text
//!           ┌───────────┐ high[1]
//!    label  │           │
//!  (upwards)│   area    │        value v  ->  x = area.x + (v - low) / (high - low) area.w
//!           └───────────┘ low[1]
//!         low[0]      high[0]
//!               label
//! ```
//!
//! The axes have scales of their own; a drawing of a plane, where 1 mm is as long both ways, is `crate::plane`.

use crate::axis::extent;
use crate::colour::INK;
use crate::font::{BODY_PX, SMALL_PX};
use crate::page::BORDER_PX;
use crate::plane::{AxisLabels, LABEL_BELOW_PX, LABEL_LEFT_PX, LEFT_PX};
use crate::svg::{Point, Rect, Style, Svg, Text};
use crate::ticks::{Across, Axis, Overhang, Ticks};

/// Pixels that each tick gets at least, about: across, up.
pub(crate) const APART_PX: [f64; 2] = [75.0, 42.0];

/// A chart placed on the picture; `low` and `high` are left and right, bottom and top.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chart {
    /// Where the lines are drawn, px, without ticks and labels.
    pub(crate) area: Rect,
    /// Values at the left and at the lower edge.
    pub(crate) low: [f64; 2],
    /// Values at the right and at the upper edge. Not checked: that they differ from the lower ones; `range`
    /// sees to it.
    pub(crate) high: [f64; 2],
}

impl Chart {
    /// A chart of `size` pixels at the left border of a page, with room for its axis; its y is still 0.
    pub(crate) fn with_axis_room(size: [f64; 2], across: [f64; 2], up: [f64; 2]) -> Self {
        let mut chart = Self {
            area: Rect {
                x: 0.0,
                y: 0.0,
                w: size[0],
                h: size[1],
            },
            low: [across[0], up[0]],
            high: [across[1], up[1]],
        };
        chart.area.x = BORDER_PX + chart.left_room_px();
        chart
    }

    /// The same chart with its upper edge at `y`.
    pub(crate) fn lowered_to(self, y: f64) -> Self {
        let area = Rect { y, ..self.area };
        Self { area, ..self }
    }

    /// Where a pair of values (across, up) is on the picture; values beyond the ends are outside the
    /// area.
    pub(crate) fn at(&self, v: [f64; 2]) -> Point {
        let t = |k: usize| (v[k] - self.low[k]) / (self.high[k] - self.low[k]);
        [
            self.area.x + t(0) * self.area.w,
            self.area.bottom() - t(1) * self.area.h,
        ]
    }

    /// Grid lines, ticks, numbers and frame; axis labels below and left.
    pub(crate) fn draw_axes(&self, svg: &mut Svg, labels: &AxisLabels) {
        let axis = |k: usize| Axis {
            ticks: self.ticks(k),
            area: self.area,
            font_px: SMALL_PX,
            across: Across::Lines,
            overhang: Overhang::Allowed,
        };
        axis(0).draw_below(svg, |v| self.at([v, 0.0])[0]);
        axis(1).draw_left(svg, |v| self.at([0.0, v])[1]);
        svg.rect(self.area, &Style::line(INK, 1.0));
        let c = self.area.centre();
        let text = Text::new(BODY_PX).middle();
        svg.text(
            [c[0], self.area.bottom() + LABEL_BELOW_PX],
            &labels.horizontal,
            &text,
        );
        let x = self.area.x - self.left_room_px() + LABEL_LEFT_PX;
        svg.text([x, c[1]], &labels.vertical, &text.turned(-90.0));
    }

    /// Room left of the chart for its numbers, ticks and label.
    fn left_room_px(&self) -> f64 {
        self.ticks(1).width_px(SMALL_PX) + LEFT_PX
    }

    /// The ticks across (0) or up (1), about as many as have room and at least two.
    fn ticks(&self, k: usize) -> Ticks {
        let count = [self.area.w / APART_PX[0], self.area.h / APART_PX[1]][k];
        Ticks::about(count.max(2.0), [self.low[k], self.high[k]])
    }
}

/// The range of some values, widened by `margin` of itself to either side and never empty: values that are all
/// equal get a tenth of their size to either side, zero gets 1. Values that are not finite are left out; `None`
/// where none is left.
pub(crate) fn range(values: impl IntoIterator<Item = f64>, margin: f64) -> Option<[f64; 2]> {
    let (low, high) = extent(values)?;
    let span = high - low;
    if span <= 1e-12 * low.abs().max(high.abs()).max(1e-300) {
        let half = if low == 0.0 { 1.0 } else { low.abs() * 0.1 };
        return Some([low - half, high + half]);
    }
    Some([low - margin * span, high + margin * span])
}

/// The runs of finite points, in their order: a line is broken where a value is missing. A run may be a single
/// point.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_is_widened_on_both_sides_and_never_empty() {
        assert_eq!(range([1.0, f64::NAN, 3.0], 0.5), Some([0.0, 4.0]));
        assert_eq!(range([0.0, 0.0], 0.1), Some([-1.0, 1.0]));
        assert_eq!(range([-20.0], 0.0), Some([-22.0, -18.0]));
        assert_eq!(range([f64::NAN], 0.1), None);
    }

    #[test]
    fn a_run_ends_where_a_value_is_missing() {
        let nan = f64::NAN;
        let points = [
            [nan, 0.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [2.0, nan],
            [nan, 3.0],
            [4.0, 4.0],
        ];
        assert_eq!(runs(points), [vec![[0.0, 0.0], [1.0, 1.0]], vec![[4.0, 4.0]]]);
        assert!(runs([[nan, nan]]).is_empty());
    }
}

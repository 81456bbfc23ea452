//! A plane in mm drawn at the same scale in both directions, with ticks and axis labels.
//!
//! The horizontal axis may run either way: maps are seen from the tool side, where base y grows to the left.
//!
//! ```text
//!          left_mm      right_mm
//!  top_mm    ┌────────────┐
//!            │    area    │      x = area.x + px_per_mm |horizontal - left_mm|
//!  bottom_mm └────────────┘      y = area.bottom - px_per_mm |vertical - bottom_mm|
//! ```
//!
//! That is valid for points of the window; beyond its left and lower edge signs change. Charts, whose axes have
//! scales of their own, are `crate::chart`.

use crate::axis::{nice_step, tick_label};
use crate::colour::INK;
use crate::font::{BODY_PX, SMALL_PX, Weight, text_width_px};
use crate::page::BORDER_PX;
use crate::svg::{Point, Rect, Style, Svg, Text};
use crate::ticks::{Across, Axis, Overhang, Ticks};

/// The labels of the two axes, with units: `base y (mm)`. An empty label leaves its room blank.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AxisLabels {
    /// Label below the drawing.
    pub horizontal: String,
    /// Label left of the drawing, reading upwards.
    pub vertical: String,
}

/// Direction in which an axis grows on the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Growth {
    /// To the right.
    #[default]
    Right,
    /// To the left, as base y does when seen from the tool side.
    Left,
}

impl Growth {
    /// The two ends of a range from left to right.
    pub(crate) fn ends(self, [low, high]: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Right => [low, high],
            Self::Left => [high, low],
        }
    }

    /// 1 to the right, -1 to the left.
    pub(crate) fn sign(self) -> f64 {
        match self {
            Self::Right => 1.0,
            Self::Left => -1.0,
        }
    }
}

/// The part of a plane that is drawn; `left_mm` may be greater than `right_mm`, and `bottom_mm` than `top_mm`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Window {
    pub(crate) left_mm: f64,
    pub(crate) right_mm: f64,
    pub(crate) bottom_mm: f64,
    pub(crate) top_mm: f64,
}

/// A window placed on the picture: the map from mm to pixels and back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    /// The part that is shown; it may be wider than requested.
    pub(crate) window: Window,
    /// Where it is drawn, px, without ticks and labels.
    pub(crate) area: Rect,
    /// The scale, the same both ways and always positive.
    pub(crate) px_per_mm: f64,
}

/// How much is written around a drawing: panels of a sheet share their labels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Marks {
    /// Ticks and numbers below.
    pub(crate) horizontal_numbers: bool,
    /// Ticks and numbers at the left.
    pub(crate) vertical_numbers: bool,
    pub(crate) font_px: f64,
    pub(crate) overhang: Overhang,
}

impl Marks {
    /// As a separate drawing has them.
    pub(crate) const ALL: Self = Self {
        horizontal_numbers: true,
        vertical_numbers: true,
        font_px: SMALL_PX,
        overhang: Overhang::Allowed,
    };
}

/// Room below a drawing for tick labels and axis label.
pub(crate) const BELOW_PX: f64 = 44.0;
/// Room left of a drawing for ticks and axis label, without the numbers.
pub(crate) const LEFT_PX: f64 = 36.0;
/// Baselines of the axis labels: below the drawing, and right of the room left of it.
pub(crate) const LABEL_BELOW_PX: f64 = 36.0;
pub(crate) const LABEL_LEFT_PX: f64 = 14.0;

/// Thinnest drawing; a window that would be thinner shows more of the plane.
const THINNEST_PX: f64 = 70.0;

impl Plane {
    /// The window inside a box of `most` (width, height) pixels whose top left corner is at `at`. The area
    /// fills the box in one direction and stays below it in the other; a side thinner than 70 px is widened
    /// with more of the plane to both sides.
    pub(crate) fn fit(window: Window, at: Point, most: [f64; 2]) -> Self {
        let mut window = window;
        let spans = [
            (window.right_mm - window.left_mm).abs(),
            (window.top_mm - window.bottom_mm).abs(),
        ];
        let spans = spans.map(|s| if s.is_finite() { s } else { 0.0 });
        let widest = spans[0].max(spans[1]).max(1e-9);
        let px_per_mm = (most[0] / spans[0].max(widest * 1e-9)).min(most[1] / spans[1].max(widest * 1e-9));
        let size = spans.map(|s| (s * px_per_mm).max(THINNEST_PX.min(most[0]).min(most[1])));
        let widen = |a: &mut f64, b: &mut f64, span: f64, px: f64| {
            let extra = (px / px_per_mm - span) / 2.0;
            let direction = if *b >= *a { 1.0 } else { -1.0 };
            *a -= direction * extra;
            *b += direction * extra;
        };
        widen(&mut window.left_mm, &mut window.right_mm, spans[0], size[0]);
        widen(&mut window.bottom_mm, &mut window.top_mm, spans[1], size[1]);
        Self {
            window,
            area: Rect {
                x: at[0],
                y: at[1],
                w: size[0],
                h: size[1],
            },
            px_per_mm,
        }
    }

    /// The window inside a box of `most` pixels, at the left border of a page with room for the axis; its y is still 0.
    pub(crate) fn with_axis_room(window: Window, most: [f64; 2]) -> Self {
        let left = BORDER_PX + Self::left_room_px(&window);
        Self::fit(window, [left, 0.0], most)
    }

    /// The same drawing with its upper edge at `y`.
    pub(crate) fn lowered_to(self, y: f64) -> Self {
        let area = Rect { y, ..self.area };
        Self { area, ..self }
    }

    /// Where a point of the plane is on the picture.
    pub(crate) fn at(&self, mm: [f64; 2]) -> Point {
        let [across, up] = self.px_per_mm_signed();
        [
            self.area.x + (mm[0] - self.window.left_mm) * across,
            self.area.bottom() - (mm[1] - self.window.bottom_mm) * up,
        ]
    }

    /// The point of the plane that is at a point of the picture: `at` backwards.
    pub(crate) fn mm(&self, at: Point) -> [f64; 2] {
        let [across, up] = self.px_per_mm_signed();
        [
            self.window.left_mm + (at[0] - self.area.x) / across,
            self.window.bottom_mm + (self.area.bottom() - at[1]) / up,
        ]
    }

    /// Pixels to the right and up for each mm; negative along an axis that falls.
    fn px_per_mm_signed(&self) -> [f64; 2] {
        let w = &self.window;
        let signed = |from: f64, to: f64| {
            if to >= from {
                self.px_per_mm
            } else {
                -self.px_per_mm
            }
        };
        [signed(w.left_mm, w.right_mm), signed(w.bottom_mm, w.top_mm)]
    }

    /// Room left of the drawing for tick labels and axis label, px.
    pub(crate) fn left_room_px(window: &Window) -> f64 {
        let step = nice_step(window.top_mm - window.bottom_mm, 5.0);
        let widest = [window.bottom_mm, window.top_mm].map(|v| {
            text_width_px(
                &tick_label((v / step).round() * step, step),
                SMALL_PX,
                Weight::Regular,
            )
        });
        widest[0].max(widest[1]) + LEFT_PX
    }

    /// Frame, ticks with numbers, and the labels of both axes.
    pub(crate) fn draw_axes(&self, svg: &mut Svg, labels: &AxisLabels) {
        self.draw_frame(svg, Marks::ALL);
        let c = self.area.centre();
        let text = Text::new(BODY_PX).middle();
        svg.text(
            [c[0], self.area.bottom() + LABEL_BELOW_PX],
            &labels.horizontal,
            &text,
        );
        let x = self.area.x - Self::left_room_px(&self.window) + LABEL_LEFT_PX;
        svg.text([x, c[1]], &labels.vertical, &text.turned(-90.0));
    }

    /// Frame and ticks with numbers.
    pub(crate) fn draw_frame(&self, svg: &mut Svg, marks: Marks) {
        let w = &self.window;
        let step = self.tick_step_mm(marks.font_px);
        let axis = |step: f64, ends: [f64; 2]| Axis {
            ticks: Ticks::every(step, ends),
            area: self.area,
            font_px: marks.font_px,
            across: Across::Nothing,
            overhang: marks.overhang,
        };
        if marks.horizontal_numbers {
            axis(step[0], [w.left_mm, w.right_mm]).draw_below(svg, |mm| self.at([mm, w.bottom_mm])[0]);
        }
        if marks.vertical_numbers {
            axis(step[1], [w.bottom_mm, w.top_mm]).draw_left(svg, |mm| self.at([w.left_mm, mm])[1]);
        }
        svg.rect(self.area, &Style::line(INK, 1.0));
    }

    /// Ticks far enough apart for their numbers; the same step both ways where that fits.
    fn tick_step_mm(&self, font_px: f64) -> [f64; 2] {
        let w = &self.window;
        let spans = [(w.right_mm - w.left_mm).abs(), (w.top_mm - w.bottom_mm).abs()];
        let mut count = (self.area.w / 34.0).clamp(2.0, 6.0);
        let mut across = nice_step(spans[0], count);
        for _ in 0..4 {
            let numbers = [w.left_mm, w.right_mm].map(|v| tick_label((v / across).round() * across, across));
            let widest = numbers
                .iter()
                .map(|n| text_width_px(n, font_px, Weight::Regular))
                .fold(0.0, f64::max);
            if across * self.px_per_mm >= widest + 8.0 {
                break;
            }
            count *= 0.7;
            across = nice_step(spans[0], count);
        }
        let up = nice_step(spans[1], (self.area.h / 40.0).clamp(2.0, 8.0));
        if across >= up && spans[1] / across >= 2.0 {
            [across, across]
        } else {
            [across, up]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WINDOW: Window = Window {
        left_mm: 400.0,
        right_mm: -400.0,
        bottom_mm: 0.0,
        top_mm: 300.0,
    };

    #[test]
    fn the_scale_is_equal_both_ways() {
        let plane = Plane::fit(WINDOW, [10.0, 20.0], [500.0, 500.0]);
        let (a, b) = (plane.at([0.0, 0.0]), plane.at([-100.0, 100.0]));
        assert!(((b[0] - a[0]) - (a[1] - b[1])).abs() < 1e-9);
        assert!((plane.area.w / plane.area.h - 800.0 / 300.0).abs() < 1e-9);
    }

    #[test]
    fn a_falling_axis_puts_its_first_value_left() {
        let plane = Plane::fit(WINDOW, [10.0, 20.0], [500.0, 500.0]);
        assert!((plane.at([400.0, 0.0])[0] - 10.0).abs() < 1e-9);
        assert!(plane.at([-400.0, 0.0])[0] > 400.0);
    }

    #[test]
    fn a_thin_window_is_widened_at_equal_scale() {
        let thin = Window {
            left_mm: 0.0,
            right_mm: 2000.0,
            bottom_mm: 5.0,
            top_mm: 6.0,
        };
        let plane = Plane::fit(thin, [0.0, 0.0], [500.0, 400.0]);
        assert!((plane.area.h - THINNEST_PX).abs() < 1e-9);
        let shown_mm = plane.window.top_mm - plane.window.bottom_mm;
        assert!((shown_mm * plane.px_per_mm - plane.area.h).abs() < 1e-9);
    }
}

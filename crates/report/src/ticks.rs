//! The numbers along an axis: which ones, how wide they are, and how they are placed below or left of a drawing.
//!
//! ```text
//!       │           │
//!  200 ─┤  drawing  │      tick 5 px, gap 3 px, number; numbers centred on their value
//!       └──┬─────┬──┘
//!         100   200
//! ```
//!
//! A number left of a drawing ends before its tick, a number below is centred under it. Values are in the unit
//! of the axis; the caller gives their positions on the picture, so that charts, planes and bars share
//! this.

use crate::axis::{multiples, nice_step, tick_label};
use crate::colour::{GRID, INK};
use crate::font::{Weight, text_width_px};
use crate::svg::{Rect, Style, Svg, Text};

/// Length of a tick.
const TICK_PX: f64 = 5.0;
/// From the end of a tick to its number.
const GAP_PX: f64 = 3.0;
/// From the middle of a number down to its baseline, as a part of the font size.
const BASELINE: f64 = 0.36;
/// How far a number may extend over the end of its axis with [`Overhang::LeftOut`].
const OVERHANG_PX: f64 = 4.0;

/// Values of an axis that are marked; their labels carry the decimals that the step needs.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ticks {
    /// Rising multiples of the step, in the unit of the axis; none where they would be more than can be read.
    pub(crate) at: Vec<f64>,
    /// Their distance, greater than 0.
    pub(crate) step: f64,
}

impl Ticks {
    /// About `count` nice values between `low` and `high`.
    pub(crate) fn about(count: f64, [low, high]: [f64; 2]) -> Self {
        Self::every(nice_step(high - low, count), [low, high])
    }

    /// The multiples of `step` between `low` and `high`.
    pub(crate) fn every(step: f64, [low, high]: [f64; 2]) -> Self {
        Self {
            at: multiples(low, high, step),
            step,
        }
    }

    /// A value with the decimals that the step needs, so that all numbers of an axis look alike.
    pub(crate) fn label(&self, value: f64) -> String {
        tick_label(value, self.step)
    }

    /// Width of the widest number at this font size; 0 without ticks.
    pub(crate) fn width_px(&self, font_px: f64) -> f64 {
        let widths = self
            .at
            .iter()
            .map(|v| text_width_px(&self.label(*v), font_px, Weight::Regular));
        widths.fold(0.0, f64::max)
    }
}

/// What becomes of a number that would reach over the end of its axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Overhang {
    /// It is written all the same: there is room next to the drawing.
    Allowed,
    /// It is left out: panels are close together, and it would run into the next. The tick stays.
    LeftOut,
}

/// Whether a line crosses the drawing at each tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Across {
    /// A thin grid line at each tick, drawn before what the chart shows.
    Lines,
    /// The tick alone.
    Nothing,
}

/// One axis of a drawing: what is marked on it, and how it looks.
pub(crate) struct Axis {
    pub(crate) ticks: Ticks,
    /// The drawing that the axis belongs to, px.
    pub(crate) area: Rect,
    /// Font size of the numbers.
    pub(crate) font_px: f64,
    pub(crate) across: Across,
    /// Heeded by an axis below the drawing alone.
    pub(crate) overhang: Overhang,
}

impl Axis {
    /// Ticks and numbers below the drawing; `x` gives the position of a value.
    pub(crate) fn draw_below(&self, svg: &mut Svg, x: impl Fn(f64) -> f64) {
        let bottom = self.area.bottom();
        for value in &self.ticks.at {
            let x = x(*value);
            if self.across == Across::Lines {
                svg.line([x, self.area.y], [x, bottom], &Style::line(GRID, 1.0));
            }
            svg.line([x, bottom], [x, bottom + TICK_PX], &Style::line(INK, 1.0));
            let label = self.ticks.label(*value);
            let half = text_width_px(&label, self.font_px, Weight::Regular) / 2.0 - OVERHANG_PX;
            let hangs_over = x - half < self.area.x || x + half > self.area.right();
            if self.overhang == Overhang::Allowed || !hangs_over {
                let y = bottom + TICK_PX + 1.0 + self.font_px;
                svg.text([x, y], &label, &Text::new(self.font_px).middle());
            }
        }
    }

    /// Ticks and numbers left of the drawing; `y` gives the position of a value.
    pub(crate) fn draw_left(&self, svg: &mut Svg, y: impl Fn(f64) -> f64) {
        let left = self.area.x;
        for value in &self.ticks.at {
            let y = y(*value);
            if self.across == Across::Lines {
                svg.line([left, y], [self.area.right(), y], &Style::line(GRID, 1.0));
            }
            svg.line([left - TICK_PX, y], [left, y], &Style::line(INK, 1.0));
            svg.text(
                [left - TICK_PX - GAP_PX, y + self.font_px * BASELINE],
                &self.ticks.label(*value),
                &Text::new(self.font_px).end(),
            );
        }
    }
}

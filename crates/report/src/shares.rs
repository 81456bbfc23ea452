//! The contributions of the joints: the share of each joint in a deviation, signed, with its uncertainty and the total.
//!
//! ```text
//!  label │  joint 1 │ joint 2 │ j3 │       the bar: shares end to end from zero, negative ones to the left
//!        │              ├────◇────┤         the total with its standard uncertainty, in the row below
//!        0        quantity (µm)
//! ```
//!
//! Shares of both signs may be longer together than the total that they make. Not checked: that they add up to
//! it.

use crate::axis::number;
use crate::chart::range;
use crate::colour::{INK, category};
use crate::font::{SMALL_PX, Weight, text_width_px};
use crate::legend::{Entry, Key, diamond};
use crate::page::{BORDER_PX, Heading};
use crate::rows::{Rows, left_px};
use crate::svg::{Point, Rect, Style, Svg, Text};

/// Width of the chart.
const AREA_WIDTH_PX: f64 = 470.0;
/// Height of a bar, and of the row under it for the mark of its total.
const BAR_PX: f64 = 22.0;
const TOTAL_PX: f64 = 16.0;
/// Room right of the bars for the totals in numbers.
const NUMBER_PX: f64 = 92.0;

/// The shares at one point or under one condition.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShareBar {
    /// Name of the point or condition.
    pub label: String,
    /// Signed share of each part in um, in the order of [`ShareBars::parts`]; one that is not finite is left
    /// out.
    pub shares_um: Vec<f64>,
    /// Total in um, marked by a diamond and written at the right.
    pub total_um: Option<f64>,
    /// Standard uncertainty of the total in um, drawn as a whisker to both sides.
    pub total_uncertainty_um: Option<f64>,
}

/// The input of a picture of shares.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShareBars {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// Label of the value axis with unit: `share of in-plane deviation (µm)`.
    pub quantity: String,
    /// Names of the parts: the joints.
    pub parts: Vec<String>,
    /// The bars from top to bottom.
    pub bars: Vec<ShareBar>,
}

impl ShareBars {
    /// The picture as a complete SVG document; no shares gives a picture that says so.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        let Some(range) = self.range_um() else {
            return heading.notice("There is nothing to draw: no shares were given.");
        };
        let left = left_px(self.bars.iter().map(|bar| bar.label.as_str()));
        let row = BAR_PX + self.total_row_px() + 14.0;
        let mut page = heading.page(left + AREA_WIDTH_PX + NUMBER_PX + BORDER_PX);
        let area = Rect {
            x: left,
            y: page.top_px + 4.0,
            w: AREA_WIDTH_PX,
            h: row * self.bars.len() as f64,
        };
        let scale = Rows { area, range };
        scale.draw_axis(&mut page.svg, &self.quantity);
        for (k, bar) in self.bars.iter().enumerate() {
            let middle = area.y + row * (k as f64 + 0.5) - self.total_row_px() / 2.0;
            scale.draw_label(&mut page.svg, &bar.label, middle);
            page.svg
                .layer("share-bar", 1.0, |svg| draw_stacked(svg, &scale, bar, middle));
            let below = area.y + row * (k as f64 + 1.0) - 6.0 - TOTAL_PX / 2.0;
            draw_total(&mut page.svg, &scale, bar, below);
        }
        let zero = scale.x(0.0);
        page.svg
            .line([zero, area.y], [zero, area.bottom()], &Style::line(INK, 1.2));
        page.finish_with_legend(&self.entries(), [left, area.bottom() + 50.0])
    }

    /// The range of the value axis: all ends of bars and zero, with room beyond; `None` where no bar has a value.
    fn range_um(&self) -> Option<[f64; 2]> {
        let mut shares = self.bars.iter().flat_map(|b| &b.shares_um);
        shares.find(|v| v.is_finite())?;
        let [low, high] = range(self.bars.iter().flat_map(ends_um).chain([0.0]), 0.0)?;
        let room = 0.04 * (high - low);
        Some([
            if low < 0.0 { low - room } else { 0.0 },
            if high > 0.0 { high + room } else { 0.0 },
        ])
    }

    /// The parts in their colours, then the mark of the total.
    fn entries(&self) -> Vec<Entry> {
        let parts = self.parts.iter().enumerate();
        let mut entries: Vec<Entry> = parts
            .map(|(k, name)| Entry::new(Key::Field(Style::fill(category(k))), name.clone()))
            .collect();
        if self.bars.iter().any(|b| b.total_um.is_some()) {
            let remark = if self.bars.iter().any(|b| b.total_uncertainty_um.is_some()) {
                "total, ± u"
            } else {
                "total, u not known"
            };
            entries.push(Entry::new(Key::Diamond(total_style()), remark));
        }
        entries
    }

    /// Room under each bar for the mark of its total.
    fn total_row_px(&self) -> f64 {
        if self.bars.iter().any(|b| b.total_um.is_some()) {
            TOTAL_PX
        } else {
            0.0
        }
    }
}

/// The values that a bar reaches.
fn ends_um(bar: &ShareBar) -> Vec<f64> {
    let sum = |sign: f64| {
        bar.shares_um
            .iter()
            .filter(|v| v.is_finite() && **v * sign > 0.0)
            .sum::<f64>()
    };
    let u = bar.total_uncertainty_um.filter(|u| u.is_finite()).unwrap_or(0.0);
    let total = bar.total_um.into_iter().flat_map(|t| [t - u, t + u]);
    [sum(1.0), sum(-1.0)].into_iter().chain(total).collect()
}

/// End to end from zero: positive to the right, negative to the left, the value written where it has room.
fn draw_stacked(svg: &mut Svg, scale: &Rows, bar: &ShareBar, middle: f64) {
    let mut end = [0.0, 0.0];
    for (k, share) in bar.shares_um.iter().enumerate().filter(|(_, v)| v.is_finite()) {
        let side = usize::from(*share < 0.0);
        let (from, to) = (end[side], end[side] + share);
        end[side] = to;
        let x = scale.x(from.min(to));
        let cell = Rect {
            x,
            y: middle - BAR_PX / 2.0,
            w: scale.x(from.max(to)) - x,
            h: BAR_PX,
        };
        svg.rect(cell, &Style::fill(category(k)).outlined("#fff", 0.8));
        let label = number(*share, if share.abs() < 10.0 { 1 } else { 0 });
        if cell.w > text_width_px(&label, 10.0, Weight::Regular) + 6.0 {
            let text = Text::new(10.0).middle().colour("#fff").bold();
            if cell.w > text_width_px(&label, 10.0, Weight::Bold) + 6.0 {
                svg.text([cell.centre()[0], middle + 3.6], &label, &text);
            }
        }
    }
}

/// The diamond, its whisker, and the number at the right; nothing without a total.
fn draw_total(svg: &mut Svg, scale: &Rows, bar: &ShareBar, middle: f64) {
    let Some(total) = bar.total_um.filter(|t| t.is_finite()) else {
        return;
    };
    let u = bar.total_uncertainty_um.filter(|u| u.is_finite() && *u > 0.0);
    let at: Point = [scale.x(total), middle];
    if let Some(u) = u {
        scale.draw_whisker(svg, [total - u, total + u], middle, 4.0);
    }
    svg.polygon(&diamond(at, 5.5), &total_style());
    let decimals = if total.abs() < 10.0 { 1 } else { 0 };
    let spread = u.map_or_else(String::new, |u| format!(" ± {}", number(u, decimals)));
    let label = format!("{}{spread} µm", number(total, decimals));
    svg.text(
        [scale.area.right() + 8.0, middle + 4.0],
        &label,
        &Text::new(SMALL_PX).bold(),
    );
}

fn total_style() -> Style {
    Style::fill("#fff").outlined(INK, 1.5)
}

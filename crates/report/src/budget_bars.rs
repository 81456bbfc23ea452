//! An error budget: a bar for each contribution, then their sum, then the measurement.
//!
//! ```text
//!  contribution │ ████████├──┤      │ 60 µm     largest bias, with twice the scatter beyond it
//!  ─────────────┼───────────────────┤
//!  plain sum    │ ██████████████    │ 200 µm
//!  part         │ █████████████     │ 190 µm
//!               0     quantity (µm)
//! ```
//!
//! The three groups have a colour each. Two times the scatter is drawn as a whisker from the end of its bar.

use crate::colour::{GRID, INK, category};
use crate::font::SMALL_PX;
use crate::legend::{Entry, Key};
use crate::page::{BORDER_PX, Heading};
use crate::rows::{Rows, left_px};
use crate::svg::{Rect, Style, Text};

/// Width of the chart, height of a row and of its bar, room between groups.
const AREA_WIDTH_PX: f64 = 430.0;
const ROW_PX: f64 = 27.0;
const BAR_PX: f64 = 17.0;
const GROUP_PX: f64 = 9.0;
/// Room right of the bars for the numbers.
const NUMBER_PX: f64 = 110.0;

/// The kind of a bar.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BudgetGroup {
    /// One part of the error.
    #[default]
    Contribution,
    /// What several make together.
    Sum,
    /// The measurement, and the part of it that is not explained.
    Measured,
}

impl BudgetGroup {
    const ALL: [BudgetGroup; 3] = [BudgetGroup::Contribution, BudgetGroup::Sum, BudgetGroup::Measured];

    fn colour(self) -> &'static str {
        category(match self {
            BudgetGroup::Contribution => 0,
            BudgetGroup::Sum => 1,
            BudgetGroup::Measured => 2,
        })
    }

    fn name(self) -> &'static str {
        match self {
            BudgetGroup::Contribution => "contribution",
            BudgetGroup::Sum => "together",
            BudgetGroup::Measured => "measured",
        }
    }
}

/// One bar.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BudgetBar {
    /// What it is called.
    pub label: String,
    /// What it is.
    pub group: BudgetGroup,
    /// Its length in um; what is not finite or below 0 has no bar.
    pub largest_um: f64,
    /// Standard deviation of one cut in um, drawn twice as a whisker beyond the bar.
    pub scatter_um: f64,
}

/// The input of a budget.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BudgetBars {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// Label of the value axis with unit: `largest radial deviation (µm)`.
    pub quantity: String,
    /// The bars from top to bottom, group by group.
    pub bars: Vec<BudgetBar>,
}

impl BudgetBars {
    /// The picture as a complete SVG document; no bars gives a picture that says so.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        let most = self.bars.iter().map(end_um).fold(0.0, f64::max);
        if most <= 0.0 {
            return heading.notice("There is nothing to draw: no contribution is larger than 0.");
        }
        let left = left_px(self.bars.iter().map(|bar| bar.label.as_str()));
        let mut page = heading.page(left + AREA_WIDTH_PX + NUMBER_PX + BORDER_PX);
        let breaks = |k: usize| {
            self.bars[..=k]
                .windows(2)
                .filter(|two| two[0].group != two[1].group)
                .count()
        };
        let top = |k: usize| page.top_px + 4.0 + ROW_PX * k as f64 + GROUP_PX * breaks(k) as f64;
        let tops: Vec<f64> = (0..self.bars.len()).map(top).collect();
        let first = page.top_px + 4.0;
        let rows = Rows {
            area: Rect {
                x: left,
                y: first,
                w: AREA_WIDTH_PX,
                h: tops.last().map_or(0.0, |last| last - first) + ROW_PX,
            },
            range: [0.0, 1.05 * most],
        };
        rows.draw_axis(&mut page.svg, &self.quantity);
        for (k, bar) in self.bars.iter().enumerate() {
            let middle = tops[k] + ROW_PX / 2.0;
            if k > 0 && self.bars[k - 1].group != bar.group {
                let y = tops[k] - GROUP_PX / 2.0;
                let ends = [[BORDER_PX, y], [rows.area.right(), y]];
                page.svg.line(ends[0], ends[1], &Style::line(GRID, 1.0));
            }
            rows.draw_label(&mut page.svg, &bar.label, middle);
            let largest = finite(bar.largest_um);
            let field = Rect {
                x: left,
                y: middle - BAR_PX / 2.0,
                w: rows.x(largest) - left,
                h: BAR_PX,
            };
            page.svg.rect(field, &Style::fill(bar.group.colour()));
            if finite(bar.scatter_um) > 0.0 {
                rows.draw_whisker(&mut page.svg, [largest, end_um(bar)], middle, 4.5);
            }
            let number = [rows.area.right() + 8.0, middle + 4.0];
            page.svg.text(number, &reported(bar), &Text::new(SMALL_PX).bold());
        }
        let zero = rows.x(0.0);
        let ends = [[zero, rows.area.y], [zero, rows.area.bottom()]];
        page.svg.line(ends[0], ends[1], &Style::line(INK, 1.2));
        page.finish_with_legend(&self.entries(), [left, rows.area.bottom() + 50.0])
    }

    /// The groups that are there, and the whisker where there is one.
    fn entries(&self) -> Vec<Entry> {
        let is_there = |group: &BudgetGroup| self.bars.iter().any(|bar| bar.group == *group);
        let groups = BudgetGroup::ALL.into_iter().filter(is_there);
        let mut entries: Vec<Entry> = groups
            .map(|group| Entry::new(Key::Field(Style::fill(group.colour())), group.name()))
            .collect();
        if self.bars.iter().any(|bar| finite(bar.scatter_um) > 0.0) {
            entries.push(Entry::line(Style::line(INK, 1.3), "twice the scatter of one cut"));
        }
        entries
    }
}

/// Where bar and whisker end.
fn end_um(bar: &BudgetBar) -> f64 {
    finite(bar.largest_um) + 2.0 * finite(bar.scatter_um)
}

/// 0 for what is not a size.
fn finite(um: f64) -> f64 {
    if um.is_finite() { um.max(0.0) } else { 0.0 }
}

/// The bar in numbers.
fn reported(bar: &BudgetBar) -> String {
    match finite(bar.scatter_um) > 0.0 {
        true => format!(
            "{:.1}, s {:.1} µm",
            finite(bar.largest_um),
            finite(bar.scatter_um)
        ),
        false => format!("{:.1} µm", finite(bar.largest_um)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn budget() -> BudgetBars {
        let bar = |label: &str, group, largest_um, scatter_um| BudgetBar {
            label: label.to_owned(),
            group,
            largest_um,
            scatter_um,
        };
        BudgetBars {
            title: "budget".to_owned(),
            subtitle: String::new(),
            quantity: "largest radial deviation (µm)".to_owned(),
            bars: vec![
                bar("load", BudgetGroup::Contribution, 60.0, 5.0),
                bar("plain sum", BudgetGroup::Sum, 200.0, 0.0),
                bar("part", BudgetGroup::Measured, 190.0, 0.0),
            ],
        }
    }

    #[test]
    fn every_bar_has_its_number_and_every_group_its_entry() {
        let svg = budget().to_svg();
        for text in [
            "60.0, s 5.0 µm",
            "200.0 µm",
            "190.0 µm",
            "together",
            "twice the scatter",
        ] {
            assert!(svg.contains(text), "{text}");
        }
    }

    #[test]
    fn values_that_are_not_finite_give_a_notice_and_never_a_nan() {
        let mut empty = budget();
        for bar in &mut empty.bars {
            (bar.largest_um, bar.scatter_um) = (f64::NAN, f64::INFINITY);
        }
        assert!(empty.to_svg().contains("There is nothing to draw"));
        empty.bars[0].largest_um = 3.0;
        assert!(!empty.to_svg().contains("NaN") && !empty.to_svg().contains("inf"));
    }
}

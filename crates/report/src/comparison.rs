//! Which cell meets the tolerance? A row a cell: mean, 95 % and largest deviation, and the tolerance.
//!
//! ```text
//!  cell A │    ●────┃───────◆      │  93.0 %     mean, 95 %, largest with its standard uncertainty
//!  note   │                 ├─┤    │             a note on the cell
//!         │        ╎ tolerance      │
//!         0     quantity (µm)
//! ```
//!
//! A tolerance more than three times the largest value of all is reported in words: drawn, it would press the rows to
//! the axis. Cells have the colours that series of the same number have on a [`crate::PathPlot`].

use crate::colour::{INK, MUTED, category};
use crate::font::{SMALL_PX, Weight, text_width_px};
use crate::legend::{Entry, Key, diamond};
use crate::page::{BORDER_PX, Heading};
use crate::rows::{Rows, left_px};
use crate::svg::{Rect, Style, Svg, Text};
use crate::tolerance;

/// Width of the chart, height of a row.
const AREA_WIDTH_PX: f64 = 470.0;
const ROW_PX: f64 = 44.0;
/// Room right of the rows for largest value and result.
const NUMBER_PX: f64 = 92.0;
/// Half the height of the mark of the 95 %.
const MARK_PX: f64 = 8.0;
/// The range from mean to largest.
const RANGE_PX: f64 = 5.0;
/// A tolerance so many times the largest value is reported in words.
const FAR: f64 = 3.0;

/// One cell of a comparison.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ComparedCell {
    /// What it is called.
    pub label: String,
    /// A note in a few words; written small in its row.
    pub note: String,
    /// Mean deviation; a number that is not finite counts as none, here and below.
    pub mean_um: Option<f64>,
    /// 95th percentile of the deviations.
    pub p95_um: Option<f64>,
    /// Largest deviation.
    pub largest_um: Option<f64>,
    /// Standard uncertainty of the largest, drawn as a whisker to both sides.
    pub largest_uncertainty_um: Option<f64>,
    /// Permissible deviation.
    pub tolerance_um: Option<f64>,
    /// The result, written at the right: `93.0 %`.
    pub result: String,
}

/// The input of a comparison.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comparison {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// Label of the value axis with unit: `in-plane deviation (µm)`.
    pub quantity: String,
    /// Head of the column of results.
    pub result: String,
    /// The cells from top to bottom.
    pub cells: Vec<ComparedCell>,
}

impl Comparison {
    /// The picture as a complete SVG document; no deviations gives a picture that says so.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        let most = self.cells.iter().filter_map(most_um).fold(0.0, f64::max);
        if most <= 0.0 {
            return heading
                .notice("There is nothing to draw: no cell reaches any point, or all deviations are 0.");
        }
        let near = |tolerance: &f64| *tolerance <= FAR * most;
        let tolerances = self.cells.iter().filter_map(|cell| finite(cell.tolerance_um));
        let right = tolerances.filter(near).fold(most, f64::max);
        let left = left_px(self.cells.iter().map(|cell| cell.label.as_str()));
        let mut page = heading.page(left + AREA_WIDTH_PX + NUMBER_PX + BORDER_PX);
        let rows = Rows {
            area: Rect {
                x: left,
                y: page.top_px + 18.0,
                w: AREA_WIDTH_PX,
                h: ROW_PX * self.cells.len() as f64,
            },
            range: [0.0, 1.06 * right],
        };
        rows.draw_axis(&mut page.svg, &self.quantity);
        let head = [rows.area.right() + 8.0, rows.area.y - 6.0];
        page.svg
            .text(head, &self.result, &Text::new(SMALL_PX).colour(MUTED));
        let top = |k: usize| rows.area.y + ROW_PX * k as f64;
        for (k, cell) in self.cells.iter().enumerate() {
            if let Some(tolerance) = finite(cell.tolerance_um).filter(near) {
                let x = rows.x(tolerance);
                page.svg
                    .line([x, top(k)], [x, top(k) + ROW_PX], &tolerance::style());
            }
        }
        for (k, cell) in self.cells.iter().enumerate() {
            page.svg.layer("compared-cell", 1.0, |svg| {
                draw_cell(svg, &rows, k, cell, top(k));
            });
        }
        let zero = rows.x(0.0);
        page.svg.line(
            [zero, rows.area.y],
            [zero, rows.area.bottom()],
            &Style::line(INK, 1.2),
        );
        page.finish_with_legend(&self.entries(most), [left, rows.area.bottom() + 50.0])
    }

    /// The three marks, then the tolerance: one that all share by its value.
    fn entries(&self, most: f64) -> Vec<Entry> {
        let grey = MUTED;
        let mut entries = vec![
            Entry::new(Key::Dot(Style::fill(grey)), "mean"),
            Entry::new(Key::Stroke(Style::line(grey, 3.0)), "95 % of the points"),
            Entry::new(Key::Diamond(largest_style(grey)), "largest, ± u"),
        ];
        let mut tolerances: Vec<f64> = self
            .cells
            .iter()
            .filter_map(|cell| finite(cell.tolerance_um))
            .collect();
        tolerances.dedup();
        match tolerances[..] {
            [] => {}
            [one] if one > FAR * most => entries.push(tolerance::entry(one, ", beyond this chart")),
            [one] => entries.push(tolerance::entry(one, "")),
            _ => entries.push(Entry::line(tolerance::style(), "tolerance of each")),
        }
        entries
    }
}

/// Label, range with its marks, note below, numbers at the right.
fn draw_cell(svg: &mut Svg, rows: &Rows, k: usize, cell: &ComparedCell, top: f64) {
    let colour = category(k);
    let middle = top + 0.42 * ROW_PX;
    rows.draw_label(svg, &cell.label, middle);
    let at = |um: f64| [rows.x(um), middle];
    let [mean, p95, largest] = [cell.mean_um, cell.p95_um, cell.largest_um].map(finite);
    if let Some((mean, largest)) = mean.zip(largest) {
        svg.line(
            at(mean),
            at(largest),
            &Style::line(colour, RANGE_PX).opacity(0.35),
        );
    }
    if let Some(p95) = p95 {
        let [x, _] = at(p95);
        svg.line(
            [x, middle - MARK_PX],
            [x, middle + MARK_PX],
            &Style::line(colour, 3.0),
        );
    }
    if let Some(largest) = largest {
        if let Some(u) = finite(cell.largest_uncertainty_um).filter(|u| *u > 0.0) {
            let low = (largest - u).max(0.0);
            rows.draw_whisker(svg, [low, largest + u], middle, 4.0);
        }
        svg.polygon(&diamond(at(largest), 6.0), &largest_style(colour));
    }
    if let Some(mean) = mean {
        svg.circle(at(mean), 4.5, &Style::fill(colour).outlined("#fff", 1.0));
    }
    let right = rows.area.right() + 8.0;
    let text = Text::new(SMALL_PX).bold();
    svg.text([right, middle + 4.0], &cell.result, &text);
    let small = Text::new(SMALL_PX - 1.0).colour(MUTED).halo(3.0);
    let below = top + ROW_PX - 6.0;
    let width = text_width_px(&cell.note, SMALL_PX - 1.0, Weight::Regular);
    if width < rows.area.w {
        svg.text([rows.area.x + 6.0, below], &cell.note, &small);
    }
}

fn largest_style(colour: &str) -> Style {
    Style::fill("#fff").outlined(colour, 2.0)
}

/// The farthest that anything of a cell reaches.
fn most_um(cell: &ComparedCell) -> Option<f64> {
    let u = finite(cell.largest_uncertainty_um).unwrap_or(0.0);
    let largest = finite(cell.largest_um).map(|um| um + u);
    [finite(cell.mean_um), finite(cell.p95_um), largest]
        .into_iter()
        .flatten()
        .max_by(f64::total_cmp)
}

fn finite(value: Option<f64>) -> Option<f64> {
    value.filter(|value| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(label: &str, largest: f64, tolerance: f64) -> ComparedCell {
        ComparedCell {
            label: label.to_owned(),
            mean_um: Some(0.5 * largest),
            p95_um: Some(0.9 * largest),
            largest_um: Some(largest),
            tolerance_um: Some(tolerance),
            result: "50.0 %".to_owned(),
            ..ComparedCell::default()
        }
    }

    #[test]
    fn tolerances_are_one_entry_where_all_are_alike_and_none_is_drawn_far_off() {
        let of = |cells: Vec<ComparedCell>| {
            Comparison {
                cells,
                ..Comparison::default()
            }
            .to_svg()
        };
        let alike = of(vec![cell("a", 20.0, 50.0), cell("b", 60.0, 50.0)]);
        assert!(alike.contains("tolerance 50 µm"));
        let apart = of(vec![cell("a", 20.0, 50.0), cell("b", 60.0, 40.0)]);
        assert!(apart.contains("tolerance of each"));
        let far = of(vec![cell("a", 20.0, 500.0), cell("b", 60.0, 500.0)]);
        assert!(far.contains("tolerance 500 µm, beyond this chart"));
    }

    #[test]
    fn a_cell_that_reaches_nothing_has_its_row_and_no_marks() {
        let lost = ComparedCell {
            largest_um: Some(f64::NAN),
            mean_um: None,
            p95_um: None,
            note: "out of reach".to_owned(),
            ..cell("lost", 1.0, 50.0)
        };
        let picture = Comparison {
            cells: vec![cell("a", 20.0, 50.0), lost.clone()],
            ..Comparison::default()
        };
        let svg = picture.to_svg();
        assert!(svg.contains(">lost<") && svg.contains(">out of reach<") && !svg.contains("NaN"));
        let nothing = Comparison {
            cells: vec![lost],
            ..Comparison::default()
        };
        assert!(nothing.to_svg().contains("nothing to draw"));
    }
}

//! A quantity over two others, cell by cell: coloured where it is known, grey where it is not, with a curve
//! that was chosen and marked places.
//!
//! ```text
//!  turn     ┌──────────────────┐
//!  of the   │ ▒▒▒▒▒▒   ~~~~~~  │   cells, one a point and turn: coloured by deviation, grey by reason
//!  tool     │~~~~~~~~~~   ▒▒▒▒ │   ~ the turn chosen
//!           └──────────────────┘
//!            along the path (mm)
//! ```
//!
//! Nothing is interpolated: a cell is as wide as half the way to its neighbours. Neighbours of one look in a column are
//! one rectangle.

use crate::axis::extent;
use crate::chart::Chart;
use crate::colour::{ColourScale, INK};
use crate::colour_bar::ColourBar;
use crate::grid::is_steady;
use crate::legend::{Entry, Key};
use crate::levels::Levels;
use crate::marker::{Marker, draw_sign, marker_entries};
use crate::page::{BORDER_PX, Heading};
use crate::plane::AxisLabels;
use crate::svg::{Rect, Style, Svg};

/// Width and height of the chart.
const AREA_PX: [f64; 2] = [560.0, 320.0];
/// Cells overlap by so much, that no ground shows between them.
const SEAM_PX: f64 = 0.3;
/// Deviations beyond this many times the tolerance have one colour.
const MOST_TOLERANCES: f64 = 4.0;
const NOTHING: &str = "There is nothing to draw: no cell has a value.";

/// The state of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell {
    /// The quantity there, um.
    Deviation(f64),
    /// A joint is outside its limits.
    OutsideJointLimits,
    /// It is too near a singularity.
    Singular,
    /// Two bodies are nearer to each other than demanded.
    InCollision,
    /// It is out of reach, or has no force equilibrium under the load.
    OutOfReach,
    /// Some points have no posture.
    PointsUnreachable,
}

/// The input of a picture of cells.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CellMap {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// The quantity, with its unit: `in-plane deviation (µm)`.
    pub quantity: String,
    /// Labels of the axes, with their units.
    pub labels: AxisLabels,
    /// Place of each column, rising steadily; at least two.
    pub across: Vec<f64>,
    /// Place of each row, rising steadily; at least two.
    pub up: Vec<f64>,
    /// The cells, column after column, each from the first row to the last.
    pub cells: Vec<Cell>,
    /// A curve: its height at each column, NaN where it has none; no curve if empty.
    pub chosen: Vec<f64>,
    /// What that is, for the legend.
    pub chosen_word: String,
    /// The height at which the curve wraps, such as 360 of an angle in degrees.
    pub period: Option<f64>,
    /// Marked places, in the units of the axes.
    pub marks: Vec<Marker>,
    /// Permissible deviation in um, where there is one.
    pub tolerance_um: Option<f64>,
}

/// Colours and legend entries of cells without a value.
const REASONS: [(Cell, &str, &str); 5] = [
    (Cell::OutsideJointLimits, "#9a9a9a", "outside the joint limits"),
    (Cell::Singular, "#c9c9c9", "near a singularity"),
    (Cell::InCollision, "#b3a1c4", "without the demanded clearance"),
    (Cell::OutOfReach, "#f0f0f0", "out of reach"),
    (Cell::PointsUnreachable, "#dcdcdc", "no posture at some points"),
];

impl CellMap {
    /// The picture as a complete SVG document; values that cannot be drawn give one that says why.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        if let Some(reason) = self.obstacle() {
            return heading.notice(reason);
        }
        let shown = self.shown();
        let levels = Levels::covering(shown.iter().flatten().copied());
        let ranges = extent(edges(&self.across)).zip(extent(edges(&self.up)));
        let (Some(levels), Some((across, up))) = (levels, ranges) else {
            return heading.notice(NOTHING);
        };
        let bar = ColourBar {
            levels: &levels,
            scale: ColourScale::default(),
            quantity: &self.quantity,
            tolerance_um: self.tolerance_um,
        };
        let chart = Chart::with_axis_room(AREA_PX, across.into(), up.into());
        let mut page = heading.page(bar.right_of(chart.area).right() + BORDER_PX);
        let chart = chart.lowered_to(page.top_px + 4.0);
        chart.draw_axes(&mut page.svg, &self.labels);
        page.svg.clipped(chart.area, |svg| {
            self.draw_cells(svg, &chart, &levels, &shown);
            self.draw_chosen(svg, &chart);
            for mark in &self.marks {
                draw_sign(svg, chart.at(mark.at_mm), mark.kind);
            }
        });
        page.svg.rect(chart.area, &Style::line(INK, 1.0));
        bar.draw(&mut page.svg, bar.right_of(chart.area));
        let mut entries = Vec::new();
        if !self.chosen.is_empty() {
            entries.push(Entry::new(
                Key::Line(chosen_styles().into()),
                self.chosen_word.as_str(),
            ));
        }
        entries.extend(marker_entries(&self.marks));
        for (cell, colour, word) in REASONS {
            if self.cells.contains(&cell) {
                entries.push(Entry::new(Key::field(colour), word));
            }
        }
        page.finish_with_legend(&entries, [chart.area.x, chart.area.bottom() + 48.0])
    }

    /// Why there is nothing to draw; `None` where there is something.
    fn obstacle(&self) -> Option<&'static str> {
        let [columns, rows] = [self.across.len(), self.up.len()];
        let curve = self.chosen.is_empty() || self.chosen.len() == columns;
        if columns < 2 || rows < 2 || self.cells.len() != columns * rows || !curve {
            return Some(NOTHING);
        }
        if !(is_steady(&self.across) && is_steady(&self.up)) {
            return Some("The values along an axis neither rise steadily nor fall steadily.");
        }
        None
    }

    /// Values as they are coloured: none where there is no value, large ones as four times the tolerance.
    fn shown(&self) -> Vec<Option<f64>> {
        let most = self.tolerance_um.filter(|tolerance| *tolerance > 0.0);
        let most = most.map_or(f64::INFINITY, |tolerance| MOST_TOLERANCES * tolerance);
        let of = |cell: &Cell| match cell {
            Cell::Deviation(um) if um.is_finite() => Some(um.min(most)),
            _ => None,
        };
        self.cells.iter().map(of).collect()
    }

    fn draw_cells(&self, svg: &mut Svg, chart: &Chart, levels: &Levels, shown: &[Option<f64>]) {
        let (across, up) = (edges(&self.across), edges(&self.up));
        let turns = self.up.len();
        let colour = |at: usize| match shown[at] {
            Some(um) => {
                let bands = levels.edge_um.iter().filter(|edge| **edge <= um).count();
                levels.colour(bands.clamp(1, levels.bands()) - 1, ColourScale::default())
            }
            None => {
                let of = REASONS.iter().find(|(cell, ..)| *cell == self.cells[at]);
                of.map_or(REASONS[2].1, |(_, colour, _)| colour).to_owned()
            }
        };
        for (column, ends) in across.windows(2).enumerate() {
            let mut first = 0;
            let looks: Vec<String> = (0..turns).map(|turn| colour(column * turns + turn)).collect();
            for turn in 1..=turns {
                if turn < turns && looks[turn] == looks[first] {
                    continue;
                }
                let [left, bottom] = chart.at([ends[0], up[first]]);
                let [right, top] = chart.at([ends[1], up[turn]]);
                let cell = Rect {
                    x: left,
                    y: top,
                    w: right - left + SEAM_PX,
                    h: bottom - top + SEAM_PX,
                };
                svg.rect(cell, &Style::fill(looks[first].as_str()));
                first = turn;
            }
        }
    }

    /// The curve, a line from column to column, broken where it goes round and where there is none.
    fn draw_chosen(&self, svg: &mut Svg, chart: &Chart) {
        let [low, high] = [self.up[0], self.up[self.up.len() - 1]];
        let inside = |height: f64| match self.period {
            Some(period) if !(height >= low && height <= high) => {
                height - period * ((height - low) / period).floor()
            }
            _ => height,
        };
        let half = self.period.map_or(f64::INFINITY, |period| period / 2.0);
        let mut run: Vec<[f64; 2]> = Vec::new();
        let mut runs = Vec::new();
        for (along, height) in self.across.iter().zip(&self.chosen) {
            let at = [*along, inside(*height)];
            let goes_on = run.last().is_none_or(|before| (at[1] - before[1]).abs() < half);
            if !height.is_finite() || !goes_on {
                runs.push(std::mem::take(&mut run));
            }
            if height.is_finite() {
                run.push(at);
            }
        }
        runs.push(run);
        for run in runs.iter().filter(|run| !run.is_empty()) {
            let line: Vec<[f64; 2]> = run.iter().map(|at| chart.at(*at)).collect();
            for style in chosen_styles() {
                svg.polyline(&line, &style);
            }
        }
    }
}

/// The edges of cells about these values: half-way between neighbours, and as far beyond the ends.
fn edges(values: &[f64]) -> Vec<f64> {
    let mut edges: Vec<f64> = values.windows(2).map(|pair| (pair[0] + pair[1]) / 2.0).collect();
    if let ([first, ..], [.., last]) = (values, values) {
        let begin = edges.first().map_or(first - 0.5, |edge| 2.0 * first - edge);
        let end = edges.last().map_or(last + 0.5, |edge| 2.0 * last - edge);
        edges.insert(0, begin);
        edges.push(end);
    }
    edges
}

fn chosen_styles() -> [Style; 2] {
    [Style::line("#fff", 4.0).opacity(0.85), Style::line(INK, 1.8)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lattice() -> CellMap {
        let up: Vec<f64> = (-9..9).map(|k| f64::from(k) * 20.0).collect();
        let across: Vec<f64> = (0..40).map(|k| f64::from(k) * 2.5).collect();
        let cell = |along: f64, turn: f64| match turn {
            turn if turn > 130.0 => Cell::OutsideJointLimits,
            turn if turn < -150.0 => Cell::OutOfReach,
            turn => Cell::Deviation(40.0 + 0.3 * along + 0.1 * turn),
        };
        CellMap {
            title: "rim".to_owned(),
            quantity: "in-plane deviation (µm)".to_owned(),
            cells: across
                .iter()
                .flat_map(|along| up.iter().map(move |turn| cell(*along, *turn)))
                .collect(),
            chosen: across.iter().map(|along| -140.0 - along).collect(),
            across,
            up,
            tolerance_um: Some(60.0),
            labels: AxisLabels {
                horizontal: "along the path (mm)".to_owned(),
                vertical: "spin of the tool (deg)".to_owned(),
            },
            chosen_word: "turn chosen".to_owned(),
            period: Some(360.0),
            ..CellMap::default()
        }
    }

    #[test]
    fn reasons_that_occur_are_in_the_legend_and_no_other() {
        let svg = lattice().to_svg();
        assert!(
            svg.contains("outside the joint limits") && svg.contains("out of reach"),
            "{svg}"
        );
        assert!(!svg.contains("singularity") && !svg.contains("NaN") && !svg.contains("inf"));
        assert!(svg.contains("spin of the tool (deg)") && svg.contains("turn chosen"));
    }

    #[test]
    fn a_curve_that_wraps_is_two_lines_and_a_missing_one_is_not_drawn() {
        let lines = |svg: &str| svg.matches("<polyline").count() + svg.matches("<path").count();
        let mut odd = lattice();
        // From -140 over -180, which is 180, to -237 deg.
        let round = lines(&odd.to_svg());
        odd.chosen = vec![-100.0; 40];
        let straight = lines(&odd.to_svg());
        odd.chosen = vec![f64::NAN; 40];
        let none = lines(&odd.to_svg());
        assert_eq!((round - none, straight - none), (4, 2));
    }

    #[test]
    fn invalid_input_gives_a_notice() {
        for odd in [
            CellMap::default(),
            CellMap {
                chosen: vec![0.0; 3],
                ..lattice()
            },
            CellMap {
                cells: vec![Cell::Singular; 40 * 18],
                ..lattice()
            },
        ] {
            assert!(odd.to_svg().contains("nothing to draw"));
        }
        let still = CellMap {
            across: vec![1.0; 40],
            ..lattice()
        };
        assert!(still.to_svg().contains("neither rise steadily"));
    }

    #[test]
    fn cells_reach_half_way_to_their_neighbours() {
        assert_eq!(edges(&[0.0, 2.0, 3.0]), [-1.0, 1.0, 2.5, 3.5]);
        assert_eq!(edges(&[]), Vec::<f64>::new());
    }
}

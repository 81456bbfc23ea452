//! How the tool may be turned along a path: deviation over path and turn, what stands in the way, and the turn that was chosen.
//!
//! ```text
//!  turn     ┌──────────────────┐
//!  of the   │ ▒▒▒▒▒▒   ~~~~~~  │   cells, one a point and turn: coloured by deviation, grey by reason
//!  tool     │~~~~~~~~~~   ▒▒▒▒ │   ~ the turn chosen
//!           └──────────────────┘
//!            along the path (mm)
//! ```
//!
//! Nothing is interpolated: a cell is a point of the lattice, as wide as half the way to its neighbours. Neighbours of one
//! look in a column are one rectangle.

use crate::axis::extent;
use crate::chart::Chart;
use crate::colour::{ColourScale, INK};
use crate::colour_bar::ColourBar;
use crate::grid::is_steady;
use crate::legend::{Entry, Key};
use crate::levels::Levels;
use crate::page::{BORDER_PX, Heading};
use crate::plane::AxisLabels;
use crate::svg::{Rect, Style, Svg};

/// Width and height of the chart.
const AREA_PX: [f64; 2] = [560.0, 320.0];
/// Cells overlap by so much, that no ground shows between them.
const SEAM_PX: f64 = 0.3;
/// Deviations beyond this many times the limit have one colour.
const MOST_LIMITS: f64 = 4.0;
const NOTHING: &str = "There is nothing to draw: no turn of the tool is held anywhere.";

/// What a posture at a point and turn comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LatticeCell {
    /// It stands; its deviation in um.
    Holds(f64),
    /// A joint is outside its limits.
    OutsideJointLimits,
    /// It is too near a singularity.
    Singular,
    /// It is out of reach, or gives way under the load.
    OutOfReach,
}

/// What a picture of turns along a path shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PostureLattice {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// What is drawn, with its unit: `in-plane deviation (µm)`.
    pub quantity: String,
    /// Distance along the path of each column in mm, rising steadily; at least two.
    pub along_mm: Vec<f64>,
    /// Turns in degrees, rising steadily; at least two.
    pub turns_deg: Vec<f64>,
    /// The cells, column after column, each from the first turn to the last.
    pub cells: Vec<LatticeCell>,
    /// The turn chosen at each column, deg; NaN where there is none.
    pub chosen_deg: Vec<f64>,
    /// Permissible deviation in um, where there is one.
    pub limit_um: Option<f64>,
}

/// What cells that do not stand look like, with their words.
const REASONS: [(LatticeCell, &str, &str); 3] = [
    (
        LatticeCell::OutsideJointLimits,
        "#9a9a9a",
        "outside the joint limits",
    ),
    (LatticeCell::Singular, "#c9c9c9", "near a singularity"),
    (LatticeCell::OutOfReach, "#f0f0f0", "out of reach"),
];

impl PostureLattice {
    /// The picture as a complete SVG document; values that cannot be drawn give one that says why.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        if let Some(reason) = self.obstacle() {
            return heading.notice(reason);
        }
        let shown = self.shown();
        let levels = Levels::covering(shown.iter().flatten().copied());
        let ranges = extent(edges(&self.along_mm)).zip(extent(edges(&self.turns_deg)));
        let (Some(levels), Some((across, up))) = (levels, ranges) else {
            return heading.notice(NOTHING);
        };
        let bar = ColourBar {
            levels: &levels,
            scale: ColourScale::default(),
            quantity: &self.quantity,
            limit_um: self.limit_um,
        };
        let chart = Chart::beside_axis(AREA_PX, across.into(), up.into());
        let mut page = heading.page(bar.beside(chart.area).right() + BORDER_PX);
        let chart = chart.lowered_to(page.top_px + 4.0);
        let labels = AxisLabels {
            horizontal: "along the path (mm)".to_owned(),
            vertical: "turn of the tool (deg)".to_owned(),
        };
        chart.draw_axes(&mut page.svg, &labels);
        page.svg.clipped(chart.area, |svg| {
            self.draw_cells(svg, &chart, &levels, &shown);
            self.draw_chosen(svg, &chart);
        });
        page.svg.rect(chart.area, &Style::line(INK, 1.0));
        bar.draw(&mut page.svg, bar.beside(chart.area));
        let mut entries = vec![Entry::new(Key::Line(chosen_styles().into()), "turn chosen")];
        for (cell, colour, word) in REASONS {
            if self.cells.contains(&cell) {
                entries.push(Entry::new(Key::field(colour), word));
            }
        }
        page.finish_with_legend(&entries, [chart.area.x, chart.area.bottom() + 48.0])
    }

    /// Why there is nothing to draw; `None` where there is something.
    fn obstacle(&self) -> Option<&'static str> {
        let [columns, turns] = [self.along_mm.len(), self.turns_deg.len()];
        if columns < 2 || turns < 2 || self.cells.len() != columns * turns || self.chosen_deg.len() != columns
        {
            return Some(NOTHING);
        }
        if !(is_steady(&self.along_mm) && is_steady(&self.turns_deg)) {
            return Some("The values along an axis neither rise steadily nor fall steadily.");
        }
        None
    }

    /// Values as they are coloured: none where nothing stands, large ones as four times the limit.
    fn shown(&self) -> Vec<Option<f64>> {
        let most = self.limit_um.filter(|limit| *limit > 0.0);
        let most = most.map_or(f64::INFINITY, |limit| MOST_LIMITS * limit);
        let of = |cell: &LatticeCell| match cell {
            LatticeCell::Holds(um) if um.is_finite() => Some(um.min(most)),
            _ => None,
        };
        self.cells.iter().map(of).collect()
    }

    fn draw_cells(&self, svg: &mut Svg, chart: &Chart, levels: &Levels, shown: &[Option<f64>]) {
        let (across, up) = (edges(&self.along_mm), edges(&self.turns_deg));
        let turns = self.turns_deg.len();
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

    /// The turn chosen, a line from column to column, broken where it goes round and where there is none.
    fn draw_chosen(&self, svg: &mut Svg, chart: &Chart) {
        let [low, high] = [self.turns_deg[0], self.turns_deg[self.turns_deg.len() - 1]];
        let inside = |deg: f64| {
            let turned = deg - 360.0 * ((deg - low) / 360.0).floor();
            if deg >= low && deg <= high { deg } else { turned }
        };
        let mut run: Vec<[f64; 2]> = Vec::new();
        let mut runs = Vec::new();
        for (along, deg) in self.along_mm.iter().zip(&self.chosen_deg) {
            let at = [*along, inside(*deg)];
            let goes_on = run.last().is_none_or(|before| (at[1] - before[1]).abs() < 180.0);
            if !deg.is_finite() || !goes_on {
                runs.push(std::mem::take(&mut run));
            }
            if deg.is_finite() {
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

    fn lattice() -> PostureLattice {
        let turns_deg: Vec<f64> = (-9..9).map(|k| f64::from(k) * 20.0).collect();
        let along_mm: Vec<f64> = (0..40).map(|k| f64::from(k) * 2.5).collect();
        let cell = |along: f64, turn: f64| match turn {
            turn if turn > 130.0 => LatticeCell::OutsideJointLimits,
            turn if turn < -150.0 => LatticeCell::OutOfReach,
            turn => LatticeCell::Holds(40.0 + 0.3 * along + 0.1 * turn),
        };
        PostureLattice {
            title: "rim".to_owned(),
            quantity: "in-plane deviation (µm)".to_owned(),
            cells: along_mm
                .iter()
                .flat_map(|along| turns_deg.iter().map(move |turn| cell(*along, *turn)))
                .collect(),
            chosen_deg: along_mm.iter().map(|along| -140.0 - along).collect(),
            along_mm,
            turns_deg,
            limit_um: Some(60.0),
            ..PostureLattice::default()
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
        assert!(svg.contains("turn of the tool (deg)") && svg.contains("turn chosen"));
    }

    #[test]
    fn a_turn_that_goes_round_is_two_lines_and_one_that_is_none_is_none() {
        let lines = |svg: &str| svg.matches("<polyline").count() + svg.matches("<path").count();
        let mut odd = lattice();
        // From -140 over -180, which is 180, to -237 deg.
        let round = lines(&odd.to_svg());
        odd.chosen_deg = vec![-100.0; 40];
        let straight = lines(&odd.to_svg());
        odd.chosen_deg = vec![f64::NAN; 40];
        let none = lines(&odd.to_svg());
        assert_eq!((round - none, straight - none), (4, 2));
    }

    #[test]
    fn what_cannot_be_drawn_says_so() {
        for odd in [
            PostureLattice::default(),
            PostureLattice {
                chosen_deg: Vec::new(),
                ..lattice()
            },
            PostureLattice {
                cells: vec![LatticeCell::Singular; 40 * 18],
                ..lattice()
            },
        ] {
            assert!(odd.to_svg().contains("nothing to draw"));
        }
        let still = PostureLattice {
            along_mm: vec![1.0; 40],
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

//! The deviation along a path: one line a load case, their envelope, and the tolerance.
//!
//! The chart shows zero and, unless it is more than three times the largest value, the tolerance; values that are
//! all positive are on the axis. A far tolerance is reported in words at the upper edge.

use crate::chart::{Chart, range, runs};
use crate::colour::{INK, category};
use crate::font::{SMALL_PX, Weight, text_width_px};
use crate::legend::Entry;
use crate::page::{BORDER_PX, Heading};
use crate::plane::AxisLabels;
use crate::sections::{SECTIONS, Samples, Sections};
use crate::svg::{Point, Style, Svg};
use crate::tolerance;

/// Width and height of the chart.
const AREA_PX: [f64; 2] = [560.0, 300.0];

/// One line of a chart: pairs of position and value, as many as the shorter list has.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Name for the legend.
    pub name: String,
    /// Path length, angle or time at each sample, in the unit of the axis label; need not rise.
    pub position: Vec<f64>,
    /// Deviation in um at each sample; a value that is not finite breaks the line.
    pub deviation_um: Vec<f64>,
}

impl Series {
    /// The samples as (position, deviation).
    pub(crate) fn points(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.position
            .iter()
            .zip(&self.deviation_um)
            .map(|(x, y)| [*x, *y])
    }

    fn samples(&self) -> Samples<'_> {
        Samples {
            position: &self.position,
            value: &self.deviation_um,
        }
    }

    /// The line with the largest value of each section.
    fn by_sections(&self, sections: Sections) -> Series {
        let (position, deviation_um) = sections.largest(self.samples());
        Series {
            name: self.name.clone(),
            position,
            deviation_um,
        }
    }
}

/// A tolerance so many times the largest value is reported in words: drawn, it would press the lines to the axis.
const FAR: f64 = 3.0;

/// The input of a path plot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathPlot {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// Label of the horizontal axis with unit: `path length (mm)`.
    pub position_label: String,
    /// Label of the vertical axis with unit: `in-plane deviation (µm)`.
    pub quantity: String,
    /// The load cases.
    pub series: Vec<Series>,
    /// Largest value over the cases at each position; drawn as a strong line over a pale band down to the axis.
    /// Not checked: that it is the largest.
    pub envelope: Option<Series>,
    /// Permissible deviation in um; one that is not finite counts as none.
    pub tolerance_um: Option<f64>,
}

impl PathPlot {
    /// The plot as a complete SVG document; no values gives a picture that says so.
    /// Lines that swing too often to be seen are drawn by sections, with the largest value of each.
    pub fn to_svg(&self) -> String {
        match Sections::of(self.series.iter().chain(&self.envelope).map(Series::samples)) {
            Some(sections) => self.by_sections(sections).drawn(),
            None => self.drawn(),
        }
    }

    /// The plot with the largest values of each section.
    fn by_sections(&self, sections: Sections) -> PathPlot {
        PathPlot {
            position_label: format!(
                "{}: largest value in each of {SECTIONS} sections",
                self.position_label
            ),
            series: self
                .series
                .iter()
                .map(|line| line.by_sections(sections))
                .collect(),
            envelope: self.envelope.as_ref().map(|line| line.by_sections(sections)),
            ..self.clone()
        }
    }

    fn drawn(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        let finite = || self.points().filter(|p| p.iter().all(|v| v.is_finite()));
        let tolerance = self.tolerance_um.filter(|l| l.is_finite());
        let largest = finite().map(|p| p[1].abs()).fold(0.0, f64::max);
        let (tolerance, far_tolerance) = match tolerance {
            Some(tolerance) if largest > 0.0 && tolerance > FAR * largest => (None, Some(tolerance)),
            tolerance => (tolerance, None),
        };
        let x = range(finite().map(|p| p[0]), 0.0);
        let y = range(finite().map(|p| p[1]).chain([0.0]).chain(tolerance), 0.06);
        let (Some(x), Some([low, high]), Some(_)) = (x, y, finite().next()) else {
            return heading.notice("There is nothing to draw: the path has no values.");
        };
        // Values that are all positive are on the axis.
        let lowest = if finite().all(|p| p[1] >= 0.0) { 0.0 } else { low };
        let chart = Chart::with_axis_room(AREA_PX, x, [lowest, high]);
        let mut page = heading.page(chart.area.right() + BORDER_PX + 8.0);
        let chart = chart.lowered_to(page.top_px + 4.0);
        let labels = AxisLabels {
            horizontal: self.position_label.clone(),
            vertical: self.quantity.clone(),
        };
        chart.draw_axes(&mut page.svg, &labels);
        page.svg.clipped(chart.area, |svg| self.draw_lines(svg, &chart));
        if let Some(tolerance) = tolerance {
            self.draw_tolerance(&mut page.svg, &chart, tolerance);
        }
        if let Some(tolerance) = far_tolerance {
            let label = format!("{}, above this chart", tolerance::label(tolerance));
            let at = [chart.area.right() - 6.0, chart.area.y + 15.0];
            page.svg.text(at, &label, &tolerance::text().end().halo(3.0));
        }
        page.finish_with_legend(&self.entries(), [chart.area.x, chart.area.bottom() + 50.0])
    }

    /// The points of all lines.
    fn points(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.series.iter().chain(&self.envelope).flat_map(Series::points)
    }

    /// One entry for each case, then the envelope.
    fn entries(&self) -> Vec<Entry> {
        let cases = self.series.iter().enumerate();
        let mut entries: Vec<Entry> = cases
            .map(|(k, series)| Entry::line(case_style(k), series.name.clone()))
            .collect();
        let envelope = self.envelope.iter();
        entries.extend(envelope.map(|series| Entry::line(envelope_style(), series.name.clone())));
        entries
    }

    /// The envelope first, the cases over it; a value alone between gaps is a dot.
    fn draw_lines(&self, svg: &mut Svg, chart: &Chart) {
        if let Some(envelope) = &self.envelope {
            let zero = chart.at([0.0, 0.0_f64.max(chart.low[1])])[1];
            for run in runs(envelope.points().map(|p| chart.at(p))) {
                let mut area = run.clone();
                area.extend(run.last().map(|p| [p[0], zero]));
                area.extend(run.first().map(|p| [p[0], zero]));
                svg.polygon(&area, &Style::fill(INK).opacity(0.07));
                svg.polyline(&run, &envelope_style());
            }
        }
        for (k, series) in self.series.iter().enumerate() {
            for run in runs(series.points().map(|p| chart.at(p))) {
                match run.as_slice() {
                    [single] => svg.circle(*single, 2.5, &Style::fill(category(k))),
                    _ => svg.polyline(&run, &case_style(k)),
                }
            }
        }
    }

    /// The tolerance with its label at the right end, on the side with fewer lines.
    fn draw_tolerance(&self, svg: &mut Svg, chart: &Chart, tolerance: f64) {
        let y = chart.at([0.0, tolerance])[1];
        svg.line([chart.area.x, y], [chart.area.right(), y], &tolerance::style());
        let label = tolerance::label(tolerance);
        let half = text_width_px(&label, SMALL_PX, Weight::Bold) / 2.0 + 4.0;
        let all: Vec<Point> = self.points().map(|p| chart.at(p)).collect();
        let crowd = |x: f64, text_y: f64| {
            all.iter()
                .filter(|p| (p[0] - x).abs() < half && (p[1] - text_y + 4.0).abs() < 11.0)
                .count()
        };
        // Trial places along the line, from the preferred one on.
        let places = [0.9, 0.1, 0.5, 0.7, 0.3]
            .map(|t| (chart.area.x + half + 4.0) * (1.0 - t) + (chart.area.right() - half - 4.0) * t);
        let above = places.iter().map(|x| [*x, y - 6.0]);
        let below = places.iter().map(|x| [*x, y + 15.0]);
        let inside = |p: &[f64; 2]| p[1] > chart.area.y + 12.0 && p[1] < chart.area.bottom() - 4.0;
        let best = above
            .chain(below)
            .filter(inside)
            .min_by_key(|p| crowd(p[0], p[1]));
        let at = best.unwrap_or([places[0], y - 6.0]);
        svg.text(at, &label, &tolerance::text().middle().halo(3.0));
    }
}

fn case_style(index: usize) -> Style {
    Style::line(category(index), 1.8)
}

fn envelope_style() -> Style {
    Style::line(INK, 2.4).opacity(0.75)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tolerance_far_above_the_values_is_reported_in_words_and_does_not_press_them_down() {
        let plot = |tolerance_um| PathPlot {
            series: vec![Series {
                name: "case 1".to_owned(),
                position: vec![0.0, 1.0, 2.0],
                deviation_um: vec![10.0, -20.0, 15.0],
            }],
            tolerance_um: Some(tolerance_um),
            ..PathPlot::default()
        };
        let (near, far) = (plot(60.0).to_svg(), plot(61.0).to_svg());
        assert!(near.contains("tolerance 60 µm<") && !near.contains("above this chart"));
        assert!(far.contains("tolerance 61 µm, above this chart"));
        // The number of the highest line of the grid.
        assert!(near.contains(">60<") && !far.contains(">60<"), "{far}");
    }
}

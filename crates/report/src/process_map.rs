//! What a cut may be: the deviation over two of its quantities, with the line of the tolerance and the cut as it stands.

use crate::axis::extent;
use crate::chart::Chart;
use crate::colour::{ColourScale, INK};
use crate::colour_bar::ColourBar;
use crate::contours::{Lattice, Ring};
use crate::levels::Levels;
use crate::limit;
use crate::line_label::{Labelled, Room, write_labels};
use crate::page::{BORDER_PX, Entry, Key, diamond, legend, notice, title_block};
use crate::plane::AxisLabels;
use crate::svg::{Ends, Point, Rect, Style, Svg, Text, trace};

const AREA_PX: [f64; 2] = [480.0, 360.0];
/// Deviations beyond this many times the limit have one colour: nobody cuts there.
const MOST_LIMITS: f64 = 4.0;

/// What a picture of permitted cuts shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProcessMap {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// Axis labels with units.
    pub axes: AxisLabels,
    /// What is drawn, with its unit: `largest deviation across the tool (µm)`.
    pub quantity: String,
    /// Values along the horizontal axis, rising.
    pub horizontal: Vec<f64>,
    /// Values along the vertical axis, rising.
    pub vertical: Vec<f64>,
    /// Deviation in um, row by row from the bottom; infinite where the cut cannot be held at all.
    pub deviation_um: Vec<f64>,
    /// Permissible deviation in um.
    pub limit_um: f64,
    /// The cut as it stands: horizontal and vertical value.
    pub drawn: Option<[f64; 2]>,
}

impl ProcessMap {
    /// The picture as a complete SVG document; no values give one that says so.
    pub fn to_svg(&self) -> String {
        let most = MOST_LIMITS * self.limit_um;
        let shown: Vec<f64> = self.deviation_um.iter().map(|um| um.min(most)).collect();
        let sizes = [self.horizontal.len(), self.vertical.len()];
        let is_field = sizes[0] >= 2 && sizes[1] >= 2 && shown.len() == sizes[0] * sizes[1];
        let levels = Levels::covering(shown.iter().copied()).filter(|_| is_field);
        let ranges = extent(self.horizontal.iter().copied()).zip(extent(self.vertical.iter().copied()));
        let (Some(levels), Some((across, up))) = (levels, ranges) else {
            return notice(
                &self.title,
                &self.subtitle,
                "There is nothing to draw: no cut has a value.",
            );
        };
        let bar = ColourBar {
            levels: &levels,
            scale: ColourScale::default(),
            quantity: &self.quantity,
            limit_um: Some(self.limit_um),
        };
        let area = Rect {
            x: 0.0,
            y: 0.0,
            w: AREA_PX[0],
            h: AREA_PX[1],
        };
        let chart = Chart {
            area,
            low: [across.0, up.0],
            high: [across.1, up.1],
        };
        let left = BORDER_PX + chart.left_room_px();
        let width = left + AREA_PX[0] + 22.0 + bar.width_px(AREA_PX[1]) + BORDER_PX;
        let mut svg = Svg::new();
        let top = title_block(&mut svg, &self.title, &self.subtitle, width);
        let chart = Chart {
            area: Rect {
                x: left,
                y: top + 4.0,
                ..area
            },
            ..chart
        };
        chart.draw(&mut svg, &self.axes.horizontal, &self.axes.vertical);
        svg.clipped(chart.area, |svg| self.draw_field(svg, &chart, &levels, &shown));
        svg.rect(chart.area, &Style::line(INK, 1.0));
        let bar_area = Rect {
            x: chart.area.right() + 22.0,
            w: 0.0,
            ..chart.area
        };
        bar.draw(&mut svg, bar_area);
        let mut entries = vec![limit::entry(self.limit_um, ": cuts below hold it")];
        if let Some(at) = self.drawn {
            let style = Style::fill("#ffffff").outlined(INK, 1.6);
            svg.polygon(&diamond(chart.at(at), 6.0), &style);
            entries.push(Entry::new(Key::Diamond(style), "the cut as it stands"));
        }
        let bottom = legend(
            &mut svg,
            &entries,
            [left, chart.area.bottom() + 48.0],
            width - left - BORDER_PX,
        );
        svg.finish(width, bottom + BORDER_PX, &self.title)
    }

    fn draw_field(&self, svg: &mut Svg, chart: &Chart, levels: &Levels, shown: &[f64]) {
        let lattice = Lattice {
            horizontal_mm: &self.horizontal,
            vertical_mm: &self.vertical,
            samples: shown,
        };
        let line = |points: &[[f64; 2]]| points.iter().map(|v| chart.at(*v)).collect::<Vec<Point>>();
        let path = |rings: &[Ring]| {
            rings
                .iter()
                .map(|ring| trace(&line(ring), Ends::Closed))
                .collect::<String>()
        };
        let scale = ColourScale::default();
        svg.rect(chart.area, &Style::fill(levels.colour(0, scale)));
        for (band, rings) in lattice.areas_from(levels.inner_um()).iter().enumerate() {
            svg.path(&path(rings), &Style::fill(levels.colour(band + 1, scale)));
        }
        let mut labels = Vec::new();
        for (lines, level) in lattice.lines_at(levels.inner_um()).iter().zip(levels.inner_um()) {
            for points in lines.iter().map(|points| line(points)) {
                svg.polyline(&points, &Style::line(INK, 0.6).opacity(0.55));
                // A line that coincides with the limit carries the limit's label.
                if (level - self.limit_um).abs() < 0.05 * levels.step_um {
                    continue;
                }
                labels.push(Labelled {
                    points,
                    text: levels.label(*level),
                    look: Text::new(10.0).halo(3.0),
                });
            }
        }
        for points in lattice.lines_at(&[self.limit_um]).into_iter().flatten() {
            let points = line(&points);
            svg.polyline(&points, &limit::style());
            let label = Labelled {
                points,
                text: limit::label(self.limit_um),
                look: limit::text(),
            };
            labels.insert(0, label);
        }
        let room = Room {
            area: chart.area,
            free: &|_| true,
            obstacles: &[],
        };
        write_labels(svg, &labels, &room);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map() -> ProcessMap {
        let axis: Vec<f64> = (1..=12).map(|k| f64::from(k) * 0.01).collect();
        let deviation = |x: f64, y: f64| (x + 0.02) * y * 20_000.0;
        ProcessMap {
            title: "ring".to_owned(),
            axes: AxisLabels {
                horizontal: "feed per tooth (mm)".to_owned(),
                vertical: "axial depth (mm)".to_owned(),
            },
            quantity: "largest deviation across the tool (µm)".to_owned(),
            deviation_um: axis
                .iter()
                .flat_map(|y| axis.iter().map(move |x| deviation(*x, *y)))
                .collect(),
            horizontal: axis.clone(),
            vertical: axis,
            limit_um: 100.0,
            drawn: Some([0.05, 0.06]),
            ..ProcessMap::default()
        }
    }

    #[test]
    fn the_limit_is_a_line_and_the_cut_a_sign() {
        let svg = map().to_svg();
        assert!(
            svg.contains("limit 100 µm") && svg.contains("the cut as it stands"),
            "{svg}"
        );
        assert!(svg.contains("axial depth (mm)") && !svg.contains("NaN"), "{svg}");
        let without = ProcessMap { drawn: None, ..map() };
        assert!(!without.to_svg().contains("as it stands"));
    }

    #[test]
    fn what_cannot_be_held_is_drawn_like_the_most_and_nothing_is_said_to_be_so() {
        let mut endless = map();
        endless.deviation_um[143] = f64::INFINITY;
        let svg = endless.to_svg();
        assert!(!svg.contains("inf") && !svg.contains("NaN"), "{svg}");
        for empty in [
            ProcessMap::default(),
            ProcessMap {
                deviation_um: vec![1.0],
                ..map()
            },
        ] {
            assert!(empty.to_svg().contains("nothing to draw"));
        }
    }
}

//! The deviation over two quantities of a cut, with the line of the tolerance and the nominal cut.
//!
//! The quantities may be any two of a cut, such as depth and feed, each in its own unit. Values go straight
//! between the points of the lattice, not in curves as on a map.

use armill_core::marching_squares::ScalarField;

use crate::axis::extent;
use crate::chart::Chart;
use crate::colour::{ColourScale, INK};
use crate::colour_bar::ColourBar;
use crate::grid::is_steady;
use crate::legend::{Entry, Key, diamond};
use crate::levels::Levels;
use crate::levels_drawing::{LevelLines, Placed};
use crate::line_label::{LabelRoom, write_labels};
use crate::page::{BORDER_PX, Heading};
use crate::plane::AxisLabels;
use crate::svg::{Style, Svg};
use crate::tolerance;

/// Width and height of the chart.
const AREA_PX: [f64; 2] = [480.0, 360.0];
/// Deviations beyond this many times the tolerance have one colour: such cuts are of no use.
const MOST_TOLERANCES: f64 = 4.0;
const NOTHING: &str = "There is nothing to draw: no cut has a value.";

/// The input of a picture of permitted cuts. Values beyond four times the tolerance are drawn as four times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProcessMap {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// Axis labels with units.
    pub axes: AxisLabels,
    /// The quantity, with its unit: `largest deviation across the tool (µm)`.
    pub quantity: String,
    /// Values along the horizontal axis, rising or falling steadily; at least two.
    pub horizontal: Vec<f64>,
    /// Values along the vertical axis, rising or falling steadily; at least two.
    pub vertical: Vec<f64>,
    /// Deviation in um, row by row from the bottom, each from left to right; infinite where the cut cannot be
    /// reached at all.
    pub deviation_um: Vec<f64>,
    /// Permissible deviation in um.
    pub tolerance_um: f64,
    /// The nominal cut: horizontal and vertical value, in the units of the axes; one that is not finite is
    /// not drawn.
    pub drawn: Option<[f64; 2]>,
}

impl ProcessMap {
    /// The picture as a complete SVG document; values that cannot be drawn give one that says why.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        if let Some(reason) = self.obstacle() {
            return heading.notice(reason);
        }
        let most = MOST_TOLERANCES * self.tolerance_um;
        let shown: Vec<f64> = self.deviation_um.iter().map(|um| um.min(most)).collect();
        let levels = Levels::covering(shown.iter().copied());
        let ranges = extent(self.horizontal.iter().copied()).zip(extent(self.vertical.iter().copied()));
        let (Some(levels), Some((across, up))) = (levels, ranges) else {
            return heading.notice(NOTHING);
        };
        let bar = ColourBar {
            levels: &levels,
            scale: ColourScale::default(),
            quantity: &self.quantity,
            tolerance_um: Some(self.tolerance_um),
        };
        let chart = Chart::with_axis_room(AREA_PX, across.into(), up.into());
        let mut page = heading.page(bar.right_of(chart.area).right() + BORDER_PX);
        let chart = chart.lowered_to(page.top_px + 4.0);
        chart.draw_axes(&mut page.svg, &self.axes);
        page.svg
            .clipped(chart.area, |svg| self.draw_field(svg, &chart, &levels, &shown));
        page.svg.rect(chart.area, &Style::line(INK, 1.0));
        bar.draw(&mut page.svg, bar.right_of(chart.area));
        let mut entries = vec![tolerance::entry(self.tolerance_um, ": cuts below are within it")];
        if let Some(at) = self.drawn.filter(|at| at.iter().all(|v| v.is_finite())) {
            let style = Style::fill("#ffffff").outlined(INK, 1.6);
            page.svg.polygon(&diamond(chart.at(at), 6.0), &style);
            entries.push(Entry::new(Key::Diamond(style), "nominal cut"));
        }
        page.finish_with_legend(&entries, [chart.area.x, chart.area.bottom() + 48.0])
    }

    /// Why there is nothing to draw; `None` where there is something.
    fn obstacle(&self) -> Option<&'static str> {
        let sizes = [self.horizontal.len(), self.vertical.len()];
        if sizes[0] < 2 || sizes[1] < 2 || self.deviation_um.len() != sizes[0] * sizes[1] {
            return Some(NOTHING);
        }
        if !(is_steady(&self.horizontal) && is_steady(&self.vertical)) {
            return Some("The values along an axis neither rise steadily nor fall steadily.");
        }
        if self.deviation_um.iter().any(|um| um.is_nan()) {
            return Some("A deviation is not a number.");
        }
        let tolerance = self.tolerance_um.is_finite() && self.tolerance_um > 0.0;
        (!tolerance).then_some("The tolerance is not a number above zero.")
    }

    /// Bands, iso-lines, the line of the tolerance and labels, cut to the chart by the caller.
    fn draw_field(&self, svg: &mut Svg, chart: &Chart, levels: &Levels, shown: &[f64]) {
        let at = |values: [f64; 2]| chart.at(values);
        let placed = Placed {
            field: ScalarField {
                x: &self.horizontal,
                y: &self.vertical,
                values: shown,
            },
            at: &at,
            area: chart.area,
        };
        placed.draw_bands(svg, levels, ColourScale::default());
        let lines = LevelLines::of(&placed, levels, Some(self.tolerance_um));
        lines.draw_iso(svg, &Style::line(INK, 0.6).opacity(0.55));
        lines.draw_tolerance(svg, &[tolerance::style()]);
        let room = LabelRoom {
            area: chart.area,
            free: &|_| true,
            obstacles: &[],
        };
        write_labels(svg, &lines.labels(), &room);
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
            tolerance_um: 100.0,
            drawn: Some([0.05, 0.06]),
            ..ProcessMap::default()
        }
    }

    #[test]
    fn the_tolerance_is_a_line_and_the_cut_a_sign() {
        let svg = map().to_svg();
        assert!(
            svg.contains("tolerance 100 µm") && svg.contains("nominal cut"),
            "{svg}"
        );
        assert!(svg.contains("axial depth (mm)") && !svg.contains("NaN"), "{svg}");
        let without = ProcessMap { drawn: None, ..map() };
        assert!(!without.to_svg().contains("nominal cut"));
    }

    #[test]
    fn unreachable_cuts_are_drawn_like_the_largest_and_empty_input_is_reported() {
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

    #[test]
    fn constant_values_and_invalid_numbers_are_refused() {
        let axis = vec![0.05; 12];
        let odd = [
            ProcessMap {
                horizontal: axis.clone(),
                ..map()
            },
            ProcessMap {
                vertical: axis,
                ..map()
            },
        ];
        for odd in odd {
            assert!(odd.to_svg().contains("neither rise steadily nor fall"));
        }
        let without = ProcessMap {
            tolerance_um: f64::NAN,
            ..map()
        };
        assert!(without.to_svg().contains("The tolerance is not a number"));
        let mut unknown = map();
        unknown.deviation_um[7] = f64::NAN;
        assert!(unknown.to_svg().contains("A deviation is not a number"));
    }
}

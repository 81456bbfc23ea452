//! Up to which depth of cut is milling stable at a spindle speed?
//!
//! ```text
//!  depth of │ ░░╲░░░░╱╲░░░╱   unstable above the lobes
//!  cut (mm) │    ╲__╱  ╲_╱ ◇  the programmed cut
//!           │ - - - - - - -   limit by mode coupling
//!           └──────────────
//!             spindle speed (rpm)
//! ```
//!
//! Speeds whose limit is deeper than the chart, or not known, have none: the curve is interrupted there.

use crate::chart::{Chart, runs};
use crate::colour::{INK, MUTED, OVER, SIGNAL};
use crate::legend::{Entry, Key, diamond};
use crate::page::{BORDER_PX, Heading};
use crate::plane::AxisLabels;
use crate::svg::{Point, Style};

/// Width and height of the chart.
const AREA_PX: [f64; 2] = [560.0, 320.0];
/// The chart ends at this multiple of the deepest curve point, or of the programmed depth.
const HEADROOM: f64 = 1.1;
const NOTHING: &str = "There is nothing to draw: no speed has a limit of the depth.";

/// The input of the picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StabilityPlot {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// Spindle speeds, rising.
    pub speeds_rpm: Vec<f64>,
    /// Limit of the depth at each speed; one that is not finite is deeper than what was sought.
    pub depths_mm: Vec<f64>,
    /// Deepest cut that the chart shows; the deepest limit if left out.
    pub deepest_mm: Option<f64>,
    /// Limit by mode coupling, if there is one.
    pub mode_coupling_mm: Option<f64>,
    /// The programmed cut: speed (rpm) and depth (mm).
    pub programmed: Option<[f64; 2]>,
}

impl StabilityPlot {
    /// The picture as a complete SVG document; no limit gives a picture that says so.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        let [first, .., last] = &self.speeds_rpm[..] else {
            return heading.notice(NOTHING);
        };
        let finite = self.depths_mm.iter().copied().filter(|depth| depth.is_finite());
        let deepest = finite.fold(0.0, f64::max);
        let valid = first.is_finite() && last > first && self.depths_mm.len() == self.speeds_rpm.len();
        if !valid || deepest <= 0.0 {
            return heading.notice(NOTHING);
        }
        let programmed = self
            .programmed
            .filter(|at| at.iter().all(|value| value.is_finite()));
        let shown = self.deepest_mm.unwrap_or(HEADROOM * deepest);
        let top = shown.max(HEADROOM * programmed.map_or(0.0, |at| at[1]));
        let chart = Chart::with_axis_room(AREA_PX, [*first, *last], [0.0, top]);
        let mut page = heading.page(chart.area.right() + BORDER_PX + 8.0);
        let chart = chart.lowered_to(page.top_px + 4.0);
        let limit = Style::line(INK, 1.8);
        let coupling = Style::line(SIGNAL, 1.4).dashed("6 4");
        page.svg.clipped(chart.area, |svg| {
            svg.polygon(&self.unstable(&chart), &Style::fill(OVER).opacity(0.6));
        });
        let labels = AxisLabels {
            horizontal: "spindle speed (rpm)".to_owned(),
            vertical: "axial depth of cut (mm)".to_owned(),
        };
        chart.draw_axes(&mut page.svg, &labels);
        let mut entries = vec![
            Entry::line(limit.clone(), "limit of stability"),
            Entry::new(Key::field(OVER), "unstable: chatter"),
        ];
        page.svg.clipped(chart.area, |svg| {
            let points = self.speeds_rpm.iter().zip(&self.depths_mm);
            for run in runs(points.map(|(rpm, mm)| [*rpm, *mm])) {
                let line: Vec<Point> = run.into_iter().map(|value| chart.at(value)).collect();
                svg.polyline(&line, &limit);
            }
            if let Some(depth) = self.mode_coupling_mm.filter(|depth| depth.is_finite()) {
                svg.line(chart.at([*first, depth]), chart.at([*last, depth]), &coupling);
            }
        });
        match self.mode_coupling_mm.filter(|depth| depth.is_finite()) {
            Some(depth) if depth <= top => {
                entries.push(Entry::line(coupling, "limit by mode coupling alone"));
            }
            _ => {}
        }
        if let Some(at) = programmed {
            let style = Style::fill("#ffffff").outlined(INK, 1.6);
            let foot = chart.at([at[0], 0.0]);
            page.svg.clipped(chart.area, |svg| {
                svg.line(
                    foot,
                    [foot[0], chart.area.y],
                    &Style::line(MUTED, 0.8).dashed("2 3"),
                );
            });
            page.svg.polygon(&diamond(chart.at(at), 6.0), &style);
            entries.push(Entry::new(Key::Diamond(style), "programmed cut"));
        }
        page.finish_with_legend(&entries, [chart.area.x, chart.area.bottom() + 50.0])
    }

    /// The area above the lobes; over speeds without a limit it is empty.
    fn unstable(&self, chart: &Chart) -> Vec<Point> {
        let top = chart.high[1];
        let mut outline: Vec<Point> = self
            .speeds_rpm
            .iter()
            .zip(&self.depths_mm)
            .map(|(rpm, mm)| chart.at([*rpm, if mm.is_finite() { mm.min(top) } else { top }]))
            .collect();
        outline.push(chart.at([chart.high[0], top]));
        outline.push(chart.at([chart.low[0], top]));
        outline
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot() -> StabilityPlot {
        StabilityPlot {
            title: "lobes".to_owned(),
            speeds_rpm: (0..20).map(|k| 4000.0 + 500.0 * f64::from(k)).collect(),
            depths_mm: (0..20)
                .map(|k| {
                    if k == 7 {
                        f64::INFINITY
                    } else {
                        1.0 + f64::from(k % 5)
                    }
                })
                .collect(),
            mode_coupling_mm: Some(2.5),
            programmed: Some([9000.0, 1.5]),
            ..StabilityPlot::default()
        }
    }

    #[test]
    fn the_curve_is_interrupted_where_there_is_no_limit() {
        let svg = plot().to_svg();
        assert!(svg.contains("limit by mode coupling") && svg.contains("programmed cut"));
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        let chart = Chart::with_axis_room(AREA_PX, [4000.0, 13_500.0], [0.0, 5.5]);
        let outline = plot().unstable(&chart);
        assert_eq!(outline.len(), 22);
        assert_eq!(
            outline[7],
            chart.at([7500.0, 5.5]),
            "no limit: the area ends at the top"
        );
    }

    #[test]
    fn without_a_limit_the_picture_says_so() {
        let none = StabilityPlot {
            depths_mm: vec![f64::INFINITY; 20],
            ..plot()
        };
        assert!(none.to_svg().contains("no speed has a limit"));
        assert!(StabilityPlot::default().to_svg().contains("no speed has a limit"));
        let one = StabilityPlot {
            speeds_rpm: vec![1.0],
            ..plot()
        };
        assert!(one.to_svg().contains("no speed has a limit"));
    }

    #[test]
    fn a_coupling_limit_above_the_chart_is_not_in_the_legend_and_a_deep_cut_extends_it() {
        let deep = StabilityPlot {
            mode_coupling_mm: Some(40.0),
            programmed: None,
            ..plot()
        };
        assert!(!deep.to_svg().contains("mode coupling"));
        let programmed = StabilityPlot {
            programmed: Some([9000.0, 45.0]),
            ..deep
        };
        assert!(programmed.to_svg().contains("mode coupling"));
    }
}

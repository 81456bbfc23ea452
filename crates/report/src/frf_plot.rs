//! How far does a tool move by a harmonic force, at which frequency?
//!
//! ```text
//!  magnitude │   ╱╲ ¦     measured points, fitted or predicted lines, modes dashed
//!  (µm/N)    │__╱  ╲¦╱╲_
//!            ├──────────
//!  phase     │ ──╲
//!  (deg)     │    ╲_____
//!            ├──────────
//!  coherence │ ~~~~~~~~~  faint; only if measured
//!            └──────────
//!              frequency (Hz)
//! ```
//!
//! Frequency and magnitude are logarithmic. Values that have no logarithm are left out.

use crate::chart::{Chart, runs};
use crate::colour::{GRID, INK, MUTED, category};
use crate::font::{BODY_PX, SMALL_PX};
use crate::legend::{Entry, Key};
use crate::log_axis::{LogTick, log_ticks};
use crate::page::{BORDER_PX, Heading};
use crate::svg::{Point, Rect, Style, Svg, Text};

/// Width of the panels.
const WIDTH_PX: f64 = 600.0;
/// Heights of magnitude, phase and coherence, and the distance between them.
const HEIGHTS_PX: [f64; 3] = [250.0, 110.0, 60.0];
const BETWEEN_PX: f64 = 16.0;
/// Room left of the panels for numbers and labels.
const LEFT_PX: f64 = 66.0;
/// Decades below the largest magnitude that are shown at most.
const MOST_DECADES: f64 = 6.0;
/// Radius of a measured point.
const POINT_PX: f64 = 1.5;
const NOTHING: &str = "There is nothing to draw: no receptance above zero.";

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FrfStyle {
    /// A line: fitted or predicted.
    #[default]
    Line,
    /// Points: measured.
    Points,
}

/// One frequency response function.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrfCurve {
    /// Name in the legend; empty: not in the legend.
    pub name: String,
    /// How it is drawn.
    pub style: FrfStyle,
    /// Number of its colour; measured and fitted curves of one FRF have the same.
    pub colour: usize,
    /// Frequencies, rising.
    pub frequencies_hz: Vec<f64>,
    /// Magnitude at each.
    pub magnitudes_um_per_n: Vec<f64>,
    /// Phase at each, from -180 to 180.
    pub phases_deg: Vec<f64>,
    /// Coherence at each, from 0 to 1; empty if it is not known.
    pub coherences: Vec<f64>,
}

/// The input of the picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrfPlot {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// The curves, drawn in this order.
    pub curves: Vec<FrfCurve>,
    /// Frequencies of modes.
    pub modes_hz: Vec<f64>,
}

impl FrfPlot {
    /// The picture as a complete SVG document; nothing to draw gives a picture that says so.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        let Some([across, up]) = self.ranges() else {
            return heading.notice(NOTHING);
        };
        let has_coherence = self.curves.iter().any(|curve| !curve.coherences.is_empty());
        let panels = if has_coherence { 3 } else { 2 };
        let mut page = heading.page(BORDER_PX + LEFT_PX + WIDTH_PX + BORDER_PX + 8.0);
        let mut y = page.top_px + 4.0;
        let vertical = [up, [-180.0, 180.0], [0.0, 1.0]];
        let titles = ["magnitude (µm/N)", "phase (deg)", "coherence"];
        let frequencies = log_ticks(across.map(power));
        let mut bottom = y;
        for panel in 0..panels {
            let chart = Chart {
                area: Rect {
                    x: BORDER_PX + LEFT_PX,
                    y,
                    w: WIDTH_PX,
                    h: HEIGHTS_PX[panel],
                },
                low: [across[0], vertical[panel][0]],
                high: [across[1], vertical[panel][1]],
            };
            let marks = match panel {
                0 => log_ticks(up.map(power)),
                1 => plain_ticks(&[-180.0, -90.0, 0.0, 90.0, 180.0]),
                _ => plain_ticks(&[0.0, 0.5, 1.0]),
            };
            draw_axes(
                &mut page.svg,
                &chart,
                &Marks {
                    frequencies: &frequencies,
                    values: &marks,
                },
                titles[panel],
            );
            page.svg
                .clipped(chart.area, |svg| self.draw_curves(svg, &chart, panel));
            page.svg.rect(chart.area, &Style::line(INK, 1.0));
            bottom = chart.area.bottom();
            if panel + 1 == panels {
                draw_frequencies(&mut page.svg, &chart, &frequencies);
            }
            y = bottom + BETWEEN_PX;
        }
        page.finish_with_legend(&self.legend(), [BORDER_PX + LEFT_PX, bottom + 46.0])
    }

    /// Common logarithms of the frequencies and magnitudes that are shown.
    fn ranges(&self) -> Option<[[f64; 2]; 2]> {
        let (mut across, mut up) = (
            [f64::INFINITY, f64::NEG_INFINITY],
            [f64::INFINITY, f64::NEG_INFINITY],
        );
        let widen = |range: &mut [f64; 2], value: f64| {
            *range = [range[0].min(value), range[1].max(value)];
        };
        for curve in &self.curves {
            for (hz, magnitude) in curve.frequencies_hz.iter().zip(&curve.magnitudes_um_per_n) {
                let (x, y) = (hz.log10(), magnitude.log10());
                if x.is_finite() && y.is_finite() {
                    widen(&mut across, x);
                    widen(&mut up, y);
                }
            }
        }
        let low = up[0].max(up[1] - MOST_DECADES);
        let margin = 0.06 * (up[1] - low).max(0.3);
        (across[1] > across[0] && up[1].is_finite()).then_some([across, [low - margin, up[1] + margin]])
    }

    fn draw_curves(&self, svg: &mut Svg, chart: &Chart, panel: usize) {
        let dashed = Style::line(MUTED, 0.8).dashed("3 3");
        for hz in self.modes_hz.iter().filter(|hz| **hz > 0.0) {
            let x = chart.at([hz.log10(), 0.0])[0];
            svg.line([x, chart.area.y], [x, chart.area.bottom()], &dashed);
        }
        for curve in &self.curves {
            let values = match panel {
                0 => &curve.magnitudes_um_per_n,
                1 => &curve.phases_deg,
                _ => &curve.coherences,
            };
            let points: Vec<Point> = (curve.frequencies_hz.iter().zip(values))
                .map(|(hz, value)| [hz.log10(), if panel == 0 { value.log10() } else { *value }])
                .collect();
            let colour = category(curve.colour);
            match (curve.style, panel) {
                (FrfStyle::Points, 0 | 1) => {
                    let style = Style::fill(colour).opacity(0.45);
                    for point in points
                        .iter()
                        .filter(|point| point.iter().all(|part| part.is_finite()))
                    {
                        svg.circle(chart.at(*point), POINT_PX, &style);
                    }
                }
                _ => {
                    let style = if panel == 2 {
                        Style::line(colour, 0.8).opacity(0.5)
                    } else {
                        Style::line(colour, 1.6)
                    };
                    let cut = if panel == 1 { without_jumps(points) } else { points };
                    for run in runs(cut) {
                        let line: Vec<Point> = run.into_iter().map(|value| chart.at(value)).collect();
                        svg.polyline(&line, &style);
                    }
                }
            }
        }
    }

    fn legend(&self) -> Vec<Entry> {
        let mut entries: Vec<Entry> = (self.curves.iter().filter(|curve| !curve.name.is_empty()))
            .map(|curve| match curve.style {
                FrfStyle::Line => Entry::line(Style::line(category(curve.colour), 1.6), curve.name.clone()),
                FrfStyle::Points => {
                    Entry::new(Key::Dot(Style::fill(category(curve.colour))), curve.name.clone())
                }
            })
            .collect();
        if !self.modes_hz.is_empty() {
            entries.push(Entry::line(Style::line(MUTED, 0.8).dashed("3 3"), "mode"));
        }
        entries
    }
}

/// What is marked on the axes of a panel.
struct Marks<'a> {
    frequencies: &'a [LogTick],
    values: &'a [LogTick],
}

fn power(exponent: f64) -> f64 {
    10_f64.powf(exponent)
}

/// Marks with numbers on an axis that is not logarithmic.
fn plain_ticks(values: &[f64]) -> Vec<LogTick> {
    let tick = |value: &f64| LogTick {
        exponent: *value,
        label: Some(crate::axis::plain(*value)),
    };
    values.iter().map(tick).collect()
}

/// A line from -180 to 180 deg is a turn, not a change: it is interrupted.
fn without_jumps(points: Vec<Point>) -> Vec<Point> {
    let mut all: Vec<Point> = Vec::with_capacity(points.len());
    for point in points {
        if let Some(before) = all.last().copied()
            && (point[1] - before[1]).abs() > 180.0
        {
            all.push([f64::NAN, f64::NAN]);
        }
        all.push(point);
    }
    all
}

/// Grid lines of both axes, numbers and label on the left.
fn draw_axes(svg: &mut Svg, chart: &Chart, marks: &Marks<'_>, title: &str) {
    let area = chart.area;
    for tick in marks.frequencies {
        let x = chart.at([tick.exponent, 0.0])[0];
        let width = if tick.label.is_some() { 1.0 } else { 0.4 };
        svg.line([x, area.y], [x, area.bottom()], &Style::line(GRID, width));
    }
    for tick in marks.values {
        let y = chart.at([0.0, tick.exponent])[1];
        let width = if tick.label.is_some() { 1.0 } else { 0.4 };
        svg.line([area.x, y], [area.right(), y], &Style::line(GRID, width));
        if let Some(label) = &tick.label {
            svg.text(
                [area.x - 6.0, y + 0.36 * SMALL_PX],
                label,
                &Text::new(SMALL_PX).end(),
            );
        }
    }
    let text = Text::new(BODY_PX).middle();
    svg.text(
        [BORDER_PX + BODY_PX, area.centre()[1]],
        title,
        &text.turned(-90.0),
    );
}

/// Numbers and label below the last panel.
fn draw_frequencies(svg: &mut Svg, chart: &Chart, ticks: &[LogTick]) {
    let bottom = chart.area.bottom();
    for tick in ticks {
        if let Some(label) = &tick.label {
            let x = chart.at([tick.exponent, 0.0])[0];
            svg.line([x, bottom], [x, bottom + 5.0], &Style::line(INK, 1.0));
            svg.text([x, bottom + 6.0 + SMALL_PX], label, &Text::new(SMALL_PX).middle());
        }
    }
    let middle = chart.area.centre()[0];
    svg.text(
        [middle, bottom + 38.0],
        "frequency (Hz)",
        &Text::new(BODY_PX).middle(),
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot() -> FrfPlot {
        let frequencies_hz: Vec<f64> = (1..200).map(|k| 5.0 * f64::from(k)).collect();
        let curve = FrfCurve {
            name: "1X/1X".to_owned(),
            magnitudes_um_per_n: frequencies_hz
                .iter()
                .map(|hz| 1.0 / (1.0 + (hz - 400.0).abs()))
                .collect(),
            phases_deg: frequencies_hz
                .iter()
                .map(|hz| if *hz < 400.0 { -170.0 } else { 170.0 })
                .collect(),
            frequencies_hz,
            ..FrfCurve::default()
        };
        FrfPlot {
            title: "receptance".to_owned(),
            curves: vec![curve],
            modes_hz: vec![400.0],
            ..FrfPlot::default()
        }
    }

    #[test]
    fn panels_and_legend_are_those_of_the_curves() {
        let svg = plot().to_svg();
        assert!(svg.contains("magnitude") && svg.contains("phase") && !svg.contains(">coherence<"));
        assert!(
            svg.contains("1X/1X") && svg.contains(">mode<") && !svg.contains("NaN") && !svg.contains("inf")
        );
        let mut measured = plot();
        measured.curves[0].style = FrfStyle::Points;
        measured.curves[0].coherences = vec![1.0; 199];
        let svg = measured.to_svg();
        assert!(svg.contains(">coherence<") && svg.matches("<circle").count() >= 2 * 199);
    }

    #[test]
    fn a_turn_of_the_phase_interrupts_the_line() {
        let cut = without_jumps(vec![[0.0, -170.0], [1.0, 170.0], [2.0, 160.0]]);
        assert!(cut.len() == 4 && cut[1][0].is_nan());
    }

    #[test]
    fn nothing_to_draw_is_said() {
        assert!(FrfPlot::default().to_svg().contains("nothing to draw"));
        let mut zero = plot();
        zero.curves[0].magnitudes_um_per_n.fill(0.0);
        assert!(zero.to_svg().contains("nothing to draw"));
        let mut odd = plot();
        odd.curves[0].magnitudes_um_per_n[3] = 0.0;
        odd.curves[0].frequencies_hz[5] = f64::NAN;
        assert!(!odd.to_svg().contains("NaN"));
    }
}

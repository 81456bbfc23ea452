//! Forces over time: each component and the size, as it was measured and as it was treated, with the stretches where
//! nothing is cut.
//!
//! A record has far more samples than a picture has columns of pixels: each column shows the least and the greatest of its
//! samples, so that no peak is lost and the picture stays small.

use std::fmt::Write;

use crate::axis::extent;
use crate::chart::{APART_PX, range};
use crate::colour::{INK, category};
use crate::font::{Weight, text_width_px};
use crate::legend::{Entry, Key};
use crate::page::{BODY_PX, BORDER_PX, Heading, SMALL_PX};
use crate::plane::LABEL_BELOW_PX;
use crate::svg::{Rect, Style, Svg, Text, num};
use crate::ticks::{Across, Axis, Overhang, Ticks};

/// Columns of pixels: what a trace is drawn in.
const COLUMNS: usize = 640;
/// Height of one chart, and the gap to the next.
const CHART_PX: f64 = 108.0;
const GAP_PX: f64 = 14.0;
/// Height that each tick of a force gets at least, about.
const TICK_PX: f64 = 30.0;
/// What was measured, behind what became of it.
const BEFORE: &str = "#b9b9b9";
/// A stretch where nothing is cut.
const AIR: &str = "#e3eef7";

/// Least and greatest value in each column of pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Envelope {
    columns: Vec<Option<[f64; 2]>>,
}

impl Envelope {
    /// Of samples (time, value) in a span of time; what lies outside or is not finite is left out.
    pub fn of(span_s: [f64; 2], samples: impl IntoIterator<Item = (f64, f64)>) -> Envelope {
        let mut columns = vec![None; COLUMNS];
        let length = span_s[1] - span_s[0];
        let mut last: Option<(usize, f64)> = None;
        for (time, value) in samples {
            let part = (time - span_s[0]) / length;
            if !((0.0..=1.0).contains(&part) && value.is_finite()) {
                continue;
            }
            let column = ((part * COLUMNS as f64) as usize).min(COLUMNS - 1);
            // The line from the column before enters at its last value.
            let enters = last.filter(|(before, _)| before + 1 == column);
            let begin = enters.map_or(value, |(_, value)| value);
            let [low, high] = columns[column].unwrap_or([begin, begin]);
            columns[column] = Some([value.min(low), value.max(high)]);
            last = Some((column, value));
        }
        Envelope { columns }
    }

    fn values(&self) -> impl Iterator<Item = f64> + '_ {
        self.columns.iter().flatten().flatten().copied()
    }
}

/// One component over time.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceTrace {
    /// Its name with the unit: `Fx (N)`.
    pub name: String,
    /// As it was measured.
    pub before: Envelope,
    /// As it was treated.
    pub after: Envelope,
}

/// What a plot of forces shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForcePlot {
    /// First line, bold.
    pub title: String,
    /// Second line: file, sampling rate, what was done.
    pub subtitle: String,
    /// The time that is shown, s.
    pub span_s: [f64; 2],
    /// One below the other.
    pub traces: Vec<ForceTrace>,
    /// Stretches where nothing is cut, s.
    pub air_s: Vec<[f64; 2]>,
    /// Instants with their names, s.
    pub marks_s: Vec<(f64, String)>,
}

impl ForcePlot {
    /// The plot as a complete SVG document; no values gives a picture that says so.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        let strips: Option<Vec<Strip<'_>>> = self.traces.iter().enumerate().map(strip).collect();
        let Some(mut strips) = strips.filter(|all| !all.is_empty() && self.span_s[1] > self.span_s[0]) else {
            return heading.notice("There is nothing to draw: the record has no values.");
        };
        let numbers = strips.iter().map(|strip| strip.ticks().width_px(SMALL_PX));
        let left = BORDER_PX + 32.0 + numbers.fold(0.0, f64::max);
        let mut page = heading.page(left + COLUMNS as f64 + BORDER_PX + 8.0);
        let names = if self.marks_s.is_empty() {
            0.0
        } else {
            SMALL_PX + 2.0
        };
        let top = page.top_px + 4.0 + names;
        for (index, strip) in strips.iter_mut().enumerate() {
            strip.area.x = left;
            strip.area.y = top + index as f64 * (CHART_PX + GAP_PX);
            self.draw_air(&mut page.svg, &strip.area);
            strip.draw(&mut page.svg);
        }
        let all = Rect {
            x: left,
            y: top,
            w: COLUMNS as f64,
            h: strips.len() as f64 * (CHART_PX + GAP_PX) - GAP_PX,
        };
        self.draw_marks(&mut page.svg, &all);
        self.draw_time(&mut page.svg, &all);
        page.finish_with_legend(&self.entries(), [left, all.bottom() + 50.0])
    }

    fn x(&self, time_s: f64, area: &Rect) -> f64 {
        let part = (time_s - self.span_s[0]) / (self.span_s[1] - self.span_s[0]);
        area.x + part.clamp(0.0, 1.0) * area.w
    }

    fn draw_air(&self, svg: &mut Svg, area: &Rect) {
        for [from, to] in &self.air_s {
            let x = self.x(*from, area);
            let air = Rect {
                x,
                w: self.x(*to, area) - x,
                ..*area
            };
            svg.rect(air, &Style::fill(AIR));
        }
    }

    /// Instants as dashed lines through all charts, each with its name above where there is room.
    fn draw_marks(&self, svg: &mut Svg, all: &Rect) {
        let mut taken = f64::NEG_INFINITY;
        for (time, name) in &self.marks_s {
            let x = self.x(*time, all);
            svg.line(
                [x, all.y],
                [x, all.bottom()],
                &Style::line(INK, 1.0).dashed("4 3"),
            );
            let half = text_width_px(name, SMALL_PX, Weight::Regular) / 2.0;
            let at = x.clamp(all.x + half, (all.right() - half).max(all.x + half));
            if at - half > taken {
                svg.text([at, all.y - 5.0], name, &Text::new(SMALL_PX).middle());
                taken = at + half + 6.0;
            }
        }
    }

    fn draw_time(&self, svg: &mut Svg, all: &Rect) {
        let axis = Axis {
            ticks: Ticks::about(COLUMNS as f64 / APART_PX[0], self.span_s),
            area: *all,
            font_px: SMALL_PX,
            across: Across::Nothing,
            overhang: Overhang::Allowed,
        };
        axis.draw_below(svg, |time| self.x(time, all));
        let at = [all.centre()[0], all.bottom() + LABEL_BELOW_PX];
        svg.text(at, "time (s)", &Text::new(BODY_PX).middle());
    }

    fn entries(&self) -> Vec<Entry> {
        let line = |colour: &str| Key::Line(vec![Style::line(colour, 2.4)]);
        let after = (0..self.traces.len()).map(|k| Style::line(category(k), 2.4));
        let mut entries = vec![Entry::new(line(BEFORE), "as measured")];
        entries.extend(
            after
                .take(1)
                .map(|style| Entry::new(Key::Line(vec![style]), "as used")),
        );
        if !self.air_s.is_empty() {
            entries.push(Entry::new(Key::Field(Style::fill(AIR)), "nothing is cut"));
        }
        entries
    }
}

/// One trace with its scale, in its place.
struct Strip<'a> {
    trace: &'a ForceTrace,
    colour: &'static str,
    /// Values at the lower and at the upper edge.
    ends: [f64; 2],
    area: Rect,
}

/// The strip of a trace, still without its place: its scale shows both envelopes and zero. `None` without values.
fn strip((index, trace): (usize, &ForceTrace)) -> Option<Strip<'_>> {
    let values = || trace.before.values().chain(trace.after.values());
    extent(values())?;
    Some(Strip {
        trace,
        colour: category(index),
        ends: range(values().chain([0.0]), 0.05)?,
        area: Rect {
            x: 0.0,
            y: 0.0,
            w: COLUMNS as f64,
            h: CHART_PX,
        },
    })
}

impl Strip<'_> {
    fn ticks(&self) -> Ticks {
        Ticks::about(CHART_PX / TICK_PX, self.ends)
    }

    fn draw(&self, svg: &mut Svg) {
        let area = self.area;
        let [low, high] = self.ends;
        let y = |value: f64| area.bottom() - (value - low) / (high - low) * area.h;
        let axis = Axis {
            ticks: self.ticks(),
            area,
            font_px: SMALL_PX,
            across: Across::Lines,
            overhang: Overhang::Allowed,
        };
        axis.draw_left(svg, y);
        for (envelope, colour) in [(&self.trace.before, BEFORE), (&self.trace.after, self.colour)] {
            svg.path(&zigzag(envelope, area.x, &y), &Style::line(colour, 1.0));
        }
        svg.rect(area, &Style::line(INK, 1.0));
        let at = [BORDER_PX + 12.0, area.centre()[1]];
        let text = Text::new(BODY_PX).middle().turned(-90.0);
        svg.text(at, &self.trace.name, &text);
    }
}

/// Up one column and down the next: a line one pixel wide fills what lies between least and greatest.
fn zigzag(envelope: &Envelope, left: f64, y: &dyn Fn(f64) -> f64) -> String {
    let mut data = String::new();
    let mut upwards = true;
    for (column, [low, high]) in envelope
        .columns
        .iter()
        .enumerate()
        .filter_map(|(column, ends)| Some((column, (*ends)?)))
    {
        let x = num(left + column as f64 + 0.5);
        let [first, second] = if upwards { [low, high] } else { [high, low] };
        let command = if data.is_empty() { 'M' } else { 'L' };
        // A tenth of a pixel is enough, and shorter.
        let short = |value: f64| num((y(value) * 10.0).round() / 10.0);
        let (from, to) = (short(first), short(second));
        let _ = write!(data, "{command}{x} {from}");
        if to != from {
            let _ = write!(data, "V{to}");
            upwards = !upwards;
        }
    }
    data
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A million samples of a wave, a single one of them ten times as high.
    fn plot() -> ForcePlot {
        let samples = |offset: f64| {
            (0..1_000_000).map(move |k| {
                let time = f64::from(k) * 1e-5;
                let peak = if k == 345_678 { 1000.0 } else { 0.0 };
                (time, 100.0 * (time * 900.0).sin() + peak + offset)
            })
        };
        let trace = |name: &str| ForceTrace {
            name: name.to_owned(),
            before: Envelope::of([0.0, 10.0], samples(20.0)),
            after: Envelope::of([0.0, 10.0], samples(0.0)),
        };
        ForcePlot {
            title: "a record".to_owned(),
            span_s: [0.0, 10.0],
            traces: ["Fx (N)", "Fy (N)", "Fz (N)", "size (N)"].map(trace).to_vec(),
            air_s: vec![[0.0, 1.0], [9.0, 10.0]],
            marks_s: vec![(1.5, "first cut".to_owned())],
            ..ForcePlot::default()
        }
    }

    #[test]
    fn a_single_peak_among_a_million_samples_is_seen_and_the_picture_stays_small() {
        let plot = plot();
        let highest = plot.traces[0].after.values().fold(0.0, f64::max);
        assert!(highest > 899.0, "{highest}");
        let svg = plot.to_svg();
        // Eight traces of 640 columns, some twelve bytes each.
        assert!(svg.len() < 150_000, "{}", svg.len());
        assert_eq!(svg.matches(AIR).count(), 2 * 4 + 1);
        assert!(svg.contains("first cut") && svg.contains("nothing is cut"));
    }

    #[test]
    fn a_step_between_two_columns_is_drawn_as_one() {
        let samples = (0..1280).map(|k| (f64::from(k) / 1280.0, f64::from(k >= 640)));
        let envelope = Envelope::of([0.0, 1.0], samples);
        let wide = |column: &usize| envelope.columns[*column].is_some_and(|[low, high]| low < high);
        assert_eq!((0..COLUMNS).filter(wide).collect::<Vec<_>>(), [320]);
    }

    #[test]
    fn few_samples_are_joined_by_a_line() {
        let envelope = Envelope::of([0.0, 1.0], [(0.0, 1.0), (0.5, 3.0), (1.0, f64::NAN), (2.0, 9.0)]);
        assert_eq!(zigzag(&envelope, 0.0, &|v| v), "M0.5 1L320.5 3");
    }

    #[test]
    fn a_record_without_values_says_so() {
        assert!(ForcePlot::default().to_svg().contains("no values"));
        let empty = ForceTrace {
            name: "Fx (N)".to_owned(),
            before: Envelope::of([0.0, 1.0], []),
            after: Envelope::of([0.0, 0.0], [(0.0, 1.0)]),
        };
        let plot = ForcePlot {
            span_s: [0.0, 1.0],
            traces: vec![empty],
            ..ForcePlot::default()
        };
        assert!(plot.to_svg().contains("no values"));
    }
}

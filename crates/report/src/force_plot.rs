//! Forces over time: each component and the size, as it was measured and as it was treated, with the stretches where
//! nothing is cut.
//!
//! A record has far more samples than a picture has columns of pixels: each column shows the least and the greatest of
//! its samples, so that no peak is lost and the picture stays small.

use std::fmt::Write;

use crate::axis::extent;
use crate::chart::{APART_PX, range};
use crate::colour::{INK, category};
use crate::font::{BODY_PX, SMALL_PX, Weight, text_width_px};
use crate::legend::{Entry, Key};
use crate::page::{BORDER_PX, Heading};
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
const NOTHING: &str = "There is nothing to draw: the record has no values.";

/// Least and greatest value in each column of pixels, over a span of time. There are 640 columns of equal time,
/// whatever the number of samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Envelope {
    /// From, to, s.
    span_s: [f64; 2],
    columns: Vec<Option<[f64; 2]>>,
}

impl Envelope {
    /// Of samples (time in s, value in the unit of the trace) in a span of time (from, to in s), in the order
    /// of time; values outside or not finite are left out. A column without a sample stays empty; a span
    /// of no length leaves all empty. A column also contains the last value of the column right before it, from
    /// which its line comes.
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
        Envelope { span_s, columns }
    }

    /// The ends of all columns that have samples.
    fn values(&self) -> impl Iterator<Item = f64> + '_ {
        self.columns.iter().flatten().flatten().copied()
    }
}

/// One component over time, in two states with the same scale.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceTrace {
    /// Its name with the unit: `Fx (N)`.
    pub name: String,
    /// As it was measured, drawn in grey behind.
    pub before: Envelope,
    /// As it was treated and is used, drawn in colour in front.
    pub after: Envelope,
}

/// What a plot of forces shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForcePlot {
    /// First line, bold.
    pub title: String,
    /// Second line: file, sampling rate, what was done.
    pub subtitle: String,
    /// One below the other; all envelopes are of one span, which is the time that is shown. Traces of different
    /// spans give a picture that says so.
    pub traces: Vec<ForceTrace>,
    /// Stretches where nothing is cut (from, to), s; drawn as a pale ground.
    pub air_s: Vec<[f64; 2]>,
    /// Instants with their names, s, in the order of time; a name without room is left out, its line stays.
    pub marks_s: Vec<(f64, String)>,
}

impl ForcePlot {
    /// The plot as a complete SVG document; no values gives a picture that says so.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        let mut spans = self.traces.iter().flat_map(|t| [t.before.span_s, t.after.span_s]);
        let Some(span_s) = spans.next().filter(|[from, to]| to > from) else {
            return heading.notice(NOTHING);
        };
        if spans.any(|other| other != span_s) {
            return heading.notice("The traces have different time spans.");
        }
        let strips: Option<Vec<Strip<'_>>> = self
            .traces
            .iter()
            .enumerate()
            .map(|(index, trace)| strip(index, trace))
            .collect();
        let Some(mut strips) = strips else {
            return heading.notice(NOTHING);
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
            let time = TimeAxis {
                span_s,
                area: strip.area,
            };
            self.draw_air(&mut page.svg, &time);
            strip.draw(&mut page.svg);
        }
        let area = Rect {
            x: left,
            y: top,
            w: COLUMNS as f64,
            h: strips.len() as f64 * (CHART_PX + GAP_PX) - GAP_PX,
        };
        let time = TimeAxis { span_s, area };
        self.draw_marks(&mut page.svg, &time);
        time.draw(&mut page.svg);
        page.finish_with_legend(&self.entries(), [left, area.bottom() + 50.0])
    }

    /// The ground of one chart where nothing is cut.
    fn draw_air(&self, svg: &mut Svg, time: &TimeAxis) {
        for [from, to] in &self.air_s {
            let x = time.x(*from);
            let air = Rect {
                x,
                w: time.x(*to) - x,
                ..time.area
            };
            svg.rect(air, &Style::fill(AIR));
        }
    }

    /// Instants as dashed lines through all charts, each with its name above where there is room.
    fn draw_marks(&self, svg: &mut Svg, time: &TimeAxis) {
        let area = time.area;
        let mut taken = f64::NEG_INFINITY;
        for (instant, name) in &self.marks_s {
            let x = time.x(*instant);
            svg.line(
                [x, area.y],
                [x, area.bottom()],
                &Style::line(INK, 1.0).dashed("4 3"),
            );
            let half = text_width_px(name, SMALL_PX, Weight::Regular) / 2.0;
            let at = x.clamp(area.x + half, (area.right() - half).max(area.x + half));
            if at - half > taken {
                svg.text([at, area.y - 5.0], name, &Text::new(SMALL_PX).middle());
                taken = at + half + 6.0;
            }
        }
    }

    fn entries(&self) -> Vec<Entry> {
        let used = (0..self.traces.len()).map(|k| Style::line(category(k), 2.4));
        let mut entries = vec![
            Entry::line(Style::line(BEFORE, 2.4), "as measured"),
            Entry::new(Key::Pieces(used.collect()), "as used"),
        ];
        if !self.air_s.is_empty() {
            entries.push(Entry::new(Key::Field(Style::fill(AIR)), "no cutting"));
        }
        entries
    }
}

/// The time across a chart, or across all of them.
struct TimeAxis {
    span_s: [f64; 2],
    area: Rect,
}

impl TimeAxis {
    /// The position of an instant; one outside the span at the nearer end.
    fn x(&self, time_s: f64) -> f64 {
        let [from, to] = self.span_s;
        self.area.x + ((time_s - from) / (to - from)).clamp(0.0, 1.0) * self.area.w
    }

    /// Ticks, numbers and label below the lowest chart.
    fn draw(&self, svg: &mut Svg) {
        let axis = Axis {
            ticks: Ticks::about(COLUMNS as f64 / APART_PX[0], self.span_s),
            area: self.area,
            font_px: SMALL_PX,
            across: Across::Nothing,
            overhang: Overhang::Allowed,
        };
        axis.draw_below(svg, |time_s| self.x(time_s));
        let at = [self.area.centre()[0], self.area.bottom() + LABEL_BELOW_PX];
        svg.text(at, "time (s)", &Text::new(BODY_PX).middle());
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
fn strip(index: usize, trace: &ForceTrace) -> Option<Strip<'_>> {
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

/// Up one column and down the next: a line one pixel wide fills the range between least and greatest.
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
        assert!(svg.contains("first cut") && svg.contains("no cutting"));
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
    fn a_record_without_values_gives_a_notice() {
        assert!(ForcePlot::default().to_svg().contains("no values"));
        let empty = ForceTrace {
            name: "Fx (N)".to_owned(),
            before: Envelope::of([0.0, 1.0], []),
            after: Envelope::of([0.0, 1.0], []),
        };
        let of = |traces| ForcePlot {
            traces,
            ..ForcePlot::default()
        };
        assert!(of(vec![empty.clone()]).to_svg().contains("no values"));
        let turned = ForceTrace {
            before: Envelope::of([1.0, 0.0], []),
            ..empty
        };
        assert!(of(vec![turned]).to_svg().contains("no values"));
    }

    #[test]
    fn traces_of_different_times_are_not_drawn_as_if_they_were_of_one() {
        let mut plot = plot();
        plot.traces[3].after = Envelope::of([0.0, 5.0], [(1.0, 2.0)]);
        assert!(plot.to_svg().contains("different time spans"));
    }

    #[test]
    fn the_legend_has_the_used_styles_in_the_colour_of_each_trace() {
        let svg = plot().to_svg();
        for index in 0..4 {
            let key = format!("stroke=\"{}\" stroke-width=\"2.4\"", category(index));
            assert_eq!(svg.matches(&key).count(), 1, "{index}");
        }
    }
}

//! A circular test: the runs around the nominal circle, magnified, in the usual form of ball-bar reports.
//!
//! Rings are a division apart, which the second line states; the nominal circle is the dashed one. Clockwise runs have
//! one colour, anticlockwise another; the first of each is a solid line, those that repeat it are dashed ever shorter.
//! A dot is where a run began. Rings and rays are those of [`PolarPlot`].

use crate::axis::plain;
use crate::chart::runs;
use crate::colour::category;
use crate::font::SMALL_PX;
use crate::legend::{Entry, Key};
use crate::line::without_straight;
use crate::page::{BORDER_PX, Heading};
use crate::plane::Growth;
use crate::polar_plot::{PolarPlot, RADIUS_PX, RadialSeries, WIDTH_PX, nominal_style};
use crate::svg::{Style, Svg, Text};

/// Room above the rim for the name of a ray.
const ABOVE_PX: f64 = 24.0;
/// Below the rim, before the legend.
const BELOW_PX: f64 = 32.0;
/// More room all around where rays are marked.
const MARKED_PX: f64 = 26.0;
/// How far a marked ray and its name extend beyond the rim.
const TICK_PX: f64 = 3.0;
const NAME_PX: f64 = 36.0;
/// Rays that are closer have one name.
const CLOSE_DEG: f64 = 6.0;
/// Colour of marked rays.
const MARK_COLOUR: usize = 1;
/// Radius of the dot where a run begins.
const START_PX: f64 = 3.5;

/// Direction of travel of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sense {
    /// Clockwise.
    #[default]
    Clockwise,
    /// Anticlockwise.
    Anticlockwise,
}

/// One run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BallbarTrace {
    /// Name for the legend: `CW1`.
    pub name: String,
    /// Direction of travel.
    pub sense: Sense,
    /// Angle from the horizontal axis towards the vertical axis in degrees, in the order of drawing.
    pub angle_deg: Vec<f64>,
    /// Deviation along the radius in um, outwards positive; a value that is not finite breaks the line.
    pub radial_um: Vec<f64>,
    /// Angle at which the run began, in degrees.
    pub start_deg: Option<f64>,
}

/// The input of a picture of a circular test.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BallbarPlot {
    /// First line, bold.
    pub title: String,
    /// Second line: radius, feed, circular deviation.
    pub subtitle: String,
    /// Name of the direction at 0 degrees: `X`.
    pub horizontal: String,
    /// Name of the direction at 90 degrees: `Y`.
    pub vertical: String,
    /// Direction of the horizontal axis.
    pub growth: Growth,
    /// The runs.
    pub traces: Vec<BallbarTrace>,
    /// Rays that are named, such as where joints reverse.
    pub marks: Vec<RayMark>,
}

/// A ray with a name outside the rim.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RayMark {
    /// Angle in degrees.
    pub angle_deg: f64,
    /// Its name; the names of close rays are combined.
    pub name: String,
}

impl BallbarPlot {
    /// The picture as a complete SVG document; no values gives a picture that says so.
    pub fn to_svg(&self) -> String {
        let series = self.traces.iter().map(|trace| RadialSeries {
            name: trace.name.clone(),
            angle_deg: trace.angle_deg.clone(),
            radial_um: trace.radial_um.clone(),
        });
        let mut under = PolarPlot {
            title: self.title.clone(),
            subtitle: self.subtitle.clone(),
            horizontal: self.horizontal.clone(),
            vertical: self.vertical.clone(),
            growth: self.growth,
            zero: "nominal circle".to_owned(),
            series: series.collect(),
            references: Vec::new(),
        };
        let Some(rings) = under.rings() else {
            return Heading::new(&self.title, &self.subtitle)
                .notice("There is nothing to draw: the test has no radii.");
        };
        let division = format!("division {} µm", plain(rings.division_um()));
        under.subtitle = match self.subtitle.is_empty() {
            true => division,
            false => format!("{}; {division}", self.subtitle),
        };
        let marks = self.marks_apart();
        let sides_px = if marks.is_empty() { 0.0 } else { MARKED_PX };
        let width = WIDTH_PX + 2.0 * sides_px;
        let mut page = Heading::new(&under.title, &under.subtitle).page(width);
        let centre = [width / 2.0, page.top_px + RADIUS_PX + ABOVE_PX + sides_px];
        under.draw_spokes(&mut page.svg, centre, &rings);
        rings.draw(&mut page.svg, centre);
        let mut entries = vec![Entry::line(nominal_style(), under.zero.clone())];
        for (trace, style) in self.traces.iter().zip(self.styles()) {
            let points = trace.angle_deg.iter().zip(&trace.radial_um);
            let points = points.map(|(deg, um)| under.on_circle(centre, *deg, rings.radius_px(*um)));
            for run in runs(points) {
                page.svg.polyline(&without_straight(&run), &style);
            }
            entries.push(Entry::line(style, trace.name.clone()));
        }
        let starts = self
            .traces
            .iter()
            .filter_map(|trace| Some((trace, trace.start()?)));
        for (trace, [deg, um]) in starts.clone() {
            let at = under.on_circle(centre, deg, rings.radius_px(um));
            draw_start(&mut page.svg, at, trace.sense);
        }
        under.write_scale(&mut page.svg, centre, &rings);
        for (deg, name) in &marks {
            let [inner, outer] = [rings.radius_px(rings.first_um()), RADIUS_PX + TICK_PX]
                .map(|px| under.on_circle(centre, *deg, px));
            page.svg.line(inner, outer, &mark_style());
            let at = under.on_circle(centre, *deg, RADIUS_PX + NAME_PX);
            let text = Text::new(SMALL_PX).bold().colour(category(MARK_COLOUR)).middle();
            page.svg.text([at[0], at[1] + 4.0], name, &text);
        }
        if !marks.is_empty() {
            entries.push(Entry::line(mark_style(), "joint reverses"));
        }
        if starts.count() > 0 {
            entries.push(Entry::new(Key::Dot(Style::fill(crate::colour::INK)), "start"));
        }
        page.finish_with_legend(
            &entries,
            [BORDER_PX + 20.0, centre[1] + RADIUS_PX + BELOW_PX + sides_px],
        )
    }

    /// The marks by their angles, close ones combined: `L, U`.
    fn marks_apart(&self) -> Vec<(f64, String)> {
        let mut marks: Vec<&RayMark> = self
            .marks
            .iter()
            .filter(|mark| mark.angle_deg.is_finite())
            .collect();
        marks.sort_by(|a, b| a.angle_deg.total_cmp(&b.angle_deg));
        let mut apart: Vec<(f64, String)> = Vec::new();
        for mark in marks {
            match apart.last_mut() {
                Some((deg, name)) if mark.angle_deg - *deg < CLOSE_DEG => {
                    name.push_str(", ");
                    name.push_str(&mark.name);
                }
                _ => apart.push((mark.angle_deg, mark.name.clone())),
            }
        }
        apart
    }

    /// A style a trace: the colour is the direction of travel, the dashes count the earlier runs in that direction.
    fn styles(&self) -> Vec<Style> {
        const DASHES: [Option<&str>; 4] = [None, Some("7 4"), Some("3 3"), Some("1 4")];
        let style = |(k, trace): (usize, &BallbarTrace)| {
            let before = self.traces[..k]
                .iter()
                .filter(|other| other.sense == trace.sense)
                .count();
            let line = Style::line(trace.sense.colour(), 1.7);
            match DASHES[before.min(DASHES.len() - 1)] {
                Some(dash) => line.dashed(dash),
                None => line,
            }
        };
        self.traces.iter().enumerate().map(style).collect()
    }
}

impl BallbarTrace {
    /// Where the run begins: angle and deviation of the sample that is nearest to its start.
    fn start(&self) -> Option<[f64; 2]> {
        let start = self.start_deg.filter(|deg| deg.is_finite())?;
        let apart = |deg: f64| {
            let apart = (deg - start).rem_euclid(360.0);
            apart.min(360.0 - apart)
        };
        let known = self.angle_deg.iter().zip(&self.radial_um);
        let known = known.filter(|(deg, um)| deg.is_finite() && um.is_finite());
        let (deg, um) = known.min_by(|a, b| apart(*a.0).total_cmp(&apart(*b.0)))?;
        Some([*deg, *um])
    }
}

impl Sense {
    fn colour(self) -> &'static str {
        category(match self {
            Sense::Clockwise => 0,
            Sense::Anticlockwise => 2,
        })
    }
}

/// A marked ray.
fn mark_style() -> Style {
    Style::line(category(MARK_COLOUR), 1.1).dashed("2 3")
}

/// The dot where a run begins.
fn draw_start(svg: &mut Svg, at: [f64; 2], sense: Sense) {
    svg.circle(at, START_PX, &Style::fill(sense.colour()).outlined("#fff", 1.0));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trace(sense: Sense, start_deg: Option<f64>) -> BallbarTrace {
        BallbarTrace {
            name: "run".to_owned(),
            sense,
            angle_deg: (0..=360).map(f64::from).collect(),
            radial_um: (0..=360)
                .map(|deg| 20.0 * f64::from(deg).to_radians().cos())
                .collect(),
            start_deg,
        }
    }

    #[test]
    fn ways_round_differ_by_colour_and_repeats_by_dashes() {
        let plot = BallbarPlot {
            traces: vec![
                trace(Sense::Clockwise, None),
                trace(Sense::Anticlockwise, None),
                trace(Sense::Clockwise, None),
            ],
            ..BallbarPlot::default()
        };
        let svg = plot.to_svg();
        let lines = |colour: &str, dashed: bool| {
            let of = svg
                .lines()
                .filter(|line| line.starts_with("<path") && line.contains(colour));
            of.filter(|line| line.contains("dasharray") == dashed).count()
        };
        let [cw, ccw] = [Sense::Clockwise, Sense::Anticlockwise].map(Sense::colour);
        // Each once on the circle and once in the legend.
        assert_eq!(
            (
                lines(cw, false),
                lines(cw, true),
                lines(ccw, false),
                lines(ccw, true)
            ),
            (2, 2, 2, 0)
        );
    }

    #[test]
    fn the_division_is_reported_and_a_start_is_marked_where_it_is() {
        let plot = |start_deg| BallbarPlot {
            subtitle: "radius 100 mm".to_owned(),
            traces: vec![trace(Sense::Clockwise, start_deg)],
            ..BallbarPlot::default()
        };
        let with = plot(Some(-270.2)).to_svg();
        assert!(with.contains("radius 100 mm; division 10 µm") && with.contains(">start<"));
        assert!(!plot(None).to_svg().contains(">start<"));
        assert_eq!(
            trace(Sense::Clockwise, Some(-270.2)).start().map(|at| at[0]),
            Some(90.0)
        );
    }

    #[test]
    fn a_test_without_radii_gives_a_notice() {
        assert!(
            BallbarPlot::default()
                .to_svg()
                .contains("There is nothing to draw")
        );
        let broken = BallbarTrace {
            radial_um: vec![f64::NAN; 361],
            ..trace(Sense::Clockwise, Some(0.0))
        };
        let plot = BallbarPlot {
            traces: vec![broken],
            ..BallbarPlot::default()
        };
        assert!(plot.to_svg().contains("There is nothing to draw"));
    }
}

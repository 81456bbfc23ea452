//! The roundness of a circle: the radial deviation, magnified, around the nominal circle or a reference circle.
//!
//! `radius = hole + (um - first) / (last - first) (rim - hole)`: the deviation of the innermost ring is at
//! 0.22 of the rim's radius, that of the outermost at the rim. The circle of deviation 0 is the dashed
//! ring between. Lengths along the radius are true to scale among each other; shapes are not, since the hole
//! represents no deviation. Circles about another centre are drawn as they are seen from this one, and their centres
//! marked in the same scale.

use crate::axis::{extent, nice_step};
use crate::chart::runs;
use crate::colour::{FAINT, GRID, INK, MUTED, category};
use crate::font::SMALL_PX;
use crate::legend::{Entry, draw_cross};
use crate::page::{BORDER_PX, Heading};
use crate::plane::Growth;
use crate::svg::{Point, Style, Svg, Text};
use crate::ticks::Ticks;
use armill_core::units::from_deg;

/// Radius of the rim, and width of the picture.
pub(crate) const RADIUS_PX: f64 = 190.0;
pub(crate) const WIDTH_PX: f64 = 500.0;
/// Radius of the innermost ring, which keeps clear of the centre.
const HOLE_PX: f64 = 0.22 * RADIUS_PX;
/// Font size of the rings' values, and the least distance of two of them.
const NUMBER_PX: f64 = 10.0;
const APART_PX: f64 = 16.0;

/// The radial deviation around a circle under one load case; as many points as the shorter list has, joined in
/// their order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RadialSeries {
    /// Name for the legend.
    pub name: String,
    /// Angle from the horizontal axis towards the vertical axis in degrees; give the first point again at the
    /// end to close the line.
    pub angle_deg: Vec<f64>,
    /// Deviation along the radius in um, outwards positive; a value that is not finite breaks the line.
    pub radial_um: Vec<f64>,
}

impl RadialSeries {
    /// Angle and deviation of each point.
    fn points(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        let pairs = self.angle_deg.iter().zip(&self.radial_um);
        pairs.map(|(deg, um)| [*deg, *um])
    }
}

/// A circle, or two of one centre, that belong to the profile.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RadialReference {
    /// The circles as seen from the centre of the plot; what is not finite parts one from the next.
    pub seen: RadialSeries,
    /// Its centre from that of the plot, along the horizontal and the vertical axis, in um.
    pub centre_um: [f64; 2],
}

/// The input of a polar plot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PolarPlot {
    /// First line, bold.
    pub title: String,
    /// Second line: radius, load, roundness.
    pub subtitle: String,
    /// Name of the direction at 0 degrees: `y`.
    pub horizontal: String,
    /// Name of the direction at 90 degrees: `z'`.
    pub vertical: String,
    /// Direction of the horizontal axis: to the left, the angles run clockwise on the picture.
    pub growth: Growth,
    /// Name of the circle of deviation 0: `nominal circle`.
    pub zero: String,
    /// The load cases.
    pub series: Vec<RadialSeries>,
    /// Other circles of the same profile, and their centres.
    pub references: Vec<RadialReference>,
}

impl PolarPlot {
    /// The plot as a complete SVG document; no values gives a picture that says so.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        let Some(rings) = self.rings() else {
            return heading.notice("There is nothing to draw: the circle has no values.");
        };
        let mut page = heading.page(WIDTH_PX);
        let centre = [WIDTH_PX / 2.0, page.top_px + RADIUS_PX + 24.0];
        self.draw_spokes(&mut page.svg, centre, &rings);
        rings.draw(&mut page.svg, centre);
        for (k, series) in self.series.iter().enumerate() {
            let points = series
                .points()
                .map(|[deg, um]| self.on_circle(centre, deg, rings.radius_px(um)));
            for run in runs(points) {
                page.svg.polyline(&run, &case_style(k));
            }
        }
        for (style, reference) in self.styled_references() {
            let points = reference.seen.points();
            let points = points.map(|[deg, um]| self.on_circle(centre, deg, rings.radius_px(um)));
            for run in runs(points) {
                page.svg.polyline(&run, &style);
            }
        }
        self.mark_centres(&mut page.svg, centre, &rings);
        self.write_scale(&mut page.svg, centre, &rings);
        let zero = format!(
            "{}; one ring {} µm",
            self.zero,
            rings.ticks.label(rings.ticks.step)
        );
        let mut entries = vec![Entry::line(nominal_style(), zero)];
        let cases = self.series.iter().enumerate();
        entries.extend(cases.map(|(k, series)| Entry::line(case_style(k), series.name.clone())));
        let references = self.styled_references();
        entries.extend(references.map(|(style, reference)| Entry::line(style, reference.seen.name.clone())));
        page.finish_with_legend(&entries, [BORDER_PX + 20.0, centre[1] + RADIUS_PX + 32.0])
    }

    /// Load cases and references.
    fn all_series(&self) -> impl Iterator<Item = &RadialSeries> {
        let references = self.references.iter().map(|reference| &reference.seen);
        self.series.iter().chain(references)
    }

    /// The references, each with its line: distinguished by colour and by dashes.
    fn styled_references(&self) -> impl Iterator<Item = (Style, &RadialReference)> {
        const DASHES: [&str; 3] = ["9 3", "2.5 2.5", "9 3 2.5 3"];
        let styles = DASHES.iter().cycle().enumerate();
        let styles = styles.map(|(k, dash)| Style::line(category(self.series.len() + k), 1.5).dashed(dash));
        styles.zip(&self.references)
    }

    /// A cross at the centre of each circle, where there are references.
    fn mark_centres(&self, svg: &mut Svg, centre: Point, rings: &Rings) {
        const HALF_PX: f64 = 5.0;
        if self.references.is_empty() {
            return;
        }
        draw_cross(svg, centre, HALF_PX, &Style::line(INK, 1.3));
        let px_per_um = rings.px_per_um();
        for (k, reference) in self.references.iter().enumerate() {
            let [right, up] = reference.centre_um.map(|um| um * px_per_um);
            // A centre out of the plot has no place in it.
            if right.hypot(up) < RADIUS_PX {
                let at = [centre[0] + self.growth.sign() * right, centre[1] - up];
                let style = Style::line(category(self.series.len() + k), 1.3);
                draw_cross(svg, at, HALF_PX, &style);
            }
        }
    }

    /// Rings that contain all deviations and the nominal circle; `None` where nothing has a value.
    pub(crate) fn rings(&self) -> Option<Rings> {
        let finite = self.all_series().flat_map(|s| &s.radial_um).copied();
        let (low, high) = extent(finite.chain([0.0])).filter(|_| self.has_values())?;
        Some(Rings::covering(low, high))
    }

    /// Whether some point has an angle and a deviation.
    fn has_values(&self) -> bool {
        let mut points = self.series.iter().flat_map(RadialSeries::points);
        points.any(|p| p.iter().all(|v| v.is_finite()))
    }

    /// The point of the picture at an angle and a distance from the centre.
    pub(crate) fn on_circle(&self, centre: Point, angle_deg: f64, radius_px: f64) -> Point {
        let (sin, cos) = from_deg(angle_deg).sin_cos();
        [
            centre[0] + self.growth.sign() * radius_px * cos,
            centre[1] - radius_px * sin,
        ]
    }

    /// Rays from the innermost ring outwards, every 30 degrees, with their names.
    pub(crate) fn draw_spokes(&self, svg: &mut Svg, centre: Point, rings: &Rings) {
        for spoke in 0..12 {
            let angle = f64::from(spoke) * 30.0;
            let inner = self.on_circle(centre, angle, rings.radius_px(rings.first_um()));
            let outer = self.on_circle(centre, angle, RADIUS_PX);
            svg.line(inner, outer, &Style::line(GRID, 1.0));
            let at = self.on_circle(centre, angle, RADIUS_PX + 14.0);
            let name = match spoke {
                0 => format!("+{}", self.horizontal),
                3 => format!("+{}", self.vertical),
                6 => format!("\u{2212}{}", self.horizontal),
                9 => format!("\u{2212}{}", self.vertical),
                _ => format!("{angle:.0}°"),
            };
            let text = if spoke % 3 == 0 {
                Text::new(SMALL_PX).bold()
            } else {
                Text::new(NUMBER_PX).colour(MUTED)
            };
            // Names at the sides are away from the circle, all others above or below their ray.
            let side = (at[0] - centre[0]) / RADIUS_PX;
            let (text, nudge) = if side > 0.9 {
                (text, -6.0)
            } else if side < -0.9 {
                (text.end(), 6.0)
            } else {
                (text.middle(), 0.0)
            };
            svg.text([at[0] + nudge, at[1] + 4.0], &name, &text);
        }
    }

    /// The ray between two spokes with the fewest points where a ring's value is to be written.
    fn clearest_ray_deg(&self, rings: &Rings, numbered_um: &[f64]) -> f64 {
        const HALF_PX: Point = [24.0, 9.0];
        let centre = [0.0, 0.0];
        let points: Vec<Point> = self
            .all_series()
            .flat_map(RadialSeries::points)
            .map(|[deg, um]| self.on_circle(centre, deg, rings.radius_px(um)))
            .collect();
        let crowd = |ray: f64| -> usize {
            let numbers = numbered_um
                .iter()
                .map(|um| self.on_circle(centre, ray, rings.radius_px(*um)));
            let covered = |n: Point| {
                let under = |p: &&Point| (0..2).all(|k| (p[k] - n[k]).abs() < HALF_PX[k]);
                points.iter().filter(under).count()
            };
            numbers.map(covered).sum()
        };
        let rays = [75.0, 105.0, 255.0, 285.0, 45.0, 135.0, 225.0, 315.0];
        rays.into_iter().min_by_key(|ray| crowd(*ray)).unwrap_or(75.0)
    }

    /// The rings' values, along a ray between two spokes.
    pub(crate) fn write_scale(&self, svg: &mut Svg, centre: Point, rings: &Rings) {
        let numbered_um = rings.numbered_um();
        let ray_deg = self.clearest_ray_deg(rings, &numbered_um);
        for um in numbered_um {
            let at = self.on_circle(centre, ray_deg, rings.radius_px(um));
            let sign = if um > rings.slack_um() { "+" } else { "" };
            let label = format!("{sign}{} µm", rings.ticks.label(um));
            let text = Text::new(NUMBER_PX).middle().halo(4.0);
            svg.text([at[0], at[1] + 3.5], &label, &text);
        }
    }
}

/// Rings of equal deviation around the nominal circle.
pub(crate) struct Rings {
    ticks: Ticks,
    /// The deviations of the innermost and of the outermost ring: at least one step below 0 and one above.
    ends_um: [f64; 2],
}

impl Rings {
    /// Rings at nice values from `low_um` (0 or less) to `high_um` (0 or more) and at least one to either side of the
    /// nominal circle.
    fn covering(low_um: f64, high_um: f64) -> Self {
        let step = nice_step((high_um - low_um).max(1e-6), 4.0);
        let first = (low_um / step).floor().min(-1.0) * step;
        let last = (high_um / step).ceil().max(1.0) * step;
        Self {
            ticks: Ticks::every(step, [first, last]),
            ends_um: [first, last],
        }
    }

    /// Distance from the centre of a deviation, px.
    pub(crate) fn radius_px(&self, um: f64) -> f64 {
        let first = self.first_um();
        HOLE_PX + (um - first) * self.px_per_um()
    }

    /// How much a deviation is magnified.
    fn px_per_um(&self) -> f64 {
        (RADIUS_PX - HOLE_PX) / (self.ends_um[1] - self.ends_um[0])
    }

    /// From one ring to the next.
    pub(crate) fn division_um(&self) -> f64 {
        self.ticks.step
    }

    pub(crate) fn first_um(&self) -> f64 {
        self.ends_um[0]
    }

    /// Less than this is nothing.
    fn slack_um(&self) -> f64 {
        self.ticks.step / 1e6
    }

    /// The rings, the nominal one dashed.
    pub(crate) fn draw(&self, svg: &mut Svg, centre: Point) {
        for um in &self.ticks.at {
            let style = if um.abs() < self.slack_um() {
                nominal_style()
            } else {
                Style::line(FAINT, 0.9)
            };
            svg.circle(centre, self.radius_px(*um), &style);
        }
    }

    /// The rings far enough from the last number for one of their own, from the inside.
    fn numbered_um(&self) -> Vec<f64> {
        let mut last_px = f64::NEG_INFINITY;
        let mut numbered = Vec::new();
        for um in &self.ticks.at {
            let radius = self.radius_px(*um);
            if radius - last_px >= APART_PX {
                last_px = radius;
                numbered.push(*um);
            }
        }
        numbered
    }
}

fn case_style(index: usize) -> Style {
    Style::line(category(index), 1.9)
}

pub(crate) fn nominal_style() -> Style {
    Style::line(INK, 1.3).dashed("6 4")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_range_from_the_hole_to_the_rim_and_contain_the_nominal_circle() {
        for (low, high) in [(-3.0, 71.0), (0.0, 6.0), (-1e-9, 0.0), (-400.0, 0.0)] {
            let rings = Rings::covering(low, high);
            let [first, last] = rings.ends_um;
            assert!(first <= low && last >= high && first < 0.0 && last > 0.0);
            assert!((rings.radius_px(first) - HOLE_PX).abs() < 1e-9);
            assert!((rings.radius_px(last) - RADIUS_PX).abs() < 1e-9);
            assert!(rings.ticks.at.iter().any(|um| um.abs() < rings.slack_um()));
        }
    }

    #[test]
    fn values_are_written_where_the_line_is_not() {
        let rings = Rings::covering(-10.0, 10.0);
        let numbered = rings.numbered_um();
        let on_ring = |deg: f64| RadialSeries {
            angle_deg: vec![deg; 5],
            radial_um: vec![numbered[1]; 5],
            ..RadialSeries::default()
        };
        let plot = |series| PolarPlot {
            series,
            ..PolarPlot::default()
        };
        let ray = |series| plot(series).clearest_ray_deg(&rings, &numbered);
        assert!((ray(Vec::new()) - 75.0).abs() < 1e-9);
        assert!((ray(vec![on_ring(75.0), on_ring(105.0)]) - 255.0).abs() < 1e-9);
    }

    #[test]
    fn references_are_distinguished_and_their_centres_are_marked() {
        let seen = |name: &str| RadialSeries {
            name: name.to_owned(),
            angle_deg: vec![0.0, 90.0, 180.0, 270.0, 360.0],
            radial_um: vec![4.0; 5],
        };
        let reference = |name: &str, centre_um| RadialReference {
            seen: seen(name),
            centre_um,
        };
        let mut plot = PolarPlot {
            zero: "LSCI".to_owned(),
            series: vec![seen("profile")],
            references: vec![reference("MCCI", [1.0, 0.0]), reference("MICI", [1e9, 0.0])],
            ..PolarPlot::default()
        };
        let svg = plot.to_svg();
        for part in ["LSCI; one ring", "MCCI", "MICI", "9 3", "2.5 2.5"] {
            assert!(svg.contains(part), "{part}");
        }
        // Without references no centre is marked; a centre out of the plot has no mark.
        let crosses = |plot: &PolarPlot| {
            plot.to_svg().matches("<line").count() + plot.to_svg().matches("<path").count()
        };
        let both = crosses(&plot);
        plot.references[1].centre_um = [0.0, 1.0];
        assert!(crosses(&plot) > both);
    }
}

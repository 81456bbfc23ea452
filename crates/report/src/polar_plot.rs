//! How round a circle comes out: the radial deviation, magnified, around the nominal circle.

use crate::axis::{extent, multiples, nice_step, tick_label};
use crate::chart::runs;
use crate::colour::{FAINT, GRID, INK, MUTED, category};
use crate::page::{BORDER_PX, Entry, Key, SMALL_PX, legend, notice, title_block};
use crate::plane::Growth;
use crate::svg::{Point, Style, Svg, Text};

const RADIUS_PX: f64 = 190.0;
const WIDTH_PX: f64 = 500.0;
/// Where the nominal circle stands if deviations are as large inwards as outwards.
const NOMINAL_SHARE: f64 = 0.6;

/// The radial deviation around a circle under one load case.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RadialSeries {
    /// Name for the legend.
    pub name: String,
    /// Angle from the horizontal axis towards the vertical axis in degrees.
    pub angle_deg: Vec<f64>,
    /// Deviation along the radius in um, outwards positive.
    pub radial_um: Vec<f64>,
}

/// What a polar plot shows.
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
    /// Which way the horizontal axis grows.
    pub growth: Growth,
    /// The load cases.
    pub series: Vec<RadialSeries>,
}

impl PolarPlot {
    /// The plot as a complete SVG document; no values gives a picture that says so.
    pub fn to_svg(&self) -> String {
        let finite = self.series.iter().flat_map(|s| &s.radial_um).copied();
        let Some((low, high)) = extent(finite.chain([0.0])).filter(|_| self.has_values()) else {
            return notice(
                &self.title,
                &self.subtitle,
                "There is nothing to draw: the circle has no values.",
            );
        };
        let step = nice_step((high - low).max(1e-6), 4.0);
        let first = (low / step).floor().min(-1.0) * step;
        let last = (high / step).ceil().max(1.0) * step;
        // The innermost ring keeps clear of the centre.
        let hole = RADIUS_PX * (1.0 - NOMINAL_SHARE) * 0.55;
        let radius = |um: f64| hole + (um - first) / (last - first) * (RADIUS_PX - hole);

        let mut svg = Svg::new();
        let top = title_block(&mut svg, &self.title, &self.subtitle, WIDTH_PX);
        let centre = [WIDTH_PX / 2.0, top + RADIUS_PX + 24.0];
        self.draw_rings(&mut svg, centre, (&multiples(first, last, step), step), radius);
        for (k, series) in self.series.iter().enumerate() {
            let points = series.angle_deg.iter().zip(&series.radial_um).map(|(a, um)| {
                let r = radius(*um);
                self.on_circle(centre, *a, r)
            });
            for run in runs(points) {
                svg.polyline(&run, &Style::line(category(k), 1.9));
            }
        }
        self.write_scale(&mut svg, centre, (&multiples(first, last, step), step), radius);
        let mut entries = vec![Entry::new(Key::Line(vec![nominal_style()]), "nominal circle")];
        for (k, series) in self.series.iter().enumerate() {
            entries.push(Entry::new(
                Key::Line(vec![Style::line(category(k), 1.9)]),
                series.name.clone(),
            ));
        }
        let y = centre[1] + RADIUS_PX + 32.0;
        let bottom = legend(
            &mut svg,
            &entries,
            [BORDER_PX + 20.0, y],
            WIDTH_PX - 2.0 * BORDER_PX - 20.0,
        );
        svg.finish(WIDTH_PX, bottom + BORDER_PX, &self.title)
    }

    fn has_values(&self) -> bool {
        let paired = self
            .series
            .iter()
            .flat_map(|s| s.angle_deg.iter().zip(&s.radial_um));
        paired.into_iter().any(|(a, r)| a.is_finite() && r.is_finite())
    }

    fn on_circle(&self, centre: Point, angle_deg: f64, radius_px: f64) -> Point {
        let (sin, cos) = angle_deg.to_radians().sin_cos();
        [
            centre[0] + self.growth.sign() * radius_px * cos,
            centre[1] - radius_px * sin,
        ]
    }

    fn draw_rings(&self, svg: &mut Svg, centre: Point, rings: (&[f64], f64), radius: impl Fn(f64) -> f64) {
        for spoke in 0..12 {
            let angle = f64::from(spoke) * 30.0;
            let outer = self.on_circle(centre, angle, RADIUS_PX);
            svg.line(
                self.on_circle(centre, angle, radius(rings.0[0])),
                outer,
                &Style::line(GRID, 1.0),
            );
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
                Text::new(10.0).colour(MUTED)
            };
            let side = (at[0] - centre[0]) / RADIUS_PX;
            let text = if side > 0.9 {
                text
            } else if side < -0.9 {
                text.end()
            } else {
                text.middle()
            };
            let nudge = if side.abs() > 0.9 {
                -6.0 * side.signum()
            } else {
                0.0
            };
            svg.text([at[0] + nudge, at[1] + 4.0], &name, &text);
        }
        for um in rings.0 {
            let is_nominal = um.abs() < rings.1 * 1e-6;
            let style = if is_nominal {
                nominal_style()
            } else {
                Style::line(FAINT, 0.9)
            };
            svg.circle(centre, radius(*um), &style);
        }
    }

    /// The ray between two spokes where the lines keep farthest from the rings' values.
    fn clearest_ray_deg(&self, radius: impl Fn(f64) -> f64) -> f64 {
        let step = RADIUS_PX / 5.0;
        let crowd = |ray: f64| -> usize {
            let near = |a: f64| ((a - ray + 540.0).rem_euclid(360.0) - 180.0).abs() < 9.0;
            let lines = self
                .series
                .iter()
                .flat_map(|s| s.angle_deg.iter().zip(&s.radial_um));
            let hits = lines.filter(|(a, um)| near(**a) && (radius(**um) / step).fract().abs() < 0.4);
            hits.count()
        };
        let rays = [75.0, 105.0, 255.0, 285.0, 45.0, 135.0, 225.0, 315.0];
        rays.into_iter().min_by_key(|ray| crowd(*ray)).unwrap_or(75.0)
    }

    /// The rings' values, along a ray between two spokes.
    fn write_scale(&self, svg: &mut Svg, centre: Point, rings: (&[f64], f64), radius: impl Fn(f64) -> f64) {
        let ray_deg = self.clearest_ray_deg(&radius);
        let mut last_r = f64::NEG_INFINITY;
        for um in rings.0 {
            let r = radius(*um);
            if r - last_r < 16.0 {
                continue;
            }
            last_r = r;
            let at = self.on_circle(centre, ray_deg, r);
            let sign = if *um > rings.1 * 1e-6 { "+" } else { "" };
            let label = format!("{sign}{} µm", tick_label(*um, rings.1));
            svg.text([at[0], at[1] + 3.5], &label, &Text::new(10.0).middle().halo(4.0));
        }
    }
}

fn nominal_style() -> Style {
    Style::line(INK, 1.3).dashed("6 4")
}

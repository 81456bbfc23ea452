//! Which way the tool is pushed: a path with the deviation as an arrow at sampled points, one colour a load case.

use crate::arrow::draw_arrow;
use crate::axis::{extent, nice_below, plain};
use crate::colour::{INK, NOMINAL, category};
use crate::page::{BORDER_PX, Entry, Key, SMALL_PX, legend, notice, title_block};
use crate::plane::{AxisLabels, BELOW_PX, Growth, Marks, Plane, Window};
use crate::svg::{Point, Style, Svg, Text};

const MOST_PX: [f64; 2] = [560.0, 480.0];
const LEAST_WIDTH_PX: f64 = 430.0;
/// The longest arrow, as a share of the drawing.
const LONGEST_ARROW: f64 = 0.16;

/// The deviation at one point of a path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Arrow {
    /// Where: horizontal, vertical, in mm.
    pub at_mm: [f64; 2],
    /// Deviation along the horizontal and vertical axis in um.
    pub deviation_um: [f64; 2],
}

/// The deviations under one load case.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ArrowCase {
    /// Name of the case, for the legend.
    pub name: String,
    /// The arrows.
    pub arrows: Vec<Arrow>,
}

/// What a vector picture shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VectorField {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// Axis labels with units.
    pub axes: AxisLabels,
    /// Which way the horizontal axis grows.
    pub growth: Growth,
    /// The nominal path in mm; give the first point again at the end to close it.
    pub path_mm: Vec<[f64; 2]>,
    /// The load cases.
    pub cases: Vec<ArrowCase>,
}

impl VectorField {
    /// The picture as a complete SVG document; no arrows gives a picture that says so.
    pub fn to_svg(&self) -> String {
        let arrows = || self.cases.iter().flat_map(|c| &c.arrows).filter(|a| is_finite(a));
        let longest_um = arrows()
            .map(|a| a.deviation_um[0].hypot(a.deviation_um[1]))
            .fold(0.0, f64::max);
        let points = || {
            let path = self
                .path_mm
                .iter()
                .filter(|p| p.iter().all(|v| v.is_finite()))
                .copied();
            path.chain(arrows().map(|a| a.at_mm))
        };
        let (Some(x), Some(y)) = (extent(points().map(|p| p[0])), extent(points().map(|p| p[1]))) else {
            return notice(
                &self.title,
                &self.subtitle,
                "There is nothing to draw: the path has no points.",
            );
        };
        let span_mm = (x.1 - x.0).max(y.1 - y.0).max(1.0);
        let factor = if longest_um > 0.0 {
            nice_below(LONGEST_ARROW * span_mm * 1000.0 / longest_um)
        } else {
            1.0
        };
        let margin = 1.25 * LONGEST_ARROW * span_mm;
        let [left_mm, right_mm] = self.growth.ends([x.0 - margin, x.1 + margin]);
        let window = Window {
            left_mm,
            right_mm,
            bottom_mm: y.0 - margin,
            top_mm: y.1 + margin,
        };
        let left = BORDER_PX + Plane::left_room_px(&window);
        let width =
            (Plane::fit(window, [left, 0.0], MOST_PX).area.right() + BORDER_PX + 10.0).max(LEAST_WIDTH_PX);

        let mut svg = Svg::new();
        let top = title_block(&mut svg, &self.title, &self.subtitle, width);
        let plane = Plane::fit(window, [left, top + 4.0], MOST_PX);
        svg.clipped(plane.area, |svg| {
            let path: Vec<Point> = self.path_mm.iter().map(|p| plane.at(*p)).collect();
            svg.polyline(&path, &nominal_style());
            for (k, case) in self.cases.iter().enumerate() {
                svg.layer("load-case", 1.0, |svg| {
                    self.draw_case(svg, &plane, case, (factor, category(k)));
                });
            }
        });
        plane.draw_frame(&mut svg, Marks::ALL);
        plane.draw_labels(&mut svg, &self.axes);
        let scale_y = plane.area.bottom() + BELOW_PX + 14.0;
        if longest_um > 0.0 {
            draw_scale(
                &mut svg,
                [left, scale_y],
                factor * plane.px_per_mm / 1000.0,
                (longest_um, factor),
            );
        }
        let mut entries = vec![Entry::new(Key::Line(vec![nominal_style()]), "nominal path")];
        for (k, case) in self.cases.iter().enumerate() {
            entries.push(Entry::new(
                Key::Line(vec![Style::line(category(k), 2.0)]),
                case.name.clone(),
            ));
        }
        let bottom = legend(
            &mut svg,
            &entries,
            [left, scale_y + 10.0],
            width - left - BORDER_PX,
        );
        svg.finish(width, bottom + BORDER_PX, &self.title)
    }

    fn draw_case(&self, svg: &mut Svg, plane: &Plane, case: &ArrowCase, (factor, colour): (f64, &str)) {
        let mm = factor / 1000.0;
        let tip = |a: &Arrow| {
            plane.at([
                a.at_mm[0] + a.deviation_um[0] * mm,
                a.at_mm[1] + a.deviation_um[1] * mm,
            ])
        };
        for arrow in case.arrows.iter().filter(|a| is_finite(a)) {
            draw_arrow(svg, [plane.at(arrow.at_mm), tip(arrow)], colour);
        }
        for arrow in case.arrows.iter().filter(|a| is_finite(a)) {
            svg.circle(plane.at(arrow.at_mm), 1.6, &Style::fill(INK));
        }
    }
}

/// The arrow that says how long a nice deviation is drawn, from `at`.
fn draw_scale(svg: &mut Svg, at: Point, px_per_um: f64, (longest_um, factor): (f64, f64)) {
    let shown_um = nice_below(longest_um);
    let tip = [at[0] + shown_um * px_per_um, at[1]];
    draw_arrow(svg, [at, tip], INK);
    let text = format!("{} µm (deviations drawn × {})", plain(shown_um), plain(factor));
    svg.text([tip[0] + 8.0, at[1] + 4.0], &text, &Text::new(SMALL_PX));
}

fn nominal_style() -> Style {
    Style::line(NOMINAL, 1.4)
}

fn is_finite(arrow: &Arrow) -> bool {
    arrow
        .at_mm
        .iter()
        .chain(&arrow.deviation_um)
        .all(|v| v.is_finite())
}

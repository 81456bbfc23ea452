//! The deviation of the tool along a path as an arrow at sampled points, one colour a load case.
//!
//! An arrow begins on the path, where the tool should be, and points to where it is; all are drawn at one
//! magnification, 1, 2 or 5 times a power of ten, so that the longest takes about a sixth of the path's extent
//! at most. The magnification and an arrow of known length are below the drawing.

use crate::arrow::draw_arrow;
use crate::axis::{extent, nice_below, plain};
use crate::colour::{INK, NOMINAL, category};
use crate::font::SMALL_PX;
use crate::legend::Entry;
use crate::page::{BORDER_PX, Heading, LEAST_WIDTH_PX};
use crate::plane::{AxisLabels, BELOW_PX, Growth, Plane, Window};
use crate::svg::{Point, Style, Svg, Text};

/// Largest drawing: width, height.
const MOST_PX: [f64; 2] = [560.0, 480.0];
/// The longest arrow, as a share of the longer side of what path and arrows' feet take up.
pub(crate) const LONGEST_ARROW: f64 = 0.16;

/// The deviation at one point of a path; an arrow with a number that is not finite is left out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Arrow {
    /// Where: horizontal, vertical, in mm.
    pub at_mm: [f64; 2],
    /// Deviation along the horizontal and vertical axis in um, in the directions in which the axes grow.
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

/// The input of a vector picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VectorField {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// Axis labels with units.
    pub axes: AxisLabels,
    /// Direction of the horizontal axis; positions and deviations follow it alike.
    pub growth: Growth,
    /// The nominal path in mm; give the first point again at the end to close it.
    pub path_mm: Vec<[f64; 2]>,
    /// The load cases.
    pub cases: Vec<ArrowCase>,
}

impl VectorField {
    /// The picture as a complete SVG document; no arrows gives a picture that says so.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        let Some(([across, up], span_mm)) = self.extent_mm() else {
            return heading.notice("There is nothing to draw: the path has no points.");
        };
        let margin = 1.25 * LONGEST_ARROW * span_mm;
        let [left_mm, right_mm] = self.growth.ends([across.0 - margin, across.1 + margin]);
        let window = Window {
            left_mm,
            right_mm,
            bottom_mm: up.0 - margin,
            top_mm: up.1 + margin,
        };
        let plane = Plane::with_axis_room(window, MOST_PX);
        let width = plane.area.right() + BORDER_PX + 10.0;
        let mut page = heading.page(width.max(LEAST_WIDTH_PX));
        let plane = plane.lowered_to(page.top_px + 4.0);
        let magnified = Magnified::new(self.longest_um(), span_mm);
        page.svg.clipped(plane.area, |svg| {
            let path: Vec<Point> = self.path_mm.iter().map(|p| plane.at(*p)).collect();
            svg.polyline(&path, &nominal_style());
            for (k, case) in self.cases.iter().enumerate() {
                svg.layer("load-case", 1.0, |svg| {
                    for arrow in case.arrows.iter().filter(|a| is_finite(a)) {
                        let ends = [plane.at(arrow.at_mm), plane.at(magnified.tip_mm(arrow))];
                        draw_arrow(svg, ends, category(k));
                    }
                    for arrow in case.arrows.iter().filter(|a| is_finite(a)) {
                        svg.circle(plane.at(arrow.at_mm), 1.6, &Style::fill(INK));
                    }
                });
            }
        });
        plane.draw_axes(&mut page.svg, &self.axes);
        let left = plane.area.x;
        let scale_y = plane.area.bottom() + BELOW_PX + 14.0;
        magnified.draw_scale(&mut page.svg, [left, scale_y], plane.px_per_mm);
        page.finish_with_legend(&self.entries(), [left, scale_y + 10.0])
    }

    /// The arrows that can be drawn, of all cases.
    fn finite_arrows(&self) -> impl Iterator<Item = &Arrow> {
        self.cases.iter().flat_map(|c| &c.arrows).filter(|a| is_finite(a))
    }

    /// Length of the longest deviation; 0 without arrows.
    fn longest_um(&self) -> f64 {
        let sizes = self
            .finite_arrows()
            .map(|a| a.deviation_um[0].hypot(a.deviation_um[1]));
        sizes.fold(0.0, f64::max)
    }

    /// Least and greatest of path and arrows across and up, and the longer of the two ways, never nothing.
    fn extent_mm(&self) -> Option<([(f64, f64); 2], f64)> {
        let path = self.path_mm.iter().filter(|p| p.iter().all(|v| v.is_finite()));
        let points: Vec<[f64; 2]> = path
            .copied()
            .chain(self.finite_arrows().map(|a| a.at_mm))
            .collect();
        let along = |k: usize| extent(points.iter().map(|p| p[k]));
        let (across, up) = (along(0)?, along(1)?);
        Some(([across, up], (across.1 - across.0).max(up.1 - up.0).max(1.0)))
    }

    fn entries(&self) -> Vec<Entry> {
        let cases = self.cases.iter().enumerate();
        let cases = cases.map(|(k, case)| Entry::line(Style::line(category(k), 2.0), case.name.clone()));
        let mut entries = vec![Entry::line(nominal_style(), "nominal path")];
        entries.extend(cases);
        entries
    }
}

/// The magnification of the deviations.
pub(crate) struct Magnified {
    /// The longest deviation of all.
    longest_um: f64,
    /// The factor of the magnification.
    times: f64,
}

impl Magnified {
    /// A nice factor that draws the longest deviation as a part of the picture.
    pub(crate) fn new(longest_um: f64, span_mm: f64) -> Self {
        let times = if longest_um > 0.0 {
            nice_below(LONGEST_ARROW * span_mm * 1000.0 / longest_um)
        } else {
            1.0
        };
        Self { longest_um, times }
    }

    /// Where an arrow ends on the magnified plane.
    pub(crate) fn tip_mm(&self, arrow: &Arrow) -> [f64; 2] {
        let mm = self.times / 1000.0;
        [0, 1].map(|k| arrow.at_mm[k] + arrow.deviation_um[k] * mm)
    }

    /// The scale arrow with its length in micrometres, from `at`; none where all deviations are 0.
    pub(crate) fn draw_scale(&self, svg: &mut Svg, at: Point, px_per_mm: f64) {
        if self.longest_um <= 0.0 {
            return;
        }
        let shown_um = nice_below(self.longest_um);
        let tip = [at[0] + shown_um * (self.times * px_per_mm / 1000.0), at[1]];
        draw_arrow(svg, [at, tip], INK);
        let text = format!(
            "{} µm (deviations drawn × {})",
            plain(shown_um),
            plain(self.times)
        );
        svg.text([tip[0] + 8.0, at[1] + 4.0], &text, &Text::new(SMALL_PX));
    }
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

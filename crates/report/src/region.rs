//! The permissible region of a plane: where the deviation is within the tolerance, and what part fits in there.
//!
//! | colour | meaning |
//! |---|---|
//! | green | the value is within the tolerance; with a spread: value + spread is |
//! | sand | the tolerance is between value - spread and value + spread |
//! | grey | the value is over the tolerance; with a spread: value - spread is |
//! | hatched | no posture, or one beyond the joint limits |
//!
//! Inscribed shapes are computed by the caller and only drawn here. Not checked: that they fit.

use crate::axis::plain;
use crate::colour::{INK, OVER, UNDECIDED, WITHIN};
use crate::field::{FieldStyle, IsoLines, Paint, draw_field, window_of, zone_entries};
use crate::font::SMALL_PX;
use crate::grid::Grid;
use crate::legend::{Entry, Key};
use crate::levels::Levels;
use crate::line_label::points_under;
use crate::marker::write_on_map;
use crate::page::{BORDER_PX, Heading, LEAST_WIDTH_PX};
use crate::plane::{AxisLabels, BELOW_PX, Plane};
use crate::svg::{Point, Style, Svg};
use crate::tolerance;

const MOST_PX: [f64; 2] = [600.0, 470.0];

/// A rectangle with its sides along the axes of the plane, by two opposite corners in any order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RectangleMm {
    /// One corner: horizontal, vertical.
    pub corner_mm: [f64; 2],
    /// The opposite corner.
    pub opposite_mm: [f64; 2],
}

/// A circle in the plane; one without a positive radius is not drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CircleMm {
    /// Centre: horizontal, vertical.
    pub centre_mm: [f64; 2],
    /// Radius.
    pub radius_mm: f64,
}

/// The input of a region map.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RegionMap {
    /// First line, bold.
    pub title: String,
    /// Second line: fraction within, area, load.
    pub subtitle: String,
    /// The points and their values in um.
    pub grid: Grid,
    /// Expanded uncertainty of each value, in um, by point, for a coverage of 95 % as the legend
    /// says; empty where that is not known. Points whose interval contains the tolerance are painted as undecided.
    /// A list of another length than the points, or with a number that is not finite, counts as empty.
    pub spread_um: Vec<f64>,
    /// Axis labels with units.
    pub axes: AxisLabels,
    /// Permissible deviation in um; a tolerance that is not finite gives a picture that says so.
    pub tolerance_um: f64,
    /// Whether iso-lines of the deviation are drawn.
    pub show_iso_lines: bool,
    /// Largest rectangle inside the region; its size is written on it.
    pub rectangle: Option<RectangleMm>,
    /// Largest circle inside the region; its diameter is written on it.
    pub circle: Option<CircleMm>,
}

impl RegionMap {
    /// The map as a complete SVG document; a grid that cannot be drawn gives a picture that says why.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        if let Some(reason) = self.grid.obstacle() {
            return heading.notice(&reason);
        }
        let levels = Levels::covering(self.grid.values_um()).filter(|_| self.tolerance_um.is_finite());
        let Some(levels) = levels else {
            return heading.notice("The tolerance is not a number.");
        };
        let plane = Plane::with_axis_room(window_of(&self.grid), MOST_PX);
        let width = plane.area.right() + BORDER_PX + 12.0;
        let mut page = heading.page(width.max(LEAST_WIDTH_PX));
        let plane = plane.lowered_to(page.top_px + 4.0);
        let sizes = self.size_labels(&plane);
        let under = |(at, text): &(Point, String)| points_under(*at, text, SMALL_PX);
        let obstacles: Vec<_> = sizes.iter().flat_map(under).collect();
        let uncertainty = self
            .has_uncertainty()
            .then(|| [-1.0, 1.0].map(|times| self.grid.raised(&self.spread_um, times)));
        let look = FieldStyle {
            levels: &levels,
            paint: Paint::Region,
            iso_lines: if self.show_iso_lines {
                IsoLines::Labelled
            } else {
                IsoLines::Off
            },
            tolerance_um: Some(self.tolerance_um),
            uncertainty: uncertainty.as_ref(),
            obstacles: &obstacles,
        };
        draw_field(&mut page.svg, &plane, &self.grid, &look);
        self.draw_fits(&mut page.svg, &plane);
        for (at, text) in &sizes {
            write_on_map(&mut page.svg, *at, text);
        }
        plane.draw_axes(&mut page.svg, &self.axes);
        let mut entries = self.entries();
        let zones = zone_entries(&mut page.svg, std::iter::once(&self.grid), Paint::Region);
        entries.extend(zones);
        let below = plane.area.bottom() + BELOW_PX + 8.0;
        page.finish_with_legend(&entries, [plane.area.x, below])
    }

    /// Whether there is a spread to paint.
    fn has_uncertainty(&self) -> bool {
        self.spread_um.len() == self.grid.points.len()
            && self.spread_um.iter().all(|spread| spread.is_finite())
            && self.spread_um.iter().any(|spread| *spread > 0.0)
    }

    fn entries(&self) -> Vec<Entry> {
        let tolerance = plain(self.tolerance_um);
        let uncertain = self.has_uncertainty();
        let coverage = if uncertain { " (95 %)" } else { "" };
        let mut entries = vec![Entry::new(
            Key::field(WITHIN),
            format!("within {tolerance} µm{coverage}"),
        )];
        if uncertain {
            entries.push(Entry::new(Key::field(UNDECIDED), "within the uncertainty (95 %)"));
        }
        entries.extend([
            Entry::new(Key::field(OVER), format!("over {tolerance} µm")),
            tolerance::entry(self.tolerance_um, ""),
        ]);
        let (rectangle, circle) = self.fits();
        if rectangle.is_some() {
            entries.push(Entry::line(rectangle_style(), "largest rectangle"));
        }
        if circle.is_some() {
            entries.push(Entry::line(circle_style(), "largest circle"));
        }
        entries
    }

    /// The shapes that fit, where all their numbers are finite.
    fn fits(&self) -> (Option<RectangleMm>, Option<CircleMm>) {
        let rectangle = self
            .rectangle
            .filter(|r| r.corner_mm.iter().chain(&r.opposite_mm).all(|v| v.is_finite()));
        let circle = self.circle.filter(|c| {
            c.centre_mm.iter().all(|v| v.is_finite()) && c.radius_mm.is_finite() && c.radius_mm > 0.0
        });
        (rectangle, circle)
    }

    /// The outlines of the shapes that fit.
    fn draw_fits(&self, svg: &mut Svg, plane: &Plane) {
        let (rectangle, circle) = self.fits();
        if let Some(r) = rectangle {
            let ([a, b], [c, d]) = (r.corner_mm, r.opposite_mm);
            let corners = [[a, b], [c, b], [c, d], [a, d]].map(|p| plane.at(p));
            svg.layer("inscribed-rectangle", 1.0, |svg| {
                svg.polygon(&corners, &rectangle_style());
            });
        }
        if let Some(c) = circle {
            let radius_px = c.radius_mm * plane.px_per_mm;
            let at = plane.at(c.centre_mm);
            svg.layer("inscribed-circle", 1.0, |svg| {
                svg.circle(at, radius_px, &circle_style());
            });
        }
    }

    /// The sizes of the shapes and their positions: under the rectangle's upper side and at the circle's centre.
    fn size_labels(&self, plane: &Plane) -> Vec<(Point, String)> {
        let mut labels: Vec<(Point, String)> = Vec::new();
        let (rectangle, circle) = self.fits();
        if let Some(r) = rectangle {
            let (a, b) = (plane.at(r.corner_mm), plane.at(r.opposite_mm));
            let size = [0, 1].map(|k| plain((r.opposite_mm[k] - r.corner_mm[k]).abs()));
            let at = [(a[0] + b[0]) / 2.0, a[1].min(b[1]) + 16.0];
            labels.push((at, format!("{} × {} mm", size[0], size[1])));
        }
        if let Some(c) = circle {
            let [x, y] = plane.at(c.centre_mm);
            let clear = labels.iter().all(|(at, _)| (at[1] - y - 4.0).abs() > 16.0);
            let at = [x, if clear { y + 4.0 } else { y + 24.0 }];
            labels.push((at, format!("Ø {} mm", plain(2.0 * c.radius_mm))));
        }
        labels
    }
}

fn rectangle_style() -> Style {
    Style::line(INK, 1.6)
}

fn circle_style() -> Style {
    Style::line("#0072B2", 1.6).dashed("6 4")
}

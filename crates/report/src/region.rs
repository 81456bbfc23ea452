//! The permissible region of a plane: where the deviation keeps within the limit, and what part fits in there.

use crate::axis::plain;
use crate::colour::{DOUBTFUL, INK, OVER, WITHIN};
use crate::field::{IsoLines, Look, Paint, draw_field, window_of, zone_entries};
use crate::grid::Grid;
use crate::levels::Levels;
use crate::limit;
use crate::line_label::points_under;
use crate::marker::write_on_map;
use crate::page::{BORDER_PX, Entry, Key, SMALL_PX, legend, notice, title_block};
use crate::plane::{AxisLabels, BELOW_PX, Marks, Plane};
use crate::svg::{Point, Style, Svg};

const MOST_PX: [f64; 2] = [600.0, 470.0];
const LEAST_WIDTH_PX: f64 = 430.0;

/// An axis-parallel rectangle in mm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RectangleMm {
    /// One corner: horizontal, vertical.
    pub corner_mm: [f64; 2],
    /// The opposite corner.
    pub opposite_mm: [f64; 2],
}

/// A circle in mm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CircleMm {
    /// Centre: horizontal, vertical.
    pub centre_mm: [f64; 2],
    /// Radius.
    pub radius_mm: f64,
}

/// What a region map shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RegionMap {
    /// First line, bold.
    pub title: String,
    /// Second line: fraction within, area, load.
    pub subtitle: String,
    /// The points and their values in um.
    pub grid: Grid,
    /// How far each value may stray to either side, in um, by point; empty where that is not known. Where the limit
    /// lies in between is painted as doubtful.
    pub spread_um: Vec<f64>,
    /// Axis labels with units.
    pub axes: AxisLabels,
    /// Permissible deviation in um.
    pub limit_um: f64,
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
        if let Some(reason) = self.grid.obstacle() {
            return notice(&self.title, &self.subtitle, &reason);
        }
        let levels = Levels::covering(self.grid.values_um()).filter(|_| self.limit_um.is_finite());
        let Some(levels) = levels else {
            return notice(&self.title, &self.subtitle, "The limit is not a number.");
        };
        let window = window_of(&self.grid);
        let left = BORDER_PX + Plane::left_room_px(&window);
        let plane = Plane::fit(window, [left, 0.0], MOST_PX);
        let width = (plane.area.right() + BORDER_PX + 12.0).max(LEAST_WIDTH_PX);

        let mut svg = Svg::new();
        let top = title_block(&mut svg, &self.title, &self.subtitle, width);
        let plane = Plane::fit(window, [left, top + 4.0], MOST_PX);
        let iso_lines = if self.show_iso_lines {
            IsoLines::Labelled
        } else {
            IsoLines::Off
        };
        let sizes = self.size_labels(&plane);
        let obstacles: Vec<_> = sizes
            .iter()
            .flat_map(|(at, text)| points_under(*at, text, SMALL_PX))
            .collect();
        let doubt = self
            .is_doubtful()
            .then(|| [-1.0, 1.0].map(|times| self.grid.raised(&self.spread_um, times)));
        let look = Look {
            levels: &levels,
            paint: Paint::Region,
            iso_lines,
            limit_um: Some(self.limit_um),
            doubt: doubt.as_ref(),
            obstacles: &obstacles,
        };
        draw_field(&mut svg, &plane, &self.grid, &look);
        self.draw_fits(&mut svg, &plane);
        for (at, text) in &sizes {
            write_on_map(&mut svg, *at, text);
        }
        plane.draw_frame(&mut svg, Marks::ALL);
        plane.draw_labels(&mut svg, &self.axes);
        let mut entries = self.entries();
        entries.extend(zone_entries(&mut svg, std::iter::once(&self.grid), Paint::Region));
        let below = plane.area.bottom() + BELOW_PX + 8.0;
        let bottom = legend(&mut svg, &entries, [left, below], width - left - BORDER_PX);
        svg.finish(width, bottom + BORDER_PX, &self.title)
    }

    fn is_doubtful(&self) -> bool {
        self.spread_um.len() == self.grid.points.len()
            && self.spread_um.iter().all(|spread| spread.is_finite())
            && self.spread_um.iter().any(|spread| *spread > 0.0)
    }

    fn entries(&self) -> Vec<Entry> {
        let limit = plain(self.limit_um);
        let doubtful = self.is_doubtful();
        let within = if doubtful { "surely within" } else { "within" };
        let mut entries = vec![Entry::new(Key::field(WITHIN), format!("{within} {limit} µm"))];
        if doubtful {
            entries.push(Entry::new(Key::field(DOUBTFUL), "within the uncertainty (95 %)"));
        }
        entries.extend([
            Entry::new(Key::field(OVER), format!("over {limit} µm")),
            limit::entry(self.limit_um, ""),
        ]);
        if self.rectangle.is_some() {
            entries.push(Entry::new(
                Key::Line(vec![rectangle_style()]),
                "largest rectangle",
            ));
        }
        if self.circle.is_some() {
            entries.push(Entry::new(Key::Line(vec![circle_style()]), "largest circle"));
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

    /// The sizes of the shapes and where they stand: under the rectangle's upper side and at the circle's centre.
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

//! The bodies of a cell from two sides, and the two that are nearest.
//!
//! | what | drawn as |
//! |---|---|
//! | link, tool, cutter, part, obstacle | its outline, filled in a colour of its kind; what it is made of are balls, and what is between them |
//! | line of the arm | through the origins of its joints |
//! | floor | a line where it is seen from the side |
//! | nearest points | two dots and the line between them, red, with their distance |
//!
//! The panels show the arm, its tool, the part and the nearest points; what stands farther away is cut. All points are in the base frame,
//! in mm. Bodies with a hollow are drawn filled: an outline is that of the convex hull.

use super::shapes::hull;
use super::view::{Projection, View};
use crate::axis::{extent, multiples, nice_step, plain};
use crate::colour::{FAINT, GRID, INK, MUTED, SIGNAL};
use crate::font::SMALL_PX;
use crate::legend::{Entry, Key};
use crate::page::{BORDER_PX, Heading};
use crate::svg::{Point, Rect, Style, Svg, Text};

/// What a body is; decides its colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum BodyKind {
    /// What stands in the cell, or carries the arm.
    Obstacle,
    /// The part or its stock.
    Part,
    /// A link of the arm.
    Link,
    /// Spindle, holder, or another part of the tool.
    Tool,
    /// The cutter.
    Cutter,
}

impl BodyKind {
    /// Its colour, and what it is called in the legend.
    fn key(self) -> (&'static str, &'static str) {
        match self {
            BodyKind::Obstacle => ("#9a9a9a", "obstacle"),
            BodyKind::Part => ("#E69F00", "part"),
            BodyKind::Link => ("#56B4E9", "arm"),
            BodyKind::Tool => ("#0072B2", "tool"),
            BodyKind::Cutter => ("#882255", "cutter"),
        }
    }
}

/// A body: balls of one radius about some points, and all that is between them.
#[derive(Clone, Debug, PartialEq)]
pub struct CellBody {
    /// What it is.
    pub kind: BodyKind,
    /// Centres of the balls: the corners of a box, the ends of a capsule, the vertices of a mesh.
    pub points_mm: Vec<[f64; 3]>,
    /// Their radius; 0 for corners.
    pub radius_mm: f64,
}

/// The two bodies that are nearest.
#[derive(Clone, Debug, PartialEq)]
pub struct NearestPair {
    /// Their nearest points.
    pub points_mm: [[f64; 3]; 2],
    /// Their distance in words, such as `12.3 mm`.
    pub label: String,
}

/// The bodies of a cell with the arm in a posture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CellView {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// The bodies; points that are not finite are left out.
    pub bodies: Vec<CellBody>,
    /// The line of the arm: base, joint origins, flange, tool centre point.
    pub line_mm: Vec<[f64; 3]>,
    /// Four corners of a piece of the floor, in order around it.
    pub floor_mm: Option<[[f64; 3]; 4]>,
    /// The two that are nearest.
    pub nearest: Option<NearestPair>,
}

/// Each panel: width and height.
const PANEL_PX: [f64; 2] = [430.0, 430.0];
const GAP_PX: f64 = 16.0;
const TITLE_ROW_PX: f64 = 20.0;
/// Border inside a panel, and that for the numbers of its axes.
const INSET_PX: f64 = 14.0;
const NUMBERS_PX: f64 = 34.0;
/// Corners of the polygon that a circle is drawn as.
const CIRCLE: usize = 40;

impl CellView {
    /// The bodies from the side and from above, as a complete SVG document; without bodies a notice.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        let Some(fit) = self.fitted_points() else {
            return heading.notice("There is nothing to draw: no body is known.");
        };
        let views = [View::Side, View::Top];
        let width = 2.0 * BORDER_PX + 2.0 * PANEL_PX[0] + GAP_PX;
        let mut page = heading.page(width);
        let top = page.top_px + TITLE_ROW_PX;
        for (k, view) in views.into_iter().enumerate() {
            let x = BORDER_PX + k as f64 * (PANEL_PX[0] + GAP_PX);
            page.svg
                .text([x, top - 7.0], view.name(), &Text::new(SMALL_PX).bold());
            let area = Rect {
                x,
                y: top,
                w: PANEL_PX[0],
                h: PANEL_PX[1],
            };
            self.panel(&mut page.svg, view, &fit, area);
        }
        page.finish_with_legend(&self.legend(), [BORDER_PX, top + PANEL_PX[1] + 12.0])
    }

    /// What the panels must show: arm, tool, part and nearest points; everything where there is none of these.
    fn fitted_points(&self) -> Option<Vec<([f64; 3], f64)>> {
        let of = |shown: &dyn Fn(BodyKind) -> bool| -> Vec<([f64; 3], f64)> {
            let bodies = self.bodies.iter().filter(|body| shown(body.kind));
            bodies.flat_map(finite).collect()
        };
        let mut points = of(&|kind| kind != BodyKind::Obstacle);
        if points.is_empty() {
            points = of(&|_| true);
        }
        let nearest = self.nearest.iter().flat_map(|nearest| nearest.points_mm);
        points.extend(nearest.map(|point| (point, 0.0)));
        (!points.is_empty()).then_some(points)
    }

    fn legend(&self) -> Vec<Entry> {
        let mut kinds: Vec<BodyKind> = self.bodies.iter().map(|body| body.kind).collect();
        kinds.sort();
        kinds.dedup();
        let mut entries: Vec<Entry> = kinds
            .into_iter()
            .map(|kind| Entry::new(Key::field(kind.key().0), kind.key().1))
            .collect();
        if self.floor_mm.is_some() {
            entries.push(Entry::line(Style::line(INK, 2.0), "floor"));
        }
        if self.nearest.is_some() {
            entries.push(Entry::line(Style::line(SIGNAL, 2.0), "nearest points"));
        }
        entries
    }

    fn panel(&self, svg: &mut Svg, view: View, fit: &[([f64; 3], f64)], area: Rect) {
        let scale = PanelScale::of(view.projection(), fit, area);
        svg.rounded(area, 4.0, &Style::fill("#fbfcfd").outlined("#d8dde2", 1.0));
        svg.clipped(area, |svg| {
            scale.draw_grid(svg);
            self.draw_floor(svg, &scale);
            let mut order: Vec<&CellBody> = self.bodies.iter().collect();
            order.sort_by_key(|body| body.kind);
            for body in order {
                let outline = scale.outline(body);
                let colour = body.kind.key().0;
                svg.polygon(&outline, &Style::fill(colour).opacity(0.35));
                svg.polygon(&outline, &Style::line(colour, 1.2));
            }
            let line: Vec<Point> = self.line_mm.iter().map(|point| scale.at(*point)).collect();
            svg.polyline(&line, &Style::line(INK, 1.4));
            for at in line {
                svg.circle(at, 2.2, &Style::fill(INK));
            }
            scale.draw_numbers(svg);
            if let Some(nearest) = &self.nearest {
                scale.draw_nearest(svg, nearest);
            }
        });
    }

    /// A line where the floor is seen from the side.
    fn draw_floor(&self, svg: &mut Svg, scale: &PanelScale) {
        let Some(corners) = &self.floor_mm else { return };
        let seen: Vec<Point> = corners.iter().map(|corner| scale.at(*corner)).collect();
        let height = extent(seen.iter().map(|point| point[1])).map_or(0.0, |(low, high)| high - low);
        let width = extent(seen.iter().map(|point| point[0])).map_or(0.0, |(low, high)| high - low);
        if height < 0.02 * width {
            svg.polygon(&seen, &Style::line(INK, 2.0));
        }
    }
}

/// The centres of a body's balls that are finite, with their radius.
fn finite(body: &CellBody) -> impl Iterator<Item = ([f64; 3], f64)> + '_ {
    let points = body.points_mm.iter().copied();
    points
        .filter(|point| point.iter().all(|v| v.is_finite()))
        .map(|point| (point, body.radius_mm))
}

/// A projection that fits a panel.
struct PanelScale {
    projection: Projection,
    area: Rect,
    px_per_mm: f64,
    /// The middle of what is shown, right and up, mm.
    middle_mm: [f64; 2],
    middle_px: Point,
}

impl PanelScale {
    fn of(projection: Projection, fit: &[([f64; 3], f64)], area: Rect) -> Self {
        let ends = [0, 1].map(|k| {
            let sides = fit.iter().flat_map(|(point, radius)| {
                let at = projection.flat(*point)[k];
                [at - radius, at + radius]
            });
            extent(sides).unwrap_or((0.0, 1.0))
        });
        let inner = Rect {
            x: area.x + NUMBERS_PX,
            y: area.y,
            w: area.w - NUMBERS_PX,
            h: area.h - NUMBERS_PX,
        }
        .shrunk(INSET_PX);
        let [width, height] = ends.map(|(low, high)| (high - low).max(1.0));
        Self {
            projection,
            area,
            px_per_mm: (inner.w / width).min(inner.h / height),
            middle_mm: ends.map(|(low, high)| 0.5 * (low + high)),
            middle_px: inner.centre(),
        }
    }

    fn flat_at(&self, flat: [f64; 2]) -> Point {
        [
            self.middle_px[0] + (flat[0] - self.middle_mm[0]) * self.px_per_mm,
            self.middle_px[1] - (flat[1] - self.middle_mm[1]) * self.px_per_mm,
        ]
    }

    fn at(&self, point: [f64; 3]) -> Point {
        self.flat_at(self.projection.flat(point))
    }

    /// The outline of a body on the panel.
    fn outline(&self, body: &CellBody) -> Vec<Point> {
        let radius_px = body.radius_mm * self.px_per_mm;
        let around = if radius_px > 0.0 { CIRCLE } else { 1 };
        let circles = finite(body).flat_map(|(point, _)| {
            let centre = self.at(point);
            (0..around).map(move |k| {
                let (sin, cos) = (std::f64::consts::TAU * k as f64 / around as f64).sin_cos();
                [centre[0] + radius_px * cos, centre[1] + radius_px * sin]
            })
        });
        hull(circles.collect())
    }

    /// Coordinates at the left and the lower edge of the panel, and the opposite ones, mm.
    fn range_mm(&self) -> [[f64; 2]; 2] {
        let right = |px: f64| self.middle_mm[0] + (px - self.middle_px[0]) / self.px_per_mm;
        let up = |px: f64| self.middle_mm[1] - (px - self.middle_px[1]) / self.px_per_mm;
        [
            [right(self.area.x), right(self.area.right())],
            [up(self.area.bottom()), up(self.area.y)],
        ]
    }

    fn step_mm(&self) -> f64 {
        let [[low, high], _] = self.range_mm();
        nice_step(high - low, 6.0)
    }

    fn draw_grid(&self, svg: &mut Svg) {
        let [[left, right], [low, high]] = self.range_mm();
        let step = self.step_mm();
        let style = |value: f64| Style::line(if value == 0.0 { FAINT } else { GRID }, 1.0);
        for x in multiples(left, right, step) {
            svg.line(self.flat_at([x, low]), self.flat_at([x, high]), &style(x));
        }
        for y in multiples(low, high, step) {
            svg.line(self.flat_at([left, y]), self.flat_at([right, y]), &style(y));
        }
    }

    /// Coordinates in mm along the lower and the left edge.
    fn draw_numbers(&self, svg: &mut Svg) {
        let [[left, right], [low, high]] = self.range_mm();
        let (step, text) = (self.step_mm(), Text::new(SMALL_PX).colour(MUTED).halo(3.0));
        for x in multiples(left, right, step) {
            let px = self.flat_at([x, low])[0];
            if px > self.area.x + NUMBERS_PX && px < self.area.right() - INSET_PX {
                svg.text([px, self.area.bottom() - 8.0], &plain(x), &text.clone().middle());
            }
        }
        for y in multiples(low, high, step) {
            let px = self.flat_at([left, y])[1];
            if px > self.area.y + INSET_PX && px < self.area.bottom() - NUMBERS_PX {
                svg.text(
                    [self.area.x + NUMBERS_PX + 4.0, px + 4.0],
                    &plain(y),
                    &text.clone().end(),
                );
            }
        }
        svg.text([self.area.x + 6.0, self.area.bottom() - 8.0], "mm", &text);
    }

    fn draw_nearest(&self, svg: &mut Svg, nearest: &NearestPair) {
        let ends = nearest.points_mm.map(|point| self.at(point));
        svg.line(ends[0], ends[1], &Style::line(SIGNAL, 2.0));
        for end in ends {
            svg.circle(end, 3.5, &Style::fill(SIGNAL).outlined("#fff", 1.0));
        }
        let middle = [0.5 * (ends[0][0] + ends[1][0]), 0.5 * (ends[0][1] + ends[1][1])];
        let is_right = middle[0] > self.area.centre()[0];
        let text = Text::new(SMALL_PX).bold().colour(SIGNAL).halo(4.0);
        let (text, x) = if is_right { (text.end(), -9.0) } else { (text, 9.0) };
        svg.text([middle[0] + x, middle[1] - 9.0], &nearest.label, &text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(bodies: Vec<CellBody>) -> CellView {
        CellView {
            title: "Cell".to_owned(),
            bodies,
            ..CellView::default()
        }
    }

    fn ball(kind: BodyKind, at: [f64; 3], radius_mm: f64) -> CellBody {
        CellBody {
            kind,
            points_mm: vec![at],
            radius_mm,
        }
    }

    #[test]
    fn the_outline_of_a_capsule_is_as_wide_as_its_length_and_two_radii() {
        let body = CellBody {
            kind: BodyKind::Link,
            points_mm: vec![[0.0; 3], [300.0, 0.0, 0.0]],
            radius_mm: 50.0,
        };
        let fit: Vec<_> = finite(&body).collect();
        let area = Rect {
            x: 0.0,
            y: 0.0,
            w: 400.0,
            h: 400.0,
        };
        let scale = PanelScale::of(View::Side.projection(), &fit, area);
        let outline = scale.outline(&body);
        let (low, high) = extent(outline.iter().map(|point| point[0])).unwrap();
        assert!(((high - low) / scale.px_per_mm - 400.0).abs() < 1e-9);
        let (low, high) = extent(outline.iter().map(|point| point[1])).unwrap();
        assert!(((high - low) / scale.px_per_mm - 100.0).abs() < 1e-9);
        assert!(outline.iter().all(|point| area.contains(*point)));
    }

    #[test]
    fn far_obstacles_do_not_make_the_arm_small() {
        let near = view(vec![ball(BodyKind::Link, [0.0; 3], 500.0)]);
        let mut far = near.clone();
        far.bodies
            .push(ball(BodyKind::Obstacle, [90_000.0, 0.0, 0.0], 10.0));
        assert_eq!(near.fitted_points(), far.fitted_points());
    }

    #[test]
    fn a_view_without_bodies_says_so_and_what_is_not_finite_is_left_out() {
        assert!(view(Vec::new()).to_svg().contains("no body is known"));
        let svg = view(vec![
            ball(BodyKind::Link, [0.0; 3], 100.0),
            ball(BodyKind::Part, [f64::NAN, 0.0, 0.0], 100.0),
        ])
        .to_svg();
        assert!(svg.starts_with("<svg") && !svg.contains("NaN"));
    }
}

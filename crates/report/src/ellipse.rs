//! The compliance of the arm by direction: the ellipse that the tool describes under a force of 1 N that turns once
//! around.
//!
//! The 2 x 2 compliance C (um/N) maps the unit circle of forces to an ellipse. Its symmetric part has the principal
//! compliances `m ± r`, `m = (c11 + c22) / 2`, `r = hypot((c11 - c22) / 2, c12)`, the softer one at
//! `atan2(c12, (c11 - c22) / 2) / 2`. The reference circle has the compliance m: the same arm, equally soft in all
//! directions.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `C` | compliance: row = deviation, column = force; horizontal, vertical | um/N |
//! | `m` | mean of the principal compliances | um/N |
//! | `m + r`, `m - r` | softest, stiffest principal compliance | um/N |
//!
//! The outline is `C f` for all `f` of length one, drawn from the whole of `C`; arrows and numbers are of the
//! symmetric part. The two agree where `C` is symmetric, as the compliance of springs alone is.

use crate::arrow::draw_arrow;
use crate::axis::three_digits;
use crate::colour::{FAINT, INK, SIGNAL, category};
use crate::font::{SMALL_PX, Weight, text_width_px};
use crate::legend::{Entry, Key};
use crate::page::{BORDER_PX, Heading, text_box};
use crate::plane::{AxisLabels, Growth, Plane, Window};
use crate::svg::{Anchor, Point, Rect, Style, Svg, Text};

/// Largest drawing: width, height.
const MOST_PX: [f64; 2] = [380.0, 380.0];
/// Half the side of the drawing, in the softest compliance.
const ROOM: f64 = 1.45;
/// Corners of the polygon that represents the ellipse.
const CORNERS: u32 = 180;
/// Colour of the stiffest direction.
const STIFF: &str = category(2);

/// What an ellipse picture shows: a picture of compliance, larger where the arm is softer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StiffnessEllipse {
    /// First line, bold.
    pub title: String,
    /// Second line: where, in which posture.
    pub subtitle: String,
    /// Axis labels with unit: `base y (µm/N)`.
    pub axes: AxisLabels,
    /// Which way the horizontal axis grows.
    pub growth: Growth,
    /// Compliance in um/N: row = deviation, column = force; horizontal, vertical.
    pub compliance_um_per_n: [[f64; 2]; 2],
}

impl StiffnessEllipse {
    /// The picture as a complete SVG document; a compliance that is not a number, or not positive in any
    /// direction, gives a picture that says so.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        let principal = Principal::of(self.compliance_um_per_n);
        if !principal.is_drawable() {
            return heading.notice(
                "There is nothing to draw: the compliance is not a positive number in any direction.",
            );
        }
        let half = ROOM * principal.soft.max(principal.stiff.abs());
        let [left_mm, right_mm] = self.growth.ends([-half, half]);
        let window = Window {
            left_mm,
            right_mm,
            bottom_mm: -half,
            top_mm: half,
        };
        let plane = Plane::with_axis_room(window, MOST_PX);
        let mut page = heading.page(plane.area.x + MOST_PX[0] + BORDER_PX + 20.0);
        let plane = plane.lowered_to(page.top_px + 4.0);
        self.draw_ellipse(&mut page.svg, &plane);
        let centre = plane.at([0.0, 0.0]);
        let radius_px = principal.mean.abs() * plane.px_per_mm;
        page.svg.circle(centre, radius_px, &mean_style());
        draw_directions(&mut page.svg, &plane, principal.directions());
        plane.draw_axes(&mut page.svg, &self.axes);
        let below = [plane.area.x, plane.area.bottom() + 50.0];
        page.finish_with_legend(&entries(&principal), below)
    }

    /// Two lines through the middle, and what the unit circle of forces becomes.
    fn draw_ellipse(&self, svg: &mut Svg, plane: &Plane) {
        let centre = plane.at([0.0, 0.0]);
        let area = plane.area;
        let faint = Style::line(FAINT, 0.9);
        svg.line([area.x, centre[1]], [area.right(), centre[1]], &faint);
        svg.line([centre[0], area.y], [centre[0], area.bottom()], &faint);
        let [[a, b], [c, d]] = self.compliance_um_per_n;
        let outline: Vec<Point> = (0..CORNERS)
            .map(|k| {
                let (s, c0) = (f64::from(k) * std::f64::consts::TAU / f64::from(CORNERS)).sin_cos();
                plane.at([a * c0 + b * s, c * c0 + d * s])
            })
            .collect();
        svg.polygon(&outline, &outline_style(2.0));
    }
}

/// The symmetric part of a compliance in its own directions, um/N.
struct Principal {
    /// Mean of the two.
    mean: f64,
    /// The larger one.
    soft: f64,
    /// The smaller one; negative where `C` is not a compliance of springs.
    stiff: f64,
    /// Where the arm is softest, from the horizontal axis.
    turn_rad: f64,
}

/// One direction and the compliance along it.
struct Direction {
    um_per_n: f64,
    turn_rad: f64,
    colour: &'static str,
}

impl Principal {
    /// Of the symmetric part of a matrix.
    fn of([[a, b], [c, d]]: [[f64; 2]; 2]) -> Self {
        let mean = (a + d) / 2.0;
        let shear = (b + c) / 2.0;
        let radius = ((a - d) / 2.0).hypot(shear);
        Self {
            mean,
            soft: mean + radius,
            stiff: mean - radius,
            turn_rad: shear.atan2((a - d) / 2.0) / 2.0,
        }
    }

    /// Whether both are numbers and the larger is positive.
    fn is_drawable(&self) -> bool {
        self.soft.is_finite() && self.stiff.is_finite() && self.soft > 0.0
    }

    /// The softest and the stiffest.
    fn directions(&self) -> [Direction; 2] {
        [
            Direction {
                um_per_n: self.soft,
                turn_rad: self.turn_rad,
                colour: SIGNAL,
            },
            Direction {
                um_per_n: self.stiff,
                turn_rad: self.turn_rad + std::f64::consts::FRAC_PI_2,
                colour: STIFF,
            },
        ]
    }
}

impl Direction {
    /// Where the arrow to one or the other side (1, -1) ends.
    fn tip(&self, plane: &Plane, side: f64) -> Point {
        let size = side * self.um_per_n;
        plane.at([size * self.turn_rad.cos(), size * self.turn_rad.sin()])
    }
}

/// Arrows to both sides of each direction, then a number at one of its two heads.
fn draw_directions(svg: &mut Svg, plane: &Plane, directions: [Direction; 2]) {
    let centre = plane.at([0.0, 0.0]);
    for direction in &directions {
        for side in [1.0, -1.0] {
            draw_arrow(svg, [centre, direction.tip(plane, side)], direction.colour);
        }
    }
    let mut taken = Vec::new();
    for direction in &directions {
        let label = format!("{} µm/N", three_digits(direction.um_per_n));
        let place = label_place(plane, direction, &label, &taken);
        taken.push(text_box(place, &label, SMALL_PX, Anchor::Middle));
        let text = Text::new(SMALL_PX).bold().middle().halo(3.5);
        svg.text(place, &label, &text.colour(direction.colour));
    }
}

/// What the legend says: ellipse, both directions, reference circle.
fn entries(principal: &Principal) -> [Entry; 4] {
    let even = format!(
        "equally soft in all directions: {} µm/N",
        three_digits(principal.mean)
    );
    [
        Entry::new(Key::Field(outline_style(1.5)), "deviation under 1 N"),
        Entry::line(Style::line(SIGNAL, 2.0), "softest direction"),
        Entry::line(Style::line(STIFF, 2.0), "stiffest direction"),
        Entry::line(mean_style(), even),
    ]
}

fn outline_style(width_px: f64) -> Style {
    Style::fill("#dbe9f4").outlined(category(0), width_px)
}

fn mean_style() -> Style {
    Style::line(INK, 1.2).dashed("6 4")
}

/// A place beyond one of the two arrow heads, inside the frame and clear of other labels; the second head's
/// where neither is clear.
fn label_place(plane: &Plane, direction: &Direction, label: &str, taken: &[Rect]) -> Point {
    let centre = plane.at([0.0, 0.0]);
    let half = text_width_px(label, SMALL_PX, Weight::Bold) / 2.0;
    let inner = plane.area.shrunk(4.0);
    let mut fallback = centre;
    for side in [1.0, -1.0] {
        let tip = direction.tip(plane, side);
        let length = (tip[0] - centre[0]).hypot(tip[1] - centre[1]).max(1.0);
        let (ux, uy) = ((tip[0] - centre[0]) / length, (tip[1] - centre[1]) / length);
        let away = 10.0 + half * ux.abs();
        let mut at = [
            tip[0] + away * ux,
            tip[1] + 4.0 + (12.0 + 0.55 * half * ux.abs()) * uy,
        ];
        at[0] = at[0].clamp(inner.x + half, (inner.right() - half).max(inner.x + half));
        at[1] = at[1].clamp(inner.y + 12.0, inner.bottom() - 4.0);
        fallback = at;
        let place = text_box(at, label, SMALL_PX, Anchor::Middle);
        if !taken.iter().any(|t| t.overlaps(&place)) {
            return at;
        }
    }
    fallback
}

//! In which direction the arm yields: the ellipse that a force of 1 N, turned all the way round, draws with the tool.
//!
//! The 2 x 2 compliance C (um/N) maps the unit circle of forces to an ellipse. Its symmetric part has the principal compliances
//! `m ± r`, `m = (c11 + c22) / 2`, `r = hypot((c11 - c22) / 2, c12)`, the softer one at `atan2(c12, (c11 - c22) / 2) / 2`.
//! The reference circle has the compliance m: the same arm, equally soft in all directions.

use crate::arrow::draw_arrow;
use crate::axis::three_digits;
use crate::colour::{FAINT, INK, SIGNAL, category};
use crate::page::{BORDER_PX, Entry, Key, SMALL_PX, legend, notice, overlap, text_box, title_block};
use crate::plane::{AxisLabels, Growth, Marks, Plane, Window};
use crate::svg::{Anchor, Ends, Point, Style, Svg, Text, trace};

const MOST_PX: [f64; 2] = [380.0, 380.0];
const CORNERS: u32 = 180;

/// What an ellipse picture shows.
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
    /// The picture as a complete SVG document; a compliance that is no number gives a picture that says so.
    pub fn to_svg(&self) -> String {
        let [[a, b], [c, d]] = self.compliance_um_per_n;
        let mean = (a + d) / 2.0;
        let shear = (b + c) / 2.0;
        let radius = ((a - d) / 2.0).hypot(shear);
        let (soft, stiff) = (mean + radius, mean - radius);
        if !(soft.is_finite() && stiff.is_finite() && soft > 0.0) {
            let reason =
                "There is nothing to draw: the compliance is not a positive number in any direction.";
            return notice(&self.title, &self.subtitle, reason);
        }
        let turn_rad = shear.atan2((a - d) / 2.0) / 2.0;
        let half = 1.45 * soft.max(stiff.abs());
        let [left_mm, right_mm] = self.growth.ends([-half, half]);
        let window = Window {
            left_mm,
            right_mm,
            bottom_mm: -half,
            top_mm: half,
        };
        let left = BORDER_PX + Plane::left_room_px(&window);
        let width = left + MOST_PX[0] + BORDER_PX + 20.0;

        let mut svg = Svg::new();
        let top = title_block(&mut svg, &self.title, &self.subtitle, width);
        let plane = Plane::fit(window, [left, top + 4.0], MOST_PX);
        let centre = plane.at([0.0, 0.0]);
        let faint = Style::line(FAINT, 0.9);
        svg.line([plane.area.x, centre[1]], [plane.area.right(), centre[1]], &faint);
        svg.line(
            [centre[0], plane.area.y],
            [centre[0], plane.area.bottom()],
            &faint,
        );
        let outline: Vec<Point> = (0..CORNERS)
            .map(|k| {
                let (s, c0) = (f64::from(k) * std::f64::consts::TAU / f64::from(CORNERS)).sin_cos();
                plane.at([a * c0 + b * s, c * c0 + d * s])
            })
            .collect();
        svg.path(
            &trace(&outline, Ends::Closed),
            &Style::fill("#dbe9f4").outlined(category(0), 2.0),
        );
        svg.circle(
            centre,
            mean.abs() * plane.px_per_mm,
            &Style::line(INK, 1.2).dashed("6 4"),
        );
        let directions = [
            (soft, turn_rad, SIGNAL),
            (stiff, turn_rad + std::f64::consts::FRAC_PI_2, category(2)),
        ];
        let mut taken = Vec::new();
        for (size, angle, colour) in directions {
            let unit = [angle.cos(), angle.sin()];
            draw_arrow(
                &mut svg,
                [centre, plane.at([size * unit[0], size * unit[1]])],
                colour,
            );
            draw_arrow(
                &mut svg,
                [centre, plane.at([-size * unit[0], -size * unit[1]])],
                colour,
            );
        }
        for (size, angle, colour) in directions {
            let label = format!("{} µm/N", three_digits(size));
            let place = label_place(&plane, [size, angle], &label, &taken);
            taken.push(text_box(place, &label, SMALL_PX, Anchor::Middle));
            svg.text(
                place,
                &label,
                &Text::new(SMALL_PX).bold().middle().colour(colour).halo(3.5),
            );
        }
        plane.draw_frame(&mut svg, Marks::ALL);
        plane.draw_labels(&mut svg, &self.axes);
        let entries = [
            Entry::new(
                Key::Field(Style::fill("#dbe9f4").outlined(category(0), 1.5)),
                "deviation under 1 N",
            ),
            Entry::new(Key::Line(vec![Style::line(SIGNAL, 2.0)]), "softest direction"),
            Entry::new(
                Key::Line(vec![Style::line(category(2), 2.0)]),
                "stiffest direction",
            ),
            Entry::new(
                Key::Line(vec![Style::line(INK, 1.2).dashed("6 4")]),
                format!("equally soft in all directions: {} µm/N", three_digits(mean)),
            ),
        ];
        let bottom = legend(
            &mut svg,
            &entries,
            [left, plane.area.bottom() + 50.0],
            width - left - BORDER_PX,
        );
        svg.finish(width, bottom + BORDER_PX, &self.title)
    }
}

/// A place beyond one of the two arrow heads, inside the frame and clear of other labels.
fn label_place(plane: &Plane, [size, angle]: [f64; 2], label: &str, taken: &[crate::svg::Rect]) -> Point {
    let centre = plane.at([0.0, 0.0]);
    let half = crate::font::text_width_px(label, SMALL_PX, crate::font::Weight::Bold) / 2.0;
    let inner = plane.area.shrunk(4.0);
    let mut fallback = centre;
    for turn in [0.0, std::f64::consts::PI] {
        let tip = plane.at([size * (angle + turn).cos(), size * (angle + turn).sin()]);
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
        if !taken.iter().any(|t| overlap(t, &place)) {
            return at;
        }
    }
    fallback
}

//! A small part of a path, true to scale: lines next to each other, such as the programmed, the commanded and the followed path at a corner.

use crate::colour::{INK, category};
use crate::legend::Entry;
use crate::line::without_straight;
use crate::page::{BORDER_PX, Heading, LEAST_WIDTH_PX};
use crate::plane::{AxisLabels, BELOW_PX, Plane, Window};
use crate::svg::{Point, Style, Svg};

/// Largest drawing: width, height.
const MOST_PX: [f64; 2] = [560.0, 460.0];

/// A line with its name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NamedLine {
    /// Its entry in the legend.
    pub name: String,
    /// Its points in mm: horizontal, vertical.
    pub points_mm: Vec<[f64; 2]>,
}

/// The input of a detail.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathDetail {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// Axis labels with units.
    pub axes: AxisLabels,
    /// What is shown: horizontal and vertical value of its centre, mm.
    pub centre_mm: [f64; 2],
    /// Half of its width and height, mm.
    pub half_size_mm: f64,
    /// The lines, the nominal one first: it is drawn dashed, the others solid over it.
    pub lines: Vec<NamedLine>,
}

impl PathDetail {
    /// The picture as a complete SVG document; without a point that is a number, or without a size, one that says so.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        let [x, y] = self.centre_mm;
        let half = self.half_size_mm;
        let has_points = self.lines.iter().any(|line| line.points_mm.iter().any(is_finite));
        let has_size = is_finite(&[x, y]) && half.is_finite() && half > 0.0;
        if !has_points || !has_size {
            return heading.notice("There is nothing to draw: the path has no points here.");
        }
        let window = Window {
            left_mm: x - half,
            right_mm: x + half,
            bottom_mm: y - half,
            top_mm: y + half,
        };
        let plane = Plane::with_axis_room(window, MOST_PX);
        let width = plane.area.right() + BORDER_PX + 12.0;
        let mut page = heading.page(width.max(LEAST_WIDTH_PX));
        let plane = plane.lowered_to(page.top_px + 4.0);
        page.svg.clipped(plane.area, |svg| self.draw_lines(svg, &plane));
        plane.draw_axes(&mut page.svg, &self.axes);
        let entries = self.lines.iter().enumerate();
        let entries: Vec<Entry> = entries
            .map(|(k, line)| Entry::line(style(k), &*line.name))
            .collect();
        page.finish_with_legend(&entries, [plane.area.x, plane.area.bottom() + BELOW_PX + 8.0])
    }

    fn draw_lines(&self, svg: &mut Svg, plane: &Plane) {
        for (k, line) in self.lines.iter().enumerate() {
            for piece in line.points_mm.split(|at| !is_finite(at)) {
                let piece: Vec<Point> = piece.iter().map(|at| plane.at(*at)).collect();
                svg.polyline(&without_straight(&piece), &style(k));
            }
        }
    }
}

fn is_finite(at: &[f64; 2]) -> bool {
    at.iter().all(|value| value.is_finite())
}

/// The nominal line is dashed.
fn style(line: usize) -> Style {
    match line.checked_sub(1) {
        None => Style::line(INK, 1.2).dashed("6 4"),
        Some(other) => Style::line(category(other), 2.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_is_drawn_and_named_and_a_gap_divides_it() {
        let line = |name: &str, points_mm: &[[f64; 2]]| NamedLine {
            name: name.to_owned(),
            points_mm: points_mm.to_vec(),
        };
        let detail = PathDetail {
            title: "corner".to_owned(),
            half_size_mm: 2.0,
            lines: vec![
                line("programmed", &[[-3.0, 0.0], [0.0, 0.0], [0.0, 3.0]]),
                line(
                    "followed",
                    &[
                        [-3.0, 0.1],
                        [-1.0, 0.1],
                        [f64::NAN, 0.0],
                        [-0.1, 1.0],
                        [-0.1, 3.0],
                    ],
                ),
            ],
            ..PathDetail::default()
        };
        let svg = detail.to_svg();
        assert!(svg.contains(">programmed<") && svg.contains(">followed<"));
        // Two pieces and the legend.
        assert_eq!(svg.matches(category(0)).count(), 3);
        for wrong in [f64::NAN, 0.0] {
            let empty = PathDetail {
                half_size_mm: wrong,
                ..detail.clone()
            };
            assert!(empty.to_svg().contains("nothing to draw"));
        }
    }
}

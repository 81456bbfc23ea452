//! How far does a joint twist under the torque of its motor?
//!
//! ```text
//!  torsion │ ··::.._        measured points, one fitted line for each direction of motion
//!  (µrad)  │     ··::.._
//!          └────────────    one panel for each joint
//!            torque (N m)
//! ```
//!
//! The slope of the lines is the compliance, their distance the step at a reversal.

use crate::chart::{Chart, range};
use crate::colour::{INK, category};
use crate::legend::{Entry, Key};
use crate::page::{BORDER_PX, Heading};
use crate::plane::AxisLabels;
use crate::svg::{Point, Style};

/// Size of a panel, and the distance between panels.
const SIZE_PX: [f64; 2] = [600.0, 190.0];
const BETWEEN_PX: f64 = 58.0;
/// Radius of a measured point.
const POINT_PX: f64 = 1.2;
/// Points of a joint that are drawn at most: more cannot be distinguished.
const MOST_DRAWN: usize = 2000;
const NOTHING: &str = "There is nothing to draw: no joint with a torsion.";

/// The torsion of one joint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TorsionPanel {
    /// Name of the joint.
    pub joint: String,
    /// Torque of the motor at each instant.
    pub torques_nm: Vec<f64>,
    /// Measured torsion at each.
    pub torsions_urad: Vec<f64>,
    /// Ends of the fitted lines, torque in N m and torsion in µrad.
    pub lines: Vec<[[f64; 2]; 2]>,
}

/// The input of the picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TorsionPlot {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// The joints, from top to bottom.
    pub panels: Vec<TorsionPanel>,
}

impl TorsionPlot {
    /// The picture as a complete SVG document; nothing to draw gives a picture that says so.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        let drawn: Vec<(&TorsionPanel, Chart)> = self
            .panels
            .iter()
            .filter_map(|panel| Some((panel, panel.chart()?)))
            .collect();
        let widest = drawn.iter().map(|(_, chart)| chart.area.x).fold(0.0, f64::max);
        if drawn.is_empty() {
            return heading.notice(NOTHING);
        }
        let mut page = heading.page(widest + SIZE_PX[0] + BORDER_PX + 8.0);
        let mut y = page.top_px + 4.0;
        for (panel, chart) in drawn {
            let chart = chart.lowered_to(y);
            let labels = AxisLabels {
                horizontal: "torque of the motor (N m)".to_owned(),
                vertical: format!("{}: torsion (µrad)", panel.joint),
            };
            chart.draw_axes(&mut page.svg, &labels);
            let every = panel.torques_nm.len().div_ceil(MOST_DRAWN).max(1);
            let style = Style::fill(category(0)).opacity(0.35);
            page.svg.clipped(chart.area, |svg| {
                for point in panel.points().step_by(every) {
                    svg.circle(chart.at(point), POINT_PX, &style);
                }
                for [from, to] in &panel.lines {
                    svg.line(chart.at(*from), chart.at(*to), &Style::line(INK, 1.4));
                }
            });
            y = chart.area.bottom() + BETWEEN_PX;
        }
        let entries = [
            Entry::new(Key::Dot(Style::fill(category(0))), "measured"),
            Entry::line(Style::line(INK, 1.4), "fitted, for each direction of motion"),
        ];
        page.finish_with_legend(&entries, [widest, y])
    }
}

impl TorsionPanel {
    fn points(&self) -> impl Iterator<Item = Point> {
        self.torques_nm
            .iter()
            .zip(&self.torsions_urad)
            .map(|(torque, torsion)| [*torque, *torsion])
            .filter(|point| point.iter().all(|part| part.is_finite()))
    }

    /// A chart of all points; `None` without any.
    fn chart(&self) -> Option<Chart> {
        let ends = || self.lines.iter().flatten().copied();
        let of = |axis: usize| range(self.points().chain(ends()).map(|point| point[axis]), 0.04);
        Some(Chart::with_axis_room(SIZE_PX, of(0)?, of(1)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_and_lines_of_each_joint_are_drawn() {
        let panel = |joint: &str| TorsionPanel {
            joint: joint.to_owned(),
            torques_nm: vec![-1.0, 0.0, f64::NAN, 2.0],
            torsions_urad: vec![3.0, 0.5, 1.0, -6.0],
            lines: vec![[[-1.0, 3.0], [2.0, -6.0]]],
        };
        let plot = TorsionPlot {
            panels: vec![panel("J1"), panel("J2")],
            ..TorsionPlot::default()
        };
        let svg = plot.to_svg();
        assert!(svg.contains("J1: torsion") && svg.contains("J2: torsion"));
        // Three finite points of each joint, and the dot of the legend.
        assert_eq!(svg.matches("<circle").count(), 7);
    }

    #[test]
    fn nothing_to_draw_gives_a_notice() {
        assert!(TorsionPlot::default().to_svg().contains("nothing to draw"));
    }
}

//! The holes as drilled: each at its position, coloured by its deviation, with an arrow for the error of its axis.
//!
//! Arrows are drawn at one magnification, 1, 2 or 5 times a power of ten, so that the longest takes about a sixth of
//! the extent of the holes; the scale is below the drawing with an arrow of known length. A hole without a value is a
//! cross; one whose every posture is rejected has its value and a cross.

use crate::arrow::draw_arrow;
use crate::axis::extent;
use crate::colour::{ColourScale, INK, NOMINAL, TOLERANCE};
use crate::colour_bar::ColourBar;
use crate::font::SMALL_PX;
use crate::legend::{Entry, Key, draw_cross};
use crate::levels::Levels;
use crate::page::{BORDER_PX, Heading, LEAST_WIDTH_PX};
use crate::plane::{AxisLabels, BELOW_PX, Plane, Window};
use crate::svg::{Point, Style, Svg, Text};
use crate::tolerance;
use crate::vector_field::{Arrow, LONGEST_ARROW, Magnified};

/// Largest drawing: width, height.
const MOST_PX: [f64; 2] = [560.0, 480.0];
/// Radius of a hole; one over the tolerance has a ring.
const HOLE_PX: f64 = 5.0;
const RING_PX: f64 = 7.5;
/// Holes of more than so many are drawn smaller.
const MANY: usize = 400;

/// One hole.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HoleMark {
    /// Where, along the axes of the picture.
    pub at_mm: [f64; 2],
    /// How its axis moves along them.
    pub error_um: [f64; 2],
    /// The evaluated component of the deviation; none where it is out of reach.
    pub deviation_um: Option<f64>,
    /// Whether the posture of its value must not be used, so that the hole cannot be drilled.
    pub is_rejected: bool,
    /// Its label; empty for most.
    pub name: String,
}

/// The input of a picture of holes; numbers that are not finite are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HoleMap {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// Axis labels with units.
    pub axes: AxisLabels,
    /// The quantity of the colours, with unit.
    pub quantity: String,
    /// Permissible deviation; one that is not finite counts as none.
    pub tolerance_um: Option<f64>,
    /// Colours.
    pub scale: ColourScale,
    /// The holes.
    pub holes: Vec<HoleMark>,
}

impl HoleMap {
    /// The picture as a complete SVG document; no hole, or none that is reached, gives a picture that says so.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        let Some((window, span_mm)) = self.window() else {
            return heading.notice("There is nothing to draw: there are no holes.");
        };
        let Some(levels) = Levels::covering(self.holes.iter().filter_map(|hole| hole.deviation_um)) else {
            return heading.notice("The robot reaches no hole.");
        };
        let bar = ColourBar {
            levels: &levels,
            scale: self.scale,
            quantity: &self.quantity,
            tolerance_um: self.tolerance_um,
        };
        let plane = Plane::with_axis_room(window, MOST_PX);
        let width = bar.right_of(plane.area).right() + BORDER_PX;
        let mut page = heading.page(width.max(LEAST_WIDTH_PX));
        let plane = plane.lowered_to(page.top_px + 4.0);
        let bar_area = bar.right_of(plane.area);
        let sizes = self.arrows().map(|a| a.deviation_um[0].hypot(a.deviation_um[1]));
        let magnified = Magnified::new(sizes.fold(0.0, f64::max), span_mm);
        page.svg.clipped(plane.area, |svg| {
            for arrow in self.arrows() {
                let ends = [plane.at(arrow.at_mm), plane.at(magnified.tip_mm(&arrow))];
                draw_arrow(svg, ends, INK);
            }
            for hole in self.finite() {
                self.draw_hole(svg, plane.at(hole.at_mm), hole, &levels);
            }
        });
        plane.draw_axes(&mut page.svg, &self.axes);
        bar.draw(&mut page.svg, bar_area);
        let left = plane.area.x;
        let scale_y = bar_area.bottom().max(plane.area.bottom() + BELOW_PX) + 14.0;
        magnified.draw_scale(&mut page.svg, [left, scale_y], plane.px_per_mm);
        page.finish_with_legend(&self.entries(), [left, scale_y + 10.0])
    }

    fn finite(&self) -> impl Iterator<Item = &HoleMark> {
        self.holes
            .iter()
            .filter(|hole| hole.at_mm.iter().all(|v| v.is_finite()))
    }

    /// The errors that can be drawn.
    fn arrows(&self) -> impl Iterator<Item = Arrow> + '_ {
        let reached = self.finite().filter(|hole| value(hole).is_some());
        reached
            .filter(|hole| hole.error_um.iter().all(|v| v.is_finite()))
            .map(|hole| Arrow {
                at_mm: hole.at_mm,
                deviation_um: hole.error_um,
            })
    }

    /// All holes with room for their arrows, and the longer side; `None` without a hole.
    fn window(&self) -> Option<(Window, f64)> {
        let along = |k: usize| extent(self.finite().map(move |hole| hole.at_mm[k]));
        let ((left, right), (bottom, top)) = (along(0)?, along(1)?);
        // Of one hole, or holes in one place, some millimetres round it.
        let span = (right - left).max(top - bottom).max(10.0);
        let margin = 1.25 * LONGEST_ARROW * span;
        let window = Window {
            left_mm: left - margin,
            right_mm: right + margin,
            bottom_mm: bottom - margin,
            top_mm: top + margin,
        };
        Some((window, span))
    }

    fn draw_hole(&self, svg: &mut Svg, at: Point, hole: &HoleMark, levels: &Levels) {
        let small = if self.holes.len() > MANY { 0.5 } else { 1.0 };
        let [x, y] = at;
        match value(hole) {
            Some(um) => {
                if self.is_over(um) {
                    svg.circle(at, RING_PX * small, &Style::line(TOLERANCE, 1.8 * small));
                }
                let band = levels.inner_um().iter().take_while(|edge| um > **edge).count();
                let fill = Style::fill(levels.colour(band, self.scale)).outlined(INK, 0.8 * small);
                svg.circle(at, HOLE_PX * small, &fill);
                if hole.is_rejected {
                    draw_cross(svg, at, RING_PX * small, &rejected_style());
                }
            }
            None => {
                draw_cross(svg, at, HOLE_PX * small, &unreachable_style());
            }
        }
        if !hole.name.is_empty() {
            let text = Text::new(SMALL_PX).bold().halo(3.0);
            // On the side that the arrow does not take.
            let up = hole.error_um[1] <= 0.0 || value(hole).is_none();
            let by = if up { -RING_PX - 4.0 } else { RING_PX + 12.0 };
            svg.text([x, y + by], &hole.name, &text.middle());
        }
    }

    fn is_over(&self, um: f64) -> bool {
        self.tolerance_um
            .is_some_and(|tolerance| tolerance.is_finite() && um > tolerance)
    }

    fn entries(&self) -> Vec<Entry> {
        let mut entries = Vec::new();
        let over = self.holes.iter().filter_map(value).any(|um| self.is_over(um));
        match self.tolerance_um.filter(|tolerance| tolerance.is_finite()) {
            Some(tolerance) if over => {
                let ring = Key::Dot(Style::line(TOLERANCE, 1.8));
                entries.push(Entry::new(
                    ring,
                    format!("over the {}", tolerance::label(tolerance)),
                ));
            }
            tolerance => entries.extend(tolerance::entry_over(
                tolerance,
                self.holes.iter().map(usable_value),
            )),
        }
        if self.holes.iter().any(|hole| value(hole).is_none()) {
            entries.push(Entry::new(Key::Cross(unreachable_style()), "out of reach"));
        }
        if self
            .holes
            .iter()
            .any(|hole| value(hole).is_some() && hole.is_rejected)
        {
            entries.push(Entry::new(Key::Cross(rejected_style()), "cannot be drilled"));
        }
        entries
    }
}

fn value(hole: &HoleMark) -> Option<f64> {
    hole.deviation_um.filter(|um| um.is_finite())
}

/// The value of a hole that can be drilled; of any other not a number.
fn usable_value(hole: &HoleMark) -> f64 {
    value(hole).filter(|_| !hole.is_rejected).unwrap_or(f64::NAN)
}

fn rejected_style() -> Style {
    Style::line(INK, 2.0)
}

fn unreachable_style() -> Style {
    Style::line(NOMINAL, 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hole(x: f64, um: Option<f64>) -> HoleMark {
        HoleMark {
            at_mm: [x, 10.0],
            error_um: [um.unwrap_or(f64::NAN), 3.0],
            deviation_um: um,
            is_rejected: false,
            name: String::new(),
        }
    }

    #[test]
    fn the_legend_has_entries_for_excess_and_out_of_reach_only_where_needed() {
        let of = |holes: Vec<HoleMark>| {
            HoleMap {
                tolerance_um: Some(50.0),
                holes,
                ..HoleMap::default()
            }
            .to_svg()
        };
        let mixed = of(vec![
            hole(0.0, Some(20.0)),
            hole(50.0, Some(80.0)),
            hole(90.0, None),
        ]);
        assert!(mixed.contains("over the tolerance 50 µm") && mixed.contains(">out of reach<"));
        assert!(mixed.contains("deviations drawn ×") && !mixed.contains("NaN"));
        let fine = of(vec![hole(0.0, Some(20.0)), hole(50.0, Some(30.0))]);
        assert!(!fine.contains("over the tolerance") && !fine.contains("out of reach"));
        assert!(fine.contains("(met everywhere)") && !fine.contains("cannot be drilled"));
        let rejected = HoleMark {
            is_rejected: true,
            ..hole(50.0, Some(30.0))
        };
        let lost = of(vec![hole(0.0, Some(20.0)), rejected]);
        assert!(lost.contains("(met at every usable point)") && lost.contains("cannot be drilled"));
    }

    #[test]
    fn a_single_hole_is_drawn_and_none_is_reported() {
        let one = HoleMap {
            holes: vec![hole(0.0, Some(20.0))],
            ..HoleMap::default()
        };
        assert!(one.to_svg().contains("<circle"));
        assert!(HoleMap::default().to_svg().contains("no holes"));
        let lost = HoleMap {
            holes: vec![hole(0.0, None)],
            ..HoleMap::default()
        };
        assert!(lost.to_svg().contains("reaches no hole"));
    }
}

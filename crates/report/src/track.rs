//! A tool path seen from above, coloured by the deviation along it; where there is no posture it is drawn in grey.
//!
//! A piece between two points has the colour of its larger deviation: a peak that one point has is seen on both
//! sides of it, and nothing is interpolated. Bands and colour bar are those of a map.

use crate::axis::extent;
use crate::colour::{ColourScale, MUTED};
use crate::colour_bar::ColourBar;
use crate::legend::Entry;
use crate::levels::Levels;
use crate::line::without_straight;
use crate::marker::{Marker, draw_marker, marker_entries};
use crate::page::{BORDER_PX, Heading, LEAST_WIDTH_PX};
use crate::plane::{AxisLabels, BELOW_PX, Plane, Window};
use crate::svg::{Point, Style, Svg};
use crate::tolerance;

/// Largest drawing: width, height.
const MOST_PX: [f64; 2] = [620.0, 520.0];
/// White around the path, part of its size.
const MARGIN: f64 = 0.06;

/// A stretch of path without rapids; where two stretches meet nothing is drawn between them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stretch {
    /// Points in mm: horizontal, vertical.
    pub points_mm: Vec<[f64; 2]>,
    /// The deviation at each point in um; not finite where there is no posture. Not checked: that there are as
    /// many as points.
    pub deviation_um: Vec<f64>,
}

/// The input of a picture of a tool path.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TrackMap {
    /// First line, bold.
    pub title: String,
    /// Second line: posture, load.
    pub subtitle: String,
    /// Axis labels with units.
    pub axes: AxisLabels,
    /// The quantity, with its unit: `deviation across the tool (µm)`.
    pub quantity: String,
    /// Permissible deviation in um: a line across the colour bar and an entry of the legend; the path itself
    /// has no line for it.
    pub tolerance_um: Option<f64>,
    /// Colours of the bands.
    pub scale: ColourScale,
    /// The path, in the order of the cut.
    pub stretches: Vec<Stretch>,
    /// Points drawn on top.
    pub markers: Vec<Marker>,
}

impl TrackMap {
    /// The picture as a complete SVG document; a path without points, or without one that is reached, gives one
    /// that says so.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        let Some(window) = self.window() else {
            return heading.notice("There is nothing to draw: the path has no points.");
        };
        let Some(levels) = Levels::covering(self.values_um()) else {
            return heading.notice("The robot reaches no point of the path.");
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
        page.svg.clipped(plane.area, |svg| {
            self.draw_path(svg, &plane, &levels);
            for marker in &self.markers {
                draw_marker(svg, &plane, marker);
            }
        });
        plane.draw_axes(&mut page.svg, &self.axes);
        bar.draw(&mut page.svg, bar_area);
        let below = bar_area.bottom().max(plane.area.bottom() + BELOW_PX) + 8.0;
        page.finish_with_legend(&self.entries(), [plane.area.x, below])
    }

    fn values_um(&self) -> impl Iterator<Item = f64> + '_ {
        self.stretches.iter().flat_map(|s| &s.deviation_um).copied()
    }

    /// All points with some white around them; `None` without a point.
    fn window(&self) -> Option<Window> {
        let along = |k: usize| {
            let points = self.stretches.iter().flat_map(|s| &s.points_mm);
            extent(points.map(move |p| p[k]))
        };
        let ((left, right), (bottom, top)) = (along(0)?, along(1)?);
        let margin = MARGIN * (right - left).max(top - bottom).max(1e-3);
        Some(Window {
            left_mm: left - margin,
            right_mm: right + margin,
            bottom_mm: bottom - margin,
            top_mm: top + margin,
        })
    }

    /// Pieces of one colour after the other, the largest deviations last: nothing hides them.
    fn draw_path(&self, svg: &mut Svg, plane: &Plane, levels: &Levels) {
        let mut draw = |band: Option<usize>, style: &Style| {
            for line in self.pieces(band, levels) {
                let line: Vec<Point> = line.iter().map(|p| plane.at(*p)).collect();
                svg.polyline(&without_straight(&line), style);
            }
        };
        draw(None, &lost_style());
        for band in 0..levels.bands() {
            draw(Some(band), &Style::line(levels.colour(band, self.scale), 2.0));
        }
    }

    /// The pieces of the path whose larger end is in this band; for no band those that have an end without a
    /// value. Neighbouring pieces are joined.
    fn pieces(&self, band: Option<usize>, levels: &Levels) -> Vec<Vec<[f64; 2]>> {
        let band_of = |a: f64, b: f64| {
            let value = (a.is_finite() && b.is_finite()).then(|| a.max(b))?;
            let above = levels.inner_um().iter().take_while(|edge| value > **edge).count();
            Some(above)
        };
        let mut pieces: Vec<Vec<[f64; 2]>> = Vec::new();
        for stretch in &self.stretches {
            let mut open = false;
            let ends = stretch.points_mm.windows(2).zip(stretch.deviation_um.windows(2));
            for (points, values) in ends {
                let here = band_of(values[0], values[1]) == band;
                match (here, open, pieces.last_mut()) {
                    (true, true, Some(piece)) => piece.push(points[1]),
                    (true, ..) => pieces.push(points.to_vec()),
                    (false, ..) => {}
                }
                open = here;
            }
        }
        pieces
    }

    fn entries(&self) -> Vec<Entry> {
        let mut entries: Vec<Entry> = tolerance::entry_over(self.tolerance_um, self.values_um())
            .into_iter()
            .collect();
        if self.values_um().any(|value| !value.is_finite()) {
            entries.push(Entry::line(lost_style(), "no posture"));
        }
        entries.extend(marker_entries(&self.markers));
        entries
    }
}

/// Where there is no posture.
fn lost_style() -> Style {
    Style::line(MUTED, 1.2).dashed("2 3")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::marker::MarkerKind;

    fn track(values: [f64; 5]) -> TrackMap {
        TrackMap {
            title: "part".to_owned(),
            tolerance_um: Some(30.0),
            stretches: vec![Stretch {
                points_mm: (0..5).map(|i| [f64::from(i) * 10.0, f64::from(i % 2)]).collect(),
                deviation_um: values.to_vec(),
            }],
            ..TrackMap::default()
        }
    }

    #[test]
    fn every_piece_is_drawn_once_in_one_band_or_as_lost() {
        let track = track([10.0, 20.0, 50.0, f64::NAN, 40.0]);
        let levels = Levels::covering(track.stretches[0].deviation_um.iter().copied()).unwrap();
        let drawn: usize = (0..levels.bands())
            .map(|band| track.pieces(Some(band), &levels))
            .chain([track.pieces(None, &levels)])
            .flatten()
            .map(|piece| piece.len() - 1)
            .sum();
        assert_eq!(drawn, 4);
        assert_eq!(
            track.pieces(None, &levels),
            [vec![[20.0, 0.0], [30.0, 1.0], [40.0, 0.0]]]
        );
    }

    #[test]
    fn markers_have_their_own_signs_and_one_that_is_not_finite_is_left_out() {
        let marker = |at_mm, kind, name: &str| Marker {
            at_mm,
            label: format!("{kind:?}"),
            kind,
            name: name.to_owned(),
        };
        let picture = TrackMap {
            markers: vec![
                marker([10.0, 1.0], MarkerKind::Point, "first"),
                marker([20.0, 0.0], MarkerKind::Best, "second"),
                marker([f64::NAN, 0.0], MarkerKind::Point, "third"),
            ],
            ..track([10.0; 5])
        };
        let svg = picture.to_svg();
        assert!(svg.contains(">first<") && svg.contains(">second<") && !svg.contains(">third<"));
        assert!(svg.contains(">Point<") && svg.contains(">Best<"));
        // Two rings and two diamonds: each on the path and in the legend.
        assert_eq!(svg.matches("<circle").count(), 2);
        assert_eq!(svg.matches("#E69F00").count(), 2);
    }

    #[test]
    fn a_path_without_values_or_points_gives_a_notice() {
        assert!(TrackMap::default().to_svg().contains("no points"));
        assert!(track([f64::NAN; 5]).to_svg().contains("reaches no point"));
        assert!(track([40.0; 5]).to_svg().contains("exceeded everywhere"));
    }
}

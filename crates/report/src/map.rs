//! The map of a deviation over a plane: filled bands, labelled iso-lines, the tolerance, and hatched zones that cannot
//! be used.
//!
//! Between the points the field is interpolated, see `crate::surface`; at the points it is exact. Both axes
//! have the same scale, so shapes on the map are true to the plane.

use crate::colour::{ColourScale, INK};
use crate::colour_bar::ColourBar;
use crate::field::{FieldStyle, IsoLines, Paint, draw_field, window_of, zone_entries};
use crate::grid::Grid;
use crate::legend::{Entry, Key};
use crate::levels::Levels;
use crate::line::points_along;
use crate::marker::{Marker, draw_marker, marker_entries};
use crate::page::{BORDER_PX, Heading, LEAST_WIDTH_PX};
use crate::plane::{AxisLabels, BELOW_PX, Plane};
use crate::svg::{Point, Style, Svg};
use crate::tolerance;

/// Largest drawing: width, height.
const MOST_PX: [f64; 2] = [600.0, 470.0];

/// A line drawn on a map, such as the path of the cut, dashed on a white ground.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overlay {
    /// What the line is, for the legend; without one it has no entry.
    pub label: String,
    /// Points in mm: horizontal, vertical, in the axes of the grid. Parts outside the grid are cut off.
    pub points_mm: Vec<[f64; 2]>,
}

/// What a deviation map shows. The default is an empty map, which draws as a notice; set the fields that
/// matter.
///
/// ```
/// use armill_report::{DeviationMap, Grid, PointState};
///
/// let map = DeviationMap {
///     title: "Vertical plate".to_owned(),
///     grid: Grid {
///         horizontal_mm: vec![400.0, -400.0], // base y as seen from the tool side
///         vertical_mm: vec![0.0, 400.0, 800.0],
///         points: [31.0, 44.0, 35.0, 52.0, 40.0, 61.0].map(PointState::Reached).to_vec(),
///     },
///     quantity: "in-plane deviation (µm)".to_owned(),
///     tolerance_um: Some(50.0),
///     ..DeviationMap::default()
/// };
/// assert!(map.to_svg().starts_with("<svg "));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeviationMap {
    /// First line, bold.
    pub title: String,
    /// Second line: load, posture, distance.
    pub subtitle: String,
    /// The points and their values in um.
    pub grid: Grid,
    /// Axis labels with units.
    pub axes: AxisLabels,
    /// The quantity, with its unit: `in-plane deviation (µm)`.
    pub quantity: String,
    /// Permissible deviation in um, drawn as an emphasised line. A tolerance below or above all values is reported in
    /// the legend; one that is not finite counts as none.
    pub tolerance_um: Option<f64>,
    /// Colours of the bands.
    pub scale: ColourScale,
    /// Lines drawn on top; labels of iso-lines keep clear of them.
    pub overlays: Vec<Overlay>,
    /// Points drawn on top of everything.
    pub markers: Vec<Marker>,
    /// Whether the grid points are shown as small dots.
    pub show_grid_points: bool,
}

impl DeviationMap {
    /// The map as a complete SVG document; a grid that cannot be drawn gives a picture that says why.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        if let Some(reason) = self.grid.obstacle() {
            return heading.notice(&reason);
        }
        let Some(levels) = Levels::covering(self.grid.values_um()) else {
            return heading.notice("No point has a value.");
        };
        let bar = ColourBar {
            levels: &levels,
            scale: self.scale,
            quantity: &self.quantity,
            tolerance_um: self.tolerance_um,
        };
        let plane = Plane::with_axis_room(window_of(&self.grid), MOST_PX);
        let width = bar.right_of(plane.area).right() + BORDER_PX;
        let mut page = heading.page(width.max(LEAST_WIDTH_PX));
        let plane = plane.lowered_to(page.top_px + 4.0);
        let bar_area = bar.right_of(plane.area);
        let paint = Paint::Bands(self.scale);
        let look = FieldStyle {
            levels: &levels,
            paint,
            iso_lines: IsoLines::Labelled,
            tolerance_um: self.tolerance_um,
            uncertainty: None,
            obstacles: &self.obstacles(&plane),
        };
        draw_field(&mut page.svg, &plane, &self.grid, &look);
        let tolerance = tolerance::entry_over(
            self.tolerance_um,
            self.grid
                .points
                .iter()
                .map(|point| point.value_um().unwrap_or(f64::NAN)),
        );
        let mut entries: Vec<Entry> = tolerance.into_iter().collect();
        entries.extend(zone_entries(&mut page.svg, std::iter::once(&self.grid), paint));
        entries.extend(self.entries_on_top());
        self.draw_on_top(&mut page.svg, &plane);
        plane.draw_axes(&mut page.svg, &self.axes);
        bar.draw(&mut page.svg, bar_area);
        let below = bar_area.bottom().max(plane.area.bottom() + BELOW_PX) + 8.0;
        page.finish_with_legend(&entries, [plane.area.x, below])
    }

    /// What labels keep clear of: points along the overlays, and a cross over each marker.
    fn obstacles(&self, plane: &Plane) -> Vec<Point> {
        const HALF_PX: f64 = 8.0;
        let drawn = self
            .overlays
            .iter()
            .flat_map(|o| points_along(&on_picture(plane, o)));
        let marked = self.markers.iter().flat_map(|m| {
            let [x, y] = plane.at(m.at_mm);
            points_along(&[
                [x - HALF_PX, y],
                [x + HALF_PX, y],
                [x, y - HALF_PX],
                [x, y + HALF_PX],
            ])
        });
        drawn.chain(marked).collect()
    }

    /// Grid points, overlays and markers, cut to the drawing.
    fn draw_on_top(&self, svg: &mut Svg, plane: &Plane) {
        svg.clipped(plane.area, |svg| {
            if self.show_grid_points {
                for y in &self.grid.vertical_mm {
                    for x in &self.grid.horizontal_mm {
                        svg.circle(plane.at([*x, *y]), 2.0, &computed_style());
                    }
                }
            }
            for overlay in &self.overlays {
                let line = on_picture(plane, overlay);
                for style in overlay_styles() {
                    svg.polyline(&line, &style);
                }
            }
            for marker in &self.markers {
                draw_marker(svg, plane, marker);
            }
        });
    }

    /// The legend's entries of what is drawn on top, in the order of drawing.
    fn entries_on_top(&self) -> Vec<Entry> {
        let mut entries = Vec::new();
        if self.show_grid_points {
            entries.push(Entry::new(Key::Dot(computed_style()), "computed point"));
        }
        for overlay in self.overlays.iter().filter(|o| !o.label.is_empty()) {
            entries.push(Entry::new(
                Key::Line(overlay_styles().into()),
                overlay.label.clone(),
            ));
        }
        entries.extend(marker_entries(&self.markers));
        entries
    }
}

/// The points of an overlay on the picture.
fn on_picture(plane: &Plane, overlay: &Overlay) -> Vec<Point> {
    overlay.points_mm.iter().map(|p| plane.at(*p)).collect()
}

fn computed_style() -> Style {
    Style::fill(INK).outlined("#fff", 0.7)
}

fn overlay_styles() -> [Style; 2] {
    [
        Style::line("#fff", 4.0).opacity(0.8),
        Style::line(INK, 1.6).dashed("6 4"),
    ]
}

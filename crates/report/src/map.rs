//! The map of a deviation over a plane: filled bands, labelled iso-lines, the limit, and hatched zones that cannot be used.

use crate::colour::{ColourScale, INK};
use crate::colour_bar::ColourBar;
use crate::field::{IsoLines, Look, Paint, draw_field, window_of, zone_entries};
use crate::grid::Grid;
use crate::levels::Levels;
use crate::limit;
use crate::line_label::points_along;
use crate::marker::{Marker, draw_marker, marker_entries};
use crate::page::{BORDER_PX, Entry, Key, legend, notice, title_block};
use crate::plane::{AxisLabels, BELOW_PX, Marks, Plane};
use crate::svg::{Rect, Style, Svg};

/// Largest drawing: width, height.
const MOST_PX: [f64; 2] = [600.0, 470.0];
/// A map is at least this wide, for its title and legend.
const LEAST_WIDTH_PX: f64 = 430.0;

/// A line drawn on a map, such as the path of the cut.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overlay {
    /// What the line is, for the legend.
    pub label: String,
    /// Points in mm: horizontal, vertical.
    pub points_mm: Vec<[f64; 2]>,
}

/// What a deviation map shows.
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
    /// What is drawn, with its unit: `in-plane deviation (µm)`.
    pub quantity: String,
    /// Permissible deviation in um, drawn as an emphasised line.
    pub limit_um: Option<f64>,
    /// Colours of the bands.
    pub scale: ColourScale,
    /// Lines drawn on top.
    pub overlays: Vec<Overlay>,
    /// Points drawn on top.
    pub markers: Vec<Marker>,
    /// Whether the grid points are shown as small dots.
    pub show_grid_points: bool,
}

impl DeviationMap {
    /// The map as a complete SVG document; a grid that cannot be drawn gives a picture that says why.
    pub fn to_svg(&self) -> String {
        if let Some(reason) = self.grid.obstacle() {
            return notice(&self.title, &self.subtitle, &reason);
        }
        let Some(levels) = Levels::covering(self.grid.values_um()) else {
            return notice(&self.title, &self.subtitle, "No point has a value.");
        };
        let bar = ColourBar {
            levels: &levels,
            scale: self.scale,
            quantity: &self.quantity,
            limit_um: self.limit_um,
        };
        let window = window_of(&self.grid);
        let left = BORDER_PX + Plane::left_room_px(&window);
        let plane = Plane::fit(window, [left, 0.0], MOST_PX);
        let bar_height = plane.area.h.max(150.0);
        let width = (plane.area.right() + 22.0 + bar.width_px(bar_height) + BORDER_PX).max(LEAST_WIDTH_PX);

        let mut svg = Svg::new();
        let top = title_block(&mut svg, &self.title, &self.subtitle, width);
        let plane = Plane::fit(window, [left, top + 4.0], MOST_PX);
        let paint = Paint::Bands(self.scale);
        let marked = self.markers.iter().flat_map(|m| {
            let [x, y] = plane.at(m.at_mm);
            points_along(&[[x - 8.0, y], [x + 8.0, y], [x, y - 8.0], [x, y + 8.0]])
        });
        let drawn = self.overlays.iter().flat_map(|o| {
            let line: Vec<_> = o.points_mm.iter().map(|p| plane.at(*p)).collect();
            points_along(&line)
        });
        let obstacles: Vec<_> = drawn.chain(marked).collect();
        let look = Look {
            levels: &levels,
            paint,
            iso_lines: IsoLines::Labelled,
            limit_um: self.limit_um,
            doubt: None,
            obstacles: &obstacles,
        };
        draw_field(&mut svg, &plane, &self.grid, &look);
        let mut entries = zone_entries(&mut svg, std::iter::once(&self.grid), paint);
        let limit = limit::entry_over(self.limit_um, self.grid.values_um());
        entries.splice(0..0, limit);
        draw_on_top(&mut svg, &plane, self, &mut entries);
        plane.draw_frame(&mut svg, Marks::ALL);
        plane.draw_labels(&mut svg, &self.axes);
        bar.draw(
            &mut svg,
            Rect {
                x: plane.area.right() + 22.0,
                y: plane.area.y,
                w: 0.0,
                h: bar_height,
            },
        );
        let below = plane.area.y + bar_height.max(plane.area.h + BELOW_PX) + 8.0;
        let bottom = legend(&mut svg, &entries, [left, below], width - left - BORDER_PX);
        svg.finish(width, bottom + BORDER_PX, &self.title)
    }
}

fn draw_on_top(svg: &mut Svg, plane: &Plane, map: &DeviationMap, entries: &mut Vec<Entry>) {
    svg.clipped(plane.area, |svg| {
        if map.show_grid_points {
            for y in &map.grid.vertical_mm {
                for x in &map.grid.horizontal_mm {
                    svg.circle(plane.at([*x, *y]), 2.0, &computed_style());
                }
            }
        }
        for overlay in &map.overlays {
            let line: Vec<_> = overlay.points_mm.iter().map(|p| plane.at(*p)).collect();
            for style in overlay_styles() {
                svg.polyline(&line, &style);
            }
        }
        for marker in &map.markers {
            draw_marker(svg, plane, marker);
        }
    });
    if map.show_grid_points {
        entries.push(Entry::new(Key::Dot(computed_style()), "computed point"));
    }
    for overlay in map.overlays.iter().filter(|o| !o.label.is_empty()) {
        entries.push(Entry::new(
            Key::Line(overlay_styles().into()),
            overlay.label.clone(),
        ));
    }
    entries.extend(marker_entries(&map.markers));
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

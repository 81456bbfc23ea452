//! Small multiples: maps of a series (distance, tilt, slices of a volume) at one scale, in one set of colours, with one
//! colour bar.
//!
//! ```text
//! title                 note    title                 note
//! ┌──────── map ───────┐        ┌──────── map ───────┐    ┌┐
//! └────────────────────┘        └────────────────────┘    ││  colour bar of all maps
//! ┌────── region ──────┐        ┌────── region ──────┐    └┘
//! └────────────────────┘        └────────────────────┘
//! ```
//!
//! All panels show the same part of the plane at the same scale, even where their grids differ; numbers are
//! at the lowest panel of each column and at the first column alone.

use crate::colour::{ColourScale, EMPTY, MUTED, OVER, WITHIN};
use crate::colour_bar::ColourBar;
use crate::field::{FieldStyle, IsoLines, Paint, draw_field, window_of, zone_entries};
use crate::font::{BODY_PX, SMALL_PX, Weight, text_width_px, wrap};
use crate::grid::Grid;
use crate::legend::{Entry, Key};
use crate::levels::Levels;
use crate::page::{BORDER_PX, Heading};
use crate::plane::{AxisLabels, Marks, Plane, Window};
use crate::svg::{Rect, Style, Svg, Text};
use crate::ticks::Overhang;
use crate::tolerance;

/// Panels in a row at most: more would be too small to read.
const MOST_COLUMNS: usize = 8;
const GAP_PX: f64 = 14.0;
/// Gap between a map and the region under it.
const PAIR_PX: f64 = 16.0;
const TITLE_ROW_PX: f64 = 18.0;
/// Font sizes of the numbers and of the notes of panels.
const PANEL_PX: f64 = 9.5;
const NOTE_PX: f64 = 10.0;
/// Width of all panels of a row with their gaps, and the longest side of a panel.
const ROW_PX: f64 = 900.0;
const MOST_PANEL_PX: f64 = 300.0;
/// From the lowest panel to the label of the horizontal axis.
const LABELS_PX: f64 = 38.0;
/// From the last panel of a row to the colour bar, and the greatest height of the bar.
const BAR_GAP_PX: f64 = 18.0;
const MOST_BAR_PX: f64 = 420.0;
const LEAST_SHEET_PX: f64 = 480.0;

/// One map of a sheet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Panel {
    /// What distinguishes this panel: `x = 600 mm`.
    pub title: String,
    /// A key figure: `62 % within`; empty for none. Left out where it would run into the
    /// title.
    pub note: String,
    /// The points and their values in um.
    pub grid: Grid,
}

/// The input of a sheet of maps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MapSeries {
    /// First line, bold.
    pub title: String,
    /// Second line: load, posture.
    pub subtitle: String,
    /// The maps in reading order.
    pub panels: Vec<Panel>,
    /// Panels in a row, 1 to 8; any other number is clamped to this range. Fewer panels take fewer
    /// columns.
    pub columns: usize,
    /// Axis labels with units, shared by all panels.
    pub axes: AxisLabels,
    /// The quantity, with its unit: `in-plane deviation (µm)`.
    pub quantity: String,
    /// Permissible deviation in um.
    pub tolerance_um: Option<f64>,
    /// Colours of the bands.
    pub scale: ColourScale,
    /// Whether the permissible region is shown under each map; needs a tolerance that is finite.
    pub show_regions: bool,
}

impl MapSeries {
    /// The sheet as a complete SVG document; a panel that cannot be drawn says why in its place. A notice where
    /// there are no panels or none can be drawn.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        if self.panels.is_empty() {
            return heading.notice("There is nothing to draw: the series has no maps.");
        }
        let grids = || self.panels.iter().map(|p| &p.grid);
        let drawable: Vec<&Grid> = grids().filter(|g| g.obstacle().is_none()).collect();
        let levels = Levels::covering(drawable.iter().flat_map(|g| g.values_um()));
        let (Some(levels), Some(window)) = (levels, common_window(&drawable)) else {
            let reason = grids().find_map(Grid::obstacle).unwrap_or_default();
            return heading.notice(&format!("No map of this series can be drawn. {reason}"));
        };
        let layout = Layout::new(self, window);
        let bar = ColourBar {
            levels: &levels,
            scale: self.scale,
            quantity: &self.quantity,
            tolerance_um: self.tolerance_um,
        };
        let bar_height = layout.height_px.min(MOST_BAR_PX);
        let bar_x = layout.left_px + layout.width_px + BAR_GAP_PX;
        let width = bar_x + bar.width_px(bar_height) + BORDER_PX;
        let mut page = heading.page(width.max(LEAST_SHEET_PX));
        let top = page.top_px;
        for (index, panel) in self.panels.iter().enumerate() {
            self.draw_panel(&mut page.svg, panel, &layout.cell(index, top), &levels);
        }
        self.write_labels(&mut page.svg, &layout, top);
        let bar_area = Rect {
            x: bar_x,
            y: top + TITLE_ROW_PX + (layout.height_px - TITLE_ROW_PX - bar_height).max(0.0) / 2.0,
            w: 0.0,
            h: bar_height - TITLE_ROW_PX,
        };
        bar.draw(&mut page.svg, bar_area);
        let entries = self.entries(&mut page.svg, &drawable);
        let below = top + layout.height_px + LABELS_PX + 12.0;
        page.finish_with_legend(&entries, [layout.left_px, below])
    }

    /// The labels of the axes, once for all panels.
    fn write_labels(&self, svg: &mut Svg, layout: &Layout, top: f64) {
        let text = Text::new(BODY_PX).middle();
        let middle = [
            layout.left_px + layout.width_px / 2.0,
            top + layout.height_px / 2.0,
        ];
        let below = [middle[0], top + layout.height_px + LABELS_PX];
        svg.text(below, &self.axes.horizontal, &text);
        let left = [BORDER_PX + 12.0, middle[1]];
        svg.text(left, &self.axes.vertical, &text.turned(-90.0));
    }

    /// Whether each panel has a region under its map.
    fn has_regions(&self) -> bool {
        self.show_regions && self.tolerance_um.is_some_and(f64::is_finite)
    }

    /// Title, note, map and region of one panel.
    fn draw_panel(&self, svg: &mut Svg, panel: &Panel, cell: &Cell, levels: &Levels) {
        let area = cell.planes[0].area;
        let room = area.w - text_width_px(&panel.note, NOTE_PX, Weight::Regular) - 6.0;
        let title_fits = text_width_px(&panel.title, SMALL_PX, Weight::Bold) <= room;
        svg.text([area.x, area.y - 6.0], &panel.title, &Text::new(SMALL_PX).bold());
        if title_fits {
            svg.text(
                [area.right(), area.y - 6.0],
                &panel.note,
                &Text::new(NOTE_PX).end().colour(MUTED),
            );
        }
        let paints = [Paint::Bands(self.scale), Paint::Region];
        for ((plane, paint), marks) in cell.planes.iter().zip(paints).zip(&cell.marks) {
            if let Some(reason) = panel.grid.obstacle() {
                write_reason(svg, plane.area, &reason);
            } else {
                let look = FieldStyle {
                    levels,
                    paint,
                    iso_lines: IsoLines::Thin,
                    tolerance_um: self.tolerance_um,
                    uncertainty: None,
                    obstacles: &[],
                };
                draw_field(svg, plane, &panel.grid, &look);
            }
            plane.draw_frame(svg, *marks);
        }
    }

    /// The tolerance, the colours of regions, and the zones that some panel has.
    fn entries(&self, svg: &mut Svg, drawable: &[&Grid]) -> Vec<Entry> {
        let mut entries = Vec::new();
        if let Some(tolerance) = self.tolerance_um.filter(|l| l.is_finite()) {
            entries.push(tolerance::entry(tolerance, ""));
            if self.has_regions() {
                let tolerance = crate::axis::plain(tolerance);
                entries.push(Entry::new(Key::field(WITHIN), format!("within {tolerance} µm")));
                entries.push(Entry::new(Key::field(OVER), format!("over {tolerance} µm")));
            }
        }
        entries.extend(zone_entries(
            svg,
            drawable.iter().copied(),
            Paint::Bands(self.scale),
        ));
        entries
    }
}

/// Why a panel stays empty, in its middle.
fn write_reason(svg: &mut Svg, area: Rect, reason: &str) {
    const LINE_PX: f64 = 14.0;
    svg.rect(area, &Style::fill(EMPTY));
    let lines = wrap(reason, NOTE_PX, Weight::Regular, area.w - 16.0);
    let c = area.centre();
    for (k, line) in lines.iter().enumerate() {
        let y = c[1] + LINE_PX * (k as f64 - (lines.len() as f64 - 1.0) / 2.0) + 4.0;
        svg.text([c[0], y], line, &Text::new(NOTE_PX).middle().colour(MUTED));
    }
}

/// The window that shows all grids, drawn in the direction of the first; `None` without grids.
fn common_window(grids: &[&Grid]) -> Option<Window> {
    let first = window_of(grids.first()?);
    let reach = |pick: fn(&Window) -> [f64; 2]| {
        let (low, high) = crate::axis::extent(grids.iter().flat_map(|g| pick(&window_of(g))))?;
        let [from, to] = pick(&first);
        Some(if to >= from { [low, high] } else { [high, low] })
    };
    let [left_mm, right_mm] = reach(|w| [w.left_mm, w.right_mm])?;
    let [bottom_mm, top_mm] = reach(|w| [w.bottom_mm, w.top_mm])?;
    Some(Window {
        left_mm,
        right_mm,
        bottom_mm,
        top_mm,
    })
}

/// The positions of the panels of a sheet, px.
struct Layout {
    window: Window,
    columns: usize,
    panels: usize,
    /// 1, or 2 with regions.
    planes_per_panel: usize,
    /// Width and height of one drawing.
    panel_px: [f64; 2],
    /// Left edge of the first column.
    left_px: f64,
    /// Of all columns and of all rows, with the gaps between.
    width_px: f64,
    height_px: f64,
}

/// The drawings of one panel, map first.
struct Cell {
    planes: Vec<Plane>,
    marks: Vec<Marks>,
}

impl Layout {
    /// Panels as large as a row has room for.
    fn new(sheet: &MapSeries, window: Window) -> Self {
        let panels = sheet.panels.len();
        let columns = sheet.columns.clamp(1, panels.clamp(1, MOST_COLUMNS));
        let planes_per_panel = if sheet.has_regions() { 2 } else { 1 };
        let most = ((ROW_PX - GAP_PX * (columns as f64 - 1.0)) / columns as f64).min(MOST_PANEL_PX);
        let area = Plane::fit(window, [0.0, 0.0], [most, most]).area;
        let rows = panels.div_ceil(columns) as f64;
        let per_row = TITLE_ROW_PX + (area.h + PAIR_PX) * planes_per_panel as f64 + GAP_PX - PAIR_PX;
        Self {
            window,
            columns,
            panels,
            planes_per_panel,
            panel_px: [area.w, area.h],
            left_px: BORDER_PX + Plane::left_room_px(&window),
            width_px: columns as f64 * (area.w + GAP_PX) - GAP_PX,
            height_px: rows * per_row - GAP_PX,
        }
    }

    /// The place of the panel `index`, counted from 0 in reading order, below `top_px`.
    fn cell(&self, index: usize, top_px: f64) -> Cell {
        let (column, row) = (index % self.columns, index / self.columns);
        let [w, h] = self.panel_px;
        let per_row = TITLE_ROW_PX + (h + PAIR_PX) * self.planes_per_panel as f64 + GAP_PX - PAIR_PX;
        let x = self.left_px + column as f64 * (w + GAP_PX);
        let y = top_px + row as f64 * per_row + TITLE_ROW_PX;
        // The lowest panel of each column carries the numbers of the horizontal axis.
        let lowest = index + self.columns >= self.panels;
        let planes: Vec<Plane> = (0..self.planes_per_panel)
            .map(|k| Plane::fit(self.window, [x, y + (h + PAIR_PX) * k as f64], [w, h]))
            .collect();
        let marks = (0..self.planes_per_panel)
            .map(|k| Marks {
                horizontal_numbers: lowest && k + 1 == self.planes_per_panel,
                vertical_numbers: column == 0,
                font_px: PANEL_PX,
                overhang: Overhang::LeftOut,
            })
            .collect();
        Cell { planes, marks }
    }
}

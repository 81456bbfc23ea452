//! One field in one plane: bands or region, iso-lines with labels, the tolerance, and the zones that cannot be used.
//!
//! What is drawn between the grid points is the monotone cubic of [`crate::surface`]: exact at the points, between the
//! two neighbours in between. How far a line is from that of the true field is not known here; a finer grid shows it.
//! Zones end half-way between a point inside and a point outside.
//!
//! Painted from back to front: bands or region; iso-lines; hatch of points outside the joint limits; the
//! tolerance; hatch of what is out of reach; labels. The tolerance runs over the first hatch, since those points have
//! values, and under the second, since there it is a continuation of the neighbours.

use crate::colour::{ColourScale, INK, NOMINAL, OVER, UNDECIDED, WITHIN};
use crate::grid::{Grid, PointState};
use crate::legend::{Entry, Key};
use crate::levels::Levels;
use crate::levels_drawing::{LevelLines, Placed};
use crate::line_label::{LabelRoom, write_labels};
use crate::plane::{Plane, Window};
use crate::surface::Surface;
use crate::svg::{Hatch, Point, Style, Svg};
use crate::tolerance;

/// How the area of a field is painted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Paint {
    /// Filled bands.
    Bands(ColourScale),
    /// One colour within the tolerance, grey over it.
    Region,
}

/// Which iso-lines are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum IsoLines {
    /// None: bands or a region only.
    Off,
    /// Without numbers, for small panels.
    Thin,
    /// With numbers where they have room.
    Labelled,
}

/// How a field is drawn; values and tolerance in um.
pub(crate) struct FieldStyle<'a> {
    pub(crate) levels: &'a Levels,
    pub(crate) paint: Paint,
    pub(crate) iso_lines: IsoLines,
    /// The tolerance; a line where the field crosses it.
    pub(crate) tolerance_um: Option<f64>,
    /// The least and the greatest value of each point, where a region shows the uncertainty.
    pub(crate) uncertainty: Option<&'a [Grid; 2]>,
    /// Points that labels keep clear of: what is drawn on top afterwards.
    pub(crate) obstacles: &'a [Point],
}

/// Draws `grid` into `plane`; the frame comes afterwards, on top. Not checked: that the grid can be drawn, see
/// [`Grid::obstacle`].
pub(crate) fn draw_field(svg: &mut Svg, plane: &Plane, grid: &Grid, look: &FieldStyle<'_>) {
    let steps = (plane.area.w.max(plane.area.h) / 3.0).clamp(40.0, crate::surface::FINE as f64) as usize;
    let surface = Surface::refine(grid, steps);
    let at = |mm: [f64; 2]| plane.at(mm);
    let placed = Placed {
        field: surface.field(),
        at: &at,
        area: plane.area,
    };
    let lines = LevelLines::of(&placed, look.levels, look.tolerance_um);
    svg.clipped(plane.area, |svg| {
        match look.paint {
            Paint::Bands(scale) => placed.draw_bands(svg, look.levels, scale),
            Paint::Region => draw_region(svg, &placed, look, steps),
        }
        match look.iso_lines {
            IsoLines::Off => {}
            IsoLines::Thin => lines.draw_iso(svg, &Style::line(INK, 0.5).opacity(0.45)),
            IsoLines::Labelled => lines.draw_iso(svg, &Style::line(INK, 0.8).opacity(0.6)),
        }
        let zone = |inside: fn(PointState) -> bool| -> Vec<f64> {
            grid.points.iter().map(|p| f64::from(inside(*p))).collect()
        };
        if grid.has_outside_limits() {
            let samples = zone(|p| matches!(p, PointState::OutsideJointLimits(_)));
            let fill = svg.hatch(&outside_hatch(look.paint));
            svg.layer("outside-joint-limits", 1.0, |svg| {
                draw_zone(svg, &placed.with(grid.sampled(&samples)), &fill);
            });
        }
        lines.draw_tolerance(svg, &[tolerance::ground_style(), tolerance::style()]);
        if grid.has_unreachable() {
            let samples = zone(|p| p.value_um().is_none());
            let fill = svg.hatch(&unreachable_hatch());
            svg.layer("unreachable", 1.0, |svg| {
                draw_zone(svg, &placed.with(grid.sampled(&samples)), &fill);
            });
        }
    });
    if look.iso_lines == IsoLines::Labelled {
        let free = |p: Point| surface.is_reached_at(plane.mm(p));
        let room = LabelRoom {
            area: plane.area,
            free: &free,
            obstacles: look.obstacles,
        };
        write_labels(svg, &lines.labels(), &room);
    }
}

/// One colour within the tolerance, another over it, and a third where it is within the uncertainty.
fn draw_region(svg: &mut Svg, values: &Placed<'_>, look: &FieldStyle<'_>, steps: usize) {
    svg.rect(values.area, &Style::fill(WITHIN));
    let Some(tolerance_um) = look.tolerance_um.filter(|tolerance| tolerance.is_finite()) else {
        return;
    };
    match look.uncertainty {
        Some([least, greatest]) => {
            for (grid, colour) in [(greatest, UNDECIDED), (least, OVER)] {
                let surface = Surface::refine(grid, steps);
                values.with(surface.field()).fill_from(svg, tolerance_um, colour);
            }
        }
        None => values.fill_from(svg, tolerance_um, OVER),
    }
}

/// Fills the zone around the points whose sample is 1, half-way to their neighbours.
fn draw_zone(svg: &mut Svg, zone: &Placed<'_>, fill: &str) {
    zone.fill_from(svg, 0.5, fill);
    for line in zone.lines_at(0.5) {
        svg.polyline(&line, &Style::line("#6f6f6f", 0.9));
    }
}

/// The window that shows all points of a grid, in the direction in which its axes run.
pub(crate) fn window_of(grid: &Grid) -> Window {
    let ends = |values: &[f64]| {
        (
            values.first().copied().unwrap_or(0.0),
            values.last().copied().unwrap_or(0.0),
        )
    };
    let (left_mm, right_mm) = ends(&grid.horizontal_mm);
    let (bottom_mm, top_mm) = ends(&grid.vertical_mm);
    Window {
        left_mm,
        right_mm,
        bottom_mm,
        top_mm,
    }
}

/// Legend entries for the zones of these grids that cannot be used; none for a zone that no grid has.
pub(crate) fn zone_entries<'a>(
    svg: &mut Svg,
    grids: impl Iterator<Item = &'a Grid> + Clone,
    paint: Paint,
) -> Vec<Entry> {
    let mut entries = Vec::new();
    let mut add = |svg: &mut Svg, hatch: Hatch, label: &str| {
        let fill = svg.hatch(&hatch);
        entries.push(Entry::new(Key::field(&fill), label));
    };
    if grids.clone().any(Grid::has_unreachable) {
        add(svg, unreachable_hatch(), "out of reach");
    }
    if grids.clone().any(Grid::has_outside_limits) {
        add(svg, outside_hatch(paint), "outside the joint limits");
    }
    entries
}

/// Rising lines on near white: the colours below are not values.
fn unreachable_hatch() -> Hatch {
    Hatch {
        turn_deg: 45.0,
        pitch_px: 6.0,
        width_px: 0.8,
        colour: NOMINAL,
        ground: Some("#fafafa"),
    }
}

/// Falling lines, over the bands where they stay visible, over grey where a region is drawn.
fn outside_hatch(paint: Paint) -> Hatch {
    let ground = match paint {
        Paint::Bands(_) => None,
        Paint::Region => Some("#ececec"),
    };
    Hatch {
        turn_deg: -45.0,
        pitch_px: 9.0,
        width_px: 0.5,
        colour: "#3a3a3a",
        ground,
    }
}

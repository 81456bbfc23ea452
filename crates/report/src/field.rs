//! One field in one plane: bands or region, iso-lines with labels, the limit, and the zones that cannot be used.

use crate::colour::{ColourScale, DOUBTFUL, INK, NOMINAL, OVER, WITHIN};
use crate::contours::{Lattice, Ring};
use crate::grid::{Grid, PointState};
use crate::levels::Levels;
use crate::limit;
use crate::line_label::{Labelled, Room, write_labels};
use crate::page::{Entry, Key};
use crate::plane::{Plane, Window};
use crate::surface::Surface;
use crate::svg::{Ends, Hatch, Point, Style, Svg, Text, trace};

/// How the area of a field is painted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Paint {
    /// Filled bands.
    Bands(ColourScale),
    /// One colour within the limit, grey over it.
    Region,
}

/// Which iso-lines are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum IsoLines {
    Off,
    Thin,
    Labelled,
}

/// How a field is drawn.
pub(crate) struct Look<'a> {
    pub(crate) levels: &'a Levels,
    pub(crate) paint: Paint,
    pub(crate) iso_lines: IsoLines,
    pub(crate) limit_um: Option<f64>,
    /// The least and the greatest that each value may be, where a region tells what is doubtful.
    pub(crate) doubt: Option<&'a [Grid; 2]>,
    /// Points that labels keep clear of: what is drawn on top afterwards.
    pub(crate) obstacles: &'a [Point],
}

/// Draws `grid` into `plane`; the frame comes afterwards, on top.
pub(crate) fn draw_field(svg: &mut Svg, plane: &Plane, grid: &Grid, look: &Look<'_>) {
    let steps = (plane.area.w.max(plane.area.h) / 3.0).clamp(40.0, crate::surface::FINE as f64) as usize;
    let surface = Surface::refine(grid, steps);
    let values = lattice(&surface);
    let level_lines = |levels: &[f64]| -> Vec<Vec<Vec<Point>>> {
        let all = values.lines_at(levels);
        all.into_iter()
            .map(|lines| lines.into_iter().map(|l| on_picture(plane, &l)).collect())
            .collect()
    };
    let limit: Vec<f64> = look.limit_um.into_iter().filter(|l| l.is_finite()).collect();
    let iso_levels: &[f64] = match (look.iso_lines, look.paint) {
        (IsoLines::Off, _) => &[],
        _ => look.levels.inner_um(),
    };
    let iso = level_lines(iso_levels);
    let limit_lines: Vec<Vec<Point>> = level_lines(&limit).into_iter().flatten().collect();

    svg.clipped(plane.area, |svg| {
        match look.paint {
            Paint::Bands(scale) => {
                svg.rect(plane.area, &Style::fill(look.levels.colour(0, scale)));
                let areas = values.areas_from(look.levels.inner_um());
                for (band, rings) in areas.iter().enumerate() {
                    svg.path(
                        &rings_path(plane, rings),
                        &Style::fill(look.levels.colour(band + 1, scale)),
                    );
                }
            }
            Paint::Region => {
                svg.rect(plane.area, &Style::fill(WITHIN));
                let over_limit = |svg: &mut Svg, values: &Lattice<'_>, colour: &str| {
                    for rings in values.areas_from(&limit) {
                        svg.path(&rings_path(plane, &rings), &Style::fill(colour));
                    }
                };
                match look.doubt {
                    Some([least, greatest]) => {
                        for (of, colour) in [(greatest, DOUBTFUL), (least, OVER)] {
                            let surface = Surface::refine(of, steps);
                            over_limit(svg, &lattice(&surface), colour);
                        }
                    }
                    None => over_limit(svg, &values, OVER),
                }
            }
        }
        let thin = match look.iso_lines {
            IsoLines::Labelled => Style::line(INK, 0.8).opacity(0.6),
            _ => Style::line(INK, 0.5).opacity(0.45),
        };
        for line in iso.iter().flatten() {
            svg.polyline(line, &thin);
        }
        if grid.has_outside_limits() {
            let fill = svg.hatch(&outside_hatch(look.paint));
            draw_zone(
                svg,
                plane,
                grid,
                &Zone {
                    class: "outside-joint-limits",
                    fill,
                },
                |p| matches!(p, PointState::OutsideJointLimits(_)),
            );
        }
        for line in &limit_lines {
            svg.polyline(line, &limit::ground_style());
        }
        for line in &limit_lines {
            svg.polyline(line, &limit::style());
        }
        if grid.has_unreachable() {
            let fill = svg.hatch(&unreachable_hatch());
            draw_zone(
                svg,
                plane,
                grid,
                &Zone {
                    class: "unreachable",
                    fill,
                },
                |p| p.value_um().is_none(),
            );
        }
    });
    if look.iso_lines == IsoLines::Labelled {
        let labels = labels_of(&limit_lines, &iso, iso_levels, look);
        let free = |p: Point| surface.is_reached_at(plane.mm(p));
        write_labels(
            svg,
            &labels,
            &Room {
                area: plane.area,
                free: &free,
                obstacles: look.obstacles,
            },
        );
    }
}

fn lattice(surface: &Surface) -> Lattice<'_> {
    Lattice {
        horizontal_mm: &surface.horizontal_mm,
        vertical_mm: &surface.vertical_mm,
        samples: &surface.value_um,
    }
}

/// The window that shows all points of a grid.
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

/// Legend entries for the zones of these grids that cannot be used.
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

fn unreachable_hatch() -> Hatch {
    Hatch {
        turn_deg: 45.0,
        pitch_px: 6.0,
        width_px: 0.8,
        colour: NOMINAL,
        ground: Some("#fafafa"),
    }
}

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

/// How a zone of points is drawn.
struct Zone {
    class: &'static str,
    fill: String,
}

/// Fills the zone around the points where `inside` holds, half-way to their neighbours.
fn draw_zone(svg: &mut Svg, plane: &Plane, grid: &Grid, zone: &Zone, inside: impl Fn(PointState) -> bool) {
    let samples: Vec<f64> = grid
        .points
        .iter()
        .map(|p| if inside(*p) { 1.0 } else { 0.0 })
        .collect();
    let lattice = Lattice {
        horizontal_mm: &grid.horizontal_mm,
        vertical_mm: &grid.vertical_mm,
        samples: &samples,
    };
    svg.layer(zone.class, 1.0, |svg| {
        for rings in lattice.areas_from(&[0.5]) {
            svg.path(&rings_path(plane, &rings), &Style::fill(zone.fill.as_str()));
        }
        for line in lattice.lines_at(&[0.5]).into_iter().flatten() {
            svg.polyline(&on_picture(plane, &line), &Style::line("#6f6f6f", 0.9));
        }
    });
}

fn labels_of(
    limit: &[Vec<Point>],
    iso: &[Vec<Vec<Point>>],
    levels: &[f64],
    look: &Look<'_>,
) -> Vec<Labelled> {
    let limit_um = look.limit_um.unwrap_or(f64::NAN);
    let limit_label = |points: &Vec<Point>| Labelled {
        points: points.clone(),
        text: limit::label(limit_um),
        look: limit::text(),
    };
    let mut labels: Vec<Labelled> = limit.iter().map(limit_label).collect();
    for (lines, level) in iso.iter().zip(levels) {
        // A line that coincides with the limit carries the limit's label.
        if (level - limit_um).abs() < 0.05 * look.levels.step_um {
            continue;
        }
        labels.extend(lines.iter().map(|points| Labelled {
            points: points.clone(),
            text: look.levels.label(*level),
            look: Text::new(10.0).halo(3.0),
        }));
    }
    labels
}

fn rings_path(plane: &Plane, rings: &[Ring]) -> String {
    rings
        .iter()
        .map(|ring| trace(&on_picture(plane, ring), Ends::Closed))
        .collect()
}

/// A line in pixels, without the points that would not be seen.
fn on_picture(plane: &Plane, line: &[[f64; 2]]) -> Vec<Point> {
    // Half of the two decimals that are written.
    const SAME_PX: f64 = 0.3;
    let mut out: Vec<Point> = Vec::with_capacity(line.len());
    for (k, mm) in line.iter().enumerate() {
        let p = plane.at(*mm);
        let near = out
            .last()
            .is_some_and(|q| (p[0] - q[0]).hypot(p[1] - q[1]) < SAME_PX);
        if !near || k + 1 == line.len() {
            out.push(p);
        }
    }
    out
}

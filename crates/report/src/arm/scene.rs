//! The whole drawing: floor with shadow, ghosts, plate, path and arm painted from back to front, then names and
//! directions.
//!
//! Painter's order: floor, shadow, ghosts, then solids, plate and path sorted by their depth, names and base
//! directions last. Nearer solids hide those behind them; solids that pass through each other are not
//! cut, which a schematic bears. Points of the scene are in the frame of the ground in mm, points of the drawing in px
//! with y downwards.

use super::body::{Body, JointSpot, Part, Solid, arm_length};
use super::drawing::{ArmDrawing, ArmPosture, is_finite};
use super::shapes::{ParallelProjection, corners, draw_solid, hull, paint_depth};
use super::view::{Projection, Vec3, View};
use crate::arrow::draw_arrow;
use crate::axis::{extent, multiples, nice_step};
use crate::colour::{INK, MUTED, SIGNAL};
use crate::font::{SMALL_PX, Weight, text_width_px};
use crate::svg::{Point, Rect, Style, Svg, Text};

/// Everything that is drawn, in the frame of the ground; what is not finite is left out.
pub(crate) struct Scene {
    /// The arm in colour.
    body: Body,
    ghosts: Vec<Body>,
    plate_mm: Option<[Vec3; 4]>,
    path_mm: Vec<Vec3>,
    /// Floor: low and high corner, on multiples of its grid step; at the height of the foot, or of the lowest
    /// point where something reaches well below the foot.
    floor_mm: [Vec3; 2],
    /// Base, joint origins, flange and tool: the line that throws the shadow and that names keep clear of.
    links_mm: Vec<Vec3>,
    /// Length of the arm, at least 1 mm.
    size_mm: f64,
}

impl Scene {
    /// The input of a drawing. Its posture has a joint, and its numbers are finite.
    pub(crate) fn of(drawing: &ArmDrawing) -> Self {
        let ghosts: Vec<&ArmPosture> = drawing
            .ghosts
            .iter()
            .filter(|g| !g.joints.is_empty() && is_finite(g))
            .collect();
        let path_mm: Vec<Vec3> = drawing
            .path_mm
            .iter()
            .filter(|p| p.iter().all(|v| v.is_finite()))
            .copied()
            .collect();
        let plate_mm = drawing
            .plate_mm
            .filter(|c| c.iter().flatten().all(|v| v.is_finite()));
        let standing = drawing
            .standing_tool_mm
            .filter(|ends| ends.iter().flatten().all(|v| v.is_finite()));
        let posture = &drawing.posture;
        let size_mm = arm_length(posture).max(1.0);
        let links_mm: Vec<Vec3> = std::iter::once(posture.base_mm)
            .chain(posture.joints.iter().map(|j| j.origin_mm))
            .chain([posture.flange_mm, posture.tool_mm])
            .collect();
        let all = || {
            let ghost_points = ghosts
                .iter()
                .flat_map(|g| g.joints.iter().map(|j| j.origin_mm).chain([g.tool_mm]));
            links_mm
                .iter()
                .copied()
                .chain(ghost_points)
                .chain(plate_mm.into_iter().flatten())
                .chain(path_mm.iter().copied())
                .chain(standing.into_iter().flatten())
        };
        let margin = 0.1 * size_mm;
        let ends =
            |k: usize| extent(all().map(|p| p[k])).map_or([0.0, 0.0], |(a, b)| [a - margin, b + margin]);
        let (x, y) = (ends(0), ends(1));
        let lowest = extent(all().map(|p| p[2]))
            .map_or(0.0, |r| r.0)
            .min(posture.base_mm[2]);
        let step = floor_step(size_mm);
        let snap = |v: [f64; 2]| [(v[0] / step).floor() * step, (v[1] / step).ceil() * step];
        let (x, y) = (snap(x), snap(y));
        let z = if lowest < posture.base_mm[2] - 0.05 * size_mm {
            lowest
        } else {
            posture.base_mm[2]
        };
        let body = Body::of(posture);
        Self {
            body: match standing {
                Some(ends) => body.and_tool(posture, ends),
                None => body,
            },
            ghosts: ghosts.into_iter().map(Body::of).collect(),
            plate_mm,
            path_mm,
            floor_mm: [[x[0], y[0], z], [x[1], y[1], z]],
            links_mm,
            size_mm,
        }
    }

    /// All solids, ghosts included, for fitting.
    fn solids(&self) -> impl Iterator<Item = &Solid> {
        self.body
            .solids
            .iter()
            .chain(self.ghosts.iter().flat_map(|g| &g.solids))
    }

    /// The corners of the floor, in order around it.
    fn floor_corners(&self) -> [Vec3; 4] {
        let [a, b] = self.floor_mm;
        [a, [b[0], a[1], a[2]], b, [a[0], b[1], a[2]]]
    }
}

/// Blank border inside a drawing.
const INSET_PX: f64 = 26.0;
/// Red, green and blue for x, y and z, as everywhere.
const AXIS_COLOURS: [&str; 3] = ["#c8102e", "#2e8b57", "#1f5fa8"];
/// Strip below it for the base directions.
const DIRECTIONS_PX: f64 = 46.0;

/// A projection placed on the picture: a scale, and the position of the base origin.
struct Placed {
    projection: Projection,
    px_per_mm: f64,
    origin_px: Point,
}

impl ParallelProjection for Placed {
    fn at(&self, p: Vec3) -> Point {
        let flat = self.projection.flat(p);
        [
            self.origin_px[0] + flat[0] * self.px_per_mm,
            self.origin_px[1] - flat[1] * self.px_per_mm,
        ]
    }

    fn px_per_mm(&self) -> f64 {
        self.px_per_mm
    }

    fn depth(&self, p: Vec3) -> f64 {
        self.projection.depth(p)
    }
}

/// Something that is painted in its turn, by its depth.
enum Item<'a> {
    Solid(&'a Solid),
    Plate([Vec3; 4]),
    Path,
}

/// Preferred height of a drawing of this width, border included, between `least_px` and `most_px`.
pub(crate) fn wanted_height_px(
    scene: &Scene,
    view: View,
    width_px: f64,
    [least_px, most_px]: [f64; 2],
) -> f64 {
    let unit = Placed {
        projection: view.projection(),
        px_per_mm: 1.0,
        origin_px: [0.0, 0.0],
    };
    let [x, y] = bounds(scene, &unit);
    let px_per_mm = (width_px - 2.0 * INSET_PX) / (x.1 - x.0).max(1e-9);
    (2.0 * INSET_PX + DIRECTIONS_PX + (y.1 - y.0) * px_per_mm).clamp(least_px, most_px)
}

/// Draws the scene into `area`, as large as it fits with the base directions below it.
pub(crate) fn draw_scene(svg: &mut Svg, scene: &Scene, view: View, area: Rect) {
    let inset = area.shrunk(INSET_PX);
    let place = fitted(
        scene,
        view,
        Rect {
            h: (inset.h - DIRECTIONS_PX).max(1.0),
            ..inset
        },
    );
    svg.rounded(area, 4.0, &Style::fill("#fbfcfd").outlined("#d8dde2", 1.0));
    draw_floor(svg, scene, view, &place);
    for ghost in &scene.ghosts {
        svg.layer("ghost", 0.2, |svg| {
            let mut solids: Vec<&Solid> = ghost.solids.iter().filter(|s| !is_foot(s)).collect();
            solids.sort_by(|a, b| paint_depth(a, &place).total_cmp(&paint_depth(b, &place)));
            for solid in solids {
                draw_solid(svg, solid, &place);
            }
        });
    }
    let mut items: Vec<(f64, Item<'_>)> = scene
        .body
        .solids
        .iter()
        .map(|s| (paint_depth(s, &place), Item::Solid(s)))
        .collect();
    let centre_depth =
        |points: &[Vec3]| points.iter().map(|p| place.depth(*p)).sum::<f64>() / points.len().max(1) as f64;
    if let Some(plate) = scene.plate_mm {
        items.push((centre_depth(&plate), Item::Plate(plate)));
    }
    if !scene.path_mm.is_empty() {
        // Just in front of the plate that it is on.
        let depth =
            centre_depth(&scene.path_mm).max(scene.plate_mm.map_or(f64::NEG_INFINITY, |p| centre_depth(&p)));
        items.push((depth + 1e-3 * scene.size_mm, Item::Path));
    }
    items.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, item) in items {
        match item {
            Item::Solid(solid) => draw_solid(svg, solid, &place),
            Item::Plate(corners) => {
                let points = corners.map(|p| place.at(p));
                svg.layer("plate", 0.5, |svg| {
                    svg.polygon(&points, &Style::fill("#f0c987").outlined("#8a5a00", 1.4));
                });
            }
            Item::Path => {
                let points: Vec<Point> = scene.path_mm.iter().map(|p| place.at(*p)).collect();
                svg.polyline(&points, &Style::line("#fff", 4.4).opacity(0.85));
                svg.polyline(&points, &Style::line(SIGNAL, 2.2));
            }
        }
    }
    draw_names(svg, scene, &place, area);
    draw_directions(svg, view, area);
}

fn is_foot(solid: &Solid) -> bool {
    matches!(solid, Solid::Cylinder { part: Part::Foot, .. })
}

/// Distance of the floor's lines, mm: about a tenth of the arm.
fn floor_step(size_mm: f64) -> f64 {
    nice_step(size_mm, 10.0)
}

/// The projection that shows everything inside `area`, in its middle.
fn fitted(scene: &Scene, view: View, area: Rect) -> Placed {
    let projection = view.projection();
    let unit = Placed {
        projection,
        px_per_mm: 1.0,
        origin_px: [0.0, 0.0],
    };
    let [x, y] = bounds(scene, &unit);
    let px_per_mm = (area.w / (x.1 - x.0).max(1e-9)).min(area.h / (y.1 - y.0).max(1e-9));
    let c = area.centre();
    let origin_px = [
        c[0] - (x.0 + x.1) / 2.0 * px_per_mm,
        c[1] - (y.0 + y.1) / 2.0 * px_per_mm,
    ];
    Placed {
        projection,
        px_per_mm,
        origin_px,
    }
}

/// Least and greatest picture coordinates of everything in the scene.
fn bounds(scene: &Scene, place: &Placed) -> [(f64, f64); 2] {
    let mut points: Vec<Point> = scene.solids().flat_map(|s| corners(s, place)).collect();
    points.extend(scene.floor_corners().map(|p| place.at(p)));
    points.extend(scene.plate_mm.into_iter().flatten().map(|p| place.at(p)));
    points.extend(scene.path_mm.iter().map(|p| place.at(*p)));
    [0, 1].map(|k| extent(points.iter().map(|p| p[k])).unwrap_or((0.0, 1.0)))
}

/// A line where the floor is seen from the side; else the grid and, straight below, the shadow of arm and
/// plate.
fn draw_floor(svg: &mut Svg, scene: &Scene, view: View, place: &Placed) {
    let [a, b] = scene.floor_mm;
    let z = a[2];
    if matches!(view, View::Front | View::Side) {
        let corners = scene.floor_corners().map(|p| place.at(p));
        let x = extent(corners.iter().map(|p| p[0])).unwrap_or((0.0, 0.0));
        svg.line(
            [x.0, corners[0][1]],
            [x.1, corners[0][1]],
            &Style::line(MUTED, 1.2),
        );
        return;
    }
    svg.polygon(
        &scene.floor_corners().map(|p| place.at(p)),
        &Style::fill("#eef1f4"),
    );
    let step = floor_step(scene.size_mm);
    let line = Style::line("#d3d9df", 0.8);
    for x in multiples(a[0], b[0], step) {
        svg.line(place.at([x, a[1], z]), place.at([x, b[1], z]), &line);
    }
    for y in multiples(a[1], b[1], step) {
        svg.line(place.at([a[0], y, z]), place.at([b[0], y, z]), &line);
    }
    let shadow: Vec<Point> = scene.links_mm.iter().map(|p| place.at([p[0], p[1], z])).collect();
    svg.layer("shadow", 0.12, |svg| {
        svg.polyline(&shadow, &Style::line(INK, 0.05 * scene.size_mm * place.px_per_mm));
        if let Some(plate) = scene.plate_mm {
            let flat = plate.map(|p| place.at([p[0], p[1], z])).to_vec();
            svg.polygon(&hull(flat), &Style::fill(INK).outlined(INK, 2.0));
        }
    });
}

/// Names in white badges next to their joints, clear of each other and, where there is room, of the arm.
fn draw_names(svg: &mut Svg, scene: &Scene, place: &Placed, area: Rect) {
    let mut taken: Vec<Rect> = Vec::new();
    let arm: Vec<Point> = scene
        .links_mm
        .windows(2)
        .flat_map(|w| {
            (0..=12)
                .map(move |k| super::view::along(w[0], super::view::between(w[0], w[1]), f64::from(k) / 12.0))
        })
        .map(|p| place.at(p))
        .collect();
    let inner = area.shrunk(6.0);
    for spot in &scene.body.joints {
        let around = Around {
            taken: &taken,
            arm: &arm,
            inner,
        };
        let badge = best_badge(spot, place, &around);
        let Some((badge, joint)) = badge else { continue };
        let c = badge.centre();
        let away = (c[0] - joint[0]).hypot(c[1] - joint[1]).max(1.0);
        let edge = [
            c[0] - (c[0] - joint[0]) / away * badge.w / 2.0,
            c[1] - (c[1] - joint[1]) / away * badge.h / 2.0,
        ];
        svg.line(joint, edge, &Style::line("#fff", 2.6).opacity(0.8));
        svg.line(joint, edge, &Style::line(INK, 0.9));
        svg.circle(joint, 1.8, &Style::fill(INK));
        svg.rounded(badge, badge.h / 2.0, &Style::fill("#fff").outlined(INK, 1.0));
        svg.text(
            [c[0], c[1] + 4.0],
            &spot.name,
            &Text::new(SMALL_PX).bold().middle(),
        );
        taken.push(badge);
    }
}

/// What a badge keeps clear of, and the part of the drawing that it is in.
struct Around<'a> {
    taken: &'a [Rect],
    arm: &'a [Point],
    inner: Rect,
}

/// The badge of a joint and the point it belongs to; `None` without a name or without room. Of 16 directions on
/// 5 rings the one that comes least close to the arm and stays near; it overlaps no other badge.
fn best_badge(spot: &JointSpot, place: &Placed, around: &Around<'_>) -> Option<(Rect, Point)> {
    if spot.name.is_empty() {
        return None;
    }
    let joint = place.at(spot.at);
    let w = (text_width_px(&spot.name, SMALL_PX, Weight::Bold) + 10.0).max(18.0);
    let start = spot.radius * place.px_per_mm + 14.0 + w / 4.0;
    let mut best: Option<(f64, Rect)> = None;
    for ring in 0..5 {
        for turn in 0..16 {
            let (sin, cos) = (f64::from(turn) * std::f64::consts::TAU / 16.0).sin_cos();
            let r = start + f64::from(ring) * 9.0;
            let c = [joint[0] + r * cos, joint[1] + r * sin];
            let badge = Rect {
                x: c[0] - w / 2.0,
                y: c[1] - 9.0,
                w,
                h: 18.0,
            };
            let room = badge.shrunk(-5.0);
            if around.taken.iter().any(|t| t.overlaps(&room))
                || !around.inner.contains([badge.x, badge.y])
                || !around.inner.contains([badge.right(), badge.bottom()])
            {
                continue;
            }
            let keep = spot.radius * place.px_per_mm;
            let crowd: f64 = around
                .arm
                .iter()
                .map(|p| (keep + 14.0 - (p[0] - c[0]).hypot(p[1] - c[1])).max(0.0))
                .sum();
            let cost = crowd + 4.0 * f64::from(ring);
            if best.as_ref().is_none_or(|(b, _)| cost < *b) {
                best = Some((cost, badge));
            }
        }
    }
    best.map(|(_, badge)| (badge, joint))
}

/// The base directions, at the lower left; one that points at the viewer is left out.
fn draw_directions(svg: &mut Svg, view: View, area: Rect) {
    const LENGTH_PX: f64 = 30.0;
    let projection = view.projection();
    let at = [area.x + 36.0, area.bottom() - 20.0];
    let axes = [
        ("x", [1.0, 0.0, 0.0], AXIS_COLOURS[0]),
        ("y", [0.0, 1.0, 0.0], AXIS_COLOURS[1]),
        ("z", [0.0, 0.0, 1.0], AXIS_COLOURS[2]),
    ];
    for (name, axis, colour) in axes {
        let flat = projection.flat(axis);
        let size = flat[0].hypot(flat[1]);
        if size < 0.15 {
            continue;
        }
        let tip = [at[0] + LENGTH_PX * flat[0], at[1] - LENGTH_PX * flat[1]];
        draw_arrow(svg, [at, tip], colour);
        let label = [tip[0] + 8.0 * flat[0] / size, tip[1] - 8.0 * flat[1] / size + 4.0];
        svg.text(label, name, &Text::new(SMALL_PX).bold().middle().colour(colour));
    }
}

//! Solids as flat shapes: outlines with a gradient that rounds them, the lit side up and to the left.
//!
//! | solid | outline |
//! |---|---|
//! | capsule | convex hull of two circles |
//! | cylinder | convex hull of its two end discs, and the disc that faces the viewer over it |
//!
//! Discs are polygons of 40 corners. A gradient across the outline, from middle over light to dark, makes it
//! look round.

use super::body::{Part, Solid};
use super::view::{Vec3, along, cross, unit};
use crate::svg::{Point, Style, Svg};

/// Where a point of the base frame is on the picture: a parallel projection with one scale.
pub(crate) trait ParallelProjection {
    /// Pixels, y downwards.
    fn at(&self, p: Vec3) -> Point;
    /// The scale of a length across the line of sight.
    fn px_per_mm(&self) -> f64;
    /// How near to the viewer, mm.
    fn depth(&self, p: Vec3) -> f64;
}

/// Corners of a drawn circle.
const CORNERS: usize = 40;
/// Direction from which the light comes, in the picture.
const LIGHT: Point = [-0.5, -0.866];

/// Edge, light, middle and dark colour of a part.
fn colours(part: Part) -> [&'static str; 4] {
    match part {
        Part::Foot => ["#59636e", "#a9b4bf", "#7d8894", "#4d5660"],
        Part::Link => ["#6c7a89", "#f7f9fb", "#d5dde5", "#93a1b0"],
        Part::Joint | Part::Collar => ["#1f4e79", "#9cc3e6", "#4a86be", "#23527f"],
        Part::Flange => ["#4a4f55", "#cfd4d9", "#8e959c", "#565c63"],
        Part::Tool => ["#6b4a00", "#ffe2a0", "#e0a526", "#94690b"],
    }
}

/// How far back a solid is painted, mm, nearer to the viewer is more: a link before both of its joints.
pub(crate) fn paint_depth(solid: &Solid, place: &impl ParallelProjection) -> f64 {
    match solid {
        Solid::Capsule { ends, .. } => place.depth(ends[0]).min(place.depth(ends[1])),
        Solid::Cylinder {
            centre,
            axis,
            half_length,
            part,
            ..
        } => match part {
            Part::Joint => place.depth(*centre) + 0.5 * half_length,
            Part::Link => {
                let ends = [1.0, -1.0].map(|side| place.depth(along(*centre, *axis, side * half_length)));
                ends[0].min(ends[1])
            }
            _ => place.depth(*centre),
        },
    }
}

/// Draws one solid over what is there.
pub(crate) fn draw_solid(svg: &mut Svg, solid: &Solid, place: &impl ParallelProjection) {
    match solid {
        Solid::Capsule { ends, radii, part } => draw_capsule(
            svg,
            [place.at(ends[0]), place.at(ends[1])],
            radii.map(|r| r * place.px_per_mm()),
            *part,
        ),
        Solid::Cylinder {
            centre,
            axis,
            radius,
            half_length,
            part,
        } => {
            let ends = [1.0, -1.0].map(|side| along(*centre, *axis, side * half_length));
            let flat = FlatCylinder {
                caps: ends.map(|end| disc(end, *axis, *radius, place)),
                centres: ends.map(|end| place.at(end)),
                near: usize::from(place.depth(*axis) - place.depth([0.0; 3]) < 0.0),
                radius_px: radius * place.px_per_mm(),
                part: *part,
            };
            draw_cylinder(svg, &flat);
        }
    }
}

/// All corners of a solid, for fitting the picture.
pub(crate) fn corners(solid: &Solid, place: &impl ParallelProjection) -> Vec<Point> {
    match solid {
        Solid::Capsule { ends, radii, .. } => ends
            .iter()
            .zip(radii)
            .flat_map(|(end, r)| {
                let (c, r) = (place.at(*end), r * place.px_per_mm());
                [[c[0] - r, c[1] - r], [c[0] + r, c[1] + r]]
            })
            .collect(),
        Solid::Cylinder {
            centre,
            axis,
            radius,
            half_length,
            ..
        } => [1.0, -1.0]
            .into_iter()
            .flat_map(|side| disc(along(*centre, *axis, side * half_length), *axis, *radius, place))
            .collect(),
    }
}

/// The hull of two circles about the ends, lit across.
fn draw_capsule(svg: &mut Svg, [a, b]: [Point; 2], radii: [f64; 2], part: Part) {
    let mut outline = circle(a, radii[0]);
    outline.extend(circle(b, radii[1]));
    let across = across_lit(a, b);
    let r = radii[0].max(radii[1]);
    let [edge, light, middle, dark] = colours(part);
    let fill = svg.gradient(
        [a[0] + across[0] * r, a[1] + across[1] * r],
        [a[0] - across[0] * r, a[1] - across[1] * r],
        &[
            (0.0, middle.to_owned()),
            (0.3, light.to_owned()),
            (0.6, middle.to_owned()),
            (1.0, dark.to_owned()),
        ],
    );
    svg.polygon(&hull(outline), &Style::fill(fill).outlined(edge, 0.9));
}

/// A cylinder on the picture.
struct FlatCylinder {
    /// Outlines and middles of both ends.
    caps: [Vec<Point>; 2],
    centres: [Point; 2],
    /// The end that faces the viewer.
    near: usize,
    radius_px: f64,
    part: Part,
}

/// The side, then the end that faces the viewer; joints have a darker middle.
fn draw_cylinder(svg: &mut Svg, cylinder: &FlatCylinder) {
    let FlatCylinder {
        caps,
        centres,
        near,
        radius_px,
        part,
    } = cylinder;
    let (near, radius_px) = (*near, *radius_px);
    let [edge, light, middle, dark] = colours(*part);
    let across = across_lit(centres[0], centres[1]);
    let c = centres[0];
    let side = svg.gradient(
        [c[0] + across[0] * radius_px, c[1] + across[1] * radius_px],
        [c[0] - across[0] * radius_px, c[1] - across[1] * radius_px],
        &[
            (0.0, middle.to_owned()),
            (0.28, light.to_owned()),
            (0.6, middle.to_owned()),
            (1.0, dark.to_owned()),
        ],
    );
    let outline: Vec<Point> = caps.iter().flatten().copied().collect();
    let outer = hull(outline);
    svg.polygon(&outer, &Style::fill(side).outlined(edge, 0.9));
    let cap = &caps[near];
    let face = svg.gradient(
        [
            centres[near][0] + LIGHT[0] * radius_px,
            centres[near][1] + LIGHT[1] * radius_px,
        ],
        [
            centres[near][0] - LIGHT[0] * radius_px,
            centres[near][1] - LIGHT[1] * radius_px,
        ],
        &[(0.0, light.to_owned()), (1.0, middle.to_owned())],
    );
    svg.polygon(cap, &Style::fill(face).outlined(edge, 0.9));
    let inner: Vec<Point> = cap
        .iter()
        .map(|p| {
            [
                centres[near][0] + 0.45 * (p[0] - centres[near][0]),
                centres[near][1] + 0.45 * (p[1] - centres[near][1]),
            ]
        })
        .collect();
    if *part == Part::Joint {
        svg.polygon(&inner, &Style::fill(dark).opacity(0.55));
    }
}

/// The direction across a line that points to the light; the light's own where the line is seen end on.
fn across_lit(a: Point, b: Point) -> Point {
    let n = (b[0] - a[0]).hypot(b[1] - a[1]);
    if n < 1e-6 {
        return LIGHT;
    }
    let across = [-(b[1] - a[1]) / n, (b[0] - a[0]) / n];
    if across[0] * LIGHT[0] + across[1] * LIGHT[1] >= 0.0 {
        across
    } else {
        [-across[0], -across[1]]
    }
}

/// A circle of the picture as a polygon.
fn circle(c: Point, r: f64) -> Vec<Point> {
    (0..CORNERS)
        .map(|k| {
            let (s, co) = (k as f64 * std::f64::consts::TAU / CORNERS as f64).sin_cos();
            [c[0] + r * co, c[1] + r * s]
        })
        .collect()
}

/// A disc at right angles to `axis`, which has length one, as it is seen.
fn disc(centre: Vec3, axis: Vec3, radius: f64, place: &impl ParallelProjection) -> Vec<Point> {
    let helper = if axis[2].abs() < 0.9 {
        [0.0, 0.0, 1.0]
    } else {
        [1.0, 0.0, 0.0]
    };
    let e1 = unit(cross(axis, helper));
    let e2 = cross(axis, e1);
    (0..CORNERS)
        .map(|k| {
            let (s, c) = (k as f64 * std::f64::consts::TAU / CORNERS as f64).sin_cos();
            place.at(along(along(centre, e1, radius * c), e2, radius * s))
        })
        .collect()
}

/// The convex hull, by Andrew's monotone chain (1979); points that are not finite are left out.
pub(crate) fn hull(mut points: Vec<Point>) -> Vec<Point> {
    points.retain(|p| p[0].is_finite() && p[1].is_finite());
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let turn = |o: Point, a: Point, b: Point| (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
    let half = |points: &mut dyn Iterator<Item = Point>| {
        let mut chain: Vec<Point> = Vec::new();
        for p in points {
            while chain.len() > 1 && turn(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0.0 {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut lower = half(&mut points.iter().copied());
    lower.extend(half(&mut points.iter().rev().copied()));
    lower
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hull_of_a_square_with_inner_points_is_the_square() {
        let points = vec![
            [0.0, 0.0],
            [1.0, 0.0],
            [0.5, 0.5],
            [1.0, 1.0],
            [0.0, 1.0],
            [0.2, 0.7],
        ];
        assert_eq!(hull(points).len(), 4);
        assert!(hull(Vec::new()).is_empty());
    }
}

//! Capsules that enclose points, or the parts of a surface, with as little volume as possible.
//!
//! | step | how |
//! |---|---|
//! | start | about the principal axes of the points, the axes of the frame and directions between them |
//! | offset | about the centre of the smallest circle around the points, seen along the axis |
//! | search | the axis is tilted and shifted while the volume falls, by steps that become smaller |
//! | parts | a surface is cut by the plane after which the capsules of both sides have the least volume together |
//!
//! Volume of a capsule: `V = pi r^2 (l + 4/3 r)`, with r its radius and l the length of its axis. The search finds a minimum near its
//! starts, not provably the smallest one. Every point is inside but for rounding, for which the radius has 1e-9 more. Nothing is
//! random: the same points give the same capsules. Lengths in m.
//!
//! A capsule is convex: with the corners of a triangle it contains the triangle, and with a closed surface what is inside of it.

use nalgebra::{Matrix3, Point3, Vector3};

use super::bounds::{Bounds, Capsule};
use super::nearest::Segment;

/// Further starts, spread over the half sphere.
const SPREAD: usize = 20;
/// First tilt of an axis, rad; the first shift is this part of the radius.
const FIRST_STEP: f64 = 0.25;
/// For a capsule that is given out.
const FINE: Effort = Effort {
    outermost: 400,
    searched: 8,
    last_step: 1e-3,
};
/// To compare cuts, and for bounds.
const COARSE: Effort = Effort {
    outermost: 100,
    searched: 2,
    last_step: 0.1,
};
/// Cuts tried along each normal.
const CUTS: usize = 9;
/// Points along each edge of the grid in which the volume of two capsules together is counted.
const GRID: usize = 24;
/// A cut that saves less than this part of the volume is not made.
const LEAST_SAVING: f64 = 0.03;

/// How thoroughly an axis is searched.
#[derive(Clone, Copy)]
struct Effort {
    /// Directions in which the outermost points are taken: with these alone the axis is searched.
    outermost: usize,
    /// Starts from which it is searched, the best ones.
    searched: usize,
    /// The search ends below this step.
    last_step: f64,
}

/// A part of a surface and the capsule around it.
#[derive(Clone, Debug)]
pub struct Enclosed {
    /// The capsule.
    pub capsule: Capsule,
    /// The triangles that it encloses; those that a cut met are cut.
    pub surface: Vec<[Point3<f64>; 3]>,
}

/// The smallest capsule that was found around these points; `None` without any.
pub fn enclosing_capsule(points: &[Point3<f64>]) -> Option<Capsule> {
    fitted(points, FINE)
}

/// The same with less effort, for a bound: somewhat larger.
pub(super) fn roughly_enclosing_capsule(points: &[Point3<f64>]) -> Option<Capsule> {
    fitted(points, COARSE)
}

/// At most this many capsules around a surface, each with its part; none of an empty one.
pub fn enclosing_capsules(surface: &[[Point3<f64>; 3]], most: usize) -> Vec<Enclosed> {
    let mut parts: Vec<Enclosed> = enclosed(surface.to_vec(), FINE).into_iter().collect();
    while !parts.is_empty() && parts.len() < most {
        // The cut that saves the most, of all parts.
        let mut best: Option<(f64, usize, [Enclosed; 2])> = None;
        for (index, part) in parts.iter().enumerate() {
            let Some((saved, sides)) = best_cut(part) else {
                continue;
            };
            if best.as_ref().is_none_or(|best| saved > best.0) {
                best = Some((saved, index, sides));
            }
        }
        let whole: f64 = parts.iter().map(|part| volume(&part.capsule)).sum();
        let Some((_, index, [first, second])) = best.filter(|best| best.0 > LEAST_SAVING * whole) else {
            break;
        };
        parts[index] = first;
        parts.push(second);
    }
    // The cuts were chosen with coarse fits.
    let refined = |part: Enclosed| enclosed(part.surface, FINE);
    parts.into_iter().filter_map(refined).collect()
}

/// The capsule about this axis that contains all points; its ends stay.
pub fn about_axis(axis: Segment, points: &[Point3<f64>]) -> Capsule {
    let distance = |point: &Point3<f64>| (axis.nearest_to_point(point) - point).norm();
    let radius = points.iter().map(distance).fold(0.0, f64::max);
    Capsule { axis, radius }
}

/// Volume of a capsule over pi, m^3.
fn volume(capsule: &Capsule) -> f64 {
    let r = capsule.radius;
    r * r * (2.0 * capsule.axis.half_length() + 4.0 / 3.0 * r)
}

/// The corners of triangles, each once.
fn corners(surface: &[[Point3<f64>; 3]]) -> Vec<Point3<f64>> {
    let mut points: Vec<Point3<f64>> = surface.iter().flatten().copied().collect();
    let order = |a: &Point3<f64>, b: &Point3<f64>| {
        let parts = a.iter().zip(b.iter());
        parts.fold(std::cmp::Ordering::Equal, |order, (a, b)| {
            order.then(a.total_cmp(b))
        })
    };
    points.sort_unstable_by(order);
    points.dedup();
    points
}

/// Volume of capsules that may overlap, over pi, m^3: counted in a grid.
fn volume_together(capsules: &[Capsule; 2]) -> f64 {
    let [first, second] = capsules.map(|capsule| capsule.bounds());
    let around = first.joined(&second);
    let step = (around.greatest - around.least) / GRID as f64;
    let is_in = |point: &Point3<f64>| {
        let apart = |capsule: &Capsule| (capsule.axis.nearest_to_point(point) - point).norm();
        capsules.iter().any(|capsule| apart(capsule) <= capsule.radius)
    };
    let mut count = 0;
    for cell in 0..GRID * GRID * GRID {
        let place = [cell % GRID, cell / GRID % GRID, cell / GRID / GRID].map(|index| index as f64 + 0.5);
        if is_in(&(around.least + step.component_mul(&Vector3::from(place)))) {
            count += 1;
        }
    }
    f64::from(count) * step.product() / std::f64::consts::PI
}

fn enclosed(surface: Vec<[Point3<f64>; 3]>, effort: Effort) -> Option<Enclosed> {
    let capsule = fitted(&corners(&surface), effort)?;
    Some(Enclosed { capsule, surface })
}

/// The capsule around these points.
fn fitted(points: &[Point3<f64>], effort: Effort) -> Option<Capsule> {
    let mut outer = outermost(points, effort.outermost);
    let mut best = searched(&outer, points, effort)?;
    // The capsule around the outermost points alone may leave others outside: these join, one at a time.
    for _ in 0..3 {
        let inner = Capsule::around(&outer, &line_of(&best, points));
        let beyond = |point: &Point3<f64>| (inner.axis.nearest_to_point(point) - point).norm() - inner.radius;
        let farthest = points.iter().max_by(|a, b| beyond(a).total_cmp(&beyond(b)))?;
        if beyond(farthest) <= 1e-4 * inner.radius {
            break;
        }
        outer.push(*farthest);
        let next = searched(&outer, points, effort)?;
        if volume(&next) < volume(&best) {
            best = next;
        }
    }
    // Rounding must not leave a point outside.
    best.radius += 1e-9 * (1.0 + best.radius + 2.0 * best.axis.half_length());
    Some(best)
}

/// A line along the axis of a capsule; of a ball any line through its centre.
fn line_of(capsule: &Capsule, points: &[Point3<f64>]) -> Segment {
    let along = capsule.axis.to - capsule.axis.from;
    let along = if along.norm() > 0.0 {
        along.normalize()
    } else {
        principal_axes(points)[0]
    };
    Segment {
        from: capsule.axis.from,
        to: capsule.axis.from + along,
    }
}

/// The best capsule around `points`, whose axis is searched with the points `outer` alone.
fn searched(outer: &[Point3<f64>], points: &[Point3<f64>], effort: Effort) -> Option<Capsule> {
    if points.is_empty() {
        return None;
    }
    let mut directions: Vec<Vector3<f64>> = principal_axes(points).into();
    directions.extend([Vector3::x(), Vector3::y(), Vector3::z()]);
    // Directions and their opposites are the same axes.
    directions.extend((0..SPREAD).map(|index| on_sphere(index, 2 * SPREAD)));
    let mut starts: Vec<Axis> = directions
        .into_iter()
        .map(|direction| Axis::through(outer, direction))
        .collect();
    starts.sort_by(|a, b| a.volume.total_cmp(&b.volume));
    let found = starts
        .into_iter()
        .take(effort.searched)
        .map(|start| start.improved(outer, effort))
        .map(|axis| Capsule::around(points, &axis.line))
        .min_by(|a, b| volume(a).total_cmp(&volume(b)))?;
    // A ball is a capsule too, about its centre.
    let ball = about_axis(point_axis(centre_of_ball(outer)), points);
    Some(if volume(&ball) < volume(&found) {
        ball
    } else {
        found
    })
}

/// An axis with the volume of its capsule.
#[derive(Clone, Copy)]
struct Axis {
    /// A point and one a unit further.
    line: Segment,
    volume: f64,
    radius: f64,
}

impl Axis {
    fn of(points: &[Point3<f64>], line: Segment) -> Axis {
        let capsule = Capsule::around(points, &line);
        Axis {
            line,
            volume: volume(&capsule),
            radius: capsule.radius,
        }
    }

    /// Along `direction`, about the centre of the smallest circle around the points as seen along it.
    fn through(points: &[Point3<f64>], direction: Vector3<f64>) -> Axis {
        let flat = |point: &Point3<f64>| point - direction * point.coords.dot(&direction);
        let seen: Vec<Point3<f64>> = points.iter().map(flat).collect();
        let from = centre_of_ball(&seen);
        Axis::of(
            points,
            Segment {
                from,
                to: from + direction,
            },
        )
    }

    /// Tilted and shifted as long as the volume falls.
    fn improved(self, points: &[Point3<f64>], effort: Effort) -> Axis {
        let mut best = self;
        let (mut step, mut count) = (FIRST_STEP, 0);
        while step > effort.last_step {
            let along = best.line.to - best.line.from;
            let (u, v) = across(&along);
            let middle = Capsule::around(points, &best.line).axis.middle();
            let moved = |way: [f64; 4]| {
                let direction = (along + (u * way[0] + v * way[1]) * step).normalize();
                let from = middle + (u * way[2] + v * way[3]) * (step * best.radius);
                Axis::of(
                    points,
                    Segment {
                        from,
                        to: from + direction,
                    },
                )
            };
            let mut next = best;
            for way in ways(count) {
                let tried = moved(way);
                if tried.volume < next.volume {
                    next = tried;
                }
            }
            count += 1;
            if next.volume < best.volume * (1.0 - 1e-6) {
                best = next;
            } else {
                step *= 0.6;
            }
        }
        best
    }
}

/// Moves of an axis: two tilts and two shifts one by one, and together in directions that differ from turn to turn.
///
/// Where the volume has an edge, none of a fixed set of directions may lead along it.
fn ways(turn: usize) -> [[f64; 4]; 24] {
    std::array::from_fn(|index| {
        if index < 8 {
            let mut way = [0.0; 4];
            way[index / 2] = if index % 2 == 0 { 1.0 } else { -1.0 };
            return way;
        }
        let place = (16 * turn + index) as f64;
        // Fractions of multiples of irrational numbers are spread evenly (Weyl); a step of the length 1, or nearly.
        let way = [0.819_172_5, 0.671_043_6, 0.549_700_5, 0.450_305_6]
            .map(|part: f64| 2.0 * (place * part).fract() - 1.0);
        let length = way.iter().map(|part| part * part).sum::<f64>().sqrt().max(0.1);
        way.map(|part| part / length)
    })
}

/// Two directions across this one, all of length 1.
fn across(along: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
    let mut other = Vector3::zeros();
    other[along.iamin()] = 1.0;
    let u = along.cross(&other).normalize();
    (u, along.cross(&u).normalize())
}

/// A direction of `count`, spread evenly over the sphere along a spiral; the first half is one hemisphere.
fn on_sphere(index: usize, count: usize) -> Vector3<f64> {
    let height = 1.0 - (2.0 * index as f64 + 1.0) / count as f64;
    let across = (1.0 - height * height).sqrt();
    // The golden angle.
    let (sin, cos) = (index as f64 * 2.399_963_229_728_653).sin_cos();
    Vector3::new(across * cos, across * sin, height)
}

/// The outermost points in directions spread over the sphere, each once.
fn outermost(points: &[Point3<f64>], count: usize) -> Vec<Point3<f64>> {
    if points.len() <= count {
        return points.to_vec();
    }
    let farthest = |index: usize| {
        let direction = on_sphere(index, count);
        let (mut best, mut reach) = (0, f64::NEG_INFINITY);
        for (index, point) in points.iter().enumerate() {
            let along = point.coords.dot(&direction);
            if along > reach {
                (best, reach) = (index, along);
            }
        }
        best
    };
    let mut chosen: Vec<usize> = (0..count).map(farthest).collect();
    chosen.sort_unstable();
    chosen.dedup();
    chosen.into_iter().map(|index| points[index]).collect()
}

/// Centre of the smallest ball around the points, within 1 % of its radius (Badoiu & Clarkson 2003, *Smaller core-sets for balls*).
fn centre_of_ball(points: &[Point3<f64>]) -> Point3<f64> {
    let mut centre = Bounds::of(points.iter().copied()).centre();
    for turn in 1..100 {
        let apart = |point: &Point3<f64>| (point - centre).norm_squared();
        let Some(farthest) = points.iter().max_by(|a, b| apart(a).total_cmp(&apart(b))) else {
            break;
        };
        centre += (farthest - centre) / (1.0 + f64::from(turn));
    }
    centre
}

/// Principal axes of points, the longest first.
fn principal_axes(points: &[Point3<f64>]) -> [Vector3<f64>; 3] {
    let mean = points.iter().map(|point| point.coords).sum::<Vector3<f64>>() / points.len().max(1) as f64;
    let spread = points.iter().fold(Matrix3::zeros(), |sum, point| {
        let d = point.coords - mean;
        sum + d * d.transpose()
    });
    let eigen = spread.symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    order.map(|index| eigen.eigenvectors.column(index).into_owned())
}

/// The cut of a part that saves the most volume, and how much; `None` where no cut leaves two sides.
fn best_cut(part: &Enclosed) -> Option<(f64, [Enclosed; 2])> {
    let points = corners(&part.surface);
    let whole = volume(&part.capsule);
    let mut normals: Vec<Vector3<f64>> = principal_axes(&points).into();
    normals.extend([Vector3::x(), Vector3::y(), Vector3::z()]);
    let mut best: Option<(f64, [Enclosed; 2])> = None;
    for normal in normals {
        let height = |point: &Point3<f64>| point.coords.dot(&normal);
        let least = points.iter().map(height).fold(f64::INFINITY, f64::min);
        let greatest = points.iter().map(height).fold(f64::NEG_INFINITY, f64::max);
        for cut in 1..=CUTS {
            let at = least + (greatest - least) * cut as f64 / (CUTS + 1) as f64;
            let [below, above] = sides(&part.surface, &normal, at);
            let coarse = |surface| enclosed(surface, COARSE);
            let (Some(below), Some(above)) = (coarse(below), coarse(above)) else {
                continue;
            };
            let saved = whole - volume_together(&[below.capsule, above.capsule]);
            if best.as_ref().is_none_or(|best| saved > best.0) {
                best = Some((saved, [below, above]));
            }
        }
    }
    best
}

/// A surface below and above the plane at this height along its normal; triangles that it meets are cut.
fn sides(surface: &[[Point3<f64>; 3]], normal: &Vector3<f64>, at: f64) -> [Vec<[Point3<f64>; 3]>; 2] {
    let mut sides = [Vec::new(), Vec::new()];
    for triangle in surface {
        let heights = triangle.map(|corner| corner.coords.dot(normal) - at);
        for (side, sign) in sides.iter_mut().zip([-1.0, 1.0]) {
            let mut polygon: Vec<Point3<f64>> = Vec::with_capacity(4);
            for corner in 0..3 {
                let next = (corner + 1) % 3;
                let [here, there] = [heights[corner] * sign, heights[next] * sign];
                if here >= 0.0 {
                    polygon.push(triangle[corner]);
                }
                if here * there < 0.0 {
                    polygon.push(
                        triangle[corner] + (triangle[next] - triangle[corner]) * (here / (here - there)),
                    );
                }
            }
            for corner in 2..polygon.len() {
                side.push([polygon[0], polygon[corner - 1], polygon[corner]]);
            }
        }
    }
    sides
}

/// The axis of a ball.
fn point_axis(centre: Point3<f64>) -> Segment {
    Segment {
        from: centre,
        to: centre,
    }
}

#[cfg(test)]
mod tests;

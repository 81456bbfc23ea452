//! The maximum inscribed circle (MICI): the largest that contains no point, about a centre within the profile.
//!
//! `r(c) = min |p - c|`, greatest over all centres `c` within the convex hull of the points. It has many local optima:
//! any point of the nearest-point Voronoi diagram where three regions meet may be one, so every part of the hull is
//! examined or bounded. In a cell of half sides `h` about `m` no point is farther than from the farthest corner:
//!
//! ```text
//! r <= min over p of | |p - m| + h |    (by components)
//! r <= d_p + |u_p| . h + bend,          d = |p - m|, u = (p - m) / d
//! ```
//!
//! and less than a mean of two of the latter.
//!
//! The circle must touch three points around the centre; otherwise it could move out through a gap, and is refused.

use nalgebra::Vector2;

use super::RoundnessError;
use super::polar::widest_gap;
use super::reach::reach;
use super::search::{Bound, Cell, Objective, Tangent, bound_by, distance_bend, least};

/// From this open angle on there is no inscribed circle: it needs less than half a turn, and within a degree of it the
/// centre moves a hundred times as far as the points that it touches.
pub(super) const WIDEST_GAP_DEG: f64 = 179.0;
/// A point touches the circle where it is no farther out than this, in radii.
const TOUCHES: f64 = 1e-10;
/// Sides of the hull that are examined: the longest, since only they can limit the circle.
const MOST_SIDES: usize = 256;

/// Centre of the largest inscribed circle of `points`, which are about the origin at a distance of about one; and the
/// least and greatest distance of the points from it: the former is its radius.
pub(super) fn maximum_inscribed(points: &[Vector2<f64>]) -> Result<(Vector2<f64>, [f64; 2]), RoundnessError> {
    let mut clearance = Clearance {
        points,
        near: Vec::new(),
        sides: longest_sides(&hull(points)),
    };
    let half = points
        .iter()
        .fold(Vector2::zeros(), |half: Vector2<f64>, p| half.sup(&p.abs()));
    let root = Cell {
        middle: Vector2::zeros(),
        half,
    };
    let (centre, _) = least(&mut clearance, root, Vector2::zeros())?;
    let [(inner, _), (outer, _)] = reach(points, &centre);
    let touching = points
        .iter()
        .map(|p| p - centre)
        .filter(|p| p.norm() <= inner + TOUCHES);
    let directions: Vec<f64> = touching.map(|p| p.y.atan2(p.x)).collect();
    if widest_gap(&directions).width.to_degrees() >= 180.0 {
        return Err(RoundnessError::OneSided);
    }
    Ok((centre, [inner, outer]))
}

/// Negative distance of the nearest point: the objective is minimised.
struct Clearance<'a> {
    points: &'a [Vector2<f64>],
    /// Working points.
    near: Vec<Vector2<f64>>,
    sides: Vec<Side>,
}

/// A side of the hull: outside of it `normal . c > offset`.
struct Side {
    normal: Vector2<f64>,
    offset: f64,
}

impl Objective for Clearance<'_> {
    fn value(&mut self, centre: &Vector2<f64>) -> f64 {
        let [(inner, near), _] = reach(self.points, centre);
        let point = self.points[near];
        if !self.near.contains(&point) {
            self.near.push(point);
        }
        -inner
    }

    fn work(&self) -> [usize; 2] {
        [self.points.len(), 4 * self.near.len() + self.sides.len()]
    }

    fn bound(&self, cell: &Cell) -> Bound {
        let mut bound = Bound {
            least: f64::INFINITY,
            at_middle: f64::INFINITY,
            by_side: cell.half,
        };
        let mut is_inside = true;
        for side in &self.sides {
            let beyond = side.normal.dot(&cell.middle) - side.offset;
            if beyond > side.normal.abs().dot(&cell.half) {
                return bound;
            }
            is_inside &= beyond <= 0.0;
        }
        let [(nearest, index), _] = reach(&self.near, &cell.middle);
        let from_corner = |p: &Vector2<f64>| ((p - cell.middle).abs() + cell.half).norm_squared();
        bound.least = -self.near.iter().map(from_corner).fold(f64::MAX, f64::min).sqrt();
        if is_inside {
            bound.at_middle = -nearest;
        }
        if nearest > cell.half.norm() {
            let others = self.near.iter().map(|point| tangent(cell, point));
            let (least, by_side) = bound_by(tangent(cell, &self.near[index]), others, &cell.half);
            if least > bound.least {
                (bound.least, bound.by_side) = (least, by_side);
            }
        }
        bound
    }
}

/// Bound of the negative radius in a cell by a point farther away than the corners.
fn tangent(cell: &Cell, point: &Vector2<f64>) -> Tangent {
    let away = point - cell.middle;
    let distance = away.norm();
    Tangent {
        value: -distance,
        slope: away / distance,
        bend: distance_bend(&away, distance, &cell.half),
    }
}

/// The corners of the convex hull, counter-clockwise.
///
/// Source: Andrew, Another efficient algorithm for convex hulls in two dimensions, Information Processing Letters 9,
/// 1979.
fn hull(points: &[Vector2<f64>]) -> Vec<Vector2<f64>> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let half = |points: &mut dyn Iterator<Item = &Vector2<f64>>| {
        let mut corners: Vec<Vector2<f64>> = Vec::new();
        for point in points {
            while let [.., a, b] = corners[..]
                && (b - a).perp(&(point - b)) <= 0.0
            {
                corners.pop();
            }
            corners.push(*point);
        }
        corners.pop();
        corners
    };
    let mut corners = half(&mut sorted.iter());
    corners.extend(half(&mut sorted.iter().rev()));
    corners
}

fn longest_sides(corners: &[Vector2<f64>]) -> Vec<Side> {
    let next = corners.iter().cycle().skip(1);
    let mut sides: Vec<(Vector2<f64>, Vector2<f64>)> = corners.iter().copied().zip(next.copied()).collect();
    sides.sort_by(|(a, b), (c, d)| (d - c).norm_squared().total_cmp(&(b - a).norm_squared()));
    sides.truncate(MOST_SIDES);
    let side = |(a, b): (Vector2<f64>, Vector2<f64>)| {
        let along = (b - a).normalize();
        let normal = Vector2::new(along.y, -along.x);
        Side {
            offset: normal.dot(&a),
            normal,
        }
    };
    sides.into_iter().map(side).collect()
}

//! The minimum zone (MZCI): the narrowest ring between two concentric circles that contains all points.
//!
//! `w(c) = max |p - c| - min |p - c|`, least over all centres `c`. In a cell of half sides `h` about `m`, one point `f`
//! far from `m` and one `g` near it bound it from below, with `d = |p - m|` and `u = (p - m) / d`:
//!
//! ```text
//! w >= (d_f - d_g) - |u_f - u_g| . h - t^2 / (2 (d_g - |h|)),    t = |u_gy| h_x + |u_gx| h_y
//! w >= (d_f - d_g) - 2 |f - g| / (d_f + d_g - 2 |h|) |h|
//! ```
//!
//! The first is good in small cells: a distance is at least its tangent, and above it by the square of the part across;
//! a mean of two such bounds is also a bound.
//! The second is good far away, where both points have nearly the same direction.
//!
//! At the best centre four points touch, in general two of each circle or three of one and one of the other; the method
//! does not depend on which.

use nalgebra::{Point2, Vector2};

use super::RoundnessError;
use super::reach::reach;
use super::search::{Bound, Cell, Objective, Tangent, bound_by, distance_bend, least};

/// Two concentric circles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zone {
    /// Centre, m.
    pub centre: Point2<f64>,
    /// Radius of the smaller circle, m.
    pub inner: f64,
    /// Radius of the larger circle, m.
    pub outer: f64,
}

impl Zone {
    /// Peak to valley about its centre (RONt), m.
    pub fn peak_to_valley(&self) -> f64 {
        self.outer - self.inner
    }
}

/// Greatest distance of centres, in radii of the least-squares circle: beyond, circles are lines.
const FARTHEST: f64 = 1e3;

/// The narrowest zone of `points`, which are about the origin at a distance of about one.
pub(super) fn minimum_zone(points: &[Vector2<f64>]) -> Result<Zone, RoundnessError> {
    // Sides along and across the arc, if the points are one: cells can be long where the centre is least determined.
    let mean: Vector2<f64> = points.iter().sum();
    let along = mean.try_normalize(1e-3).unwrap_or(Vector2::x());
    let across = Vector2::new(-along.y, along.x);
    let turned: Vec<_> = points
        .iter()
        .map(|p| Vector2::new(p.dot(&along), p.dot(&across)))
        .collect();
    let mut width = Width {
        points: &turned,
        far: Vec::new(),
        near: Vec::new(),
    };
    let root = Cell {
        middle: Vector2::zeros(),
        half: Vector2::repeat(FARTHEST),
    };
    let (centre, _) = least(&mut width, root, Vector2::zeros())?;
    if centre.norm() > FARTHEST / 2.0 {
        return Err(RoundnessError::Straight);
    }
    let [(inner, _), (outer, _)] = reach(&turned, &centre);
    Ok(Zone {
        centre: (along * centre.x + across * centre.y).into(),
        inner,
        outer,
    })
}

/// The width of the ring about a centre.
struct Width<'a> {
    points: &'a [Vector2<f64>],
    /// Working points for the larger circle and the smaller one.
    far: Vec<Vector2<f64>>,
    near: Vec<Vector2<f64>>,
}

impl Objective for Width<'_> {
    fn value(&mut self, centre: &Vector2<f64>) -> f64 {
        let [(inner, near), (outer, far)] = reach(self.points, centre);
        for (working, index) in [(&mut self.near, near), (&mut self.far, far)] {
            let point = self.points[index];
            if !working.contains(&point) {
                working.push(point);
            }
        }
        outer - inner
    }

    fn work(&self) -> [usize; 2] {
        [self.points.len(), 4 * (self.far.len() + self.near.len())]
    }

    fn bound(&self, cell: &Cell) -> Bound {
        let [_, (far, f)] = reach(&self.far, &cell.middle);
        let [(near, g), _] = reach(&self.near, &cell.middle);
        let (f, g) = (self.far[f], self.near[g]);
        let size = cell.half.norm();
        let at_middle = far - near;

        // Far away: by the greatest possible change of the difference of the distances.
        let sum = far + near - 2.0 * size;
        let most_slope = if sum > 0.0 {
            2.0_f64.min(2.0 * (f - g).norm() / sum)
        } else {
            2.0
        };
        let mut bound = Bound {
            least: at_middle - most_slope * size,
            at_middle,
            by_side: cell.half,
        };
        // Nearby: by the slope at the middle, and the bend of the distance to the near point.
        if near > size {
            let others = self.far.iter().map(|other| tangent(cell, other, &g));
            let others = others.chain(self.near.iter().map(|other| tangent(cell, &f, other)));
            let (least, by_side) = bound_by(tangent(cell, &f, &g), others, &cell.half);
            if least > bound.least {
                (bound.least, bound.by_side) = (least, by_side);
            }
        }
        // The width is never negative: without this, all centres equally far from three points would be searched.
        bound.least = bound.least.max(0.0);
        bound
    }
}

/// Bound of the width by `f` far away and `g` near by in a cell whose middle is farther from `g` than its corners.
fn tangent(cell: &Cell, f: &Vector2<f64>, g: &Vector2<f64>) -> Tangent {
    let (to_f, to_g) = (f - cell.middle, g - cell.middle);
    let (far, near) = (to_f.norm(), to_g.norm());
    Tangent {
        value: far - near,
        slope: to_g / near - to_f / far,
        bend: distance_bend(&to_g, near, &cell.half),
    }
}

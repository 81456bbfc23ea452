//! The minimum circumscribed circle (MCCI): the smallest that encloses all points.
//!
//! Two or three points determine it. From a circle about such few, the point farthest outside joins them; the smallest
//! circle about these, by trying all of two and three, is larger than the last. Where no point is left outside it is
//! the smallest of all, since it is so for the few. Each step passes through the points once; the radius grows, so it
//! ends.
//!
//! Source: Chrystal, On the problem to construct the minimum circle enclosing n given points in the plane, Proceedings
//! of the Edinburgh Mathematical Society 3, 1885; as an exchange of the basis of a convex problem: Gartner, Fast and
//! robust smallest enclosing balls, ESA 1999 \[recalled\].

use nalgebra::{Matrix2, Vector2};

use super::reach::reach;

/// Its centre, and the least and greatest distance of the points from it: the latter is its radius.
pub(super) fn minimum_circumscribed(points: &[Vector2<f64>]) -> (Vector2<f64>, [f64; 2]) {
    let [_, (_, first)] = reach(points, &Vector2::zeros());
    let (mut supports, mut centre, mut radius) = (vec![points[first]], points[first], 0.0);
    loop {
        let [(inner, _), (outer, farthest)] = reach(points, &centre);
        let point = points[farthest];
        // A point that is already on the circle is outside only by rounding.
        let larger = (outer > radius && !supports.contains(&point))
            .then(|| smallest_about(&supports, point))
            .flatten()
            .filter(|larger| larger.radius > radius);
        match larger {
            None => return (centre, [inner, outer]),
            Some(larger) => (supports, centre, radius) = (larger.supports, larger.centre, larger.radius),
        }
    }
}

/// A circle through two or three points.
struct EnclosingCircle {
    supports: Vec<Vector2<f64>>,
    centre: Vector2<f64>,
    /// Of the least circle about this centre that encloses all given points.
    radius: f64,
}

/// The smallest circle about `supports` and `point`, which is on it.
fn smallest_about(supports: &[Vector2<f64>], point: Vector2<f64>) -> Option<EnclosingCircle> {
    let two = supports.iter().map(|a| vec![point, *a]);
    let pairs = (0..supports.len()).flat_map(|i| (0..i).map(move |j| [i, j]));
    let three = pairs.map(|[i, j]| vec![point, supports[i], supports[j]]);
    let about = |few: Vec<Vector2<f64>>| {
        let centre = match few[..] {
            [a, b] => (a + b) / 2.0,
            _ => circumcentre(few[0], few[1], few[2])?,
        };
        let all = supports.iter().chain([&point]);
        let radius = all.map(|p| (p - centre).norm()).fold(0.0, f64::max);
        radius.is_finite().then_some(EnclosingCircle {
            supports: few,
            centre,
            radius,
        })
    };
    two.chain(three)
        .filter_map(about)
        .min_by(|a, b| a.radius.total_cmp(&b.radius))
}

/// The point as far from all three; `None` where they are on a line.
fn circumcentre(a: Vector2<f64>, b: Vector2<f64>, c: Vector2<f64>) -> Option<Vector2<f64>> {
    let (b, c) = (b - a, c - a);
    let sides = Matrix2::from_rows(&[b.transpose(), c.transpose()]);
    let halves = Vector2::new(b.norm_squared(), c.norm_squared()) / 2.0;
    Some(a + sides.try_inverse()? * halves)
}

//! A path that is passed several times, forth and back, in one record of points: divided at rests.
//!
//! ```text
//! rest   REST_POINTS points in a row within REST_RADIUS of the first of them
//! pass   the points between two rests
//! back   a pass whose ends are nearer to the ends of the first one in the other order
//! ```
//!
//! No times are needed: trackers give stamps when they store points.

use nalgebra::Vector3;

/// Points in a row of a rest, at least.
pub const REST_POINTS: usize = 100;
/// Largest distance of a rest from its first point, m.
pub const REST_RADIUS: f64 = 5e-5;
/// Shortest pass, m.
const SHORTEST: f64 = 1e-3;

/// The passes of a record, points in m.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Passes {
    /// In the direction of the first one.
    pub forth: Vec<Vec<Vector3<f64>>>,
    /// In the other direction, in the order of time.
    pub back: Vec<Vec<Vector3<f64>>>,
}

impl Passes {
    /// The passes between the rests of a record, of the first and of the last rest too; a record without a rest is one pass.
    pub fn of(points: &[Vector3<f64>]) -> Passes {
        let rests = rests(points);
        let mut ends = vec![0];
        ends.extend(rests.iter().flat_map(|rest| [rest.start, rest.end]));
        ends.push(points.len());
        let mut passes = Passes::default();
        for pair in ends.chunks(2) {
            // With the last point of the rest before, and the first of the rest after.
            let pass = &points[pair[0].saturating_sub(1)..(pair[1] + 1).min(points.len())];
            passes.take(pass);
        }
        passes
    }

    /// Adds the passes of another record of the same path.
    pub fn extend(&mut self, other: Passes) {
        for pass in other.forth.iter().chain(&other.back) {
            self.take(pass);
        }
    }

    fn take(&mut self, pass: &[Vector3<f64>]) {
        let (Some(start), Some(end)) = (pass.first(), pass.last()) else {
            return;
        };
        let farthest = pass.iter().map(|at| (at - start).norm()).fold(0.0, f64::max);
        if farthest < SHORTEST {
            return;
        }
        let is_back = self.forth.first().is_some_and(|first| {
            let [from, to] = [first[0], first[first.len() - 1]];
            (start - to).norm() + (end - from).norm() < (start - from).norm() + (end - to).norm()
        });
        let direction = if is_back { &mut self.back } else { &mut self.forth };
        direction.push(pass.to_vec());
    }
}

/// The rests of a record, in order.
fn rests(points: &[Vector3<f64>]) -> Vec<std::ops::Range<usize>> {
    let is_near = |from: usize, to: usize| (points[to] - points[from]).norm() <= REST_RADIUS;
    let mut rests: Vec<std::ops::Range<usize>> = Vec::new();
    let mut begin = 0;
    while begin + REST_POINTS <= points.len() {
        let window = begin..begin + REST_POINTS;
        // The middle and the end decide of most.
        let may_rest = is_near(begin, begin + REST_POINTS / 2) && is_near(begin, begin + REST_POINTS - 1);
        if !may_rest || !window.clone().all(|k| is_near(begin, k)) {
            begin += 1;
            continue;
        }
        let end = (window.end..points.len())
            .find(|k| !is_near(begin, *k))
            .unwrap_or(points.len());
        match rests.last_mut().filter(|last| last.end == begin) {
            Some(last) => last.end = end,
            None => rests.push(begin..end),
        }
        begin = end;
    }
    rests
}

/// The path through these points by `count` points at even distances along it; the points themselves where it has no length.
pub fn evenly(points: &[Vector3<f64>], count: usize) -> Vec<Vector3<f64>> {
    let mut along = vec![0.0];
    for pair in points.windows(2) {
        along.push(along[along.len() - 1] + (pair[1] - pair[0]).norm());
    }
    let length = along[along.len() - 1];
    if points.len() < 2 || length <= 0.0 || count < 2 {
        return points.to_vec();
    }
    let at = |k: usize| {
        let way = length * k as f64 / (count - 1) as f64;
        let next = along.partition_point(|at| *at <= way).clamp(1, along.len() - 1);
        let step = along[next] - along[next - 1];
        let part = if step > 0.0 {
            (way - along[next - 1]) / step
        } else {
            0.0
        };
        points[next - 1].lerp(&points[next], part.clamp(0.0, 1.0))
    };
    (0..count).map(at).collect()
}

/// Distance of a point from the path through these points, m; infinite without points.
pub fn distance_from(at: &Vector3<f64>, path: &[Vector3<f64>]) -> f64 {
    let of_piece = |ends: &[Vector3<f64>]| {
        let way = ends[1] - ends[0];
        let squared = way.norm_squared();
        let part = if squared > 0.0 {
            (at - ends[0]).dot(&way) / squared
        } else {
            0.0
        };
        (at - (ends[0] + way * part.clamp(0.0, 1.0))).norm()
    };
    match path {
        [one] => (at - one).norm(),
        path => path.windows(2).map(of_piece).fold(f64::INFINITY, f64::min),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Forth and back along 0.3 m, twice, with rests and a noise of 2 um.
    fn record() -> Vec<Vector3<f64>> {
        let mut points = Vec::new();
        let noise = |k: usize| 2e-6 * ((k * 7919 % 101) as f64 / 50.0 - 1.0);
        let mut take = |x: f64, y: f64| {
            let k = points.len();
            points.push(Vector3::new(x + noise(k), y + noise(k + 3), noise(k + 5)));
        };
        for turn in 0..4 {
            (0..250).for_each(|_| take(if turn % 2 == 0 { 0.0 } else { 0.3 }, 0.0));
            for k in 1..1500 {
                let s = f64::from(k) / 1500.0;
                let x = 0.3 * if turn % 2 == 0 { s } else { 1.0 - s };
                take(x, if turn % 2 == 0 { 0.0 } else { 4e-5 });
            }
        }
        (0..250).for_each(|_| take(0.0, 0.0));
        points
    }

    #[test]
    fn a_record_is_divided_at_rests_into_passes_forth_and_back() {
        let passes = Passes::of(&record());
        assert_eq!((passes.forth.len(), passes.back.len()), (2, 2));
        for pass in passes.forth.iter().chain(&passes.back) {
            assert!((1450..=1501).contains(&pass.len()), "{}", pass.len());
        }
        assert!(passes.forth[1][0].x < 0.001 && passes.back[1][0].x > 0.299);
        // Without a rest it is one pass.
        let line: Vec<Vector3<f64>> = (0..90)
            .map(|k| Vector3::new(f64::from(k) * 1e-3, 0.0, 0.0))
            .collect();
        assert_eq!(Passes::of(&line).forth, std::slice::from_ref(&line));
        assert_eq!(Passes::of(&[]), Passes::default());
    }

    #[test]
    fn even_points_are_on_the_path_and_distances_are_across_it() {
        let corner = [[0.0, 0.0], [0.3, 0.0], [0.3, 0.1]].map(|[x, y]| Vector3::new(x, y, 0.0));
        let even = evenly(&corner, 5);
        assert!((even[3] - corner[1]).norm() < 1e-15 && (even[1].x - 0.1).abs() < 1e-15);
        assert!((distance_from(&Vector3::new(0.2, 0.02, 0.0), &corner) - 0.02).abs() < 1e-15);
        assert!((distance_from(&Vector3::new(0.3, 0.14, 0.03), &corner) - 0.05).abs() < 1e-15);
        assert_eq!(distance_from(&corner[0], &[]), f64::INFINITY);
    }
}

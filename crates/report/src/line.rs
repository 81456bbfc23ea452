//! Lines of points on the picture, in pixels: simplified without visible change, and measured by arc length.
//!
//! Leaving out points keeps files small: a level line has a point for every cell of a fine lattice, far closer
//! than a picture shows. Labels need the arc length, to be a chosen number of pixels from the start.

use crate::svg::Point;

/// Largest distance of an omitted point from the line drawn: at 0.25 the corners of a thick line are visible in print.
const SEEN_PX: f64 = 0.1;

/// A line without the points that make no visible difference: each kept point is joined to the farthest one for which
/// all points between are in a cone about the line. The first and the last point stay. No point that is left
/// out is farther than 0.1 px from the line drawn; a line that turns back is kept at its turn.
pub(crate) fn without_straight(line: &[Point]) -> Vec<Point> {
    let mut kept: Vec<Point> = line.first().copied().into_iter().collect();
    let mut cone: Option<(f64, f64)> = None;
    for pair in line.windows(2) {
        let Some(&[x, y]) = kept.last() else { break };
        let [dx, dy] = [pair[1][0] - x, pair[1][1] - y];
        let distance = dx.hypot(dy);
        if distance <= SEEN_PX {
            continue;
        }
        // The directions from the kept point that pass this one within what is seen.
        let (towards, half) = (dy.atan2(dx), (SEEN_PX / distance).asin());
        cone = match cone {
            None => Some((towards - half, towards + half)),
            Some((low, high)) => {
                // The same direction, compared near the middle of the cone.
                let turns = ((0.5 * (low + high) - towards) / std::f64::consts::TAU).round();
                let towards = towards + turns * std::f64::consts::TAU;
                let back = [pair[0][0] - x, pair[0][1] - y];
                let goes_on = back[0].hypot(back[1]) <= distance;
                if goes_on && towards >= low && towards <= high {
                    Some((low.max(towards - half), high.min(towards + half)))
                } else {
                    kept.push(pair[0]);
                    let [dx, dy] = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
                    let distance = dx.hypot(dy).max(SEEN_PX);
                    let (towards, half) = (dy.atan2(dx), (SEEN_PX / distance).asin());
                    Some((towards - half, towards + half))
                }
            }
        };
    }
    kept.extend(line.last().copied().filter(|_| line.len() > 1));
    kept
}

/// Points at most 3 px apart along a line, as obstacles for labels; those that are not finite are left out.
pub(crate) fn points_along(line: &[Point]) -> Vec<Point> {
    const EVERY_PX: f64 = 3.0;
    let mut points = Vec::new();
    for w in line.windows(2) {
        let length = (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1]);
        // Far more than fit on a picture: the line runs out of it.
        let count = (length / EVERY_PX).ceil().clamp(1.0, 2000.0) as usize;
        points.extend((0..=count).map(|k| {
            let t = k as f64 / count as f64;
            [
                w[0][0] + (w[1][0] - w[0][0]) * t,
                w[0][1] + (w[1][1] - w[0][1]) * t,
            ]
        }));
    }
    points.retain(|p| p[0].is_finite() && p[1].is_finite());
    points
}

/// A line with the arc length from its start to each of its points, so that a place can be found by its arc length.
pub(crate) struct Stations<'a> {
    /// The corners of the line, as given.
    pub(crate) points: &'a [Point],
    /// From the first point along the line to each, px.
    way: Vec<f64>,
    /// Of the whole line, px.
    pub(crate) length: f64,
}

impl<'a> Stations<'a> {
    /// Measures the line, which may have one point or none: its length is 0 then.
    pub(crate) fn along(points: &'a [Point]) -> Self {
        let mut way = Vec::with_capacity(points.len());
        let mut length = 0.0;
        for (k, p) in points.iter().enumerate() {
            if k > 0 {
                length += (p[0] - points[k - 1][0]).hypot(p[1] - points[k - 1][1]);
            }
            way.push(length);
        }
        Self { points, way, length }
    }

    /// The point `s` px from the start; beyond the ends the nearer end. Not checked: that there are two points.
    pub(crate) fn at(&self, s: f64) -> Point {
        let k = self
            .way
            .partition_point(|w| *w < s)
            .clamp(1, self.points.len() - 1);
        let (a, b) = (self.points[k - 1], self.points[k]);
        let span = self.way[k] - self.way[k - 1];
        let t = if span > 0.0 {
            ((s - self.way[k - 1]) / span).clamp(0.0, 1.0)
        } else {
            0.0
        };
        [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_on_a_straight_line_are_left_out_and_corners_are_kept() {
        let there: Vec<Point> = (0..=1000).map(|i| [f64::from(i), 0.0]).collect();
        let up: Vec<Point> = (1..=1000).map(|i| [1000.0, f64::from(i)]).collect();
        let corner = without_straight(&[there.clone(), up].concat());
        assert_eq!(corner, [[0.0, 0.0], [1000.0, 0.0], [1000.0, 1000.0]]);
        // There and back again: the turning point stays.
        let back: Vec<Point> = there.iter().rev().copied().collect();
        let both = without_straight(&[there, back].concat());
        assert!(both.contains(&[1000.0, 0.0]) && both.len() <= 4, "{both:?}");
    }

    #[test]
    fn clips_a_curve_to_the_visible_range() {
        let on = |i: u32| {
            let phi = f64::from(i) * 1e-3;
            [300.0 * phi.cos(), 300.0 * phi.sin()]
        };
        let line: Vec<Point> = (0..6000).map(on).collect();
        let kept = without_straight(&line);
        assert!(kept.len() < 200, "{}", kept.len());
        for pair in kept.windows(2) {
            let middle = [0.5 * (pair[0][0] + pair[1][0]), 0.5 * (pair[0][1] + pair[1][1])];
            assert!(300.0 - middle[0].hypot(middle[1]) < 2.0 * SEEN_PX);
        }
    }

    #[test]
    fn a_station_is_found_by_its_way_from_the_start() {
        let corner = [[0.0, 0.0], [10.0, 0.0], [10.0, 30.0]];
        let line = Stations::along(&corner);
        assert!((line.length - 40.0).abs() < 1e-12);
        assert_eq!(line.at(4.0), [4.0, 0.0]);
        assert_eq!(line.at(25.0), [10.0, 15.0]);
        assert_eq!([line.at(-1.0), line.at(99.0)], [corner[0], corner[2]]);
    }
}

//! Corners that are rounded: the path that a controller makes of the ends of moves with zones.
//!
//! ```text
//! P(w) = C + (B(r b(1 - w)) - C) + (A(r b(w)) - C),    q(w) = q_C + (q_B - q_C) + (q_A - q_C),    0 <= w <= 1
//! b(w) = (w^2 + w^3 (2 - w)) / 2
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `C` | programmed corner | m |
//! | `B(d)`, `A(d)` | programmed path at the distance `d` before and after the corner | m |
//! | `r` | radius of the zone, at most half of the move before and of the move after it | m |
//! | `q` | joint positions at the corner and at these points | rad (m) |
//!
//! Between lines it is a curve tangent to both, in its middle `7/32 r |d2 - d1| = 7/16 r sin(a/2)` from a corner of the angle `a`: the mean of a parabola (`b = w^2`, 1/4 `r |d2 - d1|`) and of
//! the quartic that has no curvature at its ends (`b = w^3 (2 - w)`, 3/16). The joint positions neglect terms of the order `r^2` over the reach: some micrometres for a zone of 10 mm.
//!
//! Source: blending by polynomials, as in Biagiotti and Melchiorri 2008 (recalled). Controllers do not publish theirs: the mean is as near to logs of an ABB IRB 6640 at 50 mm/s as one curve can be
//! (`validation/irb6640-logs`: 0.113 `r` of the virtual controller, 0.10 `r` of the real one, at a corner of 30 deg; parabola 0.129, quartic 0.097, mean 0.113).

use std::ops::Range;

use nalgebra::{Point3, Vector3};

/// Pieces of a rounded corner that turns by more than each of these angles, rad; even.
const PIECES: [(f64, usize); 3] = [(0.4, 8), (0.1, 4), (0.0, 2)];
/// Step of the parameter of a zone for the direction there.
const NEAR: f64 = 1e-4;
/// Distance of the first point next to a stop or a zone, m.
const FINEST: f64 = 1e-5;
/// A zone smaller than this is none, m.
const NO_ZONE: f64 = 1e-9;

/// A programmed path from a stop to a stop.
#[derive(Clone, Copy, Debug)]
pub struct Programmed<'a> {
    /// Its points, m, two or more, no two in a row alike.
    pub points: &'a [Point3<f64>],
    /// Joint positions at its points, rad (m), point after point.
    pub positions: &'a [f64],
    /// Speed on the step after each point, m/s.
    pub feeds: &'a [f64],
    /// Radius of the zone at the ends of its moves, m, in order: index of the point, and radius.
    pub zones: &'a [(usize, f64)],
}

/// The path with rounded corners.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rounded {
    /// Its points, m.
    pub points: Vec<Point3<f64>>,
    /// Length up to each, m.
    pub along: Vec<f64>,
    /// Joint positions at each, rad (m), point after point.
    pub positions: Vec<f64>,
    /// Speed on the step after each, m/s, one fewer.
    pub feeds: Vec<f64>,
    /// Where it passes each programmed point, m along it.
    pub passes: Vec<f64>,
    /// Distance of the path from each programmed point, m.
    pub errors: Vec<Vector3<f64>>,
    /// The steps of each zone, by the points at their beginnings, in order.
    zones: Vec<Range<usize>>,
}

/// A zone within the path.
#[derive(Clone, Copy, Debug)]
struct Zone {
    corner: usize,
    radius: f64,
    pieces: usize,
}

impl Programmed<'_> {
    /// The path with rounded corners, and with points ever nearer to each other towards stops and zones, where speeds change.
    ///
    /// # Panics
    /// If there are fewer than two points, or the numbers of values do not belong together.
    pub fn rounded(&self) -> Rounded {
        let count = self.points.len();
        assert!(
            count >= 2 && self.feeds.len() + 1 == count,
            "a feed for every step"
        );
        let mut lengths = Vec::with_capacity(count);
        lengths.push(0.0);
        for pair in self.points.windows(2) {
            lengths.push(lengths[lengths.len() - 1] + (pair[1] - pair[0]).norm());
        }
        let zones = self.zones_that_fit(&lengths);
        let mut path = Rounded::default();
        let mut next = 0;
        for zone in zones {
            let [begin, end] = [-1.0, 1.0].map(|sign| lengths[zone.corner] + sign * zone.radius);
            while lengths[next] <= begin - NO_ZONE {
                self.keep(next, &mut path);
                next += 1;
            }
            let first = self.round(zone, &lengths, &mut path);
            while next < count && lengths[next] < end + NO_ZONE {
                let w = 0.5 * (1.0 + (lengths[next] - lengths[zone.corner]) / zone.radius);
                let w = w.clamp(0.0, 1.0);
                path.pass_within(first, zone.pieces, w);
                path.errors.push(self.error_within(zone, next, w, &lengths));
                next += 1;
            }
        }
        for index in next..count {
            self.keep(index, &mut path);
        }
        path.feeds.truncate(path.points.len() - 1);
        path.graded()
    }

    /// The zones, each at most half of the moves next to it.
    fn zones_that_fit(&self, lengths: &[f64]) -> Vec<Zone> {
        let last = lengths.len() - 1;
        let place = |at: Option<&(usize, f64)>, otherwise: usize| lengths[at.map_or(otherwise, |at| at.0)];
        let fitting = self.zones.iter().enumerate().filter_map(|(k, (corner, radius))| {
            let before = lengths[*corner] - place(k.checked_sub(1).map(|k| &self.zones[k]), 0);
            let after = place(self.zones.get(k + 1), last) - lengths[*corner];
            let radius = radius.min(0.5 * before).min(0.5 * after);
            (radius > NO_ZONE).then(|| Zone {
                corner: *corner,
                radius,
                pieces: self.pieces(*corner),
            })
        });
        fitting.collect()
    }

    /// Pieces of a rounded corner at a programmed point: more, the more the path turns there.
    fn pieces(&self, corner: usize) -> usize {
        let [before, at, after] = [0, 1, 2].map(|k| self.points[corner + k - 1]);
        let turn = (at - before).angle(&(after - at));
        PIECES
            .into_iter()
            .find(|(least, _)| turn > *least)
            .map_or(2, |(_, pieces)| pieces)
    }

    /// A programmed point that the path passes.
    fn keep(&self, index: usize, path: &mut Rounded) {
        let joints = self.joints();
        path.add(self.points[index], &self.positions[index * joints..][..joints]);
        path.feeds.push(self.feeds.get(index).copied().unwrap_or(0.0));
        path.passes.push(path.along[path.along.len() - 1]);
        path.errors.push(Vector3::zeros());
    }

    /// The points of a rounded corner; the index of the first of them in the path.
    fn round(&self, zone: Zone, lengths: &[f64], path: &mut Rounded) -> usize {
        let joints = self.joints();
        let corner = &self.positions[zone.corner * joints..][..joints];
        let mut positions = vec![0.0; joints];
        // Where the zone before ends there, its last point is the first of this one.
        let begin = lengths[zone.corner] - zone.radius;
        let is_there = path.along.last().is_some()
            && (self.at(begin, lengths).0 - path.points[path.points.len() - 1]).norm() < NO_ZONE;
        let first = path.points.len() - usize::from(is_there);
        for piece in usize::from(is_there)..=zone.pieces {
            let w = piece as f64 / zone.pieces as f64;
            let [before, after] =
                ways(zone.radius, w).map(|way| self.at(lengths[zone.corner] + way, lengths));
            for (joint, position) in positions.iter_mut().enumerate() {
                let [before, after] = [before, after].map(|(_, step, part)| self.joint(joint, step, part));
                *position = before + after - corner[joint];
            }
            path.add(before.0 + (after.0 - self.points[zone.corner]), &positions);
            let step = if w < 0.5 { zone.corner - 1 } else { zone.corner };
            path.feeds.push(if piece < zone.pieces {
                self.feeds[step]
            } else {
                self.feeds[after.1.min(self.feeds.len() - 1)]
            });
        }
        path.zones.push(first..path.points.len() - 1);
        first
    }

    /// Distance from a programmed point to the path at the parameter `w` of the zone that the point is in, across the path, m.
    fn error_within(&self, zone: Zone, index: usize, w: f64, lengths: &[f64]) -> Vector3<f64> {
        let at = |w: f64| {
            let [before, after] =
                ways(zone.radius, w).map(|way| self.at(lengths[zone.corner] + way, lengths).0);
            before + (after - self.points[zone.corner])
        };
        let tangent = at((w + NEAR).min(1.0)) - at((w - NEAR).max(0.0));
        let error = at(w) - self.points[index];
        let along = tangent
            .try_normalize(0.0)
            .map_or(Vector3::zeros(), |tangent| tangent * tangent.dot(&error));
        error - along
    }

    /// The programmed path at a length: its point, the step that the point is on, and the part of the step before it.
    fn at(&self, length: f64, lengths: &[f64]) -> (Point3<f64>, usize, f64) {
        let step = lengths
            .partition_point(|at| *at <= length)
            .clamp(1, lengths.len() - 1)
            - 1;
        let part = (length - lengths[step]) / (lengths[step + 1] - lengths[step]);
        let [from, to] = [self.points[step], self.points[step + 1]];
        (from + (to - from) * part, step, part)
    }

    fn joint(&self, joint: usize, step: usize, part: f64) -> f64 {
        let joints = self.joints();
        let [from, to] = [step, step + 1].map(|index| self.positions[index * joints + joint]);
        from + part * (to - from)
    }

    fn joints(&self) -> usize {
        self.positions.len() / self.points.len()
    }
}

/// Distances from the beginning of a step of this length at which it gets points, m: dense towards its ends that are anchors.
fn grades(length: f64, [begin, end]: [bool; 2]) -> Vec<f64> {
    let reach = if begin && end { 0.5 * length } else { length };
    let mut ways = Vec::new();
    let mut way = FINEST;
    while way < 0.7 * reach {
        if begin {
            ways.push(way);
        }
        if end {
            ways.push(length - way);
        }
        way *= 2.0;
    }
    ways.sort_by(f64::total_cmp);
    ways
}

/// The way `b(w)` of a rounded corner.
fn blend(w: f64) -> f64 {
    0.5 * w * w * (1.0 + w * (2.0 - w))
}

/// Way from the corner of the two points whose sum is the point with the parameter `w`, m, the one before it negative.
fn ways(radius: f64, w: f64) -> [f64; 2] {
    [-radius * blend(1.0 - w), radius * blend(w)]
}

impl Rounded {
    /// The same path with more points next to its ends and to those of zones, each twice as far from there as the one before.
    fn graded(mut self) -> Rounded {
        let last = self.points.len() - 1;
        let mut graded = Rounded {
            passes: std::mem::take(&mut self.passes),
            errors: std::mem::take(&mut self.errors),
            ..Rounded::default()
        };
        let joints = self.positions.len() / self.points.len();
        let at = |index: usize| &self.positions[index * joints..][..joints];
        let zone = |index: usize| {
            let next = self.zones.partition_point(|zone| zone.end <= index);
            self.zones
                .get(next)
                .filter(|zone| zone.contains(&index))
                .is_some()
        };
        let is_anchor = |index: usize| index == 0 || index == last || zone(index) || zone(index - 1);
        let mut between = vec![0.0; joints];
        for index in 0..=last {
            graded.add_at(self.along[index], self.points[index], at(index));
            if index == last {
                break;
            }
            graded.feeds.push(self.feeds[index]);
            if zone(index) {
                continue;
            }
            let length = self.along[index + 1] - self.along[index];
            for way in grades(length, [is_anchor(index), is_anchor(index + 1)]) {
                let part = way / length;
                for ((between, from), to) in between.iter_mut().zip(at(index)).zip(at(index + 1)) {
                    *between = from + part * (to - from);
                }
                let point = self.points[index] + (self.points[index + 1] - self.points[index]) * part;
                graded.add_at(self.along[index] + way, point, &between);
                graded.feeds.push(self.feeds[index]);
            }
        }
        graded
    }

    fn add_at(&mut self, along: f64, at: Point3<f64>, positions: &[f64]) {
        self.along.push(along);
        self.points.push(at);
        self.positions.extend_from_slice(positions);
    }

    /// Passes a programmed point at the parameter `w` of the zone of these pieces, whose first point has this index.
    fn pass_within(&mut self, first: usize, pieces: usize, w: f64) {
        let place = w * pieces as f64;
        let piece = (place.floor() as usize).min(pieces - 1);
        let [from, to] = [piece, piece + 1].map(|piece| self.along[first + piece]);
        self.passes.push(from + (place - piece as f64) * (to - from));
    }

    fn add(&mut self, at: Point3<f64>, positions: &[f64]) {
        let before = self.points.last().zip(self.along.last());
        self.along
            .push(before.map_or(0.0, |(last, along)| along + (at - last).norm()));
        self.points.push(at);
        self.positions.extend_from_slice(positions);
    }
}

#[cfg(test)]
mod tests;

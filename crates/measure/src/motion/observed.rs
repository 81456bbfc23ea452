//! A stretch of straight moves as it was logged: the tip, its speed, and how it passes the corners.

use armill_core::nalgebra::{Point3, Vector3};
use armill_formats::measurement::joint_log::JointLog;

use super::course::{Course, MovePart};
use super::derivative::Differentiator;
use super::line::Line;
use super::stretches::{HALF_WINDOW, Stretch};

/// A corner whose least speed is below this part of the feed is a stop.
const STOP: f64 = 0.2;
/// The least speed of a corner is sought within this distance from it, m, or this part of the shorter move.
const NEAR: (f64, f64) = (0.05, 0.3);
/// A motion begins when the tip has left its start by this, m, and ends when it is this near to its end.
pub(super) const LEFT: f64 = 1e-3;
/// Speeds above this part of the 90th percentile are those at the feed.
const AT_FEED: f64 = 0.8;

/// A corner as it was passed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassedCorner {
    /// Angle by which the path turns, rad.
    pub turn: f64,
    /// Least speed of the tip near it, m/s.
    pub least_speed: f64,
    /// Least distance of the tip from it, m.
    pub closest: f64,
    /// Standard uncertainty of that distance, m: distance of the moves next to it from their lines.
    pub closest_u: f64,
    /// Whether the tip stops there.
    pub is_stop: bool,
}

/// A stretch as it was logged.
#[derive(Clone, Debug)]
pub(super) struct Observed {
    /// s, from the first instant of the log.
    pub times: Vec<f64>,
    /// The tip, m.
    pub tips: Vec<Point3<f64>>,
    /// Its speed, m/s.
    pub speeds: Vec<f64>,
    /// Largest acceleration along the path, m/s^2.
    pub acceleration: f64,
    /// Speed that it has most of the time, m/s.
    pub feed: f64,
    /// The programmed path.
    pub course: Course,
    /// Its corners.
    pub corners: Vec<PassedCorner>,
    by_time: Differentiator,
}

impl Observed {
    /// A stretch; `None` unless it is complete and of straight moves. `tips` are those of the whole log.
    pub(super) fn of(
        log: &JointLog,
        stretch: &Stretch,
        parts: &[MovePart],
        tips: &[Point3<f64>],
    ) -> Option<Observed> {
        if !stretch.is_complete || stretch.is_joint_move {
            return None;
        }
        let course = Course::of(parts, &stretch.range, &log.positions, tips)?;
        let times = log.times[stretch.range.clone()].to_vec();
        let by_time = Differentiator::new(&times, HALF_WINDOW * log.usual_step());
        let tips = tips[stretch.range.clone()].to_vec();
        let speeds = speeds(&by_time, &tips);
        let mut found = Observed {
            feed: feed(&speeds)?,
            acceleration: largest_of_three(&by_time.slopes(&speeds, 1)),
            times,
            tips,
            speeds,
            course,
            corners: Vec::new(),
            by_time,
        };
        found.corners = (1..found.course.vertices.len() - 1)
            .map(|vertex| found.corner(vertex, parts, stretch.range.start))
            .collect();
        Some(found)
    }

    /// Whether it stops at all of its corners.
    pub(super) fn stops_only(&self) -> bool {
        self.corners.iter().all(|corner| corner.is_stop)
    }

    /// The speed of tips at the instants of this stretch, m/s, as that of the log is determined.
    pub(super) fn speeds_of(&self, tips: &[Point3<f64>]) -> Vec<f64> {
        speeds(&self.by_time, tips)
    }

    /// Time from the start to the end, s.
    pub(super) fn cycle(&self) -> Option<f64> {
        cycle(&self.times, &self.tips, &self.course)
    }

    /// Largest distance of tips from the lines, m, as the median of three neighbours, away from corners that are passed.
    pub(super) fn off_line(&self, tips: &[Point3<f64>]) -> f64 {
        let vertices = &self.course.vertices;
        let passed: Vec<Point3<f64>> = (self.corners.iter().zip(&vertices[1..]))
            .filter(|(corner, _)| !corner.is_stop)
            .map(|(_, at)| *at)
            .collect();
        let away = tips
            .iter()
            .filter(|tip| passed.iter().all(|at| (*tip - at).norm() > NEAR.0));
        let distances: Vec<f64> = away.map(|tip| closest(vertices, tip)).collect();
        largest_of_three(&distances)
    }

    fn corner(&self, vertex: usize, parts: &[MovePart], first: usize) -> PassedCorner {
        let [before, at, after] = [0, 1, 2].map(|k| self.course.vertices[vertex + k - 1]);
        let shorter = (at - before).norm().min((after - at).norm());
        let near = NEAR.0.min(NEAR.1 * shorter);
        let here = self.tips.iter().zip(&self.speeds);
        let least_speed = here
            .filter(|(tip, _)| (**tip - at).norm() < near)
            .map(|(_, speed)| *speed)
            .fold(f64::INFINITY, f64::min);
        let scatter = parts[vertex - 1..=vertex].iter().map(|part| {
            let count = part.range.len();
            let middle = part.range.start + count / 5..part.range.end - count / 5;
            let middle = &self.tips[middle.start - first..middle.end - first];
            Line::through(middle).map_or(0.0, |line| {
                let squares: f64 = middle.iter().map(|tip| line.offset(tip).norm_squared()).sum();
                (squares / middle.len() as f64).sqrt()
            })
        });
        PassedCorner {
            turn: (at - before).angle(&(after - at)),
            least_speed,
            closest: closest(&self.tips, &at),
            closest_u: scatter.fold(0.0, f64::max),
            is_stop: least_speed < STOP * self.feed,
        }
    }
}

/// Least distance of a path from a point, m.
pub(super) fn closest(tips: &[Point3<f64>], at: &Point3<f64>) -> f64 {
    let of_step = |pair: &[Point3<f64>]| {
        let (way, offset) = (pair[1] - pair[0], at - pair[0]);
        let part = offset.dot(&way) / way.norm_squared().max(f64::MIN_POSITIVE);
        (offset - way * part.clamp(0.0, 1.0)).norm()
    };
    tips.windows(2).map(of_step).fold(f64::INFINITY, f64::min)
}

/// Time from the start of a course to its end, s; `None` if the tip does not arrive.
pub(super) fn cycle(times: &[f64], tips: &[Point3<f64>], course: &Course) -> Option<f64> {
    let (start, end) = (course.vertices.first()?, course.vertices.last()?);
    // Where the distance crosses `LEFT`, evenly between two instants.
    let crossing = |distance: &dyn Fn(usize) -> f64, k: usize| {
        let (a, b) = (distance(k - 1), distance(k));
        times[k - 1] + (times[k] - times[k - 1]) * ((LEFT - a) / (b - a)).clamp(0.0, 1.0)
    };
    let from = |k: usize| (tips[k] - start).norm();
    let to = |k: usize| (tips[k] - end).norm();
    let begin = (1..tips.len()).find(|k| from(*k) > LEFT)?;
    let finish = (begin..tips.len())
        .rev()
        .find(|k| to(*k - 1) > LEFT && to(*k) <= LEFT)?;
    Some(crossing(&to, finish) - crossing(&from, begin))
}

fn speeds(by_time: &Differentiator, tips: &[Point3<f64>]) -> Vec<f64> {
    let flat: Vec<f64> = tips.iter().flat_map(|tip| [tip.x, tip.y, tip.z]).collect();
    let slopes = by_time.slopes(&flat, 3);
    slopes
        .chunks_exact(3)
        .map(|v| Vector3::new(v[0], v[1], v[2]).norm())
        .collect()
}

fn feed(speeds: &[f64]) -> Option<f64> {
    let mut sorted = speeds.to_vec();
    sorted.sort_by(f64::total_cmp);
    let high = *sorted.get(sorted.len() * 9 / 10)?;
    let at_feed = &sorted[sorted.partition_point(|speed| *speed < AT_FEED * high)..];
    at_feed.get(at_feed.len() / 2).copied().filter(|feed| *feed > 0.0)
}

/// The largest amount of values, as the median of three neighbours.
pub(super) fn largest_of_three(values: &[f64]) -> f64 {
    let medians = values.windows(3).map(|three| {
        let mut three = [three[0].abs(), three[1].abs(), three[2].abs()];
        three.sort_by(f64::total_cmp);
        three[1]
    });
    medians.fold(0.0, f64::max)
}

//! The motion along a path: time, speed, and the distance of the tip from the programmed path by rounded corners and by joints that follow late.
//!
//! ```text
//! stretch of cuts, divided at stops -> rounded corners -> fastest speed -> limited jerk -> time at each point
//!                                                        -> joints that follow late -> distance from the path
//! ```
//!
//! A zone is at least the way of the shortest blending time at the programmed feed, as far as there is a zone at all. Between two cuts the arm stops; a rapid takes the longer of the
//! time of the tip, over its whole way with one acceleration and one deceleration, and of the slowest joint, from where the cut before ends to where the next begins.

use std::ops::Range;

use nalgebra::{Point3, Vector3};

use super::detail::MotionDetail;
use super::jerk::Timed;
use super::joint_path::JointPath;
use super::lag::Lag;
use super::late_path::LatePath;
use super::limits::{Limiting, MotionLimits};
use super::rounded::{Programmed, Rounded};
use super::speed::{fastest, from_rest_to_rest};
use crate::path::{Command, MoveEnd, Passage, SampledPath};

/// How a controller moves an arm.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionModel {
    /// Limits of joints and path.
    pub limits: MotionLimits,
    /// Window of the average that limits the jerk, s.
    pub smoothing: f64,
    /// Time after which the next move begins at a stop, from where the command has arrived, s.
    pub settling: f64,
    /// Shortest time in which a zone is passed at the programmed feed, s: larger zones are not changed.
    pub shortest_blending: f64,
    /// How late each joint follows.
    pub lags: Vec<Lag>,
    /// Lead of each motor over its acceleration, s^2: how far the motor is ahead of the arm by the elastic deflection under the forces of inertia. It is part of
    /// [`followed`](super::followed()), the positions that a controller logs, and not of the tip, which is where the arm is. Empty: none.
    pub motor_leads: Vec<f64>,
    /// How the ends of moves are passed where the program does not say.
    pub passage: Passage,
    /// Feed where the program gives none, m/s.
    pub feed: Option<f64>,
    /// Speed of the tip in rapids, m/s.
    pub rapid: f64,
}

impl MotionModel {
    /// Radius of the smallest zone that is passed at a feed, m/s, in m: its way takes the shortest blending time.
    pub fn least_zone(&self, feed: f64) -> f64 {
        0.5 * self.shortest_blending * feed
    }
}

/// A path with the postures along it.
#[derive(Clone, Copy)]
pub struct Postures<'a> {
    /// The path.
    pub path: &'a SampledPath,
    /// Its points in the base, m.
    pub points: &'a [Point3<f64>],
    /// Joint positions at each point, rad (m), point after point.
    pub positions: &'a [f64],
    /// Whether a point has a posture.
    pub has_posture: &'a dyn Fn(usize) -> bool,
    /// Whether the arm has to stop at a point because a joint jumps on the way to it.
    pub jumps: &'a dyn Fn(usize) -> bool,
    /// The tip in the base at joint positions, rad (m).
    pub tip: &'a (dyn Fn(&[f64]) -> Point3<f64> + Sync),
}

/// The motion along a path. Values of points without posture are not numbers, or zero displacements.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    /// Time at which the command is at each point, s, from the first one.
    pub times: Vec<f64>,
    /// Speed of the command there, m/s.
    pub speeds: Vec<f64>,
    /// Programmed feed on the way to the point, m/s; at the first of a cut from it.
    pub feeds: Vec<f64>,
    /// What limits the speed there.
    pub limiting: Vec<Limiting>,
    /// Distance of the commanded path from the programmed point, m, base: rounded corners.
    pub blending: Vec<Vector3<f64>>,
    /// Distance of the path that is followed from the commanded one, m, base: joints that follow late.
    pub servo: Vec<Vector3<f64>>,
    /// Both paths next to the point that the followed one is farthest from; `None` if no point is left.
    pub largest: Option<MotionDetail>,
    /// Time of the cuts, s.
    pub cutting: f64,
    /// Time of the rapids between them, s.
    pub rapids: f64,
    /// Time of waits, s.
    pub waits: f64,
    /// Time of the cuts with the programmed feed throughout, s.
    pub programmed: f64,
}

/// No feed is known on the way to a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: no feed is given for this cut")]
pub struct NoFeed {
    /// Line of the program.
    pub line: u32,
}

impl Motion {
    /// Keeps the values of this many points.
    pub fn truncate(&mut self, count: usize) {
        self.largest.take_if(|detail| detail.index >= count);
        self.times.truncate(count);
        self.speeds.truncate(count);
        self.feeds.truncate(count);
        self.limiting.truncate(count);
        self.blending.truncate(count);
        self.servo.truncate(count);
    }

    /// Duration of the program from its first point to its last, s.
    pub fn duration(&self) -> f64 {
        self.cutting + self.rapids + self.waits
    }
}

/// The motion of an arm along a path in these postures.
///
/// # Errors
/// [`NoFeed`] if neither the program nor the model gives the feed of a cut.
///
/// # Panics
/// If the numbers of values do not belong to the path or the limits.
pub fn motion_along(postures: &Postures<'_>, model: &MotionModel) -> Result<Motion, NoFeed> {
    let path = postures.path;
    let count = path.points.len();
    let joints = model.limits.joints.len();
    assert_eq!(postures.points.len(), count, "every point in the base");
    assert_eq!(
        postures.positions.len(),
        count * joints,
        "positions of every point"
    );
    let mut builder = Builder {
        postures,
        model,
        joints,
        waits: waits(path, count),
        found: Motion {
            times: vec![f64::NAN; count],
            speeds: vec![f64::NAN; count],
            feeds: vec![f64::NAN; count],
            limiting: vec![Limiting::Stop; count],
            blending: vec![Vector3::zeros(); count],
            servo: vec![Vector3::zeros(); count],
            ..Motion::default()
        },
    };
    let stretches: Vec<Range<usize>> = path.stretches().collect();
    for (number, stretch) in stretches.iter().enumerate() {
        if number > 0 {
            builder.rapid(
                stretches[number - 1].end - 1,
                stretch.start,
                path.rapids.get(number).map_or(0.0, |rapids| rapids.length),
            );
        }
        builder.stretch(stretch.clone())?;
    }
    Ok(builder.found)
}

/// Waits at the points of a path, s: after a point, in order.
fn waits(path: &SampledPath, count: usize) -> Vec<(usize, f64)> {
    let waits = path.commands.iter().filter_map(|placed| match placed.command {
        Command::Dwell(time) => Some((placed.points.saturating_sub(1).min(count.saturating_sub(1)), time)),
        Command::Stop => Some((placed.points.saturating_sub(1).min(count.saturating_sub(1)), 0.0)),
        Command::Coolant(_) => None,
    });
    waits.collect()
}

struct Builder<'a> {
    postures: &'a Postures<'a>,
    model: &'a MotionModel,
    joints: usize,
    waits: Vec<(usize, f64)>,
    found: Motion,
}

impl Builder<'_> {
    /// The cuts of a stretch, from stop to stop.
    fn stretch(&mut self, stretch: Range<usize>) -> Result<(), NoFeed> {
        let path = self.postures.path;
        let first = path.ends.partition_point(|end| end.point < stretch.start);
        let last = path.ends.partition_point(|end| end.point < stretch.end);
        let ends = &path.ends[first..last];
        let mut begin = stretch.start;
        let mut next = 0;
        for index in stretch.clone() {
            while next < ends.len() && ends[next].point < index {
                next += 1;
            }
            let end = ends.get(next).filter(|end| end.point == index);
            let is_last = index + 1 == stretch.end;
            let is_free = (self.postures.has_posture)(index);
            let continues =
                !is_last && (self.postures.has_posture)(index + 1) && !(self.postures.jumps)(index + 1);
            let stops =
                end.is_some_and(|end| self.passage(end) == Passage::Stop) || !self.waits_at(index).is_empty();
            if !is_free {
                begin = index + 1;
                continue;
            }
            if stops || !continues {
                if index > begin {
                    self.between_stops(begin..index + 1, ends)?;
                } else if self.found.times[index].is_nan() {
                    self.found.times[index] = self.found.duration();
                    self.found.speeds[index] = 0.0;
                    self.found.feeds[index] = self.feed(index, stretch.clone()).unwrap_or(f64::NAN);
                }
                self.found.waits += self.waits_at(index).iter().map(|(_, time)| time).sum::<f64>();
                if !is_last {
                    self.found.waits += self.model.settling;
                }
                begin = if continues || is_last { index } else { index + 1 };
                if !is_last && (self.postures.has_posture)(index + 1) && (self.postures.jumps)(index + 1) {
                    self.rapid(index, index + 1, 0.0);
                }
            }
        }
        Ok(())
    }

    /// The waits at a point.
    fn waits_at(&self, index: usize) -> &[(usize, f64)] {
        let [first, end] = [index, index + 1].map(|index| self.waits.partition_point(|(at, _)| *at < index));
        &self.waits[first..end]
    }

    fn passage(&self, end: &MoveEnd) -> Passage {
        match end.passage {
            Passage::Unknown => self.model.passage,
            given => given,
        }
    }

    /// The programmed feed on the way to a point of a stretch.
    fn feed(&self, index: usize, stretch: Range<usize>) -> Result<f64, NoFeed> {
        let to = if index == stretch.start {
            (index + 1).min(stretch.end - 1)
        } else {
            index
        };
        let point = &self.postures.path.points[to];
        let feed = point.pace.feed().or(self.model.feed);
        feed.ok_or(NoFeed { line: point.line })
    }

    /// These points, of which the tip stops at the first and the last only.
    fn between_stops(&mut self, points: Range<usize>, ends: &[MoveEnd]) -> Result<(), NoFeed> {
        let joints = self.joints;
        let steps = points.start + 1..points.end;
        let feeds: Vec<f64> = steps
            .map(|to| self.feed(to, points.clone()))
            .collect::<Result<_, _>>()?;
        let inside = |end: &&MoveEnd| end.point > points.start && end.point + 1 < points.end;
        let zones: Vec<(usize, f64)> = ends
            .iter()
            .filter(inside)
            .map(|end| {
                let step = end.point - points.start;
                let radius = match self.passage(end) {
                    Passage::Zone(radius) => radius,
                    Passage::Within { error, most } => {
                        let [before, at, after] = [0, 1, 2].map(|k| self.postures.points[end.point + k - 1]);
                        let turn = (after - at).normalize() - (at - before).normalize();
                        (4.0 * error / turn.norm()).min(most)
                    }
                    Passage::Stop | Passage::Unknown => return (step, 0.0),
                };
                let least = self.model.least_zone(feeds[step - 1].max(feeds[step]));
                (step, radius.max(least))
            })
            .collect();
        let path = Programmed {
            points: &self.postures.points[points.clone()],
            positions: &self.postures.positions[points.start * joints..points.end * joints],
            feeds: &feeds,
            zones: &zones,
        }
        .rounded();
        let profile = fastest(
            &JointPath::new(joints, &path.positions, path.along.clone(), |_| false),
            &self.model.limits,
            &path.feeds,
        );
        let timed = Timed::of(&profile, &path.along, self.model.smoothing);
        let times = timed.times_at(&path.along);
        let late = LatePath::of(&path, &times, &self.model.lags, self.postures.tip);
        let servo = &late.errors;
        let start = self.found.duration();
        for (offset, at) in path.passes.iter().enumerate() {
            let index = points.start + offset;
            let k = path
                .along
                .partition_point(|along| along <= at)
                .clamp(1, path.along.len() - 1);
            let [low, high] = [path.along[k - 1], path.along[k]];
            let part = ((at - low) / (high - low)).clamp(0.0, 1.0);
            let nearest = if part < 0.5 { k - 1 } else { k };
            let time = times[k - 1] + part * (times[k] - times[k - 1]);
            self.found.times[index] = start + time;
            self.found.speeds[index] = timed.at(time).speed;
            self.found.feeds[index] = feeds[offset.max(1) - 1];
            self.found.limiting[index] = profile.limiting[nearest];
            self.found.blending[index] = path.errors[offset];
            self.found.servo[index] = servo[k - 1].lerp(&servo[k], part);
        }
        self.keep_largest(points.clone(), &path, &late);
        self.found.cutting += timed.duration();
        let lengths = self.postures.points[points]
            .windows(2)
            .map(|pair| (pair[1] - pair[0]).norm());
        self.found.programmed += lengths
            .zip(&feeds)
            .map(|(length, feed)| length / feed)
            .sum::<f64>();
        Ok(())
    }

    /// Keeps the detail of the point from which the followed path is farthest.
    fn keep_largest(&mut self, points: Range<usize>, path: &Rounded, late: &LatePath) {
        let distance = |index: usize| (self.found.blending[index] + self.found.servo[index]).norm();
        let Some(index) = points
            .clone()
            .max_by(|a, b| distance(*a).total_cmp(&distance(*b)))
        else {
            return;
        };
        let largest = distance(index);
        let before = self.found.largest.as_ref().map_or(0.0, |detail| detail.distance);
        if largest > before {
            let at = path.passes[index - points.start];
            let passed = path
                .along
                .partition_point(|along| *along < at)
                .min(path.along.len() - 1);
            self.found.largest = Some(MotionDetail::of(
                (index, self.postures.points[index]),
                largest,
                late.commanded.given[passed],
                [&late.commanded.points, &late.followed],
            ));
        }
    }

    /// The time from a point at rest to another one by a rapid of this length.
    fn rapid(&mut self, from: usize, to: usize, length: f64) {
        let limits = &self.model.limits;
        let at = |index: usize, joint: usize| self.postures.positions[index * self.joints + joint];
        let both = [from, to]
            .into_iter()
            .all(|index| (self.postures.has_posture)(index));
        let of_joints = limits.joints.iter().enumerate().map(|(joint, limit)| {
            let way = if both {
                (at(to, joint) - at(from, joint)).abs()
            } else {
                0.0
            };
            from_rest_to_rest(way, limit.speed, limit.acceleration)
        });
        let longest = of_joints.fold(
            from_rest_to_rest(length, self.model.rapid, limits.acceleration),
            f64::max,
        );
        if longest > 0.0 {
            self.found.rapids += longest + self.model.smoothing;
        }
    }
}

#[cfg(test)]
mod tests;

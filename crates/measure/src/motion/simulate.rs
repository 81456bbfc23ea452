//! A stretch as a model of the motion predicts it, and its difference from the log.

use armill_core::motion::{Followed, Lag, MotionModel, followed};
use armill_core::nalgebra::{Point3, Vector3};
use armill_core::robot::Robot;

use super::least_squares::{Parameter, least_squares};
use super::observed::{Observed, closest, cycle};
use super::tool::{flanges, tips};

/// Step of time, s, and its part of the duration.
const STEP: (f64, f64) = (1e-3, 1.0 / 20_000.0);
/// What is added after the end, s.
const REST: f64 = 0.3;
/// Steps in the search of a zone.
const HALVINGS: usize = 18;
/// Largest zone that is sought, part of the shorter move.
const LARGEST: f64 = 0.5;

/// A predicted stretch.
#[derive(Clone, Debug)]
pub(super) struct Predicted {
    times: Vec<f64>,
    /// The tip, m.
    pub tips: Vec<Point3<f64>>,
}

/// An arm with the tip of its tool.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arm<'a> {
    /// The arm.
    pub robot: &'a Robot,
    /// Flange axes, m.
    pub tip: Vector3<f64>,
}

/// A model with these values in place of its own: acceleration along the path, window, lag of all joints, time to settle; m, s.
pub(super) fn with(model: &MotionModel, [acceleration, smoothing, lag, settling]: [f64; 4]) -> MotionModel {
    let mut changed = model.clone();
    changed.limits.acceleration = acceleration;
    changed.smoothing = smoothing;
    changed.settling = settling;
    for own in &mut changed.lags {
        *own = Lag {
            time: lag,
            feed_forward: 0.0,
        };
    }
    changed
}

/// The motion along the course of a stretch, with this feed, m/s, and the radius of the zone, m, at each corner that is passed.
pub(super) fn predicted(
    arm: Arm<'_>,
    observed: &Observed,
    model: &MotionModel,
    feed: f64,
    zones: &[Option<f64>],
) -> Predicted {
    let found = motion(observed, model, feed, zones);
    Predicted {
        tips: tips(&flanges(arm.robot, &found.positions), arm.tip),
        times: found.times,
    }
}

/// The joints along the course of a stretch, as [`predicted`] has them.
pub(super) fn motion(observed: &Observed, model: &MotionModel, feed: f64, zones: &[Option<f64>]) -> Followed {
    let zones: Vec<Option<f64>> = zones
        .iter()
        .map(|zone| zone.map(|radius| radius.max(model.least_zone(feed))))
        .collect();
    let ways = observed.course.ways(feed, &zones);
    let programmed: Vec<_> = ways.iter().map(|way| way.programmed()).collect();
    let duration = observed.times[observed.times.len() - 1] - observed.times[0];
    followed(&programmed, model, STEP.0.max(STEP.1 * duration), REST)
}

impl Predicted {
    /// Time from start to end, s.
    pub(super) fn cycle(&self, observed: &Observed) -> Option<f64> {
        cycle(&self.times, &self.tips, &observed.course)
    }

    /// Least distance from each corner, m.
    pub(super) fn closest(&self, observed: &Observed) -> Vec<f64> {
        let vertices = &observed.course.vertices;
        vertices[1..vertices.len() - 1]
            .iter()
            .map(|at| closest(&self.tips, at))
            .collect()
    }

    /// The tip at the instants of the log, m, if the motion starts at the time `start`, s.
    pub(super) fn at_instants(&self, observed: &Observed, start: f64) -> Vec<Point3<f64>> {
        let last = self.times.len() - 1;
        let at = |time: &f64| {
            let time = (time - start).clamp(self.times[0], self.times[last]);
            let k = self.times.partition_point(|at| *at <= time).clamp(1, last);
            let part = (time - self.times[k - 1]) / (self.times[k] - self.times[k - 1]);
            self.tips[k - 1] + (self.tips[k] - self.tips[k - 1]) * part
        };
        observed.times.iter().map(at).collect()
    }

    /// Speeds at the instants of the log less those of the log, m/s, if the motion starts at the time `start`, s.
    pub(super) fn residuals(&self, observed: &Observed, start: f64) -> Vec<f64> {
        let speeds = observed.speeds_of(&self.at_instants(observed, start));
        speeds
            .iter()
            .zip(&observed.speeds)
            .map(|(own, logged)| own - logged)
            .collect()
    }

    /// The start, s, for which the motion leaves when that of the log does.
    pub(super) fn start(&self, observed: &Observed) -> f64 {
        let half = |times: &[f64], tips: &[Point3<f64>]| {
            let start = observed.course.vertices[0];
            let way = 0.25 * (observed.course.vertices[1] - start).norm();
            let index = tips.iter().position(|tip| (tip - start).norm() > way);
            times[index.unwrap_or(0)]
        };
        half(&observed.times, &observed.tips) - half(&self.times, &self.tips)
    }

    /// Root mean square of the difference of the speeds, m/s, with the start for which it is least.
    pub(super) fn feed_rms(&self, observed: &Observed) -> f64 {
        let start = Parameter {
            start: self.start(observed),
            step: 1e-3,
            least: f64::NEG_INFINITY,
        };
        least_squares(&[start], |p| self.residuals(observed, p[0])).rms
    }
}

/// Radius of the zone, m, with which the model passes each corner of a stretch as near as the log does; none at stops.
pub(super) fn zones(arm: Arm<'_>, observed: &Observed, model: &MotionModel) -> Vec<Option<f64>> {
    let lengths = observed.course.lengths();
    let mut free = model.clone();
    free.shortest_blending = 0.0;
    let mut bounds: Vec<Option<[f64; 2]>> = observed
        .corners
        .iter()
        .enumerate()
        .map(|(k, corner)| (!corner.is_stop).then_some([0.0, LARGEST * lengths[k].min(lengths[k + 1])]))
        .collect();
    let middle = |bounds: &[Option<[f64; 2]>]| -> Vec<Option<f64>> {
        bounds
            .iter()
            .map(|both| both.map(|[low, high]| 0.5 * (low + high)))
            .collect()
    };
    if bounds.iter().all(Option::is_none) {
        return middle(&bounds);
    }
    for _ in 0..HALVINGS {
        let tried = middle(&bounds);
        let found = predicted(arm, observed, &free, observed.feed, &tried).closest(observed);
        for (k, bounds) in bounds.iter_mut().enumerate() {
            if let (Some(both), Some(radius)) = (bounds.as_mut(), tried[k]) {
                both[usize::from(found[k] > observed.corners[k].closest)] = radius;
            }
        }
    }
    middle(&bounds)
}

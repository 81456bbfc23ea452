//! A program while it is cut into points, step by step as its reader gives them.

use armill_core::nalgebra::Point3;
use armill_core::path::clock::begins;
use armill_core::path::{Operation, Pace, PathPoint, Sampler, Sampling, Step};

use super::MOST_POINTS;

/// A program while it is cut into points.
pub(super) struct CutUp {
    sampler: Sampler,
    /// Points of its cuts.
    pub(super) points: Vec<PathPoint>,
    /// Its operations, and the first point of each.
    pub(super) operations: Vec<(usize, Operation)>,
    /// Moves, rapids included.
    pub(super) moves: usize,
    /// Of all cuts with a known feed, s.
    pub(super) time: f64,
    /// Whether it has more points than are kept.
    pub(super) too_many: bool,
    /// Length of the rapid before each stretch of cuts, m.
    pub(super) rapids: Vec<f64>,
    /// Length of the rapids since the last cut, m.
    since: f64,
    stands: Option<Point3<f64>>,
}

impl CutUp {
    pub(super) fn new(sampling: Sampling) -> CutUp {
        CutUp {
            sampler: Sampler::new(sampling),
            points: Vec::new(),
            operations: Vec::new(),
            moves: 0,
            time: 0.0,
            too_many: false,
            rapids: Vec::new(),
            since: 0.0,
            stands: None,
        }
    }

    pub(super) fn take(&mut self, step: Step) {
        match step {
            Step::Operation(operation) => self.operations.push((self.points.len(), operation)),
            Step::Move(next) => {
                self.moves += 1;
                if self.points.len().saturating_add(self.sampler.count(&next)) > MOST_POINTS {
                    self.too_many = true;
                    return;
                }
                let before = self.points.last().map_or(0.0, |point| point.along);
                let first = self.points.len();
                self.sampler.points(&next, |point| self.points.push(point));
                let length = self.points.last().map_or(0.0, |point| point.along) - before;
                if let Pace::Feed(speed) = next.pace
                    && speed > 0.0
                {
                    self.time += length / speed;
                }
                if !next.pace.cuts() {
                    self.since += self.stands.map_or(0.0, |from| (next.end - from).norm());
                } else if first < self.points.len() {
                    if begins(&self.points, first) {
                        self.rapids.push(self.since);
                    }
                    self.since = 0.0;
                }
                self.stands = Some(next.end);
            }
        }
    }
}

//! Where a log is at rest, and the stretches between.

use std::ops::Range;

use armill_formats::measurement::joint_log::JointLog;

use super::derivative::Differentiator;

/// Half of the window of speeds, usual steps.
pub(super) const HALF_WINDOW: f64 = 3.5;
/// A joint below this speed rests, rad/s.
const RESTS: f64 = 2e-3;
/// Shortest rest between two stretches, s: less is a stop within a stretch.
const SHORTEST_REST: f64 = 0.2;
/// What is kept of the rests before and after a stretch, s.
const MARGIN: f64 = 0.1;
/// A joint move is as straight as this between its ends in the space of the joints, relative to its length.
const STRAIGHT: f64 = 0.01;

/// A motion from a rest to a rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    /// Its instants, with some of the rests before and after it.
    pub range: Range<usize>,
    /// The instants at which it moves.
    pub moving: Range<usize>,
    /// Whether the log has a rest before and after it.
    pub is_complete: bool,
    /// Whether all joints move in proportion: a joint move.
    pub is_joint_move: bool,
}

/// Speeds of the joints, rad/s, instant after instant.
pub(super) fn joint_speeds(log: &JointLog) -> Vec<f64> {
    Differentiator::new(&log.times, HALF_WINDOW * log.usual_step()).slopes(&log.positions, log.joints)
}

/// The stretches of a log.
pub(super) fn stretches(log: &JointLog, speeds: &[f64]) -> Vec<Stretch> {
    let count = log.times.len();
    let rests = |index: usize| {
        let all = &speeds[index * log.joints..][..log.joints];
        all.iter().all(|speed| speed.abs() < RESTS)
    };
    let mut found = Vec::new();
    let mut index = 0;
    while index < count {
        if rests(index) {
            index += 1;
            continue;
        }
        let begin = index;
        let mut end = index;
        // Short rests are part of it.
        while index < count && log.times[index] - log.times[end] < SHORTEST_REST {
            if !rests(index) {
                end = index;
            }
            index += 1;
        }
        index = end + 1;
        let moving = begin..end + 1;
        let first = log
            .times
            .partition_point(|time| *time < log.times[begin] - MARGIN);
        let last = log.times.partition_point(|time| *time <= log.times[end] + MARGIN);
        found.push(Stretch {
            range: first..last,
            is_complete: begin > 0 && end + 1 < count,
            is_joint_move: is_joint_move(log, &moving),
            moving,
        });
    }
    found
}

/// Whether the joints move along a straight line in their space.
fn is_joint_move(log: &JointLog, moving: &Range<usize>) -> bool {
    let (first, last) = (log.at(moving.start), log.at(moving.end - 1));
    let way: Vec<f64> = last.iter().zip(first).map(|(to, from)| to - from).collect();
    let length = way.iter().map(|d| d * d).sum::<f64>().sqrt();
    if length < RESTS {
        return false;
    }
    moving.clone().all(|index| {
        let offset: Vec<f64> = log
            .at(index)
            .iter()
            .zip(first)
            .map(|(q, from)| q - from)
            .collect();
        let along = offset.iter().zip(&way).map(|(o, w)| o * w).sum::<f64>() / length;
        let all = offset.iter().map(|o| o * o).sum::<f64>();
        (all - along * along).max(0.0).sqrt() < STRAIGHT * length
    })
}

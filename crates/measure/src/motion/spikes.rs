//! Instants whose joint positions do not belong together, as where an interface passes on a joint of the sample before: left out.
//!
//! Each position is compared with the parabola through its neighbours in time. One that is further from it than a number of times the usual
//! distance nearby, and further than those next to it, is a spike.

use armill_core::nalgebra::{Matrix3, Vector3};
use armill_formats::measurement::joint_log::JointLog;

/// Neighbours on each side.
const NEIGHBOURS: usize = 3;
/// Instants on each side over which the usual distance is the median.
const NEARBY: usize = 25;
/// A spike is this number of usual distances off.
const OFF: f64 = 8.0;
/// Distances below this are those of the digits of a log, rad.
const DIGITS: f64 = 5e-5;

/// Leaves out the spikes of a log; their number.
pub(super) fn without_spikes(log: &mut JointLog) -> usize {
    let (count, joints) = (log.times.len(), log.joints);
    let mut is_spike = vec![false; count];
    for joint in 0..joints {
        let q = |index: usize| log.positions[index * joints + joint];
        let off: Vec<f64> = (0..count).map(|index| off(&log.times, &q, index)).collect();
        for index in 0..count {
            let near = &off[index.saturating_sub(NEARBY)..(index + NEARBY + 1).min(count)];
            let mut sorted = near.to_vec();
            sorted.sort_by(f64::total_cmp);
            let usual = sorted[sorted.len() / 2].max(DIGITS);
            let next = &off[index.saturating_sub(NEIGHBOURS)..(index + NEIGHBOURS + 1).min(count)];
            if off[index] > OFF * usual && next.iter().all(|other| *other <= off[index]) {
                is_spike[index] = true;
            }
        }
    }
    let kept: Vec<usize> = (0..count).filter(|index| !is_spike[*index]).collect();
    log.positions = rows(&kept, &log.positions, joints);
    log.commanded = log.commanded.as_ref().map(|values| rows(&kept, values, joints));
    log.moves = log
        .moves
        .as_ref()
        .map(|moves| kept.iter().map(|index| moves[*index]).collect());
    log.times = kept.iter().map(|index| log.times[*index]).collect();
    log.lines = kept.iter().map(|index| log.lines[*index]).collect();
    count - kept.len()
}

/// The rows with these indices.
fn rows(kept: &[usize], values: &[f64], joints: usize) -> Vec<f64> {
    let rows = kept.iter().map(|index| &values[index * joints..][..joints]);
    rows.flatten().copied().collect()
}

/// Distance of a position from the parabola through its neighbours, rad.
fn off(times: &[f64], q: &impl Fn(usize) -> f64, index: usize) -> f64 {
    let first = index.saturating_sub(NEIGHBOURS);
    let end = (index + NEIGHBOURS + 1).min(times.len());
    let (at, reach) = (
        times[index],
        (times[end - 1] - times[first]).max(f64::MIN_POSITIVE),
    );
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for neighbour in (first..end).filter(|neighbour| *neighbour != index) {
        let u = (times[neighbour] - at) / reach;
        let row = Vector3::new(1.0, u, u * u);
        normal += row * row.transpose();
        right += row * q(neighbour);
    }
    normal
        .try_inverse()
        .map_or(0.0, |inverse| ((inverse * right).x - q(index)).abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_joint_of_the_sample_before_is_left_out_and_starts_and_stops_are_not() {
        // From rest to a speed of 0.5 rad/s in 0.1 s, with a step of the clock that varies.
        let times: Vec<f64> = (0..200)
            .map(|i| 0.008 * f64::from(i) + 0.0005 * f64::from(i * 7 % 3))
            .collect();
        let at = |t: f64| {
            let t = (t - 0.4).max(0.0);
            if t < 0.1 {
                2.5 * t * t
            } else {
                0.025 + 0.5 * (t - 0.1)
            }
        };
        let mut log = JointLog {
            joints: 2,
            positions: times.iter().flat_map(|t| [at(*t), -at(*t)]).collect(),
            lines: (2..202).collect(),
            times,
            ..JointLog::default()
        };
        let clean = log.clone();
        assert_eq!(without_spikes(&mut log), 0);
        assert_eq!(log, clean);
        log.positions[2 * 120] = log.positions[2 * 119];
        assert_eq!(without_spikes(&mut log), 1);
        assert!(!log.lines.contains(&122) && log.positions.len() == 2 * 199);
    }
}

//! How late each joint follows, where a log has commanded and actual positions: a delay and a first-order lag.
//!
//! ```text
//! T dq/dt = q_c(t - d) - q
//! ```

use armill_core::motion::Lag;
use armill_formats::measurement::joint_log::JointLog;

use super::least_squares::{Parameter, least_squares};

/// Where the search begins: delay and lag, s.
const STARTS: [[f64; 2]; 3] = [[0.0, 0.01], [0.02, 0.005], [0.05, 0.02]];
/// A joint that moves less is not evaluated, rad.
const LEAST_WAY: f64 = 1e-3;

/// How late a joint follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointLag {
    /// Delay, s.
    pub delay: f64,
    /// Its standard uncertainty, s.
    pub delay_u: f64,
    /// Time constant, s.
    pub lag: f64,
    /// Its standard uncertainty, s.
    pub lag_u: f64,
    /// Root mean square of the difference, rad.
    pub rms: f64,
}

/// How late each joint follows; none of joints that hardly move; empty for a log without commanded positions.
pub(super) fn lags(log: &JointLog) -> Vec<Option<JointLag>> {
    let Some(commanded) = &log.commanded else {
        return Vec::new();
    };
    let column = |values: &[f64], joint: usize| -> Vec<f64> {
        values.iter().skip(joint).step_by(log.joints).copied().collect()
    };
    (0..log.joints)
        .map(|joint| {
            lag(
                &log.times,
                &column(commanded, joint),
                &column(&log.positions, joint),
            )
        })
        .collect()
}

fn lag(times: &[f64], commanded: &[f64], actual: &[f64]) -> Option<JointLag> {
    let largest = commanded.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = commanded.iter().copied().fold(f64::INFINITY, f64::min);
    if largest - least < LEAST_WAY {
        return None;
    }
    // A constant difference is an offset of the zeros.
    let offset = actual[0] - commanded[0];
    let residuals = |p: &[f64]| -> Vec<f64> {
        let delayed: Vec<f64> = times
            .iter()
            .map(|time| at(times, commanded, time - p[0]) + offset)
            .collect();
        let followed = Lag {
            time: p[1],
            feed_forward: 0.0,
        }
        .followed(times, &delayed);
        followed
            .iter()
            .zip(actual)
            .map(|(own, actual)| own - actual)
            .collect()
    };
    let fits = STARTS.iter().map(|[delay, lag]| {
        let parameter = |start: f64| Parameter {
            start,
            step: 1e-4,
            least: 0.0,
        };
        least_squares(&[parameter(*delay), parameter(*lag)], residuals)
    });
    let found = fits.min_by(|a, b| a.rms.total_cmp(&b.rms))?;
    Some(JointLag {
        delay: found.values[0],
        delay_u: found.u[0],
        lag: found.values[1],
        lag_u: found.u[1],
        rms: found.rms,
    })
}

/// A value at a time, straight between instants.
fn at(times: &[f64], values: &[f64], time: f64) -> f64 {
    let k = times.partition_point(|at| *at <= time).clamp(1, times.len() - 1);
    let part = ((time - times[k - 1]) / (times[k] - times[k - 1])).clamp(0.0, 1.0);
    values[k - 1] + part * (values[k] - values[k - 1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delay_and_lag_of_a_motion_that_is_late_are_found() {
        let times: Vec<f64> = (0..1000).map(|i| f64::from(i) * 0.004).collect();
        let command = |t: f64| 0.3 * (t.max(0.0) * 3.0).sin().powi(2) + 0.2 * (t.max(0.0) * 7.0).sin();
        let commanded: Vec<f64> = times.iter().map(|t| command(*t)).collect();
        let fine: Vec<f64> = (0..40_000).map(|i| f64::from(i) * 1e-4).collect();
        let late: Vec<f64> = fine.iter().map(|t| command(t - 0.012)).collect();
        let late = Lag {
            time: 0.02,
            feed_forward: 0.0,
        }
        .followed(&fine, &late);
        let log = JointLog {
            joints: 1,
            positions: (0..1000).map(|k| late[40 * k]).collect(),
            times,
            commanded: Some(commanded),
            ..JointLog::default()
        };
        let found = lags(&log)[0].unwrap();
        // Straight between instants of 4 ms, the command is known to some parts of a millisecond.
        assert!(
            (found.delay - 0.012).abs() < 5e-4 && (found.lag - 0.02).abs() < 5e-4,
            "{found:?}"
        );
    }

    #[test]
    fn a_joint_at_rest_has_no_lag() {
        let log = JointLog {
            joints: 1,
            positions: vec![0.5; 10],
            times: (0..10).map(f64::from).collect(),
            commanded: Some(vec![0.5; 10]),
            ..JointLog::default()
        };
        assert_eq!(lags(&log), [None]);
    }
}

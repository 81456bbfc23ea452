//! A motion in time: what the controller commands, and where the joints are.
//!
//! ```text
//! segments, each from stop to stop -> speed along it -> limited jerk -> joints in time -> waits between them -> lag of each joint
//! ```

use super::jerk::Timed;
use super::lag::Lag;

/// A way from a stop to a stop.
#[derive(Clone, Debug)]
pub struct Segment<'a> {
    /// Position along it in time.
    pub timed: &'a Timed,
    /// Lengths of its points, m.
    pub along: &'a [f64],
    /// Joint positions at its points, rad (m), point after point.
    pub positions: &'a [f64],
    /// Wait at its end, s.
    pub wait: f64,
}

/// Joint positions in steps of time.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Step, s.
    pub step: f64,
    /// Commanded positions of each joint, rad (m).
    pub commanded: Vec<Vec<f64>>,
    /// Actual ones.
    pub actual: Vec<Vec<f64>>,
}

impl Drive {
    /// The motion along segments in steps of `step`, s, with joints of these lags; it goes on at rest for `rest`, s, in which the joints arrive.
    ///
    /// # Panics
    /// If a segment has not as many positions as points and joints.
    pub fn along(segments: &[Segment<'_>], lags: &[Lag], (step, rest): (f64, f64)) -> Drive {
        let joints = lags.len();
        let mut commanded = vec![Vec::new(); joints];
        for (index, segment) in segments.iter().enumerate() {
            assert_eq!(
                segment.positions.len(),
                joints * segment.along.len(),
                "positions of every point"
            );
            let rest = segment.wait + if index + 1 == segments.len() { rest } else { 0.0 };
            let count = ((segment.timed.duration() + rest) / step).ceil() as usize;
            let mut point = 0;
            for sample in 0..count {
                let at = segment.timed.at(step * sample as f64).along;
                while point + 2 < segment.along.len() && segment.along[point + 1] <= at {
                    point += 1;
                }
                let [from, to] = [segment.along[point], segment.along[point + 1]];
                let part = ((at - from) / (to - from)).clamp(0.0, 1.0);
                for (joint, commanded) in commanded.iter_mut().enumerate() {
                    let [a, b] = [point, point + 1].map(|point| segment.positions[point * joints + joint]);
                    commanded.push(a + part * (b - a));
                }
            }
        }
        let count = commanded.first().map_or(0, Vec::len);
        let times: Vec<f64> = (0..count).map(|sample| step * sample as f64).collect();
        let actual = commanded.iter().zip(lags);
        Drive {
            step,
            actual: actual
                .map(|(commanded, lag)| lag.followed(&times, commanded))
                .collect(),
            commanded,
        }
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.commanded.first().map_or(0, Vec::len)
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::limits::{JointLimits, MotionLimits};
    use crate::motion::{JointPath, fastest};

    #[test]
    fn a_move_forth_and_back_arrives_late_by_the_lag_and_rests_where_it_should() {
        let along: Vec<f64> = (0..501).map(|i| f64::from(i) * 1e-3).collect();
        let limits = MotionLimits {
            joints: vec![JointLimits {
                speed: 1.0,
                acceleration: 5.0,
            }],
            acceleration: f64::INFINITY,
        };
        let forth = along.clone();
        let back: Vec<f64> = along.iter().map(|s| 0.5 - s).collect();
        let timed = [&forth, &back].map(|positions| {
            let path = JointPath::new(1, positions, along.clone(), |_| false);
            Timed::of(&fastest(&path, &limits, &[9.0; 500]), &along, 0.05)
        });
        let segments =
            [(&timed[0], &forth, 0.3), (&timed[1], &back, 0.0)].map(|(timed, positions, wait)| Segment {
                timed,
                along: &along,
                positions,
                wait,
            });
        let lag = Lag {
            time: 0.02,
            feed_forward: 0.0,
        };
        let drive = Drive::along(&segments, &[lag], (1e-3, 0.5));
        let whole = timed[0].duration() + timed[1].duration() + 0.8;
        assert!(
            (drive.len() as f64 * 1e-3 - whole).abs() < 3e-3,
            "{}",
            drive.len()
        );
        let turn = ((timed[0].duration() + 0.29) / 1e-3) as usize;
        assert!((drive.actual[0][turn] - 0.5).abs() < 1e-6);
        assert!(drive.actual[0].last().unwrap().abs() < 1e-6);
        // At full speed.
        let middle = (0.5 * timed[0].duration() / 1e-3) as usize;
        let late = drive.commanded[0][middle] - drive.actual[0][middle];
        assert!((late - 0.02).abs() < 1e-3, "{late}");
    }
}

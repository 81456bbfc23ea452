//! What is learnt from a joint log: a log of a plane arm summed over small steps, and logs of an ABB IRB 6640. See README.md.

use armill_formats::measurement::joint_log::JointLog;
use armill_formats::robot::{RobotDescription, armill};
use armill_measure::motion::answer::StretchAnswer;
use armill_measure::motion::{MotionAnswer, NamedLog, Question, answer, learn};
use nalgebra::Vector3;

use crate::check::{Check, ErrorBound};

#[expect(clippy::panic, reason = "a log that is missing is a failed comparison")]
pub(crate) mod logs;
#[cfg(test)]
mod tests;

const SUMS: &str = "sums over small steps";
/// Lengths of the two links, m.
const LINKS: [f64; 2] = [0.5, 0.4];
/// Start, corner and end, m.
const CORNERS: [[f64; 2]; 3] = [[0.7, -0.2], [0.7, 0.2], [0.45, 0.3]];
/// Step of the sums, s; the log has every 40th.
const STEP: f64 = 1e-4;
const LOGGED: usize = 40;
/// Acceleration along the path, m/s^2, window, s, lag, s.
const TRUE: [f64; 3] = [2.0, 0.04, 0.02];

const ARM: &str = r#"format = 1
name = "Plane arm"

[chain]
source = "own"
motions = [
  { about = "z", joint = "J1" },
  { along = "x", length_mm = 500 },
  { about = "z", joint = "J2" },
  { along = "x", length_mm = 400 },
]

[[joint]]
name = "J1"
sign = 1
source = "own"

[[joint]]
name = "J2"
sign = 1
source = "own"

[sources.own]
what = "lengths"
where = "here"
licence = "fact"
"#;

/// Joint positions at a point of the plane, rad.
fn joints([x, y]: [f64; 2]) -> [f64; 2] {
    let [a, b] = LINKS;
    let second = ((x * x + y * y - a * a - b * b) / (2.0 * a * b)).acos();
    let first = y.atan2(x) - (b * second.sin()).atan2(a + b * second.cos());
    [first, second]
}

/// Way after a time from rest to rest, m: speed up, feed, slow down.
fn way(time: f64, length: f64, feed: f64, acceleration: f64) -> f64 {
    let ramp = feed / acceleration;
    let end = length / feed + ramp;
    if time < ramp {
        0.5 * acceleration * time * time
    } else if time < end - ramp {
        feed * (time - 0.5 * ramp)
    } else if time < end {
        length - 0.5 * acceleration * (end - time).powi(2)
    } else {
        length
    }
}

/// A log of the two lines at a feed, m/s, with a stop between and rests before and after.
fn log(feed: f64) -> JointLog {
    let [acceleration, window, lag] = TRUE;
    let rest = 4000;
    let mut commanded = vec![CORNERS[0]; rest];
    for pair in CORNERS.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let steps = ((length / feed + feed / acceleration + window) / STEP) as usize + 1;
        let over = (window / STEP).round() as usize;
        let ways: Vec<f64> = (0..steps)
            .map(|k| way(k as f64 * STEP, length, feed, acceleration))
            .collect();
        for k in 0..steps {
            // The mean over the window, at rest before.
            let mean = ways[k.saturating_sub(over - 1)..=k].iter().sum::<f64>() / over as f64;
            let part = mean / length;
            commanded.push([
                from[0] + part * (to[0] - from[0]),
                from[1] + part * (to[1] - from[1]),
            ]);
        }
    }
    commanded.extend(vec![CORNERS[2]; rest]);
    let mut here = joints(commanded[0]);
    let mut log = JointLog {
        joints: 2,
        ..JointLog::default()
    };
    for (k, at) in commanded.iter().enumerate() {
        for (own, there) in here.iter_mut().zip(joints(*at)) {
            *own += (there - *own) * (STEP / lag);
        }
        if k % LOGGED == 0 {
            log.times.push(k as f64 * STEP);
            log.positions.extend(here);
            log.lines.push(k / LOGGED + 2);
        }
    }
    log
}

/// The answer of a log with the prediction of another one; `None` if nothing can be learnt.
fn learnt() -> Option<MotionAnswer> {
    let found: RobotDescription = armill::read("arm.toml", "arm", ARM).ok()?;
    let question = Question {
        tip: Some(Vector3::zeros()),
        zones: vec![0.0],
        ..Question::default()
    };
    let named = |file: &str, feed: f64| NamedLog {
        file: file.to_owned(),
        log: log(feed),
    };
    let learned = learn(&found, named("fast", 0.2), &question).ok()?;
    answer(&found.robot, &learned, &[named("slow", 0.1)], &question).ok()
}

/// What is learnt from a log that was summed, and its prediction of another feed.
pub fn checks() -> Vec<Check> {
    let found = learnt();
    let value =
        |of: &dyn Fn(&MotionAnswer) -> Option<f64>| found.as_ref().and_then(of).unwrap_or(f64::INFINITY);
    let slow = |of: &dyn Fn(&StretchAnswer) -> Option<f64>| {
        value(&|answer| of(answer.compared.get(1)?.stretches.first()?))
    };
    let check = |what: &str, worst: f64, tolerance: f64, unit: &'static str| {
        let bound = ErrorBound {
            worst,
            tolerance,
            unit,
        };
        Check::printed(what, SUMS, bound, 2)
    };
    vec![
        check(
            "acceleration along the path learnt from a log with stops: 2000 mm/s^2",
            (value(&|answer| Some(answer.path_acceleration_mm_per_s2.value)) - 2000.0).abs(),
            20.0,
            "mm/s^2",
        ),
        check(
            "window learnt from it: 40 ms",
            (value(&|answer| Some(answer.smoothing_ms.value)) - 40.0).abs(),
            1.0,
            "ms",
        ),
        check(
            "lag learnt from it: 20 ms",
            (value(&|answer| Some(answer.lag_ms.value)) - 20.0).abs(),
            1.0,
            "ms",
        ),
        check(
            "cycle time at half of the feed",
            slow(&|stretch| stretch.cycle_time_error_percent).abs(),
            0.2,
            "%",
        ),
        check(
            "speed at half of the feed, rms of the feed",
            slow(&|stretch| Some(stretch.feed_rms_percent)),
            0.5,
            "%",
        ),
    ]
}

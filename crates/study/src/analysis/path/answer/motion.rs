//! What the controller makes of a path: its time, where the feed is not reached and why, rounded corners, joints that follow late.
//!
//! ```text
//! time lost on the way to a point = (t_i - t_{i-1}) - d_i / f_i
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `t`, `d`, `f` | time at a point, distance to the point before, programmed feed | s, m, m/s |

use armill_core::motion::{Limiting, Motion};
use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;
use armill_core::units::{to_mm, to_um};
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::path::PathAnalysis;
use crate::analysis::path::run::PathResult;

/// Below this part of the programmed feed it is not reached.
const REACHED: f64 = 0.98;
/// Places where the feed is not reached that are reported at most.
const MOST_PLACES: usize = 5;
/// A place where less time is lost is not reported, s.
const LEAST_LOSS: f64 = 1e-3;

/// What the controller makes of a path.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MotionAnswer {
    /// Duration from the first point to the last, waits and rapids between the cuts included; tool changes and stops of the program are not.
    pub cycle_time_s: f64,
    /// Time of the cuts.
    pub cutting_time_s: f64,
    /// Time of the cuts at the programmed feed throughout.
    pub programmed_time_s: f64,
    /// Time of the rapids between the cuts: the longer of tip and joints, as if the arm moved directly.
    pub rapid_time_s: f64,
    /// Time of waits.
    pub wait_time_s: f64,
    /// Part of the length of the cuts with at least 98 % of the programmed feed.
    pub length_at_feed_percent: f64,
    /// Causes of lost time, the largest first.
    pub lost_time: Vec<LostTime>,
    /// Where most time is lost, the worst place first.
    pub places: Vec<SlowPlace>,
    /// Largest distance of the commanded path from a programmed point: rounded corners.
    pub largest_blending_um: f64,
    /// Its line in the program.
    pub largest_blending_line: u32,
    /// Largest distance of the path that is followed from the commanded one: joints that follow late.
    pub largest_servo_um: f64,
    /// Its standard uncertainty from that of the lag; none if it is not known.
    pub largest_servo_u_um: Option<f64>,
    /// Its line in the program.
    pub largest_servo_line: u32,
    /// Source of the values of the controller.
    pub source: Option<String>,
    /// Values that are assumed.
    pub assumed: Vec<String>,
}

/// Time that is lost for one cause.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct LostTime {
    /// What limits the speed.
    pub limited_by: String,
    /// Time more than at the programmed feed.
    pub lost_s: f64,
}

/// A stretch of the path where the feed is not reached.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct SlowPlace {
    /// Line of its slowest point.
    pub line: u32,
    /// Distance of it along all cuts.
    pub distance_mm: f64,
    /// Speed there.
    pub speed_mm_per_s: f64,
    /// Programmed feed there.
    pub programmed_mm_per_s: f64,
    /// Time lost on this stretch.
    pub lost_s: f64,
    /// What limits the speed.
    pub limited_by: String,
    /// What may help.
    pub advice: String,
}

/// What limits the speed, in words.
pub fn limited_by(robot: &Robot, limiting: Limiting) -> String {
    let name = |joint: usize| &robot.joints()[joint].name;
    match limiting {
        Limiting::Feed => "feed".to_owned(),
        Limiting::JointSpeed(joint) => format!("speed of joint {}", name(joint)),
        Limiting::JointAcceleration(joint) => format!("acceleration of joint {}", name(joint)),
        Limiting::PathAcceleration => "acceleration along the path".to_owned(),
        Limiting::Stop => "stop".to_owned(),
    }
}

fn advice(robot: &Robot, limiting: Limiting) -> String {
    let name = |joint: usize| &robot.joints()[joint].name;
    match limiting {
        Limiting::Feed => String::new(),
        Limiting::JointSpeed(joint) => {
            format!(
                "another spin or placement, so that joint {} has less to turn",
                name(joint)
            )
        }
        Limiting::JointAcceleration(joint) => format!(
            "a larger zone, points farther apart, or another spin or placement, so that joint {} turns less sharply",
            name(joint)
        ),
        Limiting::PathAcceleration => {
            "a larger zone, or fewer stops: the way between them is short for this feed".to_owned()
        }
        Limiting::Stop => "a zone instead of the stop".to_owned(),
    }
}

impl MotionAnswer {
    /// What the controller makes of this path; `None` if that was not requested.
    pub fn of(robot: &Robot, analysis: &PathAnalysis, found: &PathResult) -> Option<MotionAnswer> {
        let (motion, setting) = (found.motion.as_ref()?, analysis.setting.motion.as_ref()?);
        let points = &analysis.track.path.points;
        let steps = Steps::of(analysis, motion);
        let farthest = |errors: &[Vector3<f64>]| {
            let sizes = errors.iter().map(Vector3::norm).enumerate();
            sizes.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default()
        };
        let (blended, blending) = farthest(&motion.blending);
        let (late, servo) = farthest(&motion.servo);
        let line = |index: usize| points.get(index).map_or(0, |point| point.line);
        let lag_is_known = setting.model.lags.iter().any(|lag| lag.time > 0.0);
        Some(MotionAnswer {
            cycle_time_s: motion.duration(),
            cutting_time_s: motion.cutting,
            programmed_time_s: motion.programmed,
            rapid_time_s: motion.rapids,
            wait_time_s: motion.waits,
            length_at_feed_percent: steps.percent_at_feed(),
            lost_time: steps.by_cause(robot),
            places: steps.places(robot, analysis),
            largest_blending_um: to_um(blending),
            largest_blending_line: line(blended),
            largest_servo_um: to_um(servo),
            largest_servo_u_um: setting.lag_u.filter(|_| lag_is_known).map(|u| u * to_um(servo)),
            largest_servo_line: line(late),
            source: setting.source.clone(),
            assumed: setting.assumed.clone(),
        })
    }
}

/// A step of the path with the time that is lost on it.
#[derive(Clone, Copy)]
struct Step {
    /// The point at its end.
    to: usize,
    length: f64,
    lost: f64,
    /// Actual speed at its end over the programmed feed.
    part: f64,
    limiting: Limiting,
}

struct Steps<'a> {
    motion: &'a Motion,
    all: Vec<Step>,
}

impl Steps<'_> {
    fn of<'a>(analysis: &PathAnalysis, motion: &'a Motion) -> Steps<'a> {
        let path = &analysis.track.path;
        let steps = (1..motion.times.len()).filter_map(|to| {
            let length = path.points[to].along - path.points[to - 1].along;
            let time = motion.times[to] - motion.times[to - 1];
            (length > 0.0 && time.is_finite()).then(|| Step {
                to,
                length,
                lost: (time - length / motion.feeds[to]).max(0.0),
                part: motion.speeds[to] / motion.feeds[to],
                limiting: match motion.limiting[to] {
                    // On the way from a slow point to the feed, or from the feed to it.
                    Limiting::Feed if motion.speeds[to] < REACHED * motion.feeds[to] => {
                        Limiting::PathAcceleration
                    }
                    limiting => limiting,
                },
            })
        });
        Steps {
            motion,
            all: steps.collect(),
        }
    }

    fn percent_at_feed(&self) -> f64 {
        let length =
            |of: &dyn Fn(&&Step) -> bool| -> f64 { self.all.iter().filter(of).map(|step| step.length).sum() };
        let all = length(&|_| true);
        if all > 0.0 {
            100.0 * length(&|step| step.part >= REACHED) / all
        } else {
            0.0
        }
    }

    fn by_cause(&self, robot: &Robot) -> Vec<LostTime> {
        let mut causes: Vec<LostTime> = Vec::new();
        for step in self
            .all
            .iter()
            .filter(|step| step.lost > 0.0 && step.limiting != Limiting::Feed)
        {
            let name = limited_by(robot, step.limiting);
            match causes.iter_mut().find(|cause| cause.limited_by == name) {
                Some(cause) => cause.lost_s += step.lost,
                None => causes.push(LostTime {
                    limited_by: name,
                    lost_s: step.lost,
                }),
            }
        }
        causes.retain(|cause| cause.lost_s >= LEAST_LOSS);
        causes.sort_by(|a, b| b.lost_s.total_cmp(&a.lost_s));
        causes
    }

    /// Consecutive steps below the feed, each stretch with its slowest point.
    fn places(&self, robot: &Robot, analysis: &PathAnalysis) -> Vec<SlowPlace> {
        let path = &analysis.track.path;
        // A cut begins and ends at rest.
        let is_end =
            |index: usize| path.begins(index) || index + 1 == path.points.len() || path.begins(index + 1);
        let mut places: Vec<(Step, f64)> = Vec::new();
        let mut ends: Vec<bool> = Vec::new();
        let mut before: Option<usize> = None;
        for step in self.all.iter().filter(|step| step.part < REACHED) {
            match places.last_mut().filter(|_| before == Some(step.to - 1)) {
                Some((slowest, lost)) => {
                    *lost += step.lost;
                    if let Some(end) = ends.last_mut() {
                        *end |= is_end(step.to);
                    }
                    if step.part < slowest.part {
                        *slowest = *step;
                    }
                }
                None => {
                    places.push((*step, step.lost));
                    ends.push(is_end(step.to) || is_end(step.to - 1));
                }
            }
            before = Some(step.to);
        }
        let mut ends = ends.into_iter();
        places.retain(|(_, lost)| !ends.next().unwrap_or_default() && *lost >= LEAST_LOSS);
        places.sort_by(|a, b| b.1.total_cmp(&a.1));
        let place = |(slowest, lost): &(Step, f64)| {
            let point = &analysis.track.path.points[slowest.to];
            SlowPlace {
                line: point.line,
                distance_mm: to_mm(point.along),
                speed_mm_per_s: to_mm(self.motion.speeds[slowest.to]),
                programmed_mm_per_s: to_mm(self.motion.feeds[slowest.to]),
                lost_s: *lost,
                limited_by: limited_by(robot, slowest.limiting),
                advice: advice(robot, slowest.limiting),
            }
        };
        places.iter().take(MOST_PLACES).map(place).collect()
    }
}

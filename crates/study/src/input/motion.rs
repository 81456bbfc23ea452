//! How the controller moves the arm: the table `motion` of study and robot file, and what is assumed where they give nothing.
//!
//! | value | assumed |
//! |---|---|
//! | acceleration of a joint | its greatest speed in `TO_FULL_SPEED`; without one `JOINT_ACCELERATION`; at least what it reached in a log |
//! | others | `PATH_ACCELERATION`, `SMOOTHING`, `SHORTEST_BLENDING`, `LAG`: as fitted to a joint log of one large arm (ABB IRB 6640, virtual controller, 500 mm/s with stops) |
//! | zone at the end of a move | corners are rounded by `ROUNDING_UM` at most, as in the programs that are written |

use armill_core::motion::{JointLimits, Lag, MotionLimits, MotionModel};
use armill_core::path::Passage;
use armill_core::robot::Robot;
use armill_core::units::{from_mm, from_ms, from_um, to_deg, to_ms};
use armill_formats::motion::MotionTable;

use crate::joint_unit::JointUnit;

/// Time in which a joint is assumed to reach its greatest speed, s.
const TO_FULL_SPEED: f64 = 0.25;
/// Assumed acceleration of a revolute joint without a greatest speed, rad/s^2.
const JOINT_ACCELERATION: f64 = 7.0;
/// The same of a prismatic joint, m/s^2.
const SLIDE_ACCELERATION: f64 = 1.0;
/// Assumed acceleration along the path, m/s^2.
const PATH_ACCELERATION: f64 = 4.6;
/// Assumed window of the average, s.
const SMOOTHING: f64 = 0.040;
/// Assumed shortest blending time, s.
const SHORTEST_BLENDING: f64 = 0.008;
/// Assumed lag, s.
const LAG: f64 = 0.015;
/// Relative standard uncertainty of an assumed lag.
const ASSUMED_U: f64 = 0.5;
/// Distance of rounded corners where neither program nor study give a zone, um: that of programs that are written.
const ROUNDING_UM: f64 = 5.0;
/// Largest of these zones, m.
const LARGEST_ZONE: f64 = 5e-3;

/// How the controller moves the arm.
#[derive(Clone, Debug)]
pub struct MotionSetting {
    /// Its model.
    pub model: MotionModel,
    /// Standard uncertainty of the lag of each joint over its lag; none where it is not known.
    pub lag_u: Option<f64>,
    /// Values that are assumed, in words.
    pub assumed: Vec<String>,
    /// Source of the values, in the user's words.
    pub source: Option<String>,
}

impl MotionSetting {
    /// The values of `table` for this robot, whose rapids have the speed `rapid`, m/s.
    pub fn of(table: &MotionTable, robot: &Robot, rapid: f64) -> MotionSetting {
        let mut assumed = Vec::new();
        let count = robot.joints().len();
        let given = table
            .joint_acceleration_deg_per_s2
            .as_ref()
            .filter(|list| list.len() == count);
        let reached = table
            .joint_acceleration_reached_deg_per_s2
            .as_ref()
            .filter(|list| list.len() == count);
        if given.is_none() {
            assumed.push(format!(
                "accelerations of the joints: their greatest speed in {:.0} ms, or {:.0} deg/s^2 where no speed is known{}",
                to_ms(TO_FULL_SPEED),
                to_deg(JOINT_ACCELERATION),
                if reached.is_some() { ", at least what they reached in a log" } else { "" }
            ));
        }
        let in_si = |list: &[f64], index: usize| list[index] / JointUnit::of(robot, index).scale;
        let limits = robot.joints().iter().enumerate().map(|(index, joint)| {
            let otherwise = if robot.slides(index) {
                SLIDE_ACCELERATION
            } else {
                JOINT_ACCELERATION
            };
            let assumed = joint.max_speed.map_or(otherwise, |speed| speed / TO_FULL_SPEED);
            JointLimits {
                speed: joint.max_speed.unwrap_or(f64::INFINITY),
                acceleration: match (given, reached) {
                    (Some(list), _) => in_si(list, index),
                    (None, Some(list)) => in_si(list, index).max(assumed),
                    (None, None) => assumed,
                },
            }
        });
        let joints: Vec<JointLimits> = limits.collect();
        let mut or = |value: Option<f64>, otherwise: f64, words: &str| {
            value.unwrap_or_else(|| {
                assumed.push(words.to_owned());
                otherwise
            })
        };
        let acceleration = or(
            table.path_acceleration_mm_per_s2.map(from_mm),
            PATH_ACCELERATION,
            "acceleration along the path: 4600 mm/s^2",
        );
        let smoothing = or(table.smoothing_ms.map(from_ms), SMOOTHING, "smoothing: 40 ms");
        let shortest_blending = or(
            table.shortest_blending_ms.map(from_ms),
            SHORTEST_BLENDING,
            "shortest time in a zone: 8 ms",
        );
        let settling = or(
            table.settling_ms.map(from_ms),
            0.0,
            "time to settle at a stop: none",
        );
        let lags = per_joint(table.lag_ms.as_deref(), count);
        let lag_u = match (&lags, per_joint(table.lag_u_ms.as_deref(), count)) {
            (None, _) => {
                assumed.push("lag of the joints: 15 ms".to_owned());
                Some(ASSUMED_U)
            }
            (Some(lags), Some(u)) => {
                let parts = u
                    .iter()
                    .zip(lags)
                    .filter(|(_, lag)| **lag > 0.0)
                    .map(|(u, lag)| u / lag);
                parts.max_by(f64::total_cmp)
            }
            (Some(_), None) => None,
        };
        let lags = lags.map_or_else(
            || vec![LAG; count],
            |lags| lags.into_iter().map(from_ms).collect(),
        );
        let feed_forward = table.speed_feed_forward.unwrap_or(0.0);
        MotionSetting {
            model: MotionModel {
                limits: MotionLimits { joints, acceleration },
                smoothing,
                shortest_blending,
                lags: lags.into_iter().map(|time| Lag { time, feed_forward }).collect(),
                settling,
                motor_leads: table.motor_lead_s2.clone().unwrap_or_default(),
                passage: match table.zone_mm {
                    Some(0.0) => Passage::Stop,
                    Some(zone) => Passage::Zone(from_mm(zone)),
                    None => Passage::Within {
                        error: from_um(table.rounding_um.unwrap_or(ROUNDING_UM)),
                        most: LARGEST_ZONE,
                    },
                },
                feed: table.feed_mm_per_min.map(|feed| from_mm(feed) / 60.0),
                rapid,
            },
            lag_u,
            assumed,
            source: table.source.clone(),
        }
    }
}

impl MotionSetting {
    /// Relative standard uncertainty of the lag; zero where it is not known.
    pub fn known_lag_u(&self) -> f64 {
        self.lag_u.unwrap_or(0.0)
    }

    /// Names of the inputs that have an effect on the deviation, but no uncertainty.
    pub fn inputs_without_uncertainty(&self) -> Vec<String> {
        let is_late = self.model.lags.iter().any(|lag| lag.time > 0.0);
        let lag = (is_late && self.lag_u.is_none()).then(|| "the lag of the joints".to_owned());
        lag.into_iter()
            .chain(["the rounding of corners".to_owned()])
            .collect()
    }
}

/// One value for each joint, of a list that may have one for all; `None` without a list, or of another length.
fn per_joint(list: Option<&[f64]>, count: usize) -> Option<Vec<f64>> {
    match list? {
        [one] => Some(vec![*one; count]),
        all if all.len() == count => Some(all.to_vec()),
        _ => None,
    }
}

//! Joint positions over time as an arm follows a path: the command of each way from stop to stop, and joints that follow late.
//!
//! [`motion_along`](super::motion_along) gives the motion at the points of a path; this gives it at even times, as a controller logs it.

use super::along::MotionModel;
use super::jerk::Timed;
use super::joint_path::JointPath;
use super::rounded::Programmed;
use super::speed::fastest;

/// Accelerations are differences over this time before and after, s: rounded corners are polygons, whose edges would be steps of the speed.
const OVER: f64 = 4e-3;

/// Joint positions at even times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Followed {
    /// s, from the start of the first way.
    pub times: Vec<f64>,
    /// Joint positions of the motors, rad (m), instant after instant.
    pub positions: Vec<f64>,
    /// Time at which the command is at the end, s.
    pub duration: f64,
}

/// The motion of an arm along `ways`, one after the other, with a stop after each and the time to settle there, every `step` seconds until `rest` seconds after the command ends.
///
/// Zones are not enlarged to the shortest blending time: see [`MotionModel::least_zone`].
///
/// # Panics
/// As [`Programmed::rounded`]; if the numbers of joints differ.
pub fn followed(ways: &[Programmed<'_>], model: &MotionModel, step: f64, rest: f64) -> Followed {
    let joints = model.limits.joints.len();
    let mut found = Followed::default();
    let mut commanded: Vec<Vec<f64>> = vec![Vec::new(); joints];
    for (number, way) in ways.iter().enumerate() {
        let path = way.rounded();
        let joint_path = JointPath::new(joints, &path.positions, path.along.clone(), |_| false);
        let profile = fastest(&joint_path, &model.limits, &path.feeds);
        let timed = Timed::of(&profile, &path.along, model.smoothing);
        let end = found.duration + timed.duration();
        // Even times continue across the stop.
        while found.times.len() as f64 * step < end {
            let time = found.times.len() as f64 * step;
            let along = timed.at(time - found.duration).along;
            let k = path
                .along
                .partition_point(|at| *at <= along)
                .clamp(1, path.along.len() - 1);
            let part = (along - path.along[k - 1]) / (path.along[k] - path.along[k - 1]);
            for (joint, positions) in commanded.iter_mut().enumerate() {
                let [from, to] = [k - 1, k].map(|k| path.positions[k * joints + joint]);
                positions.push(from + part.clamp(0.0, 1.0) * (to - from));
            }
            found.times.push(time);
        }
        found.duration = end;
        if number + 1 < ways.len() {
            let resume = found.duration + model.settling;
            while found.times.len() as f64 * step < resume {
                found.times.push(found.times.len() as f64 * step);
                for (joint, positions) in commanded.iter_mut().enumerate() {
                    positions.push(path.positions[path.positions.len() - joints + joint]);
                }
            }
            found.duration = resume;
        }
    }
    let last: Vec<f64> = ways.last().map_or_else(Vec::new, |way| {
        way.positions[way.positions.len() - joints..].to_vec()
    });
    while (found.times.len() as f64) * step < found.duration + rest && !last.is_empty() {
        found.times.push(found.times.len() as f64 * step);
        for (positions, last) in commanded.iter_mut().zip(&last) {
            positions.push(*last);
        }
    }
    let of_arm = model
        .lags
        .iter()
        .zip(&commanded)
        .map(|(lag, commanded)| lag.followed(&found.times, commanded));
    let mut actual: Vec<Vec<f64>> = of_arm.collect();
    for (positions, lead) in actual.iter_mut().zip(&model.motor_leads) {
        add_lead(positions, *lead, step);
    }
    found.positions = (0..found.times.len())
        .flat_map(|index| actual.iter().map(move |joint| joint[index]))
        .collect();
    found
}

/// Adds the lead of a motor, s^2 times its acceleration, to positions at even times, s apart.
fn add_lead(positions: &mut [f64], lead: f64, step: f64) {
    if lead == 0.0 || positions.is_empty() {
        return;
    }
    let over = ((OVER / step).ceil() as usize).max(1);
    let last = positions.len() - 1;
    let of_arm = positions.to_vec();
    let factor = lead / (over as f64 * step).powi(2);
    for (k, position) in positions.iter_mut().enumerate() {
        let [before, after] = [k.saturating_sub(over), (k + over).min(last)].map(|k| of_arm[k]);
        *position += factor * (before - 2.0 * of_arm[k] + after);
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::motion::{JointLimits, Lag, MotionLimits};
    use crate::path::Passage;

    fn model(smoothing: f64, lag: f64) -> MotionModel {
        let limit = JointLimits {
            speed: f64::INFINITY,
            acceleration: f64::INFINITY,
        };
        MotionModel {
            limits: MotionLimits {
                joints: vec![limit; 2],
                acceleration: 4.0,
            },
            smoothing,
            settling: 0.0,
            shortest_blending: 0.01,
            lags: vec![
                Lag {
                    time: lag,
                    feed_forward: 0.0
                };
                2
            ],
            motor_leads: Vec::new(),
            passage: Passage::Stop,
            feed: None,
            rapid: 1.0,
        }
    }

    #[test]
    fn a_way_takes_length_over_speed_speed_over_acceleration_and_the_window() {
        // A point each millimetre, so that the end of a ramp is near one.
        let points: Vec<Point3<f64>> = (0..=500)
            .map(|k| Point3::new(f64::from(k) * 1e-3, 0.0, 0.0))
            .collect();
        let positions: Vec<f64> = points.iter().flat_map(|at| [at.x, at.y]).collect();
        let way = Programmed {
            points: &points,
            positions: &positions,
            feeds: &[0.5; 500],
            zones: &[],
        };
        let found = followed(&[way, way], &model(0.04, 0.0), 1e-3, 0.1);
        // 0.5 / 0.5 + 0.5 / 4 + 0.04, twice.
        assert!((found.duration - 2.0 * 1.165).abs() < 1e-4, "{}", found.duration);
        let settled = MotionModel {
            settling: 0.05,
            ..model(0.04, 0.0)
        };
        let later = followed(&[way, way], &settled, 1e-3, 0.1);
        assert!(
            (later.duration - found.duration - 0.05).abs() < 1e-12,
            "once between two ways"
        );
        let middle = found.times.iter().position(|time| *time >= 0.5825).unwrap();
        assert!(
            (found.positions[2 * middle] - 0.25).abs() < 1e-3,
            "half way after half of the time"
        );
        assert!((found.positions[found.positions.len() - 2] - 0.5).abs() < 1e-12);
    }

    #[test]
    fn a_joint_is_late_by_its_time_constant() {
        let points = [Point3::new(0.0, 0.0, 0.0), Point3::new(0.5, 0.0, 0.0)];
        let way = Programmed {
            points: &points,
            positions: &[0.0, 0.0, 0.5, 0.0],
            feeds: &[0.5],
            zones: &[],
        };
        let at = |lag: f64| {
            let found = followed(&[way], &model(0.0, lag), 1e-3, 0.2);
            found.positions[2 * 600]
        };
        assert!((at(0.0) - at(0.02) - 0.5 * 0.02).abs() < 1e-9);
    }

    #[test]
    fn a_motor_is_ahead_of_the_arm_in_proportion_to_its_acceleration() {
        let points = [Point3::new(0.0, 0.0, 0.0), Point3::new(0.5, 0.0, 0.0)];
        let way = Programmed {
            points: &points,
            positions: &[0.0, 0.0, 0.5, 0.0],
            feeds: &[0.5],
            zones: &[],
        };
        let arm = followed(&[way], &model(0.04, 0.0), 1e-3, 0.2);
        let motors = MotionModel {
            motor_leads: vec![4e-4, 0.0],
            ..model(0.04, 0.0)
        };
        let motors = followed(&[way], &motors, 1e-3, 0.2);
        let ahead = |time: usize| motors.positions[2 * time] - arm.positions[2 * time];
        // Speeding up with 4 m/s^2, at the feed, at rest.
        assert!((ahead(80) - 4e-4 * 4.0).abs() < 1e-9, "{}", ahead(80));
        assert!(ahead(500).abs() < 1e-12 && ahead(1250).abs() < 1e-12);
        assert!((ahead(1085) + 4e-4 * 4.0).abs() < 1e-9, "{}", ahead(1085));
    }

    #[test]
    fn the_least_zone_is_half_of_the_way_in_the_shortest_blending_time() {
        assert!((model(0.0, 0.0).least_zone(0.5) - 0.0025).abs() < 1e-15);
    }
}

//! Whole turns of joints along a chain of postures: a joint that has turned round and round on a cut meets its limit.
//!
//! A posture gives the position of a joint up to whole turns. Along a cut the joint moves by small steps `by`; its
//! position relative to that at the start of the cut is their sum, with a smallest and a largest value so far. The cut can
//! be driven if a whole number of turns `k` at its start keeps all of it within the limits:
//!
//! ```text
//! lower <= low + 2 pi k        high + 2 pi k <= upper
//! ```

use std::f64::consts::TAU;

use crate::robot::Robot;

/// Joints that are followed; on an arm of six joints two can turn more than once, the fourth and the sixth.
const MOST: usize = 4;
/// Rounding of a position at its limit, rad.
const AT_LIMIT: f64 = 1e-9;

/// A joint that can be whole turns away within its limits, rad.
#[derive(Clone, Copy, Debug, PartialEq)]
struct WindingJoint {
    joint: usize,
    lower: f64,
    upper: f64,
}

/// The joints of an arm that can be whole turns away within their limits.
#[derive(Clone, Debug, Default)]
pub(super) struct WindingJoints(Vec<WindingJoint>);

/// Positions of these joints, continued from point to point since the start of the cut, with their extremes, rad.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Winding {
    now: [f64; MOST],
    low: [f64; MOST],
    high: [f64; MOST],
}

impl WindingJoints {
    /// Those of `robot` for which `wraps` holds and that have limits.
    pub fn of(robot: &Robot, wraps: impl Fn(usize) -> bool) -> WindingJoints {
        let joints = robot.joints().iter().enumerate();
        let winding = joints
            .filter(|(joint, _)| wraps(*joint))
            .filter_map(|(joint, of)| {
                let limits = of.limits?;
                Some(WindingJoint {
                    joint,
                    lower: limits.lower,
                    upper: limits.upper,
                })
            });
        WindingJoints(winding.take(MOST).collect())
    }

    /// Whether there is no such joint.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// At the start of a cut with these joint positions, rad.
    pub fn start(&self, q: &[f64]) -> Winding {
        let mut winding = Winding::default();
        for (slot, joint) in self.0.iter().enumerate() {
            winding.now[slot] = q[joint.joint];
        }
        Winding {
            low: winding.now,
            high: winding.now,
            ..winding
        }
    }

    /// After motions `by(joint)`, rad; `None` where no number of whole turns at the start keeps a joint within its limits.
    pub fn after(&self, before: &Winding, by: impl Fn(usize) -> f64) -> Option<Winding> {
        let mut after = *before;
        for (slot, joint) in self.0.iter().enumerate() {
            after.now[slot] += by(joint.joint);
            after.low[slot] = after.low[slot].min(after.now[slot]);
            after.high[slot] = after.high[slot].max(after.now[slot]);
            let least = ((joint.lower - AT_LIMIT - after.low[slot]) / TAU).ceil();
            let most = ((joint.upper + AT_LIMIT - after.high[slot]) / TAU).floor();
            if least > most {
                return None;
            }
        }
        Some(after)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::{Amount, Axis, Joint, Limits, Motion};

    /// The second of three joints turns by 350 deg to either side.
    fn joints() -> WindingJoints {
        let motions = (0..3).map(|i| Motion::About(Axis::Z, Amount::Joint(i))).collect();
        let mut joints = ["A", "B", "C"].map(Joint::plain).to_vec();
        joints[1].limits = Some(Limits {
            lower: -350f64.to_radians(),
            upper: 350f64.to_radians(),
        });
        WindingJoints::of(&Robot::new("arm", motions, joints).unwrap(), |_| true)
    }

    /// Degrees that the joint turns in steps of 10 deg before it meets its limit.
    fn turned(from_deg: f64, step_deg: f64) -> f64 {
        let joints = joints();
        let mut winding = joints.start(&[0.0, from_deg.to_radians(), 0.0]);
        let mut turned = 0.0;
        while let Some(next) = joints.after(&winding, |_| step_deg.to_radians()) {
            (winding, turned) = (next, turned + step_deg);
        }
        turned
    }

    #[test]
    fn a_joint_turns_as_far_as_its_range_from_the_best_whole_turn() {
        // From -350, 10 or 370 deg, whichever is within the limits and farthest from the limit ahead.
        assert_eq!(turned(10.0, 10.0), 700.0);
        assert_eq!(turned(-170.0, 10.0), 520.0);
        assert_eq!(turned(190.0, 10.0), 520.0);
        assert_eq!(turned(-10.0, -10.0), -700.0);
    }

    #[test]
    fn extremes_of_both_directions_are_kept() {
        let joints = joints();
        let step = |winding: Winding, deg: f64| joints.after(&winding, |_| f64::to_radians(deg));
        let winding = joints.start(&[0.0; 3]);
        let there = step(winding, 340.0).and_then(|winding| step(winding, -680.0));
        // From -340 to 340 deg it fits, but 20 deg more do not, though the joint is far from its other limit.
        assert!(there.is_some_and(|winding| step(winding, 340.0).is_some()));
        assert_eq!(there.and_then(|winding| step(winding, -20.0)), None);
    }

    #[test]
    fn joints_without_limits_are_not_followed() {
        let motions = vec![Motion::About(Axis::Z, Amount::Joint(0))];
        let robot = Robot::new("arm", motions, vec![Joint::plain("A")]).unwrap();
        assert!(WindingJoints::of(&robot, |_| true).is_empty());
        assert!(WindingJoints::of(&robot, |_| false).is_empty());
    }
}

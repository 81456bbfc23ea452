//! Changes of joint positions: sign, zero, order and unit.

use std::f64::consts::{FRAC_PI_2, PI};

use armill_core::robot::Robot;
use armill_core::units::to_deg;

/// Another reading of the joint columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointChange {
    /// The joint is positive the other way.
    Negated(usize),
    /// The joint is at this angle more, rad.
    Zero(usize, f64),
    /// The columns of a joint and the next are exchanged.
    Exchanged(usize),
    /// Angles in radians were given as degrees.
    Radians,
}

impl JointChange {
    /// Every change for this robot: signs, zeros, orders, unit.
    pub fn all(robot: &Robot) -> Vec<JointChange> {
        let joints = robot.joints().len();
        let revolute: Vec<usize> = (0..joints).filter(|joint| !robot.slides(*joint)).collect();
        let signs = (0..joints).map(JointChange::Negated);
        let zeros = revolute
            .iter()
            .flat_map(|joint| [FRAC_PI_2, -FRAC_PI_2, PI].map(|by| JointChange::Zero(*joint, by)));
        let orders = (0..joints.saturating_sub(1)).map(JointChange::Exchanged);
        signs
            .chain(zeros)
            .chain(orders)
            .chain([JointChange::Radians])
            .collect()
    }

    /// The changed joint positions, rad (m).
    pub fn of(&self, robot: &Robot, joints: &[f64]) -> Vec<f64> {
        let mut changed = joints.to_vec();
        match *self {
            JointChange::Negated(joint) => changed[joint] = -changed[joint],
            JointChange::Zero(joint, by) => changed[joint] += by,
            JointChange::Exchanged(joint) => changed.swap(joint, joint + 1),
            JointChange::Radians => {
                for (joint, q) in changed.iter_mut().enumerate() {
                    if !robot.slides(joint) {
                        *q = to_deg(*q);
                    }
                }
            }
        }
        changed
    }

    /// What is changed: `joint A2 negated`, `90 deg added to joint A3`.
    pub fn words(&self, robot: &Robot) -> String {
        let name = |joint: usize| robot.joints().get(joint).map_or("", |joint| &joint.name);
        match *self {
            JointChange::Negated(joint) => format!("joint {} negated", name(joint)),
            JointChange::Zero(joint, by) => {
                format!("{:.0} deg added to joint {}", to_deg(by), name(joint))
            }
            JointChange::Exchanged(joint) => {
                format!("joints {} and {} exchanged", name(joint), name(joint + 1))
            }
            JointChange::Radians => "joint positions in rad, not in deg".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use armill_study::robots;

    use super::*;

    #[test]
    fn each_change_is_named_and_changes_only_what_it_names() {
        let found = robots::find("yaskawa/mh12", ".".as_ref()).unwrap();
        let robot = &found.robot;
        let all = JointChange::all(robot);
        assert_eq!(all.len(), 6 + 18 + 5 + 1);
        let q = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
        for change in &all {
            let changed = change.of(robot, &q);
            let differ = (0..6).filter(|k| changed[*k] != q[*k]).count();
            let expected = match change {
                JointChange::Negated(_) | JointChange::Zero(..) => 1,
                JointChange::Exchanged(_) => 2,
                JointChange::Radians => 6,
            };
            assert_eq!(differ, expected, "{}", change.words(robot));
        }
        assert_eq!(
            JointChange::Zero(1, -FRAC_PI_2).words(robot),
            "-90 deg added to joint L"
        );
        assert_eq!(JointChange::Exchanged(0).words(robot), "joints S and L exchanged");
    }
}

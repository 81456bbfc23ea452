//! Reach of an arm: the greatest distance of its wrist centre from its first axis.
//!
//! `reach = hypot(a1 + l2 + l3, b)`
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `a1` | distance between axes 1 and 2 | m |
//! | `l2`, `l3` | upper arm (axis 2 to 3) and forearm (axis 3 to wrist centre), seen along axis 2 | m |
//! | `b` | lateral offset of the wrist centre from axis 1 | m |
//!
//! Makers name most arms by it (KR 120 R2500: 2.5 m). Joint limits are neglected: an arm whose elbow cannot
//! stretch has less reach.

use super::model::Robot;

/// The reach of `robot`, m; `None` where it is not an ortho-parallel arm with spherical wrist.
pub fn reach(robot: &Robot) -> Option<f64> {
    let arm = robot.ortho_parallel()?;
    Some((arm.a1.abs() + arm.links.l2 + arm.links.l3).hypot(arm.b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::forward::forward;
    use crate::robot::{Amount, Axis, Joint, Motion};

    /// An arm of lengths 150, 600, 700 and 50 mm across, with its wrist 30 mm to the side.
    fn arm(wrist_offset: f64) -> Robot {
        let (along, about) = (
            |axis, m| Motion::Along(axis, Amount::Constant(m)),
            |axis, joint| Motion::About(axis, Amount::Joint(joint)),
        );
        let motions = vec![
            along(Axis::Z, 0.4),
            about(Axis::Z, 0),
            along(Axis::X, 0.15),
            about(Axis::Y, 1),
            along(Axis::Z, 0.6),
            about(Axis::Y, 2),
            along(Axis::Y, 0.03),
            along(Axis::Z, 0.05),
            about(Axis::X, 3),
            along(Axis::X, 0.7),
            about(Axis::Y, 4),
            along(Axis::Z, wrist_offset),
            about(Axis::X, 5),
        ];
        Robot::new("arm", motions, vec![Joint::plain("j"); 6]).unwrap()
    }

    #[test]
    fn stretched_links_and_the_lateral_offset_add_up() {
        let expected = (0.15 + 0.6 + 0.7_f64.hypot(0.05)).hypot(0.03);
        assert!((reach(&arm(0.0)).unwrap() - expected).abs() < 1e-15);
    }

    #[test]
    fn no_posture_exceeds_the_reach() {
        let robot = arm(0.0);
        let reach = reach(&robot).unwrap();
        let mut farthest = 0.0_f64;
        for i in 0..200 {
            for j in 0..200 {
                let q = [0.3, 0.0314 * f64::from(i), 0.0314 * f64::from(j), 0.0, 0.0, 0.0];
                let wrist = forward(&robot, &q).origin(4);
                farthest = farthest.max(wrist.x.hypot(wrist.y));
            }
        }
        // A step of 1.8 deg at two joints misses the stretched arm by less than 1.4 m (1 - cos 1.8 deg) = 0.7 mm.
        assert!(
            farthest <= reach + 1e-12 && farthest > reach - 0.7e-3,
            "{farthest} m of {reach} m"
        );
    }

    #[test]
    fn an_arm_without_spherical_wrist_has_none() {
        assert_eq!(reach(&arm(0.1)), None);
    }
}

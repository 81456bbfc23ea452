//! Geometry: the arm differs from the model in its controller.
//!
//! ```text
//! delta = T_actual(q) e - T_believed(q) e
//! ```
//!
//! | symbol | meaning |
//! |---|---|
//! | `q` | joint positions that the controller commands |
//! | `T` | base to flange of the calibrated arm, and of the model in the controller |
//! | `e` | the tool on its flange |
//!
//! Both arms have the same base and carry the same tool. Source: definition; `docs/theory/unloaded.md`.

use crate::frame::Isometry;
use crate::robot::Robot;
use crate::robot::forward::forward;
use crate::robot::inverse::tool_on;
use crate::spatial::Twist;

/// Deviation of the tool of `actual` from the pose that its controller, with the model `believed`, computes at `q`:
/// displacement (m) of the TCP and rotation (rad), base. Not checked: that both have the same number of joints.
pub fn displacement(believed: &Robot, actual: &Robot, flange_from_tool: &Isometry, q: &[f64]) -> Twist {
    let tool = |robot: &Robot| tool_on(&forward(robot, q), flange_from_tool);
    let [believed, actual] = [believed, actual].map(tool);
    Twist {
        linear: actual.translation.vector - believed.translation.vector,
        angular: (actual.rotation * believed.rotation.inverse()).scaled_axis(),
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::arms;
    use crate::robot::{Amount, Motion};

    /// The arm with its constant number `which` longer (m) or rotated further (rad) by this.
    fn other(which: usize, by: f64) -> Robot {
        let robot = arms::mh12();
        let mut motions = robot.chain().motions().to_vec();
        let constants = motions.iter_mut().filter_map(|motion| match motion {
            Motion::Along(_, Amount::Constant(value)) | Motion::About(_, Amount::Constant(value)) => {
                Some(value)
            }
            _ => None,
        });
        *constants.into_iter().nth(which).unwrap() += by;
        Robot::new("other", motions, robot.joints().to_vec()).unwrap()
    }

    #[test]
    fn an_arm_equal_to_its_model_has_no_deviation() {
        let robot = arms::mh12();
        let at = displacement(
            &robot,
            &robot,
            &arms::bent_tool(),
            &[0.3, -0.2, 0.4, 0.1, -0.9, 0.5],
        );
        assert_eq!((at.linear.norm(), at.angular.norm()), (0.0, 0.0));
    }

    #[test]
    fn a_higher_base_lifts_the_tool_without_rotation() {
        let robot = arms::mh12();
        // The first constant of the chain is the height of the base.
        let at = displacement(
            &robot,
            &other(0, 3e-4),
            &arms::bent_tool(),
            &[0.3, -0.2, 0.4, 0.1, -0.9, 0.5],
        );
        assert!((at.linear - Vector3::z() * 3e-4).norm() < 1e-15, "{at:?}");
        assert!(at.angular.norm() < 1e-15);
    }

    #[test]
    fn small_errors_add_to_the_first_order() {
        let (robot, q, tool) = (arms::mh12(), [0.3, -0.2, 0.4, 0.1, -0.9, 0.5], arms::bent_tool());
        let of = |which, by| displacement(&robot, &other(which, by), &tool, &q);
        for which in 0..3 {
            let (one, two) = (of(which, 1e-6), of(which, 2e-6));
            assert!((two.linear - one.linear * 2.0).norm() < 1e-11);
        }
    }
}

//! Jumps: points of a cut between which a joint turns so far that the arm must stop.

use crate::kernel::Answers;
use crate::path::SampledPath;
use crate::robot::Robot;

/// A joint that turns farther than this from one point to the next jumps, rad.
const FAR: f64 = 0.5;

/// A joint that turns far between two neighbouring points of a cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// The point after it.
    pub index: usize,
    /// Joint.
    pub joint: usize,
    /// Angle, rad.
    pub by: f64,
}

/// The jumps of `robot` along `path`, in order; prismatic joints and rapids are not included.
pub fn jumps<'a>(
    robot: &'a Robot,
    path: &'a SampledPath,
    answers: &'a Answers,
) -> impl Iterator<Item = Jump> + 'a {
    let reached = |i: usize| answers.points[i].is_ok();
    let follow = (1..answers.points.len()).filter(move |i| !path.begins(*i) && reached(*i) && reached(i - 1));
    follow.flat_map(move |index| {
        let turns = answers.joints_at(index - 1).iter().zip(answers.joints_at(index));
        let by = turns.map(|(before, after)| after - before).enumerate();
        by.filter(|(joint, by)| !robot.slides(*joint) && by.abs() >= FAR)
            .map(move |(joint, by)| Jump { index, joint, by })
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::Point2;

    use super::*;
    use crate::arms::answers_at;
    use crate::path::Shape;
    use crate::robot::{Amount, Axis, Joint, Motion, Unreachable};

    /// A rail with a revolute joint.
    fn robot() -> Robot {
        let motions = vec![
            Motion::Along(Axis::X, Amount::Joint(0)),
            Motion::About(Axis::Z, Amount::Joint(1)),
        ];
        Robot::new("rail", motions, vec![Joint::plain("R"), Joint::plain("A")]).unwrap()
    }

    #[test]
    fn a_joint_that_turns_far_jumps_and_a_rail_that_slides_far_does_not() {
        let path = Shape::Polyline(vec![Point2::origin(), Point2::new(3.0, 0.0)]).sampled(1.0);
        let mut answers = answers_at(&[[0.0, 0.0], [5.0, 0.49], [5.0, -0.2], [5.0, -0.1]]);
        let robot = robot();
        let found: Vec<Jump> = jumps(&robot, &path, &answers).collect();
        let [jump] = found[..] else {
            panic!("one jump, not {found:?}")
        };
        assert_eq!((jump.index, jump.joint), (2, 1));
        assert!((jump.by + 0.69).abs() < 1e-12);
        // It is not known how the arm passes a point that it does not reach.
        answers.points[1] = Err(Unreachable::TooFar { by: 1.0 });
        assert_eq!(jumps(&robot, &path, &answers).count(), 0);
    }

    #[test]
    fn in_a_rapid_the_arm_may_turn() {
        let mut path = Shape::Polyline(vec![Point2::origin(), Point2::new(1.0, 0.0)]).sampled(1.0);
        // The second cut begins where the first ended.
        path.points.extend(path.points.clone());
        for point in &mut path.points[2..] {
            point.along += 1.0;
        }
        let robot = robot();
        assert_eq!(
            jumps(
                &robot,
                &path,
                &answers_at(&[[0.0, 0.0], [0.0, 0.1], [0.0, 2.0], [0.0, 2.1]])
            )
            .count(),
            0
        );
    }
}

//! Obstacles of a cut: where the arm cannot follow a path at its feed without a stop.
//!
//! | obstacle | condition |
//! |---|---|
//! | unreachable | no posture |
//! | collision | no posture that keeps the demanded clearance |
//! | outside limits | a joint is nearer to its limit than the margin, with the whole turns that it has made on the cut |
//! | jump | a joint turns by half a radian or more between neighbouring points |
//! | joint speed | a joint would have to move faster than its maximum to keep the feed |
//!
//! Rapids are excluded: there the arm may move in any way. The speed of a joint is its mean over the move between two
//! points; a controller also needs time to accelerate.
//!
//! [`turns_along`]: limits and whole turns alone, for the placements of a search.

use super::turns::continue_turns;
use crate::kernel::{AT_LIMIT, Answers, Question, evaluate_in_order};
use crate::path::{Pace, SampledPath, Track};
use crate::robot::{Robot, Unreachable};
use crate::spatial::Wrench;
use crate::watch::{Cancelled, Watch};

/// A joint that turns farther than this from one point to the next jumps, rad.
const FAR: f64 = 0.5;
/// Rounding of a speed at its maximum.
const AT_SPEED: f64 = 1.0 + 1e-9;

/// An obstacle at one point of a cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obstacle {
    /// The point; of a move the point at its end.
    pub index: usize,
    /// What it is.
    pub kind: ObstacleKind,
}

/// What keeps the arm from following a cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ObstacleKind {
    /// No posture.
    Unreachable,
    /// No posture keeps the demanded clearance.
    InCollision {
        /// How much of it is missing, m.
        missing: f64,
    },
    /// A joint too near to its limit, or outside.
    OutsideLimits {
        /// Joint.
        joint: usize,
        /// Distance from its limit, rad (m); negative outside.
        margin: f64,
    },
    /// A revolute joint turns so far that the arm must stop.
    Jump {
        /// Joint.
        joint: usize,
        /// Angle, rad.
        by: f64,
    },
    /// A joint is too slow for the feed.
    TooSlow {
        /// Joint.
        joint: usize,
        /// Speed that the feed requires, rad/s (m/s).
        required: f64,
        /// Its maximum.
        maximum: f64,
    },
}

/// The obstacles of `robot` along `path` in the postures `answers`, in order. Joints must be at least `margin` (rad, m)
/// from their limits.
pub fn obstacles<'a>(
    robot: &'a Robot,
    path: &'a SampledPath,
    answers: &'a Answers,
    margin: f64,
) -> impl Iterator<Item = Obstacle> + 'a {
    (0..answers.points.len()).flat_map(move |index| {
        let here = at_point(answers, index, margin);
        let follows = index > 0 && !path.begins(index);
        let both = follows && answers.points[index].is_ok() && answers.points[index - 1].is_ok();
        let moved = (both.then(|| on_move(robot, path, answers, index)).into_iter()).flatten();
        let all = here.into_iter().chain(moved);
        all.map(move |kind| Obstacle { index, kind })
    })
}

/// How far the joints are from their limits along a path, with the whole turns that they make on each cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnsAlong {
    /// Points that are unreachable, or where a revolute joint is nearer to a limit than the margin.
    pub lost: usize,
    /// Smallest distance of a revolute joint from its limits, less the margin, rad; infinite without limits.
    pub room: f64,
    /// Farthest that a revolute joint turns from one point of a cut to the next, rad.
    pub largest_step: f64,
}

/// The joints along `track` in the branch of `question`, at least `margin` (rad) from their limits. Loads are not used.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
pub fn turns_along(
    question: &Question<'_>,
    track: &Track,
    margin: f64,
    watch: Watch<'_>,
) -> Result<TurnsAlong, Cancelled> {
    let robot = question.arm.robot;
    let unloaded = Question {
        cases: &[Wrench::ZERO],
        homes: track.homes.as_deref(),
        ..*question
    };
    let pose = |index: usize| track.stop(index).base_from_tool;
    let mut answers = evaluate_in_order(&unloaded, track.len(), pose, watch)?;
    continue_turns(robot, &track.path, &mut answers);
    let revolute: Vec<usize> = (0..answers.joint_count)
        .filter(|joint| !robot.slides(*joint))
        .collect();
    let mut found = TurnsAlong {
        lost: 0,
        room: f64::INFINITY,
        largest_step: 0.0,
    };
    for (index, point) in answers.points.iter().enumerate() {
        let q = answers.joints_at(index);
        let follows = index > 0 && !track.path.begins(index) && answers.points[index - 1].is_ok();
        let (mut room, mut step) = (f64::INFINITY, 0.0f64);
        for joint in revolute.iter().copied().filter(|_| point.is_ok()) {
            if let Some(limits) = robot.joints()[joint].limits {
                room = room.min(limits.margin(q[joint]) - margin);
            }
            if follows {
                step = step.max((q[joint] - answers.joints_at(index - 1)[joint]).abs());
            }
        }
        found.lost += usize::from(point.is_err() || room < -AT_LIMIT);
        found.room = found.room.min(room);
        found.largest_step = found.largest_step.max(step);
    }
    Ok(found)
}

/// The obstacle of the point itself.
fn at_point(answers: &Answers, index: usize, margin: f64) -> Option<ObstacleKind> {
    let evaluation = match &answers.points[index] {
        Ok(evaluation) => evaluation,
        Err(Unreachable::InCollision { missing, .. }) => {
            return Some(ObstacleKind::InCollision { missing: *missing });
        }
        Err(_) => return Some(ObstacleKind::Unreachable),
    };
    (evaluation.limit_margin + AT_LIMIT < margin).then_some(ObstacleKind::OutsideLimits {
        joint: evaluation.limit_joint,
        margin: evaluation.limit_margin,
    })
}

/// The obstacles of the move to point `index`: of each joint one at most.
fn on_move<'a>(
    robot: &'a Robot,
    path: &'a SampledPath,
    answers: &'a Answers,
    index: usize,
) -> impl Iterator<Item = ObstacleKind> + 'a {
    let (before, here) = (&path.points[index - 1], &path.points[index]);
    let time = match here.pace {
        Pace::Feed(feed) if feed > 0.0 => Some((here.along - before.along) / feed).filter(|time| *time > 0.0),
        _ => None,
    };
    let moves = answers.joints_at(index - 1).iter().zip(answers.joints_at(index));
    moves.enumerate().filter_map(move |(joint, (from, to))| {
        let by = to - from;
        if !robot.slides(joint) && by.abs() >= FAR {
            return Some(ObstacleKind::Jump { joint, by });
        }
        let (maximum, time) = robot.joints()[joint].max_speed.zip(time)?;
        let required = by.abs() / time;
        (required > maximum * AT_SPEED).then_some(ObstacleKind::TooSlow {
            joint,
            required,
            maximum,
        })
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::Point2;

    use super::*;
    use crate::arms::answers_at;
    use crate::path::Shape;
    use crate::robot::{Amount, Axis, Joint, Motion};

    /// A rail with a revolute joint.
    fn robot() -> Robot {
        let motions = vec![
            Motion::Along(Axis::X, Amount::Joint(0)),
            Motion::About(Axis::Z, Amount::Joint(1)),
        ];
        let joints = ["R", "A"].map(|name| Joint {
            max_speed: Some(2.0),
            ..Joint::plain(name)
        });
        Robot::new("rail", motions, joints.to_vec()).unwrap()
    }

    fn line(length: f64) -> SampledPath {
        Shape::Polyline(vec![Point2::origin(), Point2::new(length, 0.0)]).sampled(1.0)
    }

    fn found(path: &SampledPath, answers: &Answers, margin: f64) -> Vec<Obstacle> {
        obstacles(&robot(), path, answers, margin).collect()
    }

    #[test]
    fn a_joint_that_turns_far_jumps_and_a_rail_that_slides_far_does_not() {
        let mut answers = answers_at(&[[0.0, 0.0], [5.0, 0.49], [5.0, -0.2], [5.0, -0.1]]);
        let all = found(&line(3.0), &answers, 0.0);
        let [
            Obstacle {
                index: 2,
                kind: ObstacleKind::Jump { joint: 1, by },
            },
        ] = all[..]
        else {
            panic!("one jump, not {all:?}")
        };
        assert!((by + 0.69).abs() < 1e-12);
        // It is not known how the arm passes a point that it does not reach.
        answers.points[1] = Err(Unreachable::TooFar { by: 1.0 });
        let unreachable = Obstacle {
            index: 1,
            kind: ObstacleKind::Unreachable,
        };
        assert_eq!(found(&line(3.0), &answers, 0.0), [unreachable]);
    }

    #[test]
    fn in_a_rapid_the_arm_may_turn() {
        let mut path = line(1.0);
        // The second cut begins where the first ended.
        path.points.extend(path.points.clone());
        for point in &mut path.points[2..] {
            point.along += 1.0;
        }
        let answers = answers_at(&[[0.0, 0.0], [0.0, 0.1], [0.0, 2.0], [0.0, 2.1]]);
        assert_eq!(found(&path, &answers, 0.0), []);
    }

    #[test]
    fn a_joint_that_must_exceed_its_speed_at_the_feed_is_an_obstacle_and_without_a_feed_it_is_not() {
        let mut path = line(2.0);
        let answers = answers_at(&[[0.0, 0.0], [0.0, 0.2], [0.3, 0.3]]);
        assert_eq!(found(&path, &answers, 0.0), []);
        // A metre in 1/12 s: the revolute joint makes 2.4 rad/s on the first move and 1.2 on the second, where the
        // rail makes 3.6 m/s.
        for point in &mut path.points {
            point.pace = Pace::Feed(12.0);
        }
        let all = found(&path, &answers, 0.0);
        let too_slow: Vec<(usize, usize, f64)> = all
            .iter()
            .map(|obstacle| match obstacle.kind {
                ObstacleKind::TooSlow { joint, required, .. } => (obstacle.index, joint, required),
                other => panic!("{other:?}"),
            })
            .collect();
        assert_eq!(too_slow.len(), 2);
        for (found, expected) in too_slow.iter().zip([(1, 1, 2.4), (2, 0, 3.6)]) {
            assert_eq!((found.0, found.1), (expected.0, expected.1));
            assert!((found.2 - expected.2).abs() < 1e-12);
        }
    }

    #[test]
    fn a_joint_nearer_to_its_limit_than_the_margin_is_an_obstacle() {
        let mut answers = answers_at(&[[0.0, 0.0], [0.0, 0.1]]);
        for (point, margin) in answers.points.iter_mut().zip([0.5, -0.01]) {
            let evaluation = point.as_mut().unwrap();
            (evaluation.limit_joint, evaluation.limit_margin) = (1, margin);
        }
        let indices = |margin: f64| -> Vec<usize> {
            let all = found(&line(1.0), &answers, margin);
            all.iter().map(|obstacle| obstacle.index).collect()
        };
        assert_eq!(indices(0.0), [1]);
        assert_eq!(indices(0.6), [0, 1]);
    }
}

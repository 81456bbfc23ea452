//! Where does the arm jump? Points of a cut between which a joint turns so far that no arm follows without a stop.

use crate::kernel::Answers;
use crate::path::SampledPath;
use crate::robot::Robot;

/// A joint that turns farther than this from one point to the next jumps, rad.
const FAR: f64 = 0.5;

/// A joint that turns far between two points next to each other on a cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// The point after it.
    pub index: usize,
    /// Which joint.
    pub joint: usize,
    /// By how much, rad.
    pub by: f64,
}

/// The jumps of `robot` along `path`, in order; sliding joints do not count, nor what happens in a rapid.
pub fn jumps<'a>(
    robot: &'a Robot,
    path: &'a SampledPath,
    answers: &'a Answers,
) -> impl Iterator<Item = Jump> + 'a {
    let held = |i: usize| answers.points[i].is_ok();
    let follow = (1..answers.points.len()).filter(move |i| !path.begins(*i) && held(*i) && held(i - 1));
    follow.flat_map(move |index| {
        let turns = answers.joints_at(index - 1).iter().zip(answers.joints_at(index));
        let by = turns.map(|(before, after)| after - before).enumerate();
        by.filter(|(joint, by)| !robot.slides(*joint) && by.abs() >= FAR)
            .map(move |(joint, by)| Jump { index, joint, by })
    })
}

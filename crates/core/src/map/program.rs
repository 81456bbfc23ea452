//! Deviation along a tool path program: along the track, across it and along the tool, for loads that turn with the
//! feed.
//!
//! A program is followed in one posture: the branch is chosen once, from points spread over the path, so the arm does not
//! change its elbow in the middle of a part.

use nalgebra::{Point3, Rotation3, Vector3};

use super::turns;
use crate::frame::Isometry;
use crate::kernel::{Answers, BranchChoice, Question, Stop, evaluate_loaded};
use crate::load::PathLoad;
use crate::path::{PathPoint, Placing};
use crate::robot::{Branch, BranchPattern};
use crate::spatial::Wrench;
use crate::watch::{Cancelled, Watch};

/// Points of the path that decide on the branch.
const SPREAD: usize = 400;

/// The points of a program, where they lie, and what pushes there.
#[derive(Clone, Debug)]
pub struct Track {
    /// Its points.
    pub points: Vec<PathPoint>,
    /// Where they lie.
    pub placing: Placing,
    /// What pushes.
    pub load: PathLoad,
    /// The part whose axes a load may be told in.
    pub base_from_part: Isometry,
}

/// Answers along a program.
#[derive(Clone, Debug)]
pub struct ProgramAnswer {
    /// The branch it was followed in.
    pub choice: BranchChoice,
    /// What came out at each point; in-plane is across the tool, normal along it. No shares, no uncertainties.
    pub answers: Answers,
}

/// A deviation seen from the path, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parts {
    /// Where the tip goes: late or early, hardly seen on the part.
    pub along: f64,
    /// To the left of the track: what a wall gets.
    pub cross: f64,
    /// Along the tool, away from the part: what a floor gets.
    pub normal: f64,
}

impl Track {
    /// The tool pose at point `index`, and the tool axis as its normal.
    pub fn stop(&self, index: usize) -> Stop {
        let point = &self.points[index];
        Stop {
            base_from_tool: self.placing.base_from_tool(point),
            normal: self.placing.spindle(point),
        }
    }

    /// The least and the greatest coordinates of its points, path axes, m.
    pub fn corners(&self) -> [Point3<f64>; 2] {
        let first = self.points.first().map_or_else(Point3::origin, |point| point.at);
        let points = self.points.iter().map(|point| point.at);
        points.fold([first, first], |[low, high], at| [low.inf(&at), high.sup(&at)])
    }

    /// A deviation (m, base) at point `index`, seen from the path.
    pub fn parts(&self, index: usize, deviation: &Vector3<f64>) -> Parts {
        let seen = self.base_from_feed(index).inverse() * deviation;
        Parts {
            along: seen.x,
            cross: seen.y,
            normal: seen.z,
        }
    }

    /// Axes of the feed frame at point `index`, in base.
    pub fn base_from_feed(&self, index: usize) -> Rotation3<f64> {
        self.placing.base_from_feed(&self.points[index])
    }

    /// Fills in the wrenches at point `index`, base.
    pub fn wrenches(&self, index: usize, out: &mut [Wrench]) {
        let axes = self.base_from_feed(index);
        self.load.in_base(index, &self.base_from_part, &axes, out);
    }
}

/// The answers along `track`. What `question` says of cases, normal and doubt is not looked at.
///
/// Of several branches that match (or of all, for the best one) the arm keeps the one in which it reaches most points
/// within its limits; of equal ones for [`BranchChoice::Best`] the one with the least of the largest in-plane deviations,
/// otherwise the one with the most room to its limits.
///
/// # Errors
/// [`Cancelled`] if the watch says so.
pub fn along_program(
    question: &Question<'_>,
    track: &Track,
    watch: Watch<'_>,
) -> Result<ProgramAnswer, Cancelled> {
    let cases = vec![Wrench::from_force(Vector3::zeros()); track.load.case_count()];
    let asked = Question {
        cases: &cases,
        ..*question
    };
    let choice = chosen(&asked, track, watch)?;
    let asked = Question { choice, ..asked };
    let mut answers = evaluate_loaded(
        &asked,
        track.points.len(),
        |i| track.stop(i),
        |i, out| track.wrenches(i, out),
        watch,
    )?;
    let points = &track.points;
    turns::count_on(asked.robot, &mut answers, |i| {
        points[i].along > points[i - 1].along
    });
    Ok(ProgramAnswer { choice, answers })
}

/// The one branch that the whole path is followed in.
fn chosen(question: &Question<'_>, track: &Track, watch: Watch<'_>) -> Result<BranchChoice, Cancelled> {
    let pattern = match question.choice {
        BranchChoice::Of(pattern) => pattern,
        BranchChoice::Best => BranchPattern::default(),
    };
    let open: Vec<Branch> = Branch::ALL
        .into_iter()
        .filter(|branch| pattern.matches(*branch))
        .collect();
    if !question.robot.inverse().has_branches() || open.len() < 2 {
        return Ok(BranchChoice::Of(pattern));
    }
    let quiet = Watch {
        finished: &|_| (),
        ..watch
    };
    let stride = track.points.len().div_ceil(SPREAD).max(1);
    let count = track.points.len().div_ceil(stride);
    let mut best: Option<(Merit, Branch)> = None;
    for branch in open {
        let asked = Question {
            choice: BranchChoice::Of(branch.into()),
            ..*question
        };
        let answers = evaluate_loaded(
            &asked,
            count,
            |i| track.stop(i * stride),
            |i, out| track.wrenches(i * stride, out),
            quiet,
        )?;
        let merit = Merit::of(&answers, question.choice);
        if best.is_none_or(|(before, _)| merit.beats(&before)) {
            best = Some((merit, branch));
        }
    }
    let branch = best.map_or(pattern, |(_, branch)| branch.into());
    Ok(BranchChoice::Of(branch))
}

/// How good a branch is for a path.
#[derive(Clone, Copy, Debug)]
struct Merit {
    within_limits: usize,
    reached: usize,
    /// Larger is better.
    finer: f64,
}

impl Merit {
    fn of(answers: &Answers, choice: BranchChoice) -> Merit {
        let held = || answers.held().map(|(_, held)| held);
        let margin = held().map(|held| held.limit_margin).fold(f64::INFINITY, f64::min);
        let largest = held().map(|held| held.in_plane).fold(0.0, f64::max);
        Merit {
            within_limits: held().filter(|held| held.within_limits()).count(),
            reached: held().count(),
            finer: if choice == BranchChoice::Best {
                -largest
            } else {
                margin
            },
        }
    }

    fn beats(&self, other: &Merit) -> bool {
        let count = |merit: &Merit| (merit.within_limits, merit.reached);
        count(self) > count(other) || (count(self) == count(other) && self.finer > other.finer)
    }
}

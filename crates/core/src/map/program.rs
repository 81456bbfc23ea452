//! Deviation along a tool path program: along the track, across it and along the tool, for loads that turn with the
//! feed.
//!
//! A program is followed in one posture: the branch is chosen once, from points spread over the path, so the arm does not
//! change its elbow in the middle of a part. Where a tool cuts, force and deviation come to rest at every point
//! ([`crate::load::straying`]); the branch is chosen under the forces of the path as drawn.

use nalgebra::{Point3, Rotation3, Vector3};

use super::turns;
use crate::frame::Isometry;
use crate::kernel::{Answers, BranchChoice, Question, Stop, evaluate_loaded};
use crate::load::{CutsAlong, PathLoad, Rest, Straying, TipYield};
use crate::path::{PathPoint, Placing};
use crate::robot::{Branch, BranchPattern, Robot};
use crate::spatial::Wrench;
use crate::watch::{Cancelled, Watch};

/// Points of the path that decide on the branch.
const SPREAD: usize = 400;

/// The points of a program, and where they lie.
#[derive(Clone, Debug)]
pub struct Track {
    /// Its points.
    pub points: Vec<PathPoint>,
    /// Where they lie.
    pub placing: Placing,
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
    /// What pushed: of cuts the forces at rest, with the cuts as drawn.
    pub load: PathLoad,
    /// How force and deviation came to rest; `None` where no tool cuts, or the load changes the arm.
    pub rested: Option<Rested>,
}

/// How force and deviation came to rest along a program.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rested {
    /// Largest in-plane deviation if the forces did not give way, m.
    pub largest_if_drawn: f64,
    /// Points at which they do not rest: the cut draws the tool in.
    pub unsettled: usize,
    /// Index of the first of them.
    pub first_unsettled: Option<usize>,
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

    /// Fills in the wrenches of `load` at point `index`, base.
    pub fn wrenches(&self, load: &PathLoad, index: usize, out: &mut [Wrench]) {
        let axes = self.base_from_feed(index);
        load.in_base(index, &self.base_from_part, &axes, out);
    }
}

/// The answers along `track` under `load`. What `question` says of cases, normal and doubt is not looked at.
///
/// Of several branches that match (or of all, for the best one) the arm keeps the one in which it reaches most points
/// within its limits; of equal ones for [`BranchChoice::Best`] the one with the least of the largest in-plane deviations,
/// otherwise the one with the most room to its limits.
///
/// # Errors
/// [`Cancelled`] if the watch says so.
///
/// # Panics
/// If `load` does not [cover](PathLoad::covers) the points of the track.
pub fn along_program(
    question: &Question<'_>,
    track: &Track,
    load: PathLoad,
    watch: Watch<'_>,
) -> Result<ProgramAnswer, Cancelled> {
    assert!(
        load.covers(track.points.len()),
        "a load for each point of the track"
    );
    let cases = vec![Wrench::from_force(Vector3::zeros()); load.case_count()];
    let asked = Question {
        cases: &cases,
        ..*question
    };
    let choice = chosen(&asked, track, &load, watch)?;
    let asked = Question { choice, ..asked };
    let count = track.points.len();
    let stop = |i| track.stop(i);
    if let PathLoad::Cuts(cuts) = load {
        let mut resting = Resting::new(track, cuts);
        let mut answers = evaluate_loaded(
            &asked,
            count,
            stop,
            |i, tip, out| resting.load(i, tip, out),
            watch,
        )?;
        count_turns(question.arm.robot, track, &mut answers);
        return Ok(ProgramAnswer {
            choice,
            answers,
            load: PathLoad::Cuts(resting.cuts),
            rested: question.arm.model.is_affine().then_some(resting.rested),
        });
    }
    let mut answers = evaluate_loaded(
        &asked,
        count,
        stop,
        |i, _, out| track.wrenches(&load, i, out),
        watch,
    )?;
    count_turns(question.arm.robot, track, &mut answers);
    Ok(ProgramAnswer {
        choice,
        answers,
        load,
        rested: None,
    })
}

/// Joints go on past half a turn along each cut.
fn count_turns(robot: &Robot, track: &Track, answers: &mut Answers) {
    let points = &track.points;
    turns::count_on(robot, answers, |i| points[i].along > points[i - 1].along);
}

/// Cuts whose forces come to rest point after point.
struct Resting<'a> {
    track: &'a Track,
    cuts: CutsAlong,
    straying: Straying,
    rested: Rested,
}

impl Resting<'_> {
    fn new(track: &Track, cuts: CutsAlong) -> Resting<'_> {
        Resting {
            track,
            straying: Straying::new(cuts.cutters[0], cuts.law),
            cuts,
            rested: Rested::default(),
        }
    }

    /// Brings the force at point `index` to rest, and fills in its wrenches, base.
    fn load(&mut self, index: usize, tip: Option<&TipYield>, out: &mut [Wrench]) {
        let base_from_feed = self.track.base_from_feed(index);
        let here = &mut self.cuts.points[index];
        if let Some(tip) = tip {
            let tip = tip.seen_from(&base_from_feed.inverse());
            let drawn = [here.mean, here.greatest];
            for force in &drawn[..out.len().min(drawn.len())] {
                // In plane is across the tool.
                let in_plane = tip.under(*force).xy().norm();
                self.rested.largest_if_drawn = self.rested.largest_if_drawn.max(in_plane);
            }
            if let Some(cut) = here.cut {
                self.straying.hold(self.cuts.cutters[here.cutter]);
                match self.straying.rest(&cut, here.mean, &tip) {
                    Rest::Settled(force) => [here.mean, here.greatest] = here.under(force),
                    Rest::DrawnIn => {
                        self.rested.unsettled += 1;
                        self.rested.first_unsettled.get_or_insert(index);
                    }
                }
            }
        }
        for (out, force) in out.iter_mut().zip([here.mean, here.greatest]) {
            *out = Wrench::from_force(base_from_feed * force);
        }
    }
}

/// The one branch that the whole path is followed in.
fn chosen(
    question: &Question<'_>,
    track: &Track,
    load: &PathLoad,
    watch: Watch<'_>,
) -> Result<BranchChoice, Cancelled> {
    let pattern = match question.choice {
        BranchChoice::Of(pattern) => pattern,
        BranchChoice::Best => BranchPattern::default(),
    };
    let open: Vec<Branch> = Branch::ALL
        .into_iter()
        .filter(|branch| pattern.matches(*branch))
        .collect();
    if !question.arm.robot.inverse().has_branches() || open.len() < 2 {
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
            |i, _, out| track.wrenches(load, i * stride, out),
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

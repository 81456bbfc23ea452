//! A program as the moves of a path: where each ends in one frame, how the tool stands there and what it follows.
//!
//! ```text
//! path_from_tool = path_from_base base_from_frame frame_from_tcp (flange_from_tcp)^-1 flange_from_tool     a pose
//! path_from_tool = path_from_base base_from_flange(q) flange_from_tool                                  joints
//! ```
//!
//! | symbol | meaning |
//! |---|---|
//! | path | the frame that the first pose counts from |
//! | frame, tcp | what the program's poses count from, and the tool that it tells |
//! | tool | the tool of the cell, whose tip must be that of the program's along every cut |
//!
//! Straight and circular moves cut, at the speed that is told; moves of the joints are rapids whose ends alone are known.
//! What goes to or comes from a place that the program does not tell is left out, and said. On an arc the tool turns
//! evenly from its start to its end.
//!
//! In reading order: `cell` what the program does not tell, and frames and tools with it; `error` what it lacks then;
//! `circle` arcs through three points.

mod cell;
mod circle;
mod error;

use std::collections::BTreeMap;

use armill_core::frame::Isometry;
use armill_core::nalgebra::{Point3, UnitQuaternion, Vector3};
use armill_core::path::{Course, Move, Pace, ToldSpin};
use armill_core::robot::forward::forward;
use armill_core::robot::inverse::{posture_at, tool_on};
use armill_core::robot::{BranchPattern, Robot};

pub use self::cell::Cell;
use self::circle::{Through, through};
pub use self::error::FollowError;
use super::program::{Motion, RobotMove, RobotProgram, Speed, Target};

/// A program as moves of a path.
#[derive(Clone, Debug)]
pub struct Followed {
    /// Base to the frame that the moves count in.
    pub base_from_path: Isometry,
    /// Its moves, those left out apart, in order.
    pub moves: Vec<FollowedMove>,
    /// The posture in which its first cut begins, as far as the program tells it, and the line that does.
    pub posture: Option<(BranchPattern, u32)>,
    /// What was left out or taken for granted, each a sentence.
    pub notes: Vec<String>,
}

/// One move of a program as one of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FollowedMove {
    /// Which move of the program.
    pub index: usize,
    /// The same in the frame of the path.
    pub next: Move,
    /// Path to the frame that its target counts in; `None` of a target told in joints.
    pub path_from_frame: Option<Isometry>,
    /// Where an arc passes, m, path.
    pub via: Option<Point3<f64>>,
}

/// The moves of `program`, that `robot` runs in `cell`.
///
/// # Errors
/// Everything that the program does not tell and the cell does not either: frames by their numbers, a tool with another
/// tip; joints of another robot.
pub fn follow(program: &RobotProgram, robot: &Robot, cell: &Cell) -> Result<Followed, Vec<FollowError>> {
    let placed = cell.placed(program)?;
    let mut follower = Follower {
        robot,
        cell,
        placed: &placed,
        stands: None,
        posture: None,
        begun: false,
        moves: Vec::with_capacity(program.moves.len()),
        noted: Noted::default(),
        errors: Vec::new(),
    };
    for (index, next) in program.moves.iter().enumerate() {
        follower.take(index, next);
    }
    let Follower {
        posture,
        begun,
        moves,
        noted,
        errors,
        ..
    } = follower;
    if !errors.is_empty() {
        return Err(errors);
    }
    let mut notes = placed.notes();
    notes.extend(noted.sentences());
    Ok(Followed {
        base_from_path: placed.base_from_path,
        moves,
        posture: posture.filter(|_| begun),
        notes,
    })
}

/// Orientations at the via point of an arc that lie farther from the even turn are told, rad: half a degree.
const VIA_TURN: f64 = 8.7e-3;

/// Where a target is, in the frame of the path.
#[derive(Clone, Copy)]
struct Place {
    path_from_tool: Isometry,
    path_from_frame: Option<Isometry>,
}

impl Place {
    fn point(&self) -> Point3<f64> {
        self.path_from_tool.translation.vector.into()
    }
}

struct Follower<'a> {
    robot: &'a Robot,
    cell: &'a Cell,
    placed: &'a cell::Placed,
    /// Where the move before has ended, if that is known.
    stands: Option<Isometry>,
    posture: Option<(BranchPattern, u32)>,
    /// Whether a cut has begun.
    begun: bool,
    moves: Vec<FollowedMove>,
    noted: Noted,
    errors: Vec<FollowError>,
}

impl Follower<'_> {
    fn take(&mut self, index: usize, given: &RobotMove) {
        self.hear_posture(given);
        let cuts = given.motion != Motion::Joint;
        let end = match self.place(given, &given.target) {
            Ok(Some(end)) => end,
            Ok(None) => {
                if let Target::Elsewhere { name } = &given.target {
                    self.noted
                        .note(What::Elsewhere, given.line, || format!("`{name}`"));
                }
                self.stands = None;
                return;
            }
            Err(error) => return self.errors.push(error),
        };
        let pace = match given.speed {
            _ if !cuts => Pace::Rapid,
            Speed::Tip(speed) => Pace::Feed(speed),
            Speed::Joints | Speed::EvaluateError => Pace::EvaluateError,
        };
        let (mut course, mut pace, mut passed) = (Course::Line, pace, None);
        match (&given.motion, self.stands) {
            (Motion::Joint, _) => {}
            (_, None) => {
                // From where is not known: it ends there, as if by a rapid.
                self.noted
                    .note(What::FromNowhere, given.line, || match self.moves.is_empty() {
                        true => "the first move".to_owned(),
                        false => "a move".to_owned(),
                    });
                pace = Pace::Rapid;
            }
            (Motion::Linear, Some(_)) => {}
            (Motion::Circular { via }, Some(from)) => match self.place(given, via) {
                Ok(Some(via)) => {
                    passed = Some(via.point());
                    course = self.arc(given.line, [from, via.path_from_tool, end.path_from_tool]);
                }
                Ok(None) => {
                    self.noted.note(What::NoVia, given.line, || "an arc".to_owned());
                    pace = Pace::Rapid;
                }
                Err(error) => return self.errors.push(error),
            },
        }
        self.begun |= pace.cuts();
        self.stands = Some(end.path_from_tool);
        let turned = end.path_from_tool.rotation;
        self.moves.push(FollowedMove {
            index,
            next: Move {
                end: end.point(),
                axis: Some(-(turned * Vector3::z_axis())),
                spin: Some(ToldSpin::Orientation(turned)),
                course,
                pace,
                line: given.line,
            },
            path_from_frame: end.path_from_frame,
            via: passed.filter(|_| course != Course::Line),
        });
    }

    /// Where a target of this move is; `None` where the program does not tell.
    fn place(&mut self, given: &RobotMove, target: &Target) -> Result<Option<Place>, FollowError> {
        let path_from_base = self.placed.base_from_path.inverse();
        match target {
            Target::Elsewhere { .. } => Ok(None),
            Target::Pose { pose, .. } => {
                let path_from_frame = path_from_base * self.placed.base_from_frame(given);
                let tcp_from_tool = self.placed.tcp_from_tool(given)?;
                Ok(Some(Place {
                    path_from_tool: path_from_frame * pose * tcp_from_tool,
                    path_from_frame: Some(path_from_frame),
                }))
            }
            Target::Joints(joints) => {
                let robot = self.robot;
                if joints.len() != robot.joints().len() {
                    return Err(FollowError::Joints {
                        line: given.line,
                        found: joints.len(),
                        robot: robot.name().to_owned(),
                        expected: robot.joints().len(),
                    });
                }
                self.noted
                    .note(What::Joints, given.line, || "joint positions".to_owned());
                let base_from_tool = tool_on(&forward(robot, joints), &self.cell.flange_from_tool);
                Ok(Some(Place {
                    path_from_tool: path_from_base * base_from_tool,
                    path_from_frame: None,
                }))
            }
        }
    }

    /// Until the first cut: how the arm stands. Straight moves keep the posture, whatever they say of it.
    fn hear_posture(&mut self, given: &RobotMove) {
        if self.begun || (given.motion != Motion::Joint && self.posture.is_some()) {
            return;
        }
        let pattern = match &given.target {
            Target::Joints(joints) if joints.len() == self.robot.joints().len() => {
                let posture = posture_at(self.robot, joints, &self.cell.flange_from_tool);
                posture.name.branch().map(BranchPattern::from)
            }
            Target::Pose { branch, .. } => Some(*branch).filter(|branch| *branch != BranchPattern::default()),
            Target::Joints(_) | Target::Elsewhere { .. } => None,
        };
        if let Some(pattern) = pattern {
            self.posture = Some((pattern, given.line));
        } else if given.motion == Motion::Joint {
            // It may have changed, and how is not told.
            self.posture = None;
        }
    }

    /// The course of an arc from the first of these poses through the second to the third.
    fn arc(&mut self, line: u32, [from, via, end]: [Isometry; 3]) -> Course {
        let points = [from, via, end].map(|pose| pose.translation.vector.into());
        match through(points) {
            Through::Arc(arc, part) => {
                let even = from
                    .rotation
                    .try_slerp(&end.rotation, part, f64::MIN_POSITIVE)
                    .unwrap_or(end.rotation);
                if angle(&even, &via.rotation) > VIA_TURN {
                    self.noted.note(What::ViaTurn, line, || "an arc".to_owned());
                }
                Course::Arc(arc)
            }
            Through::Line => {
                self.noted.note(What::FlatArc, line, || "an arc".to_owned());
                Course::Line
            }
        }
    }
}

/// The angle between two orientations, rad; good to rounding where it is small.
fn angle(one: &UnitQuaternion<f64>, other: &UnitQuaternion<f64>) -> f64 {
    let between = one.inverse() * other;
    2.0 * between.vector().norm().atan2(between.scalar().abs())
}

/// What is worth telling of single moves, in the order told.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum What {
    FromNowhere,
    Elsewhere,
    NoVia,
    FlatArc,
    ViaTurn,
    Joints,
}

/// How often each was met, the line of its first time, and what that was.
#[derive(Default)]
struct Noted(BTreeMap<What, (usize, u32, String)>);

impl Noted {
    fn note(&mut self, what: What, line: u32, shown: impl FnOnce() -> String) {
        let noted = self.0.entry(what).or_insert_with(|| (0, line, shown()));
        noted.0 += 1;
    }

    fn sentences(self) -> impl Iterator<Item = String> {
        self.0.into_iter().map(|(what, (times, line, shown))| {
            let said = match what {
                What::FromNowhere => {
                    "begins at a place that the program does not tell: its way there is left out"
                }
                What::Elsewhere => {
                    "is a place that the program does not tell: the way there and the way on are left out"
                }
                What::NoVia => "passes a place that the program does not tell: it is left out",
                What::FlatArc => "has its three points on one line: taken as straight",
                What::ViaTurn => {
                    "tells an orientation on its way: the tool is taken to turn evenly from start to end"
                }
                What::Joints => {
                    "are taken as the robot's file counts its joints: compare them with the pendant"
                }
            };
            let times = match times {
                1 => String::new(),
                times => format!(" ({times} times, here first)"),
            };
            format!("line {line}: {shown} {said}{times}")
        })
    }
}

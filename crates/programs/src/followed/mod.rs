//! A program as moves of a path: the end of each move in one frame, the tool orientation there, and the course.
//!
//! ```text
//! path_from_tool = path_from_base base_from_frame frame_from_tcp (flange_from_tcp)^-1 flange_from_tool     a pose
//! path_from_tool = path_from_base base_from_flange(q) flange_from_tool                                  joints
//! ```
//!
//! | symbol | meaning |
//! |---|---|
//! | path | the reference frame of the first pose |
//! | frame, tcp | the reference frame of the program's poses, and the program's tool |
//! | tool | the tool of the cell; its tip must be that of the program's tool in every cut |
//!
//! Straight and circular moves cut at the programmed speed. Joint moves are rapid moves of which only the ends are
//! known. Moves to or from a position that the program does not give are left out and reported. On an arc the tool
//! rotates uniformly from start to end.
//!
//! In reading order: `cell` (the data that the program does not give, and the poses of frames and tools), `error`
//! (missing data), `circle` (arcs through three points), `angle` (between two orientations).

mod angle;
mod cell;
mod circle;
mod error;

use std::collections::BTreeMap;

use armill_core::frame::Isometry;
use armill_core::nalgebra::{Point3, Vector3};
use armill_core::path::{Course, GivenSpin, Move, Pace};
use armill_core::robot::forward::forward;
use armill_core::robot::inverse::{posture_at, tool_on};
use armill_core::robot::{BranchPattern, Robot};
use armill_formats::toolpath::Summary;
use armill_formats::toolpath::format::Format;

use self::angle::angle;
pub use self::cell::Cell;
use self::circle::{Through, through};
pub use self::error::FollowError;
use super::program::{Motion, RobotMove, RobotProgram, Speed, Target};

/// A program as moves of a path.
#[derive(Clone, Debug)]
pub struct Followed {
    /// Base to the frame of the moves.
    pub base_from_path: Isometry,
    /// Its moves in order, except those left out.
    pub moves: Vec<FollowedMove>,
    /// The posture in which its first cut begins, as far as the program gives it, and the line that gives it.
    pub posture: Option<(BranchPattern, u32)>,
    /// Assumptions and moves left out, one sentence each.
    pub notes: Vec<String>,
}

impl Followed {
    /// Summary of `program`, whose path this is: its moves, and the notes of both.
    pub fn summary(&self, program: &RobotProgram) -> Summary {
        Summary::of_moves(
            Format::Robot(program.language),
            self.moves.iter().map(|found| &found.next),
            [program.notes.as_slice(), &self.notes].concat(),
        )
    }
}

/// One move of a program as one of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FollowedMove {
    /// Index of the move in the program.
    pub index: usize,
    /// The move in the frame of the path.
    pub next: Move,
    /// Path to the frame of its target; `None` if the target is given in joints.
    pub path_from_frame: Option<Isometry>,
    /// Via point of an arc, m, path.
    pub via: Option<Point3<f64>>,
}

/// The moves of `program` as run by `robot` in `cell`.
///
/// # Errors
/// All data that neither the program nor the cell gives: numbered frames, a tool with another tip; and joints of
/// another robot.
pub fn follow(program: &RobotProgram, robot: &Robot, cell: &Cell) -> Result<Followed, Vec<FollowError>> {
    let placed = cell.placed(program)?;
    let mut follower = Follower {
        robot,
        cell,
        placed: &placed,
        position: None,
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

/// A via orientation of an arc that differs from the uniform rotation by more than this is reported, rad: half a
/// degree.
const VIA_TURN: f64 = 8.7e-3;

/// Pose of a target, in the frame of the path.
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
    /// End of the previous move, if it is known.
    position: Option<Isometry>,
    /// As in [`Followed::posture`], so far.
    posture: Option<(BranchPattern, u32)>,
    /// Whether the first cut has begun.
    begun: bool,
    moves: Vec<FollowedMove>,
    noted: Noted,
    errors: Vec<FollowError>,
}

impl Follower<'_> {
    fn take(&mut self, index: usize, given: &RobotMove) {
        self.update_posture(given);
        let cuts = given.motion != Motion::Joint;
        let end = match self.place(given, &given.target) {
            Ok(Some(end)) => end,
            Ok(None) => {
                if let Target::Elsewhere { name } = &given.target {
                    self.noted
                        .note(SkippedKind::Elsewhere, given.line, || format!("`{name}`"));
                }
                self.position = None;
                return;
            }
            Err(error) => return self.errors.push(error),
        };
        let pace = match given.speed {
            _ if !cuts => Pace::Rapid,
            Speed::Tip(speed) => Pace::Feed(speed),
            Speed::Joints | Speed::Unknown => Pace::Unknown,
        };
        let (mut course, mut pace, mut passed) = (Course::Line, pace, None);
        match (&given.motion, self.position) {
            (Motion::Joint, _) => {}
            (_, None) => {
                // The start is not known: the move ends there like a rapid move.
                self.noted.note(SkippedKind::FromNowhere, given.line, || {
                    match self.moves.is_empty() {
                        true => "the first move".to_owned(),
                        false => "a move".to_owned(),
                    }
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
                    self.noted
                        .note(SkippedKind::NoVia, given.line, || "an arc".to_owned());
                    pace = Pace::Rapid;
                }
                Err(error) => return self.errors.push(error),
            },
        }
        self.begun |= pace.cuts();
        self.position = Some(end.path_from_tool);
        let turned = end.path_from_tool.rotation;
        self.moves.push(FollowedMove {
            index,
            next: Move {
                end: end.point(),
                axis: Some(-(turned * Vector3::z_axis())),
                spin: Some(GivenSpin::Orientation(turned)),
                course,
                pace,
                line: given.line,
            },
            path_from_frame: end.path_from_frame,
            via: passed.filter(|_| course != Course::Line),
        });
    }

    /// The pose of a target of this move; `None` if the program does not give it.
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
                    .note(SkippedKind::Joints, given.line, || "joint positions".to_owned());
                let base_from_tool = tool_on(&forward(robot, joints), &self.cell.flange_from_tool);
                Ok(Some(Place {
                    path_from_tool: path_from_base * base_from_tool,
                    path_from_frame: None,
                }))
            }
        }
    }

    /// Updates the posture until the first cut. Straight moves keep it, whatever they specify.
    fn update_posture(&mut self, given: &RobotMove) {
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
            // The posture may have changed in an unknown way.
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
                    self.noted
                        .note(SkippedKind::ViaTurn, line, || "an arc".to_owned());
                }
                Course::Arc(arc)
            }
            Through::Line => {
                self.noted
                    .note(SkippedKind::FlatArc, line, || "an arc".to_owned());
                Course::Line
            }
        }
    }
}

/// Kinds of notes on single moves, in the order of the report.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum SkippedKind {
    FromNowhere,
    Elsewhere,
    NoVia,
    FlatArc,
    ViaTurn,
    Joints,
}

/// Number of occurrences of each kind, the line of the first one, and its subject.
#[derive(Default)]
struct Noted(BTreeMap<SkippedKind, (usize, u32, String)>);

impl Noted {
    fn note(&mut self, what: SkippedKind, line: u32, shown: impl FnOnce() -> String) {
        let noted = self.0.entry(what).or_insert_with(|| (0, line, shown()));
        noted.0 += 1;
    }

    fn sentences(self) -> impl Iterator<Item = String> {
        self.0.into_iter().map(|(what, (times, line, shown))| {
            let said = match what {
                SkippedKind::FromNowhere => {
                    "begins at a position that the program does not give: the move to it is left out"
                }
                SkippedKind::Elsewhere => {
                    "is a position that the program does not give: the moves to it and from it are left out"
                }
                SkippedKind::NoVia => "passes a position that the program does not give: it is left out",
                SkippedKind::FlatArc => "has its three points on one line: a straight line is used",
                SkippedKind::ViaTurn => {
                    "gives an orientation at its via point: the tool is assumed to rotate uniformly from start to end"
                }
                SkippedKind::Joints => {
                    "use the joint zeros and signs of the robot file: compare them with the pendant"
                }
            };
            let times = match times {
                1 => String::new(),
                times => format!(" ({times} times, first here)"),
            };
            format!("line {line}: {shown} {said}{times}")
        })
    }
}

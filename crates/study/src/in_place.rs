//! The program of a robot that a path came from, with its targets moved so that the tool goes where the path is drawn.
//!
//! ```text
//! target' = target + frame_from_path x        x nearest, over all points, to commanded - drawn   (core: `optimize::nodes`)
//! ```
//!
//! Places alone are written anew; orientations and all other bytes stay. Between its targets the robot goes straight or on
//! an arc as before, and one target may be asked to different places: at a corner by forces that turn with the feed, or by
//! several moves. What is left then is told: the program that was written is read again, followed again in the same
//! points, and judged by what its tool leaves.

use std::collections::BTreeMap;
use std::path::Path;

use armill_core::frame::Isometry;
use armill_core::load::PathLoad;
use armill_core::nalgebra::{Point3, Translation3, Vector3};
use armill_core::optimize::{Shares, fitted, left_by};
use armill_core::path::{Move, Sampler, Sampling, Spin, Track};
use armill_formats::file::ResultFolder;
use armill_formats::robot_program::{Motion, Moved, ProgramText, RobotMove, Spelled, Target, follow};
use serde::Serialize;

use crate::compensate::{ErrorAnswer, paths};
use crate::error::StudyError;
use crate::file::path::robot_program::Span;
use crate::file::path::{PathAnalysis, RobotPath};
use crate::file::resolve::Study;
use crate::run::{Followed, Runner};

/// A program with its targets moved.
#[derive(Clone, Debug)]
pub struct InPlace {
    /// Its files, by their names alone, and bytes.
    pub files: Vec<(String, Vec<u8>)>,
    /// What the tool leaves of the drawn path along it, under each load case, m, base.
    pub residual: Vec<Vector3<f64>>,
    /// In numbers.
    pub given: InPlaceAnswer,
}

/// A program that was written again in place.
#[derive(Clone, Debug, Serialize)]
pub struct InPlaceAnswer {
    /// Its language.
    pub language: &'static str,
    /// Its files.
    pub files: Vec<String>,
    /// Targets that were moved, points on the way of arcs included.
    pub moved_targets: usize,
    /// How far the tool goes from the drawn path then, as predicted.
    pub after: ErrorAnswer,
    /// What a user must know of it, each a sentence.
    pub notes: Vec<String>,
}

/// Two places that one target is asked to are told where they lie farther apart, m.
const ONE_PLACE: f64 = 1e-6;

/// The program of `analysis` along the commanded track.
///
/// `Err` with a sentence where it cannot be written.
///
/// # Errors
/// Cancelled by the watch.
pub(crate) fn in_place(
    runner: &Runner<'_>,
    analysis: &PathAnalysis,
    (followed, load): (&Followed, &PathLoad),
    commanded: &Track,
) -> Result<Option<Result<InPlace, String>>, StudyError> {
    let Some(robot) = analysis.source.robot() else {
        return Ok(None);
    };
    let placing = &analysis.track.placing;
    if followed.turned.is_some() || placing.keeps_axis || placing.spin != Spin::Given(0.0) {
        let why = "the study turns the tool otherwise than the program does (`posture.search`, `program.spin`, `program.tool_axis`)";
        return Ok(Some(Err(why.to_owned())));
    }
    let writer = Writer {
        robot,
        analysis,
        commanded,
    };
    let (written, wishes) = match writer.written() {
        Ok(written) => written,
        Err(why) => return Ok(Some(Err(why))),
    };
    let Some(track) = writer.track_of(runner, &written) else {
        let why = "what was written is no longer the path that was drawn";
        return Ok(Some(Err(why.to_owned())));
    };
    let question = runner.question(&analysis.setting);
    let forces = (load, followed.along.choices.as_slice());
    let (along, residual) = left_by(&question, (&analysis.track, &track), forces, runner.watch)?;
    let files: Files = written
        .into_iter()
        .map(|(name, bytes)| (name_of(&name), bytes))
        .collect();
    let given = InPlaceAnswer {
        language: robot.program.language.name(),
        files: files.iter().map(|(name, _)| name.clone()).collect(),
        moved_targets: wishes.targets.len(),
        after: ErrorAnswer::of(&analysis.track, &residual, along.answers.case_count),
        notes: writer.notes(&wishes),
    };
    Ok(Some(Ok(InPlace {
        files,
        residual,
        given,
    })))
}

/// That the programs of these paths can be written into the folder `out`.
///
/// # Errors
/// One that was read lies there; two have one name.
pub fn allow_programs(study: &Study, name: Option<&str>, out: &ResultFolder) -> Result<(), StudyError> {
    let mut names: Vec<String> = Vec::new();
    let robots = paths(study, name).filter_map(|(_, path)| path.source.robot());
    for text in robots.flat_map(|robot| &robot.program.texts) {
        let name = name_of(text.name());
        if names.contains(&name) {
            let message = format!("two programs have a file `{name}`, and one folder holds one");
            return Err(StudyError::value(
                message,
                "one path at a time: --analysis NAME --out DIR",
            ));
        }
        names.push(name);
    }
    Ok(out.allow(names.iter().map(String::as_str))?)
}

/// The name of a file without its folder.
fn name_of(path: &str) -> String {
    let name = Path::new(path).file_name();
    name.map_or_else(|| path.to_owned(), |name| name.to_string_lossy().into_owned())
}

struct Writer<'a> {
    robot: &'a RobotPath,
    analysis: &'a PathAnalysis,
    commanded: &'a Track,
}

/// Where a target is spelled.
type Key = (usize, usize);

/// By how much targets are to be moved.
#[derive(Default)]
struct Wishes {
    /// Each target that is moved, by where it is spelled.
    targets: BTreeMap<Key, Wish>,
    /// Lines of cuts that begin, end or pass where joints are told.
    joints: Vec<u32>,
}

/// By how much one target is to be moved.
struct Wish {
    /// Which node of the fit it is.
    node: usize,
    /// Path to the frame that it counts in.
    path_from_frame: Isometry,
    /// Every move that goes there: its line, and what it alone asks for, m, path.
    requested: Vec<(u32, Vector3<f64>)>,
    /// What all points ask for together, m, path.
    by: Vector3<f64>,
}

impl Wishes {
    /// The target, moved; as it is where nobody asks.
    fn moved(&self, target: &Target) -> Option<Isometry> {
        let Target::Pose { pose, spelled, .. } = target else {
            return None;
        };
        let by = self
            .targets
            .get(&key(spelled))
            .map_or_else(Vector3::zeros, |wish| {
                wish.path_from_frame.rotation.inverse() * wish.by
            });
        Some(Translation3::from(by) * pose)
    }

    /// The node of a target that a cut touches, which asks for `by` there; none of one told in joints.
    fn analysis(
        &mut self,
        (target, line): (&Target, u32),
        path_from_frame: Option<Isometry>,
        by: Vector3<f64>,
    ) -> Option<usize> {
        let node = self.targets.len();
        match (target, path_from_frame) {
            (Target::Pose { spelled, .. }, Some(path_from_frame)) => {
                let wish = self.targets.entry(key(spelled)).or_insert_with(|| Wish {
                    node,
                    path_from_frame,
                    requested: Vec::new(),
                    by,
                });
                wish.requested.push((line, by));
                Some(wish.node)
            }
            _ => {
                self.joints.push(line);
                None
            }
        }
    }
}

fn key(spelled: &Spelled) -> Key {
    (spelled.text, spelled.bytes.start)
}

fn via(of: &RobotMove) -> Option<&Target> {
    match &of.motion {
        Motion::Circular { via } => Some(via),
        Motion::Joint | Motion::Linear => None,
    }
}

/// The points of a move, each with the part of the way to it.
fn parts(span: &Span) -> impl Iterator<Item = (usize, f64)> + use<> {
    let (pieces, end) = (span.pieces, span.points.end);
    span.points
        .clone()
        .map(move |index| (index, 1.0 - (end - 1 - index) as f64 / pieces as f64))
}

/// The files of a program.
type Files = Vec<(String, Vec<u8>)>;

impl Writer<'_> {
    /// The files with their targets moved, checked by reading them again.
    fn written(&self) -> Result<(Files, Wishes), String> {
        let program = &self.robot.program;
        let wishes = self.wishes();
        let is_asked = |target: &Target| match target {
            Target::Pose { spelled, .. } => wishes.targets.contains_key(&key(spelled)),
            Target::Joints(_) | Target::Elsewhere { .. } => false,
        };
        let all = program.moves.iter().enumerate();
        let moved: Vec<Moved> = all
            .filter(|(_, of)| is_asked(&of.target) || via(of).is_some_and(is_asked))
            .filter_map(|(index, of)| {
                Some(Moved {
                    index,
                    target: wishes.moved(&of.target)?,
                    via: via(of).and_then(|via| wishes.moved(via)),
                })
            })
            .collect();
        let files = program.with_poses(&moved).map_err(|error| error.to_string())?;
        program
            .check_rewritten(&moved, &files)
            .map_err(|error| error.to_string())?;
        Ok((files, wishes))
    }

    /// By how much each target is to be moved.
    fn wishes(&self) -> Wishes {
        let mut wishes = Wishes::default();
        let (mut shares, mut expected) = (Vec::new(), Vec::new());
        // The node at which the tip stands.
        let mut from = None;
        for (of, span) in self.robot.followed.moves.iter().zip(&self.robot.spans) {
            let given = &self.robot.program.moves[of.index];
            let end = span.end.and_then(|end| {
                wishes.analysis(
                    (&given.target, given.line),
                    of.path_from_frame,
                    self.correction(end),
                )
            });
            let passed = via(given).zip(of.via).and_then(|(via, at)| {
                let (nearest, part) = self.nearest(span, &at)?;
                // At an end of the arc it would say nothing of its middle.
                let node = wishes.analysis((via, given.line), of.path_from_frame, self.correction(nearest))?;
                ((0.0..1.0).contains(&part) && part > 0.0).then_some((node, part))
            });
            for (index, t) in parts(span) {
                shares.push(match passed {
                    Some((via, part)) => Shares::bent([from, Some(via), end], part, t),
                    None => Shares::straight(from, end, t),
                });
                expected.push(self.correction(index));
            }
            from = end;
        }
        let mut start = vec![Vector3::zeros(); wishes.targets.len()];
        for wish in wishes.targets.values() {
            start[wish.node] = wish.by;
        }
        let found = fitted(start, &shares, &expected);
        for wish in wishes.targets.values_mut() {
            wish.by = found[wish.node];
        }
        wishes
    }

    /// What a point of the path is to be moved by, m, path.
    fn correction(&self, point: usize) -> Vector3<f64> {
        let [drawn, commanded] = [&self.analysis.track, self.commanded].map(|track| track.path.points[point].at);
        commanded - drawn
    }

    /// The point of a move that is nearest to a place, and the part of the way there.
    fn nearest(&self, span: &Span, at: &Point3<f64>) -> Option<(usize, f64)> {
        let away = |point: usize| (self.analysis.track.path.points[point].at - at).norm_squared();
        parts(span).min_by(|a, b| away(a.0).total_cmp(&away(b.0)))
    }

    /// The path as these files tell it, point for point; `None` if they tell another one.
    fn track_of(&self, runner: &Runner<'_>, files: &Files) -> Option<Track> {
        let texts = files.iter().map(|(name, bytes)| ProgramText::new(name, bytes));
        let again = self.robot.program.language.read(texts.collect()).ok()?;
        let found = follow(&again, runner.robot, &self.robot.cell).ok()?;
        if found.moves.len() != self.robot.followed.moves.len() {
            return None;
        }
        // Pieces are told: what each is measured by has no say.
        let mut sampler = Sampler::new(Sampling {
            chord_error: f64::INFINITY,
            step: f64::INFINITY,
        });
        let mut places = Vec::with_capacity(self.analysis.track.len());
        let moves = found
            .moves
            .iter()
            .zip(&self.robot.followed.moves)
            .zip(&self.robot.spans);
        for ((found, before), span) in moves {
            let next = Move {
                pace: before.next.pace,
                ..found.next
            };
            sampler.points_in(&next, span.pieces, |point| places.push(point.at));
        }
        let mut track = self.analysis.track.clone();
        if places.len() != track.len() {
            return None;
        }
        for (point, at) in track.path.points.iter_mut().zip(places) {
            point.at = at;
        }
        Some(track)
    }

    fn notes(&self, wishes: &Wishes) -> Vec<String> {
        let mut notes = Vec::new();
        for wish in wishes.targets.values().filter(|wish| wish.requested.len() > 1) {
            let away = wish.requested.iter().map(|(_, alone)| (alone - wish.by).norm());
            let farthest = away.fold(0.0, f64::max);
            if farthest > ONE_PLACE {
                let lines: Vec<String> = wish.requested.iter().map(|(line, _)| line.to_string()).collect();
                notes.push(format!(
                    "the moves of lines {} go to one target, which lies up to {:.1} µm from where each would have it: a target of its own for each would do \
                     better",
                    lines.join(", "),
                    farthest * 1e6
                ));
            }
        }
        if let Some(first) = wishes.joints.first() {
            notes.push(format!(
                "line {first}: a cut begins, ends or passes where joints are told, which stay as they are ({} such)",
                wishes.joints.len()
            ));
        }
        notes
    }
}

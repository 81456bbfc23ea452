//! The program of a robot that a path came from, with its targets moved so that the tool goes where the path is drawn.
//!
//! ```text
//! target' = target + frame_from_path (commanded - drawn) at the point where its move ends
//! ```
//!
//! Places alone are written anew, and orientations as they stand; all other bytes stay. Between its targets the robot goes
//! straight or on an arc as before, so what the arm yields there otherwise than at the ends is left: the program that was
//! written is read again, followed again in the same points, and told by what its tool then leaves.

use std::collections::BTreeMap;
use std::path::Path;

use armill_core::frame::Isometry;
use armill_core::load::PathLoad;
use armill_core::nalgebra::{Point3, Translation3, Vector3};
use armill_core::optimize::left_by;
use armill_core::path::{Sampler, Sampling, Track};
use armill_formats::robot_program::{
    FollowedMove, Motion, Moved, ProgramText, RobotMove, Spelled, Target, follow,
};
use serde::Serialize;

use crate::compensate::{ErrorAnswer, paths};
use crate::error::StudyError;
use crate::file::path::{PathAsk, RobotPath};
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
    pub told: InPlaceAnswer,
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

/// The program of `ask` along the commanded track.
///
/// `Err` with a sentence where it cannot be written.
///
/// # Errors
/// Cancelled by the watch.
pub(crate) fn in_place(
    runner: &Runner<'_>,
    ask: &PathAsk,
    (followed, load): (&Followed, &PathLoad),
    commanded: &Track,
) -> Result<Option<Result<InPlace, String>>, StudyError> {
    let Some(robot) = ask.source.robot() else {
        return Ok(None);
    };
    if followed.turned.is_some() {
        let why = "`posture.search` turns the tool otherwise than the program does";
        return Ok(Some(Err(why.to_owned())));
    }
    let writer = Writer {
        robot,
        ask,
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
    let question = runner.question(&ask.setting);
    let forces = (load, followed.along.choices.as_slice());
    let (along, residual) = left_by(&question, (&ask.track, &track), forces, runner.watch)?;
    let files: Files = written
        .into_iter()
        .map(|(name, bytes)| (name_of(&name), bytes))
        .collect();
    let told = InPlaceAnswer {
        language: robot.program.language.name(),
        files: files.iter().map(|(name, _)| name.clone()).collect(),
        moved_targets: wishes.targets.len(),
        after: ErrorAnswer::of(&ask.track, &residual, along.answers.case_count),
        notes: writer.notes(&wishes),
    };
    Ok(Some(Ok(InPlace {
        files,
        residual,
        told,
    })))
}

/// That the programs of these paths can be written into the folder `out`.
///
/// # Errors
/// One that was read lies there; two have one name.
pub fn check_folder(study: &Study, name: Option<&str>, out: &Path) -> Result<(), StudyError> {
    let mut names: Vec<String> = Vec::new();
    let robots = paths(study, name).filter_map(|(_, path)| path.source.robot());
    for text in robots.flat_map(|robot| &robot.program.texts) {
        let (file, name) = (Path::new(text.name()), name_of(text.name()));
        if let (Ok(ours), Ok(theirs)) = (out.join(&name).canonicalize(), file.canonicalize())
            && ours == theirs
        {
            let message = format!(
                "--out: {} is the program that was read, and would be written over",
                text.name()
            );
            return Err(StudyError::value(message, "another folder: --out DIR"));
        }
        if names.contains(&name) {
            let message = format!("two programs have a file `{name}`, and one folder holds one");
            return Err(StudyError::value(
                message,
                "one path at a time: --ask NAME --out DIR",
            ));
        }
        names.push(name);
    }
    Ok(())
}

/// The name of a file without its folder.
fn name_of(path: &str) -> String {
    let name = Path::new(path).file_name();
    name.map_or_else(|| path.to_owned(), |name| name.to_string_lossy().into_owned())
}

struct Writer<'a> {
    robot: &'a RobotPath,
    ask: &'a PathAsk,
    commanded: &'a Track,
}

/// Where a target is spelled.
type Key = (usize, usize);

/// By how much targets are to be moved.
#[derive(Default)]
struct Wishes {
    /// For each, by where it is spelled: every move that asks for one, its line and by how much, m, in the frame of the
    /// target.
    targets: BTreeMap<Key, Vec<(u32, Vector3<f64>)>>,
    /// Lines of cuts that begin or end at joints.
    joints: Vec<u32>,
}

impl Wishes {
    /// The mean of what is asked of the target that is spelled here.
    fn mean(&self, spelled: &Spelled) -> Option<Vector3<f64>> {
        let asked = self.targets.get(&key(spelled))?;
        Some(asked.iter().map(|(_, by)| by).sum::<Vector3<f64>>() / asked.len() as f64)
    }

    /// The target, moved; as it is where nobody asks.
    fn moved(&self, target: &Target) -> Option<Isometry> {
        let Target::Pose { pose, spelled, .. } = target else {
            return None;
        };
        let by = self.mean(spelled).unwrap_or_else(Vector3::zeros);
        Some(Translation3::from(by) * pose)
    }

    fn ask(&mut self, target: &Target, line: u32, by: Option<Vector3<f64>>) {
        match (target, by) {
            (Target::Pose { spelled, .. }, Some(by)) => {
                self.targets.entry(key(spelled)).or_default().push((line, by));
            }
            (Target::Joints(_), _) => self.joints.push(line),
            _ => {}
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

/// The files of a program, and what they were asked for.
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
        let moves = self.robot.followed.moves.iter().zip(&self.robot.spans);
        for (of, span) in moves {
            let told = &self.robot.program.moves[of.index];
            if let Some(end) = span.end {
                wishes.ask(&told.target, told.line, self.correction(of, end));
            }
            if let (Some(via), Some(at)) = (via(told), of.via) {
                let nearest = self.nearest(span.points.clone(), &at);
                let by = nearest.and_then(|point| self.correction(of, point));
                wishes.ask(via, told.line, by);
            }
        }
        wishes
    }

    /// What a point of the path is moved by, in the frame that the target of this move counts in, m.
    fn correction(&self, of: &FollowedMove, point: usize) -> Option<Vector3<f64>> {
        let [drawn, commanded] = [&self.ask.track, self.commanded].map(|track| track.path.points[point].at);
        Some(of.path_from_frame?.rotation.inverse() * (commanded - drawn))
    }

    /// The point of a stretch of the path that is nearest to a place.
    fn nearest(&self, points: std::ops::Range<usize>, at: &Point3<f64>) -> Option<usize> {
        let away = |point: &usize| (self.ask.track.path.points[*point].at - at).norm_squared();
        points.min_by(|a, b| away(a).total_cmp(&away(b)))
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
        let mut places = Vec::with_capacity(self.ask.track.len());
        let moves = found
            .moves
            .iter()
            .zip(&self.robot.followed.moves)
            .zip(&self.robot.spans);
        for ((found, before), span) in moves {
            let next = armill_core::path::Move {
                pace: before.next.pace,
                ..found.next
            };
            sampler.points_in(&next, span.pieces, |point| places.push(point.at));
        }
        let mut track = self.ask.track.clone();
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
        for asked in wishes.targets.values() {
            let mean = asked.iter().map(|(_, by)| by).sum::<Vector3<f64>>() / asked.len() as f64;
            let farthest = asked.iter().map(|(_, by)| (by - mean).norm()).fold(0.0, f64::max);
            if farthest > ONE_PLACE {
                let lines: Vec<String> = asked.iter().map(|(line, _)| line.to_string()).collect();
                notes.push(format!(
                    "the moves of lines {} go to one target, which lies in the mean of what they ask for, up to {:.1} µm from it; a target for each \
                     would do better",
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

//! The robot program that a path is from, with targets changed so that the tool follows the nominal path.
//!
//! ```text
//! target' = target + frame_from_path x        x nearest, over all points, to commanded - nominal   (core: `optimize::nodes`)
//! ```
//!
//! Only positions are changed; orientations and all other bytes remain. Between its targets the robot still moves
//! linearly or on an arc, and one target may need different corrections: at a corner, because forces turn with the
//! feed, or for several moves. The residual is reported: the written program is read again, sampled at the same points,
//! and evaluated by the deviation of its tool.

use std::collections::BTreeMap;
use std::path::Path;

use armill_core::frame::Isometry;
use armill_core::load::PathLoad;
use armill_core::nalgebra::{Point3, Translation3, Vector3};
use armill_core::optimize::{Shares, fitted, residual_of};
use armill_core::path::{LoadedTrack, Move, Sampler, Sampling, Spin, Track};
use armill_core::units::to_um;
use armill_formats::file::ResultFolder;
use armill_programs::{Motion, Moved, ProgramText, RobotMove, Spelled, Target, follow, read_as};
use armill_study::analysis::path::robot_program::Span;
use armill_study::analysis::path::run::Followed;
use armill_study::analysis::path::{PathAnalysis, RobotPath};
use armill_study::analysis::runner::Runner;
use armill_study::error::StudyError;
use armill_study::file::resolve::Study;
use serde::Serialize;

use super::error_answer::ErrorAnswer;

/// A program with its targets moved.
#[derive(Clone, Debug)]
pub struct RewrittenProgram {
    /// Its files, by their names without folder, and bytes.
    pub files: Vec<(String, Vec<u8>)>,
    /// Remaining deviation of the tool from the nominal path along it, under each load case, m, base.
    pub residual: Vec<Vector3<f64>>,
    /// In numbers.
    pub given: RewrittenProgramAnswer,
}

/// A program that was written again in place.
#[derive(Clone, Debug, Serialize)]
pub struct RewrittenProgramAnswer {
    /// Its language.
    pub language: &'static str,
    /// Its files.
    pub files: Vec<String>,
    /// Number of changed targets, including intermediate points of arcs.
    pub moved_targets: usize,
    /// Predicted deviation of the tool from the nominal path.
    pub after: ErrorAnswer,
    /// What a user must know of it, each a sentence.
    pub notes: Vec<String>,
}

/// Corrections of one target that differ by more than this are reported, m.
const ONE_PLACE: f64 = 1e-6;

/// The program of `analysis` along the commanded track.
///
/// `Err` with a sentence if it cannot be written.
///
/// # Errors
/// Cancelled by the watch.
pub(crate) fn in_place(
    runner: &Runner<'_>,
    analysis: &PathAnalysis,
    followed: &Followed,
    load: &PathLoad,
    commanded: &Track,
) -> Result<Option<Result<RewrittenProgram, String>>, StudyError> {
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
    let (written, corrections) = match writer.written() {
        Ok(written) => written,
        Err(why) => return Ok(Some(Err(why))),
    };
    let Some(track) = writer.track_of(runner, &written) else {
        let why = "the written program no longer describes the nominal path";
        return Ok(Some(Err(why.to_owned())));
    };
    let question = runner.question(&analysis.setting);
    let nominal = LoadedTrack {
        track: &analysis.track,
        load,
    };
    let choices = &followed.along.choices;
    let (along, residual) = residual_of(&question, nominal, &track, choices, runner.watch)?;
    let files: Files = written
        .into_iter()
        .map(|(name, bytes)| (name_of(&name), bytes))
        .collect();
    let given = RewrittenProgramAnswer {
        language: robot.program.language.name(),
        files: files.iter().map(|(name, _)| name.clone()).collect(),
        moved_targets: corrections.targets.len(),
        after: ErrorAnswer::of(&analysis.track, &residual, along.answers.case_count),
        notes: writer.notes(&corrections),
    };
    Ok(Some(Ok(RewrittenProgram {
        files,
        residual,
        given,
    })))
}

/// That the programs of these paths can be written into the folder `out`.
///
/// # Errors
/// The files of the programs; two of them must not have the same name.
pub fn allow_programs(study: &Study, name: Option<&str>, out: &ResultFolder) -> Result<(), StudyError> {
    let mut names: Vec<String> = Vec::new();
    let robots = study.paths(name).filter_map(|(_, path)| path.source.robot());
    for text in robots.flat_map(|robot| &robot.program.texts) {
        let name = name_of(text.name());
        if names.contains(&name) {
            let message = format!("two programs have a file `{name}`, and one folder can contain only one");
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
struct TargetCorrections {
    /// Each changed target, by its position in the text.
    targets: BTreeMap<Key, TargetCorrection>,
    /// Lines of cuts that begin, end or pass at a target given by joint positions.
    joints: Vec<u32>,
}

/// By how much one target is to be moved.
struct TargetCorrection {
    /// Which node of the fit it is.
    node: usize,
    /// Path to the frame of the target.
    path_from_frame: Isometry,
    /// Every move to it: its line, and the correction of this move alone, m, path.
    requested: Vec<(u32, Vector3<f64>)>,
    /// The common correction from all points, m, path.
    by: Vector3<f64>,
}

impl TargetCorrections {
    /// The changed target; unchanged if no correction is needed.
    fn moved(&self, target: &Target) -> Option<Isometry> {
        let Target::Pose { pose, spelled, .. } = target else {
            return None;
        };
        let by = self
            .targets
            .get(&key(spelled))
            .map_or_else(Vector3::zeros, |correction| {
                correction.path_from_frame.rotation.inverse() * correction.by
            });
        Some(Translation3::from(by) * pose)
    }

    /// The node of a target of a cut, with the correction `by`; none for a target given by joint positions.
    fn add(
        &mut self,
        target: &Target,
        line: u32,
        path_from_frame: Option<Isometry>,
        by: Vector3<f64>,
    ) -> Option<usize> {
        let node = self.targets.len();
        match (target, path_from_frame) {
            (Target::Pose { spelled, .. }, Some(path_from_frame)) => {
                let correction = self
                    .targets
                    .entry(key(spelled))
                    .or_insert_with(|| TargetCorrection {
                        node,
                        path_from_frame,
                        requested: Vec::new(),
                        by,
                    });
                correction.requested.push((line, by));
                Some(correction.node)
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

/// The points of a move, each with the fraction of the distance to it.
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
    fn written(&self) -> Result<(Files, TargetCorrections), String> {
        let program = &self.robot.program;
        let corrections = self.corrections();
        let is_corrected = |target: &Target| match target {
            Target::Pose { spelled, .. } => corrections.targets.contains_key(&key(spelled)),
            Target::Joints(_) | Target::Elsewhere { .. } => false,
        };
        let all = program.moves.iter().enumerate();
        let moved: Vec<Moved> = all
            .filter(|(_, of)| is_corrected(&of.target) || via(of).is_some_and(is_corrected))
            .filter_map(|(index, of)| {
                Some(Moved {
                    index,
                    target: corrections.moved(&of.target)?,
                    via: via(of).and_then(|via| corrections.moved(via)),
                })
            })
            .collect();
        let files = program.with_poses(&moved).map_err(|error| error.to_string())?;
        program
            .check_rewritten(&moved, &files)
            .map_err(|error| error.to_string())?;
        Ok((files, corrections))
    }

    /// By how much each target is to be moved.
    fn corrections(&self) -> TargetCorrections {
        let mut corrections = TargetCorrections::default();
        let (mut shares, mut expected) = (Vec::new(), Vec::new());
        // The node at which the tip is.
        let mut from = None;
        for (of, span) in self.robot.followed.moves.iter().zip(&self.robot.spans) {
            let given = &self.robot.program.moves[of.index];
            let end = span.end.and_then(|end| {
                corrections.add(
                    &given.target,
                    given.line,
                    of.path_from_frame,
                    self.correction(end),
                )
            });
            let passed = via(given).zip(of.via).and_then(|(via, at)| {
                let (nearest, part) = self.nearest(span, &at)?;
                // At an end of the arc it would not determine its middle.
                let node = corrections.add(via, given.line, of.path_from_frame, self.correction(nearest))?;
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
        let mut start = vec![Vector3::zeros(); corrections.targets.len()];
        for correction in corrections.targets.values() {
            start[correction.node] = correction.by;
        }
        let found = fitted(start, &shares, &expected);
        for correction in corrections.targets.values_mut() {
            correction.by = found[correction.node];
        }
        corrections
    }

    /// What a point of the path is to be moved by, m, path.
    fn correction(&self, point: usize) -> Vector3<f64> {
        let [drawn, commanded] =
            [&self.analysis.track, self.commanded].map(|track| track.path.points[point].at);
        commanded - drawn
    }

    /// The point of a move nearest to a position, and the fraction of the distance to it.
    fn nearest(&self, span: &Span, at: &Point3<f64>) -> Option<(usize, f64)> {
        let away = |point: usize| (self.analysis.track.path.points[point].at - at).norm_squared();
        parts(span).min_by(|a, b| away(a.0).total_cmp(&away(b.0)))
    }

    /// The path of these files, point for point; `None` if it is another path.
    fn track_of(&self, runner: &Runner<'_>, files: &Files) -> Option<Track> {
        let texts = files.iter().map(|(name, bytes)| ProgramText::new(name, bytes));
        let again = read_as(self.robot.program.language, texts.collect()).ok()?;
        let found = follow(&again, runner.robot, &self.robot.cell).ok()?;
        if found.moves.len() != self.robot.followed.moves.len() {
            return None;
        }
        // The data of the forces and measurements are not needed here.
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

    fn notes(&self, corrections: &TargetCorrections) -> Vec<String> {
        let mut notes = Vec::new();
        for correction in corrections
            .targets
            .values()
            .filter(|correction| correction.requested.len() > 1)
        {
            let away = correction
                .requested
                .iter()
                .map(|(_, alone)| (alone - correction.by).norm());
            let farthest = away.fold(0.0, f64::max);
            if farthest > ONE_PLACE {
                let lines: Vec<String> = correction
                    .requested
                    .iter()
                    .map(|(line, _)| line.to_string())
                    .collect();
                notes.push(format!(
                    "the moves of lines {} share one target, which is up to {:.1} µm from the best position for each: use separate targets for \
                     better results",
                    lines.join(", "),
                    to_um(farthest)
                ));
            }
        }
        if let Some(first) = corrections.joints.first() {
            notes.push(format!(
                "line {first}: a cut begins, ends or passes at a target given by joint positions, which is not changed ({} such)",
                corrections.joints.len()
            ));
        }
        notes
    }
}

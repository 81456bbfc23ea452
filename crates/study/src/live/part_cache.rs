//! The machined part of the last path, kept for requests of its surface: finished, and after any point of the path.
//!
//! It is used as long as the text and every file that was read for it are unchanged. The path is that of the [`PathCache`] if it is kept there.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use armill_core::watch::{Cancelled, Watch};
use armill_formats::input::Inputs;

use crate::analysis::path::PathAnalysis;
use crate::analysis::path::machined_part::answer::MachinedPartAnswer;
use crate::analysis::path::machined_part::run::refused;
use crate::analysis::path::machined_part::{InProcessPart, MachinedSetting};
use crate::analysis::path::run::PathResult;
use crate::analysis::runner::Runner;
use crate::analysis::vibration::SeriesVibration;
use crate::analysis::{AnalysisData, AnalysisResult, Subject};
use crate::error::StudyError;
use crate::live::part_surface::{finished_surface, in_process_surface};
use crate::live::path_cache::PathCache;
use crate::live::{EditedAnalysis, StudyText};
use crate::run::run_without_parts;

/// Triangles of a part in process at most: fluid while it is cut.
const MOST_TRIANGLES: usize = 100_000;

/// A surface that is requested.
#[derive(Clone, Copy, Debug)]
pub struct PartSurfaceQuestion<'a> {
    /// The analysis; the first if `None`.
    pub analysis: Option<&'a str>,
    /// Which of the frames, from 0 (the stock) to `frames` (the finished part).
    pub frame: usize,
    /// In how many frames the path is divided evenly by its points.
    pub frames: usize,
}

/// The part of the last path; empty at first.
#[derive(Debug, Default)]
pub struct PartCache {
    last: Mutex<Option<KeptPart>>,
}

/// A path, and its part as far as it was requested.
struct KeptPart {
    text: Vec<u8>,
    folder: PathBuf,
    /// The analysis as it was requested.
    analysis: Option<String>,
    /// The files that were read.
    inputs: Inputs,
    edited: EditedAnalysis<'static>,
    found: Box<PathResult>,
    /// The vibration at its points; empty if the study does not ask for it.
    vibration: Vec<SeriesVibration>,
    /// The surface of the finished part, as it is sent.
    finished: Option<Vec<u8>>,
    in_process: Option<InProcessPart>,
}

impl std::fmt::Debug for KeptPart {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("KeptPart")
            .field("analysis", &self.edited.name)
            .finish_non_exhaustive()
    }
}

impl PartCache {
    /// The surface of the part as `part_surface` describes it: after the points of the frame, or finished.
    ///
    /// # Errors
    /// A frame that is out of range; every problem of the text that concerns the analysis; an analysis without a machined
    /// part; a stock that is not a solid; cancelled by the watch.
    pub fn surface(
        &self,
        text: StudyText<'_>,
        question: &PartSurfaceQuestion<'_>,
        paths: &PathCache,
        watch: Watch<'_>,
    ) -> Result<Vec<u8>, StudyError> {
        check(question)?;
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if watch.is_cancelled() {
            return Err(Cancelled.into());
        }
        let kept = last.take().filter(|kept| kept.is_of(text, question.analysis));
        let mut kept = match kept {
            Some(kept) => kept,
            None => KeptPart::new(text, question.analysis, paths, watch)?,
        };
        let bytes = kept.surface(question, watch);
        *last = Some(kept);
        bytes
    }
}

/// Whether there is such a frame.
fn check(question: &PartSurfaceQuestion<'_>) -> Result<(), StudyError> {
    let PartSurfaceQuestion { frame, frames, .. } = *question;
    if frames == 0 {
        return Err(StudyError::value(
            "`frames` must be at least 1 (got 0)",
            "`frames` = the points of the path",
        ));
    }
    if frame > frames {
        return Err(StudyError::value(
            format!("frame {frame} is out of range: 0 to {frames}"),
            "0 is the stock, `frames` the finished part",
        ));
    }
    Ok(())
}

impl KeptPart {
    fn new(
        text: StudyText<'_>,
        analysis: Option<&str>,
        paths: &PathCache,
        watch: Watch<'_>,
    ) -> Result<KeptPart, StudyError> {
        let inputs = Inputs::current();
        let edited = inputs.during(|| text.one_analysis(analysis))?;
        machined_of(&edited)?;
        let kept = paths.with(text, analysis, |_, done| match &done.found {
            AnalysisData::Path(_, found) => Some((found.clone(), done.vibration.clone())),
            _ => None,
        });
        let found = match kept.flatten() {
            Some(found) => Some(found),
            None => {
                let done = run_without_parts(&edited.study, watch)?.into_iter().next();
                done.and_then(AnalysisResult::into_path)
            }
        };
        let (found, vibration) = found.ok_or_else(|| without_part(&edited.name))?;
        Ok(KeptPart {
            text: text.bytes.to_vec(),
            folder: text.folder.to_owned(),
            analysis: analysis.map(str::to_owned),
            inputs,
            found,
            vibration,
            edited: edited.in_folder(Path::new("")),
            finished: None,
            in_process: None,
        })
    }

    fn is_of(&self, text: StudyText<'_>, analysis: Option<&str>) -> bool {
        analysis == self.analysis.as_deref()
            && text.bytes == self.text
            && text.folder == self.folder
            && self.inputs.are_unchanged()
    }

    /// The requested surface.
    fn surface(
        &mut self,
        question: &PartSurfaceQuestion<'_>,
        watch: Watch<'_>,
    ) -> Result<Vec<u8>, StudyError> {
        let (path, machined) = machined_of(&self.edited)?;
        let runner = Runner::new(&self.edited.study.robot.robot, watch)?;
        let count = path.track.len();
        if question.frame == question.frames {
            if let Some(finished) = &self.finished {
                return Ok(finished.clone());
            }
            let followed = (&mut *self.found, self.vibration.first());
            let bytes = finished(&runner, path, followed, &mut self.in_process)?;
            return Ok(self.finished.insert(bytes).clone());
        }
        let in_process = match &mut self.in_process {
            Some(in_process) => in_process,
            absent => {
                let new = runner.in_process_part(path, &self.found)?;
                absent.insert(new.ok_or_else(|| without_part(&self.edited.name))?)
            }
        };
        let points = (question.frame as u128 * count as u128 / question.frames as u128) as usize;
        let refused = |error| refused(path, error);
        in_process.after(machined, points, watch).map_err(refused)?;
        let mesh = in_process.mesh(machined, MOST_TRIANGLES).map_err(refused)?;
        if watch.is_cancelled() {
            return Err(Cancelled.into());
        }
        in_process_surface(&mesh, &path.track.placing.base_from_path, points)
    }
}

/// The finished part of a path; its moves are kept for the part in process.
fn finished(
    runner: &Runner<'_>,
    path: &PathAnalysis,
    (found, vibration): (&mut PathResult, Option<&SeriesVibration>),
    in_process: &mut Option<InProcessPart>,
) -> Result<Vec<u8>, StudyError> {
    runner.cut_part(path, found)?;
    let answer = MachinedPartAnswer::of(runner.robot, path, found, vibration);
    let part = found.machined_part.take();
    let (Some(part), Some(machined)) = (part, &path.machined_part) else {
        return Err(without_part(path.shown()));
    };
    if in_process.is_none() {
        *in_process = Some(InProcessPart::of(path, machined, &part)?);
    }
    finished_surface(&part, answer, path.track.len())
}

/// The path of an analysis, and its machined part.
fn machined_of<'a>(
    edited: &'a EditedAnalysis<'_>,
) -> Result<(&'a PathAnalysis, &'a MachinedSetting), StudyError> {
    let first = edited.study.analyses.first();
    let Some(Subject::Path(path)) = first.map(|analysis| &analysis.subject) else {
        return Err(without_part(&edited.name));
    };
    let machined = path.machined_part.as_deref();
    Ok((path, machined.ok_or_else(|| without_part(&edited.name))?))
}

fn without_part(analysis: &str) -> StudyError {
    StudyError::value(
        format!("the analysis `{analysis}` has no `machined_part`"),
        "choose a path with `machined_part`",
    )
}

//! The last path that was evaluated, kept for requests of its columns and of the arm at its points: a long path takes
//! longer to read and to evaluate than to draw.
//!
//! It is used as long as the text and every file that was read for it are unchanged.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use armill_core::watch::Watch;
use armill_formats::input::Inputs;

use crate::analysis::path::run::PathResult;
use crate::analysis::vibration::SeriesVibration;
use crate::analysis::{AnalysisData, AnalysisResult, Subject};
use crate::error::StudyError;
use crate::live::lobes::{LobesAnswer, LobesQuestion, lobes, lobes_of};
use crate::live::path_columns::column_bytes;
use crate::live::posture::{PostureQuestion, PosturesAnswer, postures, postures_of};
use crate::live::{EditedAnalysis, StudyText};
use crate::run::run_without_parts;

/// The last path that was evaluated; empty at first.
#[derive(Debug, Default)]
pub struct PathCache {
    last: Mutex<Option<EvaluatedPath>>,
}

/// A path with the study that it belongs to.
struct EvaluatedPath {
    text: Vec<u8>,
    folder: PathBuf,
    /// The files that were read.
    inputs: Inputs,
    edited: EditedAnalysis<'static>,
    found: Box<PathResult>,
    vibration: Vec<SeriesVibration>,
}

impl std::fmt::Debug for EvaluatedPath {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("EvaluatedPath")
            .field("analysis", &self.edited.name)
            .finish_non_exhaustive()
    }
}

impl EvaluatedPath {
    fn is_of(&self, text: StudyText<'_>, analysis: Option<&str>) -> bool {
        analysis == Some(self.edited.name.as_str())
            && text.bytes == self.text
            && text.folder == self.folder
            && self.inputs.are_unchanged()
    }
}

impl PathCache {
    /// Values of these columns of a path, point after point: numbers of 4 bytes, little-endian, NaN where a value is
    /// not known.
    ///
    /// # Errors
    /// Every problem of the text that concerns the analysis; an analysis that is not a path; a column that it does not
    /// have; cancelled by the watch.
    pub fn columns(
        &self,
        text: StudyText<'_>,
        (analysis, keys): (Option<&str>, &[String]),
        watch: Watch<'_>,
    ) -> Result<Vec<u8>, StudyError> {
        let kept = self.with(text, analysis, |edited, done| column_bytes(edited, done, keys));
        if let Some(bytes) = kept {
            return bytes;
        }
        let inputs = Inputs::current();
        let edited = inputs.during(|| text.one_analysis(analysis))?;
        let mut done = run_without_parts(&edited.study, watch)?;
        let bytes = column_bytes(&edited, &done[0], keys)?;
        let found = done.remove(0).into_path();
        self.keep(text, edited, found, inputs);
        Ok(bytes)
    }

    /// As [`postures`], without another evaluation of a path that is kept.
    ///
    /// # Errors
    /// Those of [`postures`].
    pub fn postures(
        &self,
        text: StudyText<'_>,
        question: &PostureQuestion<'_>,
        watch: Watch<'_>,
    ) -> Result<PosturesAnswer, StudyError> {
        let kept = self.with(text, question.analysis, |edited, done| {
            postures_of(edited, &question.at, question.case, Some(done), watch)
        });
        kept.unwrap_or_else(|| postures(text, question, watch))
    }

    /// As `lobes`, without another evaluation of a path that is kept.
    ///
    /// # Errors
    /// Those of `lobes`.
    pub fn lobes(
        &self,
        text: StudyText<'_>,
        question: &LobesQuestion<'_>,
        watch: Watch<'_>,
    ) -> Result<LobesAnswer, StudyError> {
        let kept = self.with(text, question.analysis, |edited, done| {
            lobes_of(edited, question, Some(done), watch)
        });
        kept.unwrap_or_else(|| lobes(text, question, watch))
    }

    /// The result of `work` with the path of this text, if it is the one that is kept.
    pub(super) fn with<T>(
        &self,
        text: StudyText<'_>,
        analysis: Option<&str>,
        work: impl FnOnce(&EditedAnalysis<'_>, &AnalysisResult<'_>) -> T,
    ) -> Option<T> {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        let kept = last.take_if(|kept| kept.is_of(text, analysis))?;
        let edited = kept.edited.in_folder(text.folder);
        let Some(Subject::Path(path)) = edited.study.analyses.first().map(|first| &first.subject) else {
            return None;
        };
        let done = AnalysisResult {
            name: &edited.name,
            found: AnalysisData::Path(path, kept.found),
            vibration: kept.vibration,
        };
        let given = work(&edited, &done);
        *last = done.into_path().map(|(found, vibration)| EvaluatedPath {
            found,
            vibration,
            edited: edited.in_folder(Path::new("")),
            text: kept.text,
            folder: kept.folder,
            inputs: kept.inputs,
        });
        Some(given)
    }

    /// Keeps a path in place of the one before; another kind of analysis has none.
    pub(super) fn keep(
        &self,
        text: StudyText<'_>,
        edited: EditedAnalysis<'_>,
        found: Option<(Box<PathResult>, Vec<SeriesVibration>)>,
        inputs: Inputs,
    ) {
        let kept = found.map(|(found, vibration)| EvaluatedPath {
            text: text.bytes.to_vec(),
            folder: text.folder.to_owned(),
            inputs,
            edited: edited.in_folder(Path::new("")),
            found,
            vibration,
        });
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) = kept;
    }
}

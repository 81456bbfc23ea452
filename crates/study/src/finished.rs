//! A study with its results in memory, for later requests of tables, pictures and files.
//!
//! The result of an analysis borrows the analysis ([`AnalysisResult`]); here both are stored together, and combined for
//! the time of a request.

use std::path::PathBuf;
use std::sync::Arc;

use armill_core::map::{PlaneMap, VolumeMap};
use armill_core::optimize::HolesFound;
use armill_core::watch::Watch;
use armill_formats::file::ResultFolder;
use armill_formats::table::Table;

use crate::analysis::path::run::PathResult;
use crate::analysis::sections::Section;
use crate::analysis::vibration::SeriesVibration;
use crate::analysis::{Analysis, AnalysisData, AnalysisResult, Subject};
use crate::answer::{StudyAnswer, answer};
use crate::error::StudyError;
use crate::file::resolve::Study;
use crate::output::{self, OutputOptions, Picture, StudyResults};
use crate::run::run;

/// A study with its results.
#[derive(Debug)]
pub struct FinishedRun {
    study: Arc<Study>,
    kept: Vec<StoredResult>,
    answer: StudyAnswer,
}

/// One result, without its analysis.
#[derive(Debug)]
struct StoredResult {
    data: StoredData,
    vibration: Vec<SeriesVibration>,
}

/// Its data.
#[derive(Debug)]
enum StoredData {
    Map(PlaneMap),
    Sections(Vec<PlaneMap>),
    Volume(VolumeMap),
    Path(Box<PathResult>),
    Holes(Box<HolesFound>),
}

impl FinishedRun {
    /// Runs the study on the threads of the current rayon pool.
    ///
    /// # Errors
    /// Those of [`run`].
    pub fn run(study: Arc<Study>, watch: Watch<'_>) -> Result<FinishedRun, StudyError> {
        let found = run(&study, watch)?;
        let answer = answer(&study, &found);
        let kept = found.into_iter().map(StoredResult::of).collect();
        Ok(FinishedRun { study, kept, answer })
    }

    /// The answer.
    pub fn answer(&self) -> &StudyAnswer {
        &self.answer
    }

    /// The names of the analyses, in the order of the study.
    pub fn analyses(&self) -> Vec<&str> {
        self.study
            .analyses
            .iter()
            .map(|analysis| analysis.name.as_str())
            .collect()
    }

    /// The points of analysis `index` with their columns.
    ///
    /// # Errors
    /// A table that cannot be made, which would be a fault of armill.
    pub fn table(&mut self, index: usize) -> Result<Table, StudyError> {
        self.with(|of| output::points_table(of.study, &of.done[index]))
    }

    /// The pictures of every analysis.
    pub fn pictures(&mut self) -> Vec<Picture> {
        self.with(output::pictures)
    }

    /// Writes everything into the folder `out`, as `armill run` does, and gives the paths of the files.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(
        &mut self,
        out: &ResultFolder,
        requested: OutputOptions<'_>,
    ) -> Result<Vec<PathBuf>, StudyError> {
        self.with(|results| output::write(results, out, requested, &|_| ()))
    }

    /// Puts both side by side for `work`.
    fn with<T>(&mut self, work: impl FnOnce(StudyResults<'_>) -> T) -> T {
        let study = Arc::clone(&self.study);
        let kept = std::mem::take(&mut self.kept).into_iter();
        let pairs = study.analyses.iter().zip(kept);
        let done: Vec<AnalysisResult<'_>> = pairs
            .filter_map(|(analysis, kept)| combined(analysis, kept))
            .collect();
        let gives = work(StudyResults {
            study: &study,
            done: &done,
            answer: &self.answer,
        });
        self.kept = done.into_iter().map(StoredResult::of).collect();
        gives
    }
}

impl StoredResult {
    fn of(done: AnalysisResult<'_>) -> StoredResult {
        StoredResult {
            data: StoredData::of(done.found),
            vibration: done.vibration,
        }
    }
}

impl StoredData {
    fn of(found: AnalysisData<'_>) -> StoredData {
        match found {
            AnalysisData::Map(_, map) => StoredData::Map(map),
            AnalysisData::Sections(sections) => {
                StoredData::Sections(sections.into_iter().map(|section| section.map).collect())
            }
            AnalysisData::Volume(_, map) => StoredData::Volume(map),
            AnalysisData::Path(_, path) => StoredData::Path(path),
            AnalysisData::Holes(_, holes) => StoredData::Holes(holes),
        }
    }
}

/// A result with its analysis; both are always of one kind.
fn combined(analysis: &Analysis, kept: StoredResult) -> Option<AnalysisResult<'_>> {
    let found = match (&analysis.subject, kept.data) {
        (Subject::Map(sheet), StoredData::Map(map)) => AnalysisData::Map(sheet, map),
        (Subject::Sections(sheets), StoredData::Sections(maps)) => {
            let sections = sheets.iter().zip(maps);
            AnalysisData::Sections(
                sections
                    .map(|((label, sheet), map)| Section { label, sheet, map })
                    .collect(),
            )
        }
        (Subject::Volume(setting, _), StoredData::Volume(map)) => AnalysisData::Volume(setting, map),
        (Subject::Path(path), StoredData::Path(found)) => AnalysisData::Path(path, found),
        (Subject::Holes(holes), StoredData::Holes(found)) => AnalysisData::Holes(holes, found),
        _ => return None,
    };
    Some(AnalysisResult {
        name: &analysis.name,
        found,
        vibration: kept.vibration,
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use armill_formats::file::Writer;

    use super::*;
    use crate::studies;

    #[test]
    fn stored_results_give_the_same_answer_at_every_request() {
        let study = studies::find(Path::new("mh12-groove")).unwrap().read().unwrap();
        let study = Arc::new(study);
        let done = run(&study, Watch::NONE).unwrap();
        let mut finished = FinishedRun::run(Arc::clone(&study), Watch::NONE).unwrap();
        let witness = answer(&study, &done);
        assert_eq!(
            output::json(finished.answer()).unwrap(),
            output::json(&witness).unwrap()
        );
        for _ in 0..2 {
            for (index, done) in done.iter().enumerate() {
                let table = output::points_table(&study, done).unwrap();
                assert_eq!(finished.table(index).unwrap(), table);
            }
            let pictures = output::pictures(StudyResults {
                study: &study,
                done: &done,
                answer: &witness,
            });
            let names = |all: &[Picture]| all.iter().map(|p| p.name.clone()).collect::<Vec<_>>();
            assert_eq!(names(&finished.pictures()), names(&pictures));
        }
        let folder = tempfile::tempdir().unwrap();
        let out = Writer::new("run", false).folder(folder.path()).unwrap();
        let files = finished.write(&out, OutputOptions::TABLES).unwrap();
        assert!(files.iter().all(|file| file.is_file()));
        assert_eq!(finished.analyses().len(), done.len());
    }
}

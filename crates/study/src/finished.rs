//! A study that has been run, kept with all that came out, so that whoever holds it asks for tables, pictures and files
//! when he wants them.
//!
//! What comes out of an ask borrows what was asked ([`Done`]); here both stay together, and are put side by side for the time
//! of a question.

use std::path::PathBuf;
use std::sync::Arc;

use armill_core::map::{PlaneMap, VolumeMap};
use armill_core::optimize::HolesFound;
use armill_core::watch::Watch;
use armill_formats::file::ResultFolder;
use armill_formats::table::Table;

use crate::answer::{StudyAnswer, answer};
use crate::error::StudyError;
use crate::file::resolve::{Ask, Study, Subject};
use crate::output::{self, Picture, Wanted};
use crate::run::{Done, Found, PathFound, Section, run};

/// A study with what came out.
#[derive(Debug)]
pub struct Finished {
    study: Arc<Study>,
    kept: Vec<Kept>,
    answer: StudyAnswer,
}

/// What came out of one ask, without what was asked.
#[derive(Debug)]
enum Kept {
    Map(PlaneMap),
    Sections(Vec<PlaneMap>),
    Volume(VolumeMap),
    Path(Box<PathFound>),
    Holes(Box<HolesFound>),
}

impl Finished {
    /// Runs the study on the threads of the current rayon pool.
    ///
    /// # Errors
    /// Those of [`run`].
    pub fn run(study: Arc<Study>, watch: Watch<'_>) -> Result<Finished, StudyError> {
        let found = run(&study, watch)?;
        let answer = answer(&study, &found);
        let kept = found.into_iter().map(|done| Kept::of(done.found)).collect();
        Ok(Finished { study, kept, answer })
    }

    /// The answer.
    pub fn answer(&self) -> &StudyAnswer {
        &self.answer
    }

    /// The names of the asks, in the order of the study.
    pub fn analyses(&self) -> Vec<&str> {
        self.study.analyses.iter().map(|analysis| analysis.name.as_str()).collect()
    }

    /// The points of ask `index` with their columns.
    ///
    /// # Errors
    /// A table that cannot be made, which would be a fault of armill.
    pub fn table(&mut self, index: usize) -> Result<Table, StudyError> {
        self.with(|study, done, _| output::points_table(study, &done[index]))
    }

    /// The pictures of every ask.
    pub fn pictures(&mut self) -> Vec<Picture> {
        self.with(output::pictures)
    }

    /// Writes everything into the folder `out`, as `armill run` does, and gives the paths of the files.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(&mut self, out: &ResultFolder, requested: Wanted<'_>) -> Result<Vec<PathBuf>, StudyError> {
        self.with(|study, done, answer| output::write(study, done, answer, (out, requested), &|_| ()))
    }

    /// Puts both side by side for `work`.
    fn with<T>(&mut self, work: impl FnOnce(&Study, &[Done<'_>], &StudyAnswer) -> T) -> T {
        let study = Arc::clone(&self.study);
        let kept = std::mem::take(&mut self.kept).into_iter();
        let done: Vec<Done<'_>> = study.analyses.iter().zip(kept).filter_map(beside).collect();
        let gives = work(&study, &done, &self.answer);
        self.kept = done.into_iter().map(|done| Kept::of(done.found)).collect();
        gives
    }
}

impl Kept {
    fn of(found: Found<'_>) -> Kept {
        match found {
            Found::Map(_, map) => Kept::Map(map),
            Found::Sections(sections) => {
                Kept::Sections(sections.into_iter().map(|section| section.map).collect())
            }
            Found::Volume(_, map) => Kept::Volume(map),
            Found::Path(_, path) => Kept::Path(path),
            Found::Holes(_, holes) => Kept::Holes(holes),
        }
    }
}

/// What came out beside what was asked; always both of one kind.
fn beside((analysis, kept): (&Ask, Kept)) -> Option<Done<'_>> {
    let found = match (&analysis.subject, kept) {
        (Subject::Map(sheet), Kept::Map(map)) => Found::Map(sheet, map),
        (Subject::Sections(sheets), Kept::Sections(maps)) => {
            let sections = sheets.iter().zip(maps);
            Found::Sections(
                sections
                    .map(|((label, sheet), map)| Section { label, sheet, map })
                    .collect(),
            )
        }
        (Subject::Volume(setting, _), Kept::Volume(map)) => Found::Volume(setting, map),
        (Subject::Path(path), Kept::Path(found)) => Found::Path(path, found),
        (Subject::Holes(holes), Kept::Holes(found)) => Found::Holes(holes, found),
        _ => return None,
    };
    Some(Done {
        name: &analysis.name,
        found,
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use armill_formats::file::Writer;

    use super::*;
    use crate::studies;

    #[test]
    fn what_is_kept_gives_the_same_as_what_was_found_however_often_it_is_asked() {
        let study = studies::find(Path::new("mh12-groove")).unwrap().read().unwrap();
        let study = Arc::new(study);
        let done = run(&study, Watch::NONE).unwrap();
        let mut finished = Finished::run(Arc::clone(&study), Watch::NONE).unwrap();
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
            let pictures = output::pictures(&study, &done, &witness);
            let names = |all: &[Picture]| all.iter().map(|p| p.name.clone()).collect::<Vec<_>>();
            assert_eq!(names(&finished.pictures()), names(&pictures));
        }
        let folder = tempfile::tempdir().unwrap();
        let out = Writer::new("run", false).folder(folder.path()).unwrap();
        let files = finished.write(&out, Wanted::TABLES).unwrap();
        assert!(files.iter().all(|file| file.is_file()));
        assert_eq!(finished.analyses().len(), done.len());
    }
}

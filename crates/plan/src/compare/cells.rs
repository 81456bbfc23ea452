//! The cells compared: studies as given, and each of them with other robots.
//!
//! | given | cells | names |
//! |---|---|---|
//! | studies | each as given | by their folders |
//! | one study, robots | as given, then with each robot | by their robots |
//! | studies, robots | each as given and with each robot | `FOLDER`, `FOLDER with ROBOT` |
//!
//! The study's own robot does not make a second cell. [`ComparableCells`] are those with analyses in common.

use std::path::{Path, PathBuf};

use armill_formats::document::{Problem, Problems};
use armill_formats::robot::RobotDescription;
use armill_study::error::StudyError;
use armill_study::file::resolve::Study;
use armill_study::studies::{self, FoundStudy};
use armill_study::{library, robots};

use super::other_robot;

/// Greatest number of cells: pictures cannot show more lines.
const MOST_CELLS: usize = 40;

/// One set-up to compare.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Its name.
    pub name: String,
    /// Name of its study in errors.
    pub shown: String,
    /// Its analyses.
    pub study: Study,
    /// Where it is read from.
    pub(super) source: CellSource,
}

/// The study file of a cell, and the robot that replaces its own.
#[derive(Clone, Debug)]
pub(super) struct CellSource {
    study: FoundStudy,
    robot: Option<Other>,
}

impl CellSource {
    /// The study of the cell, its file changed as by `change`.
    ///
    /// # Errors
    /// All problems of the file; a study that cannot use the robot; those of `change`.
    pub(super) fn read_changed(
        &self,
        change: impl FnOnce(&FoundStudy) -> Result<FoundStudy, StudyError>,
    ) -> Result<Study, StudyError> {
        let changed = change(&self.study)?;
        match &self.robot {
            Some(other) => other.in_place(&changed),
            None => changed.read(),
        }
    }
}

/// Cells with analyses in common; the others are left out.
#[derive(Clone, Debug)]
pub struct ComparableCells {
    pub(super) cells: Vec<Cell>,
    pub(super) left_out: Vec<String>,
}

impl ComparableCells {
    /// Whether cells have different robots.
    pub(super) fn has_several_robots(&self) -> bool {
        let name = |cell: &Cell| cell.study.robot.robot.name().to_owned();
        self.cells.iter().any(|cell| name(cell) != name(&self.cells[0]))
    }
}

/// The cells of these studies (folders, files, names of examples) with these robots (of the library, or files
/// relative to the current folder).
///
/// # Errors
/// What is wrong in any study or robot, all together; fewer than two cells, or too many; a study twice.
pub fn cells(given: &[PathBuf], robot_names: &[String]) -> Result<Vec<Cell>, StudyError> {
    let mut errors = Vec::new();
    let mut keep = |error| errors.push(error);
    let mut others: Vec<Other> = Vec::new();
    for name in robot_names {
        match robots::find(name, Path::new(".")) {
            Ok(robot) if others.iter().any(|other| other.name() == robot.robot.name()) => {
                let message = format!("--robot: `{name}` is given twice");
                keep(StudyError::value(message, "each robot once"));
            }
            Ok(robot) => others.push(Other {
                found_as: wherever(name),
                robot,
            }),
            Err(error) => keep(error),
        }
    }
    let mut found: Vec<FoundStudy> = Vec::new();
    for path in given {
        match studies::find(path) {
            Ok(study) if found.iter().any(|other| same_file(&other.shown, &study.shown)) => {
                let message = format!("the study {} is given twice", study.shown);
                keep(StudyError::value(
                    message,
                    "each study once; a robot in its place: --robot NAME",
                ));
            }
            Ok(study) => found.push(study),
            Err(error) => keep(error),
        }
    }
    let labels = labels(&found);
    let mut cells = Vec::new();
    for (study, label) in found.iter().zip(labels) {
        match study.read() {
            Ok(own) => {
                for other in others
                    .iter()
                    .filter(|other| other.name() != own.robot.robot.name())
                {
                    match other.in_place(study) {
                        Ok(swapped) => cells.push((Some(other), label.clone(), study, swapped)),
                        Err(error) => keep(error),
                    }
                }
                // The study as given comes before its other robots.
                let at = cells.iter().position(|(_, of, ..)| *of == label);
                cells.insert(at.unwrap_or(cells.len()), (None, label, study, own));
            }
            Err(error) => keep(error),
        }
    }
    together(errors)?;
    let one_study = found.len() == 1;
    let cells: Vec<Cell> = cells
        .into_iter()
        .map(|(robot, label, of, study)| Cell {
            name: match robot {
                _ if one_study => study.robot.robot.name().to_owned(),
                Some(other) => format!("{label} with {}", other.name()),
                None => label,
            },
            shown: of.shown.clone(),
            study,
            source: CellSource {
                study: of.clone(),
                robot: robot.cloned(),
            },
        })
        .collect();
    match cells.len() {
        0 | 1 => Err(StudyError::value(
            "one study with its own robot is one cell: there is nothing to compare it with",
            "another study, or the same with another robot: --robot kuka/kr120r2500pro (`armill robots` lists them)",
        )),
        n if n > MOST_CELLS => Err(StudyError::value(
            format!("{n} cells: at most {MOST_CELLS} can be compared"),
            "compare in groups",
        )),
        _ => Ok(cells),
    }
}

/// A robot that replaces others.
#[derive(Clone, Debug)]
struct Other {
    /// What a study finds it by.
    found_as: String,
    robot: RobotDescription,
}

impl Other {
    fn name(&self) -> &str {
        self.robot.robot.name()
    }

    /// This study with it.
    ///
    /// # Errors
    /// All problems of the file, with the robot's name after that of the file; a study that cannot use it.
    fn in_place(&self, study: &FoundStudy) -> Result<Study, StudyError> {
        let study = FoundStudy {
            shown: format!("{} (with {})", study.shown, self.name()),
            ..study.clone()
        };
        let mut fits = Ok(());
        let read = study.read_changed(|file| {
            fits = other_robot::put(file, &self.found_as, &self.robot);
        });
        match fits {
            Err(StudyError::Value { message, hint }) => {
                Err(StudyError::value(format!("{}: {message}", study.shown), hint))
            }
            Err(other) => Err(other),
            Ok(()) => read,
        }
    }
}

/// The reference by which a study in any folder finds a robot: the name in the library, else the absolute path of its
/// file.
fn wherever(name: &str) -> String {
    let path =
        || std::path::absolute(name).map_or_else(|_| name.to_owned(), |path| path.display().to_string());
    match library::robot(name) {
        Some(_) => name.to_owned(),
        None => path(),
    }
}

/// Whether two studies are one file, even with different paths.
fn same_file(a: &str, b: &str) -> bool {
    let whole = |shown: &str| std::fs::canonicalize(shown).unwrap_or_else(|_| PathBuf::from(shown));
    whole(a) == whole(b)
}

/// Names of the studies: those of their folders, or their complete paths if folders have the same name.
fn labels(found: &[FoundStudy]) -> Vec<String> {
    let short = |study: &FoundStudy| {
        let file = Path::new(&study.shown);
        let plain = file.file_name().is_some_and(|name| name == "study.toml");
        let of = if plain { file.parent() } else { None };
        let name = of.and_then(Path::file_name).or(file.file_stem());
        name.map_or_else(|| study.shown.clone(), |name| name.to_string_lossy().into_owned())
    };
    let short: Vec<String> = found.iter().map(short).collect();
    let unlike = |i: usize| short.iter().filter(|other| **other == short[i]).count() == 1;
    (0..found.len())
        .map(|i| match unlike(i) {
            true => short[i].clone(),
            false => found[i].shown.clone(),
        })
        .collect()
}

/// `Ok` without errors; otherwise the problems of all files, or if no file has problems all other errors in one.
fn together(errors: Vec<StudyError>) -> Result<(), StudyError> {
    let (mut problems, mut values): (Vec<Problem>, Vec<[String; 2]>) = (Vec::new(), Vec::new());
    for error in errors {
        match error {
            StudyError::Problems(of_file) => {
                problems.extend(
                    of_file
                        .into_iter()
                        .filter(|problem| !problems.contains(problem))
                        .collect::<Vec<_>>(),
                );
            }
            StudyError::Value { message, hint } => values.push([message, hint]),
            other => return Err(other),
        }
    }
    // Each with its own hint, as if they were reported separately.
    let reported = values.into_iter().reduce(|[first, hint], [message, next_hint]| {
        [format!("{first}\n  help: {hint}\nerror: {message}"), next_hint]
    });
    if let Some([message, hint]) = reported {
        return Err(StudyError::value(message, hint));
    }
    Ok(Problems::from(problems).into_result()?)
}

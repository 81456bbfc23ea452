//! Files into one circle: the runs of all of them, and the results of the software of the ball-bar.

use std::io::BufReader;
use std::path::Path;

use armill_core::measure::ballbar::{CircularTest, Run, RunError};
use armill_formats::document::{Problem, Problems};
use armill_formats::input;
use armill_formats::measurement::ballbar::{self, BallbarFile, BallbarReadOptions, BallbarRuns, Results};

use crate::error::StudyError;

/// Data that the files do not contain.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FileOptions {
    /// Data of the runs that a file does not contain.
    pub given: BallbarReadOptions,
    /// The plane, by its two axes.
    pub plane: Option<String>,
    /// Speed along the circle, m/s.
    pub feed: Option<f64>,
}

/// Name and origin of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Origin {
    /// `CW1`: direction and number of the run.
    pub name: String,
    /// Its name in the file; empty if there is none.
    pub label: String,
    /// Its file.
    pub file: String,
}

/// One circle, as files have it.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredTest {
    /// All runs.
    pub test: CircularTest,
    /// One a run.
    pub origins: Vec<Origin>,
    /// All files, in the order in which they were named.
    pub files: Vec<String>,
    /// Speed along the circle, m/s.
    pub feed: Option<f64>,
    /// Name of the plane.
    pub plane: Option<String>,
    /// Results of the software of the ball-bar, each with its file.
    pub results: Vec<(String, Results)>,
    /// Unused columns, each with its file.
    pub unused: Vec<String>,
    /// What a user must know, each a sentence.
    pub notes: Vec<String>,
}

impl MeasuredTest {
    /// Names of the two axes of the plane; A and B if they are not given.
    pub fn axes(&self) -> [String; 2] {
        let plane = self.plane.as_deref().unwrap_or_default();
        match plane.chars().collect::<Vec<_>>()[..] {
            [a, b] if a.is_alphabetic() && b.is_alphabetic() && a != b => [a, b].map(String::from),
            _ => ["A", "B"].map(String::from),
        }
    }
}

/// Reads one circle from all `files`.
///
/// # Errors
/// Files that cannot be read; the problems of all files; no runs; radii, planes or feeds of different circles.
pub fn read(files: &[impl AsRef<Path>], requested: &FileOptions) -> Result<MeasuredTest, StudyError> {
    let mut problems: Vec<Problem> = Vec::new();
    let mut recorded: Vec<(String, BallbarRuns)> = Vec::new();
    let mut results = Vec::new();
    for path in files {
        let shown = path.as_ref().display().to_string();
        let file = input::open(path.as_ref()).map_err(|error| {
            StudyError::value(
                format!("cannot read {shown}: {error}"),
                "a CSV with `angle_deg,radius_dev_um,direction,run`, or results of a ball-bar (.b5r)",
            )
        })?;
        match ballbar::read(&shown, BufReader::new(file), &requested.given) {
            Ok(BallbarFile::Runs(runs)) => recorded.push((shown, runs)),
            Ok(BallbarFile::Results(found, runs)) => {
                recorded.extend(runs.map(|runs| (shown.clone(), runs)));
                results.push((shown, found));
            }
            Err(wrong) => problems.extend(wrong),
        }
    }
    Problems::from(problems).into_result()?;
    let radius = one_of(&recorded, "nominal radius", requested.given.radius, |file| {
        file.radius
    })?;
    let feed = one_of(&recorded, "feed", requested.feed, |file| file.feed)?;
    let plane = one_of(&recorded, "plane", requested.plane.clone(), |file| {
        file.plane.clone()
    })?;
    if recorded.is_empty() {
        let message = match results.is_empty() {
            true => "no file was named".to_owned(),
            false => "these files contain results only, no radii".to_owned(),
        };
        let hint =
            "give a CSV with the radii too; the results of the Renishaw software are shown for comparison";
        return Err(StudyError::value(message, hint));
    }
    let Some(radius) = radius else {
        return Err(StudyError::value(
            "the nominal radius is not given",
            "a line `# radius_mm: 100` in the file, or --radius-mm 100",
        ));
    };
    let mut notes = Vec::new();
    let mut unused = Vec::new();
    let mut runs: Vec<Run> = Vec::new();
    let mut origins = Vec::new();
    for (file, recorded) in recorded {
        notes.extend(recorded.notes.into_iter().map(|note| format!("{file}: {note}")));
        unused.extend(recorded.unused.into_iter().map(|name| format!("{file}: {name}")));
        for (run, label) in recorded.runs.into_iter().zip(recorded.names) {
            let before = runs
                .iter()
                .filter(|other| other.direction() == run.direction())
                .count();
            origins.push(Origin {
                name: format!("{}{}", run.direction().name(), before + 1),
                label,
                file: file.clone(),
            });
            runs.push(run);
        }
    }
    let test = CircularTest::new(radius, runs).map_err(|error| {
        // Runs are numbered from the first of each file on: as in results, and as in the file.
        let message = match &error {
            RunError::TooFar {
                run,
                sample,
                deviation,
                radius,
            } => {
                let Origin { name, label, file } = &origins[*run];
                let label = match label.as_str() {
                    "" => String::new(),
                    label => format!(" (run `{label}`)"),
                };
                let why = CircularTest::too_far(*radius, *deviation).unwrap_or_default();
                format!("{file}: {name}{label}, sample {}: {why}", sample + 1)
            }
            RunError::TooMany(_) => {
                return StudyError::value(error.to_string(), "name fewer files, or fewer runs");
            }
            _ => error.to_string(),
        };
        StudyError::value(message, "is the nominal radius right, and the unit of the radii?")
    })?;
    Ok(MeasuredTest {
        test,
        origins,
        files: files
            .iter()
            .map(|path| path.as_ref().display().to_string())
            .collect(),
        feed,
        plane,
        results,
        unused,
        notes,
    })
}

/// The common value of all files and the option.
///
/// # Errors
/// Two files, or a file and an option, that differ.
fn one_of<T: PartialEq + std::fmt::Debug>(
    files: &[(String, BallbarRuns)],
    what: &str,
    given: Option<T>,
    of: impl Fn(&BallbarRuns) -> Option<T>,
) -> Result<Option<T>, StudyError> {
    let mut found: Option<(T, &str)> = given.map(|value| (value, "the option"));
    for (file, recorded) in files {
        let Some(value) = of(recorded) else {
            continue;
        };
        match &found {
            Some((before, place)) if *before != value => {
                let message = format!("{file} has another {what} than {place}");
                return Err(StudyError::value(
                    message,
                    "files of one command are of one circle",
                ));
            }
            Some(_) => {}
            None => found = Some((value, file)),
        }
    }
    Ok(found.map(|(value, _)| value))
}

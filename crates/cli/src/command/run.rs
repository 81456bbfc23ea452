//! `armill run`: a study from file to report.
//!
//! All files go into `--out` (`out` next to the study): `--no-pictures` omits pictures and report, `--csv` adds tables.
//! Stdout has the result as text, or with `--json` all of `result.json`; warnings and progress go to stderr. `--strict`
//! exits with 1 if the tolerance is not met at every point.

use armill_formats::file::ResultFolder;
use armill_study::answer::{StudyAnswer, answer};
use armill_study::output::{self, Csv, Opening, OutputOptions, Pictures, StudyResults};
use armill_study::run::point_count;
use armill_study::run::run as run_study;
use armill_study::studies::{self, FoundStudy};
use armill_study::{Study, StudyError};

use crate::arguments::{RunArguments, RunOptions};
use crate::listener;
use crate::outcome::Outcome;
use crate::progress::Progress;
use crate::terminal::{print, say};

/// Runs the study and writes all results.
///
/// # Errors
/// No such study, or its problems; a folder that cannot be written (reported before the work starts); an
/// error while results are written.
pub(crate) fn run(arguments: &RunArguments) -> Result<Outcome, StudyError> {
    let found = studies::find(&arguments.run.study)?;
    let study = found.read()?;
    let out = folder("run", "out", &found, &arguments.run)?;
    results(&study, &out, &arguments.run, None, summary)
}

/// The folder for the results of the command `by`: the one that the options name, or `name` in the folder of the study.
///
/// # Errors
/// A folder that cannot be written, or that another run is writing.
pub(super) fn folder(
    by: &'static str,
    name: &str,
    found: &FoundStudy,
    options: &RunOptions,
) -> Result<ResultFolder, StudyError> {
    let writer = options.writing.writer(by);
    Ok(match &options.out {
        Some(out) => writer.folder(out)?,
        None => writer.folder_in(&found.folder, name)?,
    })
}

/// Runs a study, writes all results into the folder `out`, with `opening` before the report, and prints the result;
/// as text the sentences of `summary`.
///
/// # Errors
/// Files that must not be replaced (reported before the work starts); an error while results are written.
pub(super) fn results(
    study: &Study,
    out: &ResultFolder,
    options: &RunOptions,
    opening: Option<&Opening>,
    summary: impl FnOnce(&StudyAnswer) -> String,
) -> Result<Outcome, StudyError> {
    let mut requested = OutputOptions {
        opening,
        ..OutputOptions::USUAL
    };
    if options.no_pictures {
        requested.pictures = Pictures::None;
    }
    if options.csv {
        requested.csv = Csv::Every;
    }
    output::allow(study, out, requested)?;
    let answer = in_pool(options.threads, || work(study, out, requested))??;
    if options.json {
        print(output::json(&answer)?.trim_end())?;
    } else {
        print(&summary(&answer))?;
    }
    for warning in &answer.warnings {
        say(&format!("warning: {warning}"));
    }
    say(&format!("results in {}", out.path().display()));
    Ok(if options.strict && !answer.meets_tolerance() {
        Outcome::ToleranceNotMet
    } else {
        Outcome::Fine
    })
}

/// Runs `work` on this many threads, or one per processor; the numbers are the same.
pub(super) fn in_pool<T: Send>(
    threads: Option<u16>,
    work: impl FnOnce() -> T + Send,
) -> Result<T, StudyError> {
    let Some(threads) = threads else { return Ok(work()) };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(usize::from(threads))
        .build();
    let pool = pool.map_err(|error| {
        StudyError::value(format!("cannot start {threads} threads: {error}"), "try fewer")
    })?;
    let listener = listener::current();
    Ok(pool.install(|| listener::heard_by(listener, work)))
}

/// Computes the study and writes its files, under a progress bar.
fn work(study: &Study, out: &ResultFolder, requested: OutputOptions<'_>) -> Result<StudyAnswer, StudyError> {
    let progress = Progress::new(point_count(study));
    let found = progress.watch(|watch| run_study(study, watch))?;
    let answer = answer(study, &found);
    let results = StudyResults {
        study,
        done: &found,
        answer: &answer,
    };
    output::write(results, out, requested, &|name| {
        progress.set_message(name);
    })?;
    Ok(answer)
}

/// The result as text: the main sentence, then each statement of a source with the
/// possible readings, each with the range of its in-plane deviation.
fn summary(answer: &StudyAnswer) -> String {
    let mut lines = vec![answer.answer.clone()];
    for statement in &answer.statements {
        lines.push(String::new());
        lines.push(format!(
            "{} ({}): at most {} µm",
            statement.text, statement.source, statement.at_most_um
        ));
        for reading in &statement.readings {
            let range = reading
                .in_plane_um
                .map_or("not reached".to_owned(), |[a, b]| format!("{a:.1} to {b:.1} µm"));
            let verdict = if reading.consistent {
                "consistent"
            } else {
                "not consistent"
            };
            let limits = if reading.inside_joint_limits {
                ""
            } else {
                ", outside joint limits"
            };
            lines.push(format!("  {:<62} {range:>20}  {verdict}{limits}", reading.name));
        }
    }
    if !answer.statements.is_empty() {
        lines.push(
            "\"Consistent\" does not mean confirmed: the source does not state which reading applies."
                .to_owned(),
        );
    }
    lines.join("\n")
}

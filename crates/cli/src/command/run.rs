//! `armill run`: a study from file to report.
//!
//! Everything goes into `--out` (`out` beside the study): `--no-pictures` leaves pictures and report away, `--csv` adds tables.
//! Stdout holds the answer in words, or with `--json` all of `result.json`; warnings and progress go to stderr. `--strict`
//! exits with 1 unless every point holds its limit.

use armill_formats::file::ResultFolder;
use armill_study::answer::{StudyAnswer, answer};
use armill_study::output::{self, Csv, Opening, Pictures, Wanted};
use armill_study::run::{point_count, run as run_study};
use armill_study::studies::{self, FoundStudy};
use armill_study::{Study, StudyError};

use crate::Outcome;
use crate::arguments::{RunArguments, RunOptions};
use crate::listener;
use crate::progress::Progress;
use crate::terminal::{print, say};

/// Runs the study and writes all of its results.
///
/// # Errors
/// No study there, or its problems; a folder where nothing can be written, told before any work is done; a
/// fault while results are written.
pub(crate) fn run(arguments: &RunArguments) -> Result<Outcome, StudyError> {
    let found = studies::find(&arguments.run.study)?;
    let study = found.read()?;
    let out = folder(("run", "out"), &found, &arguments.run)?;
    results((&study, &out), (&arguments.run, None), summary)
}

/// The folder for the results of the command `by`: the one that the options name, or `name` in the folder of the study.
///
/// # Errors
/// A folder where nothing can be written, or where another run writes.
pub(super) fn folder(
    (by, name): (&'static str, &str),
    found: &FoundStudy,
    options: &RunOptions,
) -> Result<ResultFolder, StudyError> {
    let writer = options.writing.writer(by);
    Ok(match &options.out {
        Some(out) => writer.folder(out)?,
        None => writer.folder_in(&found.folder, name)?,
    })
}

/// Runs a study, writes all of its results into the folder `out`, with `opening` before the report, and says what came out,
/// in words those of `summary`.
///
/// # Errors
/// Files that may not be replaced, before any work is done; a fault while results are written.
pub(super) fn results(
    (study, out): (&Study, &ResultFolder),
    (options, opening): (&RunOptions, Option<&Opening>),
    summary: impl FnOnce(&StudyAnswer) -> String,
) -> Result<Outcome, StudyError> {
    let mut requested = Wanted {
        opening,
        ..Wanted::USUAL
    };
    if options.no_pictures {
        requested.pictures = Pictures::None;
    }
    if options.csv {
        requested.csv = Csv::Every;
    }
    output::allow(study, (out, requested))?;
    let answer = in_pool(options.threads, || work(study, (out, requested)))??;
    if options.json {
        print(output::json(&answer)?.trim_end())?;
    } else {
        print(&summary(&answer))?;
    }
    for warning in &answer.warnings {
        say(&format!("warning: {warning}"));
    }
    say(&format!("results in {}", out.path().display()));
    Ok(if options.strict && !answer.holds_everywhere() {
        Outcome::ToleranceNotHeld
    } else {
        Outcome::Fine
    })
}

/// Runs `work` on this many threads, or on as many as there are processors; the numbers are the same.
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

/// From the study to its answer and its files, under a bar.
fn work(study: &Study, (out, requested): (&ResultFolder, Wanted<'_>)) -> Result<StudyAnswer, StudyError> {
    let progress = Progress::new(point_count(study));
    let found = progress.watch(|watch| run_study(study, watch))?;
    let answer = answer(study, &found);
    output::write(study, &found, &answer, (out, requested), &|name| {
        progress.tell(name);
    })?;
    Ok(answer)
}

/// The answer as a person reads it: the sentence that answers, then each statement of a source beside the
/// readings that could be meant, each with the range of its in-plane deviation.
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
            "Consistent is not confirmed: the source leaves open what tells these readings apart.".to_owned(),
        );
    }
    lines.join("\n")
}

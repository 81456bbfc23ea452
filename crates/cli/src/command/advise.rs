//! `armill advise`: measures that bring a path within its tolerance.
//!
//! `--out` (`advice` next to the study) receives the results of the path with all recommended measures, as from
//! `armill run`, and before them `advice.json`; `advised` next to the study the study as advised, the path to command and the
//! table of the steps; `--program` a robot program of this path. Like `armill place` it continues an interrupted search. Stdout has the
//! advice as text.

use armill_plan::advise::{Advice, advise, progress_count};
use armill_plan::place::{Journal, PlacementSearch};
use armill_study::output::Opening;
use armill_study::program_out::{PathToWrite, program as write_program};
use armill_study::studies::FoundStudy;
use armill_study::{StudyError, output, studies};

use super::place::requested;
use super::program;
use super::run::{folder, in_pool, results};
use crate::arguments::AdviseArguments;
use crate::outcome::Outcome;
use crate::progress::Progress;
use crate::terminal::say;

/// Searches, optimizes the spin, compensates, and runs the recommended path.
///
/// # Errors
/// No such study, or its problems; no such path; empty bounds; a folder that cannot be written.
pub(crate) fn run(arguments: &AdviseArguments) -> Result<Outcome, StudyError> {
    let found = studies::find(&arguments.run.study)?;
    let study = found.read()?;
    let seed = u64::from(arguments.place.seed);
    let placing = PlacementSearch::new(&study, requested(&arguments.place)?, seed)?.brief_if_long();
    let requested_program = program::requested(&arguments.program, None)?;
    let out = folder("advise", "advice", &found, &arguments.run)?;
    let mut journal = Journal::kept_in(&out);
    let advice = in_pool(arguments.run.threads, || {
        let progress = Progress::of("steps", progress_count(&placing));
        progress.watch(|watch| {
            let note = |what: &str| progress.set_message(what);
            advise(&found, &placing, &mut journal, watch, &note)
        })
    })??;
    let json = serde_json::to_string_pretty(&advice.answer)? + "\n";
    out.write("advice.json", json.as_bytes())?;
    let drawn = if arguments.run.no_pictures {
        &[][..]
    } else {
        &advice.pictures
    };
    output::write_pictures(drawn, &out)?;
    let sentences = advice.answer.advice.join("\n");
    let opening = Opening {
        heading: "Recommended measures",
        sentences: advice.answer.advice.clone(),
        pictures: advice.pictures.clone(),
    };
    let outcome = results(&advice.study, &out, &arguments.run, Some(&opening), |_| sentences)?;
    advised(arguments, &found, &advice)?;
    if let Some((folder, requested)) = &requested_program {
        let files = &advice.files;
        let path = PathToWrite {
            setting: &files.setting,
            track: &files.path.0,
            answers: &files.path.1,
            top: files.top,
            spindle: files.spindle,
        };
        let written = write_program(&advice.study, path, requested)?;
        program::save(&arguments.run.writing.writer("advise"), folder, &written)?;
    }
    Ok(outcome)
}

/// Writes the study as advised, the path to command and the table of the steps: into `advised` next to the study, or in
/// the folder that `--out` gives.
fn advised(arguments: &AdviseArguments, found: &FoundStudy, advice: &Advice) -> Result<(), StudyError> {
    let writer = arguments.run.writing.writer("advise");
    let folder = match &arguments.run.out {
        Some(out) => writer.folder(&out.join("advised"))?,
        None => writer.folder_in(&found.folder, "advised")?,
    };
    let files = advice.files.files(folder.path())?;
    folder.allow(files.iter().map(|(name, _)| name.as_str()))?;
    for (name, bytes) in &files {
        folder.write(name, bytes)?;
    }
    folder.finish()?;
    for note in &advice.files.notes {
        say(&format!("note: {note}"));
    }
    say(&format!("as advised in {}", folder.path().display()));
    Ok(())
}

//! `armill compensate`: compensated paths, commanded so that the tool follows the nominal path.
//!
//! `--out` (`compensated` next to the study) receives one table and one picture per path; stdout one line each, before
//! and after. `--program` writes the path as a robot program, in the language of its extension.

use armill_core::optimize::Compensation;
use armill_plan::compensate::in_place::allow_programs;
use armill_plan::compensate::{Commanded, CompensationAnswer, Requested, compensate};
use armill_study::{StudyError, studies};

use super::program::{requested, save};
use crate::arguments::CompensateArguments;
use crate::outcome::Outcome;
use crate::progress::Progress;
use crate::terminal::{print, say};

/// Compensates and writes the results.
///
/// # Errors
/// No such study, or its problems; no such path; a folder that cannot be written.
pub(crate) fn run(arguments: &CompensateArguments) -> Result<Outcome, StudyError> {
    let found = studies::find(&arguments.study)?;
    let study = found.read()?;
    let requested = requested(&arguments.program, arguments.feed_mm_per_min)?;
    let writer = arguments.writing.writer("compensate");
    let folder = match &arguments.out {
        Some(out) => writer.folder(out)?,
        None => writer.folder_in(&found.folder, "compensated")?,
    };
    let out = folder.path().to_owned();
    allow_programs(&study, arguments.analysis.as_deref(), &folder)?;
    let progress = Progress::new(armill_plan::compensate::point_count(
        &study,
        arguments.analysis.as_deref(),
    ));
    let how = Requested {
        iteration: match arguments.nominal {
            true => Compensation::NONE,
            false => Compensation::USUAL,
        },
        normal_to_surface: arguments.surface,
    };
    let name = arguments.analysis.as_deref();
    let commanded = progress.watch(|watch| compensate(&study, name, how, watch))?;
    let files: Vec<(String, &[u8])> = commanded.iter().flat_map(Commanded::files).collect();
    folder.allow(files.iter().map(|(name, _)| name.as_str()))?;
    for (name, bytes) in files {
        folder.write(&name, bytes)?;
    }
    folder.finish()?;
    drop(folder);
    if let Some((folder, requested)) = &requested {
        let written = Commanded::only_program(&commanded, &study, requested)?;
        save(&writer, folder, &written)?;
    }
    let answer = CompensationAnswer::of(&study, &commanded);
    print(&if arguments.json {
        serde_json::to_string_pretty(&answer)?
    } else {
        answer.sentences().join("\n")
    })?;
    say(&format!("commanded paths in {}", out.display()));
    Ok(Outcome::Fine)
}

//! `armill advise`: what to do so that a path holds its tolerance.
//!
//! `--out` (`advice` beside the study) takes the results of the path with all that is advised, as `armill run` writes them, and
//! before them `advice.json`. Like `armill place` it goes on where it was stopped. Stdout has the advice in sentences.

use armill_study::advise::advise;
use armill_study::output::Opening;
use armill_study::place::{Journal, Placing};
use armill_study::{StudyError, output, studies};

use super::place::requested;
use super::run::{folder, in_pool, results};
use crate::Outcome;
use crate::arguments::AdviseArguments;
use crate::progress::Progress;

/// Searches, turns, compensates, and runs what is advised.
///
/// # Errors
/// No study there, or its problems; no such path; bounds that leave nothing; a folder where nothing can be written.
pub(crate) fn run(arguments: &AdviseArguments) -> Result<Outcome, StudyError> {
    let found = studies::find(&arguments.run.study)?;
    let study = found.read()?;
    let seed = u64::from(arguments.place.seed);
    let placing = Placing::new(&study, requested(&arguments.place)?, seed)?;
    let out = folder(("advise", "advice"), &found, &arguments.run)?;
    let mut journal = Journal::kept_in(&out);
    let advice = in_pool(arguments.run.threads, || {
        let progress = Progress::of("places", placing.place_count());
        progress.watch(|watch| {
            let given = |what: &str| progress.tell(what);
            advise((&found, &study), &placing, &mut journal, (watch, &given))
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
        heading: "What to do",
        sentences: advice.answer.advice.clone(),
        pictures: advice.pictures,
    };
    let options = (&arguments.run, Some(&opening));
    results((&advice.study, &out), options, |_| sentences)
}

//! `armill advise`: measures that bring a path within its tolerance.
//!
//! `--out` (`advice` next to the study) receives the results of the path with all recommended measures, as from
//! `armill run`, and before them `advice.json`. Like `armill place` it continues an interrupted search. Stdout has the
//! advice as text.

use armill_plan::advise::advise;
use armill_plan::place::{Journal, PlacementSearch};
use armill_study::output::Opening;
use armill_study::{StudyError, output, studies};

use super::place::requested;
use super::run::{folder, in_pool, results};
use crate::arguments::AdviseArguments;
use crate::outcome::Outcome;
use crate::progress::Progress;

/// Searches, optimizes the spin, compensates, and runs the recommended path.
///
/// # Errors
/// No such study, or its problems; no such path; empty bounds; a folder that cannot be written.
pub(crate) fn run(arguments: &AdviseArguments) -> Result<Outcome, StudyError> {
    let found = studies::find(&arguments.run.study)?;
    let study = found.read()?;
    let seed = u64::from(arguments.place.seed);
    let placing = PlacementSearch::new(&study, requested(&arguments.place)?, seed)?;
    let out = folder("advise", "advice", &found, &arguments.run)?;
    let mut journal = Journal::kept_in(&out);
    let advice = in_pool(arguments.run.threads, || {
        let progress = Progress::of("places", placing.place_count());
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
        pictures: advice.pictures,
    };
    results(&advice.study, &out, &arguments.run, Some(&opening), |_| sentences)
}

//! `armill place`: the placement of the part for the least deviation along a path.
//!
//! `--out` (`place` next to the study) receives the results of the path at the best placement, as from `armill run`,
//! and before them `placement.json` with the pictures of the search. During the search `place.rounds` there stores its
//! state: an interrupted search continues from it. Stdout has the placement as text, and the lines of a study for it.

use armill_plan::place::{Journal, PlacementSearch};
use armill_study::file::placement::PlaceTable;
use armill_study::{StudyError, output, studies};

use super::run::{folder, in_pool, results};
use crate::arguments::numbers::within;
use crate::arguments::{PlaceArguments, PlaceOptions};
use crate::outcome::Outcome;
use crate::progress::Progress;
use crate::terminal::say;

/// Searches, and runs the path at the best placement.
///
/// # Errors
/// No such study, or its problems; no such path; empty bounds; a folder that cannot be written.
pub(crate) fn run(arguments: &PlaceArguments) -> Result<Outcome, StudyError> {
    let found = studies::find(&arguments.run.study)?;
    let study = found.read()?;
    let placing = PlacementSearch::new(
        &study,
        requested(&arguments.place)?,
        u64::from(arguments.place.seed),
    )?;
    let out = folder("place", "place", &found, &arguments.run)?;
    let mut journal = Journal::kept_in(&out);
    let placed = in_pool(arguments.run.threads, || {
        let progress = Progress::of("places", placing.place_count());
        progress.watch(|watch| placing.search(&mut journal, watch, &|best| progress.set_message(best)))
    })??;
    if journal.taken() > 0 {
        say(&format!(
            "note: continued after {} completed rounds",
            journal.taken()
        ));
    }
    let json = serde_json::to_string_pretty(&placed.answer)? + "\n";
    out.write("placement.json", json.as_bytes())?;
    let drawn = if arguments.run.no_pictures {
        &[][..]
    } else {
        &placed.pictures
    };
    output::write_pictures(drawn, &out)?;
    let there = placed.study(&found)?;
    let opening = placed.opening();
    results(&there, &out, &arguments.run, Some(&opening), |_| {
        let lines = placed.answer.sentences().join("\n");
        format!("{lines}\n\n{}", placed.answer.study_lines())
            .trim_end()
            .to_owned()
    })
}

/// The settings given by the options.
pub(super) fn requested(options: &PlaceOptions) -> Result<PlaceTable, StudyError> {
    if let Some(margin) = options.margin_deg {
        within("--margin-deg", margin, [0.0, 90.0])?;
    }
    Ok(PlaceTable {
        analysis: options.analysis.clone(),
        x_mm: options.x_mm,
        y_mm: options.y_mm,
        z_mm: options.z_mm,
        heading_deg: options.heading_deg,
        tilt_deg: options.tilt_deg,
        roll_deg: options.roll_deg,
        spin_deg: options.spin_deg,
        rail_mm: options.rail_mm,
        fixture: Vec::new(),
        branch: options.branch.clone(),
        component: options.component.map(Into::into),
        objective: options.objective.map(Into::into),
        rank_by: options.rank_by.map(Into::into),
        margin_deg: options.margin_deg,
        least_wrist_deg: None,
    })
}

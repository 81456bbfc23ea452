//! Holes commanded so that they end at their nominal positions: each in its own posture.

use armill_core::kernel::BranchChoice;
use armill_core::optimize::{Compensation, compensated, hole_postures};
use armill_core::path::{LoadedTrack, Track};
use armill_core::units::to_um;
use armill_study::analysis::holes::HolesAnalysis;
use armill_study::analysis::holes::answer::is_refused;
use armill_study::analysis::runner::Runner;
use armill_study::error::StudyError;

use super::commanded::{CollisionsAnswer, Commanded, CompensatedPath, caution, position_columns};
use super::error_answer::ErrorAnswer;
use armill_formats::table::{Table, csv};

/// The commanded positions of these holes.
///
/// # Errors
/// An arm whose branches have no names; cancelled by the watch.
pub(super) fn of_holes<'a>(
    runner: &Runner<'_>,
    name: &str,
    holes: &'a HolesAnalysis,
    compensation: Compensation,
) -> Result<Commanded<'a>, StudyError> {
    let path = &holes.path;
    let question = runner.question(&path.setting);
    let loaded = LoadedTrack {
        track: &path.track,
        load: &path.load,
    };
    let found = hole_postures(
        &question,
        loaded,
        &holes.search,
        &path.setting.least_gain,
        runner.watch,
    )?;
    let track = Track {
        spins: Some(found.spins.clone()),
        ..path.track.clone()
    };
    let choice = |index: usize| {
        let evaluation = found.answers.points[index].as_ref().ok()?;
        evaluation
            .name
            .branch()
            .map(|branch| BranchChoice::Of(branch.into()))
    };
    let mut choices = Vec::with_capacity(track.len());
    for index in 0..track.len() {
        let is_reached = found.answers.points[index].is_ok();
        match choice(index) {
            Some(choice) => choices.push((index, choice)),
            None if is_reached => {
                return Err(StudyError::value(
                    format!(
                        "{name}: the postures of this robot have no names: its holes cannot be compensated"
                    ),
                    "compensate a path (kind = \"path\")",
                ));
            }
            None => choices.push((index, BranchChoice::Best)),
        }
    }
    let loaded = LoadedTrack {
        track: &track,
        load: &path.load,
    };
    let commanded = compensated(&question, loaded, &choices, compensation, runner.watch)?;
    let correction = |index: usize| {
        let moved = commanded.track.path.points[index].at - track.path.points[index].at;
        to_um(moved.norm())
    };
    let largest_correction_um = (0..track.len()).map(correction).fold(0.0, f64::max);
    let given = CompensatedPath {
        name: name.to_owned(),
        points: track.len(),
        before: ErrorAnswer::of(&track, &found.answers.deviations, found.answers.case_count),
        after: ErrorAnswer::of(&track, &commanded.residual, commanded.along.answers.case_count),
        largest_correction_um,
        rounds: commanded.rounds,
        last_round_um: to_um(commanded.last_move),
        contraction_ratio: commanded.contraction,
        unreachable: commanded.unmoved,
        collisions: CollisionsAnswer::of(&path.setting, &commanded.along.answers),
        outside_joint_limits: commanded
            .along
            .answers
            .evaluations()
            .filter(|(_, evaluation)| !evaluation.within_limits())
            .count(),
        file: format!("{}.commanded.csv", armill_study::file_names::slug(name)),
        in_place: None,
        surface: None,
        notes: caution(name, largest_correction_um).into_iter().collect(),
    };
    let table = Table::new(name, position_columns(&commanded.track))?;
    Ok(Commanded {
        setting: &path.setting,
        csv: csv::write(&table),
        to_measure: None,
        picture: None,
        path: (commanded.track, commanded.along.answers),
        top: holes.path.track.top(),
        spindle: None,
        holes: Some(holes),
        refused: (0..track.len())
            .filter(|index| is_refused(&found, *index))
            .collect(),
        given,
        program: Vec::new(),
    })
}

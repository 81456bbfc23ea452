//! What a cell contributes to a comparison: the result of each of its analyses, with its properties.

use armill_core::optimize::{Component, FollowedTrack, LeastGain, Objective, Sensitivity, sensitivity};
use armill_core::path::LoadedTrack;
use armill_core::watch::Watch;
use armill_study::analysis::AnalysisData;
use armill_study::analysis::path::PathAnalysis;
use armill_study::analysis::path::run::PathResult;
use armill_study::analysis::runner::Runner;
use armill_study::error::StudyError;
use armill_study::file::resolve::Study;
use armill_study::output::StudyResults;

use super::curve::Curve;
use super::numbers::AnalysisNumbers;
use super::traits;

/// Result of one cell for one name.
pub(super) struct Entry {
    pub cell: usize,
    pub requested: AnalysisNumbers,
    pub traits: Vec<(&'static str, String)>,
    pub curve: Option<Curve>,
    pub sensitivity: Option<Sensitivity>,
    /// The smallest gain that is significant.
    pub least: LeastGain,
}

impl Entry {
    /// The same with the name of an analysis at the best placement of its robot.
    pub(super) fn at_best_placement(mut self) -> Entry {
        self.requested.name = format!("{}, each robot at its best placement", self.requested.name);
        self
    }
}

/// The entries of one cell after its run.
///
/// # Errors
/// Cancelled by the watch.
pub(super) fn of_cell(
    cell: usize,
    results: StudyResults<'_>,
    watch: Watch<'_>,
) -> Result<Vec<Entry>, StudyError> {
    let StudyResults { study, done, answer } = results;
    let (mut maps, mut paths) = (answer.maps.iter(), answer.paths.iter());
    let (mut volumes, mut holes) = (answer.volumes.iter(), answer.holes.iter());
    let mut entries = Vec::new();
    let entry = |requested: AnalysisNumbers, traits: Vec<(&'static str, String)>, least: LeastGain| Entry {
        cell,
        requested,
        traits,
        curve: None,
        sensitivity: None,
        least,
    };
    for done in done {
        match &done.found {
            AnalysisData::Map(sheet, map) => {
                let requested = maps
                    .next()
                    .map(|given| AnalysisNumbers::map(given, sheet.setting.tolerance, &map.answers));
                let traits = traits::of_sheet(study, sheet);
                entries.extend(requested.map(|numbers| entry(numbers, traits, sheet.setting.least_gain)));
            }
            AnalysisData::Sections(sections) => {
                for section in sections {
                    let setting = &section.sheet.setting;
                    let requested = maps
                        .next()
                        .map(|given| AnalysisNumbers::map(given, setting.tolerance, &section.map.answers));
                    let traits = traits::of_sheet(study, section.sheet);
                    entries.extend(requested.map(|numbers| entry(numbers, traits, setting.least_gain)));
                }
            }
            AnalysisData::Volume(setting, volume) => {
                let requested = volumes
                    .next()
                    .map(|given| AnalysisNumbers::volume(given, setting.tolerance, &volume.answers));
                let traits = traits::of_volume(study, setting, volume);
                entries.extend(requested.map(|numbers| entry(numbers, traits, setting.least_gain)));
            }
            AnalysisData::Path(analysis, found) => {
                let Some(given) = paths.next() else { continue };
                let requested = AnalysisNumbers::path(given, analysis, &found.along.answers);
                let traits = traits::of_path(study, analysis);
                entries.push(Entry {
                    curve: Some(Curve::along(analysis, &found.along.answers)),
                    sensitivity: Some(of_path(study, analysis, found, watch)?),
                    ..entry(requested, traits, analysis.setting.least_gain)
                });
            }
            AnalysisData::Holes(analysis, found) => {
                let setting = &analysis.path.setting;
                let requested = holes
                    .next()
                    .map(|given| AnalysisNumbers::holes(given, setting.tolerance, found));
                let traits = traits::of_holes(study, analysis);
                entries.extend(requested.map(|numbers| entry(numbers, traits, setting.least_gain)));
            }
        }
    }
    Ok(entries)
}

/// The sensitivity of the largest in-plane deviation of a path.
fn of_path(
    study: &Study,
    analysis: &PathAnalysis,
    found: &PathResult,
    watch: Watch<'_>,
) -> Result<Sensitivity, StudyError> {
    let runner = Runner::new(&study.robot.robot, watch)?;
    let (load, _) = runner.pushed(analysis)?;
    let applied = found.searched.as_ref().filter(|searched| searched.applied);
    let turned = applied.map(|searched| searched.posture.turned(&analysis.track));
    let load = applied.map_or_else(|| load.clone(), |searched| searched.posture.load(&load));
    let followed = FollowedTrack {
        path: LoadedTrack {
            track: turned.as_ref().unwrap_or(&analysis.track),
            load: &load,
        },
        choices: &found.along.choices,
        home: None,
    };
    let measure = (Component::InPlane, Objective::Worst);
    Ok(sensitivity(
        &runner.question(&analysis.setting),
        &followed,
        measure,
        watch,
    )?)
}

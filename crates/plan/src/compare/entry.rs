//! What a cell contributes to a comparison: the result of each of its analyses, with its properties.

use armill_study::analysis::{AnalysisData, AnalysisResult};
use armill_study::answer::StudyAnswer;
use armill_study::file::resolve::Study;

use super::curve::Curve;
use super::numbers::AnalysisNumbers;
use super::traits;

/// Result of one cell for one name.
pub(super) struct Entry {
    pub cell: usize,
    pub requested: AnalysisNumbers,
    pub traits: Vec<(&'static str, String)>,
    pub curve: Option<Curve>,
}

/// The entries of one cell after its run.
pub(super) fn of_cell(
    cell: usize,
    study: &Study,
    done: &[AnalysisResult<'_>],
    answer: &StudyAnswer,
) -> Vec<Entry> {
    let (mut maps, mut paths) = (answer.maps.iter(), answer.paths.iter());
    let (mut volumes, mut holes) = (answer.volumes.iter(), answer.holes.iter());
    let mut entries = Vec::new();
    let mut add = |requested: Option<AnalysisNumbers>, traits: Vec<(&'static str, String)>, curve| {
        entries.extend(requested.map(|requested| Entry {
            cell,
            requested,
            traits,
            curve,
        }));
    };
    for done in done {
        match &done.found {
            AnalysisData::Map(sheet, map) => {
                let requested = maps
                    .next()
                    .map(|given| AnalysisNumbers::map(given, sheet.setting.tolerance, &map.answers));
                add(requested, traits::of_sheet(study, sheet), None);
            }
            AnalysisData::Sections(sections) => {
                for section in sections {
                    let limit = section.sheet.setting.tolerance;
                    let requested = maps
                        .next()
                        .map(|given| AnalysisNumbers::map(given, limit, &section.map.answers));
                    add(requested, traits::of_sheet(study, section.sheet), None);
                }
            }
            AnalysisData::Volume(setting, volume) => {
                let requested = volumes
                    .next()
                    .map(|given| AnalysisNumbers::volume(given, setting.tolerance, &volume.answers));
                add(requested, traits::of_volume(study, setting, volume), None);
            }
            AnalysisData::Path(analysis, found) => {
                let requested = paths
                    .next()
                    .map(|given| AnalysisNumbers::path(given, analysis, &found.along.answers));
                let curve = Curve::along(analysis, &found.along.answers);
                add(requested, traits::of_path(study, analysis), Some(curve));
            }
            AnalysisData::Holes(analysis, found) => {
                let requested = holes.next().map(|given| {
                    AnalysisNumbers::holes(given, analysis.path.setting.tolerance, &found.answers)
                });
                add(requested, traits::of_holes(study, analysis), None);
            }
        }
    }
    entries
}

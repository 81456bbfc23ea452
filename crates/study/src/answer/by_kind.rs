//! The answers to the analyses of a study, by kind.

use rayon::prelude::*;

use crate::analysis;
use crate::analysis::holes::answer::HolesAnswer;
use crate::analysis::map::answer::MapAnswer;
use crate::analysis::path::PathSource;
use crate::analysis::path::answer::{PathAnswer, PathVibration};
use crate::analysis::path::vibration::engagement;
use crate::analysis::sections::Section;
use crate::analysis::vibration::VibrationAnswer;
use crate::analysis::volume::answer::VolumeAnswer;
use crate::analysis::{AnalysisData, AnalysisResult};
use crate::file::resolve::Study;

/// The answer to one analysis.
enum AnswerKind {
    Maps(Vec<MapAnswer>),
    Path(Box<PathAnswer>),
    Volume(Box<VolumeAnswer>),
    Holes(Box<HolesAnswer>),
}

/// The answers to all analyses, by kind.
#[derive(Default)]
pub(super) struct AnalysisAnswers {
    pub maps: Vec<MapAnswer>,
    pub paths: Vec<PathAnswer>,
    pub volumes: Vec<VolumeAnswer>,
    pub holes: Vec<HolesAnswer>,
}

impl AnalysisAnswers {
    /// Those of `done`, in the order of its analyses on any number of threads.
    pub fn of(study: &Study, done: &[AnalysisResult<'_>]) -> AnalysisAnswers {
        let robot = &study.robot.robot;
        let given = |done: &AnalysisResult<'_>| match &done.found {
            AnalysisData::Map(sheet, map) => AnswerKind::Maps(vec![analysis::map::answer::answer(
                robot,
                done.name,
                &sheet.setting,
                map,
                vibration(done, 0),
            )]),
            AnalysisData::Sections(sections) => {
                let section = |(index, section): (usize, &Section<'_>)| {
                    let name = format!("{}: {}", done.name, section.label);
                    let (setting, vibration) = (&section.sheet.setting, vibration(done, index));
                    analysis::map::answer::answer(robot, &name, setting, &section.map, vibration)
                };
                AnswerKind::Maps(sections.par_iter().enumerate().map(section).collect())
            }
            AnalysisData::Volume(setting, volume) => AnswerKind::Volume(Box::new(
                analysis::volume::answer::answer(robot, done.name, setting, volume, vibration(done, 0)),
            )),
            AnalysisData::Path(analysis, found) => {
                let vibration = PathVibration {
                    series: done.vibration.first(),
                    answer: vibration(done, 0),
                };
                let given = analysis::path::answer::answer(robot, done.name, analysis, found, vibration);
                AnswerKind::Path(Box::new(given))
            }
            AnalysisData::Holes(analysis, found) => AnswerKind::Holes(Box::new(
                analysis::holes::answer::answer(robot, done.name, analysis, found),
            )),
        };
        let all: Vec<AnswerKind> = done.par_iter().map(given).collect();
        let mut answers = AnalysisAnswers::default();
        for given in all {
            match given {
                AnswerKind::Maps(given) => answers.maps.extend(given),
                AnswerKind::Path(given) => answers.paths.push(*given),
                AnswerKind::Volume(given) => answers.volumes.push(*given),
                AnswerKind::Holes(given) => answers.holes.push(*given),
            }
        }
        answers
    }
}

/// The summary of the vibration of one series of a result.
fn vibration(done: &AnalysisResult<'_>, series: usize) -> Option<VibrationAnswer> {
    done.vibration.get(series)?;
    let rows = done.rows();
    match &done.found {
        AnalysisData::Path(path, _) => {
            let is_program = matches!(path.source, PathSource::Program { .. });
            let line = |index: usize| is_program.then(|| path.track.path.points[index].line);
            VibrationAnswer::of(rows.get(series)?, engagement(path), &line)
        }
        _ => VibrationAnswer::of(rows.get(series)?, "cut", &|_| None),
    }
}

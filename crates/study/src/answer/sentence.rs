//! The answer in one sentence, with its main numbers.
//!
//! ```text
//! NAME, branch BRANCH: 63.2 % of the plane is within 60 µm; the in-plane deviation ranges from 21 to 84 µm (u = 9 µm)
//! and is largest at (900, -200, 800) mm; largest contribution: joint A2 (41 %).
//! ```
//!
//! `u` is the standard uncertainty. If no point is reached, the sentence states that instead.

use crate::analysis;
use crate::analysis::Subject;
use crate::answer::by_kind::AnalysisAnswers;
use crate::file::resolve::Study;

/// The sentence of the first analysis.
pub(super) fn answer(study: &Study, answers: &AnalysisAnswers) -> String {
    let robot = &study.robot.robot;
    let first = study
        .analyses
        .first()
        .and_then(|analysis| match analysis.subject {
            Subject::Map(_) | Subject::Sections(_) => answers
                .maps
                .first()
                .map(|map| analysis::map::sentence::sentence(robot, map)),
            Subject::Volume(..) => answers
                .volumes
                .first()
                .map(|volume| analysis::volume::sentence::sentence(robot, volume)),
            Subject::Path(_) => answers
                .paths
                .first()
                .map(|path| analysis::path::sentence::sentence(robot, path)),
            Subject::Holes(_) => answers
                .holes
                .first()
                .map(|set| analysis::holes::sentence::sentence(robot, set)),
        });
    let sentence = first.unwrap_or_else(|| "The study has no analysis.".to_owned());
    if study.compliance_is_assumed() {
        sentence + " The joint compliances are assumed, not measured."
    } else {
        sentence
    }
}

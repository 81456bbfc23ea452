//! The result of a search, and the study with its path there.

use armill_core::nalgebra::UnitQuaternion;
use armill_study::analysis::Subject;
use armill_study::error::StudyError;
use armill_study::file::resolve::Study;
use armill_study::live::ChangedValue;
use armill_study::output::{Opening, Picture};
use armill_study::studies::FoundStudy;
use serde_json::Value as Json;

use super::answer::PlacementAnswer;
use crate::study_text::{StudyText, toml_of};

/// Result of a search.
pub struct PlacementResult {
    /// In numbers.
    pub answer: PlacementAnswer,
    /// Front and sections.
    pub pictures: Vec<Picture>,
    /// Index of the analysis.
    pub(super) analysis: usize,
    /// Whether it is a set of holes, whose spins are searched for each hole.
    pub(super) is_of_holes: bool,
    /// The tool on the part at each point, if it turns with it though the study does not say so.
    pub(super) with_part: Option<Vec<UnitQuaternion<f64>>>,
}

impl PlacementResult {
    /// The first section of a report about the path there.
    pub fn opening(&self) -> Opening {
        Opening {
            heading: "Placement",
            sentences: self.answer.sentences(),
            pictures: self.pictures.clone(),
        }
    }

    /// The study with only its path, placed there with the spin of the tool of the search where that is an improvement.
    ///
    /// # Errors
    /// Every problem of the file, which may have changed since it was read.
    pub fn study(&self, found: &FoundStudy) -> Result<Study, StudyError> {
        self.with_tool(self.placed(found)?.read()?)
    }

    /// The study file with its path placed there where that is an improvement.
    ///
    /// # Errors
    /// A file that is not TOML.
    pub fn placed(&self, found: &FoundStudy) -> Result<FoundStudy, StudyError> {
        let mut text = StudyText::of(found)?;
        if self.answer.is_improvement {
            for change in self.changes_of(&mut text) {
                let keys: Vec<&str> = change.key.split('.').collect();
                text.set(self.analysis, &keys, toml_of(&change.value));
            }
        }
        Ok(text.in_place_of(found))
    }

    /// A study that was read from [`PlacementResult::placed`], with its path only and with the spin of the tool where it
    /// turns with the part.
    pub(crate) fn with_tool(&self, mut study: Study) -> Result<Study, StudyError> {
        study
            .analyses
            .retain(|analysis| analysis.name == self.answer.analysis);
        study.statements.clear();
        for analysis in &mut study.analyses {
            let path = match &mut analysis.subject {
                Subject::Path(path) => path,
                Subject::Holes(holes) => &mut holes.path,
                _ => continue,
            };
            let with_part = self.with_part.as_ref();
            if let Some(part_from_tools) = with_part.filter(|_| self.answer.is_improvement) {
                let track = &path.track;
                let spins = part_from_tools.iter().enumerate().map(|(index, on_part)| {
                    let evaluated = track.base_from_part.rotation * on_part;
                    let turn = track.stop(index).base_from_tool.rotation.inverse() * evaluated;
                    let had = track.spins.as_ref().map_or(0.0, |spins| spins[index]);
                    had + 2.0 * turn.k.atan2(turn.w)
                });
                path.track.spins = Some(spins.collect());
            }
        }
        Ok(study)
    }

    /// Index of the path among the analyses of the study.
    pub(crate) fn analysis(&self) -> usize {
        self.analysis
    }

    /// Whether the tool turns with the part though the study does not say so, which its file cannot express.
    pub(crate) fn has_own_spins(&self) -> bool {
        self.with_part.is_some()
    }

    /// The placement as changes of the path in the study file.
    ///
    /// # Errors
    /// A file that is not TOML.
    pub fn changes(&self, found: &FoundStudy) -> Result<Vec<ChangedValue>, StudyError> {
        Ok(self.changes_of(&mut StudyText::of(found)?))
    }

    fn changes_of(&self, text: &mut StudyText) -> Vec<ChangedValue> {
        let (place, index) = (&self.answer.place, self.analysis);
        let change = |key: &str, value: Json| ChangedValue {
            key: key.to_owned(),
            value,
            whole: false,
        };
        let mut all = vec![
            change("plane.centre_mm", place.centre_mm.to_vec().into()),
            change("plane.tilt_deg", place.tilt_deg.into()),
            change("plane.rotation_deg", place.rotation_deg.map(Vec::from).into()),
        ];
        let branch = self.answer.recommended.branch.as_ref();
        all.extend(branch.map(|branch| change("posture.branch", branch.as_str().into())));
        let home = self.answer.home_deg.as_ref();
        all.extend(home.map(|home| change("posture.home_deg", home.clone().into())));
        let keys: &[&str] = match () {
            () if self.is_of_holes => return all,
            () if text.has(index, &["program"]) => &["program", "spin_deg"],
            () => &["spin_deg"],
        };
        let sum = text.number(index, keys).unwrap_or(0.0) + place.spin_deg;
        if sum != 0.0 || text.has(index, keys) {
            let turn = sum - 360.0 * (sum / 360.0).round();
            all.push(change(&keys.join("."), turn.into()));
        }
        all
    }
}

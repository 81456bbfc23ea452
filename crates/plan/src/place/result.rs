//! The result of a search, and the study with its path there.

use armill_core::nalgebra::UnitQuaternion;
use armill_study::analysis::Subject;
use armill_study::error::StudyError;
use armill_study::file::resolve::Study;
use armill_study::output::{Opening, Picture};
use armill_study::studies::FoundStudy;
use toml_edit::Value;

use super::answer::PlacementAnswer;
use crate::study_text::{StudyText, numbers};

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
            self.place_path(&mut text);
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

    /// Changes the placement of the path in the study file.
    fn place_path(&self, text: &mut StudyText) {
        let (place, index) = (&self.answer.place, self.analysis);
        text.set(index, &["plane", "centre_mm"], Some(numbers(&place.centre_mm)));
        text.set(index, &["plane", "tilt_deg"], place.tilt_deg.map(Value::from));
        let rotation = place.rotation_deg.map(|rotation| numbers(&rotation));
        text.set(index, &["plane", "rotation_deg"], rotation);
        if let Some(branch) = &self.answer.recommended.branch {
            text.set(index, &["posture", "branch"], Some(branch.as_str().into()));
        }
        if let Some(home) = &self.answer.home_deg {
            text.set(index, &["posture", "home_deg"], Some(numbers(home)));
        }
        let keys: &[&str] = match () {
            () if self.is_of_holes => return,
            () if text.has(index, &["program"]) => &["program", "spin_deg"],
            () => &["spin_deg"],
        };
        let sum = text.number(index, keys).unwrap_or(0.0) + place.spin_deg;
        if sum != 0.0 || text.has(index, keys) {
            text.set(index, keys, Some((sum - 360.0 * (sum / 360.0).round()).into()));
        }
    }
}

//! The result of a search, and the study with its path there.

use armill_core::nalgebra::UnitQuaternion;
use armill_study::analysis::Subject;
use armill_study::analysis::table::AnalysisKind;
use armill_study::error::StudyError;
use armill_study::file::format::StudyFile;
use armill_study::file::resolve::Study;
use armill_study::input::tables::{PlaneChange, PostureTable};
use armill_study::output::{Opening, Picture};
use armill_study::studies::FoundStudy;

use super::answer::PlacementAnswer;

/// Result of a search.
pub struct PlacementResult {
    /// In numbers.
    pub answer: PlacementAnswer,
    /// Front and sections.
    pub pictures: Vec<Picture>,
    /// Index of the analysis.
    pub(super) analysis: usize,
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
        self.study_read(|place| found.read_changed(|file| place(file)))
    }

    /// The same, where `read` reads the study after the given change of its file.
    ///
    /// # Errors
    /// Those of `read`.
    pub fn study_read(
        &self,
        read: impl FnOnce(&mut dyn FnMut(&mut StudyFile)) -> Result<Study, StudyError>,
    ) -> Result<Study, StudyError> {
        let moves = self.answer.is_improvement;
        let mut study = read(&mut |file| {
            if moves {
                self.place_path(file);
            }
        })?;
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
            if let Some(part_from_tools) = self.with_part.as_ref().filter(|_| moves) {
                let track = &path.track;
                let spins = part_from_tools.iter().enumerate().map(|(index, on_part)| {
                    let evaluated = track.base_from_part.rotation * on_part;
                    let turn = track.stop(index).base_from_tool.rotation.inverse() * evaluated;
                    2.0 * turn.k.atan2(turn.w)
                });
                path.track.spins = Some(spins.collect());
            }
        }
        Ok(study)
    }

    /// Changes the placement of the path in the study file.
    fn place_path(&self, file: &mut StudyFile) {
        let place = &self.answer.place;
        let Some(analysis) = file.analysis.get_mut(self.analysis) else {
            return;
        };
        analysis.plane = Some(PlaneChange {
            centre_mm: Some(place.centre_mm),
            tilt_deg: place.tilt_deg,
            rotation_deg: place.rotation_deg,
            ..analysis.plane.take().unwrap_or_default()
        });
        let whole = file.posture.as_ref();
        let own = analysis.posture.as_ref();
        analysis.posture = Some(PostureTable {
            branch: self.answer.recommended.branch.clone().or_else(|| {
                let own = own.and_then(|posture| posture.branch.clone());
                own.or_else(|| whole.and_then(|posture| posture.branch.clone()))
            }),
            home_deg: self
                .answer
                .home_deg
                .clone()
                .or_else(|| own.and_then(|posture| posture.home_deg.clone())),
            search: own.and_then(|posture| posture.search.clone()),
        });
        let more = |spin: Option<f64>| {
            let sum = spin.unwrap_or(0.0) + place.spin_deg;
            Some(sum - 360.0 * (sum / 360.0).round())
        };
        match &mut analysis.program {
            _ if analysis.kind == AnalysisKind::Holes => (),
            Some(program) => program.spin_deg = more(program.spin_deg),
            None => analysis.spin_deg = more(analysis.spin_deg),
        }
    }
}

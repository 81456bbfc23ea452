//! What a pose is asked of: a robot, or the arm of a study in its cell.

use std::path::Path;

use armill_core::frame::Isometry;
use armill_formats::robot::RobotDescription;
use armill_study::input::quantities::pose_mm_deg;
use armill_study::pose::{PoseAnswer, PoseQuestion, answer, answer_in_study, first_setting};
use armill_study::{BASE_LINK, Study, StudyError, robots, studies};

use crate::arguments::PoseArguments;
use crate::arguments::numbers::three_or_six;

/// A robot, or a study.
pub(super) enum PoseSubject {
    /// A robot alone.
    Robot(Box<RobotDescription>),
    /// The arm of a study, with its tool, its stiffness model and the bodies of its cell.
    Study(Box<Study>),
}

impl PoseSubject {
    /// What the arguments name.
    ///
    /// # Errors
    /// Neither a robot nor a study; problems of its file; an option that the study replaces.
    pub fn find(arguments: &PoseArguments) -> Result<PoseSubject, StudyError> {
        let given = Path::new(&arguments.robot);
        if !studies::is_study(given) {
            return Ok(PoseSubject::Robot(Box::new(robots::find(
                &arguments.robot,
                ".".as_ref(),
            )?)));
        }
        let replaced = [
            ("--load-dependent", arguments.load_dependent, "load_dependent"),
            (
                "--reference-joints-deg",
                arguments.reference_joints_deg.is_some(),
                "[gravity]",
            ),
        ];
        if let Some((option, _, key)) = replaced.into_iter().find(|(_, given, _)| *given) {
            let message = format!("{option} with the study {}", arguments.robot);
            return Err(StudyError::value(
                message,
                format!("`{key}` of the study gives it"),
            ));
        }
        Ok(PoseSubject::Study(Box::new(studies::find(given)?.read()?)))
    }

    /// The robot.
    pub fn robot(&mut self) -> &mut RobotDescription {
        match self {
            PoseSubject::Robot(robot) => robot,
            PoseSubject::Study(study) => &mut study.robot,
        }
    }

    /// Flange to TCP: of the arguments, else of the study, else none.
    ///
    /// # Errors
    /// A wrong count of numbers; a study without analyses.
    pub fn flange_from_tool(&self, arguments: &PoseArguments) -> Result<Isometry, StudyError> {
        match (self, &arguments.tool_mm) {
            (PoseSubject::Study(study), None) => Ok(first_setting(study)?.flange_from_tool),
            (_, given) => Ok(pose_mm_deg(&three_or_six("--tool-mm", given.as_deref())?)),
        }
    }

    /// The frame that positions count from: of the arguments, else of the study, else `base_link`.
    ///
    /// # Errors
    /// A study without analyses.
    pub fn base(&self, arguments: &PoseArguments) -> Result<String, StudyError> {
        match (self, &arguments.base) {
            (_, Some(base)) => Ok(base.clone()),
            (PoseSubject::Study(study), None) => Ok(first_setting(study)?.base_name.clone()),
            (PoseSubject::Robot(_), None) => Ok(BASE_LINK.to_owned()),
        }
    }

    /// The answer.
    ///
    /// # Errors
    /// A wrong number of joints, an unknown frame.
    pub fn answer(&self, question: &PoseQuestion) -> Result<PoseAnswer, StudyError> {
        match self {
            PoseSubject::Robot(robot) => answer(robot, question),
            PoseSubject::Study(study) => answer_in_study(study, question),
        }
    }
}

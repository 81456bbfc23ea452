//! What a pose is asked of: a robot, or the arm of a study in its cell.

use std::path::Path;

use armill_core::frame::Isometry;
use armill_core::robot::{JointCompliance, RobotError};
use armill_formats::robot::RobotDescription;
use armill_study::input::quantities::pose_mm_deg;
use armill_study::modes::{ModesAnswer, ModesQuestion};
use armill_study::pose::{PoseAnswer, PoseQuestion, answer, answer_in_study, first_setting};
use armill_study::{BASE_LINK, ComplianceClass, Study, StudyError, robots, studies};

use crate::arguments::PoseArguments;
use crate::arguments::numbers::{finite, three_or_six};

/// A robot, or a study.
pub(super) enum PoseSubject {
    /// A robot alone.
    Robot(Box<RobotDescription>),
    /// The arm of a study, with its tool, its stiffness model and the bodies of its cell.
    Study(Box<Study>),
}

impl PoseSubject {
    /// What this name stands for.
    ///
    /// # Errors
    /// Neither a robot nor a study; problems of its file.
    pub fn named(name: &str) -> Result<PoseSubject, StudyError> {
        let given = Path::new(name);
        if studies::is_study(given) {
            return Ok(PoseSubject::Study(Box::new(studies::find(given)?.read()?)));
        }
        Ok(PoseSubject::Robot(Box::new(robots::find(name, ".".as_ref())?)))
    }

    /// What the arguments name.
    ///
    /// # Errors
    /// As of [`PoseSubject::named`]; an option that the study replaces.
    pub fn find(arguments: &PoseArguments) -> Result<PoseSubject, StudyError> {
        let replaced = [
            ("--load-dependent", arguments.load_dependent, "load_dependent"),
            (
                "--reference-joints-deg",
                arguments.reference_joints_deg.is_some(),
                "[gravity]",
            ),
        ];
        if studies::is_study(Path::new(&arguments.robot))
            && let Some((option, _, key)) = replaced.into_iter().find(|(_, given, _)| *given)
        {
            let message = format!("{option} with the study {}", arguments.robot);
            return Err(StudyError::value(
                message,
                format!("`{key}` of the study gives it"),
            ));
        }
        PoseSubject::named(&arguments.robot)
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
    pub fn flange_from_tool(&self, tool_mm: Option<&[f64]>) -> Result<Isometry, StudyError> {
        match (self, tool_mm) {
            (PoseSubject::Study(study), None) => Ok(first_setting(study)?.flange_from_tool),
            (_, given) => Ok(pose_mm_deg(&three_or_six("--tool-mm", given)?)),
        }
    }

    /// The frame that positions count from: of the arguments, else of the study, else `base_link`.
    ///
    /// # Errors
    /// A study without analyses.
    pub fn base(&self, base: Option<&str>) -> Result<String, StudyError> {
        match (self, base) {
            (_, Some(base)) => Ok(base.to_owned()),
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

    /// The modes of vibration.
    ///
    /// # Errors
    /// As of [`armill_study::modes::answer`].
    pub fn modes(&self, question: &ModesQuestion) -> Result<ModesAnswer, StudyError> {
        match self {
            PoseSubject::Robot(robot) => armill_study::modes::answer(robot, question),
            PoseSubject::Study(study) => armill_study::modes::answer_in_study(study, question),
        }
    }
}

/// Puts given compliances (`--compliance-rad-per-n-m`, without uncertainty) or those of a class (`--compliance-class`) into the robot;
/// returns a caution for the latter. Without either the robot keeps its own.
pub(super) fn with_compliances(
    given: Option<&[f64]>,
    class: Option<&str>,
    found: &mut RobotDescription,
) -> Result<Option<String>, StudyError> {
    let Some(name) = class else {
        if let Some(values) = given {
            finite("--compliance-rad-per-n-m", values)?;
            let given = values.iter().map(|value| JointCompliance {
                value: *value,
                standard_uncertainty: 0.0,
            });
            let refused = |error| {
                let message = format!("--compliance-rad-per-n-m: {error}");
                StudyError::value(message, "one per joint, 0 or more")
            };
            let robot = found.robot.clone().with_other_compliance(given.collect());
            found.robot = robot.map_err(|error: RobotError| refused(error))?;
        }
        return Ok(None);
    };
    let class = ComplianceClass::named(name)?;
    let assumed = class.compliance_of(&found.robot)?;
    let robot = found.robot.clone().with_other_compliance(assumed);
    found.robot = robot.map_err(|error| StudyError::value(error.to_string(), ""))?;
    class.caution(&found.robot).map(Some)
}

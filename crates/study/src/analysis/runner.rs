//! The arm of a study as the core asks for it, and the watch of the run.

use armill_core::kernel::Question;
use armill_core::robot::{JointCompliance, Robot};
use armill_core::source::Arm;
use armill_core::watch::Watch;

use crate::error::StudyError;
use crate::input::cell::AnalysisCell;
use crate::input::setting::Setting;

/// The robot of the study, and the watch.
pub struct Runner<'a> {
    /// The arm.
    pub robot: &'a Robot,
    compliance: &'a [JointCompliance],
    /// Receives the progress.
    pub watch: Watch<'a>,
}

impl<'a> Runner<'a> {
    /// Runs analyses with this robot.
    ///
    /// # Errors
    /// A robot without compliance.
    pub fn new(robot: &'a Robot, watch: Watch<'a>) -> Result<Runner<'a>, StudyError> {
        let compliance = robot.compliance().ok_or_else(|| {
            let message = format!("robot `{}` has no joint compliance", robot.name());
            StudyError::value(message, "see `armill check`")
        })?;
        Ok(Runner {
            robot,
            compliance,
            watch,
        })
    }

    /// The question for the core under this setting.
    pub fn question<'q>(&'q self, setting: &'q Setting) -> Question<'q> {
        Question {
            arm: Arm {
                robot: self.robot,
                compliance: self.compliance,
                model: &setting.model,
                flange_from_tool: &setting.flange_from_tool,
            },
            home: setting.home.as_deref(),
            homes: None,
            cases: &setting.cases,
            uncertainty: setting.uncertainty,
            normal: setting.plane.normal(),
            choice: setting.choice,
            clearance: setting.cell.as_ref().map(AnalysisCell::demanded),
        }
    }
}

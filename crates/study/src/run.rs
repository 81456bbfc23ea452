//! Runs a study: every ask through the core.

use armill_core::kernel::Question;
use armill_core::map::{
    PathAnswer, PlaneMap, ProgramAnswer, VolumeMap, along_path, along_program, plane_map, volume_map,
};
use armill_core::robot::{JointCompliance, Robot};
use armill_core::watch::Watch;

use crate::error::StudyError;
use crate::file::resolve::{Ask, Setting, Sheet, Study, Subject};

/// What came out of one ask.
#[derive(Clone, Debug)]
pub enum Found {
    /// One plane.
    Map(PlaneMap),
    /// Several planes, in the order asked.
    Sections(Vec<PlaneMap>),
    /// A box of points.
    Volume(VolumeMap),
    /// A path.
    Path(PathAnswer),
    /// A tool path program.
    Program(Box<ProgramAnswer>),
}

/// How many points the study asks for.
pub fn point_count(study: &Study) -> usize {
    let of = |ask: &Ask| match &ask.subject {
        Subject::Map(sheet) => sheet.grid.len(),
        Subject::Sections(sections) => sections.iter().map(|(_, sheet)| sheet.grid.len()).sum(),
        Subject::Volume(_, grid) => grid.len(),
        Subject::Path(_, shape, step) => (shape.length() / step).ceil() as usize,
        Subject::Program(program) => program.track.points.len(),
    };
    study.asks.iter().map(of).sum()
}

/// The answers to all asks of the study, in its order, on the threads of the current rayon pool.
///
/// # Errors
/// Cancelled by the watch; a robot without compliance.
pub fn run(study: &Study, watch: Watch<'_>) -> Result<Vec<Found>, StudyError> {
    let robot = &study.robot.robot;
    let compliance = robot.compliance().ok_or_else(|| {
        let message = format!("robot `{}` has no joint compliance", robot.name());
        StudyError::value(message, "see `armill check`")
    })?;
    let runner = Runner {
        robot,
        compliance,
        watch,
    };
    study.asks.iter().map(|ask| runner.find(ask)).collect()
}

struct Runner<'a> {
    robot: &'a Robot,
    compliance: &'a [JointCompliance],
    watch: Watch<'a>,
}

impl Runner<'_> {
    fn find(&self, ask: &Ask) -> Result<Found, StudyError> {
        Ok(match &ask.subject {
            Subject::Map(sheet) => Found::Map(self.map(sheet)?),
            Subject::Sections(sections) => Found::Sections(
                sections
                    .iter()
                    .map(|(_, sheet)| self.map(sheet))
                    .collect::<Result<_, _>>()?,
            ),
            Subject::Volume(setting, grid) => Found::Volume(volume_map(
                &self.question(setting),
                setting.plane,
                *grid,
                self.watch,
            )?),
            Subject::Path(setting, shape, step) => Found::Path(along_path(
                &self.question(setting),
                setting.plane,
                shape,
                *step,
                self.watch,
            )?),
            Subject::Program(program) => Found::Program(Box::new(along_program(
                &self.question(&program.setting),
                &program.track,
                self.watch,
            )?)),
        })
    }

    fn map(&self, sheet: &Sheet) -> Result<PlaneMap, StudyError> {
        let question = self.question(&sheet.setting);
        Ok(plane_map(&question, sheet.setting.plane, sheet.grid, self.watch)?)
    }

    fn question<'q>(&'q self, setting: &'q Setting) -> Question<'q> {
        question(self.robot, self.compliance, setting)
    }
}

/// What is asked of every point of this setting.
pub(crate) fn question<'q>(
    robot: &'q Robot,
    compliance: &'q [JointCompliance],
    setting: &'q Setting,
) -> Question<'q> {
    Question {
        robot,
        compliance,
        model: &setting.model,
        flange_from_tool: &setting.flange_from_tool,
        home: setting.home.as_deref(),
        cases: &setting.cases,
        doubt: setting.doubt,
        normal: setting.plane.normal(),
        choice: setting.choice,
    }
}

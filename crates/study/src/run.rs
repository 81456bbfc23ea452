//! Runs a study: every ask through the core.

use armill_core::kernel::Question;
use armill_core::load::PathLoad;
use armill_core::map::{
    PathAnswer, PlaneMap, ProgramAnswer, ProgramLimits, VolumeMap, along_path, along_program, plane_map,
    program_limits, volume_map,
};
use armill_core::nalgebra::Point3;
use armill_core::path::{ForcesTold, NoForces, Stock};
use armill_core::robot::{JointCompliance, Robot};
use armill_core::source::Arm;
use armill_core::watch::{Cancelled, Watch};

use crate::error::StudyError;
use crate::file::program::ProgramAsk;
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
    Program(Box<ProgramFound>),
}

/// What came out along a program.
#[derive(Clone, Debug)]
pub struct ProgramFound {
    /// Its deviation.
    pub answer: ProgramAnswer,
    /// What is worth telling of its forces, where a cut makes them.
    pub forces: Option<ForcesTold>,
    /// What keeps the tolerance, where that was asked and can be told.
    pub limits: Option<ProgramLimits>,
}

/// How many points the study asks for.
pub fn point_count(study: &Study) -> usize {
    let of = |ask: &Ask| match &ask.subject {
        Subject::Map(sheet) => sheet.grid.len(),
        Subject::Sections(sections) => sections.iter().map(|(_, sheet)| sheet.grid.len()).sum(),
        Subject::Volume(_, grid) => grid.len(),
        Subject::Path(_, shape, step) => (shape.length() / step).ceil() as usize,
        // A stock is cut in a pass of its own.
        Subject::Program(program) => program.track.points.len() * if program.has_stock() { 2 } else { 1 },
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

const BESIDE_STOCK: &str = "is the stock where the program cuts?";

/// A program that misses its stock would hold any tolerance.
fn nothing_cut(ask: &ProgramAsk, stock: &Stock) -> StudyError {
    let mm = |corners: [Point3<f64>; 2]| {
        let [low, high] =
            corners.map(|at| format!("({:.1}, {:.1}, {:.1})", at.x * 1e3, at.y * 1e3, at.z * 1e3));
        format!("{low} to {high} mm")
    };
    let message = format!(
        "{}: the program cuts nothing of its stock: the cuts go from {}, the stock from {}",
        ask.file,
        mm(ask.track.corners()),
        mm(stock.corners())
    );
    StudyError::value(message, BESIDE_STOCK)
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
            Subject::Program(program) => Found::Program(Box::new(self.program(program)?)),
        })
    }

    fn program(&self, ask: &ProgramAsk) -> Result<ProgramFound, StudyError> {
        let (load, forces) = match &ask.cut {
            Some(cut) if let Some(stock) = &cut.stock => {
                let (points, placing) = (&ask.track.points, &ask.track.placing);
                let mut stock = stock.clone();
                let found =
                    cut.cutting
                        .along((points, &ask.operations), placing, Some(&mut stock), self.watch);
                let found = found.map_err(|error| match error {
                    NoForces::Cancelled => StudyError::Cancelled(Cancelled),
                    error => StudyError::value(format!("{}: {error}", ask.file), BESIDE_STOCK),
                })?;
                if found.cuts.points.iter().all(|here| here.cut.is_none()) {
                    return Err(nothing_cut(ask, &stock));
                }
                (PathLoad::Cuts(found.cuts), Some(found.told))
            }
            _ => (ask.load.clone(), ask.forces),
        };
        let question = self.question(&ask.setting);
        let answer = along_program(&question, &ask.track, load, self.watch)?;
        let question = Question {
            choice: answer.choice,
            ..question
        };
        let limits = match ask.tells_limits() {
            true => program_limits(&question, &ask.track, &answer, ask.setting.limit, self.watch)?,
            false => None,
        };
        Ok(ProgramFound {
            answer,
            forces,
            limits,
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
        arm: Arm {
            robot,
            compliance,
            model: &setting.model,
            flange_from_tool: &setting.flange_from_tool,
        },
        home: setting.home.as_deref(),
        cases: &setting.cases,
        doubt: setting.doubt,
        normal: setting.plane.normal(),
        choice: setting.choice,
    }
}

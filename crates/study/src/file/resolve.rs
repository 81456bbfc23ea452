//! From the study file to resolved analyses: in SI, in the robot's base, checked.
//!
//! The whole file is checked before it is refused: a wrong value of one analysis does not hide those of the next, and a
//! value of the study that several analyses use is reported once.

use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

use armill_formats::controller::ControllerTable;
use armill_formats::document::{Document, Problem, Problems};
use armill_formats::input::Inputs;
use armill_formats::robot::RobotDescription;

use super::memory;
use crate::analysis::holes::HolesAnalysis;
use crate::analysis::path::PathAnalysis;
use crate::analysis::resolve::Resolver;
use crate::analysis::study_tables::StudyTables;
use crate::analysis::table::AnalysisTable;
use crate::analysis::{Analysis, Subject};
use crate::error::StudyError;
use crate::file::calibrated::find_calibrated;
use crate::file::circles::MeasuredCircle;
use crate::file::compliance::OwnCompliance;
use crate::file::experiment::Experiment;
use crate::file::format::{StatementTable, StudyFile};
use crate::file::names::{check_statements, name_of, unfit_names};
use crate::file::placement::PlaceTable;
use crate::file::{ResolvedAnalyses, compliance, motion, part_in_hand, positioner};
use crate::input::cell::CellBodies;
use crate::input::problem_log::ProblemLog;
use crate::input::setting::Setting;
use crate::robots;

/// A study that can be run.
#[derive(Clone, Debug)]
pub struct Study {
    /// Title of the report.
    pub title: String,
    /// The question in words.
    pub question: Option<String>,
    /// The robot, with the compliance of the study if it gives one.
    pub robot: RobotDescription,
    /// Compliances given by the study.
    pub own_compliance: Option<OwnCompliance>,
    /// The analyses.
    pub analyses: Vec<Analysis>,
    /// How robot programs are written, with the values of the robot file.
    pub controller: ControllerTable,
    /// Permitted placements of the part.
    pub place: Option<PlaceTable>,
    /// Measurements of one circle.
    pub experiment: Option<Experiment>,
    /// Circular tests for the backlash of the joints.
    pub circles: Vec<MeasuredCircle>,
    /// Published statements by others.
    pub statements: Vec<StatementTable>,
    /// What a user should know of the bodies of the cell.
    pub cell_notes: Vec<String>,
}

impl Study {
    /// Whether the study gives joint compliances that were not measured.
    pub fn compliance_is_assumed(&self) -> bool {
        self.own_compliance
            .as_ref()
            .is_some_and(|own| own.caution.is_some())
    }

    /// The paths of the study with their names, or the one called `name`.
    pub fn paths<'a>(&'a self, name: Option<&str>) -> impl Iterator<Item = (&'a str, &'a PathAnalysis)> {
        self.analyses
            .iter()
            .filter_map(move |analysis| match &analysis.subject {
                Subject::Path(path) if name.is_none_or(|name| name == analysis.name) => {
                    Some((analysis.name.as_str(), &**path))
                }
                _ => None,
            })
    }

    /// The sets of holes of the study with their names, or the one called `name`.
    pub fn holes<'a>(&'a self, name: Option<&str>) -> impl Iterator<Item = (&'a str, &'a HolesAnalysis)> {
        self.analyses
            .iter()
            .filter_map(move |analysis| match &analysis.subject {
                Subject::Holes(holes) if name.is_none_or(|name| name == analysis.name) => {
                    Some((analysis.name.as_str(), &**holes))
                }
                _ => None,
            })
    }

    /// What the points of each analysis share, by analysis.
    ///
    /// The first section represents all: sections differ in the plane alone.
    pub fn settings(&self) -> impl Iterator<Item = &Setting> {
        self.analyses
            .iter()
            .filter_map(|analysis| analysis.subject.setting(0))
    }
}

/// The study in this text; `shown` is what errors call it, robot files are looked for in `folder`.
///
/// # Errors
/// Every problem of the file, each with its place.
///
/// A study without analyses means one map of its plane, called `map`.
pub fn read(shown: &str, folder: &Path, bytes: &[u8]) -> Result<Study, StudyError> {
    read_changed(shown, folder, bytes, |_| ())
}

/// [`read`], with the file modified by `change` before it is resolved; problems refer to the unmodified file.
///
/// # Errors
/// As of [`read`].
pub fn read_changed(
    shown: &str,
    folder: &Path,
    bytes: &[u8],
    change: impl FnOnce(&mut StudyFile),
) -> Result<Study, StudyError> {
    let mut parsed = Parsed::in_folder(shown, folder, bytes)?;
    change(&mut parsed.file);
    parsed.resolve(folder, None)
}

/// A study file whose fields are known, and not yet what they mean.
#[derive(Clone, Debug)]
pub struct Parsed {
    document: Document,
    /// The file as written.
    pub file: StudyFile,
}

impl Parsed {
    /// The file in this text; `shown` is its name in messages.
    ///
    /// # Errors
    /// Invalid TOML, or a field that a study does not have.
    pub fn of(shown: &str, bytes: &[u8]) -> Result<Parsed, StudyError> {
        let document = Document::from_bytes(shown, bytes)?;
        let file = document.read()?;
        Ok(Parsed { document, file })
    }

    /// [`Parsed::of`], where an unknown robot is also reported if fields have problems.
    ///
    /// # Errors
    /// As of [`Parsed::of`]; the robot, relative to `folder`.
    pub fn in_folder(shown: &str, folder: &Path, bytes: &[u8]) -> Result<Parsed, StudyError> {
        let document = Document::from_bytes(shown, bytes)?;
        match document.read() {
            Ok(file) => Ok(Parsed { document, file }),
            Err(problems) => {
                let of_robot = unknown_robot(&document, folder);
                let problems = problems.as_slice().iter().cloned().chain(of_robot);
                Err(StudyError::Problems(Problems::from(problems.collect::<Vec<_>>())))
            }
        }
    }

    /// The tables of its analyses; of a study without any, the table of its implied map.
    pub fn analysis_tables(&self) -> Cow<'_, [AnalysisTable]> {
        if self.file.analysis.is_empty() {
            Cow::Owned(vec![whole_plane()])
        } else {
            Cow::Borrowed(&self.file.analysis)
        }
    }

    /// The names of its analyses, in order.
    pub fn analysis_names(&self) -> Vec<String> {
        let tables = self.analysis_tables();
        let names = tables
            .iter()
            .enumerate()
            .map(|(index, table)| name_of(table, index));
        names.collect()
    }

    /// The paths of the values that the file itself gives below this path, such as `plane.step_mm` below ``.
    pub fn keys(&self, path: &str) -> Vec<String> {
        self.document.keys(path)
    }

    /// The resolved study; with `only` that analysis alone is resolved, and problems of others are not looked for.
    ///
    /// # Errors
    /// Every problem of the file, each with its place; no analysis of that name.
    pub fn resolve(&self, folder: &Path, only: Option<&str>) -> Result<Study, StudyError> {
        self.meaning(folder, only).map_err(|error| match error {
            StudyError::Problems(problems) => {
                StudyError::Problems(problems.quoting_only(|file| may_be_quoted(file, folder)))
            }
            other => other,
        })
    }

    fn meaning(&self, folder: &Path, only: Option<&str>) -> Result<Study, StudyError> {
        let (document, file) = (&self.document, &self.file);
        let tables = self.analysis_tables();
        let requested = only.map(|name| self.index_of(name)).transpose()?;
        let mut log = ProblemLog::new(document, None);
        let mut robot = find_robot(&mut log, file, folder)?;
        let mut actual = match &robot {
            Some(robot) => find_calibrated(&mut log, file, robot, folder)?,
            None => None,
        };
        if let Some(actual) = &actual {
            robot = robot.map(|arm| actual.measured_on(arm)).transpose()?;
        }
        robot = (robot.map(|arm| with_own_compliance(&mut log, file, arm))).transpose()?;
        if let Some((table, arm)) = file.positioner.as_ref().zip(robot.as_ref())
            && let Some(found) = positioner::find(&mut log, table, folder, &arm.robot)?
        {
            robot = robot.map(|arm| found.described(arm)).transpose()?;
            if let Some(actual) = &mut actual {
                actual.robot = Arc::new(found.under(&actual.robot)?);
            }
        }
        if let Some(table) = &file.part_in_hand {
            part_in_hand::check(&mut log, file);
            if file.positioner.is_none() {
                robot = robot.map(|arm| part_in_hand::described(table, arm)).transpose()?;
                if let Some(actual) = &mut actual {
                    actual.robot = Arc::new(part_in_hand::holding(table, &actual.robot)?);
                }
            }
        }
        let before_bodies = log.problems.len();
        let bodies = match &robot {
            Some(robot) => CellBodies::read(&mut log, &file.cell_tables(&tables), robot, folder)?,
            None => None,
        };
        let bodies_have_problems = log.problems.len() > before_bodies;
        let of_robot = robot
            .as_ref()
            .and_then(|robot| robot.controller.clone())
            .unwrap_or_default();
        let controller =
            (file.controller.as_ref()).map_or_else(|| of_robot.clone(), |table| table.or(&of_robot));
        let motion = motion::merged(&mut log, document, file, robot.as_ref());
        let common = StudyTables {
            motion: motion.as_ref(),
            rapid: controller.rapid(),
            ..file.common()
        };
        let mut problems = std::mem::take(&mut log.problems);
        let mut analyses = Vec::new();
        let chosen = tables.iter().enumerate();
        for (index, table) in
            chosen.filter(|(index, _)| requested.is_none_or(|requested| requested == *index))
        {
            let own = (!file.analysis.is_empty()).then_some(index);
            let mut log = ProblemLog::new(document, own);
            let resolver = Resolver {
                common: &common,
                robot: robot.as_ref(),
                actual: actual.as_ref().map(|actual| &actual.robot),
                table,
                folder,
                bodies: bodies.as_ref(),
                bodies_have_problems,
            };
            let name = name_of(table, index);
            if let Some(subject) = resolver.subject(&mut log)? {
                analyses.push(Analysis { name, subject });
            }
            problems.append(&mut log.problems);
        }
        if let Some(robot) = &robot {
            memory::check_analyses(&mut log, robot, &analyses);
        }
        check_statements(&mut log, file, &analyses);
        let resolved = ResolvedAnalyses {
            list: &analyses,
            complete: analyses.len() == tables.len(),
        };
        check_place(&mut log, file, resolved);
        let experiment = file
            .measured
            .as_ref()
            .and_then(|table| Experiment::read(&mut log, table, folder, resolved));
        let circles: Vec<MeasuredCircle> = (file.ballbar.iter().enumerate())
            .filter_map(|(index, table)| MeasuredCircle::read(&mut log, index, table, folder, resolved))
            .collect();
        problems.append(&mut log.problems);
        if let Some((table, robot)) = file.controller.as_ref().zip(robot.as_ref()) {
            problems.extend(table.problems(
                document,
                robot.robot.joints().len(),
                robot.robot.chain().ground().positioner_joints(),
            ));
        }
        problems.extend(unfit_names(document, file));
        Problems::from(without_repeats(problems)).into_result()?;
        let Some(mut robot) = robot else {
            return Err(StudyError::value("the study has no robot", "add `robot = ...`"));
        };
        robot
            .sources
            .extend(actual.into_iter().flat_map(|actual| actual.sources));
        let own_compliance = (file.compliance.as_ref()).map(|table| OwnCompliance::of(table, &robot.robot));
        Ok(Study {
            controller,
            title: file
                .title
                .clone()
                .unwrap_or_else(|| format!("Deviation of {} under load", robot.title)),
            question: file.question.clone(),
            own_compliance: own_compliance.transpose()?,
            robot,
            analyses,
            place: file.place.clone(),
            experiment,
            circles,
            statements: file.statement.clone(),
            cell_notes: bodies.map_or_else(Vec::new, |bodies| bodies.notes),
        })
    }

    /// Which analysis is called so.
    pub(crate) fn index_of(&self, name: &str) -> Result<usize, StudyError> {
        let names = self.analysis_names();
        names.iter().position(|own| own == name).ok_or_else(|| {
            let all: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
            let hint = format!("its analyses: {}", all.join(", "));
            StudyError::value(format!("no analysis is called `{name}`"), hint)
        })
    }
}

/// Whether problems may quote this file: one in the folder of the study, one that the command line names, and a text
/// that is no file, as of the library. A study from elsewhere must not show what else is on this machine.
fn may_be_quoted(file: &str, folder: &Path) -> bool {
    let file = Path::new(file);
    let Ok(real) = file.canonicalize() else {
        return true;
    };
    // A study that is named alone is in the current folder.
    let inside = Path::new(".").join(folder).canonicalize();
    let inside = inside.is_ok_and(|folder| real.starts_with(folder));
    inside || Inputs::current().name(file)
}

/// Problems of the permitted placements.
fn check_place(log: &mut ProblemLog<'_>, file: &StudyFile, analyses: ResolvedAnalyses<'_>) {
    let Some(place) = &file.place else { return };
    for (key, message, hint) in place.faults() {
        log.problem(&format!("place.{key}"), message, hint);
    }
    let is_it = |analysis: &Analysis, name: &String| {
        analysis.name == *name && matches!(analysis.subject, Subject::Path(_) | Subject::Holes(_))
    };
    let of_none =
        |name: &&String| analyses.complete && !analyses.list.iter().any(|analysis| is_it(analysis, name));
    if let Some(name) = place.analysis.as_ref().filter(of_none) {
        let message = format!("the study has no path called `{name}`");
        log.problem(
            "place.analysis",
            message,
            "the name of an analysis of kind = \"path\"",
        );
    }
}

/// An analysis for one map of the study's plane.
fn whole_plane() -> AnalysisTable {
    AnalysisTable {
        name: Some("map".to_owned()),
        ..AnalysisTable::default()
    }
}

/// A problem of a value of the study that several analyses use is reported once.
fn without_repeats(problems: Vec<Problem>) -> Vec<Problem> {
    let mut kept: Vec<Problem> = Vec::new();
    for problem in problems {
        if !kept.contains(&problem) {
            kept.push(problem);
        }
    }
    kept
}

/// The problem of `robot` in a document that is not a study yet, if it names one that is not found.
fn unknown_robot(document: &Document, folder: &Path) -> Option<Problem> {
    let values = document.to_json();
    match robots::find(values.get("robot")?.as_str()?, folder) {
        Err(StudyError::Value { message, hint }) => Some(document.problem("robot", message, Some(&hint))),
        _ => None,
    }
}

/// The robot of the study, with the compliances of the study, if given; `None` if it is not found, reported at its key.
///
/// # Errors
/// The problems of a robot file; compliances that the robot refuses.
fn find_robot(
    log: &mut ProblemLog<'_>,
    file: &StudyFile,
    folder: &Path,
) -> Result<Option<RobotDescription>, StudyError> {
    let found = match robots::find(&file.robot, folder) {
        Ok(found) => found,
        Err(StudyError::Value { message, hint }) => {
            log.problem("robot", message, &hint);
            return Ok(None);
        }
        Err(problems) => return Err(problems),
    };
    let joints = found.robot.joints().len();
    if joints < crate::ENOUGH_JOINTS {
        let message = format!("robot `{}` has {joints} joints", file.robot);
        let hint = "a tool at any pose requires six joints; `armill pose` accepts the joint positions";
        log.problem("robot", message, hint);
    }
    Ok(Some(found))
}

/// `found` with the compliances of `[compliance]`, if there are any; otherwise it must have its own.
fn with_own_compliance(
    log: &mut ProblemLog<'_>,
    file: &StudyFile,
    mut found: RobotDescription,
) -> Result<RobotDescription, StudyError> {
    let own = compliance::of_study(log, file, &found.robot)?;
    if let Some(joints) = own {
        let refused = |error: armill_core::robot::RobotError| {
            let hint = "one compliance for each joint of the robot, 0 for a rigid one";
            StudyError::value(error.to_string(), hint)
        };
        found.robot = found.robot.with_other_compliance(joints).map_err(refused)?;
    }
    Ok(found)
}

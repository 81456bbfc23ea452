//! From the study file to what each ask means: in SI, in the robot's base, checked.
//!
//! Everything of the file is looked at before anything is refused: a value that is wrong for one ask does not hide
//! those of the next, and a value of the study that several asks take is told once.

use std::borrow::Cow;
use std::path::Path;

use armill_core::frame::Isometry;
use armill_core::kernel::BranchChoice;
use armill_core::load::{InputUncertainty, LoadCases};
use armill_core::map::BoxGrid;
use armill_core::nalgebra::{Matrix6, Point3};
use armill_core::optimize::PostureSearch;
use armill_core::robot::{BranchPattern, Robot};
use armill_core::source::{Arm, ArmState, StiffnessModel};
use armill_core::spatial::Wrench;
use armill_core::workpiece::{Grid, Plane};
use armill_formats::document::{Document, Problem, Problems};
use armill_formats::input::Inputs;
use armill_formats::robot::RobotDescription;

use super::calibrated::find_calibrated;
use super::analysis::Resolver;
use super::circles::MeasuredCircle;
use super::compliance::{self, OwnCompliance};
use super::experiment::Experiment;
use super::format::{AnalysisTable, StatementTable, StudyFile};
use super::holes::HolesAnalysis;
use super::memory;
use super::names::{check_statements, name_of, unfit_names};
use super::path::PathAnalysis;
use super::placement::PlaceTable;
use super::places::Places;
use super::positioner;
use crate::error::StudyError;
use crate::robots;

/// A study that can be run.
#[derive(Clone, Debug)]
pub struct Study {
    /// Title of the report.
    pub title: String,
    /// The question in words.
    pub question: Option<String>,
    /// The robot, with the compliance of the study if it brings one.
    pub robot: RobotDescription,
    /// Compliances that the study brings.
    pub own_compliance: Option<OwnCompliance>,
    /// What is asked.
    pub analyses: Vec<Ask>,
    /// Where the part may lie.
    pub place: Option<PlaceTable>,
    /// What was measured on one circle.
    pub experiment: Option<Experiment>,
    /// Circular tests for the backlash of the joints.
    pub circles: Vec<MeasuredCircle>,
    /// What others state.
    pub statements: Vec<StatementTable>,
}

impl Study {
    /// Whether the study brings joint compliances that nobody measured.
    pub fn compliance_is_assumed(&self) -> bool {
        self.own_compliance
            .as_ref()
            .is_some_and(|own| own.caution.is_some())
    }

    /// What the points of each ask share, ask by ask.
    ///
    /// Of sections the first stands for all: they differ in the plane alone.
    pub fn settings(&self) -> impl Iterator<Item = &Setting> {
        self.analyses.iter().filter_map(|analysis| match &analysis.subject {
            Subject::Map(sheet) => Some(&sheet.setting),
            Subject::Sections(sections) => sections.first().map(|(_, sheet)| &sheet.setting),
            Subject::Volume(setting, _) => Some(setting),
            Subject::Path(path) => Some(&path.setting),
            Subject::Holes(holes) => Some(&holes.path.setting),
        })
    }
}

/// One ask, worked out.
#[derive(Clone, Debug)]
pub struct Ask {
    /// Its name.
    pub name: String,
    /// What it is about.
    pub subject: Subject,
}

/// What an ask is about.
#[derive(Clone, Debug)]
pub enum Subject {
    /// One plane.
    Map(Sheet),
    /// Several planes, each with its label.
    Sections(Vec<(String, Sheet)>),
    /// A box of points.
    Volume(Setting, BoxGrid),
    /// A path.
    Path(Box<PathAnalysis>),
    /// Holes.
    Holes(Box<HolesAnalysis>),
}

/// A plane with its grid.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// How the points are asked.
    pub setting: Setting,
    /// Which points.
    pub grid: Grid,
}

/// Everything that a point needs to be answered, SI, base.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Name of the frame that coordinates count from.
    pub base_name: String,
    /// That frame in base.
    pub base_from_reference: Isometry,
    /// Flange to tool centre point.
    pub flange_from_tool: Isometry,
    /// What yields and weighs beside the drives.
    pub model: StiffnessModel,
    /// The workpiece plane.
    pub plane: Plane,
    /// Its tilt as asked, rad, where it was given by one.
    pub tilt: Option<f64>,
    /// Load cases as they are told; none where the forces come with a path.
    pub load: LoadCases,
    /// The same in base; of a load that turns with the feed as if that went along x of the part.
    pub cases: Vec<Wrench>,
    /// Where the load comes from, in the user's words.
    pub load_source: Option<String>,
    /// Where springs and masses of the tool come from, likewise.
    pub tool_sources: Vec<String>,
    /// How sure load and tool are.
    pub uncertainty: InputUncertainty,
    /// The tolerance, m.
    pub limit: f64,
    /// Which posture.
    pub choice: BranchChoice,
    /// Where a rail stands and what joints to spare are drawn to, rad (m).
    pub home: Option<Vec<f64>>,
    /// Branches that the words of the study leave open; all where it has none.
    pub open: BranchPattern,
    /// Along a path: which turns and branches are tried.
    pub search: Option<PostureSearch>,
}

impl Setting {
    /// Name of the posture asked for: words of a branch, or `best`.
    pub fn branch(&self) -> String {
        match self.choice {
            BranchChoice::Of(pattern) if pattern == BranchPattern::default() => "nominal".to_owned(),
            BranchChoice::Of(pattern) => pattern.to_string(),
            BranchChoice::Best => "best".to_owned(),
        }
    }

    /// Compliance of the unloaded arm at joint positions `q` (rad, m), SI; zeros where the arm does not hold itself.
    pub fn compliance_at(&self, robot: &Robot, q: &[f64]) -> Matrix6<f64> {
        let mut arm_state = ArmState::new(Arm {
            robot,
            compliance: robot.compliance().unwrap_or_default(),
            model: &self.model,
            flange_from_tool: &self.flange_from_tool,
        });
        arm_state.set_joints(q);
        arm_state.compliance().unwrap_or_else(Matrix6::zeros)
    }

    /// A point of base told in the frame that the study counts from, m.
    pub fn counted(&self, in_base: &Point3<f64>) -> Point3<f64> {
        self.base_from_reference.inverse_transform_point(in_base)
    }
}

/// The study in this text; `shown` is what errors call it, robot files are looked for in `folder`.
///
/// # Errors
/// Every problem of the file, each with its place.
///
/// A study without asks means one map of its plane, called `map`.
pub fn read(shown: &str, folder: &Path, bytes: &[u8]) -> Result<Study, StudyError> {
    read_changed((shown, folder), bytes, |_| ())
}

/// [`read`], with what `change` makes of the file before it is worked out; problems stand where the file as it is has them.
///
/// # Errors
/// As of [`read`].
pub fn read_changed(
    (shown, folder): (&str, &Path),
    bytes: &[u8],
    change: impl FnOnce(&mut StudyFile),
) -> Result<Study, StudyError> {
    let mut parsed = Parsed::of(shown, bytes)?;
    change(&mut parsed.file);
    parsed.resolve(folder, None)
}

/// A study file whose fields are known, and not yet what they mean.
#[derive(Clone, Debug)]
pub struct Parsed {
    document: Document,
    /// The file as it stands.
    pub file: StudyFile,
}

impl Parsed {
    /// The file in this text; `shown` is what errors call it.
    ///
    /// # Errors
    /// What is no TOML, or no field of a study.
    pub fn of(shown: &str, bytes: &[u8]) -> Result<Parsed, StudyError> {
        let document = Document::from_bytes(shown, bytes)?;
        let file = document.read()?;
        Ok(Parsed { document, file })
    }

    /// The tables of its asks; of a study without any that of the map which it means.
    pub fn ask_tables(&self) -> Cow<'_, [AnalysisTable]> {
        if self.file.analysis.is_empty() {
            Cow::Owned(vec![whole_plane()])
        } else {
            Cow::Borrowed(&self.file.analysis)
        }
    }

    /// The names of its asks, in order.
    pub fn ask_names(&self) -> Vec<String> {
        let tables = self.ask_tables();
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

    /// What the file means; with `only` that ask alone is worked out, and problems of others are not looked for.
    ///
    /// # Errors
    /// Every problem of the file, each with its place; no ask of that name.
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
        let tables = self.ask_tables();
        let requested = only.map(|name| self.index_of(name)).transpose()?;
        let mut places = Places::new(document, None);
        let robot = find_robot(&mut places, file, folder)?;
        let actual = match &robot {
            Some(robot) => find_calibrated(&mut places, file, (robot, folder))?,
            None => None,
        };
        let mut problems = std::mem::take(&mut places.problems);
        let mut analyses = Vec::new();
        let chosen = tables.iter().enumerate();
        for (index, table) in chosen.filter(|(index, _)| requested.is_none_or(|requested| requested == *index)) {
            let own = (!file.analysis.is_empty()).then_some(index);
            let mut places = Places::new(document, own);
            let resolver = Resolver {
                file,
                robot: robot.as_ref(),
                actual: actual.as_ref().map(|actual| &actual.robot),
                table,
                folder,
            };
            let name = name_of(table, index);
            if let Some(subject) = resolver.subject(&mut places)? {
                analyses.push(Ask { name, subject });
            }
            problems.append(&mut places.problems);
        }
        if let Some(robot) = &robot {
            memory::check_asks(&mut places, robot, &analyses);
        }
        check_statements(&mut places, file, &analyses);
        let all_read = analyses.len() == tables.len();
        check_place(&mut places, file, (&analyses, all_read));
        let experiment = file
            .measured
            .as_ref()
            .and_then(|table| Experiment::read(&mut places, table, folder, (&analyses, all_read)));
        let circles: Vec<MeasuredCircle> = (file.ballbar.iter().enumerate())
            .filter_map(|table| MeasuredCircle::read(&mut places, table, folder, (&analyses, all_read)))
            .collect();
        problems.append(&mut places.problems);
        problems.extend(unfit_names(document, file));
        Problems::from(without_repeats(problems)).into_result()?;
        let Some(mut robot) = robot else {
            return Err(StudyError::value(
                "the study names no robot",
                "name one with `robot = ...`",
            ));
        };
        robot
            .sources
            .extend(actual.into_iter().flat_map(|actual| actual.sources));
        Ok(Study {
            title: file
                .title
                .clone()
                .unwrap_or_else(|| format!("Deviation of {} under load", robot.title)),
            question: file.question.clone(),
            own_compliance: file.compliance.as_ref().map(OwnCompliance::of).transpose()?,
            robot,
            analyses,
            place: file.place.clone(),
            experiment,
            circles,
            statements: file.statement.clone(),
        })
    }

    /// Which ask is called so.
    pub(crate) fn index_of(&self, name: &str) -> Result<usize, StudyError> {
        let names = self.ask_names();
        names.iter().position(|own| own == name).ok_or_else(|| {
            let all: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
            let hint = format!("its asks: {}", all.join(", "));
            StudyError::value(format!("no ask is called `{name}`"), hint)
        })
    }
}

/// Whether problems may quote this file: one in the folder of the study, one that the command line names, and a text that is
/// no file, as of the library. A study from elsewhere must not show what else is on this machine.
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

/// Problems of where the part may lie.
fn check_place(places: &mut Places<'_>, file: &StudyFile, (analyses, all_read): (&[Ask], bool)) {
    let Some(place) = &file.place else { return };
    for (key, message, hint) in place.faults() {
        places.problem(&format!("place.{key}"), message, hint);
    }
    let is_it = |analysis: &Ask, name: &String| {
        analysis.name == *name && matches!(analysis.subject, Subject::Path(_) | Subject::Holes(_))
    };
    let of_none = |name: &&String| all_read && !analyses.iter().any(|analysis| is_it(analysis, name));
    if let Some(name) = place.analysis.as_ref().filter(of_none) {
        let message = format!("the study has no path called `{name}`");
        places.problem("place.ask", message, "the name of an ask of kind = \"path\"");
    }
}

/// An ask for one map of the study's plane.
fn whole_plane() -> AnalysisTable {
    AnalysisTable {
        name: Some("map".to_owned()),
        ..AnalysisTable::default()
    }
}

/// A value of the study that several asks take is wrong once, not once an ask.
fn without_repeats(problems: Vec<Problem>) -> Vec<Problem> {
    let mut kept: Vec<Problem> = Vec::new();
    for problem in problems {
        if !kept.contains(&problem) {
            kept.push(problem);
        }
    }
    kept
}

/// The robot of the study, with its compliances and its positioner where the study brings them; `None` where it is not
/// found, told at its place.
///
/// # Errors
/// The problems of a robot file; compliances or a positioner that the robot refuses.
fn find_robot(
    places: &mut Places<'_>,
    file: &StudyFile,
    folder: &Path,
) -> Result<Option<RobotDescription>, StudyError> {
    let mut found = match robots::find(&file.robot, folder) {
        Ok(found) => found,
        Err(StudyError::Value { message, hint }) => {
            places.problem("robot", message, &hint);
            return Ok(None);
        }
        Err(problems) => return Err(problems),
    };
    let joints = found.robot.joints().len();
    if joints < crate::ENOUGH_JOINTS {
        let message = format!("robot `{}` has {joints} joints", file.robot);
        let hint = "holding a tool at any pose takes six; `armill pose` takes its joints";
        places.problem("robot", message, hint);
    }
    let own = compliance::of_study(places, file, &found.robot)?;
    if let Some(joints) = own {
        let refused = |error: armill_core::robot::RobotError| {
            let hint = "one compliance for each joint of the robot, 0 for a rigid one";
            StudyError::value(error.to_string(), hint)
        };
        found.robot = found.robot.with_other_compliance(joints).map_err(refused)?;
    }
    if let Some(table) = &file.positioner {
        found = positioner::beside(places, table, folder, found)?;
    }
    Ok(Some(found))
}

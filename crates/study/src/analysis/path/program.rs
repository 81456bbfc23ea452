//! A program that a path follows: its file, its placement on the part, the spin of the tool, the resolution of its
//! points.
//!
//! | frame | meaning |
//! |---|---|
//! | `path` | the reference frame of the program, moved by `part_from_path_mm_deg` |
//! | `part` | origin at the centre of the plane, z its outward normal |
//!
//! A robot program specifies its frame in the base of the robot itself; see `robot_program`.
//!
//! Lines become points at most `step_mm` apart, arcs so many that no chord leaves them by more than `chord_error_mm`.
//! The reader hands its steps on one by one; at most `MOST_POINTS` points are made of them.

use std::io::Read;
use std::path::{Path, PathBuf};

use armill_core::frame::Isometry;
use armill_core::nalgebra::Vector3;
use armill_core::path::{Placing, SampledPath, Sampling, Spin, TooManyPoints};
use armill_core::units::from_deg;
use armill_formats::input;
use armill_formats::toolpath::Summary;
use armill_formats::toolpath::format::{Format, HEAD_BYTES};
use armill_formats::toolpath::gcode::Rotaries;
use armill_programs::Language;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::StudyError;
use crate::analysis::path::drill::DrillTable;
use crate::analysis::path::feature::{FeatureTable, features_have_points};
use crate::analysis::path::measured::MeasuredTable;
use crate::analysis::path::robot_program::{RobotInCell, RobotPath};
use crate::analysis::path::{machine_program, robot_program};
use crate::input::problem_log::ProblemLog;
use crate::input::quantities::{at_least, pose_mm_deg, step};

/// A program that the tool follows.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProgramTable {
    /// Its file, relative to the study: G-code, APT-CL or CLSF, a CSV of points, or a robot program (KRL, RAPID,
    /// INFORM, TP, URScript; of VAL3 the folder).
    pub file: String,
    /// Unit of lengths, if the file does not specify it.
    pub unit: Option<UnitName>,
    /// Dialect of the cutter locations (APT, CLSF), if the file does not show it.
    pub dialect: Option<DialectName>,
    /// Meaning of the rotary words of G-code.
    pub rotaries: Option<RotariesName>,
    /// Tool table of the machine of the G-code, in the format of LinuxCNC, relative to the study.
    pub tool_table: Option<String>,
    /// Its origin in the part frame (z = outward normal of the plane, origin at its centre): x, y, z in mm,
    /// then rotations about the fixed axes x, y, z in degrees.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub part_from_path_mm_deg: Option<[f64; 6]>,
    /// Robot programs: the frame that the program calls by its number, as in the controller: x, y, z in mm,
    /// then rotations about the fixed axes x, y, z in degrees.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub frame_mm_deg: Option<[f64; 6]>,
    /// Robot programs: straight and circular moves faster than this do not cut, as joint moves do not.
    #[schemars(range(min = 0.0, max = 1e9))]
    pub cuts_up_to_mm_per_min: Option<f64>,
    /// Direction of the tool.
    pub tool_axis: Option<ToolAxisName>,
    /// Spin of the tool about its axis.
    pub spin: Option<SpinName>,
    /// Additional spin.
    #[schemars(range(min = -360.0, max = 360.0))]
    pub spin_deg: Option<f64>,
    /// Largest distance of a chord from its arc; 0.01 if left out.
    #[schemars(range(max = 1e3))]
    pub chord_error_mm: Option<f64>,
    /// Longest distance between points; 1 if left out.
    #[schemars(range(max = 1e6))]
    pub step_mm: Option<f64>,
    /// Whether force, depth, width and feed that meet the tolerance are reported; true if left out.
    pub limits: Option<bool>,
    /// Ranges of lines of the program that make a feature.
    #[serde(default)]
    pub feature: Vec<FeatureTable>,
    /// Measured forces: the load of this program.
    pub measured: Option<MeasuredTable>,
    /// A drill: its thrust and torque are the load of this program.
    pub drill: Option<DrillTable>,
}

/// Unit of lengths.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum UnitName {
    /// Millimetre.
    Mm,
    /// Inch.
    Inch,
}

/// Dialects of cutter locations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum DialectName {
    /// Siemens NX: a GOTO without tool axis keeps the one before.
    Nx,
    /// SolidWorks CAM: a GOTO without tool axis means 0,0,1.
    SolidWorks,
}

/// Meaning of rotary words, from the frame of the machine outwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RotariesName {
    /// A tilting table A that carries a turntable C.
    TableAc,
    /// A tilting table B that carries a turntable C.
    TableBc,
    /// A fork C that carries a tilting head A.
    HeadCa,
    /// A fork C that carries a tilting head B.
    HeadCb,
}

impl RotariesName {
    /// As the reader of G-code knows them.
    pub fn rotaries(self) -> Rotaries {
        match self {
            RotariesName::TableAc => Rotaries::table_ac(),
            RotariesName::TableBc => Rotaries::table_bc(),
            RotariesName::HeadCa => Rotaries::head_ca(),
            RotariesName::HeadCb => Rotaries::head_cb(),
        }
    }
}

/// Direction of the tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ToolAxisName {
    /// As in the program; opposite to the normal of the plane if the program has no tool axis.
    Program,
    /// Always opposite to the normal of the plane.
    Normal,
}

/// Spin of the tool about its axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SpinName {
    /// Constant.
    Fixed,
    /// With the feed.
    AlongFeed,
    /// As the program specifies at each point: column `spin_deg` of a CSV, the orientations of a robot program.
    Given,
}

/// Most points of a program: limited by the memory of a study.
pub const MOST_POINTS: usize = 8_000_000;
/// Hint for a file that is not found.
pub const FILE_HINT: &str = "paths are relative to the folder of the study";
/// Default of the largest distance of a chord from its arc, mm.
const CHORD_ERROR_MM: f64 = 0.01;
/// Least distance of a chord from its arc, mm: far below the accuracy of any machine.
const LEAST_CHORD_ERROR_MM: f64 = 1e-6;
/// Default of the largest distance of points, mm.
const STEP_MM: f64 = 1.0;

/// A program as points.
pub struct ReadProgram {
    /// Its points.
    pub path: SampledPath,
    /// Data of the program.
    pub summary: Summary,
    /// Data that only a robot program has.
    pub robot: Option<Box<RobotPath>>,
}

/// The points of the program of this table; `None` if it has problems, reported at their keys. A robot program
/// is followed by the robot of `cell`; without, it is read alone.
///
/// # Errors
/// The problems of its file.
pub fn read(
    log: &mut ProblemLog<'_>,
    table: &ProgramTable,
    folder: &Path,
    cell: Option<RobotInCell<'_>>,
) -> Result<Option<ReadProgram>, StudyError> {
    let chord_error_mm = table.chord_error_mm.unwrap_or(CHORD_ERROR_MM);
    let chord_error = at_least(
        log,
        "program.chord_error_mm",
        chord_error_mm,
        LEAST_CHORD_ERROR_MM,
    );
    let step = step(log, "program.step_mm", table.step_mm.unwrap_or(STEP_MM));
    for (index, feature) in table.feature.iter().enumerate() {
        let [first, last] = feature.lines;
        if first == 0 || last < first {
            let message = format!(
                "`{}`: the range of lines {first} to {last} is not valid",
                feature.name
            );
            let hint = "give the first and the last line of the program, from 1";
            log.problem(&format!("program.feature[{index}].lines"), message, hint);
        }
    }
    let (Some(chord_error), Some(step)) = (chord_error, step) else {
        return Ok(None);
    };
    let file = ProgramFile {
        path: folder.join(&table.file),
        folder,
        sampling: Sampling { chord_error, step },
    };
    let shown = file.path.display().to_string();
    let found = match file.robot_language(log) {
        Some(Some(language)) => robot_program::read(log, table, language, &file, cell)?,
        Some(None) => machine_program::read(log, table, &file)?,
        None => None,
    };
    let Some(found) = found else {
        return Ok(None);
    };
    if found.path.points.is_empty() {
        let message = format!("{shown} has no cutting move");
        let hint = match &found.robot {
            Some(_) => {
                "moves of the joints cut nothing, nor those above `cuts_up_to_mm_per_min`, and straight ones only from a place \
                 that the program specifies"
            }
            None => "the program has rapids only",
        };
        log.problem("program.file", message, hint);
        return Ok(None);
    }
    if table.spin == Some(SpinName::Given)
        && let Some(silent) = found.path.points.iter().find(|point| point.spin.is_none())
    {
        let message = format!("{shown}: line {} gives no spin", silent.line);
        let hint = "a CSV gives it in a column `spin_deg`, a robot program in its poses; for others: spin = \"fixed\" or \
                    \"along-feed\"";
        log.problem("program.spin", message, hint);
        return Ok(None);
    }
    if !features_have_points(log, table, &found.path.points) {
        return Ok(None);
    }
    Ok(Some(found))
}

/// The file of a program, and how it is read.
pub struct ProgramFile<'a> {
    /// Its path.
    pub path: PathBuf,
    /// That of the study.
    pub folder: &'a Path,
    /// Resolution of its points.
    pub sampling: Sampling,
}

impl ProgramFile<'_> {
    /// The robot language of the program, if it is a robot program; `None` if it cannot be read, reported at its key.
    fn robot_language(&self, log: &mut ProblemLog<'_>) -> Option<Option<Language>> {
        if self.path.is_dir() {
            // A project of VAL3 is a folder.
            let is_project = |name: &str| Path::new(name).extension().is_some_and(|ending| ending == "pjx");
            let entries = std::fs::read_dir(&self.path).into_iter().flatten().flatten();
            let mut names = entries.map(|entry| entry.file_name().to_string_lossy().to_lowercase());
            if names.any(|name| is_project(&name)) {
                return Some(Some(Language::Val3));
            }
            let message = format!("{} is a folder", self.path.display());
            log.problem("program.file", message, "name the file in it");
            return None;
        }
        let mut head = Vec::new();
        let read = input::open(&self.path).and_then(|file| file.take(HEAD_BYTES).read_to_end(&mut head));
        if let Err(error) = read {
            let message = format!("cannot read {}: {error}", self.path.display());
            log.problem("program.file", message, FILE_HINT);
            return None;
        }
        match Format::of(&self.path, &String::from_utf8_lossy(&head)) {
            Ok(Format::Robot(language)) => Some(Some(language)),
            // What is none at all its reader says.
            _ => Some(None),
        }
    }

    /// Reports a program with more points than fit into memory.
    pub fn too_many(&self, log: &mut ProblemLog<'_>, error: TooManyPoints) {
        let message = format!("{} gives {error}", self.path.display());
        log.problem(
            "program.step_mm",
            message,
            "use a larger step, or split the program",
        );
    }
}

/// The placement of the program, and the orientation of the tool on it.
///
/// Without `tool_axis` and `spin` the tool points as in the program, and has a constant spin.
///
/// A robot program specifies its own placement and complete orientations.
pub fn placing(table: &ProgramTable, base_from_part: &Isometry, robot: Option<&RobotPath>) -> Placing {
    let part_from_path = table
        .part_from_path_mm_deg
        .as_ref()
        .map_or_else(Isometry::identity, pose_mm_deg);
    let (base_from_path, axis) = match robot {
        None => (
            base_from_part * part_from_path,
            part_from_path.rotation.inverse() * Vector3::z_axis(),
        ),
        Some(robot) => {
            let base_from_path = robot.followed.base_from_path;
            let normal = base_from_part.rotation * Vector3::z_axis();
            (base_from_path, base_from_path.rotation.inverse() * normal)
        }
    };
    let spin = from_deg(table.spin_deg.unwrap_or(0.0));
    Placing {
        base_from_path,
        axis,
        keeps_axis: table.tool_axis == Some(ToolAxisName::Normal),
        spin: match table.spin {
            None if robot.is_some() => Spin::Given(spin),
            None | Some(SpinName::Fixed) => Spin::Fixed(spin),
            Some(SpinName::AlongFeed) => Spin::AlongFeed(spin),
            Some(SpinName::Given) => Spin::Given(spin),
        },
    }
}

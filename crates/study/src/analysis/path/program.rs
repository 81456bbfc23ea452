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

use std::path::Path;

use armill_core::frame::Isometry;
use armill_core::nalgebra::Vector3;
use armill_core::path::{Placing, SampledPath, Sampling, Spin};
use armill_core::units::from_deg;
use armill_formats::toolpath::Summary;

use crate::StudyError;
use crate::analysis::path::feature::features_have_points;
use crate::analysis::path::program_file::ProgramFile;
use crate::analysis::path::program_table::{ProgramTable, SpinName, ToolAxisName};
use crate::analysis::path::robot_program::{RobotInCell, RobotPath};
use crate::analysis::path::{machine_program, robot_program};
use crate::input::problem_log::ProblemLog;
use crate::input::quantities::{at_least, pose_mm_deg, step};

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
        Some(Some(language)) => {
            let found = robot_program::read(log, table, language, &file, cell)?;
            found.map(|(path, robot)| ReadProgram {
                path,
                summary: robot.followed.summary(&robot.program),
                robot: Some(Box::new(robot)),
            })
        }
        Some(None) => {
            let found = machine_program::read(log, table, &file)?;
            found.map(|(path, summary)| ReadProgram {
                path,
                summary,
                robot: None,
            })
        }
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
    if !features_have_points(log, &table.feature, &found.path.points) {
        return Ok(None);
    }
    Ok(Some(found))
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

//! The files of a journal, as campaigns of the core.

use std::io::BufReader;
use std::path::Path;

use armill_core::calibrate::MeasuredPose;
use armill_core::frame::Isometry;
use armill_core::nalgebra::{Point3, Vector3};
use armill_core::robot::Robot;
use armill_core::robot::forward::forward;
use armill_core::units::to_mm;
use armill_core::update::{Campaign, Condition, Distances, Known, Observed, Positions, pivot_of};
use armill_formats::file::sum_of;
use armill_formats::input;
use armill_formats::measurement::conditions::{self, ConditionRow};
use armill_formats::measurement::journal::{self, Entry, Journal, Kind};
use armill_formats::measurement::load_tests;
use armill_formats::measurement::poses::PoseReadOptions;
use armill_formats::robot::RobotDescription;
use armill_study::{StudyError, robots};

use crate::calibrate;

/// Least number of readings of a ball-bar: pivot, point and length take seven.
const FEWEST_READINGS: usize = 8;
/// A reading further from the robot file than this, m, is not one of these joint positions.
const FARTHEST_READING: f64 = 0.02;

/// A journal with its robot and all its files.
#[derive(Clone, Debug)]
pub struct Measurements {
    /// The journal.
    pub journal: Journal,
    /// Its path, as given.
    pub file: String,
    /// The robot before any measurement.
    pub robot: RobotDescription,
    /// Name or path by which the robot file is found.
    pub robot_name: String,
    /// One per measurement.
    pub campaigns: Vec<Campaign>,
    /// Columns that were passed over, with their file.
    pub unused: Vec<String>,
}

/// Reads the journal in `path` and every file that it names, relative to it.
///
/// # Errors
/// The journal or a file cannot be read; their problems; a file with another checksum; an unknown robot.
pub fn read(path: &Path) -> Result<Measurements, StudyError> {
    let shown = path.display().to_string();
    let bytes = input::read(path).map_err(|error| {
        StudyError::value(
            format!("cannot read {shown}: {error}"),
            "a journal of measurements: docs/guide/journal.md",
        )
    })?;
    let journal = journal::read(&shown, &bytes)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let here = if folder == Path::new("") {
        Path::new(".")
    } else {
        folder
    };
    let robot = robots::find(&journal.robot, here)?;
    let robot_name = match folder.join(&journal.robot) {
        file if file.is_file() => file.display().to_string(),
        _ => journal.robot.clone(),
    };
    let mut campaigns = Vec::new();
    let mut unused = Vec::new();
    for entry in &journal.measurements {
        let file = folder.join(&entry.file);
        campaigns.push(campaign(&robot.robot, &journal, entry, &file, &mut unused)?);
    }
    Ok(Measurements {
        journal,
        file: shown,
        robot,
        robot_name,
        campaigns,
        unused,
    })
}

/// Rows of a table of conditions of `robot`: the work, or candidates.
///
/// # Errors
/// The file cannot be read; its problems.
pub fn conditions(path: &Path, robot: &Robot) -> Result<Vec<ConditionRow>, StudyError> {
    let shown = path.display().to_string();
    Ok(conditions::read(
        &shown,
        BufReader::new(open(&shown, path)?),
        robot,
    )?)
}

fn campaign(
    robot: &Robot,
    journal: &Journal,
    entry: &Entry,
    path: &Path,
    unused: &mut Vec<String>,
) -> Result<Campaign, StudyError> {
    let shown = path.display().to_string();
    if let Some(expected) = &entry.sha256 {
        let bytes = input::read(path).map_err(|error| not_read(&shown, &error))?;
        let found = sum_of(&bytes);
        if *expected != found {
            return Err(StudyError::value(
                format!("{shown}: its checksum is {found}, the journal has {expected}"),
                "the measurement was changed after it was entered: restore it, or enter the new checksum",
            ));
        }
    }
    let (point, known, u) = match entry.kind {
        Kind::LoadTests => {
            let reader = BufReader::new(open(&shown, path)?);
            let found = load_tests::read(&shown, reader, robot, entry.point)?;
            if !found.uncertainties_stated {
                return Err(StudyError::value(
                    format!("{shown}: a displacement has no uncertainty"),
                    "add the column d_u_mm, the standard uncertainty of a displacement",
                ));
            }
            return Ok(Campaign::LoadTests(found.tests));
        }
        Kind::BallBar { u, is_calibrated } => {
            let rows = conditions(path, robot)?;
            return ball_bar(robot, entry, (&shown, &rows), (u, is_calibrated));
        }
        Kind::Part(u) => (journal.tool_point, Known::Exactly, u),
        Kind::Tracker(u) => (entry.point, Known::Approximately, u),
    };
    let question = calibrate::Question {
        requested: armill_core::calibrate::ParameterSet::Base,
        tool_point: point,
        turn_length: None,
        prior: None,
    };
    let measured = calibrate::read(&shown, path, robot, &PoseReadOptions::default(), &question)?;
    let rows = conditions(path, robot)?;
    let of_line = |line: &usize| {
        let found = rows.iter().find(|row| row.line == *line);
        found.map_or_else(|| Condition::unloaded(robot), |row| row.condition.clone())
    };
    let passed_over = measured
        .unused
        .iter()
        .filter(|name| !conditions::is_condition(name, robot));
    unused.extend(passed_over.map(|name| format!("{}: {name}", entry.file)));
    let normal_of = |line: &usize| rows.iter().find(|row| row.line == *line)?.normal;
    let normals: Vec<Vector3<f64>> = measured.lines.iter().filter_map(normal_of).collect();
    let observed = match normals.len() {
        0 => Observed::Coordinates,
        count if count == measured.lines.len() => Observed::AlongNormals(normals),
        count => {
            let of = measured.lines.len();
            return Err(StudyError::value(
                format!("{shown}: {count} of {of} positions have a normal (`nx`, `ny`, `nz`)"),
                "a table has a normal in every row with a position, or in none",
            ));
        }
    };
    Ok(Campaign::Positions(Positions {
        conditions: measured.lines.iter().map(of_line).collect(),
        poses: measured.poses,
        flange_from_point: Isometry::from_parts(point.into(), Default::default()),
        point: known,
        standard_uncertainty: u,
        turn_length: 1.0,
        observed,
    }))
}

/// Readings of a ball-bar; the pivot is approximately where the nominal chain has it.
fn ball_bar(
    robot: &Robot,
    entry: &Entry,
    (shown, rows): (&str, &[ConditionRow]),
    (u, is_calibrated): (f64, bool),
) -> Result<Campaign, StudyError> {
    let refused = |message: String, hint: &str| StudyError::value(format!("{shown}: {message}"), hint);
    if let Some(row) = rows.iter().find(|row| row.radius.is_none()) {
        let hint = "add the column radius_mm, the distance from the pivot at these joint positions";
        return Err(refused(
            format!("line {} has no reading of the ball-bar", row.line),
            hint,
        ));
    }
    if rows.len() < FEWEST_READINGS {
        let hint = "use the readings along a whole circle, some hundred of them";
        return Err(refused(
            format!("{} readings of a ball-bar are too few", rows.len()),
            hint,
        ));
    }
    let flange_from_point = Isometry::from_parts(entry.point.into(), Default::default());
    let tip = |row: &ConditionRow| {
        let flange = forward(robot, &row.joints).base_from_flange;
        (flange * Point3::from(entry.point)).coords
    };
    let tips: Vec<Vector3<f64>> = rows.iter().map(tip).collect();
    let pivot = pivot_of(&tips).ok_or_else(|| {
        let hint = "the joint positions at each reading, along a circle or on a sphere";
        refused("no pivot is found from these joint positions".to_owned(), hint)
    })?;
    let radius = rows.iter().filter_map(|row| row.radius).sum::<f64>() / rows.len() as f64;
    let farthest = tips.iter().map(|tip| ((tip - pivot).norm() - radius).abs());
    let farthest = farthest.fold(0.0, f64::max);
    if farthest > FARTHEST_READING {
        return Err(refused(
            format!(
                "the robot file is {:.1} mm from a reading of the ball-bar",
                to_mm(farthest)
            ),
            "joint positions and readings of one row belong together; point_mm is the centre of the ball in the flange frame",
        ));
    }
    let pose = |row: &ConditionRow| MeasuredPose {
        joints: row.joints.clone(),
        position: Vector3::zeros(),
        rotation: None,
    };
    Ok(Campaign::Positions(Positions {
        poses: rows.iter().map(pose).collect(),
        conditions: rows.iter().map(|row| row.condition.clone()).collect(),
        flange_from_point,
        point: Known::Approximately,
        standard_uncertainty: u,
        turn_length: 1.0,
        observed: Observed::Distances(Distances {
            lengths: rows.iter().filter_map(|row| row.radius).collect(),
            pivot,
            is_calibrated,
        }),
    }))
}

fn open(shown: &str, path: &Path) -> Result<input::InputFile, StudyError> {
    input::open(path).map_err(|error| not_read(shown, &error))
}

fn not_read(shown: &str, error: &std::io::Error) -> StudyError {
    StudyError::value(
        format!("cannot read {shown}: {error}"),
        "files are relative to the journal",
    )
}

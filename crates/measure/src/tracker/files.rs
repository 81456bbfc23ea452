//! The files of a tracker and of a controller.

use std::path::{Path, PathBuf};

use armill_core::measure::reflectors::Readings;
use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;
use armill_core::units::{from_deg, from_mm};
use armill_formats::input;
use armill_formats::measurement::bodies::{self, Bodies};
use armill_formats::measurement::numbers::{self, Columns};
use armill_study::StudyError;

/// Unit of the joint positions in a file of numbers; of prismatic joints mm and m.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointUnit {
    /// deg and mm.
    Degree,
    /// rad and m.
    Radian,
}

/// The files that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Files {
    /// One file of a measured body, of one point or, without titles, of three reflectors in its first nine columns; or three of reflectors.
    pub measured: Vec<PathBuf>,
    /// Three reflectors on the base, measured with every pose.
    pub base: Option<[PathBuf; 3]>,
    /// Joint positions, in the last columns; without it they are in the file of the body or of the three reflectors.
    pub joints: Option<PathBuf>,
    /// Their unit.
    pub joint_unit: JointUnit,
}

/// Reads a file.
///
/// # Errors
/// It cannot be read.
fn bytes(path: &Path) -> Result<(String, Vec<u8>), StudyError> {
    let shown = path.display().to_string();
    let read = input::read(path).map_err(|error| {
        StudyError::value(
            format!("cannot read {shown}: {error}"),
            "a table of the tracker or of the controller, one row per pose",
        )
    })?;
    Ok((shown, read))
}

/// The body in the one file that is given.
pub(super) fn body(path: &Path, robot: &Robot) -> Result<Bodies, StudyError> {
    let (shown, bytes) = bytes(path)?;
    Ok(bodies::read(&shown, &bytes, robot)?)
}

/// Readings of three reflectors, m, in one file without titles: mm in its first nine columns. None of a file with titles.
pub(super) fn three_in_one(path: &Path) -> Result<Option<Vec<Readings>>, StudyError> {
    let (shown, bytes) = bytes(path)?;
    if !numbers::is_without_titles(&bytes, 9) {
        return Ok(None);
    }
    let rows = numbers::read(&shown, &bytes, Columns::First(9))?;
    let readings = |row: &Vec<f64>| {
        [0, 3, 6].map(|first: usize| Vector3::from_column_slice(&row[first..first + 3]).map(from_mm))
    };
    Ok(Some(rows.iter().map(readings).collect()))
}

/// Readings of three reflectors, m, one row each in three files: mm in the first three columns.
pub(super) fn reflectors(paths: &[PathBuf; 3]) -> Result<Vec<Readings>, StudyError> {
    let mut three = Vec::new();
    for path in paths {
        let (shown, bytes) = bytes(path)?;
        let rows = numbers::read(&shown, &bytes, Columns::First(3))?;
        let points: Vec<Vector3<f64>> = rows
            .iter()
            .map(|row| Vector3::new(row[0], row[1], row[2]).map(from_mm))
            .collect();
        three.push((shown, points));
    }
    same_rows(three.iter().map(|(file, points)| (file.as_str(), points.len())))?;
    let count = three[0].1.len();
    Ok((0..count)
        .map(|row| [0, 1, 2].map(|file: usize| three[file].1[row]))
        .collect())
}

/// Joint positions, rad or m.
pub(super) fn joints(path: &Path, robot: &Robot, unit: JointUnit) -> Result<Vec<Vec<f64>>, StudyError> {
    let (shown, bytes) = bytes(path)?;
    let rows = numbers::read(&shown, &bytes, Columns::Last(robot.joints().len()))?;
    let si = |(joint, value): (usize, f64)| match (unit, robot.slides(joint)) {
        (JointUnit::Degree, false) => from_deg(value),
        (JointUnit::Degree, true) => from_mm(value),
        (JointUnit::Radian, _) => value,
    };
    let found: Vec<Vec<f64>> = rows
        .into_iter()
        .map(|row| row.into_iter().enumerate().map(si).collect())
        .collect();
    let most = found.iter().flatten().enumerate().find(|(k, value)| {
        !robot.slides(k % robot.joints().len()) && value.abs() > 4.0 * std::f64::consts::PI
    });
    match most {
        None => Ok(found),
        Some((k, _)) => Err(StudyError::value(
            format!(
                "{shown}: a joint position of row {} is more than two turns",
                k / robot.joints().len() + 1
            ),
            "positions in degrees are the default; radians: --joint-unit rad",
        )),
    }
}

/// Refuses files with different numbers of rows.
pub(super) fn same_rows<'a>(files: impl Iterator<Item = (&'a str, usize)>) -> Result<(), StudyError> {
    let all: Vec<(&str, usize)> = files.collect();
    match all.iter().find(|(_, rows)| *rows != all[0].1) {
        None => Ok(()),
        Some((file, rows)) => Err(StudyError::value(
            format!("{} has {} rows, {file} has {rows}", all[0].0, all[0].1),
            "the files belong together row by row: remove the rows that are missing in one of them from all",
        )),
    }
}

//! Settings, and reading the logs.

use std::io::BufReader;
use std::path::Path;

use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;
use armill_formats::input;
use armill_formats::measurement::joint_log::{self, JointLog, LogReadOptions};
use armill_study::StudyError;

use super::spikes::without_spikes;

/// What is asked of the logs.
#[derive(Clone, Debug, Default)]
pub struct Question {
    /// Units that the headers do not give.
    pub units: LogReadOptions,
    /// From the flange to the tip, flange axes, m; none: the tip is fitted.
    pub tip: Option<Vector3<f64>>,
    /// Radius of the zone, m, at the corners of each compared log; 0: stops; empty: fitted.
    pub zones: Vec<f64>,
}

/// A log with the name of its file.
#[derive(Clone, Debug)]
pub struct NamedLog {
    /// Its file.
    pub file: String,
    /// Its content.
    pub log: JointLog,
}

/// Reads a log of `robot`.
///
/// # Errors
/// A robot with prismatic joints; a file that cannot be read; its problems.
pub fn read(path: &Path, robot: &Robot, question: &Question) -> Result<NamedLog, StudyError> {
    let file = path.display().to_string();
    let joints = robot.joints().len();
    if let Some(slides) = (0..joints).find(|joint| robot.slides(*joint)) {
        return Err(StudyError::value(
            format!(
                "joint {} of {} is prismatic; only logs of revolute joints are evaluated",
                robot.joints()[slides].name,
                robot.name()
            ),
            "give a robot file of the arm without its external axes",
        ));
    }
    let opened = input::open(path).map_err(|error| {
        StudyError::value(
            format!("cannot read {file}: {error}"),
            "a table with the time and the position of each joint: time_s, J1_deg, ...",
        )
    })?;
    let mut log = joint_log::read(&file, BufReader::new(opened), joints, question.units)?;
    let spikes = without_spikes(&mut log);
    if spikes > 0 {
        let instants = if spikes == 1 { "instant" } else { "instants" };
        log.notes.push(format!(
            "{spikes} {instants} whose joint positions do not belong together: left out"
        ));
    }
    Ok(NamedLog { file, log })
}

//! Settings of a calibration, and reading of its poses.

use std::io::BufReader;
use std::path::{Path, PathBuf};

use armill_core::calibrate::{self, ParameterSet, Prior};
use armill_core::frame::Isometry;
use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;
use armill_formats::input;
use armill_formats::measurement::poses::{self, MeasuredPoses, PoseReadOptions};
use armill_study::StudyError;

/// The validation poses.
#[derive(Clone, Debug, PartialEq)]
pub enum ValidationPoses {
    /// None.
    Nothing,
    /// This part of the file, evenly spread over it.
    Fraction(f64),
    /// Another file; `same_set_up` means that the tracker and the measured point had the same position.
    File {
        /// Where it is.
        path: PathBuf,
        /// Values that it does not give.
        given: PoseReadOptions,
        /// Otherwise base and point are fitted again for it.
        same_set_up: bool,
    },
}

/// Settings of a calibration.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// Of the chain.
    pub requested: ParameterSet,
    /// About where the measured point is, flange frame, m.
    pub tool_point: Vector3<f64>,
    /// Length in metres with the weight of one radian; without it orientations are not used.
    pub turn_length: Option<f64>,
    /// What is known of small motions of the chain before they are measured.
    pub prior: Option<Prior>,
}

impl Question {
    /// The question to the core.
    pub(crate) fn for_core(&self, requested: ParameterSet) -> calibrate::Question {
        calibrate::Question {
            requested,
            flange_from_point: Isometry::from_parts(self.tool_point.into(), Default::default()),
            // Without orientations the weight has no effect.
            turn_length: self.turn_length.unwrap_or(1.0),
            prior: self.prior,
        }
    }
}

/// Reads the poses of `robot` in `path`; `shown` is its name in problems. Orientations are read if `turns` is set.
///
/// # Errors
/// The file cannot be read; its problems; orientations that are requested but missing.
pub fn read(
    shown: &str,
    path: &Path,
    robot: &Robot,
    given: &PoseReadOptions,
    question: &Question,
) -> Result<MeasuredPoses, StudyError> {
    let file = input::open(path).map_err(|error| {
        StudyError::value(
            format!("cannot read {shown}: {error}"),
            "a table with joint positions and measured points: q1_deg, ..., x_mm, y_mm, z_mm",
        )
    })?;
    let mut measured = poses::read(shown, BufReader::new(file), robot, given)?;
    if question.turn_length.is_none() {
        measured.poses.iter_mut().for_each(|pose| pose.rotation = None);
    } else if measured.poses.iter().any(|pose| pose.rotation.is_none()) {
        return Err(StudyError::value(
            format!("--turns: {shown} has no orientations"),
            "columns rx_deg, ry_deg, rz_deg, or leave --turns out",
        ));
    }
    Ok(measured)
}

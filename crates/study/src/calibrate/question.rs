//! What is asked of measured poses, and where they are read from.

use std::io::BufReader;
use std::path::{Path, PathBuf};

use armill_core::calibrate::{self, Asked, Prior};
use armill_core::frame::Isometry;
use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;
use armill_formats::input;
use armill_formats::measurement::poses::{self, MeasuredPoses, PoseReadOptions};

use crate::StudyError;

/// Which poses judge what the others found.
#[derive(Clone, Debug, PartialEq)]
pub enum HoldOut {
    /// None.
    Nothing,
    /// This part of the file, evenly spread over it.
    Fraction(f64),
    /// Another file; `same_set_up` says that tracker and measured point stayed where they were.
    File {
        /// Where it is.
        path: PathBuf,
        /// Else base and point are found anew for it.
        same_set_up: bool,
    },
}

/// What is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// Of the chain.
    pub requested: Asked,
    /// About where the measured point is, flange frame, m.
    pub tool_point: Vector3<f64>,
    /// So many metres count as much as a radian of turn; without it turns are passed over.
    pub turn_length: Option<f64>,
    /// What is known of small motions of the chain before they are measured.
    pub prior: Option<Prior>,
}

impl Question {
    /// In the words of the core.
    pub(crate) fn for_core(&self, requested: Asked) -> calibrate::Question {
        calibrate::Question {
            requested,
            flange_from_point: Isometry::from_parts(self.tool_point.into(), Default::default()),
            // Where no turn is given, nothing is weighed by it.
            turn_length: self.turn_length.unwrap_or(1.0),
            prior: self.prior,
        }
    }
}

/// Reads the poses of `robot` in `path`; `shown` is what problems call it. Turns are kept if `turns` says so.
///
/// # Errors
/// The file cannot be read; its problems; turns that are asked for and not there.
pub fn read(
    (shown, path): (&str, &Path),
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
            format!("--turns: {shown} tells no turns"),
            "columns rx_deg, ry_deg, rz_deg, or leave --turns out",
        ));
    }
    Ok(measured)
}

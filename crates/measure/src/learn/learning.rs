//! Calibration and residual from all poses, and how far they carry to poses that were not used.

use std::path::PathBuf;

use armill_core::calibrate::{Calibrated, ParameterSet, Refusal, fit};
use armill_core::learn::{self, FewPoses, HeldOut, Models, OtherSetUp, held_out, on_other_poses};
use armill_core::robot::learnt::{Learnt, ResidualAt};
use armill_core::robot::{LearntError, Robot};
use armill_core::watch::{Cancelled, Watch};
use armill_formats::measurement::poses::{MeasuredPoses, PoseReadOptions};
use armill_study::StudyError;

use crate::calibrate;

/// Settings.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// Of the calibration.
    pub calibration: calibrate::Question,
    /// Number of stretches of the file of poses, each held out once.
    pub stretches: usize,
    /// Poses measured from another position of the tracker.
    pub other: Option<OtherPoses>,
}

/// Poses measured from another position of the tracker.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherPoses {
    /// Their file.
    pub path: PathBuf,
    /// Values that it does not give.
    pub given: PoseReadOptions,
    /// What is found from them.
    pub set_up: OtherSetUp,
}

/// What was learnt, and how it was tried.
#[derive(Clone, Debug)]
pub struct Learning {
    /// File of the poses.
    pub file: String,
    /// The calibration of all poses.
    pub calibrated: Calibrated,
    /// What it leaves.
    pub residuals: Vec<ResidualAt>,
    /// The residual learnt from these.
    pub learnt: Learnt,
    /// Errors of poses held out.
    pub held_out: HeldOut,
    /// The file of other poses, and their errors.
    pub other: Option<(String, HeldOut)>,
    /// Columns that were passed over.
    pub unused: Vec<String>,
}

/// Learns from the poses of `measured`, the file `shown`. The watch counts poses.
///
/// # Errors
/// Poses that determine too little or belong to another robot; other poses that cannot be read; cancellation.
pub fn learn(
    robot: &Robot,
    shown: &str,
    measured: &MeasuredPoses,
    question: &Question,
    watch: Watch<'_>,
) -> Result<Learning, StudyError> {
    let poses = &measured.poses;
    let for_core = question.calibration.for_core(question.calibration.requested);
    let refused = |error: &Refusal| calibrate::calibration::refused(shown, error);
    let held_out = held_out(robot, poses, &for_core, question.stretches, watch)
        .map_err(|error| not_held_out(shown, &error))?;
    let calibrated = fit(robot, poses, &for_core).map_err(|error| refused(&error))?;
    let residuals = learn::residuals(robot, &calibrated, poses).map_err(|error| refused(&error))?;
    let learnt = learn::learn(robot, &residuals).map_err(|error| not_learnt(shown, &error))?;
    let other = match &question.other {
        None => None,
        Some(other) => {
            let file = other.path.display().to_string();
            let read = calibrate::read(&file, &other.path, robot, &other.given, &question.calibration)?;
            let frames = question.calibration.for_core(ParameterSet::BaseAndTool);
            let models = Models {
                nominal: &fit(robot, poses, &frames).map_err(|error| refused(&error))?,
                calibrated: &calibrated,
                learnt: &learnt,
            };
            let found = on_other_poses(robot, models, other.set_up, &read.poses, &for_core);
            let found = found.map_err(|error| not_predicted(&file, &error))?;
            Some((file, found))
        }
    };
    Ok(Learning {
        file: shown.to_owned(),
        calibrated,
        residuals,
        learnt,
        held_out,
        other,
        unused: measured.unused.clone(),
    })
}

fn not_predicted(file: &str, error: &Refusal) -> StudyError {
    match error {
        Refusal::NotFound => StudyError::value(
            format!("--other: the poses of {file} hardly determine the measured point"),
            "--same-point if it was not mounted again; or measured orientations (--turns)",
        ),
        _ => calibrate::calibration::refused(file, error),
    }
}

fn not_held_out(shown: &str, error: &FewPoses) -> StudyError {
    match error {
        FewPoses::Cancelled => Cancelled.into(),
        FewPoses::Calibration { error, .. } => calibrate::calibration::refused(shown, error),
        FewPoses::Learnt(error) => not_learnt(shown, error),
        FewPoses::Stretches(..) => StudyError::value(
            format!("--stretches: {shown}: {error}"),
            "at least two poses a stretch, and two stretches; some hundred poses are usual",
        ),
    }
}

fn not_learnt(shown: &str, error: &LearntError) -> StudyError {
    StudyError::value(
        format!("{shown}: {error}"),
        "poses at rest, spread over the postures of later work",
    )
}

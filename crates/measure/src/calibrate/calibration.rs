//! The fits: base and tool only, for the robot file as it is, and all requested parameters; each evaluated with the
//! training poses and the validation poses.

use armill_core::calibrate::{Calibrated, MeasuredPose, ParameterSet, PoseErrors, Refusal, fit};
use armill_core::robot::Robot;
use armill_core::units::to_mm;
use armill_formats::measurement::poses::MeasuredPoses;
use armill_study::StudyError;

use super::question::{Question, ValidationPoses, read};
use crate::data_check::{self, SlipAnswer};

/// Fewest training and validation poses for a fraction.
const FEWEST: usize = 4;

/// Poses of one kind, with their errors before and after.
#[derive(Clone, Debug)]
pub struct PoseSet {
    /// Their file.
    pub file: String,
    /// Their lines, from 1.
    pub lines: Vec<usize>,
    /// Errors with the robot file unchanged.
    pub before: PoseErrors,
    /// By the calibrated chain.
    pub after: PoseErrors,
    /// Whether base and tool were fitted again for these poses.
    pub frames_refitted: bool,
    /// Poses with a joint beyond the range of the training poses.
    pub beyond: usize,
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct Calibration {
    /// Base and tool only, the chain unchanged.
    pub before: Calibrated,
    /// With the requested parameters of the chain.
    pub after: Calibrated,
    /// Training poses.
    pub training: PoseSet,
    /// Validation poses.
    pub validation: Option<PoseSet>,
    /// The likely slip in the data.
    pub slip: Option<SlipAnswer>,
    /// Columns that were passed over.
    pub unused: Vec<String>,
    /// Rows without a measured point.
    pub not_measured: usize,
}

/// Calibrates `robot` by the poses of `measured`, the file `shown`.
///
/// # Errors
/// Poses that determine too little or belong to another robot; validation poses that cannot be read or are too few.
pub fn calibrate(
    robot: &Robot,
    shown: &str,
    measured: &MeasuredPoses,
    question: &Question,
    validation: &ValidationPoses,
) -> Result<Calibration, StudyError> {
    let (kept, apart) = parted(shown, measured.poses.len(), validation)?;
    let chosen = |places: &[usize]| -> Vec<MeasuredPose> {
        places
            .iter()
            .map(|place| measured.poses[*place].clone())
            .collect()
    };
    let lines = |places: &[usize]| places.iter().map(|place| measured.lines[*place]).collect();
    let poses = chosen(&kept);
    let by = |poses: &[MeasuredPose], requested| fit(robot, poses, &question.for_core(requested));
    let check = || {
        let frames = question.for_core(ParameterSet::BaseAndTool);
        data_check::poses::slip(robot, &measured.poses, &measured.lines, &frames)
    };
    let not_found = |error: Refusal| match &error {
        Refusal::NotFound => refused_by(shown, &error, check().as_ref()),
        _ => refused(shown, &error),
    };
    let before = by(&poses, ParameterSet::BaseAndTool).map_err(not_found)?;
    let after = by(&poses, question.requested).map_err(not_found)?;
    let training = PoseSet {
        file: shown.to_owned(),
        lines: lines(&kept),
        before: before.errors.clone(),
        after: after.errors.clone(),
        frames_refitted: false,
        beyond: 0,
    };
    let found_from = poses;
    let evaluated = |file: &str, poses: &[MeasuredPose], lines| -> Result<PoseSet, StudyError> {
        let errors = |of: &Calibrated| of.errors_of(robot, poses).map_err(|error| refused(file, &error));
        Ok(PoseSet {
            file: file.to_owned(),
            lines,
            before: errors(&before)?,
            after: errors(&after)?,
            frames_refitted: false,
            beyond: beyond(&found_from, poses),
        })
    };
    let validation = match validation {
        ValidationPoses::Nothing => None,
        ValidationPoses::Fraction(_) => Some(evaluated(shown, &chosen(&apart), lines(&apart))?),
        ValidationPoses::File {
            path,
            given,
            same_set_up,
        } => {
            let file = path.display().to_string();
            let other = read(&file, path, robot, given, question)?;
            Some(match same_set_up {
                true => evaluated(&file, &other.poses, other.lines)?,
                false => PoseSet {
                    beyond: beyond(&found_from, &other.poses),
                    ..elsewhere(robot, &after, &file, other, question)?
                },
            })
        }
    };
    Ok(Calibration {
        before,
        after,
        training,
        validation,
        slip: check(),
        unused: measured.unused.clone(),
        not_measured: measured.not_measured,
    })
}

impl Calibration {
    /// Whether the calibrated chain may be written to a robot file.
    ///
    /// # Errors
    /// Data with a likely slip; validation poses that the calibrated chain predicts worse than the nominal one.
    pub fn check_usable(&self) -> Result<(), StudyError> {
        if let Some(slip) = &self.slip {
            return Err(StudyError::value(
                format!("--out: the calibration is not usable: {}", slip.sentence()),
                "correct the data, or leave --out out to see the result",
            ));
        }
        let rms = |errors: &PoseErrors| errors.of_position().map(|spread| spread.rms);
        let of = |set: &PoseSet| rms(&set.before).zip(rms(&set.after));
        let Some((before, after)) = self.validation.as_ref().and_then(of) else {
            return Ok(());
        };
        if after > MOST_WORSE * before {
            return Err(StudyError::value(
                format!(
                    "--out: the calibration is not usable: validation poses are missed by {:.3} mm rms, {:.3} mm with the robot file as it is",
                    to_mm(after),
                    to_mm(before)
                ),
                "more training poses, over the same range of the joints; or fewer parameters: --unknowns zeros",
            ));
        }
        Ok(())
    }
}

/// Errors of validation poses over those before, above which a calibration makes no robot file.
const MOST_WORSE: f64 = 1.3;

/// Poses measured in another set-up: base and tool are fitted again, for both chains.
fn elsewhere(
    robot: &Robot,
    after: &Calibrated,
    file: &str,
    other: MeasuredPoses,
    question: &Question,
) -> Result<PoseSet, StudyError> {
    let calibrated = after
        .bare_robot(robot)
        .map_err(|error| StudyError::value(error.to_string(), "do these poses belong to this robot?"))?;
    let errors = |robot: &Robot| {
        let found = fit(robot, &other.poses, &question.for_core(ParameterSet::BaseAndTool));
        found
            .map(|found| found.errors)
            .map_err(|error| refused(file, &error))
    };
    Ok(PoseSet {
        file: file.to_owned(),
        before: errors(robot)?,
        after: errors(&calibrated)?,
        lines: other.lines,
        frames_refitted: true,
        beyond: 0,
    })
}

/// Number of `poses` with a joint beyond the range of `found_from`.
fn beyond(found_from: &[MeasuredPose], poses: &[MeasuredPose]) -> usize {
    let range = |joint: usize| {
        let all = found_from.iter().map(move |pose| pose.joints[joint]);
        all.fold([f64::MAX, f64::MIN], |[low, high], q| [low.min(q), high.max(q)])
    };
    let joints = found_from.first().map_or(0, |pose| pose.joints.len());
    let ranges: Vec<[f64; 2]> = (0..joints).map(range).collect();
    let is_beyond = |pose: &&MeasuredPose| {
        let mut both = pose.joints.iter().zip(&ranges);
        both.any(|(q, [low, high])| q < low || q > high)
    };
    poses.iter().filter(is_beyond).count()
}

/// Which of `count` poses are used for training, and which for validation.
fn parted(
    shown: &str,
    count: usize,
    validation: &ValidationPoses,
) -> Result<(Vec<usize>, Vec<usize>), StudyError> {
    let ValidationPoses::Fraction(fraction) = validation else {
        return Ok(((0..count).collect(), Vec::new()));
    };
    // A pose is used for validation wherever the sum of fractions passes a whole number.
    let whole = |places: usize| (places as f64 * fraction).floor();
    let (apart, kept): (Vec<usize>, Vec<usize>) =
        (0..count).partition(|place| whole(place + 1) > whole(*place));
    if apart.len() < FEWEST || kept.len() < FEWEST {
        return Err(StudyError::value(
            format!(
                "--validation: {fraction} of the {count} poses of {shown} leaves {} for training and {} for validation",
                kept.len(),
                apart.len()
            ),
            format!("at least {FEWEST} of each"),
        ));
    }
    Ok((kept, apart))
}

/// What the core refuses, of a file with this likely slip.
pub(crate) fn refused_by(shown: &str, error: &Refusal, slip: Option<&SlipAnswer>) -> StudyError {
    match slip {
        Some(slip) => StudyError::value(
            format!(
                "{shown}: no geometry near the nominal one was found; {}",
                slip.sentence()
            ),
            "correct the data",
        ),
        None => refused(shown, error),
    }
}

/// What the core refuses, of a file.
pub(crate) fn refused(shown: &str, error: &Refusal) -> StudyError {
    StudyError::value(
        format!("{shown}: {error}"),
        "some ten poses more than unknowns, spread over all the room, of the robot that the file names",
    )
}

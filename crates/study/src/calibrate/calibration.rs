//! The fits: base and tool alone, which is the arm as its file says, and all that was asked; each judged by the poses
//! that it was found from and by those held out.

use armill_core::calibrate::{Asked, Calibrated, MeasuredPose, PoseErrors, Refusal, fit};
use armill_core::robot::Robot;
use armill_formats::measurement::poses::{MeasuredPoses, PoseReadOptions};

use super::question::{HoldOut, Question, read};
use crate::StudyError;

/// Fewest poses on either side of a fraction held out.
const FEWEST: usize = 4;

/// Poses of one kind, with their errors before and after.
#[derive(Clone, Debug)]
pub struct Set {
    /// The file they stand in.
    pub file: String,
    /// Their lines, from 1.
    pub lines: Vec<usize>,
    /// By the robot file as it is.
    pub before: PoseErrors,
    /// By the calibrated chain.
    pub after: PoseErrors,
    /// Whether base and tool were found anew for these poses.
    pub frames_refitted: bool,
    /// Poses with a joint beyond the range of the poses that the geometry was found from.
    pub beyond: usize,
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct Calibration {
    /// Base and tool, the chain as it is.
    pub before: Calibrated,
    /// With what was asked of the chain.
    pub after: Calibrated,
    /// Poses that it was found from.
    pub training: Set,
    /// Poses that judge it.
    pub held_out: Option<Set>,
    /// Columns that were passed over.
    pub unused: Vec<String>,
    /// Rows without a measured point.
    pub not_measured: usize,
}

/// Calibrates `robot` by the poses of `measured`, the file `shown`.
///
/// # Errors
/// Poses that tell too little or belong to another arm; a hold-out that cannot be read or leaves too few.
pub fn calibrate(
    robot: &Robot,
    (shown, measured): (&str, &MeasuredPoses),
    question: &Question,
    (hold_out, given): (&HoldOut, &PoseReadOptions),
) -> Result<Calibration, StudyError> {
    let (kept, apart) = parted(shown, measured.poses.len(), hold_out)?;
    let chosen = |places: &[usize]| -> Vec<MeasuredPose> {
        places
            .iter()
            .map(|place| measured.poses[*place].clone())
            .collect()
    };
    let lines = |places: &[usize]| places.iter().map(|place| measured.lines[*place]).collect();
    let poses = chosen(&kept);
    let by = |poses: &[MeasuredPose], requested| fit(robot, poses, &question.for_core(requested));
    let before = by(&poses, Asked::BaseAndTool).map_err(|error| refused(shown, &error))?;
    let after = by(&poses, question.requested).map_err(|error| refused(shown, &error))?;
    let training = Set {
        file: shown.to_owned(),
        lines: lines(&kept),
        before: before.errors.clone(),
        after: after.errors.clone(),
        frames_refitted: false,
        beyond: 0,
    };
    let found_from = poses;
    let judged = |file: &str, poses: &[MeasuredPose], lines| -> Result<Set, StudyError> {
        let errors = |of: &Calibrated| of.errors_of(robot, poses).map_err(|error| refused(file, &error));
        Ok(Set {
            file: file.to_owned(),
            lines,
            before: errors(&before)?,
            after: errors(&after)?,
            frames_refitted: false,
            beyond: beyond(&found_from, poses),
        })
    };
    let held_out = match hold_out {
        HoldOut::Nothing => None,
        HoldOut::Fraction(_) => Some(judged(shown, &chosen(&apart), lines(&apart))?),
        HoldOut::File { path, same_set_up } => {
            let file = path.display().to_string();
            let other = read((&file, path), robot, given, question)?;
            Some(match same_set_up {
                true => judged(&file, &other.poses, other.lines)?,
                false => Set {
                    beyond: beyond(&found_from, &other.poses),
                    ..elsewhere(robot, &after, (&file, other), question)?
                },
            })
        }
    };
    Ok(Calibration {
        before,
        after,
        training,
        held_out,
        unused: measured.unused.clone(),
        not_measured: measured.not_measured,
    })
}

/// Poses measured from another place: base and tool are found anew, alike for both chains.
fn elsewhere(
    robot: &Robot,
    after: &Calibrated,
    (file, other): (&str, MeasuredPoses),
    question: &Question,
) -> Result<Set, StudyError> {
    let calibrated = after
        .bare_robot(robot)
        .map_err(|error| StudyError::value(error.to_string(), "do these poses belong to this robot?"))?;
    let errors = |robot: &Robot| {
        let found = fit(robot, &other.poses, &question.for_core(Asked::BaseAndTool));
        found
            .map(|found| found.errors)
            .map_err(|error| refused(file, &error))
    };
    Ok(Set {
        file: file.to_owned(),
        before: errors(robot)?,
        after: errors(&calibrated)?,
        lines: other.lines,
        frames_refitted: true,
        beyond: 0,
    })
}

/// How many of `poses` have a joint beyond the range of `found_from`.
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

/// Which of `count` poses calibrate, and which judge.
fn parted(shown: &str, count: usize, hold_out: &HoldOut) -> Result<(Vec<usize>, Vec<usize>), StudyError> {
    let HoldOut::Fraction(fraction) = hold_out else {
        return Ok(((0..count).collect(), Vec::new()));
    };
    // One is set apart wherever the sum of fractions passes a whole number.
    let whole = |places: usize| (places as f64 * fraction).floor();
    let (apart, kept): (Vec<usize>, Vec<usize>) =
        (0..count).partition(|place| whole(place + 1) > whole(*place));
    if apart.len() < FEWEST || kept.len() < FEWEST {
        return Err(StudyError::value(
            format!(
                "--hold-out: {fraction} of the {count} poses of {shown} leaves {} and {}",
                kept.len(),
                apart.len()
            ),
            format!("at least {FEWEST} on either side"),
        ));
    }
    Ok((kept, apart))
}

/// What the core refuses, of a file.
pub(crate) fn refused(shown: &str, error: &Refusal) -> StudyError {
    StudyError::value(
        format!("{shown}: {error}"),
        "some ten poses more than unknowns, spread over all the room, of the robot that the file names",
    )
}

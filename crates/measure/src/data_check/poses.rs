//! Data check of measured poses: mirrored axes, units, signs, zeros and order of the joints, one gross outlier.
//!
//! The residual is the root mean square error of the positions with base and measured point fitted, and the chain of the
//! robot file. The axes of the tracker are free: a rotated frame is no slip, and all mirrored ones look alike.

use armill_core::calibrate::{MeasuredPose, Question, fit};
use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;

use super::joints::JointChange;
use super::{BETTER, SlipAnswer, Trial, likely_slip};

/// Units that were read as mm, by their size in mm; positions are then too small or too large by it.
const UNITS: [(&str, f64); 4] = [
    ("positions in m, not in mm", 1e3),
    ("positions in um, not in mm", 1e-3),
    ("positions in inches, not in mm", 25.4),
    ("positions in cm, not in mm", 10.0),
];
/// Poses with the largest errors that may be gross outliers.
const SUSPECTS: usize = 5;
/// A residual below this is the accuracy of a robot whose chain is nominal, m: no slip.
const ACCURATE: f64 = 3e-3;
/// More poses than these give no further knowledge of a slip.
const MOST_POSES: usize = 200;

/// The likely slip of `poses`, at these lines of their file; none of poses that the nominal chain predicts well.
/// `question` asks for base and tool only.
pub fn slip(
    robot: &Robot,
    poses: &[MeasuredPose],
    lines: &[usize],
    question: &Question,
) -> Option<SlipAnswer> {
    let thinned = poses.len().div_ceil(MOST_POSES).max(1);
    let (poses, lines): (Vec<MeasuredPose>, Vec<usize>) = poses
        .iter()
        .zip(lines)
        .step_by(thinned)
        .map(|(pose, line)| {
            // Positions alone decide: orientations mirror differently.
            let pose = MeasuredPose {
                rotation: None,
                ..pose.clone()
            };
            (pose, *line)
        })
        .unzip();
    let errors = |poses: &[MeasuredPose]| fit(robot, poses, question).ok().map(|found| found.errors);
    let residual = |poses: &[MeasuredPose]| {
        let spread = errors(poses).and_then(|errors| errors.of_position());
        spread.map_or(f64::INFINITY, |spread| spread.rms)
    };
    let as_given = residual(&poses);
    if as_given < ACCURATE {
        return None;
    }
    let trial = |change: String, of: &dyn Fn(&MeasuredPose) -> MeasuredPose| {
        let changed: Vec<MeasuredPose> = poses.iter().map(of).collect();
        Trial {
            change,
            residual: residual(&changed),
        }
    };
    let moved = |pose: &MeasuredPose, position: Vector3<f64>| MeasuredPose {
        position,
        ..pose.clone()
    };
    let mirrored = "measured points mirrored (one of x, y, z negated, or two columns exchanged)";
    let mut trials = vec![trial(mirrored.to_owned(), &|pose| {
        let [x, y, z] = pose.position.into();
        moved(pose, Vector3::new(-x, y, z))
    })];
    for (words, factor) in UNITS {
        trials.push(trial(words.to_owned(), &|pose| {
            moved(pose, pose.position * factor)
        }));
    }
    for change in JointChange::all(robot) {
        trials.push(trial(change.words(robot), &|pose| MeasuredPose {
            joints: change.of(robot, &pose.joints),
            ..pose.clone()
        }));
    }
    if let Some(errors) = errors(&poses) {
        let mut order: Vec<usize> = (0..poses.len()).collect();
        order.sort_by(|a, b| errors.position[*b].norm().total_cmp(&errors.position[*a].norm()));
        for place in order.into_iter().take(SUSPECTS) {
            let mut others = poses.clone();
            others.remove(place);
            trials.push(Trial {
                change: format!("line {} left out", lines[place]),
                residual: residual(&others),
            });
        }
    }
    likely_slip(as_given, BETTER, &trials)
}

//! Speeds and accelerations that the joints reached: lower bounds of what they can.

use armill_core::motion::MotionModel;
use armill_formats::measurement::joint_log::JointLog;

use super::derivative::Differentiator;
use super::fit::LearntModel;
use super::observed::{Observed, largest_of_three};
use super::simulate::{motion, with};
use super::stretches::Stretch;

/// Half of the window of accelerations, usual steps: the noise of a second derivative falls with the fifth power of the square root of it.
pub(super) const HALF_OF_ACCELERATION: f64 = 5.5;
/// Fewest instants at rest from which the noise is determined.
const FEWEST: usize = 20;

/// What a joint reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointReached {
    /// Largest speed, rad/s.
    pub speed: f64,
    /// Largest acceleration, rad/s^2.
    pub acceleration: f64,
    /// Standard deviation of the acceleration at rest, rad/s^2; none where the log has too few instants at rest.
    pub noise: Option<f64>,
}

/// Largest acceleration of each joint in the command that was fitted, rad/s^2, before it is smoothed and followed: joints can do this as well.
pub(super) fn commanded(stretches: &[&Observed], model: &MotionModel, fitted: &LearntModel) -> Vec<f64> {
    let [acceleration, _, _, settling] = fitted.values;
    let mut sharp = with(model, [acceleration, 0.0, 0.0, settling]);
    sharp.motor_leads.clear();
    let joints = model.limits.joints.len();
    let mut largest = vec![0.0_f64; joints];
    for (stretch, feed) in stretches.iter().zip(&fitted.feeds) {
        let found = motion(stretch, &sharp, *feed, &vec![None; stretch.corners.len()]);
        let half = feed / acceleration / 4.0;
        let curvatures = Differentiator::new(&found.times, half).curvatures(&found.positions, joints);
        for (joint, largest) in largest.iter_mut().enumerate() {
            let own: Vec<f64> = curvatures.iter().skip(joint).step_by(joints).copied().collect();
            *largest = largest.max(largest_of_three(&own));
        }
    }
    largest
}

/// What each joint of a log reached.
pub(super) fn reached(log: &JointLog, speeds: &[f64], stretches: &[Stretch]) -> Vec<JointReached> {
    let by_time = Differentiator::new(&log.times, HALF_OF_ACCELERATION * log.usual_step());
    let accelerations = by_time.curvatures(&log.positions, log.joints);
    let column = |values: &[f64], joint: usize| -> Vec<f64> {
        values.iter().skip(joint).step_by(log.joints).copied().collect()
    };
    let at_rest: Vec<usize> = (0..log.times.len())
        .filter(|index| !stretches.iter().any(|stretch| stretch.range.contains(index)))
        .collect();
    (0..log.joints)
        .map(|joint| {
            let own = column(&accelerations, joint);
            let squares: f64 = at_rest.iter().map(|index| own[*index].powi(2)).sum();
            JointReached {
                speed: largest_of_three(&column(speeds, joint)),
                acceleration: largest_of_three(&own),
                noise: (at_rest.len() >= FEWEST).then(|| (squares / at_rest.len() as f64).sqrt()),
            }
        })
        .collect()
}

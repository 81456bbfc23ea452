//! Speeds and accelerations that the joints reached: lower bounds of what they can.

use armill_formats::measurement::joint_log::JointLog;

use super::derivative::Differentiator;
use super::observed::largest_of_three;
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

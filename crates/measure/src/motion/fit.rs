//! The acceleration along the path, the window and the lag with which the model has the speeds of a log, by least squares over all stretches that stop at their corners.

use armill_core::motion::MotionModel;

use super::least_squares::{Fitted, Parameter, least_squares};
use super::observed::Observed;
use super::simulate::{Arm, predicted, with};

/// Where the search begins: window and lag, s.
const START: [f64; 2] = [0.03, 0.01];
/// Least acceleration, m/s^2.
const LEAST: f64 = 0.05;

/// Values with their standard uncertainties.
#[derive(Clone, Debug)]
pub(super) struct LearntModel {
    /// Acceleration along the path, m/s^2, window, s, and lag, s.
    pub values: [f64; 3],
    /// Their standard uncertainties; infinite where the log does not determine them.
    pub u: [f64; 3],
    /// Correlation of window and lag.
    pub window_and_lag: f64,
    /// Feed of each stretch, m/s.
    pub feeds: Vec<f64>,
    /// Root mean square of the difference of the speeds, m/s.
    pub rms: f64,
}

/// The values for these stretches; the limits of the joints are those of `model`.
pub(super) fn fit(arm: Arm<'_>, stretches: &[&Observed], model: &MotionModel) -> LearntModel {
    let reached = stretches
        .iter()
        .map(|stretch| stretch.acceleration)
        .fold(LEAST, f64::max);
    let common = [
        Parameter {
            start: reached,
            step: 1e-3 * reached,
            least: LEAST,
        },
        Parameter {
            start: START[0],
            step: 5e-4,
            least: 0.0,
        },
        Parameter {
            start: START[1],
            step: 2e-4,
            least: 0.0,
        },
    ];
    let first = with(model, common.map(|parameter| parameter.start));
    let own = stretches.iter().flat_map(|stretch| {
        let begun = predicted(
            arm,
            stretch,
            &first,
            stretch.feed,
            &vec![None; stretch.corners.len()],
        );
        [
            Parameter {
                start: stretch.feed,
                step: 1e-3 * stretch.feed,
                least: 0.1 * stretch.feed,
            },
            Parameter {
                start: begun.start(stretch),
                step: 1e-3,
                least: f64::NEG_INFINITY,
            },
        ]
    });
    let parameters: Vec<Parameter> = common.into_iter().chain(own).collect();
    let found: Fitted = least_squares(&parameters, |p| {
        let model = with(model, [p[0], p[1], p[2]]);
        let all = stretches.iter().enumerate().flat_map(|(k, stretch)| {
            let (feed, start) = (p[3 + 2 * k], p[4 + 2 * k]);
            let stops = vec![None; stretch.corners.len()];
            predicted(arm, stretch, &model, feed, &stops).residuals(stretch, start)
        });
        all.collect()
    });
    LearntModel {
        values: [found.values[0], found.values[1], found.values[2]],
        u: [found.u[0], found.u[1], found.u[2]],
        window_and_lag: found.correlation[(1, 2)],
        feeds: (0..stretches.len()).map(|k| found.values[3 + 2 * k]).collect(),
        rms: found.rms,
    }
}

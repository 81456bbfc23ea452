//! The lead of the motors over their acceleration, from how far the logged tip leaves its lines.
//!
//! ```text
//! q_motor = q + c d2q/dt2        c = deflection of the drive under the forces of inertia / acceleration
//! ```
//!
//! Encoders stand on the motors. A controller that compensates the elastic deflection of its drives moves the motors ahead of the arm while it accelerates, and the tip that is computed
//! from the encoders leaves a line that the arm follows. `c` is the inertia about the axis over the stiffness of the drive: `1/omega^2` of a joint that vibrates alone.
//!
//! A lead that is common to all joints moves the tip along its line. The joints of the wrist move little mass: their leads are taken as zero.

use armill_core::nalgebra::{Point3, Vector3};

use super::fit::{Fitting, LearntModel, rms_of_vectors};
use super::least_squares::{Parameter, least_squares};
use super::observed::Observed;
use super::simulate::Predicted;

/// Joints of the wrist.
const WRIST: usize = 3;
/// Step of the derivatives, s^2.
const STEP: f64 = 1e-5;
/// Leads that leave more of the variance of the offsets explain nothing.
const MOST_LEFT: f64 = 0.25;
/// Smaller offsets need no explanation, m.
const LEAST: f64 = 2e-5;

/// Leads of the motors.
#[derive(Clone, Debug)]
pub(super) struct Leads {
    /// Of each joint, base to flange, s^2; zero of those of the wrist.
    pub values: Vec<f64>,
    /// Their standard uncertainties; infinite where the log does not determine them; none of the wrist.
    pub u: Vec<Option<f64>>,
    /// Root mean square of predicted less logged offsets from the lines, m: without leads, and with them.
    pub off_line: [f64; 2],
}

impl Leads {
    /// Joints before the wrist.
    pub(super) fn free(&self) -> usize {
        self.u.iter().flatten().count()
    }

    /// The same with other values of the joints before the wrist.
    pub(super) fn with(&self, values: &[f64], u: &[f64], left: f64) -> Leads {
        let of_wrist = self.values.len() - values.len();
        Leads {
            values: values.iter().copied().chain(vec![0.0; of_wrist]).collect(),
            u: u.iter().copied().map(Some).chain(vec![None; of_wrist]).collect(),
            off_line: [self.off_line[0], left],
        }
    }
}

/// The leads with which the model leaves the lines as the logs do, with the speeds that were fitted; `None` if they explain nothing.
pub(super) fn leads(fitting: &Fitting<'_>, fitted: &LearntModel) -> Option<Leads> {
    let joints = fitting.arm.robot.joints().len();
    let free = joints.saturating_sub(WRIST).max(1);
    let own = fitted.feeds.iter().zip(&fitted.starts);
    let common: Vec<f64> = fitted
        .values
        .into_iter()
        .chain(own.flat_map(|(feed, start)| [*feed, *start]))
        .collect();
    let offsets = |leads: &[f64]| fitting.offsets(&common, fitted.values.len(), leads);
    let parameter = Parameter {
        start: 0.0,
        step: STEP,
        least: f64::NEG_INFINITY,
    };
    let before = rms_of_vectors(&offsets(&vec![0.0; free]));
    let found = least_squares(&vec![parameter; free], offsets);
    let left = rms_of_vectors(&offsets(&found.values));
    let none = Leads {
        values: vec![0.0; joints],
        u: vec![None; joints],
        off_line: [before, before],
    };
    let explained = before > LEAST && left * left < MOST_LEFT * before * before;
    explained.then(|| none.with(&found.values, &found.u, left))
}

/// Predicted less logged offsets from the lines, m, three coordinates each, if the motion starts at the time `start`, s.
pub(super) fn off_lines(found: &Predicted, observed: &Observed, start: f64) -> Vec<f64> {
    let own = found.at_instants(observed, start);
    let pairs = own.iter().zip(&observed.tips);
    pairs
        .flat_map(|(own, logged)| {
            let difference = off_line(observed, own) - off_line(observed, logged);
            [difference.x, difference.y, difference.z]
        })
        .collect()
}

/// From the nearest of the lines of a stretch to a point, m.
fn off_line(stretch: &Observed, tip: &Point3<f64>) -> Vector3<f64> {
    let offsets = stretch.course.vertices.windows(2).map(|pair| {
        let (way, offset) = (pair[1] - pair[0], tip - pair[0]);
        let part = offset.dot(&way) / way.norm_squared().max(f64::MIN_POSITIVE);
        offset - way * part.clamp(0.0, 1.0)
    });
    offsets
        .min_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))
        .unwrap_or_else(Vector3::zeros)
}

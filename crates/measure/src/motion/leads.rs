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

use super::observed::Observed;
use super::simulate::Predicted;

/// Joints of the wrist.
pub(super) const WRIST: usize = 3;
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
    /// Without leads, for `joints` joints, with these offsets, m.
    pub(super) fn none(joints: usize, off_line: f64) -> Leads {
        Leads {
            values: vec![0.0; joints],
            u: vec![None; joints],
            off_line: [off_line, off_line],
        }
    }

    /// Whether they explain the offsets from the lines.
    pub(super) fn explain(&self) -> bool {
        let [before, left] = self.off_line;
        before > LEAST && left * left < MOST_LEFT * before * before
    }

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

/// Length of vectors of which these are the coordinates, root mean square.
pub(super) fn rms_of_vectors(residuals: &[f64]) -> f64 {
    let sum: f64 = residuals.iter().map(|r| r * r).sum();
    (3.0 * sum / residuals.len().max(1) as f64).sqrt()
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

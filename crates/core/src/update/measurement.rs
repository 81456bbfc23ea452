//! Campaigns of measurements: positions of a point, and load tests.

use nalgebra::Vector3;

use crate::calibrate::{MeasuredPose, ParameterSet, Question, Refusal, fit};
use crate::frame::Isometry;
use crate::identify::LoadTest;
use crate::robot::Robot;
use crate::spatial::Wrench;

/// Measurements that were taken together.
#[derive(Clone, Debug, PartialEq)]
pub enum Campaign {
    /// Positions of a point on the tool, by a tracker, a probe, or of features that the tool cut.
    Positions(Positions),
    /// Displacements under load. Their readings state their uncertainties.
    LoadTests(Vec<LoadTest>),
}

/// Measured positions of one point.
#[derive(Clone, Debug, PartialEq)]
pub struct Positions {
    /// Joint positions and position of the point, in any frame; with a rotation all or none.
    pub poses: Vec<MeasuredPose>,
    /// What acted on the arm at each pose.
    pub conditions: Vec<Condition>,
    /// The point on the flange: approximate, or known.
    pub flange_from_point: Isometry,
    /// Whether the point is known, as the tip of a tool that cut.
    pub point: Known,
    /// Standard uncertainty of a coordinate, m.
    pub standard_uncertainty: f64,
    /// Weight of rotations: metres per radian.
    pub turn_length: f64,
}

/// Whether something is known or to be found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// It is exactly as given.
    Exactly,
    /// It is approximately as given, and found from the measurements.
    Approximately,
}

/// What acted on the arm when a position was measured, or when the feature was cut.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// Load on the tool at the point, base axes; the weight of the arm belongs to its geometry.
    pub wrench: Wrench,
    /// Direction of the last motion of each joint in the coordinates of the controller: -1, 1, or 0 where it is not known.
    pub directions: Vec<f64>,
}

impl Condition {
    /// No load, and directions that are not known.
    pub fn unloaded(robot: &Robot) -> Condition {
        Condition {
            wrench: Wrench::from_force(Vector3::zeros()),
            directions: vec![0.0; robot.joints().len()],
        }
    }

    /// Side on which each link is within its backlash, in the coordinates of the chain: it lags behind its motor.
    pub(super) fn sides(&self, robot: &Robot) -> Vec<f64> {
        let joints = 0..robot.joints().len();
        let at_rest = vec![0.0; robot.joints().len()];
        let moved = |joint| robot.theta(joint, &self.directions) - robot.theta(joint, &at_rest);
        joints
            .map(|joint| match moved(joint) {
                0.0 => 0.0,
                moved => -f64::signum(moved),
            })
            .collect()
    }
}

impl Campaign {
    /// Number of measured numbers.
    pub fn rows(&self) -> usize {
        match self {
            Campaign::Positions(positions) => {
                let turned = positions
                    .poses
                    .iter()
                    .filter(|pose| pose.rotation.is_some())
                    .count();
                3 * (positions.poses.len() + turned)
            }
            Campaign::LoadTests(tests) => tests.iter().map(|test| test.readings.len()).sum(),
        }
    }

    /// Whether the direction of the last motion of a joint is known.
    pub fn reverses(&self) -> bool {
        match self {
            Campaign::Positions(positions) => {
                let known = |condition: &Condition| condition.directions.iter().any(|side| *side != 0.0);
                positions.conditions.iter().any(known)
            }
            Campaign::LoadTests(_) => false,
        }
    }
}

impl Positions {
    /// The frame of the measurements and the point on the flange, by the nominal chain.
    ///
    /// # Errors
    /// Poses that a calibration refuses.
    pub(super) fn placed(&self, robot: &Robot) -> Result<[Isometry; 2], Refusal> {
        let question = |requested| Question {
            requested,
            flange_from_point: self.flange_from_point,
            turn_length: self.turn_length,
            prior: None,
        };
        let found = match self.point {
            Known::Exactly => fit(robot, &self.poses, &question(ParameterSet::Base)),
            // Where the poses hardly determine the point, it stays where it is said to be.
            Known::Approximately => fit(robot, &self.poses, &question(ParameterSet::BaseAndTool))
                .or_else(|_| fit(robot, &self.poses, &question(ParameterSet::Base))),
        }?;
        Ok([found.tracker_from_base, found.flange_from_point])
    }
}

//! What is uncertain of an arm, and what is known of it before any measurement.
//!
//! | parameter | known as | before |
//! |---|---|---|
//! | small motion after a joint | normal, m or rad | zero, with the standard deviation of arms of this kind |
//! | compliance of a drive | its logarithm is normal | value of the robot file and its uncertainty; without them the typical prior of [`identify`](crate::identify::prior) |
//! | backlash of a joint | its logarithm is normal | value of the robot file and its uncertainty; without them the lost motion of reducers |

use crate::calibrate::{self, ParameterLocation, ParameterSet, Unknown, unknowns};
use crate::identify::prior::{LogPrior, typical};
use crate::identify::unknown::{drives, lost_motion};
use crate::robot::{Attachment, Robot};

/// One uncertain number of an arm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parameter {
    /// A small motion of the chain.
    Geometry(Unknown),
    /// The compliance of the drive of the joint with this index.
    Drive(usize),
    /// The backlash of the joint with this index.
    Backlash(usize),
}

/// What is known of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knowledge {
    /// Which one.
    pub parameter: Parameter,
    /// Mean: m or rad of a small motion, otherwise of the logarithm of rad/(N m), m/N, rad, m.
    pub mean: f64,
    /// Standard deviation, same unit.
    pub deviation: f64,
}

impl Knowledge {
    /// The most likely value, m, rad, rad/(N m), m/N.
    pub fn value(&self) -> f64 {
        match self.parameter {
            Parameter::Geometry(_) => self.mean,
            Parameter::Drive(_) | Parameter::Backlash(_) => self.mean.exp(),
        }
    }

    /// Standard uncertainty of the value, to first order.
    pub fn standard_uncertainty(&self) -> f64 {
        match self.parameter {
            Parameter::Geometry(_) => self.deviation,
            Parameter::Drive(_) | Parameter::Backlash(_) => self.mean.exp() * self.deviation,
        }
    }
}

/// Standard deviations where the robot file states none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PriorFactors {
    /// Of the small motions.
    pub geometry: calibrate::Prior,
    /// Of a compliance or backlash that the robot file gives without an uncertainty: a factor, above 1.
    pub factor: f64,
}

/// The knowledge of `robot` before any measurement; with the backlash of joints that the robot file does not give if `reverses`.
pub fn prior(robot: &Robot, factors: &PriorFactors, reverses: bool) -> Vec<Knowledge> {
    let geometry = unknowns(robot, ParameterSet::Geometry, false)
        .into_iter()
        .filter(|unknown| matches!(unknown.place, ParameterLocation::After(_)))
        .map(|unknown| Knowledge {
            parameter: Parameter::Geometry(unknown),
            mean: 0.0,
            deviation: match unknown.turns() {
                true => factors.geometry.angle,
                false => factors.geometry.length,
            },
        });
    let given = |parameter, value: f64, u: f64| Knowledge {
        parameter,
        mean: value.ln(),
        deviation: match u > 0.0 {
            true => u / value,
            false => factors.factor.ln(),
        },
    };
    let assumed = |parameter, typical: &LogPrior| Knowledge {
        parameter,
        mean: typical.mean,
        deviation: typical.standard_uncertainty,
    };
    let typical_drives = typical(&drives(robot));
    let drive = |(joint, typical): (usize, &LogPrior)| {
        let parameter = Parameter::Drive(joint);
        match robot.compliance().map(|joints| joints[joint]) {
            // A rigid drive is a statement of the robot file.
            Some(stated) if stated.value == 0.0 => None,
            Some(stated) => Some(given(parameter, stated.value, stated.standard_uncertainty)),
            None => Some(assumed(parameter, typical)),
        }
    };
    let reversing = lost_motion(robot, &vec![f64::MAX; robot.joints().len()]);
    let typical_gaps = typical(&reversing);
    let gap = |joint: usize| {
        let parameter = Parameter::Backlash(joint);
        let stated = robot
            .structure()
            .joints_with_backlash()
            .find(|(of, _)| *of == joint);
        match stated {
            Some((_, stated)) => Some(given(parameter, stated.gap, stated.standard_uncertainty)),
            None => reversing
                .iter()
                .position(|unknown| reverses && unknown.attachment == Attachment::Joint(joint))
                .map(|k| assumed(parameter, &typical_gaps[k])),
        }
    };
    let joints = 0..robot.joints().len();
    geometry
        .chain(typical_drives.iter().enumerate().filter_map(drive))
        .chain(joints.filter_map(gap))
        .collect()
}

//! What yields, weighs, has play and scatters in an arm beside its drives: springs, masses, compensator, torque curves,
//! backlash, repeatability; and how much of what it does no such part explains.
//!
//! Empty for the simple model, in which only joints yield, each about its own axis.

use nalgebra::DMatrix;

use super::backlash::Backlash;
use super::compensator::{Compensator, Mass};
use super::model::{Robot, SOFTEST};
use super::spring::{Attachment, Spring};
use super::torque_curve::JointCurve;

/// What yields, weighs and has play beside the drives.
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    /// Springs, in any order; those of one seat act in the order of this list.
    pub springs: Vec<Spring>,
    /// Masses.
    pub masses: Vec<Mass>,
    /// The gravity compensator, if the arm has one.
    pub compensator: Option<Compensator>,
    /// Torque curves that stand in place of joint compliances, by joint; a list may end early.
    pub curves: Vec<Option<JointCurve>>,
    /// Covariance of the compliances of the drives, then the springs; what it does not reach is independent.
    pub covariance: Option<DMatrix<f64>>,
    /// Backlash, by joint; a list may end early. It yields to nothing; it moves the tool.
    pub backlash: Vec<Option<Backlash>>,
    /// Standard deviation of where the tool comes to rest, along any axis, from time to time, m; zero where it is not known.
    pub repeatability: f64,
    /// Standard uncertainty of what the model predicts under a load, as a fraction of it, beside that of its compliances: what
    /// springs and joints do that no number of this arm describes. Zero where it is not known.
    pub model_error: f64,
}

/// Why a structure fits no arm.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StructureError {
    /// A number is NaN or infinite.
    #[error("{0} holds a number that is not finite")]
    NotFinite(&'static str),
    /// A matrix differs from its transpose.
    #[error("{0} is not symmetric")]
    NotSymmetric(&'static str),
    /// A compliance below zero in some direction.
    #[error("{0} has a negative eigenvalue: something would move against its load")]
    YieldsAgainstLoad(&'static str),
    /// A covariance that gives some sum a negative variance.
    #[error(
        "the covariance has a negative eigenvalue, or is of {size} compliances where there are {compliances}"
    )]
    Covariance {
        /// Rows given.
        size: usize,
        /// Drives and springs.
        compliances: usize,
    },
    /// A compliance or its uncertainty below zero, or beyond [`SOFTEST`].
    #[error("spring number {}: compliance {value} is not a number from 0 to {SOFTEST} rad/(N m) (m/N)", spring + 1)]
    Compliance {
        /// Index of the spring.
        spring: usize,
        /// As given.
        value: f64,
    },
    /// A mass that is no mass.
    #[error("mass number {}: {value} kg is not a number from 0 to 1e6", mass + 1)]
    Mass {
        /// Index of the mass.
        mass: usize,
        /// As given.
        value: f64,
    },
    /// A seat, curve or compensator at a joint that does not exist, or slides.
    #[error("{what} names joint number {}, which does not exist or slides", joint + 1)]
    NoSuchJoint {
        /// Which part.
        what: &'static str,
        /// Index given.
        joint: usize,
    },
    /// Backlash that is none.
    #[error("backlash of joint number {}: {value} is not a number from 0 to {WIDEST} rad (m)", joint + 1)]
    Backlash {
        /// Index of the joint.
        joint: usize,
        /// As given.
        value: f64,
    },
    /// A repeatability that is none.
    #[error("a standard deviation of {0} m is not a number from 0 to {WIDEST_SCATTER}")]
    Repeatability(f64),
    /// A model error that is none.
    #[error("a model error of {0} is not a fraction from 0 to {WORST_MODEL}")]
    ModelError(f64),
    /// A curve of fewer than two pairs.
    #[error("a torque curve of {0} pairs: two make a line")]
    ShortCurve(usize),
    /// A curve that turns back.
    #[error("torque curve: pair number {} does not rise: torques rise, angles do not fall", pair + 1)]
    FallingCurve {
        /// Index of the pair.
        pair: usize,
    },
    /// A compensator without size, or whose spring can shrink to nothing.
    #[error("the compensator needs lengths above 0, and radii that differ by a millimetre or more")]
    Compensator,
}

/// Radii of a compensator that differ by less let its spring shrink to nothing, m.
const LEAST_SPRING: f64 = 1e-3;

/// No gap is wider, rad (m).
pub const WIDEST: f64 = 0.1;

/// No arm scatters by more, m.
pub const WIDEST_SCATTER: f64 = 0.01;

/// A model that misses more, as a fraction of what it predicts, predicts nothing.
pub const WORST_MODEL: f64 = 10.0;

impl Structure {
    /// Nothing yields or weighs but the drives.
    pub const EMPTY: Structure = Structure {
        springs: Vec::new(),
        masses: Vec::new(),
        compensator: None,
        curves: Vec::new(),
        covariance: None,
        backlash: Vec::new(),
        repeatability: 0.0,
        model_error: 0.0,
    };

    /// The torque curve of joint `index`, if it has one.
    pub fn curve(&self, index: usize) -> Option<&JointCurve> {
        self.curves.get(index).and_then(Option::as_ref)
    }

    /// Joints that have play, each with its backlash.
    pub fn gaps(&self) -> impl Iterator<Item = (usize, &Backlash)> {
        let gaps = self.backlash.iter().enumerate();
        gaps.filter_map(|(joint, backlash)| Some((joint, backlash.as_ref().filter(|b| b.gap > 0.0)?)))
    }

    /// Whether this structure fits `robot`.
    ///
    /// # Errors
    /// The first thing that does not.
    pub fn check(&self, robot: &Robot) -> Result<(), StructureError> {
        let joints = robot.joints().len();
        let turns = |what, joint: usize| {
            let fits = joint < joints && !robot.slides(joint);
            fits.then_some(())
                .ok_or(StructureError::NoSuchJoint { what, joint })
        };
        let seated = |what, attachment: Attachment| match attachment {
            Attachment::Joint(joint) if joint >= joints => Err(StructureError::NoSuchJoint { what, joint }),
            _ => Ok(()),
        };
        for (spring, s) in self.springs.iter().enumerate() {
            seated("a spring", s.attachment)?;
            if s.direction.to_vector().iter().any(|part| !part.is_finite()) {
                return Err(StructureError::NotFinite("a spring"));
            }
            for value in [s.compliance.value, s.compliance.standard_uncertainty] {
                if !(0.0..=SOFTEST).contains(&value) {
                    return Err(StructureError::Compliance { spring, value });
                }
            }
        }
        for (mass, m) in self.masses.iter().enumerate() {
            seated("a mass", m.attachment)?;
            if !(0.0..=1e6).contains(&m.mass) {
                let value = m.mass;
                return Err(StructureError::Mass { mass, value });
            }
            if m.centre.iter().any(|part| !part.is_finite()) {
                return Err(StructureError::NotFinite("a centre of mass"));
            }
        }
        for (joint, _) in self
            .curves
            .iter()
            .enumerate()
            .filter(|(_, curve)| curve.is_some())
        {
            turns("a torque curve", joint)?;
        }
        for (joint, backlash) in self.backlash.iter().enumerate() {
            let Some(backlash) = backlash else { continue };
            seated("backlash", Attachment::Joint(joint))?;
            for value in [backlash.gap, backlash.standard_uncertainty] {
                if !(0.0..=WIDEST).contains(&value) {
                    return Err(StructureError::Backlash { joint, value });
                }
            }
        }
        if !(0.0..=WIDEST_SCATTER).contains(&self.repeatability) {
            return Err(StructureError::Repeatability(self.repeatability));
        }
        if !(0.0..=WORST_MODEL).contains(&self.model_error) {
            return Err(StructureError::ModelError(self.model_error));
        }
        if let Some(c) = &self.compensator {
            turns("the compensator", c.joint)?;
            check_compensator(c)?;
        }
        self.covariance
            .as_ref()
            .map_or(Ok(()), |s| check_covariance(s, joints + self.springs.len()))
    }
}

impl Default for Structure {
    fn default() -> Structure {
        Structure::EMPTY
    }
}

fn check_compensator(c: &Compensator) -> Result<(), StructureError> {
    let lengths = [c.fixed_radius, c.arm_radius, c.free_length, c.stiffness];
    let numbers = lengths.iter().all(|value| value.is_finite()) && c.angle.is_finite();
    let apart = (c.fixed_radius - c.arm_radius).abs() >= LEAST_SPRING;
    let positive = c.fixed_radius > 0.0 && c.arm_radius > 0.0 && c.free_length >= 0.0 && c.stiffness >= 0.0;
    (numbers && apart && positive)
        .then_some(())
        .ok_or(StructureError::Compensator)
}

/// A covariance may miss symmetry and sign by what printing its numbers rounds away, relative to its largest entry.
const PRINTED: f64 = 1e-6;

fn check_covariance(covariance: &DMatrix<f64>, compliances: usize) -> Result<(), StructureError> {
    let size = covariance.nrows();
    if covariance.iter().any(|value| !value.is_finite()) {
        return Err(StructureError::NotFinite("the covariance"));
    }
    if size != covariance.ncols() || size > compliances {
        return Err(StructureError::Covariance { size, compliances });
    }
    let rounding = PRINTED * covariance.amax();
    if (covariance - covariance.transpose()).amax() > rounding {
        return Err(StructureError::NotSymmetric("the covariance"));
    }
    if covariance.clone().symmetric_eigenvalues().min() < -rounding {
        return Err(StructureError::Covariance { size, compliances });
    }
    Ok(())
}

#[cfg(test)]
mod tests;

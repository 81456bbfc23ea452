//! The structure of an arm in addition to its drives: springs, masses, compensator, torque curves,
//! backlash, repeatability, and model error.
//!
//! Empty for the simple model, in which only joints deflect, each about its own axis.

use nalgebra::DMatrix;

use super::backlash::Backlash;
use super::compensator::{Compensator, Mass};
use super::model::{Robot, SOFTEST};
use super::spring::{Attachment, Spring};
use super::torque_curve::JointCurve;

/// Springs, masses, backlash and other properties in addition to the drives.
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    /// Springs, in any order; those of one attachment act in the order of this list.
    pub springs: Vec<Spring>,
    /// Masses.
    pub masses: Vec<Mass>,
    /// The gravity compensator, if the arm has one.
    pub compensator: Option<Compensator>,
    /// Torque curves that replace joint compliances, by joint; the list may be shorter than the joints.
    pub curves: Vec<Option<JointCurve>>,
    /// Covariance of the compliances of the drives, then the springs; compliances outside it are independent.
    pub covariance: Option<DMatrix<f64>>,
    /// Backlash, by joint; the list may be shorter than the joints. It has no compliance, but displaces the tool.
    pub backlash: Vec<Option<Backlash>>,
    /// Standard deviation of the attained tool position between repetitions, along any axis, m; zero where it is not
    /// known.
    pub repeatability: f64,
    /// Model error: standard uncertainty of the prediction under a load, as a fraction of it, in addition to that of
    /// the compliances. It covers effects of springs and joints that have no parameter. Zero where it is not known.
    pub model_error: f64,
}

/// Why a structure is not valid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StructureError {
    /// A number is NaN or infinite.
    #[error("{0} contains a number that is not finite")]
    NotFinite(&'static str),
    /// A matrix differs from its transpose.
    #[error("{0} is not symmetric")]
    NotSymmetric(&'static str),
    /// A compliance below zero in some direction.
    #[error("{0} has a negative eigenvalue: a compliance must not be negative in any direction")]
    NegativeEigenvalue(&'static str),
    /// A covariance with a negative variance.
    #[error("the covariance has a negative eigenvalue, or {size} rows for {compliances} compliances")]
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
        /// The value given.
        value: f64,
    },
    /// A mass out of range.
    #[error("mass number {}: {value} kg is not a number from 0 to 1e6", mass + 1)]
    Mass {
        /// Index of the mass.
        mass: usize,
        /// The value given.
        value: f64,
    },
    /// An attachment, curve or compensator at a joint that does not exist, or is prismatic.
    #[error("{what} names joint number {}, which does not exist or is prismatic", joint + 1)]
    NoSuchJoint {
        /// The part.
        what: &'static str,
        /// Index given.
        joint: usize,
    },
    /// Backlash out of range.
    #[error("backlash of joint number {}: {value} is not a number from 0 to {WIDEST} rad (m)", joint + 1)]
    Backlash {
        /// Index of the joint.
        joint: usize,
        /// The value given.
        value: f64,
    },
    /// A repeatability out of range.
    #[error("a standard deviation of {0} m is not a number from 0 to {WIDEST_SCATTER}")]
    Repeatability(f64),
    /// A model error out of range.
    #[error("a model error of {0} is not a fraction from 0 to {WORST_MODEL}")]
    ModelError(f64),
    /// A curve of fewer than two pairs.
    #[error("a torque curve of {0} pairs: at least 2 are needed")]
    ShortCurve(usize),
    /// A curve that does not rise.
    #[error("torque curve: pair number {} does not rise: torques must rise, angles must not fall", pair + 1)]
    FallingCurve {
        /// Index of the pair.
        pair: usize,
    },
    /// A compensator without size, or whose spring can shrink to length zero.
    #[error("the compensator needs lengths above 0, and radii that differ by 1 mm or more")]
    Compensator,
}

/// Radii of a compensator that differ by less let its spring shrink to length zero, m.
const LEAST_SPRING: f64 = 1e-3;

/// Greatest backlash, rad (m).
pub const WIDEST: f64 = 0.1;

/// Greatest standard deviation of repeatability, m.
pub const WIDEST_SCATTER: f64 = 0.01;

/// Greatest model error, as a fraction of the prediction: beyond it the prediction is useless.
pub const WORST_MODEL: f64 = 10.0;

impl Structure {
    /// Only the drives deflect, and nothing has a weight.
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

    /// Joints that have backlash, each with it.
    pub fn joints_with_backlash(&self) -> impl Iterator<Item = (usize, &Backlash)> {
        let gaps = self.backlash.iter().enumerate();
        gaps.filter_map(|(joint, backlash)| Some((joint, backlash.as_ref().filter(|b| b.gap > 0.0)?)))
    }

    /// Whether this structure is valid for `robot`.
    ///
    /// # Errors
    /// The first error.
    pub fn check(&self, robot: &Robot) -> Result<(), StructureError> {
        let joints = robot.joints().len();
        let turns = |what, joint: usize| {
            let fits = joint < joints && !robot.slides(joint);
            fits.then_some(())
                .ok_or(StructureError::NoSuchJoint { what, joint })
        };
        let attached = |what, attachment: Attachment| match attachment {
            Attachment::Joint(joint) if joint >= joints => Err(StructureError::NoSuchJoint { what, joint }),
            _ => Ok(()),
        };
        for (spring, s) in self.springs.iter().enumerate() {
            attached("a spring", s.attachment)?;
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
            attached("a mass", m.attachment)?;
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
            attached("backlash", Attachment::Joint(joint))?;
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

/// A covariance may deviate from symmetry and sign by the rounding of its printed numbers, relative to its largest
/// entry.
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

//! The structure of an arm in addition to its drives: springs, masses, motors, damping, compensator, torque curves,
//! backlash, repeatability, model error, learnt residual, and uncertainty of the geometry.
//!
//! Empty for the simple model, in which only joints deflect, each about its own axis.

use std::sync::Arc;

use nalgebra::{DMatrix, Matrix3};

use super::backlash::Backlash;
use super::chain::Chain;
use super::compensator::{Compensator, Mass};
use super::damping::{CRITICAL, Damping, STRONGEST_DAMPER};
use super::joint::SOFTEST;
use super::learnt::{Learnt, LearntError};
use super::motor::{HEAVIEST_ROTOR, Motor};
use super::spring::{Attachment, Spring};
use super::structure_error::{StructureError, WIDEST, WIDEST_SCATTER, WORST_MODEL};
use super::torque_curve::JointCurve;
use super::uncertain_geometry::{UncertainGeometry, UncertainGeometryError};

/// Springs, masses, backlash and other properties in addition to the drives.
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    /// Springs, in any order; those of one attachment act in the order of this list.
    pub springs: Vec<Spring>,
    /// Masses.
    pub masses: Vec<Mass>,
    /// Rotors of the motors, at most one a joint; only the vibration of the arm depends on them.
    pub motors: Vec<Motor>,
    /// Damping of the vibration, if known.
    pub damping: Option<Damping>,
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
    /// What the model of the chain leaves of the measured positions, if it was learnt.
    pub learnt: Option<Arc<Learnt>>,
    /// How uncertain the geometry is, if it is known.
    pub geometry: Option<Arc<UncertainGeometry>>,
}

/// Radii of a compensator that differ by less let its spring shrink to length zero, m.
const LEAST_SPRING: f64 = 1e-3;

impl Structure {
    /// Only the drives deflect, and nothing has a weight.
    pub const EMPTY: Structure = Structure {
        springs: Vec::new(),
        masses: Vec::new(),
        motors: Vec::new(),
        damping: None,
        compensator: None,
        curves: Vec::new(),
        covariance: None,
        backlash: Vec::new(),
        repeatability: 0.0,
        model_error: 0.0,
        learnt: None,
        geometry: None,
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

    /// Whether a body or a rotor has inertia, without which there are no modes of vibration.
    pub fn has_inertia(&self) -> bool {
        let of_body = |mass: &Mass| mass.mass > 0.0 || mass.inertia.is_some();
        self.masses.iter().any(of_body) || self.motors.iter().any(|motor| motor.inertia_at_joint() > 0.0)
    }

    /// Whether this structure is valid for an arm of this chain.
    ///
    /// # Errors
    /// The first error.
    pub fn check(&self, chain: &Chain) -> Result<(), StructureError> {
        let joints = chain.links().len();
        let turns = |what, joint: usize| {
            let fits = joint < joints && !chain.slides(joint);
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
            if let Some(inertia) = &m.inertia
                && !is_inertia(inertia)
            {
                return Err(StructureError::Inertia { mass });
            }
        }
        for motor in &self.motors {
            attached("a motor", Attachment::Joint(motor.joint))?;
            let value = motor.inertia_at_joint();
            if motor.rotor_inertia < 0.0 || !(0.0..=HEAVIEST_ROTOR).contains(&value) {
                let joint = motor.joint;
                return Err(StructureError::Motor { joint, value });
            }
        }
        match &self.damping {
            Some(Damping::Ratio(ratio)) if !(0.0..CRITICAL).contains(ratio) => {
                return Err(StructureError::DampingRatio(*ratio));
            }
            Some(Damping::Joints(dampers)) => {
                for (joint, value) in dampers.iter().enumerate() {
                    attached("damping", Attachment::Joint(joint))?;
                    if !(0.0..=STRONGEST_DAMPER).contains(value) {
                        return Err(StructureError::Damper { joint, value: *value });
                    }
                }
            }
            Some(Damping::Ratio(_)) | None => {}
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
        if let Some(learnt) = &self.learnt {
            check_learnt(learnt, chain)?;
        }
        if let Some(geometry) = &self.geometry
            && let Some(wrong) = geometry
                .motions()
                .iter()
                .position(|motion| motion.after >= joints)
        {
            return Err(UncertainGeometryError::Motion(wrong).into());
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

fn check_learnt(learnt: &Learnt, chain: &Chain) -> Result<(), StructureError> {
    let (lengths, joints) = (learnt.joints(), chain.links().len());
    match chain.ground().is_base() {
        false => Err(LearntError::Ground.into()),
        true if lengths != joints => Err(LearntError::Lengths { lengths, joints }.into()),
        true => Ok(()),
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

/// Greatest number of an inertia, kg m^2.
const GREATEST_INERTIA: f64 = 1e12;

/// Whether this is the inertia of a body: finite, symmetric, and negative about no axis, up to the rounding of printed numbers.
/// That each principal inertia is at most the sum of the others is not required: a body without thickness meets it only up to rounding.
fn is_inertia(inertia: &Matrix3<f64>) -> bool {
    let rounding = PRINTED * inertia.amax();
    inertia.iter().all(|value| value.abs() <= GREATEST_INERTIA)
        && (inertia - inertia.transpose()).amax() <= rounding
        && inertia.symmetric_eigenvalues().min() >= -rounding
}

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

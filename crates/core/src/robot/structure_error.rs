//! Why a structure is not valid, and the greatest values of a valid one.

use super::joint::SOFTEST;
use super::learnt::LearntError;
use super::uncertain_geometry::UncertainGeometryError;

/// Greatest backlash, rad (m).
pub const WIDEST: f64 = 0.1;

/// Greatest standard deviation of repeatability, m.
pub const WIDEST_SCATTER: f64 = 0.01;

/// Greatest model error, as a fraction of the prediction: beyond it the prediction is useless.
pub const WORST_MODEL: f64 = 10.0;

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
    /// An inertia that no body has.
    #[error("mass number {}: its inertia is not finite, symmetric and positive about every axis", mass + 1)]
    Inertia {
        /// Index of the mass.
        mass: usize,
    },
    /// A rotor out of range.
    #[error("motor of joint number {}: an inertia of {value} kg m^2 at the joint is not a number from 0 to 1e9", joint + 1)]
    Motor {
        /// Index of the joint.
        joint: usize,
        /// Rotor inertia times the square of the ratio.
        value: f64,
    },
    /// A damping ratio out of range.
    #[error("a damping ratio of {0} is not a number from 0 to below 1")]
    DampingRatio(f64),
    /// Viscous damping out of range.
    #[error("damping of joint number {}: {value} is not a number from 0 to 1e12 N m s/rad (N s/m)", joint + 1)]
    Damper {
        /// Index of the joint.
        joint: usize,
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
    /// A learnt residual of another arm.
    #[error(transparent)]
    Learnt(#[from] LearntError),
    /// An uncertainty of the geometry of another arm.
    #[error(transparent)]
    Geometry(#[from] UncertainGeometryError),
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

//! **The main idea.** Posture and load in, deviation of the tool out, with its parts.
//!
//! An arm that holds a tool stands in some posture (`robot::inverse`). Its joints lie on lines in space; seen from
//! the tool each is a screw. The load is a wrench on the tool. Each source of error answers with a small
//! displacement of the tool, and these add:
//!
//! ```text
//! pose -> posture -> screws s_i        load -> wrench w
//! deviation = elastic(s_i, c_i, w) + gravity(s_i, c_i, masses) + backlash(s_i, u_i) + geometric
//! ```
//!
//! [`predict`] is the simple model, in which only joints yield; [`predict_in_full`] has every part of a
//! [`StiffnessModel`](crate::source::StiffnessModel), and without them the same numbers.
//! Reference point: TCP. Basis: base. Deviation = where the tool is minus where it was asked to be.

use nalgebra::Matrix3;

use crate::robot::Posture;
use crate::robot::joint::JointCompliance;
use crate::source::{Standing, Unstable, elastic, repeatability};
use crate::spatial::{Twist, Wrench};

/// How far the tool is from where it was asked to be, and why.
#[derive(Clone, Debug)]
pub struct Deviation {
    /// Displacement (m) and rotation (rad) of the tool.
    pub twist: Twist,
    /// Share of each joint, base to flange, then of base, flange and tool where springs sit; they add up to `twist`.
    pub shares: Vec<Twist>,
    /// Covariance of the displacement, m^2, from the uncertainties of the inputs and the repeatability of the arm.
    pub covariance: Matrix3<f64>,
}

/// The deviation of a tool held in `posture` by joints of these compliances, as many as it has, under `wrench`.
///
/// ```
/// use armill_core::predict::predict;
/// use armill_core::robot::{Amount, Axis, Joint, JointCompliance, Motion, Robot, inverse::posture_at};
/// use armill_core::{frame::Isometry, spatial::Wrench};
///
/// // One joint, a lever of 1 m, 2 urad/(N m), pushed sideways with 10 N: 20 um.
/// let motions = vec![Motion::About(Axis::Z, Amount::Joint(0)), Motion::Along(Axis::X, Amount::Constant(1.0))];
/// let lever = Robot::new("lever", motions, vec![Joint::plain("A")])?;
/// let posture = posture_at(&lever, &[0.0], &Isometry::identity());
/// let joint = JointCompliance { value: 2e-6, standard_uncertainty: 0.0 };
/// let push = Wrench::from_force(nalgebra::Vector3::new(0.0, 10.0, 0.0));
/// assert!((predict(&posture, &[joint], &push).twist.linear.y - 20e-6).abs() < 1e-18);
/// # Ok::<(), armill_core::robot::RobotError>(())
/// ```
pub fn predict(posture: &Posture, joints: &[JointCompliance], wrench: &Wrench) -> Deviation {
    let elastic = elastic::shares(&posture.screws, joints, wrench);
    Deviation {
        twist: elastic.iter().copied().sum(),
        covariance: elastic::covariance(&posture.screws, joints, wrench),
        shares: elastic,
    }
}

/// The deviation of the tool where an arm stands, under `wrench`, with all that yields and weighs.
///
/// # Errors
/// [`Unstable`] where the arm finds no stable rest under the load.
pub fn predict_in_full(standing: &mut Standing<'_>, wrench: &Wrench) -> Result<Deviation, Unstable> {
    Ok(Deviation {
        twist: deviation_of(standing, wrench)?,
        shares: standing.shares(),
        covariance: standing.covariance() + repeatability::covariance(standing.scatter()),
    })
}

/// The sources in their row: what they add up to where the arm stands.
pub(crate) fn deviation_of(standing: &mut Standing<'_>, wrench: &Wrench) -> Result<Twist, Unstable> {
    let (elastic, gravity) = (standing.elastic(wrench)?, standing.gravity()?);
    Ok(gravity.map_or(elastic, |gravity| elastic + gravity))
}

/// What comes on top along a path, where it is known where links were `dragged` to in their gaps, rad (m).
pub(crate) fn beside_load(standing: &Standing<'_>, dragged: &[f64], wrench: &Wrench) -> Twist {
    standing.backlash(dragged, wrench) + standing.geometric()
}

//! The learnt residual of a robot: what the process needs of its kinematics.

use nalgebra::{Unit, Vector3};

use super::chain::Motion;
use super::forward::forward;
use super::learnt::{
    FirstJoint, Learnt, LearntAxes, LearntError, LearntKinematics, LearntSettings, ResidualAt,
};
use super::model::Robot;

impl Learnt {
    /// The process with these settings, given these residuals of `robot`.
    ///
    /// # Errors
    /// See [`LearntError`].
    pub fn new(robot: &Robot, poses: &[ResidualAt], settings: LearntSettings) -> Result<Learnt, LearntError> {
        Learnt::of(kinematics(robot), poses, settings)
    }
}

/// Components of the residuals of `robot` along these axes, m.
pub(crate) fn components(robot: &Robot, poses: &[ResidualAt], axes: LearntAxes) -> Vec<Vector3<f64>> {
    kinematics(robot).components(poses, axes)
}

fn kinematics(robot: &Robot) -> LearntKinematics {
    LearntKinematics {
        slides: (0..robot.joints().len())
            .map(|joint| robot.slides(joint))
            .collect(),
        first: first_joint(robot),
        is_on_base: robot.chain().ground().is_base(),
    }
}

fn first_joint(robot: &Robot) -> Option<FirstJoint> {
    let (joint, link) = (robot.joints().first()?, robot.chain().links().first()?);
    let Motion::About(axis, _) = link.motion else {
        return None;
    };
    let rest = vec![0.0; robot.joints().len()];
    let base_from_joint = *forward(robot, &rest).base_from_joint.first()?;
    Some(FirstJoint {
        axis: Unit::new_normalize(base_from_joint.rotation * axis.unit()),
        sign: joint.sign.factor(),
    })
}

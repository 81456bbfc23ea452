//! A question made ready for lanes: everything in the arm's axes.

use nalgebra::{Matrix3, Vector3};

use super::arm::Arm;
use super::cosine_limits::CosineLimits;
use crate::frame::both_across;
use crate::kernel::Question;
use crate::robot::inverse::OrthoParallel;

/// Numbers that all blocks of a question share.
#[derive(Clone, Debug)]
pub(in crate::kernel::lanes) struct Prepared {
    pub arm: Arm,
    /// Whether the arm's axes are not those of the base.
    pub turned: bool,
    /// Absent where joints are coupled in a way that cosines do not see.
    pub cosines: Option<CosineLimits>,
    pub compliance: [f64; 6],
    pub uncertainty: [f64; 6],
    /// Standard uncertainty that does not depend on the posture (m), and that of each deviation as a fraction of it.
    pub repeatability: f64,
    pub model_error: f64,
    /// Force and moment of each load case.
    pub cases: Vec<[Vector3<f64>; 2]>,
    /// Whether any case has a moment.
    pub moments: bool,
    /// Two directions across the plane's normal, then the normal.
    pub plane: [Vector3<f64>; 3],
}

impl Prepared {
    pub fn new(question: &Question<'_>, arm: &OrthoParallel) -> Prepared {
        let arm = Arm::new(question.arm.robot, arm, question.arm.flange_from_tool);
        let turn = |v: Vector3<f64>| arm.arm_from_base * v;
        let cases: Vec<[Vector3<f64>; 2]> = question
            .cases
            .iter()
            .map(|wrench| [turn(wrench.force), turn(wrench.moment)])
            .collect();
        let normal = turn(question.normal.into_inner());
        let [first, second] = both_across(&normal);
        let of = |get: fn(&crate::robot::JointCompliance) -> f64| {
            std::array::from_fn(|i| question.arm.compliance.get(i).map_or(0.0, get))
        };
        Prepared {
            turned: arm.arm_from_base_rotation() != Matrix3::identity(),
            cosines: CosineLimits::new(&arm),
            compliance: of(|c| c.value),
            uncertainty: of(|c| c.standard_uncertainty),
            repeatability: question.arm.model.structure.repeatability,
            model_error: question.arm.model.structure.model_error,
            moments: cases.iter().any(|[_, moment]| *moment != Vector3::zeros()),
            cases,
            plane: [first, second, normal],
            arm,
        }
    }
}

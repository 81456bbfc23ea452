//! Thermal growth of the links against rs-opw-kinematics with grown lengths. See README.md.

use rs_opw_kinematics::kinematic_traits::Kinematics;
use rs_opw_kinematics::kinematics_impl::OPWKinematics;
use rs_opw_kinematics::parameters::opw_kinematics::Parameters;

use armill_core::frame::Isometry;
use armill_core::robot::{JointCompliance, Robot};
use armill_core::source::thermal::STEEL;
use armill_core::source::{Arm, ArmState, StiffnessModel, ThermalGrowth};

use crate::arms;
use crate::check::{Check, ErrorBound, worst};
use crate::random::Random;

const REFERENCE: &str = "rs-opw-kinematics 3.0.0, every length grown";
const SEED: u64 = 11;
/// Joint positions an arm.
const POSITIONS: usize = 10_000;
/// Robot minus its calibration, K.
const DIFFERENCE: f64 = 10.0;

/// The parameters with every length grown by `growth`.
fn grown(parameters: &Parameters, growth: f64) -> Parameters {
    let by = 1.0 + growth;
    Parameters {
        a1: parameters.a1 * by,
        a2: parameters.a2 * by,
        b: parameters.b * by,
        c1: parameters.c1 * by,
        c2: parameters.c2 * by,
        c3: parameters.c3 * by,
        c4: parameters.c4 * by,
        ..*parameters
    }
}

/// Greatest difference between both displacements of the flange, m.
fn difference(robot: &Robot, parameters: &Parameters) -> f64 {
    let thermal = ThermalGrowth::new(STEEL, DIFFERENCE, 0.0);
    let mut model = StiffnessModel::DRIVES.clone();
    model.thermal = Some(thermal);
    let compliance = [JointCompliance {
        value: 0.0,
        standard_uncertainty: 0.0,
    }; 6];
    let flange = Isometry::identity();
    let mut arm_state = ArmState::new(Arm {
        robot,
        compliance: &compliance,
        model: &model,
        flange_from_tool: &flange,
    });
    let before = OPWKinematics::new(*parameters);
    let after = OPWKinematics::new(grown(parameters, thermal.growth));
    let mut random = Random::seeded(SEED);
    let errors = (0..POSITIONS).map(|_| {
        let q = random.joints();
        arm_state.set_joints(&q);
        let ours = arm_state.thermal().linear;
        let theirs = after.forward(&q).translation - before.forward(&q).translation;
        (ours - nalgebra::Vector3::from(theirs.to_array())).norm()
    });
    worst(errors)
}

/// One check per arm.
pub fn checks() -> Vec<Check> {
    arms::with_opw_parameters()
        .into_iter()
        .map(|(title, robot, parameters)| {
            let gap = ErrorBound {
                worst: difference(&robot, &parameters),
                // Two positions of some metres are subtracted in double precision.
                tolerance: 1e-13,
                unit: "m",
            };
            let what = format!(
                "displacement of the flange of {title} by {DIFFERENCE} K, {POSITIONS} random joint positions"
            );
            Check::computed(what, REFERENCE, gap)
        })
        .collect()
}

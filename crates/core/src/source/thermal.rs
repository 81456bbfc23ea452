//! Thermal growth: the links are warmer than when the arm was calibrated, and the controller does not know it.
//!
//! ```text
//! delta = g (r - sum_j a_j d_j)        g = alpha dT
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `g` | relative growth of every constant length of the chain, base to flange | 1 |
//! | `alpha` | coefficient of linear thermal expansion | 1/K |
//! | `dT` | temperature of the robot minus that of its calibration | K |
//! | `r` | centre of the flange, base | m |
//! | `a_j`, `d_j` | axis (base) and travel of each prismatic joint: a scale measures it, so it does not grow | 1, m |
//!
//! An arm that holds the part moves it by `delta`: the tool moves relative to the part by the opposite.
//!
//! All lengths grow alike, so no axis turns, and the displacement is exactly proportional to `g`. Tool and part do not grow.
//! Source: linear expansion, ISO 1:2022 and `docs/theory/thermal.md`.

use nalgebra::Vector3;

use crate::spatial::Twist;

/// Coefficient of linear thermal expansion of steel, 1/K: 11e-6 to 13e-6 for plain carbon steel, ASM Handbook, vol. 1 (1990).
pub const STEEL: f64 = 12e-6;

/// Relative growth of the links.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThermalGrowth {
    /// Growth of every constant length, 1; negative for an arm that is colder than at its calibration.
    pub growth: f64,
    /// Its standard uncertainty.
    pub standard_uncertainty: f64,
}

impl ThermalGrowth {
    /// Of links with this expansion (1/K), warmer by `difference` with the standard uncertainty `u` (K).
    pub fn new(expansion: f64, difference: f64, u: f64) -> ThermalGrowth {
        ThermalGrowth {
            growth: expansion * difference,
            standard_uncertainty: expansion * u,
        }
    }

    /// Displacement of a tool whose constant lengths add up to `lengths` (m, base): from the base to the flange, without
    /// the travel of prismatic joints.
    pub fn displacement(&self, lengths: &Vector3<f64>) -> Twist {
        Twist {
            linear: lengths * self.growth,
            angular: Vector3::zeros(),
        }
    }

    /// Standard uncertainty (m, base) of [`ThermalGrowth::displacement`]: all components together, fully correlated.
    pub fn uncertainty(&self, lengths: &Vector3<f64>) -> Vector3<f64> {
        lengths * self.standard_uncertainty
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arms;
    use crate::robot::forward::forward;
    use crate::robot::inverse::tool_on;
    use crate::robot::{Amount, Motion, Robot};
    use crate::source::{Arm, ArmState, StiffnessModel};

    /// The arm with every constant length of its chain grown by `growth`.
    fn grown(robot: &Robot, growth: f64) -> Robot {
        let mut motions = robot.chain().motions().to_vec();
        for motion in &mut motions {
            if let Motion::Along(_, Amount::Constant(length)) = motion {
                *length *= 1.0 + growth;
            }
        }
        Robot::new("grown", motions, robot.joints().to_vec()).unwrap()
    }

    #[test]
    fn a_metre_of_steel_grows_by_120_um_in_10_k() {
        let growth = ThermalGrowth::new(STEEL, 10.0, 0.5);
        let lengths = Vector3::new(0.0, 0.0, 1.0);
        assert!((growth.displacement(&lengths).linear.z - 120e-6).abs() < 1e-18);
        assert!((growth.uncertainty(&lengths).z - 6e-6).abs() < 1e-18);
    }

    #[test]
    fn the_tool_moves_as_the_forward_kinematics_of_the_grown_chain() {
        let tool = arms::bent_tool();
        for robot in arms::ALL.iter() {
            let q: Vec<f64> = (0..robot.joints().len()).map(|i| 0.3 - 0.2 * i as f64).collect();
            let mut model = StiffnessModel::DRIVES.clone();
            model.thermal = Some(ThermalGrowth::new(STEEL, -7.0, 1.0));
            let growth = model.thermal.unwrap().growth;
            let compliance = vec![
                crate::robot::JointCompliance {
                    value: 0.0,
                    standard_uncertainty: 0.0
                };
                q.len()
            ];
            let arm = Arm {
                robot,
                compliance: &compliance,
                model: &model,
                flange_from_tool: &tool,
            };
            let mut arm_state = ArmState::new(arm);
            arm_state.set_joints(&q);
            let tip = |robot: &Robot| tool_on(&forward(robot, &q), &tool);
            let (before, after) = (tip(robot), tip(&grown(robot, growth)));
            let moved = after.translation.vector - before.translation.vector;
            let thermal = arm_state.thermal();
            assert!(
                (moved - thermal.linear).norm() < 1e-13,
                "{}: {moved} {}",
                robot.name(),
                thermal.linear
            );
            assert!(before.rotation.angle_to(&after.rotation) < 1e-12 && thermal.angular.norm() == 0.0);
        }
    }
}

//! The units of a joint: degrees and rad/(N m) if it is revolute, millimetres and µm/N if it is prismatic.

use armill_core::robot::Robot;
use armill_core::units::{from_deg, from_mm};

/// The units of one joint at the boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointUnit {
    /// Unit of its positions, limits, and (a second) speed.
    pub name: &'static str,
    /// That unit in one rad (m).
    pub scale: f64,
    /// Unit of its compliance.
    pub compliance_name: &'static str,
    /// That unit in one rad/(N m) (m/N).
    pub compliance_scale: f64,
}

impl JointUnit {
    /// Of a revolute joint.
    pub const TURNING: JointUnit = JointUnit {
        name: "deg",
        scale: 180.0 / std::f64::consts::PI,
        compliance_name: "rad/(N m)",
        compliance_scale: 1.0,
    };

    /// Of a prismatic joint.
    pub const SLIDING: JointUnit = JointUnit {
        name: "mm",
        scale: 1e3,
        compliance_name: "µm/N",
        compliance_scale: 1e6,
    };

    /// A position in rad (m) from one in this unit.
    pub fn to_si(self, value: f64) -> f64 {
        match self {
            JointUnit::SLIDING => from_mm(value),
            _ => from_deg(value),
        }
    }

    /// The units of joint `index` of `robot`.
    pub fn of(robot: &Robot, index: usize) -> JointUnit {
        if robot.slides(index) {
            JointUnit::SLIDING
        } else {
            JointUnit::TURNING
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_angle_is_shown_as_by_to_degrees() {
        for q in [1.0_f64, -2.705260340591211, 0.1] {
            assert_eq!(q * JointUnit::TURNING.scale, q.to_degrees());
        }
    }
}

//! What is known of a robot apart from its drives, as JSON: springs, masses, motors, damping, torque curves, compensator.
//!
//! In the units of robot files, under keys that name the unit.

use armill_core::nalgebra::Matrix3;
use armill_core::robot::{Damping, Robot, TorqueCurve};
use armill_core::units::{to_deg, to_mm, to_per_mm, to_um};
use schemars::JsonSchema;
use serde::Serialize;

use crate::body_answers::attachment_name;
use crate::number::without_rounding;

/// Springs and masses apart from the drives.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct StructureDetails {
    /// Springs.
    pub springs: Vec<SpringDetails>,
    /// Masses.
    pub masses: Vec<MassDetails>,
    /// Rotors of the motors.
    pub motors: Vec<MotorDetails>,
    /// Damping of the vibration; none where it is not known.
    pub damping: Option<DampingDetails>,
    /// Curves in place of compliances of drives.
    pub torque_curves: Vec<CurveDetails>,
    /// The gravity compensator, if there is one.
    pub compensator: Option<CompensatorDetails>,
    /// Whether the covariance of the compliances is known.
    pub covariance_known: bool,
    /// Standard deviation of the position of the tool in repeated visits, along any axis; none if not known.
    pub scatter_um: Option<f64>,
    /// Standard uncertainty of the model apart from that of its compliances; none if not known.
    pub model_error_percent: Option<f64>,
}

/// A direction in which the structure deflects.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SpringDetails {
    /// Its attachment: `base`, a joint, `flange`, `tool`.
    pub at: String,
    /// A twist at the attachment in its axes, translation first.
    pub direction: [f64; 6],
    /// Its compliance, in the unit of its kind.
    #[serde(flatten)]
    pub compliance: SpringCompliance,
}

/// Compliance of a spring.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum SpringCompliance {
    /// It turns.
    Turning {
        /// Compliance.
        compliance_rad_per_n_m: f64,
        /// Its standard uncertainty.
        compliance_u_rad_per_n_m: Option<f64>,
    },
    /// Along a direction, which may rotate with the displacement, rad/m.
    Sliding {
        /// Compliance.
        compliance_um_per_n: f64,
        /// Its standard uncertainty.
        compliance_u_um_per_n: Option<f64>,
    },
}

/// A mass.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct MassDetails {
    /// Its attachment.
    pub at: String,
    /// How much.
    pub mass_kg: f64,
    /// Its standard uncertainty; none where it is not given.
    pub mass_u_percent: Option<f64>,
    /// Its centre in the frame of the attachment.
    pub centre_mm: [f64; 3],
    /// Inertia about its centre, in the axes of the attachment; none where it is not known.
    pub inertia_kg_m2: Option<[[f64; 3]; 3]>,
}

/// The rotor of a motor.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct MotorDetails {
    /// Its joint.
    pub joint: String,
    /// Inertia of the rotor about its axis.
    pub rotor_inertia_kg_m2: f64,
    /// Turns of the rotor per turn of the joint, rad/m of a prismatic joint.
    pub ratio: f64,
}

/// Damping of the vibration of an arm.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct DampingDetails {
    /// The damping ratio of every mode; none where the damping of the joints is given.
    pub ratio: Option<f64>,
    /// Viscous damping of each joint, of a prismatic one in N s/m; none where a ratio is given.
    pub joints_n_m_s_per_rad: Option<Vec<f64>>,
}

/// The torque curve of a joint.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct CurveDetails {
    /// The joint.
    pub joint: String,
    /// Pairs of torque and angle while the load increases the torque; always if there is no other curve.
    // unit: N m, rad
    pub torque_curve_n_m_rad: Vec<[f64; 2]>,
    /// The same where the load lowers it.
    pub torque_curve_falling_n_m_rad: Option<Vec<[f64; 2]>>,
}

/// A gravity compensator; lengths and angle as in a robot file.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct CompensatorDetails {
    /// The joint on which it acts.
    pub joint: String,
    /// From the axis to the fixed end.
    pub fixed_radius_mm: f64,
    /// From the axis to the moving end.
    pub arm_radius_mm: f64,
    /// Length without force.
    pub free_length_mm: f64,
    /// Of the spring.
    pub stiffness_n_per_mm: f64,
    /// The spring is longest at the chain position `-angle` of the joint.
    pub angle_deg: f64,
}

impl StructureDetails {
    /// Data of the file apart from the drives, in the units of such files.
    pub(crate) fn of(robot: &Robot) -> StructureDetails {
        let structure = robot.structure();
        let given = |value: f64| (value > 0.0).then_some(value);
        let name = |joint: usize| robot.joints()[joint].name.clone();
        let springs = structure.springs.iter().map(|spring| {
            let (value, u) = (spring.compliance.value, spring.compliance.known_uncertainty());
            let turns = spring.direction.linear.norm() == 0.0;
            SpringDetails {
                at: attachment_name(robot, spring.attachment),
                direction: spring.direction.to_vector().into(),
                compliance: if turns {
                    SpringCompliance::Turning {
                        compliance_rad_per_n_m: value,
                        compliance_u_rad_per_n_m: u,
                    }
                } else {
                    SpringCompliance::Sliding {
                        compliance_um_per_n: to_um(value),
                        compliance_u_um_per_n: u.map(to_um),
                    }
                },
            }
        });
        let masses = structure.masses.iter().map(|mass| MassDetails {
            at: attachment_name(robot, mass.attachment),
            mass_kg: mass.mass,
            mass_u_percent: given(100.0 * mass.relative_uncertainty),
            centre_mm: to_mm(mass.centre.coords).into(),
            inertia_kg_m2: mass.inertia.map(|inertia| rows(&inertia)),
        });
        let motors = structure.motors.iter().map(|motor| MotorDetails {
            joint: name(motor.joint),
            rotor_inertia_kg_m2: motor.rotor_inertia,
            ratio: motor.ratio,
        });
        let curves = (0..robot.joints().len()).filter_map(|joint| {
            let curve = structure.curve(joint)?;
            let points = |curve: &TorqueCurve| curve.points().to_vec();
            Some(CurveDetails {
                joint: name(joint),
                torque_curve_n_m_rad: points(&curve.rising),
                torque_curve_falling_n_m_rad: curve.falling.as_ref().map(points),
            })
        });
        StructureDetails {
            springs: springs.collect(),
            masses: masses.collect(),
            motors: motors.collect(),
            damping: structure.damping.as_ref().map(|damping| match damping {
                Damping::Ratio(ratio) => DampingDetails {
                    ratio: Some(*ratio),
                    joints_n_m_s_per_rad: None,
                },
                Damping::Joints(dampers) => DampingDetails {
                    ratio: None,
                    joints_n_m_s_per_rad: Some(dampers.clone()),
                },
            }),
            torque_curves: curves.collect(),
            compensator: structure.compensator.map(|c| CompensatorDetails {
                joint: name(c.joint),
                fixed_radius_mm: to_mm(c.fixed_radius),
                arm_radius_mm: to_mm(c.arm_radius),
                free_length_mm: to_mm(c.free_length),
                stiffness_n_per_mm: to_per_mm(c.stiffness),
                angle_deg: to_deg(c.angle),
            }),
            covariance_known: structure.covariance.is_some(),
            scatter_um: given(structure.repeatability).map(to_um),
            model_error_percent: given(structure.model_error).map(|part| without_rounding(part * 100.0)),
        }
    }
}

/// A 3 x 3 matrix row by row.
fn rows(matrix: &Matrix3<f64>) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)]))
}

//! The robot file as written: its tables and keys.

use armill_core::units::{from_deg, from_mm, from_um};
use schemars::JsonSchema;
use serde::Deserialize;

use super::geometry_covariance_table::GeometryCovarianceTable;
use crate::controller::ControllerTable;
use crate::motion::MotionTable;
use crate::robot::armill::learnt_table::LearntTable;
use crate::robot::shape_tables::{BoxTable, RoundTable};
use crate::robot::spring_tables::{AxisName, MassTable, SpringTable};
use crate::sources::SourceTable;

/// The robot file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RobotFile {
    /// Version of the format: 1.
    #[schemars(range(min = 1, max = 1))]
    #[serde(rename = "format")]
    pub _format: u32,
    /// Manufacturer and type.
    pub name: String,
    /// Note on the reliability of the numbers; a warning of every result.
    pub note: Option<String>,
    /// Zeros, frames and origin in words; not a warning.
    pub description: Option<String>,
    /// Default branch of the robot, such as `front elbow-up`.
    pub nominal_branch: Option<String>,
    /// Elementary motions from base to flange.
    pub chain: ChainTable,
    /// Joints, in the order of the chain.
    #[schemars(length(max = 64))]
    pub joint: Vec<JointEntry>,
    /// Frames that positions may be relative to, other than base_link.
    #[schemars(length(max = 1000))]
    #[serde(default)]
    pub frame: Vec<FrameEntry>,
    /// Springs in addition to the drives.
    #[schemars(length(max = 1000))]
    #[serde(default)]
    pub spring: Vec<SpringTable>,
    /// Masses of the arm.
    #[schemars(length(max = 1000))]
    #[serde(default)]
    pub mass: Vec<MassTable>,
    /// Bodies of the links, for clearance.
    #[schemars(length(max = 1000))]
    #[serde(default)]
    pub body: Vec<BodyEntry>,
    /// Which of these bodies are apart.
    pub clearance: Option<ClearanceTable>,
    /// Rotors of the motors, for vibration.
    #[schemars(length(max = 64))]
    #[serde(default)]
    pub motor: Vec<MotorTable>,
    /// Damping of the vibration.
    pub damping: Option<DampingTable>,
    /// Spring that compensates gravity at a joint.
    pub compensator: Option<CompensatorTable>,
    /// Covariance of compliances that were identified together.
    pub covariance: Option<CovarianceTable>,
    /// Covariance of the chain, if it was calibrated.
    pub geometry_covariance: Option<GeometryCovarianceTable>,
    /// Pose repeatability of the arm.
    pub repeatability: Option<RepeatabilityTable>,
    /// Standard uncertainty of the model itself.
    pub model_error: Option<ModelErrorTable>,
    /// What the chain leaves of measured positions.
    pub learnt: Option<LearntTable>,
    /// Greatest load at the flange.
    pub payload: Option<PayloadTable>,
    /// How robot programs are written for this cell.
    pub controller: Option<ControllerTable>,
    /// How its controller moves it.
    pub motion: Option<MotionTable>,
    /// Sources of the numbers, by key.
    pub sources: SourceTable,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ChainTable {
    /// Key of the source of the lengths and angles.
    #[serde(rename = "source")]
    pub _source: String,
    /// Elementary motions, base to flange.
    #[schemars(length(max = 1000))]
    pub motions: Vec<MotionEntry>,
}

/// One elementary motion: along or about an axis, by a length, an angle or a joint.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct MotionEntry {
    /// Translation along this axis.
    pub along: Option<AxisName>,
    /// Rotation about this axis, right-hand rule.
    pub about: Option<AxisName>,
    /// Length of the translation.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub length_mm: Option<f64>,
    /// Angle of the rotation.
    #[schemars(range(min = -360.0, max = 360.0))]
    pub angle_deg: Option<f64>,
    /// Name of the joint that makes the motion.
    pub joint: Option<String>,
    /// Symbol in the source, as a note.
    pub symbol: Option<String>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct JointEntry {
    /// Name of the joint, as the manufacturer writes it.
    pub name: String,
    /// 1 if the controller's positive direction follows the right-hand rule about the chain's axis, else -1.
    #[schemars(range(min = -1, max = 1))]
    pub sign: i8,
    /// Chain angle at the controller's zero.
    pub zero_offset_deg: Option<f64>,
    /// Chain position at the controller's zero, prismatic joints.
    pub zero_offset_mm: Option<f64>,
    /// Earlier joints whose positions add to that of this joint.
    #[serde(default)]
    pub coupling: Vec<CouplingEntry>,
    /// Lower and upper limit, as the controller shows positions.
    pub limits_deg: Option<[f64; 2]>,
    /// Lower and upper limit, prismatic joints.
    pub limits_mm: Option<[f64; 2]>,
    /// Greatest speed.
    #[schemars(range(min = 0.0))]
    pub max_speed_deg_per_s: Option<f64>,
    /// Greatest speed, prismatic joints.
    #[schemars(range(min = 0.0))]
    pub max_speed_mm_per_s: Option<f64>,
    /// Whether it is an external axis in front of the arm: a turntable that carries it. Prismatic joints in front of six
    /// are external axes without that.
    #[serde(default)]
    pub external: bool,
    /// Key of the source of sign, zero, limits and speed.
    pub source: String,
    /// Compliance about the axis, drive and control loop included.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub compliance_rad_per_n_m: Option<f64>,
    /// Standard uncertainty of the compliance.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub compliance_u_rad_per_n_m: Option<f64>,
    /// Compliance along the axis, prismatic joints.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub compliance_um_per_n: Option<f64>,
    /// Standard uncertainty of the compliance, prismatic joints.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub compliance_u_um_per_n: Option<f64>,
    /// Torque and angle, pair by pair, in place of one compliance; where the load raises the torque.
    #[schemars(inner(inner(range(min = -1e9, max = 1e9))))]
    pub torque_curve_n_m_rad: Option<Vec<[f64; 2]>>,
    /// The same where the load lowers the torque; if left out, the other curve is used for both.
    #[schemars(inner(inner(range(min = -1e9, max = 1e9))))]
    pub torque_curve_falling_n_m_rad: Option<Vec<[f64; 2]>>,
    /// Key of the source of the compliance.
    pub compliance_source: Option<String>,
    /// Key of the source of its standard uncertainty; that of the compliance if left out.
    pub compliance_u_source: Option<String>,
    /// Backlash: the total backlash between motor and link.
    #[schemars(range(min = 0.0, max = 5.0))]
    pub backlash_deg: Option<f64>,
    /// Standard uncertainty of the backlash.
    #[schemars(range(min = 0.0, max = 5.0))]
    pub backlash_u_deg: Option<f64>,
    /// Backlash, prismatic joints.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub backlash_mm: Option<f64>,
    /// Standard uncertainty of the backlash, prismatic joints.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub backlash_u_mm: Option<f64>,
    /// What decides on which side of the backlash the link is; `motion` if left out.
    pub backlash_side: Option<BacklashSideName>,
    /// Key of the source of the backlash.
    pub backlash_source: Option<String>,
    /// Viscous damping between motor and link, for vibration.
    #[schemars(range(min = 0.0, max = 1e12))]
    pub damping_n_m_s_per_rad: Option<f64>,
    /// Viscous damping between motor and link, prismatic joints.
    #[schemars(range(min = 0.0, max = 1e12))]
    pub damping_n_s_per_m: Option<f64>,
    /// Key of the source of the damping.
    pub damping_source: Option<String>,
    /// Limits by other sources; reported, never enforced.
    #[serde(default)]
    pub other_limits: Vec<OtherLimitsEntry>,
}

/// What decides on which side of its backlash a link is.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(super) enum BacklashSideName {
    /// Friction: the link lags behind the motor.
    Motion,
    /// The torque of load and gravity on the link.
    Torque,
}

impl JointEntry {
    /// Compliance along or about the axis, m/N or rad/(N m).
    pub(super) fn compliance(&self) -> Option<f64> {
        let sliding = self.compliance_um_per_n.map(from_um);
        self.compliance_rad_per_n_m.or(sliding)
    }

    /// Its standard uncertainty, same unit; zero where none is given.
    pub(super) fn compliance_uncertainty(&self) -> f64 {
        let sliding = self.compliance_u_um_per_n.map(from_um);
        self.compliance_u_rad_per_n_m.or(sliding).unwrap_or(0.0)
    }

    /// Backlash and its standard uncertainty, rad or m.
    pub(super) fn backlash(&self) -> Option<[f64; 2]> {
        let rad = |deg: Option<f64>| deg.map(from_deg);
        let m = |mm: Option<f64>| mm.map(from_mm);
        let gap = rad(self.backlash_deg).or(m(self.backlash_mm))?;
        let u = rad(self.backlash_u_deg).or(m(self.backlash_u_mm));
        Some([gap, u.unwrap_or(0.0)])
    }
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct CouplingEntry {
    /// Name of the earlier joint.
    pub joint: String,
    /// Factor of its position in that of this joint.
    pub factor: f64,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct OtherLimitsEntry {
    /// Lower and upper limit.
    pub limits_deg: [f64; 2],
    /// Key of the source.
    pub source: String,
    /// Remark on the difference.
    pub note: Option<String>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct FrameEntry {
    /// Its name, such as `controller`.
    pub name: String,
    /// Its origin in base_link.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub origin_mm: [f64; 3],
    /// Rotation about the fixed axes x, y, z of base_link.
    #[serde(default)]
    pub rotation_deg: [f64; 3],
    /// Key of the source.
    #[serde(rename = "source")]
    pub _source: String,
    /// Its description.
    #[serde(rename = "note")]
    pub _note: Option<String>,
}

/// A body of a link: all of the link is inside of its bodies.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct BodyEntry {
    /// Attachment: `base`, a joint's name (the link after it), or `flange`.
    pub at: String,
    /// Its name; after its attachment if left out.
    pub name: Option<String>,
    /// All within half the diameter of a segment, in the frame of the attachment.
    pub capsule_mm: Option<RoundTable>,
    /// A cylinder with flat ends, in the frame of the attachment.
    pub cylinder_mm: Option<RoundTable>,
    /// A box along the axes of the frame of the attachment.
    pub box_mm: Option<BoxTable>,
    /// Largest distance of its surface from the link.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub accuracy_mm: Option<f64>,
    /// Key of the source.
    pub source: String,
}

/// What is known of the clearance of the bodies.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ClearanceTable {
    /// Pairs of bodies that are apart in every posture, by name: these are not checked.
    #[schemars(length(max = 1000))]
    pub apart: Vec<[String; 2]>,
    /// Key of the source.
    #[serde(rename = "source")]
    pub _source: String,
}

/// The rotor of a motor, which moves with its joint.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct MotorTable {
    /// Name of its joint.
    pub joint: String,
    /// Inertia of the rotor about its axis, brake and input shaft included.
    #[schemars(range(min = 0.0, max = 1e3))]
    pub rotor_inertia_kg_m2: f64,
    /// Turns of the motor per turn of the joint.
    #[schemars(range(min = -1e5, max = 1e5))]
    pub ratio: Option<f64>,
    /// Travel per turn of the motor, prismatic joints.
    #[schemars(range(min = 0.01, max = 1e6))]
    pub lead_mm: Option<f64>,
    /// Key of the source.
    #[serde(rename = "source")]
    pub _source: String,
}

/// Damping of the vibration of the arm, the same for every mode.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct DampingTable {
    /// Damping ratio: damping over critical damping.
    #[schemars(range(min = 0.0, max = 0.99))]
    pub ratio: f64,
    /// Key of the source.
    #[serde(rename = "source")]
    pub _source: String,
}

/// A spring between a fixed point and a point of the arm.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct CompensatorTable {
    /// Name of the joint that it supports.
    pub joint: String,
    /// From the joint's axis to the fixed point (a).
    #[schemars(range(min = 1.0, max = 1e6))]
    pub fixed_radius_mm: f64,
    /// From the joint's axis to the point of the arm (L).
    #[schemars(range(min = 1.0, max = 1e6))]
    pub arm_radius_mm: f64,
    /// Length of the spring without force (s0).
    #[schemars(range(min = 0.0, max = 1e6))]
    pub free_length_mm: f64,
    /// Stiffness of the spring.
    #[schemars(range(min = 0.0, max = 1e9))]
    pub stiffness_n_per_mm: f64,
    /// Chain position of the joint, sign reversed, where the spring is longest (alpha).
    #[schemars(range(min = -360.0, max = 360.0))]
    pub angle_deg: f64,
    /// Key of the source.
    #[serde(rename = "source")]
    pub _source: String,
}

/// Covariance of compliances that were identified together.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct CovarianceTable {
    /// Names of the compliances: joints, and springs as `A2 about x`.
    pub of: Vec<String>,
    /// The matrix row by row, in the order of `of`.
    #[schemars(inner(inner(range(min = -1.0, max = 1.0))))]
    pub matrix_rad2_per_n2_m2: Vec<Vec<f64>>,
    /// Key of the source.
    #[serde(rename = "source")]
    pub _source: String,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RepeatabilityTable {
    /// Pose repeatability RP of ISO 9283, as data sheets state it after a plus-minus.
    #[schemars(range(min = 0.0, max = 30.0))]
    pub pose_mm: f64,
    /// Key of the source.
    #[serde(rename = "source")]
    pub _source: String,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ModelErrorTable {
    /// Standard uncertainty of a predicted deviation in addition to that of the compliances: the error at validation
    /// tests.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub percent: f64,
    /// Key of the source.
    #[serde(rename = "source")]
    pub _source: String,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct PayloadTable {
    /// Greatest mass at the flange.
    #[schemars(range(min = 0.0))]
    pub mass_kg: f64,
    /// Key of the source.
    #[serde(rename = "source")]
    pub _source: String,
}

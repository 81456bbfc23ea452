//! The robot file unchanged: its tables and keys.

use schemars::JsonSchema;
use serde::Deserialize;

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
    /// Maker and type, for people.
    pub name: String,
    /// What a user should know before trusting the numbers.
    pub note: Option<String>,
    /// Branch that represents the robot where none is requested, such as `front elbow-up`.
    pub nominal_branch: Option<String>,
    /// Elementary motions from base to flange.
    pub chain: ChainTable,
    /// Joints, in the order of the chain.
    #[schemars(length(max = 64))]
    pub joint: Vec<JointEntry>,
    /// Frames that positions may be counted from, beside base_link.
    #[schemars(length(max = 1000))]
    #[serde(default)]
    pub frame: Vec<FrameEntry>,
    /// What yields beside the drives.
    #[schemars(length(max = 1000))]
    #[serde(default)]
    pub spring: Vec<SpringTable>,
    /// What gravity pulls on.
    #[schemars(length(max = 1000))]
    #[serde(default)]
    pub mass: Vec<MassTable>,
    /// The spring that contains a joint against gravity.
    pub compensator: Option<CompensatorTable>,
    /// Covariance of compliances that were identified together.
    pub covariance: Option<CovarianceTable>,
    /// How much the arm scatters from time to time.
    pub repeatability: Option<RepeatabilityTable>,
    /// How much of what it predicts the model misses.
    pub model_error: Option<ModelErrorTable>,
    /// Greatest load at the flange.
    pub payload: Option<PayloadTable>,
    /// Where the numbers come from, by key.
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
    /// Rotation about this axis, by the right hand.
    pub about: Option<AxisName>,
    /// How far along.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub length_mm: Option<f64>,
    /// How far about.
    #[schemars(range(min = -360.0, max = 360.0))]
    pub angle_deg: Option<f64>,
    /// Name of the joint that makes the motion.
    pub joint: Option<String>,
    /// Symbol in the source, for people.
    pub symbol: Option<String>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct JointEntry {
    /// The maker's name.
    pub name: String,
    /// 1 if the controller counts by the right hand about the chain's axis, -1 if against it.
    #[schemars(range(min = -1, max = 1))]
    pub sign: i8,
    /// Chain angle at the controller's zero.
    pub zero_offset_deg: Option<f64>,
    /// Chain position at the controller's zero, sliding joints.
    pub zero_offset_mm: Option<f64>,
    /// Earlier joints that add to this one's count.
    #[serde(default)]
    pub coupling: Vec<CouplingEntry>,
    /// Lower and upper limit in the controller's counting.
    pub limits_deg: Option<[f64; 2]>,
    /// Lower and upper limit, sliding joints.
    pub limits_mm: Option<[f64; 2]>,
    /// Greatest speed.
    #[schemars(range(min = 0.0))]
    pub max_speed_deg_per_s: Option<f64>,
    /// Greatest speed, sliding joints.
    #[schemars(range(min = 0.0))]
    pub max_speed_mm_per_s: Option<f64>,
    /// Key of the source of sign, zero, limits and speed.
    pub source: String,
    /// Compliance about the axis, drive and control loop included.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub compliance_rad_per_n_m: Option<f64>,
    /// Standard uncertainty of the compliance.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub compliance_u_rad_per_n_m: Option<f64>,
    /// Compliance along the axis, sliding joints.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub compliance_um_per_n: Option<f64>,
    /// Standard uncertainty of the compliance, sliding joints.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub compliance_u_um_per_n: Option<f64>,
    /// Torque and angle, pair by pair, in place of one compliance; where the load raises the torque.
    #[schemars(inner(inner(range(min = -1e9, max = 1e9))))]
    pub torque_curve_n_m_rad: Option<Vec<[f64; 2]>>,
    /// The same where the load lowers the torque; the other one holds both ways if this is left out.
    #[schemars(inner(inner(range(min = -1e9, max = 1e9))))]
    pub torque_curve_falling_n_m_rad: Option<Vec<[f64; 2]>>,
    /// Key of the source of the compliance.
    pub compliance_source: Option<String>,
    /// Key of the source of its standard uncertainty; that of the compliance if left out.
    pub compliance_u_source: Option<String>,
    /// Backlash: the whole gap between motor and link.
    #[schemars(range(min = 0.0, max = 5.0))]
    pub backlash_deg: Option<f64>,
    /// Standard uncertainty of the backlash.
    #[schemars(range(min = 0.0, max = 5.0))]
    pub backlash_u_deg: Option<f64>,
    /// Backlash, sliding joints.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub backlash_mm: Option<f64>,
    /// Standard uncertainty of the backlash, sliding joints.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub backlash_u_mm: Option<f64>,
    /// What decides on which flank the link lies; `motion` if left out.
    pub backlash_side: Option<BacklashSideName>,
    /// Key of the source of the backlash.
    pub backlash_source: Option<String>,
    /// Limits by other sources; told to the user, never enforced.
    #[serde(default)]
    pub other_limits: Vec<OtherLimitsEntry>,
}

/// What decides on which flank of its gap a link lies.
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
        let sliding = self.compliance_um_per_n.map(|um| um * 1e-6);
        self.compliance_rad_per_n_m.or(sliding)
    }

    /// Its standard uncertainty, same unit; zero where none is reported.
    pub(super) fn compliance_uncertainty(&self) -> f64 {
        let sliding = self.compliance_u_um_per_n.map(|um| um * 1e-6);
        self.compliance_u_rad_per_n_m.or(sliding).unwrap_or(0.0)
    }

    /// Backlash and its standard uncertainty, rad or m.
    pub(super) fn backlash(&self) -> Option<[f64; 2]> {
        let rad = |deg: Option<f64>| deg.map(f64::to_radians);
        let m = |mm: Option<f64>| mm.map(|mm| mm * 1e-3);
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
    /// What part of its position adds to this joint's count.
    pub factor: f64,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct OtherLimitsEntry {
    /// Lower and upper limit.
    pub limits_deg: [f64; 2],
    /// Key of the source.
    pub source: String,
    /// What to make of it.
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
    /// Turn about the fixed axes x, y, z of base_link.
    #[serde(default)]
    pub rotation_deg: [f64; 3],
    /// Key of the source.
    #[serde(rename = "source")]
    pub _source: String,
    /// What it is.
    #[serde(rename = "note")]
    pub _note: Option<String>,
}

/// A spring between a point that stands still and a point of the arm.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct CompensatorTable {
    /// Name of the joint that it holds.
    pub joint: String,
    /// From the joint's axis to the point that stands still (a).
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
    /// Chain position of the joint, sign turned, where the spring is longest (alpha).
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
    /// Which: joints, and springs as `A2 about x`.
    pub of: Vec<String>,
    /// Row by row, in that order.
    #[schemars(inner(inner(range(min = -1.0, max = 1.0))))]
    pub matrix_rad2_per_n2_m2: Vec<Vec<f64>>,
    /// Key of the source.
    #[serde(rename = "source")]
    pub _source: String,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RepeatabilityTable {
    /// Pose repeatability RP of ISO 9283, as data sheets tell it after a plus-minus.
    #[schemars(range(min = 0.0, max = 30.0))]
    pub pose_mm: f64,
    /// Key of the source.
    #[serde(rename = "source")]
    pub _source: String,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ModelErrorTable {
    /// Standard uncertainty of a predicted deviation beside that of the compliances: what tests that were left out miss by.
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

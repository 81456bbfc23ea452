//! What is known of a robot, as JSON: `armill robots`, `armill robots NAME`, `armill robots import`.
//!
//! A revolute joint is reported in deg and rad/(N m), a prismatic one in mm and µm/N, under keys that name the unit.

use armill_core::robot::{Amount, Axis, Joint, Motion, Robot, reach};
use armill_core::units::to_mm;
use armill_formats::robot::RobotDescription;
use armill_formats::sources::Source;
use schemars::JsonSchema;
use serde::Serialize;

pub use crate::body_answers::attachment_name;
use crate::body_answers::{BodyDetails, pairs_apart};
use crate::compliance_class::ComplianceClass;
use crate::error::StudyError;
use crate::joint_unit::JointUnit;
use crate::number::{decimals, without_rounding};
use crate::structure_answers::StructureDetails;
use crate::{library, robots};

/// A row of the list of robots.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RobotRow {
    /// Its name in the library.
    pub name: String,
    /// Maker and type.
    pub title: String,
    /// Payload, if known.
    pub payload_kg: Option<f64>,
    /// Reach of the wrist centre from axis 1, to a micrometre; none for a robot without wrist centre.
    pub reach_mm: Option<f64>,
    /// Method of the inverse kinematics: `closed_form`, `polished`, `searched`.
    pub inverse: &'static str,
    /// Whether its joint compliances are known.
    #[serde(rename = "compliance")]
    pub compliance_known: bool,
    /// Class of compliances that can be assumed for its payload; none if they are known, or if no class fits its joints.
    pub compliance_class: Option<&'static str>,
}

impl RobotRow {
    /// The row of a robot that the library calls `name`.
    pub fn of(name: &str, found: &RobotDescription) -> RobotRow {
        RobotRow {
            name: name.to_owned(),
            title: found.title.clone(),
            payload_kg: found.payload_kg,
            reach_mm: reach(&found.robot).map(|m| decimals(to_mm(m), 3)),
            inverse: found.robot.inverse().word(),
            compliance_known: found.robot.compliance().is_some(),
            compliance_class: assumed_class(found).map(ComplianceClass::name),
        }
    }
}

/// The class that can be assumed for a robot without known compliances.
fn assumed_class(found: &RobotDescription) -> Option<ComplianceClass> {
    let class = found
        .payload_kg
        .map_or(ComplianceClass::Medium, ComplianceClass::of_payload);
    let fits = found.robot.compliance().is_none() && class.compliance_of(&found.robot).is_ok();
    fits.then_some(class)
}

/// The rows of the library; every robot of it is read for this.
///
/// # Errors
/// Never in practice: the built-in files can be read.
pub fn library_rows() -> Result<Vec<RobotRow>, StudyError> {
    let row = |entry: &library::Embedded| {
        let found = robots::find(entry.name, ".".as_ref())?;
        Ok(RobotRow::of(entry.name, &found))
    };
    library::ROBOTS.iter().map(row).collect()
}

/// Everything that is known of one robot.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RobotDetails {
    /// Its name in the library, or of its file.
    pub name: String,
    /// Maker and type.
    pub title: String,
    /// What a user should know before trusting it.
    pub note: Option<String>,
    /// Its zeros, frames and origin in words.
    pub description: Option<String>,
    /// Elementary motions as text, base to flange.
    pub chain: Vec<String>,
    /// Joints with signs and zeros of the controller, base to flange.
    pub joints: Vec<JointDetails>,
    /// Springs and masses apart from the drives.
    pub structure: StructureDetails,
    /// Bodies of its links, for clearance.
    pub bodies: Vec<BodyDetails>,
    /// Pairs of these bodies that are apart in every posture, by name.
    pub apart: Vec<[String; 2]>,
    /// The nominal branch, used if none is specified.
    pub nominal_branch: String,
    /// Method of the inverse kinematics: `closed_form`, `polished`, `searched`.
    pub inverse: &'static str,
    /// Frames in which positions can be given.
    pub frames: Vec<FrameDetails>,
    /// Payload, if known.
    pub payload_kg: Option<f64>,
    /// Assumptions made when its file was read.
    pub assumed: Vec<String>,
    /// Reach of the wrist centre from axis 1; none for a robot without wrist centre.
    pub reach_mm: Option<f64>,
    /// Sources of its numbers.
    pub sources: Vec<Source>,
}

/// A joint with sign and zero of the controller.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct JointDetails {
    /// The maker's name.
    pub name: String,
    /// 1 if it is positive by the right-hand rule about its axis in the chain, -1 if negative.
    pub sign: f64,
    /// Numbers in the units of the joint.
    #[serde(flatten)]
    pub numbers: JointNumbers,
    /// Key of the source of sign, limits and speed.
    pub source: Option<String>,
    /// Key of the source of the compliance.
    pub compliance_source: Option<String>,
    /// Key of the source of its standard uncertainty.
    pub compliance_u_source: Option<String>,
}

/// Numbers of a joint; none where they are not known.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum JointNumbers {
    /// It turns.
    Turning {
        /// Compliance.
        compliance_rad_per_n_m: Option<f64>,
        /// Its standard uncertainty.
        compliance_u_rad_per_n_m: Option<f64>,
        /// Chain position at the controller's zero.
        zero_offset_deg: f64,
        /// Least and greatest position.
        limits_deg: Option<[f64; 2]>,
        /// Greatest speed.
        max_speed_deg_per_s: Option<f64>,
    },
    /// For a prismatic joint.
    Sliding {
        /// Compliance.
        compliance_um_per_n: Option<f64>,
        /// Its standard uncertainty.
        compliance_u_um_per_n: Option<f64>,
        /// Chain position at the controller's zero.
        zero_offset_mm: f64,
        /// Least and greatest position.
        limits_mm: Option<[f64; 2]>,
        /// Greatest speed.
        max_speed_mm_per_s: Option<f64>,
    },
}

/// A frame in which positions can be given.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct FrameDetails {
    /// Its name.
    pub name: String,
    /// Its origin in `base_link`.
    pub origin_mm: [f64; 3],
}

/// What came of a robot file of another format.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ImportedRobot {
    /// The file that was written; none if it was printed.
    pub file: Option<String>,
    /// The text of the file, if it was printed.
    pub text: Option<String>,
    /// Manufacturer and type, if its file gives them.
    pub title: String,
    /// Names of its joints.
    pub joints: Vec<String>,
    /// Method of the inverse kinematics.
    pub inverse: &'static str,
    /// What was assumed.
    pub assumed: Vec<String>,
    /// Joints whose limits are not in its file.
    pub without_limits: Vec<String>,
}

impl ImportedRobot {
    /// The robot `found`, with `text` in the format of armill, written to `file`.
    pub fn of(found: &RobotDescription, file: Option<String>, text: &str) -> ImportedRobot {
        let joints = found.robot.joints();
        let names = |joints: &[&Joint]| joints.iter().map(|joint| joint.name.clone()).collect();
        ImportedRobot {
            text: file.is_none().then(|| text.to_owned()),
            file,
            title: found.title.clone(),
            joints: names(&joints.iter().collect::<Vec<_>>()),
            inverse: found.robot.inverse().word(),
            assumed: found.remarks.clone(),
            without_limits: names(&joints.iter().filter(|j| j.limits.is_none()).collect::<Vec<_>>()),
        }
    }
}

impl RobotDetails {
    /// Everything that is known of the robot.
    pub fn of(found: &RobotDescription) -> RobotDetails {
        let robot = &found.robot;
        let frames = robot.frames().iter().map(|frame| FrameDetails {
            name: frame.name.clone(),
            origin_mm: to_mm(frame.base_from_frame.translation.vector).into(),
        });
        RobotDetails {
            name: robot.name().to_owned(),
            title: found.title.clone(),
            note: found.note.clone(),
            description: found.description.clone(),
            chain: chain(found),
            joints: (0..robot.joints().len())
                .map(|index| JointDetails::of(found, index))
                .collect(),
            structure: StructureDetails::of(robot),
            bodies: BodyDetails::all_of(found),
            apart: pairs_apart(found),
            nominal_branch: robot.nominal_branch().to_string(),
            inverse: robot.inverse().word(),
            frames: frames.collect(),
            payload_kg: found.payload_kg,
            assumed: found.remarks.clone(),
            reach_mm: reach(robot).map(|m| without_rounding(to_mm(m))),
            sources: found.sources.clone(),
        }
    }
}

impl JointDetails {
    /// Joint `index`, in its units.
    fn of(found: &RobotDescription, index: usize) -> JointDetails {
        let robot = &found.robot;
        let (joint, note) = (&robot.joints()[index], &found.joint_notes[index]);
        let unit = JointUnit::of(robot, index);
        let given = |value: f64| without_rounding(value * unit.scale);
        let compliance = robot.compliance().map(|all| all[index]);
        let value = compliance.map(|c| c.value * unit.compliance_scale);
        let u = compliance
            .and_then(|c| c.known_uncertainty())
            .map(|u| u * unit.compliance_scale);
        let zero_offset = given(joint.zero_offset);
        let limits = joint
            .limits
            .map(|limits| [given(limits.lower), given(limits.upper)]);
        let max_speed = joint.max_speed.map(given);
        let numbers = if robot.slides(index) {
            JointNumbers::Sliding {
                compliance_um_per_n: value,
                compliance_u_um_per_n: u,
                zero_offset_mm: zero_offset,
                limits_mm: limits,
                max_speed_mm_per_s: max_speed,
            }
        } else {
            JointNumbers::Turning {
                compliance_rad_per_n_m: value,
                compliance_u_rad_per_n_m: u,
                zero_offset_deg: zero_offset,
                limits_deg: limits,
                max_speed_deg_per_s: max_speed,
            }
        };
        JointDetails {
            name: joint.name.clone(),
            sign: joint.sign.factor(),
            numbers,
            source: note.source.clone(),
            compliance_source: note.compliance_source.clone(),
            compliance_u_source: note.compliance_u_source.clone(),
        }
    }
}

/// The chain as text, one elementary motion each: `along z 450 mm (H)`, `about y by U, left-handed`.
pub fn chain(found: &RobotDescription) -> Vec<String> {
    let motions = found.robot.chain().motions().iter();
    let words = motions.zip(&found.symbols).map(|(motion, symbol)| {
        let symbol = symbol
            .as_ref()
            .map_or(String::new(), |symbol| format!(" ({symbol})"));
        let (way, axis, amount) = match *motion {
            Motion::Along(axis, amount) => ("along", axis, amount),
            Motion::About(axis, amount) => ("about", axis, amount),
        };
        let unit = match motion {
            Motion::Along(..) => JointUnit::SLIDING,
            Motion::About(..) => JointUnit::TURNING,
        };
        let axis = match axis {
            Axis::X => "x",
            Axis::Y => "y",
            Axis::Z => "z",
        };
        match amount {
            Amount::Constant(value) => {
                format!(
                    "{way} {axis} {} {}{symbol}",
                    without_rounding(value * unit.scale),
                    unit.name
                )
            }
            Amount::Joint(joint) => {
                format!("{way} {axis} by {}{symbol}", of_joint(&found.robot, joint, unit))
            }
        }
    });
    words.collect()
}

/// A joint with the relation between its position and its rotation in the chain.
fn of_joint(robot: &Robot, index: usize, unit: JointUnit) -> String {
    let joint = &robot.joints()[index];
    let against = if joint.sign.factor() < 0.0 {
        ", left-handed"
    } else {
        ""
    };
    let zero = if joint.zero_offset == 0.0 {
        String::new()
    } else {
        format!(", zero at {:.4} {}", joint.zero_offset * unit.scale, unit.name)
    };
    let coupled = joint
        .coupling
        .iter()
        .map(|c| format!(", plus {} x {}", c.factor, robot.joints()[c.joint].name));
    format!("{}{against}{zero}{}", joint.name, coupled.collect::<String>())
}

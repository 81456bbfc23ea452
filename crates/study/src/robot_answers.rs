//! What is known of a robot, as JSON: `armill robots`, `armill robots NAME`, `armill robots import`.
//!
//! A joint that turns is told in deg and rad/(N m), one that slides in mm and µm/N, under keys that say so.

use armill_core::robot::{Amount, Axis, Joint, Motion, Robot, Attachment, TorqueCurve, reach};
use armill_formats::robot::RobotDescription;
use armill_formats::sources::Source;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::StudyError;
use crate::joint_unit::JointUnit;
use crate::number::{decimals, without_rounding};
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
    /// Reach of the wrist centre from axis 1, to a micrometre; none of an arm without wrist centre.
    pub reach_mm: Option<f64>,
    /// How its postures are found: `closed_form`, `polished`, `searched`.
    pub inverse: &'static str,
    /// Whether its joint compliances are known.
    #[serde(rename = "compliance")]
    pub compliance_known: bool,
}

impl RobotRow {
    /// The row of a robot that the library calls `name`.
    pub fn of(name: &str, found: &RobotDescription) -> RobotRow {
        RobotRow {
            name: name.to_owned(),
            title: found.title.clone(),
            payload_kg: found.payload_kg,
            reach_mm: reach(&found.robot).map(|m| decimals(m * 1e3, 3)),
            inverse: found.robot.inverse().word(),
            compliance_known: found.robot.compliance().is_some(),
        }
    }
}

/// The rows of the library; every robot of it is read for this.
///
/// # Errors
/// Never in practice: what is built in reads.
pub fn library_rows() -> Result<Vec<RobotRow>, StudyError> {
    let row = |entry: &library::Embedded| {
        let found = robots::find(entry.name, ".".as_ref())?;
        Ok(RobotRow::of(entry.name, &found))
    };
    library::ROBOTS.iter().map(row).collect()
}

/// Everything that is known of one robot.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct KnownRobot {
    /// Its name in the library, or of its file.
    pub name: String,
    /// Maker and type.
    pub title: String,
    /// What a user should know before trusting it.
    pub note: Option<String>,
    /// Elementary motions in words, base to flange.
    pub chain: Vec<String>,
    /// Joints as their controller counts them, base to flange.
    pub joints: Vec<KnownJoint>,
    /// What yields and weighs beside the drives.
    pub structure: KnownStructure,
    /// The branch that stands for this robot where none is asked for.
    pub nominal_branch: String,
    /// How its postures are found: `closed_form`, `polished`, `searched`.
    pub inverse: &'static str,
    /// Frames that positions may be counted from.
    pub frames: Vec<KnownFrame>,
    /// Payload, if known.
    pub payload_kg: Option<f64>,
    /// What the reader of its file assumed.
    pub assumed: Vec<String>,
    /// Reach of the wrist centre from axis 1; none of an arm without wrist centre.
    pub reach_mm: Option<f64>,
    /// Where its numbers come from.
    pub sources: Vec<Source>,
}

/// A joint as its controller counts it.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct KnownJoint {
    /// The maker's name.
    pub name: String,
    /// 1 where it counts by the right hand about its axis in the chain, -1 against it.
    pub sign: f64,
    /// Numbers in the units of its kind.
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
    /// It slides.
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

/// What yields and weighs beside the drives.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct KnownStructure {
    /// Springs.
    pub springs: Vec<KnownSpring>,
    /// Masses.
    pub masses: Vec<KnownMass>,
    /// Curves in place of compliances of drives.
    pub torque_curves: Vec<KnownCurve>,
    /// The gravity compensator, if there is one.
    pub compensator: Option<KnownCompensator>,
    /// Whether the covariance of the compliances is known.
    pub covariance_known: bool,
    /// Standard deviation of where the tool comes to rest from time to time, along any axis; zero where it is not known.
    pub scatter_um: f64,
    /// Standard uncertainty of what the model predicts, beside that of its compliances; zero where it is not known.
    pub model_error_percent: f64,
}

/// A direction in which the arm yields.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct KnownSpring {
    /// Its seat: `base`, a joint, `flange`, `tool`.
    pub at: String,
    /// A twist at the seat in the seat's axes, translation first.
    pub direction: [f64; 6],
    /// How much it yields, in the unit of its kind.
    #[serde(flatten)]
    pub compliance: SpringCompliance,
}

/// How much a spring yields.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum SpringCompliance {
    /// It turns.
    Turning {
        /// Compliance.
        compliance_rad_per_n_m: f64,
        /// Its standard uncertainty.
        compliance_u_rad_per_n_m: f64,
    },
    /// It slides; its direction may turn on the way, rad a metre.
    Sliding {
        /// Compliance.
        compliance_um_per_n: f64,
        /// Its standard uncertainty.
        compliance_u_um_per_n: f64,
    },
}

/// A mass.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct KnownMass {
    /// Its seat.
    pub at: String,
    /// How much.
    pub mass_kg: f64,
    /// Its centre in the seat's frame.
    pub centre_mm: [f64; 3],
}

/// The torque curve of a joint.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct KnownCurve {
    /// The joint.
    pub joint: String,
    /// Pairs of torque and angle where the load raises the torque; everywhere if there is no other.
    // unit: N m, rad
    pub torque_curve_n_m_rad: Vec<[f64; 2]>,
    /// The same where the load lowers it.
    pub torque_curve_falling_n_m_rad: Option<Vec<[f64; 2]>>,
}

/// A gravity compensator; lengths and angle as in a robot file.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct KnownCompensator {
    /// The joint that it holds.
    pub joint: String,
    /// From the axis to the end that stands still.
    pub fixed_radius_mm: f64,
    /// From the axis to the end on the arm.
    pub arm_radius_mm: f64,
    /// Length without force.
    pub free_length_mm: f64,
    /// Of the spring.
    pub stiffness_n_per_mm: f64,
    /// The spring is longest at the chain position `-angle` of the joint.
    pub angle_deg: f64,
}

/// A frame that positions may be counted from.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct KnownFrame {
    /// Its name.
    pub name: String,
    /// Its origin in `base_link`.
    pub origin_mm: [f64; 3],
}

/// What came of a robot file of another format.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ImportedRobot {
    /// The file that was made; none where it was printed.
    pub file: Option<String>,
    /// The file itself, where none was made.
    pub text: Option<String>,
    /// Maker and type, as far as its file says.
    pub title: String,
    /// Names of its joints.
    pub joints: Vec<String>,
    /// How its postures are found.
    pub inverse: &'static str,
    /// What was assumed.
    pub assumed: Vec<String>,
    /// Joints whose limits its file does not tell.
    pub without_limits: Vec<String>,
}

impl ImportedRobot {
    /// The robot `found`, which is `text` as a file of ours, made at `file`.
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

impl KnownRobot {
    /// Everything that is known of the robot.
    pub fn of(found: &RobotDescription) -> KnownRobot {
        let robot = &found.robot;
        let frames = robot.frames().iter().map(|frame| KnownFrame {
            name: frame.name.clone(),
            origin_mm: (frame.base_from_frame.translation.vector * 1e3).into(),
        });
        KnownRobot {
            name: robot.name().to_owned(),
            title: found.title.clone(),
            note: found.note.clone(),
            chain: chain(found),
            joints: (0..robot.joints().len())
                .map(|index| KnownJoint::of(found, index))
                .collect(),
            structure: KnownStructure::of(robot),
            nominal_branch: robot.nominal_branch().to_string(),
            inverse: robot.inverse().word(),
            frames: frames.collect(),
            payload_kg: found.payload_kg,
            assumed: found.remarks.clone(),
            reach_mm: reach(robot).map(|m| without_rounding(m * 1e3)),
            sources: found.sources.clone(),
        }
    }
}

impl KnownJoint {
    /// Joint `index`, in the units of its kind.
    fn of(found: &RobotDescription, index: usize) -> KnownJoint {
        let robot = &found.robot;
        let (joint, note) = (&robot.joints()[index], &found.joint_notes[index]);
        let unit = JointUnit::of(robot, index);
        let given = |value: f64| without_rounding(value * unit.scale);
        let compliance = robot.compliance().map(|all| all[index]);
        let value = compliance.map(|c| c.value * unit.compliance_scale);
        let u = compliance.map(|c| c.standard_uncertainty * unit.compliance_scale);
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
        KnownJoint {
            name: joint.name.clone(),
            sign: joint.sign.factor(),
            numbers,
            source: note.source.clone(),
            compliance_source: note.compliance_source.clone(),
            compliance_u_source: note.compliance_u_source.clone(),
        }
    }
}

impl KnownStructure {
    /// What its file tells beside the drives, in the units of such files.
    fn of(robot: &Robot) -> KnownStructure {
        let structure = robot.structure();
        let name = |joint: usize| robot.joints()[joint].name.clone();
        let springs = structure.springs.iter().map(|spring| {
            let (value, u) = (spring.compliance.value, spring.compliance.standard_uncertainty);
            let turns = spring.direction.linear.norm() == 0.0;
            KnownSpring {
                at: attachment_name(robot, spring.attachment),
                direction: spring.direction.to_vector().into(),
                compliance: if turns {
                    SpringCompliance::Turning {
                        compliance_rad_per_n_m: value,
                        compliance_u_rad_per_n_m: u,
                    }
                } else {
                    SpringCompliance::Sliding {
                        compliance_um_per_n: value * 1e6,
                        compliance_u_um_per_n: u * 1e6,
                    }
                },
            }
        });
        let masses = structure.masses.iter().map(|mass| KnownMass {
            at: attachment_name(robot, mass.attachment),
            mass_kg: mass.mass,
            centre_mm: (mass.centre.coords * 1e3).into(),
        });
        let curves = (0..robot.joints().len()).filter_map(|joint| {
            let curve = structure.curve(joint)?;
            let points = |curve: &TorqueCurve| curve.points().to_vec();
            Some(KnownCurve {
                joint: name(joint),
                torque_curve_n_m_rad: points(&curve.rising),
                torque_curve_falling_n_m_rad: curve.falling.as_ref().map(points),
            })
        });
        KnownStructure {
            springs: springs.collect(),
            masses: masses.collect(),
            torque_curves: curves.collect(),
            compensator: structure.compensator.map(|c| KnownCompensator {
                joint: name(c.joint),
                fixed_radius_mm: c.fixed_radius * 1e3,
                arm_radius_mm: c.arm_radius * 1e3,
                free_length_mm: c.free_length * 1e3,
                stiffness_n_per_mm: c.stiffness * 1e-3,
                angle_deg: c.angle.to_degrees(),
            }),
            covariance_known: structure.covariance.is_some(),
            scatter_um: structure.repeatability * 1e6,
            model_error_percent: without_rounding(structure.model_error * 100.0),
        }
    }
}

/// What a seat is called in files and answers.
pub fn attachment_name(robot: &Robot, attachment: Attachment) -> String {
    match attachment {
        Attachment::Base => "base".to_owned(),
        Attachment::Joint(joint) => robot.joints()[joint].name.clone(),
        Attachment::Flange => "flange".to_owned(),
        Attachment::Tool => "tool".to_owned(),
    }
}

/// The chain in words, one elementary motion each: `along z 450 mm (H)`,
/// `about y by U, counted against the right hand`.
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

/// A joint with what lies between its count and its turn in the chain.
fn of_joint(robot: &Robot, index: usize, unit: JointUnit) -> String {
    let joint = &robot.joints()[index];
    let against = if joint.sign.factor() < 0.0 {
        ", counted against the right hand"
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

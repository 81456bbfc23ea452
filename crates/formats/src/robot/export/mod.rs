//! Robots out, for other programs: calibrated geometry and stiffness included where the format has words for them.
//!
//! | format | module | contains |
//! |---|---|---|
//! | URDF | `urdf` | chain, limits, speeds, masses, shapes |
//! | xacro with its arguments in YAML | `xacro` | the same; the pose of each joint in a YAML file |
//! | calibration file of `ur_description` | [`ur_yaml`] | poses of the six joints of an arm like those of Universal Robots |
//! | Denavit-Hartenberg table | [`dh_table`], `dh_rows` | chain, limits |
//! | SDF | `sdf` | as URDF; springs |
//! | MJCF of MuJoCo | `mjcf` | as URDF; springs, inertia of rotors |
//!
//! `linkage` (bodies and joints; with `names`, `elasticity`) is common to them; `left_out` names what a format does not express, `spelling` writes
//! numbers, `shapes` the shapes of links.
//!
//! Positions of joints are those of the robot file. A number that is not known is not written; where a format requires one, it is marked as a
//! placeholder in the file and in a warning.

mod dh_rows;
mod dh_table;
mod elasticity;
mod left_out;
mod linkage;
mod mjcf;
mod names;
mod sdf;
mod shapes;
mod spelling;
mod ur_yaml;
mod urdf;
mod xacro;

use std::str::FromStr;

use armill_core::frame::Isometry;
use armill_core::robot::{Attachment, Robot};

pub use self::dh_table::DhConvention;
use self::linkage::Linkage;
pub(super) use self::ur_yaml::{KEYS as UR_KEYS, LINKS as UR_LINKS};
use super::RobotDescription;

/// A format that robots are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExportFormat {
    /// URDF.
    Urdf,
    /// xacro, with its arguments in a YAML file.
    Xacro,
    /// Calibration file of `ur_description`.
    Ur,
    /// Denavit-Hartenberg table.
    Dh,
    /// SDF.
    Sdf,
    /// MJCF.
    Mjcf,
}

impl ExportFormat {
    /// Every format.
    pub const ALL: [ExportFormat; 6] = [
        ExportFormat::Urdf,
        ExportFormat::Xacro,
        ExportFormat::Ur,
        ExportFormat::Dh,
        ExportFormat::Sdf,
        ExportFormat::Mjcf,
    ];

    /// Its name, as `--format` takes it.
    pub fn name(self) -> &'static str {
        match self {
            ExportFormat::Urdf => "urdf",
            ExportFormat::Xacro => "xacro",
            ExportFormat::Ur => "ur",
            ExportFormat::Dh => "dh",
            ExportFormat::Sdf => "sdf",
            ExportFormat::Mjcf => "mjcf",
        }
    }

    /// The format of files with this ending (without point, any case).
    pub fn of_ending(ending: &str) -> Option<ExportFormat> {
        match ending.to_lowercase().as_str() {
            "urdf" => Some(ExportFormat::Urdf),
            "xacro" => Some(ExportFormat::Xacro),
            "yaml" | "yml" => Some(ExportFormat::Ur),
            "dh" | "csv" => Some(ExportFormat::Dh),
            "sdf" => Some(ExportFormat::Sdf),
            "mjcf" | "xml" => Some(ExportFormat::Mjcf),
            _ => None,
        }
    }
}

impl FromStr for ExportFormat {
    type Err = String;

    /// The format of this name.
    ///
    /// # Errors
    /// A name that no format has; the message lists those that they have.
    fn from_str(name: &str) -> Result<ExportFormat, String> {
        let found = ExportFormat::ALL.into_iter().find(|format| format.name() == name);
        found.ok_or_else(|| {
            let names = ExportFormat::ALL.map(ExportFormat::name).join(", ");
            format!("`{name}` is none of {names}")
        })
    }
}

/// How joints that are coupled to earlier ones are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoupledJoints {
    /// A further joint follows the earlier one (`mimic`): positions are those of the robot file.
    Follower,
    /// Positions are those of the joint itself, `q + k q'`.
    Own,
}

/// How the compliance of an arm is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ExportedStiffness {
    /// Not at all: a rigid arm.
    #[default]
    None,
    /// Each joint is a spring around a given position, without a drive; springs of the structure are passive joints.
    Joints,
    /// A passive joint with a spring behind each drive, and for each spring of the structure.
    Passive,
}

/// A mesh that the source of a robot names.
#[derive(Clone, Debug)]
pub struct ExportedMesh {
    /// What it moves with.
    pub attachment: Attachment,
    /// Its pose there.
    pub attachment_from_mesh: Isometry,
    /// The file, as the source names it.
    pub file: String,
    /// Factors along its axes that make metres of it.
    pub scale: [f64; 3],
    /// Whether it is how the link looks, or its coarser shape for collisions.
    pub looks: bool,
}

/// What a user may decide.
#[derive(Clone, Debug, Default)]
pub struct ExportOptions {
    /// How coupled joints are written; without a decision they are refused.
    pub coupling: Option<CoupledJoints>,
    /// How the compliance is written.
    pub stiffness: ExportedStiffness,
    /// Joint positions without load, rad (m), of the robot file; for [`ExportedStiffness::Joints`].
    pub joints: Option<Vec<f64>>,
    /// Convention of a Denavit-Hartenberg table.
    pub convention: DhConvention,
    /// Why compliances are not those of this robot, if so.
    pub caution: Option<String>,
    /// Meshes of the links.
    pub meshes: Vec<ExportedMesh>,
    /// Name of the file of arguments that a xacro reads, next to it.
    pub arguments_file: Option<String>,
}

impl ExportOptions {
    /// The position of joint `index` in the exported file, rad (m).
    ///
    /// # Errors
    /// No positions, or another number of them.
    fn positions(&self, robot: &Robot, index: usize) -> Result<f64, ExportError> {
        let joints = robot.joints().len();
        let given = self.joints.as_deref().ok_or(ExportError::NoPosture)?;
        if given.len() != joints {
            return Err(ExportError::PostureCount {
                given: given.len(),
                joints,
            });
        }
        let coupled = robot.joints()[index].coupling.iter();
        Ok(match self.coupling {
            Some(CoupledJoints::Own) => {
                given[index] + coupled.map(|c| c.factor * given[c.joint]).sum::<f64>()
            }
            _ => given[index],
        })
    }
}

/// A written robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    /// The text of the file.
    pub text: String,
    /// The text of the file of arguments that belongs to it.
    pub arguments: Option<String>,
    /// What a user should know, one sentence each; each begins with the consequence.
    pub warnings: Vec<String>,
}

/// Why a robot is not written.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ExportError {
    /// A coupled joint, and no decision.
    #[error(
        "joint {joint} is coupled to joint {other}: the position on its controller is not the angle between its links"
    )]
    Coupled {
        /// The joint.
        joint: String,
        /// The joint that it is coupled to.
        other: String,
    },
    /// A follower in a format without them.
    #[error("{0} has no joint that follows another")]
    NoFollower(&'static str),
    /// Springs in a format without them.
    #[error("{0} cannot express stiffness")]
    NoStiffness(&'static str),
    /// Stiffness of a robot whose compliances are not known.
    #[error("the joint compliances of this robot are not known, so that no stiffness can be written")]
    NoCompliance,
    /// A joint without compliance that should be a spring.
    #[error("the compliance of joint {0} is 0: it cannot be a spring")]
    Rigid(String),
    /// Springs around a posture that is not given.
    #[error("springs in the joints keep one posture, which is not given")]
    NoPosture,
    /// Another number of positions than joints.
    #[error("{given} joint positions for {joints} joints")]
    PostureCount {
        /// Positions.
        given: usize,
        /// Joints.
        joints: usize,
    },
    /// A prismatic joint without limits in a format that requires them.
    #[error("prismatic joint {0} has no limits, which a URDF requires")]
    NoLimits(String),
    /// An arm that is not like those of Universal Robots.
    #[error("a UR calibration file cannot describe this robot: {0}")]
    NotUr(String),
    /// Axes whose common normal is too far away.
    #[error(
        "joints {first} and {second} are parallel within {angle_deg:.2e} deg: the common normal of their axes is {distance:.3e} m away"
    )]
    FarNormal {
        /// The joint before.
        first: String,
        /// The joint behind.
        second: String,
        /// Angle between their axes.
        angle_deg: f64,
        /// Distance of the common normal, m.
        distance: f64,
    },
}

impl ExportError {
    /// How to correct it.
    pub fn hint(&self) -> &'static str {
        match self {
            ExportError::Coupled { .. } => {
                "--coupling own writes the angle between the links, --coupling mimic a further joint that follows (URDF, xacro, SDF)"
            }
            ExportError::NoFollower(_) => "--coupling own writes the angle between the links",
            ExportError::NoStiffness(_) => "--format sdf and --format mjcf can",
            ExportError::NoCompliance => {
                "--compliance-rad-per-n-m gives them, --compliance-class assumes them by payload"
            }
            ExportError::Rigid(_) => "--stiffness passive leaves rigid joints without a spring",
            ExportError::NoPosture | ExportError::PostureCount { .. } => {
                "--joints-deg gives one position for each joint"
            }
            ExportError::NoLimits(_) => "add limits_mm to its robot file",
            ExportError::NotUr(_) => "--format urdf describes any serial robot",
            ExportError::FarNormal { .. } => {
                "--convention hayati turns such axes about y instead, --convention standard and modified need the normal"
            }
        }
    }
}

/// A robot in this format.
///
/// # Errors
/// What the format cannot express and would make of the robot another one: see [`ExportError`].
pub fn export(
    found: &RobotDescription,
    format: ExportFormat,
    options: &ExportOptions,
) -> Result<Exported, ExportError> {
    if options.stiffness != ExportedStiffness::None
        && !matches!(format, ExportFormat::Sdf | ExportFormat::Mjcf)
    {
        return Err(ExportError::NoStiffness(title(format)));
    }
    if options.coupling == Some(CoupledJoints::Follower)
        && !matches!(
            format,
            ExportFormat::Urdf | ExportFormat::Xacro | ExportFormat::Sdf
        )
        && found
            .robot
            .joints()
            .iter()
            .any(|joint| !joint.coupling.is_empty())
    {
        return Err(ExportError::NoFollower(title(format)));
    }
    let mut linkage = Linkage::of(found, options)?;
    let mut warnings = std::mem::take(&mut linkage.warnings);
    warnings.extend(options.caution.clone());
    warnings.extend(left_out::left_out(found, format, options));
    let head = head(found, format, &warnings);
    let mut exported = match format {
        ExportFormat::Urdf => urdf::write(&linkage, &head),
        ExportFormat::Xacro => xacro::write(found, (&linkage, options), &head),
        ExportFormat::Ur => ur_yaml::write(found, &head),
        ExportFormat::Dh => dh_table::write(found, (&linkage, options), &head),
        ExportFormat::Sdf => Ok(sdf::write(&linkage.with_rigid_flange(), &head)),
        ExportFormat::Mjcf => Ok(mjcf::write(found, (&linkage.with_rigid_flange(), options), &head)),
    }?;
    warnings.append(&mut exported.warnings);
    exported.warnings = warnings;
    Ok(exported)
}

/// How a format is called in a sentence.
fn title(format: ExportFormat) -> &'static str {
    match format {
        ExportFormat::Urdf => "URDF",
        ExportFormat::Xacro => "xacro",
        ExportFormat::Ur => "a UR calibration file",
        ExportFormat::Dh => "a Denavit-Hartenberg table",
        ExportFormat::Sdf => "SDF",
        ExportFormat::Mjcf => "MJCF",
    }
}

/// The first lines of a file, for people.
fn head(found: &RobotDescription, format: ExportFormat, warnings: &[String]) -> Vec<String> {
    let mut lines = vec![
        format!(
            "{} ({}), written by armill {} as {}.",
            found.title,
            found.robot.name(),
            env!("CARGO_PKG_VERSION"),
            title(format)
        ),
        "Joint positions have the signs and zeros of the robot file.".to_owned(),
    ];
    lines.extend(
        found
            .sources
            .iter()
            .map(|source| format!("Source `{}`: {}; {}", source.key, source.what, source.place)),
    );
    lines.extend(warnings.iter().map(|warning| format!("Note: {warning}.")));
    lines
}

#[cfg(test)]
mod tests;

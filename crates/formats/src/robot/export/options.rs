//! What a user may decide about an exported robot, and what comes of it.

use armill_core::frame::Isometry;
use armill_core::robot::{Attachment, Robot};

use super::convention::DhConvention;
use super::error::ExportError;

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
    pub(super) fn positions(&self, robot: &Robot, index: usize) -> Result<f64, ExportError> {
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

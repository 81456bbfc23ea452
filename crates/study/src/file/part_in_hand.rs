//! A part in the hand of the robot: the robot holds the part, and the tool stands in the cell.
//!
//! Robot and tool become one chain, from the flange to the mount of the tool ([`armill_core::robot::hand`]): its base is the
//! flange, so that what is given of the part is constant while the robot moves. In study and results joints have the order of the
//! robot ([`crate::joint_order`]).
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `base_from_mount` | position of the tool's mount, `base_from_mount_mm_deg` | m, rad |

use armill_core::frame::Isometry;
use armill_core::robot::model::NamedFrame;
use armill_core::robot::positioner::Positioner;
use armill_core::robot::{Attachment, Mass, Robot, RobotError};
use armill_core::units::from_mm;
use armill_formats::robot::RobotDescription;

use crate::error::StudyError;
use crate::file::format::{PartInHandTable, StudyFile};
use crate::input::problem_log::ProblemLog;
use crate::input::quantities::pose_mm_deg;
use crate::naming::FLANGE;

/// This robot with the part in its hand.
///
/// # Errors
/// What the chain cannot have, such as external axes in front of the arm.
pub(super) fn holding(table: &PartInHandTable, arm: &Robot) -> Result<Robot, StudyError> {
    let mut structure = arm.structure().clone();
    let springs = structure.springs.iter().map(|spring| spring.attachment);
    let mut attachments = springs.chain(structure.masses.iter().map(|mass| mass.attachment));
    if attachments.any(|attachment| attachment == Attachment::Tool) {
        let message = format!(
            "the file of robot `{}` has a spring or a mass at the tool",
            arm.name()
        );
        let hint = "the robot of `[part_in_hand]` has no tool: attach it to the flange";
        return Err(StudyError::value(message, hint));
    }
    structure.masses.extend(table.mass.iter().map(|mass| Mass {
        attachment: Attachment::Flange,
        mass: mass.mass_kg,
        centre: mass.centre_mm.map(from_mm).into(),
        inertia: None,
        relative_uncertainty: 0.0,
    }));
    let base_from_mount = pose_mm_deg(&table.base_from_mount_mm_deg);
    let robot = arm.clone().with_structure(structure).map_err(refused)?;
    let robot = robot.holding_part(&base_from_mount).map_err(refused)?;
    Ok(robot.with_frames(vec![NamedFrame {
        name: FLANGE.to_owned(),
        base_from_frame: Isometry::identity(),
    }]))
}

/// The robot with the part in its hand, with its notes and bodies.
///
/// # Errors
/// See [`holding`].
pub(super) fn described(
    table: &PartInHandTable,
    mut found: RobotDescription,
) -> Result<RobotDescription, StudyError> {
    let robot = holding(table, &found.robot)?;
    let base = Isometry::identity();
    let read_back = Positioner {
        robot: &found.robot,
        base_from_root: &base,
        home: &[],
    };
    for body in &mut found.bodies {
        let (attachment, new_from_old) = read_back.attached(body.attachment);
        body.attachment = attachment;
        body.attachment_from_body = new_from_old * body.attachment_from_body;
    }
    found.symbols.reverse();
    found.symbols.resize(robot.chain().motions().len(), None);
    found.joint_notes.reverse();
    found.robot = robot;
    Ok(found)
}

fn refused(error: RobotError) -> StudyError {
    StudyError::value(
        error.to_string(),
        "`[part_in_hand]` needs a robot without external axes, which holds the part on its flange",
    )
}

/// Reports a positioner next to a part in the hand.
pub(super) fn check(log: &mut ProblemLog<'_>, file: &StudyFile) {
    if file.positioner.is_some() {
        let message = "a part is either on a positioner or in the hand of the robot";
        log.problem("positioner", message, "remove `[positioner]` or `[part_in_hand]`");
    }
}

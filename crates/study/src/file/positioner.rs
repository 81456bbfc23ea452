//! A turntable or positioner that carries the part: a second kinematic chain.
//!
//! Robot and positioner become one chain, from the table to the flange ([`armill_core::robot::positioner`]): its base is the
//! table, so that what is given of the part is constant while the table moves. Its joints are external axes in front of
//! those of the robot; they stand at `joints_deg` unless a search moves them.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `base_from_root` | position of the positioner, `base_from_root_mm_deg` | m, rad |
//! | `q` | its joint positions, `joints_deg` | rad (m) |
//!
//! Its other springs and its repeatability are neglected.

use std::path::Path;

use armill_core::clearance::{ArmBody, Role};
use armill_core::frame::Isometry;
use armill_core::robot::RobotError;
use armill_core::robot::model::NamedFrame;
use armill_core::robot::positioner::{Positioner, moved};
use armill_core::robot::{Attachment, Mass, Robot};
use armill_core::units::from_mm;
use armill_formats::robot::{BodyNote, JointNote, RobotDescription};
use armill_formats::sources::Source;

use crate::error::StudyError;
use crate::file::format::PositionerTable;
use crate::input::problem_log::ProblemLog;
use crate::input::quantities::pose_mm_deg;
use crate::joint_order::joint_positions;
use crate::joint_unit::JointUnit;
use crate::naming::{BASE_LINK, TABLE};
use crate::robots;

/// A positioner that was found, and where it stands.
pub(super) struct FoundPositioner {
    described: RobotDescription,
    base_from_root: Isometry,
    home: Vec<f64>,
}

/// The positioner of this table; `None` where something is wrong, which is reported.
///
/// # Errors
/// The problems of the positioner's file.
pub(super) fn find(
    log: &mut ProblemLog<'_>,
    table: &PositionerTable,
    folder: &Path,
    robot: &Robot,
) -> Result<Option<FoundPositioner>, StudyError> {
    let mut described = match robots::find(&table.robot, folder) {
        Ok(found) => found,
        Err(StudyError::Value { message, hint }) => {
            log.problem("positioner.robot", message, &hint);
            return Ok(None);
        }
        Err(problems) => return Err(problems),
    };
    let home = match joint_positions(&described.robot, &table.joints_deg) {
        Ok(home) => home,
        Err(StudyError::Value { message, hint }) => {
            log.problem("positioner.joints_deg", message, &hint);
            return Ok(None);
        }
        Err(problems) => return Err(problems),
    };
    check_limits(log, &described.robot, &home);
    let names = |robot: &Robot| {
        robot
            .joints()
            .iter()
            .map(|joint| joint.name.clone())
            .collect::<Vec<_>>()
    };
    let own = names(robot);
    if let Some(name) = names(&described.robot)
        .into_iter()
        .find(|name| own.contains(name))
    {
        let message = format!("robot and positioner both have a joint `{name}`");
        log.problem(
            "positioner.robot",
            message,
            "rename it in the file of the positioner",
        );
        return Ok(None);
    }
    if robot.frames().iter().any(|frame| frame.name == TABLE) {
        let message = format!("the robot has a frame `{TABLE}` already");
        log.problem("positioner", message, "rename the frame in the robot file");
        return Ok(None);
    }
    let mut structure = described.robot.structure().clone();
    structure.masses.extend(table.mass.iter().map(|mass| Mass {
        attachment: Attachment::Flange,
        mass: mass.mass_kg,
        centre: mass.centre_mm.map(from_mm).into(),
        inertia: None,
        relative_uncertainty: 0.0,
    }));
    described.robot = described.robot.with_structure(structure).map_err(refused)?;
    Ok(Some(FoundPositioner {
        described,
        base_from_root: pose_mm_deg(&table.base_from_root_mm_deg),
        home,
    }))
}

/// Reports the joint that is farthest outside its range.
fn check_limits(log: &mut ProblemLog<'_>, positioner: &Robot, home: &[f64]) {
    let Some((joint, outside)) = positioner.limit_margin(home).filter(|(_, margin)| *margin < 0.0) else {
        return;
    };
    let (name, unit) = (&positioner.joints()[joint].name, JointUnit::of(positioner, joint));
    let beyond = -outside * unit.scale;
    let message = format!(
        "the positioner's joint {name} is {beyond:.1} {} outside its range",
        unit.name
    );
    let hint = "see `armill robots FILE` for its limits";
    log.problem("positioner.joints_deg", message, hint);
}

fn refused(error: RobotError) -> StudyError {
    StudyError::value(error.to_string(), "see the positioner's file and its position")
}

impl FoundPositioner {
    fn positioner(&self) -> Positioner<'_> {
        Positioner {
            robot: &self.described.robot,
            base_from_root: &self.base_from_root,
            home: &self.home,
        }
    }

    /// This arm behind the positioner, with the frames `base_link` and `table`.
    ///
    /// # Errors
    /// What the chain cannot have, such as coupled joints of the positioner.
    pub(super) fn under(&self, arm: &Robot) -> Result<Robot, StudyError> {
        let robot = arm
            .on_positioner(&self.positioner(), BASE_LINK)
            .map_err(refused)?;
        let mut frames = robot.frames().to_vec();
        frames.push(NamedFrame {
            name: TABLE.to_owned(),
            base_from_frame: Isometry::identity(),
        });
        Ok(robot.with_frames(frames))
    }

    /// The robot behind the positioner, with its sources, notes and bodies.
    ///
    /// # Errors
    /// See [`FoundPositioner::under`].
    pub(super) fn described(&self, mut found: RobotDescription) -> Result<RobotDescription, StudyError> {
        let own = &self.described;
        let count = own.robot.joints().len();
        let motions = found.robot.chain().motions().len();
        found.robot = self.under(&found.robot)?;
        let added = found.robot.chain().motions().len() - motions;
        found.symbols.splice(0..0, vec![None; added]);
        let key = |key: &Option<String>| key.as_ref().map(|key| own_key(key));
        let notes = own.joint_notes.iter().rev().map(|note| JointNote {
            source: key(&note.source),
            compliance_source: key(&note.compliance_source),
            compliance_u_source: key(&note.compliance_u_source),
            other_limits: Vec::new(),
        });
        let notes: Vec<JointNote> = notes.collect();
        found.joint_notes.splice(0..0, notes);
        for body in &mut found.bodies {
            if body.attachment == Attachment::Base {
                body.attachment_from_body =
                    found.robot.chain().ground().joint_from_ground * body.attachment_from_body;
            }
            body.attachment = moved(body.attachment, count);
        }
        let first = found.bodies.len();
        found.bodies.extend(own.bodies.iter().map(|body| {
            let (attachment, new_from_old) = self.positioner().attached(body.attachment);
            ArmBody {
                role: match body.attachment {
                    // It does not ride on the arm, whose first link may come near it.
                    Attachment::Base => Role::Obstacle,
                    _ => body.role,
                },
                attachment,
                attachment_from_body: new_from_old * body.attachment_from_body,
                ..body.clone()
            }
        }));
        found
            .body_notes
            .extend(own.body_notes.iter().map(|note| BodyNote {
                source: own_key(&note.source),
                ..note.clone()
            }));
        let apart = own.apart.iter().map(|pair| pair.map(|body| body + first));
        found.apart.extend(apart);
        found.sources.extend(own.sources.iter().map(|source| Source {
            key: own_key(&source.key),
            ..source.clone()
        }));
        Ok(found)
    }
}

/// The key of a source of the positioner among those of the robot.
fn own_key(key: &str) -> String {
    format!("positioner:{key}")
}

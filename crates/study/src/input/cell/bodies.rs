//! The bodies that a study gives to all its analyses: links, obstacles, the part, and the demanded clearance.

use std::path::Path;

use armill_core::clearance::{ArmBody, FixedBody, Role, Shape};
use armill_core::frame::Isometry;
use armill_core::robot::Attachment;
use armill_core::units::from_mm;
use armill_formats::robot::RobotDescription;

use crate::error::StudyError;
use crate::input::cell::links::LinkBodies;
use crate::input::cell::shape::shape_of;
use crate::input::cell::tables::{ObstacleTable, PartTable};
use crate::input::problem_log::ProblemLog;
use crate::input::quantities::pose_mm_deg;
use crate::input::tables::ToolTable;

/// The tables of a study that are about its cell.
#[derive(Clone, Copy, Debug)]
pub struct CellTables<'a> {
    /// What stands in the cell.
    pub obstacles: &'a [ObstacleTable],
    /// The part.
    pub part: Option<&'a PartTable>,
    /// The demanded clearance.
    pub least_clearance_mm: Option<f64>,
    /// The robot as the study names it.
    pub robot: &'a str,
    /// Whether any tool of the study has bodies.
    pub tool_has_bodies: bool,
}

/// A body with its position in its frame.
#[derive(Clone, Debug)]
pub struct NamedShape {
    /// Its name.
    pub name: String,
    /// Its shape.
    pub shape: Shape,
    /// From the frame that it is given in.
    pub frame_from_body: Isometry,
}

/// The bodies of a study.
#[derive(Clone, Debug)]
pub struct CellBodies {
    /// Links of the robot.
    pub links: Vec<ArmBody>,
    /// Pairs of links that are apart in every posture.
    pub apart: Vec<[usize; 2]>,
    /// Of each link whether the tool is not checked against it, since its body is too coarse.
    pub is_coarse: Vec<bool>,
    /// What stands in the cell, in the reference frame.
    pub obstacles: Vec<NamedShape>,
    /// The part, in its own frame.
    pub part: Option<NamedShape>,
    /// The demanded clearance, m.
    pub least: f64,
    /// What a user should know of them.
    pub notes: Vec<String>,
}

impl CellBodies {
    /// The bodies of these tables; `None` where the study has none of them, and where they have problems.
    ///
    /// # Errors
    /// The problems of a mesh file.
    pub fn read(
        log: &mut ProblemLog<'_>,
        tables: &CellTables<'_>,
        robot: &RobotDescription,
        folder: &Path,
    ) -> Result<Option<CellBodies>, StudyError> {
        let asked = tables.least_clearance_mm.is_some() || tables.part.is_some() || tables.tool_has_bodies;
        if tables.obstacles.is_empty() && !asked {
            return Ok(None);
        }
        let before = log.problems.len();
        let mut notes = Vec::new();
        let mut obstacles: Vec<NamedShape> = Vec::new();
        for (index, table) in tables.obstacles.iter().enumerate() {
            let path = format!("obstacle[{index}]");
            if obstacles.iter().any(|other| other.name == table.name) {
                let message = format!("two obstacles are called `{}`", table.name);
                log.problem(&format!("{path}.name"), message, "a name of its own for each");
            }
            if let Some(found) = shape_of(log, &path, table.shape(), folder)? {
                notes.extend(found.notes);
                obstacles.push(NamedShape {
                    name: table.name.clone(),
                    shape: found.shape,
                    frame_from_body: pose_or_none(table.base_from_obstacle_mm_deg.as_ref()),
                });
            }
        }
        let mut part = None;
        if let Some(table) = tables.part
            && let Some(found) = shape_of(log, "part", table.shape(), folder)?
        {
            notes.extend(found.notes);
            part = Some(NamedShape {
                name: "part".to_owned(),
                shape: found.shape,
                frame_from_body: pose_or_none(table.part_from_body_mm_deg.as_ref()),
            });
        }
        let LinkBodies {
            links,
            apart,
            is_coarse,
            notes: of_links,
        } = LinkBodies::of(robot, tables.robot, folder)?;
        notes.extend(of_links);
        Ok((log.problems.len() == before).then_some(CellBodies {
            links,
            apart,
            is_coarse,
            obstacles,
            part,
            least: from_mm(tables.least_clearance_mm.unwrap_or(0.0)),
            notes,
        }))
    }
}

/// The bodies of a tool; `None` if they have problems, reported at their keys.
///
/// # Errors
/// The problems of a mesh file.
pub fn tool_bodies(
    log: &mut ProblemLog<'_>,
    tool: Option<&ToolTable>,
    folder: &Path,
) -> Result<Option<Vec<ArmBody>>, StudyError> {
    let mut bodies = Vec::new();
    let mut complete = true;
    for (index, table) in tool.iter().flat_map(|tool| &tool.body).enumerate() {
        let path = format!("tool.body[{index}]");
        let Some(found) = shape_of(log, &path, table.shape(), folder)? else {
            complete = false;
            continue;
        };
        let role = if table.cuts { Role::Cutter } else { Role::Holder };
        let usual = if table.cuts { "cutter" } else { "tool" };
        bodies.push(ArmBody {
            name: table.name.clone().unwrap_or_else(|| usual.to_owned()),
            attachment: Attachment::Flange,
            attachment_from_body: pose_or_none(table.flange_from_body_mm_deg.as_ref()),
            shape: found.shape,
            role,
        });
    }
    Ok(complete.then_some(bodies))
}

fn pose_or_none(pose: Option<&[f64; 6]>) -> Isometry {
    pose.map_or_else(Isometry::identity, pose_mm_deg)
}

/// A body that stands still, whose frame is at `frame`.
pub(super) fn fixed(body: &NamedShape, frame: &Isometry, is_part: bool) -> FixedBody {
    FixedBody {
        name: body.name.clone(),
        shape: body.shape.clone(),
        frame_from_body: frame * body.frame_from_body,
        is_part,
    }
}

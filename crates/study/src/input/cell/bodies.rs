//! The bodies that a study gives to all its analyses: links, obstacles, the part, and the demanded clearance.

use std::path::Path;

use armill_core::clearance::{ArmBody, Role};
use armill_core::form::superposition;
use armill_core::frame::Isometry;
use armill_core::nalgebra::Point3;
use armill_core::robot::Attachment;
use armill_core::units::{from_mm, to_mm};
use armill_formats::robot::RobotDescription;

use crate::error::StudyError;
use crate::input::cell::carried::{CarriedBody, joint_in_front, slab, under_the_arm};
use crate::input::cell::links::LinkBodies;
use crate::input::cell::named_shape::{FLOOR, NamedShape};
use crate::input::cell::shape::shape_of;
use crate::input::cell::tables::{FloorTable, ObstacleTable, PartTable, PedestalTable};
use crate::input::problem_log::ProblemLog;
use crate::input::quantities::{pose_mm_deg, reference_from_part};
use crate::input::tables::{PlaneTable, ToolTable};

/// The tables of a study that are about its cell.
#[derive(Clone, Copy, Debug)]
pub struct CellTables<'a> {
    /// What stands in the cell.
    pub obstacles: &'a [ObstacleTable],
    /// What the robot stands on.
    pub pedestal: Option<&'a PedestalTable>,
    /// The floor.
    pub floor: Option<FloorTable>,
    /// The part.
    pub part: Option<&'a PartTable>,
    /// The plane of the study, which the part is on.
    pub plane: &'a PlaneTable,
    /// The demanded clearance.
    pub least_clearance_mm: Option<f64>,
    /// The robot as the study names it.
    pub robot: &'a str,
    /// Whether any tool of the study has bodies.
    pub tool_has_bodies: bool,
}

/// Names of the bodies that a study has once.
pub(super) const PART: &str = "part";
const PEDESTAL: &str = "pedestal";

/// The bodies of a study.
#[derive(Clone, Debug)]
pub struct CellBodies {
    /// Links of the robot.
    pub links: Vec<ArmBody>,
    /// Pairs of links that are apart in every posture.
    pub apart: Vec<[usize; 2]>,
    /// Of each link whether the tool or part in the hand is not checked against it, since its body is too coarse.
    pub is_coarse: Vec<bool>,
    /// What stands in the cell, in the reference frame.
    pub obstacles: Vec<NamedShape>,
    /// What carries the arm or rides with it.
    pub carried: Vec<CarriedBody>,
    /// Height of the floor in the reference frame, m.
    pub floor: Option<f64>,
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
        let around = tables.pedestal.is_some() || tables.floor.is_some() || !tables.obstacles.is_empty();
        if !asked && !around {
            return Ok(None);
        }
        let before = log.problems.len();
        let mut notes = Vec::new();
        refuse_equal_names(log, tables);
        let (mut obstacles, mut carried) = (Vec::new(), Vec::new());
        let ground = robot.robot.chain().ground();
        for (index, table) in tables.obstacles.iter().enumerate() {
            let path = format!("obstacle[{index}]");
            let on = table.on.as_ref();
            let on = on.map(|joint| joint_in_front(log, &format!("{path}.on"), joint, &robot.robot));
            let Some(found) = shape_of(log, &path, table.shape(), folder)? else {
                continue;
            };
            notes.extend(found.notes);
            let body = NamedShape {
                name: table.name.clone(),
                shape: found.shape,
                frame_from_body: pose_or_none(table.base_from_obstacle_mm_deg.as_ref()),
                table: path,
            };
            match on {
                None if ground.is_base() => obstacles.push(body),
                None => carried.push(CarriedBody {
                    body,
                    attachment: ground.attachment(),
                    role: Role::Obstacle,
                }),
                Some(joint) => carried.extend(joint.map(|attachment| CarriedBody {
                    body,
                    attachment,
                    role: Role::Link,
                })),
            }
        }
        if let Some(table) = tables.pedestal
            && let Some(found) = shape_of(log, PEDESTAL, table.shape(), folder)?
        {
            notes.extend(found.notes);
            carried.push(CarriedBody {
                body: NamedShape {
                    name: PEDESTAL.to_owned(),
                    shape: found.shape,
                    frame_from_body: pose_or_none(table.base_from_pedestal_mm_deg.as_ref()),
                    table: PEDESTAL.to_owned(),
                },
                attachment: under_the_arm(&robot.robot),
                role: Role::Link,
            });
        }
        let floor = tables.floor.map(|floor| from_mm(floor.height_mm));
        if let Some(height) = floor.filter(|_| !ground.is_base()) {
            carried.push(slab(height, ground.attachment()));
        }
        let mut part = None;
        if let Some(table) = tables.part
            && let Some(found) = shape_of(log, PART, table.shape(), folder)?
        {
            notes.extend(found.notes);
            part = Some(NamedShape {
                name: PART.to_owned(),
                shape: found.shape,
                frame_from_body: part_from_body(log, table, tables.plane, &mut notes),
                table: PART.to_owned(),
            });
        }
        let LinkBodies {
            links,
            apart,
            is_coarse,
            notes: of_links,
        } = LinkBodies::of(robot, tables.robot, folder)?;
        notes.extend(of_links);
        if let Some(least) = tables.least_clearance_mm
            && links.is_empty()
            && !tables.tool_has_bodies
        {
            let message = format!(
                "`least_clearance_mm = {least}`, but neither the tool nor a link of {} has a body that could keep it",
                robot.title
            );
            let hint = "[[tool.body]] for spindle and cutter; a robot of the library, or a URDF with its meshes, for the links";
            log.problem("least_clearance_mm", message, hint);
        }
        Ok((log.problems.len() == before).then_some(CellBodies {
            links,
            apart,
            is_coarse,
            obstacles,
            carried,
            floor: floor.filter(|_| ground.is_base()),
            part,
            least: from_mm(tables.least_clearance_mm.unwrap_or(0.0)),
            notes,
        }))
    }
}

/// Points that do not fit by more than this, relative to their distance from each other, have another unit or order.
const MISFIT: f64 = 0.02;

/// Position of the part on the plane: as given, or from its measured points.
fn part_from_body(
    log: &mut ProblemLog<'_>,
    table: &PartTable,
    plane: &PlaneTable,
    notes: &mut Vec<String>,
) -> Isometry {
    let given = pose_or_none(table.part_from_body_mm_deg.as_ref());
    let Some(points) = &table.points else {
        return given;
    };
    const KEY: &str = "part.points";
    if table.part_from_body_mm_deg.is_some() {
        log.problem(
            KEY,
            "the part has `part_from_body_mm_deg` and `points`",
            "remove one",
        );
        return given;
    }
    let in_si = |mm: &[[f64; 3]]| {
        mm.iter()
            .map(|mm| Point3::from(mm.map(from_mm)))
            .collect::<Vec<_>>()
    };
    let (body, measured) = (in_si(&points.body_mm), in_si(&points.measured_mm));
    let found = match superposition(&body, &measured) {
        Ok(found) => found,
        Err(error) => {
            let hint = "body_mm = [[0, 0, 0], [100, 0, 0], [0, 50, 0]], measured_mm: the same points in the reference frame";
            log.problem(KEY, error.to_string(), hint);
            return given;
        }
    };
    let farthest = |points: &[Point3<f64>]| {
        let from_first = points.iter().map(|point| (point - points[0]).norm());
        from_first.fold(0.0, f64::max)
    };
    let largest = found.residuals.iter().copied().fold(0.0, f64::max);
    if largest > MISFIT * farthest(&body) {
        let message = format!(
            "the measured points do not fit: {:.3} mm are left at one of them, and the body's points are up to {:.1} mm apart",
            to_mm(largest),
            to_mm(farthest(&body))
        );
        log.problem(KEY, message, "check their order, and that both are in mm");
        return given;
    }
    notes.push(format!(
        "the part is placed by {} measured points; the largest distance that is left is {:.3} mm.",
        body.len(),
        to_mm(largest)
    ));
    match reference_from_part(plane) {
        Some((reference_from_part, _)) => reference_from_part.inverse() * found.motion,
        // Reported at the plane.
        None => given,
    }
}

/// Reports obstacles with the name of another body.
fn refuse_equal_names(log: &mut ProblemLog<'_>, tables: &CellTables<'_>) {
    for (index, table) in tables.obstacles.iter().enumerate() {
        let earlier = tables.obstacles[..index].iter();
        let message = if earlier.into_iter().any(|other| other.name == table.name) {
            format!("two obstacles are called `{}`", table.name)
        } else if table.name == PEDESTAL && tables.pedestal.is_some()
            || table.name == FLOOR && tables.floor.is_some()
        {
            format!(
                "an obstacle is called `{}`, as the table [{}]",
                table.name, table.name
            )
        } else {
            continue;
        };
        log.problem(
            &format!("obstacle[{index}].name"),
            message,
            "a name of its own for each",
        );
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

//! Bodies that touch the arm in every posture: their position or their unit is wrong.

use armill_core::clearance::Cell;
use armill_core::nalgebra::Point3;
use armill_core::robot::Robot;
use armill_core::units::to_mm;

use crate::input::cell::AnalysisCell;
use crate::input::cell::bodies::{CellBodies, PART};
use crate::input::cell::placed::CellFrames;
use crate::input::problem_log::ProblemLog;
use crate::number::without_rounding;

/// A base that is less than this below the floor stands on it, m.
const STANDS_ON: f64 = 1e-3;
const HEIGHT_HINT: &str =
    "the height is the z of the floor in the reference frame of the study; the robot is above it";

/// Reports obstacles, pedestal and floor that the arm cannot avoid.
pub fn report_permanent_contacts(
    log: &mut ProblemLog<'_>,
    bodies: &CellBodies,
    robot: &Robot,
    found: &AnalysisCell,
    frames: &CellFrames<'_>,
) {
    let cell: &Cell = &found.cell;
    let mut report = |table: &str, what: &str, body: usize, hint: &str| {
        let message = format!("{what} touches {} in every posture of the robot", cell.name(body));
        log.problem(table, message, hint);
    };
    for [obstacle, body] in cell.permanent_obstacles(robot, frames.flange_from_tool) {
        let obstacle = &bodies.obstacles[obstacle];
        let hint = "is its position right? A room is given by its walls, not by a body around the robot";
        report(
            &obstacle.table,
            &format!("obstacle `{}`", obstacle.name),
            body,
            hint,
        );
    }
    let first_carried = cell.arm().len() - bodies.carried.len();
    let in_hand = robot.chain().ground().part_is_in_hand();
    for [other, body] in cell.always_in_contact() {
        if in_hand && (bodies.links.len()..first_carried).contains(body) {
            let table = format!("tool.body[{}]", body - bodies.links.len());
            let what = format!("`{}`, which stands in the cell,", cell.name(*body));
            report(&table, &what, *other, "is base_from_mount_mm_deg right?");
        } else if let Some(carried) = body.checked_sub(first_carried) {
            let carried = &bodies.carried[carried].body;
            let hint =
                "is its position right? Links next to what it is on are not checked against it; this one is";
            report(&carried.table, &format!("`{}`", carried.name), *other, hint);
        }
    }
    if in_hand {
        for body in cell.always_near_part(robot, frames.base_from_part, 0.0) {
            let hint = "it is relative to the centre of the plane, and that to the flange; are both right?";
            report(PART, "the part in the hand", body, hint);
        }
    }
    let slab = bodies.carried.iter().find(|body| in_hand && body.is_floor());
    let slab = slab.map(|slab| slab.body.frame_from_body.translation.z);
    let Some(height) = bodies.floor.or(slab) else {
        return;
    };
    let base = match in_hand {
        true => Point3::origin(),
        false => frames
            .base_from_reference
            .inverse_transform_point(&Point3::origin()),
    };
    let on_floor = cell.always_on_floor(robot, frames.flange_from_tool);
    if base.z < height - STANDS_ON {
        let [floor, base] = [height, base.z].map(|z| without_rounding(to_mm(z)));
        let message =
            format!("the floor at {floor} mm is above the base of the robot, which is at {base} mm");
        log.problem("floor.height_mm", message, HEIGHT_HINT);
    } else if let Some(body) = on_floor.first() {
        report("floor.height_mm", "the floor", *body, HEIGHT_HINT);
    }
}

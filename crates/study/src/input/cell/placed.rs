//! The cell of an analysis: all bodies, with its tool on the flange and the part on its plane.

use std::sync::Arc;

use armill_core::clearance::{ArmBody, Cell, Floor};
use armill_core::frame::Isometry;
use armill_core::robot::Robot;

use crate::input::cell::AnalysisCell;
use crate::input::cell::bodies::CellBodies;
use crate::input::cell::carried::{CarriedBody, is_near_the_ground};
use crate::input::cell::named_shape::FLOOR;

/// Where the frames of a study are.
#[derive(Clone, Copy, Debug)]
pub struct CellFrames<'a> {
    /// The reference frame of the study.
    pub base_from_reference: &'a Isometry,
    /// The frame of the part.
    pub base_from_part: &'a Isometry,
    /// Flange to tool centre point.
    pub flange_from_tool: &'a Isometry,
}

/// The bodies of an analysis whose arm has this tool.
pub fn placed_cell(
    robot: &Robot,
    bodies: &CellBodies,
    tool: Vec<ArmBody>,
    frames: CellFrames<'_>,
) -> AnalysisCell {
    let obstacles = bodies
        .obstacles
        .iter()
        .map(|body| body.fixed(frames.base_from_reference, false));
    let part = bodies
        .part
        .iter()
        .map(|body| body.fixed(&Isometry::identity(), true));
    let still: Vec<_> = obstacles.chain(part).collect();
    let of_tool = bodies.links.len()..bodies.links.len() + tool.len();
    let part_is_in_hand = robot.chain().ground().part_is_in_hand();
    let coarse = (0..bodies.links.len()).filter(|link| bodies.is_coarse[*link]);
    let coarse: Vec<usize> = coarse.collect();
    let in_hand = if part_is_in_hand { 0..0 } else { of_tool.clone() };
    let unchecked = coarse
        .iter()
        .flat_map(|link| in_hand.clone().map(move |body| [*link, body]));
    let first_carried = of_tool.end;
    let slab = bodies.carried.iter().position(CarriedBody::is_floor);
    let floor_body = slab.map(|index| first_carried + index);
    let above = floor_body.into_iter().flat_map(|slab| {
        let near = bodies.links.iter().enumerate();
        let near = near.filter(|(_, body)| is_near_the_ground(body, robot));
        near.map(move |(link, _)| [link, slab])
    });
    let apart: Vec<[usize; 2]> = bodies
        .apart
        .iter()
        .copied()
        .chain(unchecked)
        .chain(above)
        .collect();
    let carried = bodies
        .carried
        .iter()
        .map(|body| body.placed(robot, frames.base_from_reference));
    let arm = bodies.links.iter().cloned().chain(tool).chain(carried).collect();
    let mut cell = Cell::new(robot, frames.flange_from_tool, arm, &apart, &still);
    let of_floor = |height: f64| frames.base_from_reference * Isometry::translation(0.0, 0.0, height);
    let base_from_floor = bodies.floor.map(of_floor);
    if let Some(plane) = &base_from_floor {
        cell = cell.with_floor(Floor::below(FLOOR, plane, robot));
    }
    let mut cell = cell.for_clearance(robot, frames.flange_from_tool, bodies.least);
    if part_is_in_hand {
        cell = cell
            .apart_from_part(coarse)
            .with_part_in_hand(robot, frames.base_from_part, bodies.least);
    }
    AnalysisCell {
        cell: Arc::new(cell),
        carried: bodies.carried.len(),
        still,
        base_from_part: *frames.base_from_part,
        base_from_floor,
        floor_body,
        least: bodies.least,
    }
}

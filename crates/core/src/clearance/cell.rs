//! The cell: bodies that move with the arm, and bodies that stand still.
//!
//! | pair | checked |
//! |---|---|
//! | bodies of the arm on the same or on adjacent links | no: they touch by design |
//! | bodies in contact in every posture, or which the robot file states to be apart in all | no |
//! | all other bodies that move relative to each other | yes |
//! | the floor and the second or a later link of the arm, its tool | yes |
//! | what carries the arm, and an obstacle that it touches in every posture | no: it rides on it |
//! | a cutter and the part | no: it cuts it |
//! | a holder and the part, the arm and anything that stands still | yes |
//! | a holder or a link, and the stock that is cut along a path | yes, by [`crate::map::measure_stock_clearances`] |
//!
//! If the arm holds the part ([`crate::robot::hand`]), the part is at the base of the chain, and tool and obstacles are bodies of the ground:
//!
//! | pair | checked |
//! |---|---|
//! | the part and the last link of the arm, to which it is fixed | no |
//! | the part and any other body but the cutter | yes |
//! | tool, cutter or obstacle, and any link but the base of the arm | yes |
//! | tool, cutter and obstacles | no: they do not move relative to each other |

use nalgebra::IsometryMatrix3;

use super::bounds::{Bounds, Capsule};
use super::field::Field;
use super::floor::Floor;
use super::mesh::Mesh;
use super::nearest::Nearest;
use super::shape::{Placed, Shape};
use crate::frame::Isometry;
use crate::robot::Attachment;

/// Longest edge of the triangles of a mesh of the arm whose distance is bounded, m.
const PIECE_EDGE: f64 = 0.03;

/// Name of the stock that is cut along a path.
const STOCK: &str = "stock";

/// What a body of the arm is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A link of the robot.
    Link,
    /// Spindle, holder, or another part of the tool that must not touch the part.
    Holder,
    /// The cutter, which may touch the part.
    Cutter,
    /// An obstacle on the ground of a chain whose base, the table of a positioner or the flange that holds the part, moves.
    Obstacle,
}

/// A body that moves with the arm, or stands under it.
#[derive(Clone, Debug)]
pub struct ArmBody {
    /// Its name, for people.
    pub name: String,
    /// What it is attached to.
    pub attachment: Attachment,
    /// From the frame of the attachment to that of its shape.
    pub attachment_from_body: Isometry,
    /// Its shape, in its own frame.
    pub shape: Shape,
    /// What it is.
    pub role: Role,
}

/// A body that stands still.
#[derive(Clone, Debug)]
pub struct FixedBody {
    /// Its name, for people.
    pub name: String,
    /// Its shape.
    pub shape: Shape,
    /// Its position: in the base of the robot, of the part in the frame of the part.
    pub frame_from_body: Isometry,
    /// Whether it is the part, or its stock.
    pub is_part: bool,
}

/// The bodies of a cell.
#[derive(Clone, Debug)]
pub struct Cell {
    pub(super) arm: Vec<ArmBody>,
    pub(super) attachment_from_body: Vec<IsometryMatrix3<f64>>,
    pub(super) hulls: Vec<Capsule>,
    /// Radii of the balls around the hulls, m.
    pub(super) balls: Vec<f64>,
    /// Pairs of bodies of the arm that are checked.
    pub(super) pairs: Vec<[usize; 2]>,
    /// Pairs of bodies of the arm that are in contact in every posture, and so not checked.
    pub(super) always_in_contact: Vec<[usize; 2]>,
    /// Checked pairs that are nearer than the demanded clearance in every posture, such as a spindle and the link before its flange: of these
    /// contact alone is a conflict.
    pub(super) always_near: Vec<[usize; 2]>,
    /// Links that a part in the hand is nearer to than the demanded clearance in every posture: of these contact alone is a conflict.
    pub(super) near_part: Vec<usize>,
    /// Bodies of the arm that are not checked against the part.
    pub(super) apart_from_part: Vec<usize>,
    pub(super) obstacles: Option<Still>,
    pub(super) part: Option<Still>,
    pub(super) floor: Option<Floor>,
    /// Obstacles that what carries the arm rides on: index among the obstacles, and the body of the arm. Not checked.
    pub(super) ridden_on: Vec<[usize; 2]>,
    /// Of each mesh of the arm: the field around it, in its own frame.
    pub(super) own_fields: Vec<Option<Still>>,
    /// Of each mesh of the arm: the same surface in small triangles.
    pub(super) pieces: Vec<Option<Mesh>>,
}

/// Bodies that stand still relative to each other, in their common frame.
#[derive(Clone, Debug)]
pub(super) struct Still {
    names: Vec<String>,
    pub(super) bodies: Vec<Placed>,
    pub(super) field: Field,
}

impl Still {
    pub(super) fn of<'a>(bodies: impl Iterator<Item = &'a FixedBody>) -> Option<Still> {
        let (mut names, mut placed, mut around) = (Vec::new(), Vec::new(), Bounds::EMPTY);
        for body in bodies {
            let frame = matrix(&body.frame_from_body);
            names.push(body.name.clone());
            around = around.joined(&body.shape.bounds().moved(&frame, &frame.rotation.matrix().abs()));
            placed.push(body.shape.placed(&frame));
        }
        (!names.is_empty()).then(|| Still {
            names,
            bodies: placed,
            field: Field::around(&around),
        })
    }

    /// Number of the bodies.
    pub(super) fn len(&self) -> usize {
        self.bodies.len()
    }

    /// A body of the arm alone, in its own frame, if it is a mesh: pairs of other shapes are measured in a moment.
    pub(super) fn of_mesh(body: &ArmBody) -> Option<Still> {
        let Shape::Mesh(mesh) = &body.shape else {
            return None;
        };
        Some(Still {
            names: vec![body.name.clone()],
            bodies: vec![body.shape.placed(&IsometryMatrix3::identity())],
            field: Field::around(mesh.bounds()),
        })
    }

    /// The surface of a body of the arm in small triangles, if it is a mesh.
    pub(super) fn pieces(body: &ArmBody) -> Option<Mesh> {
        match &body.shape {
            Shape::Mesh(mesh) => mesh.in_pieces(PIECE_EDGE),
            _ => None,
        }
    }

    /// The nearest of the bodies that `is_checked` to a body in the same frame, with its index.
    pub(super) fn nearest(
        &self,
        own: &Placed,
        limit: f64,
        is_checked: impl Fn(usize) -> bool,
    ) -> Option<(Nearest, usize)> {
        let mut best: Option<(Nearest, usize)> = None;
        let checked = self.bodies.iter().enumerate();
        for (index, other) in checked.filter(|(index, _)| is_checked(*index)) {
            let limit = best.map_or(limit, |(best, _)| best.distance);
            if own.hull().bound_of_balls(other.hull()) > limit {
                continue;
            }
            if let Some(nearest) = own.nearest(other, limit)
                && best.is_none_or(|(best, _)| nearest.distance < best.distance)
            {
                best = Some((nearest, index));
                if nearest.distance == 0.0 {
                    break;
                }
            }
        }
        best
    }
}

/// The least distance in a posture, and what it is between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// Distance and points, base.
    pub nearest: Nearest,
    /// The two bodies: indices of [`Cell::name`].
    pub bodies: [usize; 2],
}

impl Cell {
    /// Name of a body of a [`Clearance`]: those of the arm first, then obstacles, then the part, then the floor, then the stock.
    pub fn name(&self, index: usize) -> &str {
        let mut names = self.names();
        names.nth(index).map_or(STOCK, String::as_str)
    }

    /// Index of the stock that is cut along a path, which is no body of the cell.
    pub fn stock_index(&self) -> usize {
        self.names().count()
    }

    /// Whether a body of the arm is checked against the part.
    pub(super) fn meets_part(&self, body: usize) -> bool {
        self.arm[body].role != Role::Cutter && !self.apart_from_part.contains(&body)
    }

    /// Whether a body of the arm is checked against the stock that is cut along a path.
    pub(crate) fn meets_stock(&self, body: usize) -> bool {
        self.arm[body].attachment != Attachment::Base && self.meets_part(body)
    }

    fn names(&self) -> impl Iterator<Item = &String> {
        let still = [&self.obstacles, &self.part].into_iter().flatten();
        let arm = self.arm.iter().map(|body| &body.name);
        let floor = self.floor.iter().map(|floor| &floor.name);
        arm.chain(still.flat_map(|still| &still.names)).chain(floor)
    }

    /// The cell with a floor.
    pub fn with_floor(self, floor: Floor) -> Cell {
        Cell {
            floor: Some(floor),
            ..self
        }
    }

    /// The bodies of the arm.
    pub fn arm(&self) -> &[ArmBody] {
        &self.arm
    }

    /// Largest distance of a body of the arm from the origin of its attachment, m.
    pub(super) fn reach_of_body(&self, body: usize) -> f64 {
        let hull = self.hulls[body].moved(&self.attachment_from_body[body]);
        let ends = [hull.axis.from, hull.axis.to].map(|end| end.coords.norm());
        ends[0].max(ends[1]) + hull.radius
    }

    /// Pairs of bodies of the arm that are in contact in every posture: these are not checked.
    pub fn always_in_contact(&self) -> &[[usize; 2]] {
        &self.always_in_contact
    }

    /// Pairs of bodies of the arm that are nearer than the demanded clearance in every posture: of these contact alone is a conflict.
    pub fn always_near(&self) -> &[[usize; 2]] {
        &self.always_near
    }
}

pub(super) fn matrix(isometry: &Isometry) -> IsometryMatrix3<f64> {
    nalgebra::convert(*isometry)
}

/// A cell with its part at a place.
#[derive(Clone, Copy, Debug)]
pub struct PlacedCell<'a> {
    /// The bodies.
    pub cell: &'a Cell,
    /// The frame of the part in base.
    pub base_from_part: &'a Isometry,
}

#[cfg(test)]
impl<'a> PlacedCell<'a> {
    /// With the frame of the part at the base.
    pub(super) fn at_base(cell: &'a Cell) -> PlacedCell<'a> {
        static BASE: std::sync::LazyLock<Isometry> = std::sync::LazyLock::new(Isometry::identity);
        PlacedCell {
            cell,
            base_from_part: &BASE,
        }
    }
}

#[cfg(test)]
mod tests;

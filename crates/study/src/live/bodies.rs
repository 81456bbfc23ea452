//! The bodies of the cell as a page draws them: shapes, each in its own frame, and where these frames are in base. Meshes are
//! sent apart: `body_mesh`.

use armill_core::clearance::{ArmBody, Capsule, CellState, FixedBody, Role, Shape};
use armill_core::frame::Isometry;
use armill_core::nalgebra::{IsometryMatrix3, Point3, UnitQuaternion};
use armill_core::robot::Robot;
use armill_core::units::{from_mm, to_mm};
use schemars::JsonSchema;
use serde::Serialize;

use crate::input::cell::AnalysisCell;
use crate::live::body_mesh::mesh_key;
use crate::number::without_rounding;
use crate::pose::PostureAnswer;

/// Half the edge of the piece of the floor that is drawn, mm.
const FLOOR_HALF_MM: f64 = 3000.0;
/// How thick it is drawn, mm.
const FLOOR_DEPTH_MM: f64 = 10.0;

/// The bodies of a cell.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct CellInScene {
    /// Bodies of the arm and of the tool; their poses are in the drawing of each posture, in this order.
    pub arm: Vec<BodyInScene>,
    /// What stands still: obstacles, then the part, then a piece of the floor.
    pub still: Vec<StillBodyInScene>,
    /// The demanded clearance.
    pub least_clearance_mm: f64,
}

/// A body.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct BodyInScene {
    /// Its name.
    pub name: String,
    /// What it is.
    pub role: BodyRole,
    /// Its shape, in its own frame.
    pub shape: ShapeInScene,
}

/// What a body is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BodyRole {
    /// A link of the robot.
    Link,
    /// Spindle, holder, or another part of the tool that must not touch the part.
    Holder,
    /// A cutter.
    Cutter,
    /// What stands in the cell.
    Obstacle,
    /// The part.
    Part,
}

/// A body that stands still.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct StillBodyInScene {
    /// The body.
    pub body: BodyInScene,
    /// Where it is. Of sections each has a part of its own.
    pub pose: BodyPose,
}

/// The frame of a body, base.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct BodyPose {
    /// Its origin.
    pub xyz_mm: [f64; 3],
    /// Its orientation, unit quaternion.
    pub quaternion_wxyz: [f64; 4],
}

/// The bodies of a cell with the arm in a posture, base.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct DrawnCell {
    /// Bodies of the arm and of the tool, in the order of the scene.
    pub bodies: Vec<BodyPose>,
    /// The nearest points of two bodies; `null` where no two are checked.
    pub nearest_mm: Option<[[f64; 3]; 2]>,
    /// Whether the posture keeps the demanded clearance, without contact.
    pub keeps_clearance: bool,
}

/// A shape in the frame of its body.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum ShapeInScene {
    /// A box along the axes, between two opposite corners.
    Box {
        /// The corner with the least coordinates.
        from_mm: [f64; 3],
        /// The opposite one.
        to_mm: [f64; 3],
    },
    /// A cylinder with flat ends.
    Cylinder {
        /// Centre of one end.
        from_mm: [f64; 3],
        /// Centre of the other end.
        to_mm: [f64; 3],
        /// Its radius.
        radius_mm: f64,
    },
    /// All within a radius of a segment.
    Capsule {
        /// One end of the segment.
        from_mm: [f64; 3],
        /// The other end.
        to_mm: [f64; 3],
        /// The radius.
        radius_mm: f64,
    },
    /// Triangles, which are requested by their key.
    Mesh {
        /// The key: the same for the same triangles.
        key: String,
        /// The corner of the box around it with the least coordinates.
        from_mm: [f64; 3],
        /// The opposite one.
        to_mm: [f64; 3],
    },
}

/// The bodies of this cell.
pub(super) fn cell_in_scene(cell: &AnalysisCell) -> CellInScene {
    CellInScene {
        arm: cell.cell.arm().iter().map(of_arm).collect(),
        still: cell
            .still
            .iter()
            .map(|body| of_still(body, cell))
            .chain(cell.base_from_floor.as_ref().map(of_floor))
            .collect(),
        least_clearance_mm: without_rounding(to_mm(cell.least)),
    }
}

/// Where the part of this cell is; `None` without one.
pub(super) fn pose_of_part(cell: &AnalysisCell) -> Option<BodyPose> {
    let part = cell.still.iter().find(|body| body.is_part)?;
    Some(of_still(part, cell).pose)
}

fn of_arm(body: &ArmBody) -> BodyInScene {
    BodyInScene {
        name: body.name.clone(),
        role: match body.role {
            Role::Link => BodyRole::Link,
            Role::Holder => BodyRole::Holder,
            Role::Cutter => BodyRole::Cutter,
            Role::Obstacle => BodyRole::Obstacle,
        },
        shape: ShapeInScene::of(&body.shape),
    }
}

fn of_still(body: &FixedBody, cell: &AnalysisCell) -> StillBodyInScene {
    let base_from_body = match body.is_part {
        true => cell.base_from_part * body.frame_from_body,
        false => body.frame_from_body,
    };
    StillBodyInScene {
        body: BodyInScene {
            name: body.name.clone(),
            role: if body.is_part {
                BodyRole::Part
            } else {
                BodyRole::Obstacle
            },
            shape: ShapeInScene::of(&body.shape),
        },
        pose: BodyPose::of(
            &base_from_body.translation.vector.into(),
            &base_from_body.rotation,
        ),
    }
}

/// The piece of the floor that is drawn: a plate under the robot.
fn of_floor(base_from_floor: &Isometry) -> StillBodyInScene {
    let centre = base_from_floor.inverse_transform_point(&Point3::origin());
    let at = base_from_floor * Point3::new(centre.x, centre.y, 0.0);
    StillBodyInScene {
        body: BodyInScene {
            name: "floor".to_owned(),
            role: BodyRole::Obstacle,
            shape: ShapeInScene::Box {
                from_mm: [-FLOOR_HALF_MM, -FLOOR_HALF_MM, -FLOOR_DEPTH_MM],
                to_mm: [FLOOR_HALF_MM, FLOOR_HALF_MM, 0.0],
            },
        },
        pose: BodyPose::of(&at, &base_from_floor.rotation),
    }
}

impl ShapeInScene {
    fn of(shape: &Shape) -> ShapeInScene {
        match shape {
            Shape::Box(bounds) => ShapeInScene::Box {
                from_mm: point_mm(&bounds.least),
                to_mm: point_mm(&bounds.greatest),
            },
            Shape::Cylinder(axis, radius) => ShapeInScene::Cylinder {
                from_mm: point_mm(&axis.from),
                to_mm: point_mm(&axis.to),
                radius_mm: without_rounding(to_mm(*radius)),
            },
            Shape::Capsule(Capsule { axis, radius }) => ShapeInScene::Capsule {
                from_mm: point_mm(&axis.from),
                to_mm: point_mm(&axis.to),
                radius_mm: without_rounding(to_mm(*radius)),
            },
            Shape::Mesh(mesh) => ShapeInScene::Mesh {
                key: mesh_key(mesh),
                from_mm: point_mm(&mesh.bounds().least),
                to_mm: point_mm(&mesh.bounds().greatest),
            },
        }
    }
}

impl BodyPose {
    pub(super) fn of(origin: &Point3<f64>, rotation: &UnitQuaternion<f64>) -> BodyPose {
        let turn = rotation.coords;
        BodyPose {
            xyz_mm: point_mm(origin),
            quaternion_wxyz: [turn.w, turn.x, turn.y, turn.z].map(without_rounding),
        }
    }
}

/// The bodies of the arm in base, posture by posture.
pub(super) struct DrawnBodies<'a> {
    cell: &'a AnalysisCell,
    state: CellState<'a>,
}

impl<'a> DrawnBodies<'a> {
    /// Those of this cell, on an arm with this tool.
    pub(super) fn of(
        cell: &'a AnalysisCell,
        robot: &'a Robot,
        flange_from_tool: &Isometry,
    ) -> DrawnBodies<'a> {
        DrawnBodies {
            cell,
            state: CellState::new(cell.placed(), robot, flange_from_tool),
        }
    }

    /// The cell at these joint positions (rad, m); `posture`: the answer there, in the reference frame.
    pub(super) fn drawn(
        &mut self,
        q: &[f64],
        posture: &PostureAnswer,
        base_from_reference: &Isometry,
    ) -> DrawnCell {
        self.state.set_joints(q);
        let pose = |frame: &IsometryMatrix3<f64>| {
            let rotation = UnitQuaternion::from_rotation_matrix(&frame.rotation);
            BodyPose::of(&frame.translation.vector.into(), &rotation)
        };
        let in_base = |at: [f64; 3]| point_mm(&(base_from_reference * from_mm(Point3::from(at))));
        let least_mm = to_mm(self.cell.least);
        DrawnCell {
            bodies: self.state.base_from_body().iter().map(pose).collect(),
            nearest_mm: posture.nearest_mm.map(|points| points.map(in_base)),
            keeps_clearance: posture.clearance_mm.is_none_or(|mm| mm > 0.0 && mm >= least_mm),
        }
    }
}

fn point_mm(at: &Point3<f64>) -> [f64; 3] {
    at.coords.map(|m| without_rounding(to_mm(m))).into()
}

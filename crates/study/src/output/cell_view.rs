//! Pictures of bodies: those of a robot alone, and those of a cell in the posture of least clearance.

use std::path::Path;

use armill_core::clearance::{Cell, CellState, FixedBody, Mesh, PlacedCell, Role, Shape};
use armill_core::frame::Isometry;
use armill_core::nalgebra::{self, IsometryMatrix3, Point3, Vector3};
use armill_core::robot::Robot;
use armill_core::units::to_mm;
use armill_formats::robot::RobotDescription;
use armill_report::{BodyKind, CellBody, CellView, NearestPair};

use crate::analysis::arm::{FromGround, arm_on_ground};
use crate::analysis::picture::Picture;
use crate::analysis::rows::Rows;
use crate::error::StudyError;
use crate::file_names::slug;
use crate::input::cell::links::LinkBodies;
use crate::naming::BASE_LINK;

/// Half the edge of the piece of the floor that is drawn, m.
const FLOOR_HALF: f64 = 50.0;
/// Directions in which the outermost corners of a mesh are drawn.
const OUTERMOST: usize = 300;
/// Corners of the end of a cylinder as it is drawn.
const RIM: usize = 60;

/// The bodies of this robot, which the user calls `name`, with all joints at zero, from two sides; a notice where they are not known.
///
/// # Errors
/// The problems of a mesh file.
pub fn bodies_drawing(found: &RobotDescription, name: &str) -> Result<String, StudyError> {
    let links = LinkBodies::of(found, name, Path::new("."))?.links;
    let count = links.len();
    let robot = &found.robot;
    let zeros = vec![0.0; robot.joints().len()];
    let here = Isometry::identity();
    let cell = Cell::new(robot, &here, links, &[], &[]);
    let placed = PlacedCell {
        cell: &cell,
        base_from_part: &here,
    };
    let mut state = CellState::new(placed, robot, &here);
    state.set_joints(&zeros);
    let view = CellView {
        title: found.title.clone(),
        subtitle: format!("{count} bodies of its links; all joints at zero"),
        bodies: moving(&cell, &state, &FromGround::at(robot, &zeros)),
        line_mm: line(robot, &zeros, &here),
        ..CellView::default()
    };
    Ok(view.to_svg())
}

/// The cell of an analysis where its clearance is least, of the points that have a posture; `None` without bodies or postures.
pub(super) fn least_clearance(name: &str, robot: &Robot, series: &[Rows<'_>]) -> Option<Picture> {
    let of_series = |rows: &Rows<'_>| -> Option<(f64, usize)> {
        let found = rows.answers.clearances.iter().enumerate();
        let distances = found.filter_map(|(index, found)| Some((found.as_ref()?.nearest.distance, index)));
        distances.min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let least = series.iter().filter_map(|rows| Some((rows, of_series(rows)?)));
    let (rows, (_, index)) = least.min_by(|(_, a), (_, b)| a.0.total_cmp(&b.0))?;
    let setting = rows.setting;
    let of_analysis = setting.cell.as_ref()?;
    let found = rows.answers.clearances[index]?;
    let cell = &of_analysis.cell;
    let joints = rows.answers.joints_at(index);
    let mut state = CellState::new(of_analysis.placed(), robot, &setting.flange_from_tool);
    state.set_joints(joints);
    let seen = FromGround::at(robot, joints);
    let mut bodies = moving(cell, &state, &seen);
    let of_arm = bodies.len() - of_analysis.carried;
    bodies[of_arm..]
        .iter_mut()
        .for_each(|body| body.kind = BodyKind::Obstacle);
    let of_base = of_analysis.base_from_floor.map(nalgebra::convert);
    let base_from_floor = of_base.or_else(|| {
        let floor = of_analysis.floor_body?;
        bodies.remove(floor);
        Some(state.base_from_body()[floor])
    });
    bodies.extend(
        of_analysis
            .still
            .iter()
            .map(|body| still(body, &of_analysis.base_from_part, &seen)),
    );
    let label = match found.nearest.distance > 0.0 {
        true => format!("{:.1} mm", to_mm(found.nearest.distance)),
        false => "contact".to_owned(),
    };
    let [first, second] = found.bodies.map(|body| cell.name(body));
    let [x, y, z] = rows.at_mm[index];
    let place = format!(
        "TCP at ({x:.0}, {y:.0}, {z:.0}) mm relative to {}",
        setting.base_name
    );
    let view = CellView {
        title: format!("{name}: least clearance, {label}"),
        subtitle: format!(
            "{first} and {second}; {place}; coordinates of the picture relative to {BASE_LINK}"
        ),
        bodies,
        line_mm: line(robot, joints, &setting.flange_from_tool),
        floor_mm: base_from_floor.map(|frame| floor(&(seen.ground_from_base() * frame))),
        nearest: Some(NearestPair {
            points_mm: found.nearest.points.map(|point| seen.point_mm(mm(point))),
            label: label.clone(),
        }),
    };
    Some(Picture {
        name: format!("{}-clearance", slug(name)),
        caption: format!(
            "{name}: the posture with the least clearance, {label} between {first} and {second}, {place}. Links are drawn as their \
             bodies; meshes as their convex hulls. Points where no posture keeps the demanded clearance have no posture to draw."
        ),
        svg: view.to_svg(),
    })
}

fn mm(point: Point3<f64>) -> [f64; 3] {
    to_mm(point.coords).into()
}

/// Base, joint origins, flange and tool centre point, seen from the ground.
fn line(robot: &Robot, joints: &[f64], flange_from_tool: &Isometry) -> Vec<[f64; 3]> {
    let posture = arm_on_ground(robot, joints, flange_from_tool);
    let origins = posture.joints.iter().map(|joint| joint.origin_mm);
    std::iter::once(posture.base_mm)
        .chain(origins)
        .chain([posture.flange_mm, posture.tool_mm])
        .collect()
}

/// The bodies that move with the arm, or carry it.
fn moving(cell: &Cell, state: &CellState<'_>, seen: &FromGround) -> Vec<CellBody> {
    let frames = state.base_from_body().iter();
    let bodies = cell.arm().iter().zip(frames);
    bodies
        .map(|(body, frame)| {
            let kind = match body.role {
                Role::Link => BodyKind::Link,
                Role::Holder => BodyKind::Tool,
                Role::Cutter => BodyKind::Cutter,
                Role::Obstacle => BodyKind::Obstacle,
            };
            drawn(kind, &body.shape, &(seen.ground_from_base() * frame))
        })
        .collect()
}

fn still(body: &FixedBody, base_from_part: &Isometry, seen: &FromGround) -> CellBody {
    let (kind, frame) = match body.is_part {
        true => (BodyKind::Part, base_from_part * body.frame_from_body),
        false => (BodyKind::Obstacle, body.frame_from_body),
    };
    let base_from_body: IsometryMatrix3<f64> = nalgebra::convert(frame);
    drawn(kind, &body.shape, &(seen.ground_from_base() * base_from_body))
}

/// A shape as balls, where this frame is.
fn drawn(kind: BodyKind, shape: &Shape, ground_from_body: &IsometryMatrix3<f64>) -> CellBody {
    let (points, radius): (Vec<Point3<f64>>, f64) = match shape {
        Shape::Capsule(capsule) => (vec![capsule.axis.from, capsule.axis.to], capsule.radius),
        Shape::Cylinder(axis, radius) => {
            let along = axis.to - axis.from;
            let least = along.map(f64::abs).imin();
            let across = along.cross(&Vector3::ith(least, 1.0)).normalize();
            let other = along.normalize().cross(&across);
            let rim = (0..RIM).flat_map(|k| {
                let (sin, cos) = (std::f64::consts::TAU * k as f64 / RIM as f64).sin_cos();
                [axis.from, axis.to].map(|end| end + (across * cos + other * sin) * *radius)
            });
            (rim.collect(), 0.0)
        }
        Shape::Box(bounds) => (bounds.corners().to_vec(), 0.0),
        Shape::Mesh(mesh) => (outermost(mesh), 0.0),
    };
    CellBody {
        kind,
        points_mm: points
            .into_iter()
            .map(|point| mm(ground_from_body * point))
            .collect(),
        radius_mm: to_mm(radius),
    }
}

/// The corners of a mesh that are outermost in directions spread over the sphere (Fibonacci).
fn outermost(mesh: &Mesh) -> Vec<Point3<f64>> {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let direction = |k: usize| {
        let z = 1.0 - (2.0 * k as f64 + 1.0) / OUTERMOST as f64;
        let (sin, cos) = (golden * k as f64).sin_cos();
        let r = (1.0 - z * z).max(0.0).sqrt();
        Vector3::new(r * cos, r * sin, z)
    };
    (0..OUTERMOST)
        .map(|k| mesh.farthest_along(&direction(k)))
        .collect()
}

/// Corners of a piece of the floor.
fn floor(ground_from_floor: &IsometryMatrix3<f64>) -> [[f64; 3]; 4] {
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y)| mm(ground_from_floor * Point3::new(x * FLOOR_HALF, y * FLOOR_HALF, 0.0)))
}

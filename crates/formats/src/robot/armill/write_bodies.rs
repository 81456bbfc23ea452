//! Bodies of a robot, written: `[[body]]` and `[clearance]`.
//!
//! Lengths are the shortest decimals that come back within 1e-9 m. A mesh has no table: it is left out, and pairs with it too.

use armill_core::clearance::{ArmBody, Segment, Shape};
use armill_core::nalgebra::Point3;
use armill_core::robot::Attachment;

use super::super::description::RobotDescription;
use super::spelling::{line, millimetres, quoted, source, sources};

/// How far a length may be from its decimal, m.
const WITHIN: f64 = 1e-9;

/// The bodies alone, with their sources: tables that can be appended to a robot file.
pub fn body_tables(found: &RobotDescription) -> String {
    let mut text = String::new();
    bodies(&mut text, found);
    sources(&mut text, found);
    text
}

/// Adds the tables of all bodies.
pub(super) fn bodies(text: &mut String, found: &RobotDescription) {
    for (index, body) in found.bodies.iter().enumerate() {
        let Some(shape) = shape(&body.shape) else {
            continue;
        };
        let note = found.body_notes.get(index);
        line(text, "\n[[body]]");
        line(text, &format!("at = {}", quoted(&attachment(found, body))));
        line(text, &format!("name = {}", quoted(&body.name)));
        line(text, &shape);
        if let Some(accuracy) = note.and_then(|note| note.accuracy_mm) {
            line(text, &format!("accuracy_mm = {accuracy:?}"));
        }
        let source = note.map_or(source(found), |note| note.source.as_str());
        line(text, &format!("source = {}", quoted(source)));
    }
    let name = |index: usize| {
        let body = found.bodies.get(index)?;
        shape(&body.shape).map(|_| quoted(&body.name))
    };
    let pair = |pair: &[usize; 2]| Some(format!("  [{}, {}],", name(pair[0])?, name(pair[1])?));
    let pairs: Vec<String> = found.apart.iter().filter_map(pair).collect();
    if pairs.is_empty() {
        return;
    }
    line(text, "\n[clearance]");
    line(text, "# Pairs of bodies that are apart in every posture.");
    line(text, "apart = [");
    pairs.iter().for_each(|pair| line(text, pair));
    line(text, "]");
    line(text, &format!("source = {}", quoted(source(found))));
}

/// The name of what a body is attached to.
fn attachment(found: &RobotDescription, body: &ArmBody) -> String {
    match body.attachment {
        Attachment::Base => "base".to_owned(),
        Attachment::Joint(index) => {
            (found.robot.joints().get(index)).map_or(String::new(), |joint| joint.name.clone())
        }
        Attachment::Flange | Attachment::Tool => "flange".to_owned(),
    }
}

/// Key and value of a shape; `None` for a mesh.
fn shape(shape: &Shape) -> Option<String> {
    let ends = |from: &Point3<f64>, to: &Point3<f64>| format!("from = {}, to = {}", point(from), point(to));
    let round = |key: &str, axis: &Segment, radius: f64| {
        let ends = ends(&axis.from, &axis.to);
        format!(
            "{key} = {{ {ends}, diameter = {} }}",
            millimetres(2.0 * radius, WITHIN)
        )
    };
    match shape {
        Shape::Capsule(capsule) => Some(round("capsule_mm", &capsule.axis, capsule.radius)),
        Shape::Cylinder(axis, radius) => Some(round("cylinder_mm", axis, *radius)),
        Shape::Box(bounds) => Some(format!(
            "box_mm = {{ {} }}",
            ends(&bounds.least, &bounds.greatest)
        )),
        Shape::Mesh(_) => None,
    }
}

fn point(point: &Point3<f64>) -> String {
    let [x, y, z] = [point.x, point.y, point.z].map(|m| millimetres(m, WITHIN));
    format!("[{x}, {y}, {z}]")
}

//! What is known of the bodies of a robot's links, as JSON.

use armill_core::clearance::{ArmBody, Shape};
use armill_formats::robot::RobotDescription;
use schemars::JsonSchema;
use serde::Serialize;

/// A body of a link.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct BodyDetails {
    /// Its name.
    pub name: String,
    /// Its attachment.
    pub at: String,
    /// Its shape: `capsule`, `cylinder`, `box`, `mesh`.
    pub shape: &'static str,
    /// Largest distance of its surface from the link; none if not known.
    pub accuracy_mm: Option<f64>,
    /// Key of its source; none for a file that has no sources.
    pub source: Option<String>,
}

impl BodyDetails {
    /// Body `index`, attached to what is called `at`.
    pub fn of(found: &RobotDescription, index: usize, at: String) -> BodyDetails {
        let ArmBody { name, shape, .. } = &found.bodies[index];
        let note = found.body_notes.get(index);
        BodyDetails {
            name: name.clone(),
            at,
            shape: match shape {
                Shape::Capsule(_) => "capsule",
                Shape::Cylinder(..) => "cylinder",
                Shape::Box(_) => "box",
                Shape::Mesh(_) => "mesh",
            },
            accuracy_mm: note.and_then(|note| note.accuracy_mm),
            source: note.map(|note| note.source.clone()),
        }
    }
}

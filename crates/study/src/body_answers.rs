//! What is known of the bodies of a robot's links, as JSON, and the names of attachments.

use armill_core::clearance::{ArmBody, Shape};
use armill_core::robot::{Attachment, Robot};
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
    /// Every body of a robot, in the order of its file.
    pub fn all_of(found: &RobotDescription) -> Vec<BodyDetails> {
        let details = |(index, body): (usize, &ArmBody)| {
            let note = found.body_notes.get(index);
            BodyDetails {
                name: body.name.clone(),
                at: attachment_name(&found.robot, body.attachment),
                shape: match body.shape {
                    Shape::Capsule(_) => "capsule",
                    Shape::Cylinder(..) => "cylinder",
                    Shape::Box(_) => "box",
                    Shape::Mesh(_) => "mesh",
                },
                accuracy_mm: note.and_then(|note| note.accuracy_mm),
                source: note.map(|note| note.source.clone()),
            }
        };
        found.bodies.iter().enumerate().map(details).collect()
    }
}

/// Names of the pairs of bodies that are apart in every posture.
pub fn pairs_apart(found: &RobotDescription) -> Vec<[String; 2]> {
    let names = |pair: &[usize; 2]| pair.map(|index| found.bodies[index].name.clone());
    found.apart.iter().map(names).collect()
}

/// Name of an attachment in files and results.
pub fn attachment_name(robot: &Robot, attachment: Attachment) -> String {
    match attachment {
        Attachment::Base => "base".to_owned(),
        Attachment::Joint(joint) => robot.joints()[joint].name.clone(),
        Attachment::Flange => "flange".to_owned(),
        Attachment::Tool => "tool".to_owned(),
    }
}

//! A lifting column with an arm on a construction robot, on four floors, by a total station. See README.md.

use armill_core::calibrate::{MeasuredPose, Prior, Question};
use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;
use armill_core::units::{from_deg, from_mm};
use armill_formats::robot::urdf;
use saphyr_parser::{Event, Parser};

use crate::measured::poses::{on_others, question};
use crate::measured::{Comparison, Samples};

/// The floor from which the arm is found; the names are those of the files.
const FOUND_ON: &str = "flat";
const OTHERS: [&str; 3] = ["outdoor", "pallet", "seesaw"];

/// Positions of the prism on the other floors.
pub fn comparisons(samples: &Samples) -> Vec<Comparison> {
    // A prototype with a column of 4 m: errors ten times those of an industrial arm.
    let question = Question {
        prior: Some(Prior {
            length: from_mm(5.0),
            angle: from_deg(0.5),
        }),
        ..question()
    };
    let poses = OTHERS.map(|floor| poses(samples, floor));
    let others: Vec<(&str, &[MeasuredPose])> =
        OTHERS.into_iter().zip(poses.iter().map(Vec::as_slice)).collect();
    on_others(
        &robot(samples),
        &question,
        (FOUND_ON, &self::poses(samples, FOUND_ON)),
        &others,
    )
}

/// The two sliding stages of the column, which mimic one joint, as that joint: the file has it with the full stroke.
fn robot(samples: &Samples) -> Robot {
    let (shown, text) = text(samples, "trailblazer.urdf");
    let text = text
        .replace(
            "<parent link=\"column_top\" />",
            "<parent link=\"column_pseudo_tip\" />",
        )
        .replace("xyz=\"0 0 1.442\"", "xyz=\"0 0 0\"");
    let read = urdf::read_to_tip(&shown, "column with arm", &text, Some("prism"));
    read.unwrap_or_else(|error| panic!("{error}")).robot
}

fn text(samples: &Samples, file: &str) -> (String, String) {
    let path = samples.path(&format!("hilti-column/{file}"));
    let shown = path.display().to_string();
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{shown}: {error}"));
    (shown, text)
}

/// Joint positions (m and rad) and positions of the prism (m) of a file: the lists of these two keys, in order.
fn poses(samples: &Samples, floor: &str) -> Vec<MeasuredPose> {
    let (shown, text) = text(samples, &format!("{floor}.yaml"));
    let mut lists = [("joint_states", Vec::new()), ("prism_position", Vec::new())];
    let (mut key, mut list): (String, Option<Vec<f64>>) = (String::new(), None);
    for event in Parser::new_from_str(&text) {
        match event.unwrap_or_else(|error| panic!("{shown}: {error}")).0 {
            Event::Scalar(value, ..) => match &mut list {
                Some(list) => list.push(value.parse().unwrap_or(f64::NAN)),
                None => key = value.into_owned(),
            },
            Event::SequenceStart(..) => list = Some(Vec::new()),
            Event::SequenceEnd => {
                let found = list.take();
                if let Some((_, all)) = lists.iter_mut().find(|(name, _)| *name == key) {
                    all.extend(found);
                }
            }
            Event::MappingStart(..) => list = None,
            _ => {}
        }
    }
    let [(_, joints), (_, positions)] = lists;
    let pose = |(joints, position): (Vec<f64>, Vec<f64>)| MeasuredPose {
        joints,
        position: Vector3::from_column_slice(&position),
        rotation: None,
    };
    assert_eq!(joints.len(), positions.len(), "{shown}");
    joints.into_iter().zip(positions).map(pose).collect()
}

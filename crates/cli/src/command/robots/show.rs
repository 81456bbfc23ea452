//! `armill robots NAME`: all data of one robot, as text or as [`RobotDetails`]; `--drawing` draws it, with `--bodies` those of its links.

use armill_core::robot::reach;
use armill_core::units::to_mm;
use armill_formats::robot::RobotDescription;
use armill_study::joint_unit::JointUnit;
use armill_study::number::without_rounding;
use armill_study::output::{arm_drawing, bodies_drawing};
use armill_study::robot_answers::{RobotDetails, attachment_name, chain};
use armill_study::{StudyError, robots};

use super::structure;
use crate::arguments::RobotsArguments;
use crate::command::drawing;
use crate::outcome::Outcome;
use crate::terminal::print;

/// Prints all data of the robot `name`; the drawing, if any, is written first.
///
/// # Errors
/// No such robot; a drawing that cannot be written.
pub(super) fn run(name: &str, arguments: &RobotsArguments) -> Result<Outcome, StudyError> {
    let found = robots::find(name, ".".as_ref())?;
    if let Some(file) = &arguments.drawing {
        let svg = match arguments.bodies {
            true => bodies_drawing(&found, name)?,
            false => arm_drawing(&found.robot, &found.title),
        };
        drawing::write(&arguments.writing.writer("robots"), file, &svg)?;
    }
    print(&if arguments.json {
        serde_json::to_string(&RobotDetails::of(&found))?
    } else {
        as_text(&found)
    })?;
    Ok(Outcome::Fine)
}

/// Chain, joints, compliance apart from the drives, bodies, inverse kinematics, frames, assumptions and sources, each with a
/// heading. Numbers are those of the file.
fn as_text(found: &RobotDescription) -> String {
    let robot = &found.robot;
    let mut lines = vec![format!("{} ({})", found.title, robot.name())];
    lines.extend(found.note.iter().chain(&found.description).cloned());
    lines.push(String::new());
    lines.push(
        "Chain of elementary motions, base to flange (right-handed; joints in the sense of the chain):"
            .to_owned(),
    );
    lines.extend(chain(found).iter().map(|motion| format!("  {motion}")));
    lines.push(String::new());
    lines.push("Joints with the signs and zeros of the controller:".to_owned());
    lines.extend((0..robot.joints().len()).flat_map(|index| joint_text(found, index)));
    lines.extend(structure::as_text(robot));
    lines.extend(bodies_text(found));
    lines.push(String::new());
    if robot.inverse().has_branches() {
        lines.push(format!("Nominal branch: {}", robot.nominal_branch()));
    }
    lines.push(format!("Inverse kinematics: {}", robot.inverse()));
    lines.extend(reach(robot).map(|m| format!("Reach of the wrist centre from axis 1: {:.0} mm", to_mm(m))));
    lines.extend(found.payload_kg.map(|kg| format!("Payload: {kg} kg")));
    for frame in robot.frames() {
        let at = to_mm(frame.base_from_frame.translation.vector);
        lines.push(format!(
            "Frame {}: at ({}, {}, {}) mm of base_link",
            frame.name,
            without_rounding(at.x),
            without_rounding(at.y),
            without_rounding(at.z)
        ));
    }
    lines.extend(found.remarks.iter().map(|remark| format!("Assumed: {remark}")));
    lines.push(String::new());
    lines.push("Sources:".to_owned());
    lines.extend(
        found
            .sources
            .iter()
            .map(|s| format!("  {}: {}; {}; {}", s.key, s.what, s.place, s.licence)),
    );
    lines.join("\n")
}

/// One line for the bodies of the links; none without bodies.
fn bodies_text(found: &RobotDescription) -> Option<String> {
    let mut places: Vec<(String, usize)> = Vec::new();
    for body in &found.bodies {
        let at = attachment_name(&found.robot, body.attachment);
        match places.last_mut() {
            Some((last, count)) if *last == at => *count += 1,
            _ => places.push((at, 1)),
        }
    }
    if places.is_empty() {
        return None;
    }
    let places: Vec<String> = places
        .iter()
        .map(|(at, count)| format!("{count} at {at}"))
        .collect();
    let known: Option<Vec<f64>> = found.body_notes.iter().map(|note| note.accuracy_mm).collect();
    let accuracy = match known.filter(|known| known.len() == found.bodies.len()) {
        Some(known) => {
            let largest = known.into_iter().fold(0.0, f64::max);
            format!("their surfaces are at most {largest} mm from the links")
        }
        None => "their accuracy is not known".to_owned(),
    };
    let apart = match found.apart.len() {
        0 => String::new(),
        1 => "; 1 pair is apart in every posture".to_owned(),
        count => format!("; {count} pairs are apart in every posture"),
    };
    Some(format!(
        "\nBodies of the links: {}; {accuracy}{apart}",
        places.join(", ")
    ))
}

/// One line for the joint, and one for each other source of its limits.
fn joint_text(found: &RobotDescription, index: usize) -> Vec<String> {
    let robot = &found.robot;
    let (joint, unit) = (&robot.joints()[index], JointUnit::of(robot, index));
    let (name, given) = (unit.name, |value: f64| without_rounding(value * unit.scale));
    let chain = if joint.sign.factor() < 0.0 { "-" } else { "+" };
    let limits = joint.limits.map_or("limits not known".to_owned(), |limits| {
        format!("{} to {} {name}", given(limits.lower), given(limits.upper))
    });
    let speed = joint.max_speed.map_or("speed not known".to_owned(), |speed| {
        format!("{} {name}/s", given(speed))
    });
    let compliance = robot
        .compliance()
        .map_or("compliance not known".to_owned(), |all| {
            structure::compliance_text(all[index], unit)
        });
    let line = format!(
        "  {:<4} chain {chain}{:<4} {limits:<20} {speed:<14} {compliance}",
        joint.name, joint.name
    );
    let others = found.joint_notes[index].other_limits.iter().map(|limits| {
        let ([lower, upper], source) = (limits.limits_deg, &limits.source);
        let note = limits
            .note
            .as_ref()
            .map_or(String::new(), |note| format!(": {note}"));
        format!("       limits by {source}: {lower} to {upper} deg{note}")
    });
    [line].into_iter().chain(others).collect()
}

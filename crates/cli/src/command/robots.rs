//! `armill robots`: one robot with everything that is known of it.

use armill_core::robot::{Amount, Axis, Motion, reach};
use armill_formats::robot::RobotDescription;
use armill_study::output::arm_drawing;
use armill_study::{StudyError, robots};
use serde_json::{Value, json};

use crate::Outcome;
use crate::arguments::{RobotsAction, RobotsArguments};
use crate::terminal::print;

pub(crate) fn run(arguments: &RobotsArguments) -> Result<Outcome, StudyError> {
    match &arguments.action {
        Some(RobotsAction::Import(import)) => return super::robots_import::run(import),
        Some(RobotsAction::Check(check)) => return super::robots_check::run(check),
        None => {}
    }
    let Some(name) = &arguments.name else {
        return super::robots_list::run(arguments.json);
    };
    let found = robots::find(name, ".".as_ref())?;
    if let Some(file) = &arguments.drawing {
        super::drawing::write(file, &arm_drawing(&found.robot, &found.title))?;
    }
    print(&if arguments.json {
        as_json(&found).to_string()
    } else {
        as_text(&found)
    })?;
    Ok(Outcome::Fine)
}

fn axis_name(axis: Axis) -> &'static str {
    match axis {
        Axis::X => "x",
        Axis::Y => "y",
        Axis::Z => "z",
    }
}

/// One elementary motion in words: `along z 450 mm (H)`, `about y by U, counted -`.
fn motion(found: &RobotDescription, index: usize) -> String {
    let symbol = found.symbols[index]
        .as_ref()
        .map_or(String::new(), |symbol| format!(" ({symbol})"));
    let of_joint = |joint: usize| {
        let joint = &found.robot.joints()[joint];
        let against = if joint.sign.factor() < 0.0 {
            ", counted against the right hand"
        } else {
            ""
        };
        let zero = if joint.zero_offset == 0.0 {
            String::new()
        } else {
            format!(", zero at {:.4} deg", joint.zero_offset.to_degrees())
        };
        let coupled: String = joint
            .coupling
            .iter()
            .map(|c| format!(", plus {} x {}", c.factor, found.robot.joints()[c.joint].name))
            .collect();
        format!("{}{against}{zero}{coupled}", joint.name)
    };
    match found.robot.chain().motions()[index] {
        Motion::Along(axis, Amount::Constant(m)) => {
            format!("along {} {} mm{symbol}", axis_name(axis), tidy(m * 1e3))
        }
        Motion::Along(axis, Amount::Joint(joint)) => {
            format!("along {} by {}{symbol}", axis_name(axis), of_joint(joint))
        }
        Motion::About(axis, Amount::Constant(rad)) => {
            format!("about {} {} deg{symbol}", axis_name(axis), tidy(rad.to_degrees()))
        }
        Motion::About(axis, Amount::Joint(joint)) => {
            format!("about {} by {}{symbol}", axis_name(axis), of_joint(joint))
        }
    }
}

fn tidy(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}

fn as_text(found: &RobotDescription) -> String {
    let robot = &found.robot;
    let mut lines = vec![format!("{} ({})", found.title, robot.name())];
    lines.extend(found.note.iter().cloned());
    lines.push(String::new());
    lines.push(
        "Chain of elementary motions, base to flange (right hand; joints in the chain's own sense):"
            .to_owned(),
    );
    lines.extend((0..robot.chain().motions().len()).map(|i| format!("  {}", motion(found, i))));
    lines.push(String::new());
    lines.push("Joints as their controller counts them:".to_owned());
    for (i, joint) in robot.joints().iter().enumerate() {
        let (scale, unit) = if robot.slides(i) {
            (1e3, "mm")
        } else {
            (1f64.to_degrees(), "deg")
        };
        let chain = if joint.sign.factor() < 0.0 { "-" } else { "+" };
        let limits = joint.limits.map_or("limits not known".to_owned(), |l| {
            format!("{} to {} {unit}", tidy(l.lower * scale), tidy(l.upper * scale))
        });
        let speed = joint.max_speed.map_or("speed not known".to_owned(), |v| {
            format!("{} {unit}/s", tidy(v * scale))
        });
        let compliance = robot.compliance().map_or("compliance not known".to_owned(), |c| {
            format!("{:.2e} ± {:.1e} rad/(N m)", c[i].value, c[i].standard_uncertainty)
        });
        lines.push(format!(
            "  {:<4} chain {chain}{:<4} {limits:<20} {speed:<14} {compliance}",
            joint.name, joint.name
        ));
        for ([lower, upper], source, note) in &found.joints[i].other_limits {
            let note = note.as_ref().map_or(String::new(), |note| format!(": {note}"));
            lines.push(format!("       limits by {source}: {lower} to {upper} deg{note}"));
        }
    }
    lines.extend(super::structure::as_text(robot));
    lines.push(String::new());
    if robot.inverse().has_branches() {
        lines.push(format!("Nominal branch: {}", robot.nominal_branch()));
    }
    lines.push(format!("Inverse kinematics: {}", robot.inverse()));
    lines.extend(reach(robot).map(|m| format!("Reach of the wrist centre from axis 1: {:.0} mm", m * 1e3)));
    lines.extend(found.payload_kg.map(|kg| format!("Payload: {kg} kg")));
    for frame in robot.frames() {
        let at = frame.base_from_frame.translation.vector * 1e3;
        lines.push(format!(
            "Frame {}: at ({}, {}, {}) mm of base_link",
            frame.name,
            tidy(at.x),
            tidy(at.y),
            tidy(at.z)
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

fn as_json(found: &RobotDescription) -> Value {
    let robot = &found.robot;
    let joints: Vec<Value> = robot
        .joints()
        .iter()
        .enumerate()
        .map(|(i, joint)| {
            let unit = if robot.slides(i) { "mm" } else { "deg" };
            let scale = if robot.slides(i) { 1e3 } else { 1f64.to_degrees() };
            let mut value = json!({
                "name": joint.name,
                "sign": joint.sign.factor(),
                "compliance_rad_per_n_m": robot.compliance().map(|c| c[i].value),
                "compliance_u_rad_per_n_m": robot.compliance().map(|c| c[i].standard_uncertainty),
                "source": found.joints[i].source,
                "compliance_source": found.joints[i].compliance_source,
                "compliance_u_source": found.joints[i].compliance_u_source,
            });
            value[format!("zero_offset_{unit}")] = json!(tidy(joint.zero_offset * scale));
            value[format!("limits_{unit}")] = json!(
                joint
                    .limits
                    .map(|l| [tidy(l.lower * scale), tidy(l.upper * scale)])
            );
            value[format!("max_speed_{unit}_per_s")] = json!(joint.max_speed.map(|v| tidy(v * scale)));
            value
        })
        .collect();
    json!({
        "name": robot.name(),
        "title": found.title,
        "note": found.note,
        "chain": (0..robot.chain().motions().len()).map(|i| motion(found, i)).collect::<Vec<_>>(),
        "joints": joints,
        "structure": super::structure::as_json(robot),
        "nominal_branch": robot.nominal_branch().to_string(),
        "inverse": robot.inverse().word(),
        "frames": robot.frames().iter().map(|f| json!({
            "name": f.name,
            "origin_mm": (f.base_from_frame.translation.vector * 1e3).as_slice(),
        })).collect::<Vec<_>>(),
        "payload_kg": found.payload_kg,
        "assumed": found.remarks,
        "reach_mm": reach(robot).map(|m| tidy(m * 1e3)),
        "sources": found.sources,
    })
}

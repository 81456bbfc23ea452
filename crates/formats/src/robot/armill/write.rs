//! Our robot file, written: what a foreign file gave, and in comments what it did not.
//!
//! Numbers are the shortest decimals that come back as the same motion: lengths and angles of the chain within
//! 1e-15 m and rad, limits and speeds within 1e-9.
//!
//! Order: comments on origin, what was assumed and what is missing; `format`, `name`, `nominal_branch`, `note`;
//! `[chain]`; a `[[joint]]` each; a `[[frame]]` each; a `[[mass]]` each; a `[[body]]` each; `[clearance]`; `[sources]`. Keys that a user has to
//! fill in are in comments.

use armill_core::frame::{Isometry, fixed_angles};
use armill_core::robot::{Amount, Joint, Motion};

use super::super::description::RobotDescription;
use super::spelling::{degrees, line, millimetres, quoted, source, sources};
use super::{write_bodies, write_masses};

/// How far (m, rad) a number of the chain may be from its decimal.
const CHAIN: f64 = 1e-15;
/// The same for limits and speeds, rad (rad/s), m (m/s).
const RANGE: f64 = 1e-9;

/// The text of a robot file, format 1, for a robot that came from one foreign source.
///
/// Not written: compliance, payload and limits by other sources, which no foreign format has; bodies that are meshes.
///
/// Every number names the first source of `found`. Not checked: that `read` takes the text back, which the
/// tests show for every foreign format.
pub fn write(found: &RobotDescription) -> String {
    let mut text = String::new();
    head(&mut text, found);
    chain(&mut text, found);
    for index in 0..found.robot.joints().len() {
        joint(&mut text, found, index);
    }
    for frame in found.robot.frames() {
        let (origin, angles) = pose(&frame.base_from_frame);
        line(&mut text, "\n[[frame]]");
        line(&mut text, &format!("name = {}", quoted(&frame.name)));
        line(&mut text, &format!("origin_mm = {origin}"));
        line(&mut text, &format!("rotation_deg = {angles}"));
        line(&mut text, &format!("source = {}", quoted(source(found))));
    }
    write_masses::masses(&mut text, found);
    write_bodies::bodies(&mut text, found);
    sources(&mut text, found);
    text
}

/// Comments on what was assumed and what is missing, and the fields of the file as a whole.
///
/// What a foreign file says may contain any character, so it is brought onto one line before it goes into a comment.
fn head(text: &mut String, found: &RobotDescription) {
    let robot = &found.robot;
    let place = found.sources.first().map_or("", |source| source.place.as_str());
    line(
        text,
        &format!("# {}, imported from {}.", one_line(&found.title), one_line(place)),
    );
    line(
        text,
        "# armill robot file, format 1. Lengths in mm, angles in degrees.",
    );
    if !found.remarks.is_empty() {
        line(text, "#\n# Assumed:");
        for remark in &found.remarks {
            line(text, &format!("# - {}", one_line(remark)));
        }
    }
    let without = |known: fn(&Joint) -> bool| robot.joints().iter().filter(|joint| !known(joint)).count();
    let count = robot.joints().len();
    line(text, "#\n# Missing, to be added where known:");
    line(
        text,
        "# - the joints' compliances: no deviation can be predicted without them",
    );
    for (missing, what) in [
        (
            without(|joint| joint.limits.is_some()),
            "limits: postures are not checked against limits there",
        ),
        (without(|joint| joint.max_speed.is_some()), "greatest speeds"),
    ] {
        if missing > 0 {
            line(text, &format!("# - {missing} of {count} joints: {what}"));
        }
    }
    line(text, &format!("#\n# Inverse: {}.", robot.inverse()));
    line(text, "\nformat = 1");
    line(text, &format!("name = {}", quoted(&found.title)));
    line(
        text,
        &format!("nominal_branch = {}", quoted(&robot.nominal_branch().to_string())),
    );
    line(
        text,
        "# Remove this note when two poses of the pendant, all joints away from zero, agree with `armill pose`.",
    );
    let note = format!(
        "imported from {}: signs and zeros of its joints have not been compared with the pendant",
        one_line(place)
    );
    line(text, &format!("note = {}", quoted(&note)));
}

/// The table `[chain]`, a motion a line.
fn chain(text: &mut String, found: &RobotDescription) {
    line(text, "\n[chain]");
    line(text, &format!("source = {}", quoted(source(found))));
    line(text, "motions = [");
    let motions = found.robot.chain().motions();
    for (index, motion) in motions.iter().enumerate() {
        let (word, axis) = match motion {
            Motion::Along(axis, _) => ("along", axis),
            Motion::About(axis, _) => ("about", axis),
        };
        let axis = axis.letter();
        let amount = match (motion, motion.amount()) {
            (Motion::Along(..), Amount::Constant(m)) => format!("length_mm = {}", millimetres(m, CHAIN)),
            // Whole turns do nothing, and `read` takes none.
            (Motion::About(..), Amount::Constant(rad)) => {
                format!("angle_deg = {}", degrees(rad % std::f64::consts::TAU, CHAIN))
            }
            (_, Amount::Joint(joint)) => {
                let name = found
                    .robot
                    .joints()
                    .get(joint)
                    .map_or("", |joint| joint.name.as_str());
                format!("joint = {}", quoted(name))
            }
        };
        let symbol = match found.symbols.get(index) {
            Some(Some(symbol)) => format!(", symbol = {}", quoted(symbol)),
            _ => String::new(),
        };
        line(text, &format!("  {{ {word} = \"{axis}\", {amount}{symbol} }},"));
    }
    line(text, "]");
}

/// A table `[[joint]]`; what is not known is in comments, ready to be filled in.
fn joint(text: &mut String, found: &RobotDescription, index: usize) {
    let Some(joint) = found.robot.joints().get(index) else {
        return;
    };
    let slides = found.robot.slides(index);
    let (unit, number): (&str, fn(f64, f64) -> String) = match slides {
        true => ("mm", millimetres),
        false => ("deg", degrees),
    };
    line(text, "\n[[joint]]");
    line(text, &format!("name = {}", quoted(&joint.name)));
    line(
        text,
        &format!("sign = {}", if joint.sign.factor() < 0.0 { "-1" } else { "1" }),
    );
    if joint.zero_offset != 0.0 {
        line(
            text,
            &format!("zero_offset_{unit} = {}", number(joint.zero_offset, CHAIN)),
        );
    }
    if !joint.coupling.is_empty() {
        let names = found.robot.joints();
        let coupled = joint.coupling.iter().filter_map(|c| {
            let name = quoted(&names.get(c.joint)?.name);
            Some(format!("{{ joint = {name}, factor = {:?} }}", c.factor))
        });
        line(
            text,
            &format!("coupling = [{}]", coupled.collect::<Vec<_>>().join(", ")),
        );
    }
    match joint.limits {
        Some(limits) => {
            let ends = |within| [limits.lower, limits.upper].map(|end| number(end, within));
            // Limits that are closer together than the rounding are written in full.
            let [lower, upper] = match ends(RANGE) {
                [lower, upper] if lower == upper => ends(0.0),
                given => given,
            };
            line(text, &format!("limits_{unit} = [{lower}, {upper}]"));
        }
        None => line(text, &format!("# limits_{unit} = [lower, upper]")),
    }
    match joint.max_speed {
        Some(speed) => line(
            text,
            &format!("max_speed_{unit}_per_s = {}", number(speed, RANGE)),
        ),
        None => line(text, &format!("# max_speed_{unit}_per_s = ...")),
    }
    line(text, &format!("source = {}", quoted(source(found))));
    let compliance = if slides { "um_per_n" } else { "rad_per_n_m" };
    line(text, &format!("# compliance_{compliance} = ..."));
    line(text, "# compliance_source = \"...\"");
}

/// Origin and turns about the fixed axes x, y, z, as the file has them.
fn pose(base_from_frame: &Isometry) -> (String, String) {
    let at = base_from_frame.translation.vector;
    let angles: [f64; 3] = fixed_angles(&base_from_frame.rotation).into();
    let three = |values: [String; 3]| format!("[{}]", values.join(", "));
    (
        three([at.x, at.y, at.z].map(|m| millimetres(m, CHAIN))),
        three(angles.map(|rad| degrees(rad, CHAIN))),
    )
}

/// A text that fits into a comment.
fn one_line(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect()
}

#[cfg(test)]
mod tests;

//! Values of a study that are probably slips: angles in rad, lengths in m, forces beyond the payload.
//!
//! Each may be meant, so each is a warning. It begins with the consequence for the result, and gives the value that was
//! probably meant.
//!
//! | value | slip where |
//! |---|---|
//! | angle in deg | it is a multiple of pi/4 or pi/12 to the digits that people write: 0.7854, 1.571, 3.14 |
//! | plane centre | it is nearer than `INSIDE_BASE_MM` to the origin of the base, where the robot stands |
//! | TCP | it is nearer than `SHORT_TOOL_MM` to the flange, but not on it, or farther than `LONG_TOOL_MM` |
//! | no `base` | the frame of the controller is not base_link |
//! | force | it is larger than the weight of the payload |

use armill_core::frame::fixed_angles;
use armill_core::source::stiffness_model::FREE_FALL;
use armill_core::units::{from_deg, to_deg, to_mm};
use armill_formats::robot::RobotDescription;

use crate::file::resolve::Study;
use crate::input::setting::Setting;
use crate::naming::CONTROLLER;
use crate::number::{decimals, without_rounding};

/// A plane whose centre is nearer than this to the origin of the base is inside the robot, mm.
const INSIDE_BASE_MM: f64 = 20.0;
/// A shorter tool is no tool, mm.
const SHORT_TOOL_MM: f64 = 1.0;
/// Frames that are nearer to each other are one, mm.
const SAME_FRAME_MM: f64 = 0.01;
/// No arm carries a longer tool, mm.
const LONG_TOOL_MM: f64 = 5e3;
/// Difference of a number in rad, as people write it, from a multiple of pi/4; a tenth of it of pi/12.
const WRITTEN: f64 = 1.7e-3;

/// The angle in deg that was probably meant where `deg` is an angle in rad; none of an ordinary angle.
pub fn meant_in_rad(deg: f64) -> Option<f64> {
    let is_multiple = |of: f64, within: f64| {
        let times = (to_deg(deg) / of).round();
        let away = (deg - from_deg(times * of)).abs();
        (times != 0.0 && times.abs() * of <= 360.0 && away < within).then_some(times * of)
    };
    // Whole numbers are degrees: 1 deg is no 1.0472 rad, and 3 no pi.
    if deg.fract() == 0.0 {
        return None;
    }
    is_multiple(45.0, WRITTEN).or_else(|| is_multiple(15.0, 0.1 * WRITTEN))
}

/// The likely slips in the settings of a study, each a sentence, each once.
pub fn of_study(study: &Study) -> Vec<String> {
    let mut found = Vec::new();
    for warning in (study.settings()).flat_map(|setting| warnings(&study.robot, setting)) {
        if !found.contains(&warning) {
            found.push(warning);
        }
    }
    found
}

/// The likely slips in the setting of one analysis, each a sentence.
fn warnings(described: &RobotDescription, setting: &Setting) -> Vec<String> {
    let mut warnings = Vec::new();
    warnings.extend(frame(described, setting));
    warnings.extend(angles(setting));
    warnings.extend(plane(described, setting));
    warnings.extend(tool(setting));
    warnings.extend(force(described, setting));
    warnings
}

fn angles(setting: &Setting) -> Vec<String> {
    let mut found = Vec::new();
    let mut say = |consequence: &str, key: &str, deg: f64| {
        let given = decimals(deg, 6);
        if let Some(meant) = meant_in_rad(given) {
            found.push(format!(
                "{consequence} by only {given} deg: {given} is {meant} deg in rad; if that was meant, write `{key}` in deg."
            ));
        }
    };
    match setting.tilt {
        Some(tilt) => say("The plane is tilted", "plane.tilt_deg", to_deg(tilt)),
        None => {
            let reference_from_part = setting.base_from_reference.inverse() * setting.plane.base_from_part;
            for angle in fixed_angles(&reference_from_part.rotation).iter() {
                say("The plane is rotated", "plane.rotation_deg", to_deg(*angle));
            }
        }
    }
    for angle in fixed_angles(&setting.flange_from_tool.rotation).iter() {
        say(
            "The tool is rotated",
            "tool.flange_from_tool_mm_deg",
            to_deg(*angle),
        );
    }
    found
}

/// No frame is named, and the controller of the robot has its own.
fn frame(described: &RobotDescription, setting: &Setting) -> Option<String> {
    let robot = &described.robot;
    if setting.base_is_given || robot.chain().ground().part_is_in_hand() {
        return None;
    }
    let controller = robot.frames().iter().find(|frame| frame.name == CONTROLLER)?;
    let origin = controller.base_from_frame.translation.vector.map(to_mm);
    if origin.norm() < SAME_FRAME_MM {
        return None;
    }
    let given = origin.map(without_rounding);
    Some(format!(
        "The part may be {} mm off: the study names no `base`, so its coordinates are relative to base_link; those on the \
         pendant are relative to the frame `{CONTROLLER}`, which is at ({}, {}, {}) mm. Write `base = \"{CONTROLLER}\"` \
         or `base = \"base_link\"`.",
        without_rounding(origin.norm()),
        given.x,
        given.y,
        given.z
    ))
}

fn plane(described: &RobotDescription, setting: &Setting) -> Option<String> {
    let robot = &described.robot;
    // The origin of a rail is a place for a part, and so is the flange of a robot that holds it.
    let is_in_hand = robot.chain().ground().part_is_in_hand();
    if is_in_hand || (0..robot.joints().len()).any(|joint| robot.slides(joint)) {
        return None;
    }
    let from_base = setting.plane.base_from_part.translation.vector;
    (to_mm(from_base.norm()) < INSIDE_BASE_MM).then(|| {
        let given = setting.in_reference(&from_base.into()).coords.map(to_mm).map(without_rounding);
        format!(
            "The plane is inside the base of the robot: its centre is at ({}, {}, {}) mm; is it in m? 1 m is 1000 mm.",
            given.x, given.y, given.z
        )
    })
}

fn tool(setting: &Setting) -> Option<String> {
    let length = to_mm(setting.flange_from_tool.translation.vector.norm());
    let shown = without_rounding(length);
    if length > 0.0 && length < SHORT_TOOL_MM {
        return Some(format!(
            "The lever of the tool is missing: the TCP is {shown} mm from the flange; is it in m? 0.15 m is 150 mm."
        ));
    }
    (length > LONG_TOOL_MM).then(|| {
        format!("The lever of the tool is too long: the TCP is {shown} mm from the flange; is it in um?")
    })
}

fn force(described: &RobotDescription, setting: &Setting) -> Option<String> {
    let payload = described.payload_kg?;
    let weight = payload * FREE_FALL;
    let largest = setting
        .cases
        .iter()
        .map(|case| case.force.norm())
        .fold(0.0, f64::max);
    (largest > weight).then(|| {
        format!(
            "The robot cannot hold this load: {} N is more than the weight of its payload, {} kg or {:.0} N; is the force in N?",
            decimals(largest, 1),
            without_rounding(payload),
            weight
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_in_rad_as_people_write_them_are_recognised() {
        for (given, meant) in [
            ("1.5708", 90.0),
            ("1.571", 90.0),
            ("1.57", 90.0),
            ("-1.5708", -90.0),
            ("3.14159", 180.0),
            ("3.14", 180.0),
            ("0.7854", 45.0),
            ("0.785", 45.0),
            ("2.3562", 135.0),
            ("0.5236", 30.0),
            ("1.0472", 60.0),
            ("0.2618", 15.0),
            ("4.7124", 270.0),
        ] {
            assert_eq!(meant_in_rad(given.parse().unwrap()), Some(meant), "{given}");
        }
    }

    #[test]
    fn ordinary_angles_are_not() {
        for given in [
            0.0, 1.0, 3.0, 0.5, 0.25, 1.5, 2.5, 0.1, 12.3, 90.0, 45.5, 3.2, 1.05, 6.0, 22.5,
        ] {
            assert_eq!(meant_in_rad(given), None, "{given}");
        }
    }
}

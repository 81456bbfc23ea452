//! Words for uncertainties: "not known" where no input has one, and which inputs lack theirs.
//!
//! Unknown is not zero. Every text, table and picture that reports an uncertainty takes its words from here;
//! [`Arm::inputs_without_uncertainty`] decides what is known.

use armill_core::robot::{Joint, Robot};
use armill_core::source::{Arm, InputWithoutUncertainty};

use crate::number::micrometres;
use crate::robot_answers::attachment_name;

/// The words for an unknown uncertainty.
pub const NOT_KNOWN: &str = "not known";

/// A standard uncertainty in a sentence: `u = 31.9 µm`, or `u not known`.
pub fn u_in_words(u_um: Option<f64>) -> String {
    match u_um {
        Some(u) => format!("u = {} µm", micrometres(u)),
        None => format!("u {NOT_KNOWN}"),
    }
}

/// A standard uncertainty after its value: `± 31.9`, or `± not known`.
pub fn plus_minus(u: Option<impl std::fmt::Display>) -> String {
    u.map_or_else(|| format!("± {NOT_KNOWN}"), |u| format!("± {u}"))
}

/// A deviation with its standard uncertainty in a table of µm: `241.3 ± 31.9`, or `241.3 ± not known`.
pub fn deviation_in_words(um: f64, u_um: Option<f64>) -> String {
    format!("{um:.1} {}", plus_minus(u_um.map(|u| format!("{u:.1}"))))
}

/// Names of the inputs of a prediction that have an effect, but no uncertainty.
pub fn inputs_without_uncertainty(arm: &Arm<'_>) -> Vec<String> {
    let robot = arm.robot;
    let inputs = arm.inputs_without_uncertainty();
    let names = |matching: fn(&InputWithoutUncertainty) -> Option<usize>| -> Vec<&str> {
        let joints = inputs.iter().filter_map(matching);
        joints.map(|joint| name(robot, joint)).collect()
    };
    let joints = names(|input| match input {
        InputWithoutUncertainty::Joint(joint) => Some(*joint),
        _ => None,
    });
    let backlash = names(|input| match input {
        InputWithoutUncertainty::Backlash(joint) => Some(*joint),
        _ => None,
    });
    let springs = inputs.iter().filter_map(|input| match input {
        InputWithoutUncertainty::Spring(spring) => Some(arm.model.structure.springs[*spring].attachment),
        _ => None,
    });
    let mut all = Vec::new();
    if joints.len() == robot.joints().len() {
        all.push("the compliance of every joint".to_owned());
    } else if !joints.is_empty() {
        all.push(format!("the compliance of {}", joints.join(", ")));
    }
    for attachment in springs {
        let spring = format!("the springs at {}", attachment_name(robot, attachment));
        if !all.contains(&spring) {
            all.push(spring);
        }
    }
    if !backlash.is_empty() {
        all.push(format!("the backlash of {}", backlash.join(", ")));
    }
    if inputs.contains(&InputWithoutUncertainty::Thermal) {
        all.push("the thermal growth".to_owned());
    }
    if inputs.contains(&InputWithoutUncertainty::Geometry) {
        all.push("the calibrated geometry".to_owned());
    }
    all
}

/// The warning about inputs without uncertainty; none if each has one.
pub fn warning(arm: &Arm<'_>) -> Option<String> {
    let without = inputs_without_uncertainty(arm);
    if without.is_empty() {
        return None;
    }
    let consequence = match arm.has_known_uncertainty() {
        true => "The standard uncertainties are lower bounds, and probabilities are too close to 0 or 1",
        false => "The uncertainty of the deviations is not known, and no probability is reported",
    };
    Some(format!(
        "{consequence}: no uncertainty is given for {}.",
        without.join(", ")
    ))
}

fn name(robot: &Robot, joint: usize) -> &str {
    robot.joints().get(joint).map_or("", |joint: &Joint| &joint.name)
}

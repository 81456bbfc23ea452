//! Compliance, masses and uncertainty of a robot apart from its drives, for `armill robots NAME`.
//!
//! ```text
//! Apart from the drives:
//!   spring at ATTACHMENT: about AXIS, ... rad/(N m)       or: along AXIS, ... µm/N; or both, of a screw
//!   mass at ATTACHMENT: ... kg, centre (x, y, z) mm
//!   motor of JOINT: rotor ... kg m^2, ratio ...
//!   torque curve of JOINT: ... pairs, both directions
//!   gravity compensator of JOINT: ... N/mm
//!   covariance of the compliances: known
//! ```
//!
//! An attachment is the body to which a spring or mass belongs; axes and centres are in its frame.

use armill_core::nalgebra::Vector3;
use armill_core::robot::{Damping, JointCompliance, Robot};
use armill_core::units::{to_mm, to_per_mm, to_um};
use armill_study::joint_unit::JointUnit;
use armill_study::robot_answers::attachment_name;
use armill_study::uncertainty_words::plus_minus;

/// Lines of text; none if only drives are known.
pub(super) fn as_text(robot: &Robot) -> Vec<String> {
    let structure = robot.structure();
    let mut lines = Vec::new();
    for spring in &structure.springs {
        let c = spring.compliance;
        let (linear, angular) = (spring.direction.linear, spring.direction.angular);
        let what = if linear == Vector3::zeros() {
            format!(
                "about {}, {}",
                axis(&angular),
                compliance_text(c, JointUnit::TURNING)
            )
        } else if angular == Vector3::zeros() {
            format!(
                "along {}, {}",
                axis(&linear),
                compliance_text(c, JointUnit::SLIDING)
            )
        } else {
            format!(
                "{:.2e} m/N along {} with a rotation of {} rad/m",
                c.value,
                axis(&linear),
                axis(&angular)
            )
        };
        lines.push(format!(
            "  spring at {}: {what}",
            attachment_name(robot, spring.attachment)
        ));
    }
    for mass in &structure.masses {
        let centre = to_mm(mass.centre.coords);
        lines.push(format!(
            "  mass at {}: {} kg{}, centre ({:.3}, {:.3}, {:.3}) mm{}",
            attachment_name(robot, mass.attachment),
            mass.mass,
            match mass.relative_uncertainty {
                0.0 => String::new(),
                u => format!(" (u {:.0} %)", 100.0 * u),
            },
            centre.x,
            centre.y,
            centre.z,
            mass.inertia.map_or_else(String::new, |inertia| {
                let [x, y, z]: [f64; 3] = inertia.diagonal().into();
                format!(", inertia about it {x:.4}, {y:.4}, {z:.4} kg m^2")
            })
        ));
    }
    for motor in &structure.motors {
        let name = &robot.joints()[motor.joint].name;
        let (inertia, ratio) = (motor.rotor_inertia, motor.ratio);
        lines.push(format!(
            "  motor of {name}: rotor {inertia} kg m^2, ratio {ratio}"
        ));
    }
    lines.extend(structure.damping.as_ref().map(|damping| match damping {
        Damping::Ratio(ratio) => format!("  damping ratio of every mode: {ratio}"),
        Damping::Joints(dampers) => format!("  viscous damping of the joints: {dampers:?} N m s/rad"),
    }));
    for joint in 0..robot.joints().len() {
        let name = &robot.joints()[joint].name;
        lines.extend(structure.curve(joint).map(|curve| {
            let sides = if curve.falling.is_some() { "rising and falling" } else { "both directions" };
            let pairs = curve.rising.points().len();
            format!("  torque curve of {name}: {pairs} pairs, {sides}; the compliance above is its slope without load")
        }));
    }
    if let Some(c) = &structure.compensator {
        let name = &robot.joints()[c.joint].name;
        lines.push(format!(
            "  gravity compensator of {name}: {} N/mm",
            to_per_mm(c.stiffness)
        ));
    }
    if structure.covariance.is_some() {
        lines.push("  covariance of the compliances: known".to_owned());
    }
    if structure.repeatability > 0.0 {
        lines.push(format!(
            "  repeatability: {:.1} um along any axis, one standard deviation",
            to_um(structure.repeatability)
        ));
    }
    if structure.model_error > 0.0 {
        lines.push(format!(
            "  model error: {:.1} % of what it predicts, one standard uncertainty",
            structure.model_error * 100.0
        ));
    }
    if !lines.is_empty() {
        lines.insert(0, "Apart from the drives:".to_owned());
        lines.insert(0, String::new());
    }
    lines
}

/// A direction by its letter if it is an axis, otherwise by its components.
fn axis(v: &Vector3<f64>) -> String {
    match [v.x, v.y, v.z] {
        [1.0, 0.0, 0.0] => "x".to_owned(),
        [0.0, 1.0, 0.0] => "y".to_owned(),
        [0.0, 0.0, 1.0] => "z".to_owned(),
        [x, y, z] => format!("({x:.3}, {y:.3}, {z:.3})"),
    }
}

/// A compliance with its standard uncertainty, in the unit of its joint: revolute or
/// prismatic.
pub(super) fn compliance_text(c: JointCompliance, unit: JointUnit) -> String {
    let value = c.value * unit.compliance_scale;
    let u = c
        .known_uncertainty()
        .map(|u| format!("{:.1e}", u * unit.compliance_scale));
    format!("{value:.2e} {} {}", plus_minus(u), unit.compliance_name)
}

//! What a robot has beside its drives, for `armill robots NAME`.

use armill_core::nalgebra::Vector3;
use armill_core::robot::{Robot, Seat, TorqueCurve};
use serde_json::{Value, json};

fn seat_name(robot: &Robot, seat: Seat) -> String {
    match seat {
        Seat::Base => "base".to_owned(),
        Seat::Joint(joint) => robot.joints()[joint].name.clone(),
        Seat::Flange => "flange".to_owned(),
        Seat::Tool => "tool".to_owned(),
    }
}

/// Lines for people; none where drives alone are known.
pub(super) fn as_text(robot: &Robot) -> Vec<String> {
    let structure = robot.structure();
    let mut lines = Vec::new();
    for spring in &structure.springs {
        let c = spring.compliance;
        let (linear, angular) = (spring.direction.linear, spring.direction.angular);
        let what = if linear == Vector3::zeros() {
            format!(
                "about {}, {:.2e} ± {:.1e} rad/(N m)",
                axis(&angular),
                c.value,
                c.standard_uncertainty
            )
        } else if angular == Vector3::zeros() {
            let (value, u) = (c.value * 1e6, c.standard_uncertainty * 1e6);
            format!("along {}, {value:.2e} ± {u:.1e} µm/N", axis(&linear))
        } else {
            format!(
                "{:.2e} m/N along {} with a turn of {} rad/m",
                c.value,
                axis(&linear),
                axis(&angular)
            )
        };
        lines.push(format!("  spring at {}: {what}", seat_name(robot, spring.seat)));
    }
    for mass in &structure.masses {
        let centre = axis(&(mass.centre.coords * 1e3));
        lines.push(format!(
            "  mass at {}: {} kg, centre {centre} mm",
            seat_name(robot, mass.seat),
            mass.mass
        ));
    }
    for joint in 0..robot.joints().len() {
        let name = &robot.joints()[joint].name;
        lines.extend(structure.curve(joint).map(|curve| {
            let sides = if curve.falling.is_some() { "rising and falling" } else { "both ways" };
            let pairs = curve.rising.points().len();
            format!("  torque curve of {name}: {pairs} pairs, {sides}; the compliance above is its slope without load")
        }));
    }
    if let Some(c) = &structure.compensator {
        let name = &robot.joints()[c.joint].name;
        lines.push(format!(
            "  gravity compensator of {name}: {} N/mm",
            c.stiffness * 1e-3
        ));
    }
    if structure.covariance.is_some() {
        lines.push("  covariance of the compliances: known".to_owned());
    }
    if !lines.is_empty() {
        lines.insert(0, "Beside the drives:".to_owned());
        lines.insert(0, String::new());
    }
    lines
}

fn axis(v: &Vector3<f64>) -> String {
    match [v.x, v.y, v.z] {
        [1.0, 0.0, 0.0] => "x".to_owned(),
        [0.0, 1.0, 0.0] => "y".to_owned(),
        [0.0, 0.0, 1.0] => "z".to_owned(),
        [x, y, z] => format!("({x:.3}, {y:.3}, {z:.3})"),
    }
}

/// The same for programs. Directions of springs are twists at the seat, translation first.
pub(super) fn as_json(robot: &Robot) -> Value {
    let structure = robot.structure();
    let springs = structure.springs.iter().map(|spring| {
        json!({
            "at": seat_name(robot, spring.seat),
            "direction": spring.direction.to_vector().as_slice(),
            "compliance": spring.compliance.value,
            "compliance_u": spring.compliance.standard_uncertainty,
        })
    });
    let masses = structure.masses.iter().map(|mass| {
        json!({
            "at": seat_name(robot, mass.seat),
            "mass_kg": mass.mass,
            "centre_mm": (mass.centre.coords * 1e3).as_slice(),
        })
    });
    let curves = (0..robot.joints().len()).filter_map(|joint| {
        let curve = structure.curve(joint)?;
        Some(json!({
            "joint": robot.joints()[joint].name,
            "torque_curve_n_m_rad": curve.rising.points(),
            "torque_curve_falling_n_m_rad": curve.falling.as_ref().map(TorqueCurve::points),
        }))
    });
    json!({
        "springs": springs.collect::<Vec<_>>(),
        "masses": masses.collect::<Vec<_>>(),
        "torque_curves": curves.collect::<Vec<_>>(),
        "compensator": structure.compensator.map(|c| json!({
            "joint": robot.joints()[c.joint].name,
            "fixed_radius_mm": c.fixed_radius * 1e3,
            "arm_radius_mm": c.arm_radius * 1e3,
            "free_length_mm": c.free_length * 1e3,
            "stiffness_n_per_mm": c.stiffness * 1e-3,
            "angle_deg": c.angle.to_degrees(),
        })),
        "covariance_known": structure.covariance.is_some(),
    })
}

//! What only the vibration of an arm depends on: motors and damping.

use armill_core::robot::{Damping, Motor};
use armill_core::units::from_mm;

use super::checks::Checks;
use super::file::RobotFile;

impl Checks<'_> {
    /// The rotors of the motors.
    pub(super) fn motors(&mut self, file: &RobotFile) -> Vec<Motor> {
        let mut motors: Vec<Motor> = Vec::new();
        for (index, table) in file.motor.iter().enumerate() {
            let path = format!("motor[{index}]");
            let Some(joint) = file.joint.iter().position(|joint| joint.name == table.joint) else {
                let known: Vec<&str> = file.joint.iter().map(|joint| joint.name.as_str()).collect();
                let message = format!("`{}` is not a joint of the arm", table.joint);
                let hint = format!("one of: {}", known.join(", "));
                self.problem(&format!("{path}.joint"), message, &hint);
                continue;
            };
            if motors.iter().any(|motor| motor.joint == joint) {
                let message = format!("joint `{}` has two motors", table.joint);
                self.problem(
                    &format!("{path}.joint"),
                    message,
                    "add up their inertias at the joint",
                );
                continue;
            }
            let slides = super::structure::slides(file, &table.joint);
            let ratio = match (table.ratio, table.lead_mm) {
                (Some(ratio), None) if !slides => ratio,
                (None, Some(lead)) if slides => std::f64::consts::TAU / from_mm(lead),
                _ => {
                    let message = match slides {
                        true => "the motor of a prismatic joint needs `lead_mm` and no `ratio`",
                        false => "the motor of a revolute joint needs `ratio` and no `lead_mm`",
                    };
                    let hint = "ratio = 120 (turns of the motor per turn of the joint), or lead_mm = 20 (travel per turn of the motor)";
                    self.problem(&path, message, hint);
                    continue;
                }
            };
            motors.push(Motor {
                joint,
                rotor_inertia: table.rotor_inertia_kg_m2,
                ratio,
            });
        }
        motors
    }

    /// Damping: one ratio, or dampers of all joints that deflect.
    pub(super) fn damping(&mut self, file: &RobotFile) -> Option<Damping> {
        let mut dampers = Vec::new();
        let mut missing = None;
        for (index, entry) in file.joint.iter().enumerate() {
            let path = format!("joint[{index}]");
            let slides = super::structure::slides(file, &entry.name);
            let (own, other, key) = match slides {
                true => (
                    entry.damping_n_s_per_m,
                    entry.damping_n_m_s_per_rad,
                    "damping_n_s_per_m",
                ),
                false => (
                    entry.damping_n_m_s_per_rad,
                    entry.damping_n_s_per_m,
                    "damping_n_m_s_per_rad",
                ),
            };
            if other.is_some() {
                let message = format!(
                    "joint {}: the unit of its damping is that of the other kind of joint",
                    entry.name
                );
                self.problem(&path, message, &format!("write {key}"));
            }
            match (own, &entry.damping_source) {
                (Some(_), None) => {
                    let message = format!("joint {}: its damping names no source", entry.name);
                    self.problem(&path, message, "add damping_source = \"...\"");
                }
                (None, Some(_)) => {
                    let message = format!(
                        "joint {}: a source of its damping without the damping",
                        entry.name
                    );
                    self.problem(&path, message, &format!("add {key} = ..."));
                }
                _ => {}
            }
            if own.is_none() && entry.compliance().is_none_or(|compliance| compliance > 0.0) {
                missing = missing.or(Some((path, key, entry.name.clone())));
            }
            dampers.push(own);
        }
        if dampers.iter().all(Option::is_none) {
            return file.damping.as_ref().map(|table| Damping::Ratio(table.ratio));
        }
        if file.damping.is_some() {
            let message = "the damping is given twice: as one ratio, and of joints";
            self.problem(
                "damping",
                message,
                "remove [damping], or the damping of the joints",
            );
        }
        if let Some((path, key, joint)) = missing {
            let message = format!("joint {joint} has no damping, but others have");
            let hint = format!("add {key} to every joint that deflects, or use [damping] ratio");
            self.problem(&path, message, &hint);
        }
        Some(Damping::Joints(
            dampers.into_iter().map(Option::unwrap_or_default).collect(),
        ))
    }
}

#[cfg(test)]
mod tests;

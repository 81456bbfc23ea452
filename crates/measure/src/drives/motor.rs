//! Friction, load and inertia of each joint, from the torque of its motor.

use armill_core::motor_torque::load::{of_own_position, of_robot};
use armill_core::motor_torque::{LoadTerm, LoadUnit, MotorSignals, MotorTorque, fit};
use schemars::JsonSchema;
use serde::Serialize;

use super::estimate::{EstimateAnswer, pairs_text};
use super::question::{DriveLog, DrivesQuestion};

/// What makes up the torque of the motor of a joint.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct MotorAnswer {
    /// Number of the joint, from 1.
    pub joint: usize,
    /// Coulomb friction.
    pub coulomb_nm: Option<EstimateAnswer>,
    /// Viscous friction, per speed of the joint.
    pub viscous_nm_s_per_rad: Option<EstimateAnswer>,
    /// Torque per acceleration of the joint.
    pub inertia_kg_m2: Option<EstimateAnswer>,
    /// Load: gravity and, where there is one, the counterbalance.
    pub loads: Vec<LoadAnswer>,
    /// Constant part: friction that differs between the directions, or an offset of the measured torque.
    pub constant_nm: Option<EstimateAnswer>,
    /// Torque in motion about its mean, rms.
    pub before_rms_nm: f64,
    /// What remains of it, rms.
    pub after_rms_nm: f64,
    /// Number of independent instants.
    pub independent_samples: f64,
    /// Torque in the compared log about its mean, rms; less the prediction; less the prediction with a constant part of its own.
    pub compared_rms_nm: Option<[f64; 3]>,
    /// Values that cannot be distinguished.
    pub inseparable: Vec<String>,
    /// Terms that the log does not determine.
    pub left_out: Vec<String>,
}

/// A part of the load: its coefficient times a function of the joint positions.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct LoadAnswer {
    /// Function of the joint positions.
    pub name: String,
    /// Unit of the coefficient.
    pub unit: LoadUnitAnswer,
    /// Torque of the motor per unit of the function.
    pub coefficient: EstimateAnswer,
}

/// Unit of the coefficient of a load.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub enum LoadUnitAnswer {
    /// N m.
    #[serde(rename = "nm")]
    Torque,
    /// N m of the motor per N m at the joint.
    #[serde(rename = "nm_per_nm")]
    PerTorque,
}

impl From<LoadUnit> for LoadUnitAnswer {
    fn from(unit: LoadUnit) -> LoadUnitAnswer {
        match unit {
            LoadUnit::Torque => LoadUnitAnswer::Torque,
            LoadUnit::PerTorque => LoadUnitAnswer::PerTorque,
        }
    }
}

/// The answers of all joints that move, and notes on the others.
pub(super) fn evaluate(
    log: &DriveLog,
    compared: Option<&DriveLog>,
    question: &DrivesQuestion,
) -> (Vec<MotorAnswer>, Vec<String>) {
    let own = loads(log, question);
    let other = compared.map(|other| (other, loads(other, question)));
    let (mut motors, mut notes) = (Vec::new(), Vec::new());
    for (joint, loads) in own.iter().enumerate() {
        let Some(found) = fit(&signals(log, joint, loads)) else {
            notes.push(format!("joint {}: the log does not determine friction and load (fewer than 50 instants in motion, or too few independent ones)", joint + 1));
            continue;
        };
        let compared_rms = other
            .as_ref()
            .and_then(|(other, loads)| found.prediction_rms(&signals(other, joint, loads.get(joint)?)));
        let answer = MotorAnswer::of(joint + 1, &found, compared_rms);
        notes.extend(answer.notes());
        motors.push(answer);
    }
    if !motors.is_empty() {
        notes.push("the load contains gravity and, where there is one, a counterbalance: both depend on the position, and a log cannot tell them apart".to_owned());
        notes.push("friction is that of the temperature, the lubrication and the load of the log".to_owned());
    }
    (motors, notes)
}

fn loads(log: &DriveLog, question: &DrivesQuestion) -> Vec<Vec<LoadTerm>> {
    match &question.robot {
        Some(robot) => {
            let instant = |index: usize| log.joints.iter().map(|joint| joint.motor[index]).collect();
            let positions: Vec<Vec<f64>> = (0..log.times.len()).map(instant).collect();
            of_robot(robot, &positions)
        }
        None => log
            .joints
            .iter()
            .map(|joint| of_own_position(&joint.motor))
            .collect(),
    }
}

fn signals<'a>(log: &'a DriveLog, joint: usize, loads: &'a [LoadTerm]) -> MotorSignals<'a> {
    MotorSignals {
        times: &log.times,
        motor: &log.joints[joint].motor,
        torque: &log.joints[joint].torque,
        loads,
    }
}

impl MotorAnswer {
    fn of(joint: usize, found: &MotorTorque, compared_rms_nm: Option<[f64; 3]>) -> MotorAnswer {
        let same = |estimate| EstimateAnswer::of(estimate, |value| value);
        MotorAnswer {
            joint,
            coulomb_nm: found.coulomb.map(same),
            viscous_nm_s_per_rad: found.viscous.map(same),
            inertia_kg_m2: found.inertia.map(same),
            loads: found
                .loads
                .iter()
                .map(|load| LoadAnswer {
                    name: load.name.clone(),
                    unit: load.unit.into(),
                    coefficient: same(load.estimate),
                })
                .collect(),
            constant_nm: found.constant.map(same),
            before_rms_nm: found.before_rms,
            after_rms_nm: found.after_rms,
            independent_samples: found.independent_samples,
            compared_rms_nm,
            inseparable: pairs_text(&found.inseparable),
            left_out: found.left_out.clone(),
        }
    }

    fn notes(&self) -> Vec<String> {
        let joint = self.joint;
        let mut notes: Vec<String> = self
            .inseparable
            .iter()
            .map(|pair| format!("joint {joint}: cannot be distinguished: {pair}"))
            .collect();
        if !self.left_out.is_empty() {
            notes.push(format!(
                "joint {joint}: not determined and left out: {}",
                self.left_out.join(", ")
            ));
        }
        let negative = [
            ("Coulomb friction", self.coulomb_nm),
            ("viscous friction", self.viscous_nm_s_per_rad),
            ("inertia", self.inertia_kg_m2),
        ];
        for (name, value) in negative {
            if value.is_some_and(|value| value.found && value.value < 0.0) {
                notes.push(format!("joint {joint}: the {name} is negative; reverse the sign of the torque, or the model does not describe this log"));
            }
        }
        notes
    }
}

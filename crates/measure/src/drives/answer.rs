//! The result as one JSON value.

use armill_core::torsion::{Estimate, Torsion, fit};
use armill_core::units::{to_ms, to_urad};
use schemars::JsonSchema;
use serde::Serialize;

use super::estimate::{EstimateAnswer, pairs_text};
use super::motor::{self, MotorAnswer};
use super::question::{DriveLog, DrivesQuestion};

/// Orders of the motor shaft.
const ORDERS: usize = 2;

/// Torsion, friction and load of the joints of a log.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct DrivesAnswer {
    /// The log.
    pub file: String,
    /// The log that was predicted.
    pub compared: Option<String>,
    /// From the first instant to the last.
    pub duration_s: f64,
    /// Number of instants.
    pub samples: usize,
    /// The joints with a link encoder.
    pub joints: Vec<DriveAnswer>,
    /// Friction and load of the joints that move.
    pub motors: Vec<MotorAnswer>,
    /// What to know of the log and of the result.
    pub notes: Vec<String>,
}

/// Torsion of a joint.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct DriveAnswer {
    /// Number of the joint, from 1.
    pub joint: usize,
    /// Delay of the link encoder behind the motor encoder.
    pub delay_ms: Option<EstimateAnswer>,
    /// Link minus motor at rest without torque.
    pub offset_urad: EstimateAnswer,
    /// Torsion per torque of the motor.
    pub compliance_urad_per_nm: Option<EstimateAnswer>,
    /// Stiffness at the joint, with a gear ratio and a compliance that was found.
    pub stiffness_nm_per_rad: Option<EstimateAnswer>,
    /// Step of the torsion at a reversal: friction before the gear (positive) less lost motion (negative).
    pub reversal_urad: Option<EstimateAnswer>,
    /// Least lost motion, where the step is negative and was found.
    pub lost_motion_urad: Option<f64>,
    /// Least friction torque between motor and gear, where the step is positive and both it and the compliance were found.
    pub friction_nm: Option<f64>,
    /// Transmission error of the orders 1, 2 of the motor shaft, amplitudes, with a gear ratio.
    pub transmission_error_urad: Vec<EstimateAnswer>,
    /// Link minus motor about its mean, rms.
    pub before_rms_urad: f64,
    /// What remains of it, rms.
    pub after_rms_urad: f64,
    /// Number of independent samples.
    pub independent_samples: f64,
    /// Link minus motor in the compared log about its mean, rms; less the prediction; less the prediction with an offset of its own.
    pub compared_rms_urad: Option<[f64; 3]>,
    /// Values that cannot be distinguished.
    pub inseparable: Vec<String>,
}

/// The result, with what a picture needs.
#[derive(Clone, Debug)]
pub struct Evaluated {
    /// The result.
    pub answer: DrivesAnswer,
    /// Number of each joint of the answer, and its torsion.
    pub torsions: Vec<(usize, Torsion)>,
}

/// Fits all joints of a log and predicts another one.
pub fn evaluate(log: &DriveLog, compared: Option<&DriveLog>, question: &DrivesQuestion) -> Evaluated {
    let mut notes = log.notes.clone();
    let mut joints = Vec::new();
    let mut torsions = Vec::new();
    for joint in 0..log.joints.len() {
        let ratio = question.ratios.get(joint).copied();
        // Torque of the rotor per acceleration of the joint.
        let rotor = question
            .rotor_inertias
            .get(joint)
            .zip(ratio)
            .map_or(0.0, |(inertia, ratio)| inertia * ratio);
        let Some(link) = &log.joints[joint].link else {
            continue;
        };
        if link.iter().all(|value| *value == link[0]) {
            notes.push(format!(
                "joint {}: the link encoder does not change; its torsion is not evaluated",
                joint + 1
            ));
            continue;
        }
        let torque = log.gear_torque(joint, rotor);
        let fitted = log
            .signals(joint, &torque)
            .and_then(|signals| fit(&signals, ratio.map(|ratio| (ratio, ORDERS))));
        let Some(torsion) = fitted else {
            notes.push(format!("joint {}: the log does not determine the torsion (too few independent samples, or a delay above 100 ms)", joint + 1));
            continue;
        };
        let compared_rms = compared
            .filter(|other| joint < other.joints.len())
            .and_then(|other| {
                let torque = other.gear_torque(joint, rotor);
                let other = other.signals(joint, &torque)?;
                let [whole, about_mean] = torsion.prediction_rms(&other)?;
                Some([other.difference_rms(), whole, about_mean].map(to_urad))
            });
        let found = DriveAnswer::of(joint + 1, ratio, &torsion);
        notes.extend(found.notes(&torsion));
        joints.push(DriveAnswer {
            compared_rms_urad: compared_rms,
            ..found
        });
        torsions.push((joint + 1, torsion));
    }
    if !joints.is_empty() {
        notes.push("friction between motor and gear and lost motion act on the step at a reversal with opposite signs; a log gives their difference".to_owned());
        notes.push("viscous friction between motor and gear shortens the delay by compliance times damping; a log gives their difference".to_owned());
        if question.ratios.is_empty() {
            notes.push(
                "without gear ratios (--gear) there is no stiffness at the joint and no transmission error"
                    .to_owned(),
            );
        }
        if question.rotor_inertias.is_empty() {
            notes.push("the torque that accelerates the rotors is not removed (--rotor-inertia): it makes a drive appear stiffer".to_owned());
        }
    }
    let (motors, of_motors) = motor::evaluate(log, compared, question);
    notes.extend(of_motors);
    let answer = DrivesAnswer {
        file: log.file.clone(),
        compared: compared.map(|other| other.file.clone()),
        duration_s: log
            .times
            .last()
            .zip(log.times.first())
            .map_or(0.0, |(last, first)| last - first),
        samples: log.times.len(),
        joints,
        motors,
        notes,
    };
    Evaluated { answer, torsions }
}

impl DriveAnswer {
    fn of(joint: usize, ratio: Option<f64>, torsion: &Torsion) -> DriveAnswer {
        let microradians = |estimate: Estimate| EstimateAnswer::of(estimate, to_urad);
        let stiff = torsion
            .compliance
            .filter(|compliance| compliance.is_found() && compliance.value > 0.0);
        let stiffness = stiff.zip(ratio).map(|(compliance, ratio)| {
            let value = ratio / compliance.value;
            EstimateAnswer {
                value,
                u: value * compliance.u / compliance.value,
                found: true,
            }
        });
        let step = torsion
            .reversal
            .filter(Estimate::is_found)
            .map(|reversal| 2.0 * reversal.value);
        DriveAnswer {
            joint,
            delay_ms: torsion.delay.map(|delay| EstimateAnswer::of(delay, to_ms)),
            offset_urad: microradians(torsion.offset),
            compliance_urad_per_nm: torsion.compliance.map(microradians),
            stiffness_nm_per_rad: stiffness,
            reversal_urad: torsion
                .reversal
                .map(|half| EstimateAnswer::of(half, |value| 2.0 * to_urad(value))),
            lost_motion_urad: step.filter(|step| *step < 0.0).map(|step| -to_urad(step)),
            friction_nm: step
                .filter(|step| *step > 0.0)
                .zip(stiff)
                .map(|(step, stiff)| step / 2.0 / stiff.value),
            transmission_error_urad: torsion
                .harmonics
                .iter()
                .map(|harmonic| microradians(harmonic.amplitude))
                .collect(),
            before_rms_urad: to_urad(torsion.before_rms),
            after_rms_urad: to_urad(torsion.after_rms),
            independent_samples: torsion.independent_samples,
            compared_rms_urad: None,
            inseparable: pairs_text(&torsion.inseparable),
        }
    }

    fn notes(&self, torsion: &Torsion) -> Vec<String> {
        let mut notes = Vec::new();
        let joint = self.joint;
        match torsion.compliance {
            None => notes.push(format!("joint {joint}: the torque does not change; no compliance")),
            Some(compliance) if !compliance.is_found() => {
                notes.push(format!("joint {joint}: no compliance found; it is less than three standard uncertainties from 0"));
            }
            Some(compliance) if compliance.value < 0.0 => notes.push(format!(
                "joint {joint}: the torsion has the direction of the torque; reverse the sign of the torque, or the model does not describe this log"
            )),
            Some(_) => {}
        }
        if torsion.delay.is_none() {
            notes.push(format!("joint {joint}: it does not move; no delay"));
        }
        if torsion.reversal.is_none() {
            notes.push(format!("joint {joint}: no reversal; no step"));
        }
        notes.extend(
            self.inseparable
                .iter()
                .map(|pair| format!("joint {joint}: cannot be distinguished: {pair}")),
        );
        notes
    }
}

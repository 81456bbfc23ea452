//! KUKA KR 300 R2500 ultra: motor encoders, link encoders and torques of two logs, each predicted from the other. See README.md.

use armill_measure::drives::{DrivesAnswer, DrivesQuestion, MatlabNames, evaluate, read};

use crate::measured::{Comparison, Samples, Stated};

/// Arrays of the logs.
const NAMES: [&str; 4] = [
    "rec.time_cont",
    "rec.act_pos_mot_deg",
    "rec.act_pos_se_deg",
    "rec.act_torque_abs_nm",
];
/// Axes with a link encoder.
const AXES: usize = 3;

/// Torsion of each axis with a link encoder, and the torques of the motors, of each log from the other; one rms for each log and axis.
pub fn comparisons(samples: &Samples) -> Vec<Comparison> {
    let answers =
        [["run_A.mat", "run_B.mat"], ["run_B.mat", "run_A.mat"]].map(|logs| answered(samples, logs));
    let torsions = (0..AXES).flat_map(|axis| {
        let rms = |which: usize| -> Vec<f64> {
            let of_axis = answers.iter().map(|answer| &answer.joints[axis]);
            of_axis
                .filter_map(|joint| Some(joint.compared_rms_urad?[which]))
                .collect()
        };
        let quantity = format!("link minus motor encoder, axis {} (rms of a log)", axis + 1);
        pair(
            &quantity,
            ["none: rigid drive", "delay, torsion, step of the other log"],
            [rms(0), rms(1)],
            "urad",
        )
    });
    let torques = ["1 to 3", "4 to 6"]
        .into_iter()
        .enumerate()
        .flat_map(|(half, axes)| {
            let rms = |which: usize| -> Vec<f64> {
                let of_half = answers
                    .iter()
                    .flat_map(|answer| answer.motors.iter().skip(half * AXES).take(AXES));
                of_half
                    .filter_map(|motor| Some(motor.compared_rms_nm?[which]))
                    .collect()
            };
            let quantity = format!("torque of a motor, axes {axes} (rms of a log)");
            pair(
                &quantity,
                ["none: its mean", "friction, inertia, load of the other log"],
                [rms(0), rms(1)],
                "N m",
            )
        });
    torsions.chain(torques).collect()
}

fn pair(quantity: &str, models: [&str; 2], errors: [Vec<f64>; 2], unit: &'static str) -> Vec<Comparison> {
    models
        .into_iter()
        .zip(errors)
        .map(|(model, errors)| Comparison {
            quantity: quantity.to_owned(),
            model: model.to_owned(),
            unit,
            errors,
            stated: Stated::Nothing,
        })
        .collect()
}

fn answered(samples: &Samples, logs: [&str; 2]) -> DrivesAnswer {
    let question = DrivesQuestion {
        names: MatlabNames::of(&NAMES.map(str::to_owned)),
        ..DrivesQuestion::default()
    };
    let [log, other] = logs.map(|name| {
        read(&samples.path("kuka-kr300-encoders").join(name), &question)
            .unwrap_or_else(|problems| panic!("{name}: {problems}"))
    });
    evaluate(&log, Some(&other), &question).answer
}

//! KUKA LBR iiwa 7: 198 poses with each of three payloads, with the torques of the joints. See README.md.

use armill_core::calibrate::{Calibrated, MeasuredPose, ParameterSet, Question, fit};
use armill_core::robot::Robot;
use armill_core::units::to_mm;
use armill_measure::tracker::{Files, JointUnit, together};

use crate::arms;
use crate::measured::poses::question;
use crate::measured::{Comparison, Samples, Stated};

/// The axis whose compliance is found: in these postures the torques of axes 4 and 6 are proportional to its own.
const AXIS: usize = 1;
/// Compliances among which it is found, rad/(N m).
const RANGE: [f64; 2] = [0.0, 5e-4];
/// Files and payloads; the first one is that from which the compliance is found.
const RUNS: [(&str, &str); 3] = [
    ("20161216_run1_0kg", "without payload"),
    ("20161216_run2_1.25kg", "1.25 kg"),
    ("20161216_run3_2.5kg", "2.5 kg"),
];

/// Poses of a run, and the torque of the axis at each, N m.
struct Run {
    poses: Vec<MeasuredPose>,
    torques: Vec<f64>,
}

/// Positions with payloads, without compliance and with that of the run without payload.
pub fn comparisons(samples: &Samples) -> Vec<Comparison> {
    let robot = arms::iiwa7();
    let [unloaded, loaded @ ..] = RUNS.map(|(file, payload)| (payload, read(samples, &robot, file)));
    let compliance = compliance(&robot, &unloaded.1);
    let rows = loaded.iter().flat_map(|(payload, run)| {
        [
            ("nominal", 0.0),
            ("compliance of the run without payload", compliance),
        ]
        .map(|(model, compliance)| {
            let errors = placed(&robot, run, compliance).errors.position;
            Comparison {
                quantity: format!("198 poses, {payload}"),
                model: model.to_owned(),
                unit: "mm",
                errors: errors.iter().map(|error| to_mm(error.norm())).collect(),
                stated: Stated::Nothing,
            }
        })
    });
    rows.collect()
}

/// Base and target of a run, with the axis displaced by its torque: the target was mounted again for each run.
fn placed(robot: &Robot, run: &Run, compliance: f64) -> Calibrated {
    let displaced = run.poses.iter().zip(&run.torques).map(|(pose, torque)| {
        let mut pose = pose.clone();
        pose.joints[AXIS] += compliance * torque;
        pose
    });
    let question = Question {
        requested: ParameterSet::BaseAndTool,
        ..question()
    };
    fit(robot, &displaced.collect::<Vec<_>>(), &question).unwrap_or_else(|error| panic!("{error}"))
}

/// The compliance with which base and target explain a run best, by golden section, rad/(N m).
fn compliance(robot: &Robot, run: &Run) -> f64 {
    let cost = |compliance: f64| placed(robot, run, compliance).standard_deviation;
    let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
    let [mut low, mut high] = RANGE;
    for _ in 0..30 {
        let width = golden * (high - low);
        match cost(high - width) < cost(low + width) {
            true => high = low + width,
            false => low = high - width,
        }
    }
    0.5 * (low + high)
}

fn read(samples: &Samples, robot: &Robot, file: &str) -> Run {
    let name = format!("iiwa7-payload/{file}.csv");
    let files = Files {
        measured: vec![samples.path(&name)],
        base: None,
        joints: None,
        joint_unit: JointUnit::Degree,
    };
    let found = together(robot, &files).unwrap_or_else(|error| panic!("{error}"));
    // Columns: number, seven positions, seven torques, matrix.
    let torques = samples.rows(&name).iter().map(|row| row[8 + AXIS]).collect();
    Run {
        poses: found.poses,
        torques,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compliance_and_errors_are_those_of_another_program() {
        let Some(samples) = Samples::from_environment() else {
            println!("skipped: ARMILL_SAMPLES is not set");
            return;
        };
        let robot = arms::iiwa7();
        let run = read(&samples, &robot, RUNS[0].0);
        // numpy and scipy (least_squares; 1 rad as 200 mm).
        let rms = |compliance| to_mm(placed(&robot, &run, compliance).errors.of_position().unwrap().rms);
        assert!((rms(0.0) / 1.3936 - 1.0).abs() < 2e-3, "{}", rms(0.0));
        let found = compliance(&robot, &run);
        assert!((found / 76.4e-6 - 1.0).abs() < 0.01, "{found}");
        assert!((rms(found) / 0.4222 - 1.0).abs() < 2e-3, "{}", rms(found));
    }
}

//! Staubli TX90L: poses of a 6-D target on three paths. See README.md.

use armill_core::calibrate::MeasuredPose;
use armill_measure::tracker::{Files, JointUnit, together};

use crate::arms;
use crate::measured::poses::{on_others, question, stretches_held_out};
use crate::measured::{Comparison, Samples};

/// Poses held out, and points and poses by what was found from the other.
pub fn comparisons(samples: &Samples) -> Vec<Comparison> {
    let robot = arms::tx90l();
    let [points, line, few] = ["POINTS", "LINE", "Calibration"].map(|path| poses(samples, path));
    let mut rows = stretches_held_out(&robot, "300 points", &points, 6);
    rows.extend(stretches_held_out(&robot, "a line", &line, 6));
    rows.extend(on_others(
        &robot,
        &question(),
        ("40 poses", &few),
        &[("300 points", &points), ("a line", &line)],
    ));
    rows.extend(on_others(
        &robot,
        &question(),
        ("300 points", &points),
        &[("40 poses", &few), ("a line", &line)],
    ));
    rows
}

/// Poses of a path.
fn poses(samples: &Samples, path: &str) -> Vec<MeasuredPose> {
    let file = |ending: &str| samples.path(&format!("staubli-tx90l-tracker/{path}.{ending}"));
    let files = Files {
        measured: vec![file("csv")],
        base: None,
        joints: Some(file("xlsx")),
        joint_unit: JointUnit::Degree,
    };
    together(&arms::tx90l(), &files)
        .unwrap_or_else(|error| panic!("{path}: {error}"))
        .poses
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::poses::testing::{assert_near, least_squares};

    #[test]
    fn calibration_is_the_least_squares_of_another_program() {
        let Some(samples) = Samples::from_environment() else {
            println!("skipped: ARMILL_SAMPLES is not set");
            return;
        };
        // numpy and scipy (least_squares, 25 parameters of Denavit and Hartenberg with one of Hayati, and both frames, 1 rad as 200 mm).
        for (path, expected) in [
            ("POINTS", [[0.173_394, 0.040_586], [0.073_913, 0.022_733]]),
            ("Calibration", [[0.421_199, 0.068_651], [0.115_688, 0.029_495]]),
        ] {
            assert_near(
                least_squares(&arms::tx90l(), &poses(&samples, path)),
                expected,
                2e-3,
            );
        }
    }
}

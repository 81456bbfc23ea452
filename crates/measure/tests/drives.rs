//! Drives of a KUKA KR 300 R2500 ultra from two logs with both encoders (MATLAB, 10 s, 4 ms), if the samples are available.
//!
//! Expected: a script with numpy and scipy, with cubic splines between samples, and uncertainties by a bootstrap of blocks of 1 s.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::path::{Path, PathBuf};

use armill_measure::drives::{DrivesAnswer, DrivesQuestion, MatlabNames, evaluate, read};

/// Of a run: delay, ms, compliance, urad/(N m), step, urad, each with its uncertainty; rms before and after; rms of the other run before
/// and less the prediction, urad.
type Expected = [f64; 10];

#[rustfmt::skip]
const EXPECTED: [(&str, &str, [Expected; 3]); 2] = [
    ("run_A.mat", "run_B.mat", [
        [3.160, 0.187, -16.50, 9.19, -66.7, 73.0, 700.0, 58.62, 524.4, 105.1],
        [2.902, 0.089, 18.74, 5.69, 60.7, 54.8, 727.6, 78.14, 556.5, 73.7],
        [2.722, 0.061, 36.95, 4.51, 94.4, 34.1, 679.0, 47.13, 601.2, 55.4],
    ]),
    ("run_B.mat", "run_A.mat", [
        [2.851, 0.066, 22.31, 4.63, 7.8, 19.1, 524.4, 35.57, 700.0, 115.2],
        [2.881, 0.066, 20.26, 3.43, 44.5, 22.1, 556.5, 69.63, 727.6, 81.9],
        [2.728, 0.051, 40.49, 5.67, 113.5, 30.6, 601.2, 46.28, 679.0, 58.1],
    ]),
];

fn folder() -> Option<PathBuf> {
    let samples = std::env::var_os("ARMILL_SAMPLES");
    if samples.is_none() {
        println!("skipped: ARMILL_SAMPLES is not set");
    }
    Some(Path::new(&samples?).join("datasets/kuka-kr300-encoders"))
}

fn answered(folder: &Path, log: &str, other: &str) -> DrivesAnswer {
    let paths = [
        "rec.time_cont",
        "rec.act_pos_mot_deg",
        "rec.act_pos_se_deg",
        "rec.act_torque_abs_nm",
    ];
    let question = DrivesQuestion {
        names: Some(MatlabNames {
            paths: paths.map(str::to_owned),
        }),
        ..DrivesQuestion::default()
    };
    let [log, other] = [log, other].map(|name| {
        read(&folder.join(name), &question).unwrap_or_else(|problems| panic!("{name}: {problems}"))
    });
    evaluate(&log, Some(&other), &question).answer
}

/// Values within 0.05 of their uncertainty and rms within 3 % (other interpolation); uncertainties within a factor of 3, as the bootstrap has ten blocks.
#[test]
fn the_axes_of_a_kr_300_are_as_an_independent_script_finds_them() {
    let Some(folder) = folder() else { return };
    let mut bad = Vec::new();
    for (log, other, expected) in EXPECTED {
        let found = answered(&folder, log, other);
        assert_eq!(found.joints.len(), 3, "axes 4 to 6 have no link encoder");
        for (joint, expected) in found.joints.iter().zip(expected) {
            let estimates = [joint.delay_ms, joint.compliance_urad_per_nm, joint.reversal_urad];
            for (index, estimate) in estimates.into_iter().enumerate() {
                let estimate = estimate.expect("the log determines it");
                let [value, u] = [expected[2 * index], expected[2 * index + 1]];
                let factor = estimate.u / u;
                if (estimate.value - value).abs() > 0.05 * u || !(1.0 / 3.0..3.0).contains(&factor) {
                    bad.push(format!(
                        "{log}, axis {}, value {index}: {estimate:?} for {value} +- {u}",
                        joint.joint
                    ));
                }
            }
            let compared = joint.compared_rms_urad.expect("the other log is compared");
            let rms = [
                joint.before_rms_urad,
                joint.after_rms_urad,
                compared[0],
                compared[1],
            ];
            for (found, expected) in rms.into_iter().zip(&expected[6..]) {
                if (found / expected - 1.0).abs() > 0.03 {
                    bad.push(format!("{log}, axis {}: rms {found} for {expected}", joint.joint));
                }
            }
        }
    }
    assert!(bad.is_empty(), "{}", bad.join("\n"));
}

#[test]
fn arrays_of_a_matlab_file_have_to_be_named() {
    let Some(folder) = folder() else { return };
    let error = read(&folder.join("run_A.mat"), &DrivesQuestion::default()).unwrap_err();
    for part in ["--names TIME,MOTOR,LINK,TORQUE", "time_data.time_cont"] {
        assert!(error.to_string().contains(part), "{error}");
    }
}

//! Drives of a KUKA KR 300 R2500 ultra from two logs with both encoders (MATLAB, 10 s, 4 ms), if the samples are available.
//!
//! Expected: scripts with numpy and scipy; the torsion with cubic splines between samples, and uncertainties by a bootstrap of blocks of 1 s; friction and load by `lstsq` with
//! derivatives of `savgol_filter`; stiffness without the torque of the rotors by the same splines and filter.

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
    answered_with(folder, [log, other], DrivesQuestion::default())
}

fn answered_with(folder: &Path, [log, other]: [&str; 2], settings: DrivesQuestion) -> DrivesAnswer {
    let names = [
        "rec.time_cont",
        "rec.act_pos_mot_deg",
        "rec.act_pos_se_deg",
        "rec.act_torque_abs_nm",
    ];
    let question = DrivesQuestion {
        names: MatlabNames::of(&names.map(str::to_owned)),
        ..settings
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

/// Of a run and axis: Coulomb friction, N m, viscous friction, N m s/rad, inertia, kg m^2, cosine and sine of the load, N m, each with its uncertainty; rms before and after, N m; rms of the other run before, less the
/// prediction, and with a constant part of its own, N m.
type Torque = [f64; 15];

#[rustfmt::skip]
#[expect(clippy::approx_constant, reason = "numbers of a script that are near a constant by chance")]
const TORQUES: [(&str, &str, [Torque; 6]); 2] = [
    ("run_A.mat", "run_B.mat", [
        [1.5198, 0.0338, 7.1075, 0.1308, 8.2904, 0.1439, 0.0593, 0.0447, 0.4916, 0.1273, 3.9196, 0.8680, 3.0973, 1.2692, 1.2690],
        [2.0748, 0.6751, 7.2349, 2.6095, 9.7800, 1.1539, -8.2726, 0.8083, 6.6272, 3.2056, 5.5706, 1.3644, 4.8963, 2.0173, 1.6304],
        [1.6388, 0.9485, 5.9681, 3.8389, 0.6959, 4.4583, -12.3519, 1.2142, -0.6352, 3.4183, 3.8355, 1.6123, 4.6094, 2.8294, 2.5678],
        [0.5642, 0.0814, 0.6377, 0.2511, 0.6993, 0.1073, 0.0023, 0.0764, 0.5742, 0.1674, 0.8345, 0.2007, 0.7367, 0.2426, 0.2169],
        [0.4119, 0.3716, 3.6907, 1.7503, 1.4237, 0.7609, -1.9500, 0.2859, 1.0444, 1.7657, 1.2507, 0.4391, 1.0480, 0.4867, 0.4788],
        [0.6466, 0.0691, 2.4386, 0.1678, 0.4651, 0.0576, -0.0053, 0.0628, -0.0008, 0.1168, 1.5691, 0.1709, 1.0465, 0.2091, 0.2068],
    ]),
    ("run_B.mat", "run_A.mat", [
        [1.4071, 0.0244, 7.4627, 0.1280, 4.7025, 0.0715, -0.0259, 0.0280, -0.2529, 0.1434, 3.0973, 0.7060, 3.9196, 1.2173, 1.1819],
        [1.7481, 0.2931, 8.9981, 1.4752, 10.0719, 1.0179, -7.5879, 0.2585, -1.0844, 2.0935, 4.8963, 1.0122, 5.5706, 2.2455, 2.0149],
        [2.1799, 0.6366, 3.3449, 2.9137, 8.2346, 2.8415, -11.5522, 0.7534, -2.9306, 2.7183, 4.6094, 1.3655, 3.8355, 3.0647, 2.7851],
        [0.5234, 0.0571, 0.9403, 0.3063, 0.6718, 0.1075, -0.1284, 0.0602, 0.6789, 0.2583, 0.7367, 0.2120, 0.8345, 0.2633, 0.2114],
        [0.6428, 0.3005, 1.5080, 1.6402, 1.3559, 1.0184, -1.7116, 0.3510, -0.5794, 2.7963, 1.0480, 0.3415, 1.2507, 0.5934, 0.5904],
        [0.5982, 0.0778, 2.5244, 0.4053, 0.4438, 0.2261, -0.0521, 0.0690, -0.2096, 0.6519, 1.0465, 0.2025, 1.5691, 0.1946, 0.1940],
    ]),
];

/// The same formulas: digits of the script, and the uneven clock, which the script takes as even (0.5 % of a value and 0.01 of its uncertainty).
#[test]
fn friction_and_load_of_a_kr_300_are_as_an_independent_script_finds_them() {
    let Some(folder) = folder() else { return };
    let mut bad = Vec::new();
    for (log, other, expected) in TORQUES {
        let found = answered(&folder, log, other);
        assert_eq!(found.motors.len(), 6);
        for (motor, expected) in found.motors.iter().zip(expected) {
            assert_eq!(motor.left_out, ["constant part"], "{log}, axis {}", motor.joint);
            let values = [motor.coulomb_nm, motor.viscous_nm_s_per_rad, motor.inertia_kg_m2]
                .into_iter()
                .flatten()
                .chain(motor.loads.iter().map(|load| load.coefficient));
            let rms = motor.compared_rms_nm.expect("the other log is compared");
            let numbers: Vec<f64> = values
                .flat_map(|value| [value.value, value.u])
                .chain([motor.before_rms_nm, motor.after_rms_nm])
                .chain(rms)
                .collect();
            assert_eq!(numbers.len(), expected.len());
            for (index, (found, expected_value)) in numbers.iter().zip(expected).enumerate() {
                // Value of a pair: relative to its uncertainty as well.
                let u = if index < 10 { expected[index | 1] } else { 0.0 };
                if (found - expected_value).abs() > 5e-3 * expected_value.abs() + 0.01 * u + 5e-5 {
                    bad.push(format!(
                        "{log}, axis {}, number {index}: {found} for {expected_value}",
                        motor.joint
                    ));
                }
            }
        }
    }
    assert!(bad.is_empty(), "{}", bad.join("\n"));
}

/// Published inertias of the motors, kg m^2, and gear ratios; stiffness within 1 % (other interpolation; transmission error in both), of axis 1 in log B only: log A does not determine it.
#[test]
fn without_the_torque_of_the_rotors_the_drives_are_as_an_independent_script_finds_them() {
    let Some(folder) = folder() else { return };
    let expected = [
        ("run_A.mat", "run_B.mat", [0.0, 8.9347e6, 6.2319e6]),
        ("run_B.mat", "run_A.mat", [8.0731e6, 1.0088e7, 5.3649e6]),
    ];
    for (log, other, expected) in expected {
        let settings = DrivesQuestion {
            ratios: vec![
                1798.0 / 7.0,
                1872.0 / 7.0,
                757.0 / 3.0,
                221.0,
                5032.0 / 21.0,
                206_793.0 / 1340.0,
            ],
            rotor_inertias: vec![0.009_23, 0.0118, 0.0118, 0.001_73, 0.001_73, 0.001_73],
            ..DrivesQuestion::default()
        };
        let found = answered_with(&folder, [log, other], settings);
        for (joint, expected) in found.joints.iter().zip(expected) {
            match joint.stiffness_nm_per_rad {
                Some(stiffness) => assert!(
                    (stiffness.value / expected - 1.0).abs() < 0.01,
                    "{log}, axis {}: {stiffness:?} for {expected}",
                    joint.joint
                ),
                None => assert_eq!((log, joint.joint), ("run_A.mat", 1)),
            }
        }
    }
}

#[test]
fn arrays_of_a_matlab_file_have_to_be_named() {
    let Some(folder) = folder() else { return };
    let error = read(&folder.join("run_A.mat"), &DrivesQuestion::default()).unwrap_err();
    for part in ["--names TIME,MOTOR,LINK,TORQUE", "time_data.time_cont"] {
        assert!(error.to_string().contains(part), "{error}");
    }
}

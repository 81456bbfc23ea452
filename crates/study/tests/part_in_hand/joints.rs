//! The order of joints: that of the robot, in results, tables and keys.

use std::path::Path;

use armill_core::watch::Watch;
use armill_study::answer::answer;
use armill_study::file::resolve::read;
use armill_study::output::table_csv;
use armill_study::pose::{At, PoseQuestion, answer_in_study, first_setting};
use armill_study::run::run;

use crate::{answered, hand};

#[test]
fn a_posture_of_a_result_is_the_posture_of_the_study() {
    let text = hand("[30, -20, 250]", "").replace("half_size_mm = 0", "half_size_mm = 100");
    let worst = answered(&text).maps[0].worst.clone().unwrap();
    let study = read("study.toml", Path::new("."), text.as_bytes()).unwrap();
    let names = ["A1", "A2", "A3", "A4", "A5", "A6"];
    let of_result = answered(&text);
    let shown: Vec<&str> = of_result
        .robot
        .joints
        .iter()
        .map(|joint| joint.name.as_str())
        .collect();
    assert_eq!(shown, names);
    assert_eq!(of_result.maps[0].setting.contributors[..6], names);
    let setting = first_setting(&study).unwrap();
    let question = PoseQuestion {
        at: At::JointsDeg(worst.joints_deg.clone()),
        wrench: Some(setting.cases[0]),
        flange_from_tool: setting.flange_from_tool,
        base: "flange".to_owned(),
        load_dependent: false,
        reference_joints_deg: None,
        home_deg: None,
        caution: None,
    };
    let pose = answer_in_study(&study, &question).unwrap();
    assert_eq!(pose.joint_names, names);
    assert_eq!(pose.contributors[..6], names);
    let posture = &pose.postures[0];
    assert_eq!(posture.branch, worst.branch);
    for (a, b) in posture.tool.xyz_mm.iter().zip(&worst.xyz_mm) {
        assert!(
            (a - b).abs() < 1e-6,
            "{:?} {:?}",
            posture.tool.xyz_mm,
            worst.xyz_mm
        );
    }
    // The shares belong to the same joints: along the deviation they add up to those of the result.
    let deviation = posture.deviation_um.unwrap();
    let [x, y] = [deviation[0], deviation[1]];
    let in_plane = x.hypot(y);
    let shares = posture.joint_share_um.clone().unwrap();
    for (share, of_result) in shares.iter().zip(&worst.joint_share_um) {
        let along = (share[0] * x + share[1] * y) / in_plane;
        assert!(
            (along - of_result).abs() < 1e-3,
            "{shares:?} {:?}",
            worst.joint_share_um
        );
    }
    // Column k of the Jacobian is that of joint k.
    for k in 0..6 {
        const STEP_DEG: f64 = 1e-3;
        let mut moved = worst.joints_deg.clone();
        moved[k] += STEP_DEG;
        let moved = PoseQuestion {
            at: At::JointsDeg(moved),
            ..question.clone()
        };
        let moved = answer_in_study(&study, &moved).unwrap();
        for axis in 0..3 {
            let by = moved.postures[0].tool.xyz_mm[axis] - posture.tool.xyz_mm[axis];
            let expected = 1e3 * posture.jacobian[axis][k] * STEP_DEG.to_radians();
            // Second order: 2 m times the square of the step.
            assert!((by - expected).abs() < 1e-6, "{k} {axis}: {by} {expected} mm");
        }
    }
}

#[test]
fn tables_list_the_joints_in_the_order_of_the_robot() {
    let study = read(
        "study.toml",
        Path::new("."),
        hand("[30, -20, 250]", "").as_bytes(),
    )
    .unwrap();
    let results = run(&study, Watch::NONE).unwrap();
    let point = answer(&study, &results).maps[0].worst.clone().unwrap();
    let csv = String::from_utf8(table_csv(&study, &results[0]).unwrap()).unwrap();
    let mut lines = csv.lines().filter(|line| !line.starts_with('#'));
    let [header, row] = [(); 2].map(|()| lines.next().unwrap().split(',').collect::<Vec<_>>());
    let values = |kind: &str| -> Vec<(String, f64)> {
        let columns = header.iter().zip(&row);
        let of_joints = columns.filter(|(name, _)| name.starts_with(&format!("{kind}_A")));
        of_joints
            .map(|(name, value)| ((*name).to_owned(), value.parse().unwrap()))
            .collect()
    };
    for (kind, unit, expected) in [
        ("joint", "deg", &point.joints_deg),
        ("share", "um", &point.joint_share_um),
    ] {
        let found = values(kind);
        assert_eq!(found.len(), 6, "{header:?}");
        for (k, (name, value)) in found.iter().enumerate() {
            assert_eq!(*name, format!("{kind}_A{}_{unit}", k + 1));
            assert!(
                (value - expected[k]).abs() < 1e-3,
                "{name} {value} {}",
                expected[k]
            );
        }
    }
}

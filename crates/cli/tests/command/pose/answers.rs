//! What `armill pose` says of a pose, in words and in JSON.

use serde_json::Value;

use super::{apart, mh12, of_branch, postures};
use crate::cell::{Cell, LEVER, MH12_URDF, apart_deg, number, numbers, rows};

#[test]
fn the_mh12_regression_point_has_the_printed_joints_and_compliance() {
    let all = mh12(&["--at-mm", "1000,0,800", "--tilt-deg", "0"]);
    for (branch, r, b) in [
        ("front elbow-up no-flip", 180.0, -39.3804),
        ("front elbow-up flip", 0.0, 39.3804),
    ] {
        let posture = of_branch(&all, branch);
        // The witness prints four decimals.
        let joints = numbers(&posture["joints_deg"]);
        for (joint, expected) in [0.0, 11.5959, -27.7845, r, b].into_iter().enumerate() {
            assert!(
                apart_deg(joints[joint], expected) < 0.5e-4,
                "{branch}: joint {joint} at {}",
                joints[joint]
            );
        }
        let compliance = rows(&posture["compliance"]);
        let printed = [[2.8357, 0.0, 6.5188], [0.0, 2.3415, 0.0], [6.5188, 0.0, 23.2123]];
        for (row, printed) in compliance.iter().zip(printed) {
            for (si, printed) in row.iter().zip(printed) {
                assert!(
                    (si * 1e6 - printed).abs() < 0.5e-4,
                    "{} um/N, printed {printed}",
                    si * 1e6
                );
            }
        }
    }
}

#[test]
fn all_eight_branches_of_a_reachable_pose_are_reported_once_each() {
    let all = mh12(&["--at-mm", "1000,0,800"]);
    let mut names: Vec<&str> = all
        .iter()
        .map(|posture| posture["branch"].as_str().unwrap())
        .collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!((all.len(), names.len()), (8, 8), "{names:?}");
}

#[test]
fn joints_outside_their_limits_are_answered_and_reported() {
    let posture = mh12(&["--joints-deg", "175,0,0,0,0,0"]).remove(0);
    assert_eq!(posture["within_limits"], false);
    assert_eq!(posture["limit_joint"], "S");
    // 175 deg against a limit of 170 deg.
    assert!((number(&posture["limit_margin_deg"]) + 5.0).abs() < 1e-9);
    assert_eq!(mh12(&["--joints-deg", "165,0,0,0,0,0"])[0]["within_limits"], true);
}

#[test]
fn a_point_beyond_the_arm_is_a_result_with_its_reason() {
    let said = Cell::new()
        .armill(&["pose", "yaskawa/mh12", "--at-mm", "5000,0,800", "--json"])
        .fine();
    let answer = said.json();
    assert_eq!(answer["postures"], Value::Array(Vec::new()));
    assert_eq!(answer["unreachable"]["reason"], "too_far");
    // The wrist centre at (4900, 0, 800); the stretched arm turns about (155, 0, 450), 614 + sqrt(640^2 + 200^2) long.
    let amount = (4745.0_f64.hypot(350.0)) - (614.0 + 640.0_f64.hypot(200.0));
    assert!(
        (number(&answer["unreachable"]["amount_mm"]) - amount).abs() < 1e-6,
        "{}",
        answer["unreachable"]
    );
    let text = Cell::new()
        .armill(&["pose", "yaskawa/mh12", "--at-mm", "5000,0,800"])
        .fine();
    assert!(text.out.contains("out of reach"), "{}", text.out);
}

#[test]
fn reachable_poses_have_null_for_unreachable() {
    let answer = Cell::new()
        .armill(&["pose", "yaskawa/mh12", "--at-mm", "1000,0,800", "--json"])
        .fine()
        .json();
    assert_eq!(answer["unreachable"], Value::Null);
    assert_eq!(answer["robot"], "yaskawa/mh12");
}

#[test]
fn a_chain_without_named_branches_answers_its_joints_with_branch_null() {
    let cell = Cell::new();
    cell.file("lever.toml", LEVER);
    let posture = postures(
        &cell,
        &["lever.toml", "--joints-deg", "90,100", "--wrench-n", "10,0,0"],
    )
    .remove(0);
    assert_eq!(posture["branch"], "+-");
    // Turned by 90 deg: (500 + 100) mm along y, 300 mm high. Exact to the sine of a quarter turn.
    assert!(apart(&numbers(&posture["tool"]["xyz_mm"]), &[0.0, 600.0, 300.0]) < 1e-9);
    let j = rows(&posture["jacobian"]);
    assert_eq!((j.len(), j[0].len()), (6, 2));
    // 10 N across a lever of 0.6 m on 2e-6 rad/(N m): 7.2 um; the slide is perpendicular to the force.
    assert!(apart(&numbers(&posture["deviation_um"]), &[7.2, 0.0, 0.0]) < 1e-9);
    // Two joints reach few poses: not this one.
    let answer = cell
        .armill(&["pose", "lever.toml", "--at-mm", "0,600,300", "--json"])
        .fine()
        .json();
    assert_eq!(answer["unreachable"]["reason"], "not_found");
    assert!(answer["unreachable"]["amount_deg"].as_f64().unwrap() > 0.0);
}

#[test]
fn without_joint_compliance_there_is_no_deviation_but_a_note_with_a_hint() {
    let cell = Cell::new();
    cell.file("arm.urdf", MH12_URDF);
    let flags = [
        "pose",
        "arm.urdf",
        "--at-mm",
        "1000,0,800",
        "--wrench-n",
        "3,5,5",
        "--json",
    ];
    let answer = cell.armill(&flags).fine().json();
    for posture in answer["postures"].as_array().unwrap() {
        for key in ["compliance", "deviation_um", "rotation_urad", "joint_share_um"] {
            assert_eq!(posture[key], Value::Null, "{key}");
        }
    }
    assert!(
        answer["notes"].to_string().contains("--compliance-rad-per-n-m"),
        "{}",
        answer["notes"]
    );
}

#[test]
fn postures_are_reported_as_text_without_json() {
    let said = Cell::new()
        .armill(&[
            "pose",
            "yaskawa/mh12",
            "--at-mm",
            "1000,0,800",
            "--wrench-n",
            "3,5,5",
        ])
        .fine();
    for word in [
        "front elbow-up flip",
        "OUTSIDE LIMITS",
        "µm/N",
        "deviation",
        "by joint",
    ] {
        assert!(said.out.contains(word), "no `{word}` in:\n{}", said.out);
    }
    assert!(
        !said.out.contains("-0.00,") && !said.out.contains("-0.000 "),
        "{}",
        said.out
    );
}

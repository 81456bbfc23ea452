//! Options that cannot be.

use super::pose;
use crate::cell::Cell;

#[test]
fn a_wrong_number_of_joints_is_reported_with_their_names() {
    pose(&["--joints-deg", "1,2,3"]).refused(&["3 joint positions for the 6 joints", "S, L, U, R, B, T"]);
    pose(&["--joints-deg", "1,2,3,4,5,6,7"]).refused(&["7 joint positions for the 6 joints"]);
}

#[test]
fn a_wrong_count_of_numbers_in_a_flag_is_reported() {
    pose(&["--at-mm", "1,2"]).refused(&["--at-mm: 2 numbers", "three"]);
    pose(&["--at-mm", "1,2,3,4"]).refused(&["--at-mm: 4 numbers"]);
    pose(&["--at-mm", "900,0,800", "--axis", "1,0"]).refused(&["--axis: 2 numbers"]);
    pose(&["--at-mm", "900,0,800", "--tool-mm", "1,2"]).refused(&["--tool-mm: 2 numbers", "three or six"]);
    pose(&["--at-mm", "900,0,800", "--wrench-n", "1,2,3,4"])
        .refused(&["--wrench-n: 4 numbers", "three or six"]);
    pose(&["--at-mm", "900,0,800", "--compliance-rad-per-n-m", "1e-6,1e-6"])
        .refused(&["2 compliances for 6 joints"]);
}

#[test]
fn numbers_that_are_not_finite_are_refused_in_every_flag() {
    for none in ["nan", "inf", "-inf"] {
        let three = format!("{none},0,0");
        let six = format!("{none},0,0,0,0,0");
        pose(&["--joints-deg", &six]).refused(&["--joints-deg", "is not a"]);
        pose(&["--at-mm", &three]).refused(&["--at-mm", "is not a"]);
        for (flag, value) in [
            ("--axis", &*three),
            ("--tool-mm", &*three),
            ("--wrench-n", &*three),
            ("--tilt-deg", none),
            ("--spin-deg", none),
            ("--compliance-rad-per-n-m", &*six),
        ] {
            pose(&["--at-mm", "900,0,800", flag, value]).refused(&[flag, "is not a"]);
        }
    }
}

#[test]
fn numbers_beyond_all_reason_are_refused_in_every_flag() {
    pose(&["--at-mm", "1e300,0,0"]).refused(&["--at-mm", "1e9"]);
    pose(&["--joints-deg", "1e300,0,0,0,0,0"]).refused(&["--joints-deg", "1e9"]);
    pose(&["--at-mm", "900,0,800", "--wrench-n", "0,0,-1e308"]).refused(&["--wrench-n", "1e9"]);
}

#[test]
fn refuses_text_in_place_of_a_number() {
    pose(&["--joints-deg", "1,2,three,4,5,6"]).refused(&["three", "--joints-deg"]);
    pose(&["--joints-deg", ""]).refused(&["--joints-deg"]);
    pose(&["--at-mm", "1,,3"]).refused(&["--at-mm"]);
}

#[test]
fn a_negative_compliance_in_a_flag_is_reported() {
    let flags = [
        "--at-mm",
        "900,0,800",
        "--compliance-rad-per-n-m",
        "-1e-6,1e-6,1e-6,1e-6,1e-6,1e-6",
    ];
    pose(&flags).refused(&["--compliance-rad-per-n-m", "joint S", "rad/(N m)"]);
}

#[test]
fn flags_that_contradict_each_other_are_refused() {
    pose(&[]).refused(&["--at-mm"]);
    pose(&["--joints-deg", "0,0,0,0,0,0", "--at-mm", "1,2,3"]).refused(&["cannot be used with"]);
    pose(&["--at-mm", "1,2,3", "--tilt-deg", "3", "--axis", "0,0,-1"]).refused(&["cannot be used with"]);
    pose(&["--joints-deg", "0,0,0,0,0,0", "--spin-deg", "3"]).refused(&["cannot be used with"]);
    pose(&["--joints-deg", "0,0,0,0,0,0", "--tilt-deg", "3"]).refused(&["cannot be used with"]);
}

#[test]
fn an_axis_without_length_and_an_unknown_frame_are_reported() {
    pose(&["--at-mm", "900,0,800", "--axis", "0,0,0"]).refused(&["--axis", "has no direction"]);
    pose(&["--at-mm", "900,0,800", "--base", "flor"]).refused(&["no frame `flor`", "base_link, controller"]);
}

#[test]
fn commands_and_flags_that_do_not_exist_are_refused() {
    for arguments in [
        &["fly"][..],
        &["run"],
        &["run", "a", "--colour"],
        &["run", "a", "--threads", "0"],
        &["pose"],
        &[],
    ] {
        let said = Cell::new().armill(arguments);
        assert_eq!(
            (said.code, said.out.as_str()),
            (2, ""),
            "{arguments:?}: {}",
            said.err
        );
        assert!(
            said.err.contains("--help") || said.err.contains("Usage"),
            "{}",
            said.err
        );
    }
}

#[test]
fn a_renamed_option_is_refused_with_its_present_name() {
    let cell = Cell::new();
    for (command, old, present) in [
        ("compensate", "--as-drawn", "--nominal"),
        ("compensate", "--ask", "--analysis"),
        ("posture", "--counts", "--component"),
        ("posture", "--goal", "--objective"),
        ("calibrate", "--hold-out", "--validation"),
        ("place", "--sure", "--rank-by"),
    ] {
        let words = [old, present, "a similar argument exists"];
        cell.armill(&[command, "study.toml", old, "1"]).refused(&words);
    }
}

//! One answer of `armill pose` follows from another.

use serde_json::Value;

use super::{SAME_JOINTS_DEG, apart, assert_same_joints, mh12, of_branch, postures};
use crate::cell::{Cell, MH12_COMPLIANCE, MH12_URDF, apart_deg, number, numbers, rows};

#[test]
fn deviation_is_compliance_times_wrench_and_the_shares_add_up() {
    let wrench = [30.0, -20.0, 50.0, 1.0, 2.0, -3.0];
    let list = wrench.map(|w| w.to_string()).join(",");
    for posture in mh12(&[
        "--at-mm",
        "900,250,700",
        "--tilt-deg",
        "35",
        "--tool-mm",
        "0,0,150",
        "--wrench-n",
        &list,
    ]) {
        let c = rows(&posture["compliance"]);
        let predicted: Vec<f64> = c
            .iter()
            .map(|row| row.iter().zip(wrench).map(|(c, w)| c * w).sum::<f64>() * 1e6)
            .collect();
        let given = [
            numbers(&posture["deviation_um"]),
            numbers(&posture["rotation_urad"]),
        ]
        .concat();
        let largest = given.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        // Six products a component, twice; cancellation costs a digit or two of the largest.
        let allowed = 1e3 * f64::EPSILON * largest.max(1.0);
        assert!(apart(&predicted, &given) < allowed, "{predicted:?} and {given:?}");
        let shares = rows(&posture["joint_share_um"]);
        assert_eq!(shares.len(), 6);
        let sum: Vec<f64> = (0..3)
            .map(|axis| shares.iter().map(|share| share[axis]).sum())
            .collect();
        assert!(apart(&sum, &given[..3]) < allowed, "{sum:?} and {given:?}");
    }
}

#[test]
fn twice_the_force_deviates_twice() {
    let at = ["--at-mm", "1000,100,800", "--wrench-n"];
    let (once, twice) = (
        mh12(&[&at[..], &["3,5,-7"]].concat()),
        mh12(&[&at[..], &["6,10,-14"]].concat()),
    );
    for (once, twice) in once.iter().zip(&twice) {
        // Doubling a number is exact; reading it back from JSON may cost its last bit.
        for (once, twice) in numbers(&once["deviation_um"])
            .iter()
            .zip(numbers(&twice["deviation_um"]))
        {
            assert!(
                (2.0 * once - twice).abs() <= 2.0 * f64::EPSILON * twice.abs(),
                "{once} um and {twice} um"
            );
        }
    }
}

#[test]
fn spin_turns_the_last_joint_only() {
    let at = ["--at-mm", "1000,100,800", "--tilt-deg", "30"];
    let unspun = mh12(&at);
    let spun = mh12(&[&at[..], &["--spin-deg", "25"]].concat());
    assert_eq!(unspun.len(), spun.len());
    for posture in &unspun {
        let other = of_branch(&spun, posture["branch"].as_str().unwrap());
        let (before, after) = (numbers(&posture["joints_deg"]), numbers(&other["joints_deg"]));
        for joint in 0..5 {
            assert!(
                apart_deg(before[joint], after[joint]) < SAME_JOINTS_DEG,
                "joint {joint}"
            );
        }
        // T counts against the right hand about the flange's outward axis: only the amount is claimed.
        assert!(
            (apart_deg(before[5], after[5]) - 25.0).abs() < SAME_JOINTS_DEG,
            "T {} to {}",
            before[5],
            after[5]
        );
    }
}

#[test]
fn heights_of_the_controller_frame_count_450_mm_higher() {
    let from_controller = mh12(&["--at-mm", "1000,0,350", "--base", "controller"]);
    let from_floor = mh12(&["--at-mm", "1000,0,800"]);
    assert_eq!(from_controller.len(), from_floor.len());
    for (a, b) in from_controller.iter().zip(&from_floor) {
        assert_eq!(a["branch"], b["branch"]);
        assert_same_joints(a, b);
        let z = |posture: &Value| number(&posture["tool"]["xyz_mm"][2]);
        // 1 m in doubles, a few operations.
        assert!((z(a) + 450.0 - z(b)).abs() < 1e-9);
    }
}

#[test]
fn a_urdf_of_the_same_arm_gives_the_postures_of_the_library() {
    let cell = Cell::new();
    cell.file("by hand.urdf", MH12_URDF);
    for at in [
        ["--at-mm", "1000,0,800", "--tilt-deg", "0"],
        ["--at-mm", "850,-300,650", "--tilt-deg", "70"],
    ] {
        let flags = [
            &at[..],
            &["--wrench-n", "3,5,5", "--compliance-rad-per-n-m", MH12_COMPLIANCE],
        ]
        .concat();
        let by_hand = postures(&cell, &[&["by hand.urdf"], &flags[..]].concat());
        let library = postures(&cell, &[&["yaskawa/mh12"], &flags[..]].concat());
        assert_eq!(by_hand.len(), library.len());
        for posture in &library {
            let other = of_branch(&by_hand, posture["branch"].as_str().unwrap());
            assert_same_joints(posture, other);
            assert_eq!(posture["within_limits"], other["within_limits"]);
            // 1e2 um, through cosines of joints that are SAME_JOINTS_DEG apart.
            assert!(
                apart(
                    &numbers(&posture["deviation_um"]),
                    &numbers(&other["deviation_um"])
                ) < 1e-9
            );
        }
    }
}

#[test]
fn joints_of_a_posture_return_the_tool_to_the_requested_pose() {
    let tool = ["--tool-mm", "15,-25,180,0,30,0"];
    for posture in mh12(&[&["--at-mm", "900,250,700", "--tilt-deg", "60"], &tool[..]].concat()) {
        let joints = numbers(&posture["joints_deg"])
            .iter()
            .map(f64::to_string)
            .collect::<Vec<_>>()
            .join(",");
        let again = mh12(&[&["--joints-deg", &joints], &tool[..]].concat()).remove(0);
        // Nanometres: 1 m in doubles through six rotations.
        assert!(
            apart(&numbers(&again["tool"]["xyz_mm"]), &[900.0, 250.0, 700.0]) < 1e-6,
            "{}",
            posture["branch"]
        );
        assert_eq!(again["branch"], posture["branch"]);
        assert_eq!(again["within_limits"], posture["within_limits"]);
    }
}

#[test]
fn a_tilt_of_90_deg_is_a_tool_that_points_down() {
    let by_tilt = mh12(&["--at-mm", "1000,100,500", "--tilt-deg", "90"]);
    let by_axis = mh12(&["--at-mm", "1000,100,500", "--axis", "0,0,-7"]);
    assert_eq!(by_tilt.len(), by_axis.len());
    by_tilt
        .iter()
        .zip(&by_axis)
        .for_each(|(a, b)| assert_same_joints(a, b));
}

//! `armill pose` against printed numbers, against differences, and against itself.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod cell;

use cell::{Cell, LEVER, MH12_COMPLIANCE, MH12_URDF, apart_deg, number, numbers, rows};
use serde_json::Value;

/// Postures of `armill pose ... --json`.
fn postures(cell: &Cell, arguments: &[&str]) -> Vec<Value> {
    let answer = cell
        .armill(&[&["pose", "--json"], arguments].concat())
        .fine()
        .json();
    answer["postures"].as_array().unwrap().clone()
}

fn mh12(arguments: &[&str]) -> Vec<Value> {
    postures(&Cell::new(), &[&["yaskawa/mh12"], arguments].concat())
}

fn of_branch<'a>(postures: &'a [Value], branch: &str) -> &'a Value {
    postures
        .iter()
        .find(|posture| posture["branch"] == branch)
        .unwrap_or_else(|| panic!("no branch `{branch}`"))
}

/// Largest difference of two lists.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Joints that say the same posture, whole turns taken off; deg. Closed forms keep some 1e3 eps of a turn.
const SAME_JOINTS_DEG: f64 = 360.0 * 1e3 * f64::EPSILON;

#[track_caller]
fn assert_same_joints(a: &Value, b: &Value) {
    for (a, b) in numbers(&a["joints_deg"]).iter().zip(numbers(&b["joints_deg"])) {
        assert!(apart_deg(*a, b) < SAME_JOINTS_DEG, "{a} deg and {b} deg");
    }
}

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
fn all_eight_branches_of_a_reachable_pose_are_told_once_each() {
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
fn compliance_is_symmetric() {
    for posture in mh12(&[
        "--at-mm",
        "900,250,700",
        "--tilt-deg",
        "35",
        "--tool-mm",
        "10,20,150,5,0,0",
    ]) {
        let c = rows(&posture["compliance"]);
        let largest = c
            .iter()
            .flatten()
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        for (i, row) in c.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                // Each entry is a sum of six products.
                assert!(
                    (entry - c[j][i]).abs() <= 6.0 * f64::EPSILON * largest,
                    "C[{i}][{j}]"
                );
            }
        }
    }
}

/// Hamilton product of quaternions (w, x, y, z).
fn product(a: &[f64], b: &[f64]) -> [f64; 4] {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

#[test]
fn jacobian_matches_differences_of_two_poses() {
    const STEP_DEG: f64 = 0.01;
    // Central differences over h: h^2/6 of the third derivative (below 2 m), and eps times 2 m over h.
    let h = STEP_DEG.to_radians();
    let allowed = h * h / 6.0 * 2.0 + 2.0 * 8.0 * f64::EPSILON / h;
    let joints = [20.0, 15.0, -35.0, 50.0, -40.0, 70.0];
    let pose = |joints: &[f64; 6]| {
        let list = joints.map(|q| q.to_string()).join(",");
        mh12(&["--joints-deg", &list, "--tool-mm", "10,-20,150"]).remove(0)
    };
    let j = rows(&pose(&joints)["jacobian"]);
    assert_eq!((j.len(), j[0].len()), (6, 6));
    for joint in 0..6 {
        let moved = |by: f64| {
            let mut joints = joints;
            joints[joint] += by;
            let tool = pose(&joints)["tool"].clone();
            (numbers(&tool["xyz_mm"]), numbers(&tool["quaternion_wxyz"]))
        };
        let ((before, turned_before), (after, turned_after)) = (moved(-STEP_DEG), moved(STEP_DEG));
        let back = [
            turned_before[0],
            -turned_before[1],
            -turned_before[2],
            -turned_before[3],
        ];
        let turn = product(&turned_after, &back);
        for row in 0..3 {
            let linear = (after[row] - before[row]) * 1e-3 / (2.0 * h);
            assert!(
                (j[row][joint] - linear).abs() < allowed,
                "J[{row}][{joint}] = {}, {linear}",
                j[row][joint]
            );
            // Twice the vector part over the angle; of either sign, as the quaternion is.
            let angular = 2.0 * turn[row + 1] * turn[0].signum() / (2.0 * h);
            let found = j[row + 3][joint];
            assert!(
                (found - angular).abs() < allowed,
                "J[{}][{joint}] = {found}, {angular}",
                row + 3
            );
        }
    }
}

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
        let told = [
            numbers(&posture["deviation_um"]),
            numbers(&posture["rotation_urad"]),
        ]
        .concat();
        let largest = told.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        // Six products a component, twice; cancellation costs a digit or two of the largest.
        let allowed = 1e3 * f64::EPSILON * largest.max(1.0);
        assert!(apart(&predicted, &told) < allowed, "{predicted:?} and {told:?}");
        let shares = rows(&posture["joint_share_um"]);
        assert_eq!(shares.len(), 6);
        let sum: Vec<f64> = (0..3)
            .map(|axis| shares.iter().map(|share| share[axis]).sum())
            .collect();
        assert!(apart(&sum, &told[..3]) < allowed, "{sum:?} and {told:?}");
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
fn joints_of_a_posture_bring_the_tool_back_where_it_was_asked() {
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

#[test]
fn joints_outside_their_limits_are_answered_and_told() {
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
fn reachable_poses_say_null_for_unreachable() {
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
    // 10 N across a lever of 0.6 m on 2e-6 rad/(N m): 7.2 um; the slide lies across the force.
    assert!(apart(&numbers(&posture["deviation_um"]), &[7.2, 0.0, 0.0]) < 1e-9);
    // Two joints hold few poses: this one they miss.
    let answer = cell
        .armill(&["pose", "lever.toml", "--at-mm", "0,600,300", "--json"])
        .fine()
        .json();
    assert_eq!(answer["unreachable"]["reason"], "not_found");
    assert!(answer["unreachable"]["amount_deg"].as_f64().unwrap() > 0.0);
}

#[test]
fn without_joint_compliance_there_is_no_deviation_and_a_note_says_what_to_do() {
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
fn postures_are_told_in_words_without_json() {
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

/// Robots that others published, read where they lie.
#[test]
fn every_sample_urdf_answers_and_its_inverse_leads_back_to_the_joints() {
    let Some(samples) = std::env::var_os("ARMILL_SAMPLES") else {
        println!("skipped: ARMILL_SAMPLES is not set");
        return;
    };
    let mut seen = 0;
    for maker in ["kuka", "abb", "staubli"] {
        let folder = std::path::Path::new(&samples).join("robots").join(maker);
        let entries =
            std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
        for file in entries
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|e| e == "urdf"))
        {
            seen += 1;
            check_sample(file.to_str().unwrap());
        }
    }
    assert!(seen > 0, "no sample at all");
}

fn check_sample(file: &str) {
    let cell = Cell::new();
    let robot = cell.armill(&["robots", file, "--json"]).fine().json();
    // A quarter of the way from the lower to the upper limit: away from singularities and from symmetry.
    let quarter = |joint: &Value| {
        let limits = numbers(&joint["limits_deg"]);
        0.75 * limits[0] + 0.25 * limits[1]
    };
    let joints: Vec<f64> = robot["joints"].as_array().unwrap().iter().map(quarter).collect();
    let list = joints.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    let posture = postures(&cell, &[file, "--joints-deg", &list]).remove(0);
    assert_eq!(posture["within_limits"], true, "{file}");
    if robot["inverse"] != "closed_form" {
        println!("{file}: {}", robot["inverse"]);
        return;
    }
    let (axis, spin) = axis_and_spin_deg(&numbers(&posture["tool"]["quaternion_wxyz"]));
    let comma = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    let at = comma(&numbers(&posture["tool"]["xyz_mm"]));
    let flags = [
        file,
        "--at-mm",
        &at,
        "--axis",
        &comma(&axis),
        "--spin-deg",
        &spin.to_string(),
    ];
    let found = postures(&cell, &flags);
    let same = found.iter().map(|other| {
        let other = numbers(&other["joints_deg"]);
        joints
            .iter()
            .zip(other)
            .map(|(a, b)| apart_deg(*a, b))
            .fold(0.0, f64::max)
    });
    let nearest = same.fold(f64::INFINITY, f64::min);
    // The inverse checks itself to 1e-9 m and rad; the wrist is some 0.3 rad from singular: 1e-8 rad, 1e-6 deg.
    assert!(
        nearest < 1e-6,
        "{file}: nearest posture {nearest} deg away of {} postures",
        found.len()
    );
    println!("{file}: {} postures, nearest {nearest:.1e} deg away", found.len());
}

/// Tool axis and spin of an orientation: tool z, and the turn of tool y from where it is nearest to base y.
fn axis_and_spin_deg(q: &[f64]) -> ([f64; 3], f64) {
    let [w, x, y, z] = [q[0], q[1], q[2], q[3]];
    let axis = [
        2.0 * (x * z + w * y),
        2.0 * (y * z - w * x),
        1.0 - 2.0 * (x * x + y * y),
    ];
    let second = [
        2.0 * (x * y - w * z),
        1.0 - 2.0 * (x * x + z * z),
        2.0 * (y * z + w * x),
    ];
    // Base y without its part along the axis, and the direction a quarter turn on; both as long.
    let nearest = [-axis[1] * axis[0], 1.0 - axis[1] * axis[1], -axis[1] * axis[2]];
    let beyond = [-axis[2], 0.0, axis[0]];
    let dot = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    (
        axis,
        dot(&second, &beyond).atan2(dot(&second, &nearest)).to_degrees(),
    )
}

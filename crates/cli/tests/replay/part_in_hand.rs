//! Programs of a part in the hand of the robot: the tool stands in the cell, the work object is on the flange.

use std::process::{Command, Output};

use crate::cells::{events, written};
use crate::event::{Action, JointTarget};
use crate::pose::{Pose, distance};
use crate::replay::Language;

/// The mount of the spindle, which points at the robot, mm, deg.
const MOUNT: [f64; 6] = [1900.0, 100.0, 1500.0, 0.0, -90.0, 0.0];
const TOOL_MM: f64 = 200.0;
const RADIUS_MM: f64 = 120.0;
const HEIGHT_MM: f64 = 250.0;
const ABB: &str = "abb/irb6640-185-280";

fn compensated(robot: &str, program: &str) -> (tempfile::TempDir, Output) {
    let folder = tempfile::tempdir().unwrap();
    let study = format!(
        "format = 1\nrobot = \"{robot}\"\ntolerance_um = 500\ncompliance = {{ class = \"heavy\" }}\n\
         tool = {{ flange_from_tool_mm_deg = [0, 0, {TOOL_MM}, 0, 0, 0] }}\n\
         part_in_hand = {{ base_from_mount_mm_deg = {MOUNT:?} }}\n\
         plane = {{ centre_mm = [0, 0, {HEIGHT_MM}], rotation_deg = [0, 0, 0], half_size_mm = 100, step_mm = 50 }}\n\
         [[analysis]]\nkind = \"path\"\nname = \"ring\"\nload = {{ frame = \"feed\", cases_n = [[0, 0, 50]] }}\n\
         circle = {{ radius_mm = {RADIUS_MM} }}\nstep_mm = 20\n"
    );
    std::fs::write(folder.path().join("study.toml"), study).unwrap();
    let output = written(
        folder.path(),
        program,
        &["--feed-mm-per-min", "1200", "--retract-mm", "40"],
    );
    (folder, output)
}

/// The flange at these joint positions of the robot alone, mm.
fn flange_mm(joints: &[f64]) -> [f64; 3] {
    let joints: Vec<String> = joints.iter().map(f64::to_string).collect();
    let output = Command::new(env!("CARGO_BIN_EXE_armill"))
        .args(["pose", ABB, "--json", "--joints-deg", &joints.join(",")])
        .output()
        .unwrap();
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let at = &answer["postures"][0]["tool"]["xyz_mm"];
    [0, 1, 2].map(|axis| at[axis].as_f64().unwrap())
}

#[test]
fn the_ring_on_the_flange_passes_the_tip_of_the_tool_that_stands() {
    let (folder, output) = compensated(ABB, "p/part.mod");
    let all = events(Language::Rapid, folder.path(), &output);
    let tip = [MOUNT[0] - TOOL_MM, MOUNT[1], MOUNT[2]];
    let mut cut = 0;
    for target in all.iter().filter_map(|event| event.action.linear()) {
        assert!(target.tool.is_swapped && target.base.is_swapped);
        let world_from_tool = target.tool.pose.unwrap();
        assert!(distance(world_from_tool.position_mm, tip) < 1e-3);
        let flange_from_tool = target.base.pose.unwrap().then(&target.to);
        let [x, y, z] = flange_from_tool.position_mm;
        // The tool points along its z against that of the flange.
        assert!(
            flange_from_tool
                .then(&Pose::fixed_xyz([0.0, 0.0, 1.0, 0.0, 0.0, 0.0]))
                .position_mm[2]
                < z - 0.999
        );
        if (z - HEIGHT_MM).abs() < 0.01 {
            assert!((x.hypot(y) - RADIUS_MM).abs() < 0.02, "{x} {y}");
            cut += 1;
        }
    }
    assert!(cut > 10, "{cut} moves on the ring");
    // Joint positions are those of the robot, from its base on: there the tip is above the ring.
    let joint = all.iter().find_map(|event| match &event.action {
        Action::Joint(joint) => Some(joint),
        _ => None,
    });
    let joint = joint.unwrap();
    assert!(joint.tool.is_swapped);
    let JointTarget::Axes(axes) = &joint.to else {
        panic!("{joint:?}")
    };
    // 40 mm above the ring the tip is this far from the flange.
    let expected = RADIUS_MM.hypot(HEIGHT_MM + 40.0);
    let found = distance(flange_mm(axes), tip);
    assert!((found - expected).abs() < 0.05, "{found} {expected} mm");
    let said =
        String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout);
    assert!(said.contains("stands in the cell"), "{said}");
}

#[test]
fn other_languages_refuse_a_part_in_the_hand() {
    for (robot, program) in [
        ("kuka/kr210r2700extra", "p/part.src"),
        ("fanuc/r2000ic", "p/part.ls"),
        ("yaskawa/gp180-120", "p/part.jbi"),
    ] {
        let (_folder, output) = compensated(robot, program);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains("the robot holds the part"), "{program}: {said}");
    }
}

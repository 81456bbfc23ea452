//! The bodies of a cell: the clearance of a pose, and programs that do not keep it.

use crate::cell::{Cell, number, numbers};

const STUDY: &str = r#"format = 1
robot = "yaskawa/mh12"
tolerance_um = 500
least_clearance_mm = 5
plane = { centre_mm = [1000, 0, 500], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }
load = { cases_n = [[3, 5, 5]] }
[tool]
flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0]
[[tool.body]]
name = "spindle"
cylinder_mm = { from = [0, 0, 0], to = [0, 0, 120], diameter = 60 }
[[analysis]]
kind = "path"
name = "ring"
program = { file = "ring.ngc" }
"#;
const RING: &str = "G21 G90 G17\nG0 X40 Y0 Z10\nG0 Z0\nG3 X40 Y0 I-40 J0 F600\nG1 X0 Y20\nG0 Z10\nM2\n";

/// A cell with this study, and more tables.
fn cell(more: &str) -> Cell {
    let cell = Cell::with_study(&format!("{STUDY}{more}"));
    cell.file("ring.ngc", RING);
    cell
}

/// A box from corner to corner.
fn obstacle(name: &str, corners: &str) -> String {
    format!("[[obstacle]]\nname = \"{name}\"\nbox_mm = {corners}\n")
}

#[test]
fn a_pose_in_the_cell_of_a_study_has_its_clearance_and_the_nearest_bodies() {
    let fence = obstacle("fence", "{ from = [1200, -500, 0], to = [1250, 500, 2000] }");
    let cell = cell(&fence);
    let pose = ["pose", "study.toml", "--at-mm", "1000,0,500", "--tilt-deg", "90"];
    let given = cell.armill(&[&pose[..], &["--json"]].concat()).fine().json();
    let first = &given["postures"][0];
    let clearance = number(&first["clearance_mm"]);
    assert!(clearance > 0.0 && clearance < 171.0, "{clearance}");
    assert_eq!(first["nearest"][1], "fence");
    // Across the gap between the two points, of which one is on the fence.
    let [on_arm, on_fence] = [0, 1].map(|body| numbers(&first["nearest_mm"][body]));
    let square: f64 = on_arm.iter().zip(&on_fence).map(|(a, b)| (a - b).powi(2)).sum();
    assert!((square.sqrt() - clearance).abs() < 1e-6);
    assert!((on_fence[0] - 1200.0).abs() < 1e-6);
    let said = cell.armill(&pose).fine();
    assert!(
        said.out.contains("  clearance   ") && said.out.contains(" and fence"),
        "{}",
        said.out
    );
    cell.armill(&[&pose[..], &["--load-dependent"]].concat())
        .refused(&["--load-dependent", "study.toml"]);
    // A robot alone has no cell.
    let alone = [
        "pose",
        "yaskawa/mh12",
        "--at-mm",
        "1000,0,500",
        "--tilt-deg",
        "90",
        "--json",
    ];
    assert!(cell.armill(&alone).fine().json()["postures"][0]["clearance_mm"].is_null());
}

#[test]
fn no_program_is_written_through_a_body() {
    let open = cell("");
    open.armill(&["compensate", "study.toml", "--program", "ring.src"])
        .fine();
    assert!(open.at("ring.src").is_file());
    // A post next to the ring, which the spindle would touch.
    let post = obstacle("post", "{ from = [1050, -10, 400], to = [1070, 10, 700] }");
    let blocked = cell(&post);
    let said = blocked.armill(&["compensate", "study.toml", "--program", "ring.src"]);
    said.refused(&[
        "cannot follow the path",
        "5.0 mm of the demanded clearance are missing",
    ]);
    assert!(!blocked.at("ring.src").exists());
    blocked
        .armill(&["run", "study.toml", "--no-pictures", "--out", "out"])
        .fine();
    let path = &blocked.answer("out")["paths"][0];
    assert!(number(&path["in_collision"]) > 0.0);
    assert_eq!(path["obstacles"][0]["kind"], "collision");
}

#[test]
fn a_joint_move_through_a_body_is_refused() {
    // Home is on the other side of a wall that the cuts do not come near.
    let wall = obstacle("wall", "{ from = [300, 400, 0], to = [1600, 420, 2000] }");
    let home = "[controller]\nhome_deg = [60, 0, 0, 0, -30, 0]\n";
    let clear = cell(home);
    clear
        .armill(&["compensate", "study.toml", "--program", "ring.src"])
        .fine();
    let blocked = cell(&format!("{home}{wall}"));
    let said = blocked.armill(&["compensate", "study.toml", "--program", "ring.src"]);
    said.refused(&["on the joint move", "wall", "home position"]);
    assert!(!blocked.at("ring.src").exists());
}

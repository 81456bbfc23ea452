//! A part in the hand of the robot: the same robot with a tool at the place of contact is the witness.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

mod clearance;
mod joints;

use std::fs;
use std::path::{Path, PathBuf};

use armill_core::watch::Watch;
use armill_study::answer::{StudyAnswer, answer};
use armill_study::file::resolve::read;
use armill_study::run::run;

const HAND: &str = r#"format = 1
robot = "kuka/kr210r2700extra"
tolerance_um = 200
plane = { centre_mm = CENTRE, rotation_deg = [0, 0, 0], half_size_mm = SIZE, step_mm = 50 }
[part_in_hand]
base_from_mount_mm_deg = [2000, 0, 1300, 0, -90, 0]
mass = [{ mass_kg = 80, centre_mm = [0, 0, 120] }]
[tool]
flange_from_tool_mm_deg = [0, 0, 200, 0, 0, 0]
[load]
frame = "part"
cases_n = [[40, -60, 100]]
"#;

fn hand(centre: &str, more: &str) -> String {
    format!("{}{more}", HAND.replace("CENTRE", centre).replace("SIZE", "0"))
}

fn answered(text: &str) -> StudyAnswer {
    let study = read("study.toml", Path::new("."), text.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    answer(&study, &run(&study, Watch::NONE).unwrap())
}

fn problems(text: &str) -> String {
    read("study.toml", Path::new("."), text.as_bytes())
        .unwrap_err()
        .to_string()
}

#[test]
fn the_part_deviates_as_a_tool_of_the_same_robot_at_the_place_of_contact() {
    // The spindle points against base x, its tip is at (1800, 0, 1300). The flange looks along base x, its y is that of
    // the base, and its x is down.
    for [x, y] in [[0, 0], [120, -40], [-60, 150]] {
        let of_hand = answered(&hand(&format!("[{x}, {y}, 250]"), ""));
        // Force on the part: the opposite of that on the tool. In base (x, y, z) it is (z, y, -x) of the flange.
        let with_tool = answered(&format!(
            r#"format = 1
robot = "kuka/kr210r2700extra"
tolerance_um = 200
plane = {{ centre_mm = [1800, 0, 1300], tilt_deg = 0, half_size_mm = 0, step_mm = 50 }}
tool = {{ flange_from_tool_mm_deg = [{x}, {y}, 250, 0, 0, 0] }}
load = {{ cases_n = [[-100, 60, 40]] }}
"#
        ));
        let [hand, tool] = [&of_hand, &with_tool].map(|answer| answer.maps[0].worst.clone().unwrap());
        assert_eq!(hand.branch, tool.branch);
        for (a, b) in hand.joints_deg.iter().zip(&tool.joints_deg) {
            assert!(
                (a - b).abs() < 1e-6,
                "{:?} {:?}",
                hand.joints_deg,
                tool.joints_deg
            );
        }
        assert!(hand.in_plane_um > 50.0);
        // Rounded to 0.1 nm.
        assert!(
            (hand.in_plane_um - tool.in_plane_um).abs() < 2e-4,
            "{} {}",
            hand.in_plane_um,
            tool.in_plane_um
        );
        assert_eq!(of_hand.maps[0].setting.base, "flange");
    }
}

#[test]
fn gravity_has_no_effect_in_the_posture_of_tool_setting_and_has_one_elsewhere() {
    let there = answered(&hand("[0, 0, 250]", "")).maps[0].worst.clone().unwrap();
    let joints = there.joints_deg.iter().map(f64::to_string);
    let joints = joints.collect::<Vec<_>>().join(", ");
    let gravity = format!("[gravity]\nreference_joints_deg = [{joints}]\n");
    let same = answered(&hand("[0, 0, 250]", &gravity)).maps[0]
        .worst
        .clone()
        .unwrap();
    // Joint positions are rounded to 1e-9 deg.
    assert!((same.in_plane_um - there.in_plane_um).abs() < 1e-3);
    let elsewhere = |more: &str| {
        answered(&hand("[150, 100, 250]", more)).maps[0]
            .worst
            .clone()
            .unwrap()
    };
    let by = (elsewhere(&gravity).in_plane_um - elsewhere("").in_plane_um).abs();
    assert!(by > 1.0, "{by} um");
}

#[test]
fn maps_boxes_paths_searches_and_holes_run() {
    let analyses = r#"
[[analysis]]
kind = "map"
name = "face"
[[analysis]]
kind = "volume"
name = "box"
box = { half_size_mm = [50, 50, 50], step_mm = 50 }
[[analysis]]
kind = "path"
name = "ring"
circle.radius_mm = 150
[[analysis]]
kind = "path"
name = "searched"
circle.radius_mm = 150
posture.search = { step_deg = 20, turns_deg = [-60, 60], lean = { lead_deg = [0, 10], step_deg = 5, cutter = { diameter_mm = 12, corner_radius_mm = 6 } } }
[[analysis]]
kind = "holes"
name = "holes"
holes = { at_mm = [[100, 0, 0], [0, 100, 0]] }
"#;
    let text = hand("[0, 0, 250]", analyses).replace("half_size_mm = 0", "half_size_mm = 100");
    let answer = answered(&text);
    assert_eq!(
        answer.maps[0].counts.within + answer.maps[0].counts.above_tolerance,
        25
    );
    assert_eq!(
        answer.volumes[0].counts.within + answer.volumes[0].counts.above_tolerance,
        27
    );
    assert_eq!(answer.paths.len(), 2);
    for path in &answer.paths {
        assert!(path.worst.is_some(), "{}", path.name);
    }
    assert_eq!(answer.holes.len(), 1);
}

#[test]
fn a_part_on_a_positioner_and_in_the_hand_is_refused() {
    let more = "positioner = { robot = \"table.toml\", base_from_root_mm_deg = [0, 0, 0, 0, 0, 0], joints_deg = [0] }\n";
    let text =
        hand("[0, 0, 250]", "").replace("tolerance_um = 200\n", &format!("tolerance_um = 200\n{more}"));
    let found = problems(&text);
    assert!(
        found.contains("a part is either on a positioner or in the hand of the robot")
            && found.contains("study.toml:4:"),
        "{found}"
    );
}

#[test]
fn frames_and_loads_of_the_base_are_refused() {
    let base =
        hand("[0, 0, 250]", "").replace("tolerance_um = 200", "tolerance_um = 200\nbase = \"base_link\"");
    let found = problems(&base);
    assert!(
        found.contains("has no frame `base_link`") && found.contains("it has: flange"),
        "{found}"
    );
    let found = problems(&hand("[0, 0, 250]", "").replace("frame = \"part\"\n", ""));
    assert!(
        found.contains("forces in the axes of base_link are not known of a part in the hand"),
        "{found}"
    );
    let found = problems(&hand("[0, 0, 250]", "").replace(
        "[load]",
        "mass = [{ at = \"A3\", mass_kg = 20, centre_mm = [0, 0, 0], source = \"made-up\" }]\n[load]",
    ));
    assert!(found.contains("a mass of the tool is at `A3`"), "{found}");
}

#[test]
fn a_robot_on_a_rail_is_refused() {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("part-in-hand-rail");
    fs::create_dir_all(&folder).unwrap();
    let joint = |name: &str| {
        format!(
            "[[joint]]\nname = \"{name}\"\nsign = 1\nsource = \"made-up\"\ncompliance_SI = 1e-7\ncompliance_source = \"made-up\"\n"
        )
    };
    let rail = joint("rail").replace("compliance_SI = 1e-7", "compliance_um_per_n = 0.01");
    let joints = ["A1", "A2", "A3", "A4", "A5", "A6"].map(|name| joint(name).replace("_SI", "_rad_per_n_m"));
    let robot = format!(
        r#"format = 1
name = "On a rail"
[chain]
source = "made-up"
motions = [
  {{ along = "y", joint = "rail" }},
  {{ along = "z", length_mm = 600 }},
  {{ about = "z", joint = "A1" }},
  {{ along = "x", length_mm = 300 }},
  {{ about = "y", joint = "A2" }},
  {{ along = "z", length_mm = 1000 }},
  {{ about = "y", joint = "A3" }},
  {{ along = "x", length_mm = 1000 }},
  {{ about = "x", joint = "A4" }},
  {{ about = "y", joint = "A5" }},
  {{ about = "x", joint = "A6" }},
]
{rail}{}
[sources.made-up]
what = "all"
where = "this test"
licence = "none needed"
"#,
        joints.concat()
    );
    fs::write(folder.join("rail.toml"), robot).unwrap();
    let text = hand("[0, 0, 250]", "").replace("kuka/kr210r2700extra", "rail.toml");
    let found = read("study.toml", &folder, text.as_bytes())
        .unwrap_err()
        .to_string();
    assert!(
        found.contains("an arm on 1 external axes cannot hold the part"),
        "{found}"
    );
}

#[test]
fn the_examples_of_the_guide_run() {
    let guide = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/guide/cell.md");
    let guide = fs::read_to_string(guide).unwrap();
    let section = guide.split("## Part in the hand").nth(1).unwrap();
    let section = section.split("\n## ").next().unwrap();
    let mut examples = section
        .split("```toml")
        .skip(1)
        .map(|text| text.split("```").next().unwrap());
    let (study, cell) = (examples.next().unwrap(), examples.next().unwrap());
    let text =
        |keys: &str, tables: &str| format!("format = 1\ntolerance_um = 200\n{keys}\n{study}\n{tables}");
    let counts = &answered(&text("", "")).maps[0].counts;
    assert!(counts.within > 400 && counts.out_of_reach == 0, "{counts:?}");
    let (keys, tables) = cell.split_at(cell.find("[[tool.body]]").unwrap());
    let map = &answered(&text(keys, tables)).maps[0];
    assert_eq!(map.counts.in_collision, 0);
    // The part is 120 mm below its centre, which is up to 200 mm below the tip at 1300 mm; the post ends at 950 mm.
    assert!(
        (map.least_clearance_mm.unwrap() - 30.0).abs() < 1e-6,
        "{:?}",
        map.least_clearance_mm
    );
}

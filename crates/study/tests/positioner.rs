//! A part on a turntable or positioner: where its points are, and what the table's joints add.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::fs;
use std::path::{Path, PathBuf};

use armill_core::nalgebra::Vector3;
use armill_core::watch::Watch;
use armill_study::answer::{StudyAnswer, answer};
use armill_study::file::resolve::read;
use armill_study::output::{StudyResults, pictures};
use armill_study::run::run;

/// Tilts about x at 400 mm, then turns about z at 500 mm above its root.
const TABLE: &str = r#"format = 1
name = "Two-axis positioner"
[chain]
source = "made-up"
motions = [
  { along = "z", length_mm = 400 },
  { about = "x", joint = "tilt" },
  { along = "z", length_mm = 100 },
  { about = "z", joint = "turn" },
]
[[joint]]
name = "tilt"
sign = 1
limits_deg = [-90, 90]
source = "made-up"
COMPLIANCE_TILT
[[joint]]
name = "turn"
sign = 1
limits_deg = [-360, 360]
source = "made-up"
COMPLIANCE_TURN
[sources.made-up]
what = "all"
where = "this test"
licence = "none needed"
"#;

const STUDY: &str = r#"format = 1
robot = "yaskawa/mh12"
tolerance_um = 60
BASE
plane = { centre_mm = CENTRE, rotation_deg = ROTATION, half_size_mm = 100, step_mm = 50 }
load = { cases_n = [[3, -5, 5], [3, 5, 5]] }
"#;

/// A folder of its own with the positioner in it.
fn cell(name: &str, tilt: &str, turn: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).unwrap();
    let compliance = |value: &str| match value {
        "" => String::new(),
        value => format!("compliance_rad_per_n_m = {value}\ncompliance_source = \"made-up\""),
    };
    let text = TABLE
        .replace("COMPLIANCE_TILT", &compliance(tilt))
        .replace("COMPLIANCE_TURN", &compliance(turn));
    fs::write(folder.join("table.toml"), text).unwrap();
    folder
}

fn study(base: &str, centre: &str, rotation: &str, more: &str) -> String {
    let text = STUDY
        .replace("BASE", base)
        .replace("CENTRE", centre)
        .replace("ROTATION", rotation);
    format!("{text}{more}")
}

fn answered(folder: &Path, text: &str) -> StudyAnswer {
    let study = read("study.toml", folder, text.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    answer(&study, &run(&study, Watch::NONE).unwrap())
}

fn positioner(joints: &str) -> String {
    format!(
        "[positioner]\nrobot = \"table.toml\"\nbase_from_root_mm_deg = [1000, 0, 0, 0, 0, 0]\njoints_deg = {joints}\n"
    )
}

#[test]
fn a_part_on_the_table_is_placed_by_its_joints() {
    let folder = cell("positioner-frame", "", "");
    // Tilted by 30 deg about x, turned by 90 deg about its own z. The table's origin is at (1000, 0, 400) + 100 mm
    // along the tilted z: (0, -sin 30, cos 30). Its x axis is the tilted y: (0, cos 30, sin 30).
    let on_table = study(
        "base = \"table\"",
        "[50, 0, 200]",
        "[0, 0, 0]",
        &positioner("[30, 90]"),
    );
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let up = Vector3::new(0.0, -sin, cos);
    let x = Vector3::new(0.0, cos, sin);
    let centre = Vector3::new(1000.0, 0.0, 400.0) + up * 300.0 + x * 50.0;
    // Rotation of the table given about fixed x, y, z: first z by 90, then x by 30 is not of that order; with
    // R = Rx(30) Rz(90) the columns are (0, cos, sin), (-1, 0, 0), (0, -sin, cos): fixed angles (0, -30, 90).
    let in_base = study(
        "",
        &format!("[{}, {}, {}]", centre.x, centre.y, centre.z),
        "[0, -30, 90]",
        "",
    );
    let (a, b) = (answered(&folder, &on_table), answered(&folder, &in_base));
    assert!(a.maps[0].counts.within + a.maps[0].counts.above_tolerance > 10);
    assert_eq!(a.maps[0].setting.base, "table");
    for (a, b) in a.maps[0].grid.in_plane_um.iter().zip(&b.maps[0].grid.in_plane_um) {
        // Both are rounded to 0.1 nm.
        assert!(
            (a.unwrap_or(-1.0) - b.unwrap_or(-1.0)).abs() < 2e-4,
            "{a:?} against {b:?} um"
        );
    }
}

#[test]
fn a_box_is_along_the_axes_of_the_table() {
    let folder = cell("positioner-box", "", "");
    let analysis = "[[analysis]]\nkind = \"volume\"\nname = \"box\"\nbox = { half_size_mm = [100, 100, 100], step_mm = 50 }\n";
    let text = study(
        "base = \"table\"",
        "[50, 0, 200]",
        "[0, 0, 0]",
        &format!("{}{analysis}", positioner("[30, 40]")),
    );
    let answer = answered(&folder, &text);
    let of_box = &answer.volumes[0];
    assert!(of_box.counts.within + of_box.counts.above_tolerance > 30);
    for (corner, expected) in of_box.origin_mm.iter().zip([-50.0, -100.0, 100.0]) {
        assert!((corner - expected).abs() < 1e-9);
    }
    for point in [&of_box.worst, &of_box.best].into_iter().flatten() {
        for (at, corner) in point.xyz_mm.iter().zip(&of_box.origin_mm) {
            let steps = (at - corner) / 50.0;
            assert!(
                (steps - steps.round()).abs() < 1e-9 && (0.0..=4.0).contains(&steps.round()),
                "{point:?}"
            );
        }
    }
    // Its numbers are in the result as those of the robot.
    assert!(
        answer
            .sources
            .iter()
            .any(|source| source.key == "positioner:made-up")
    );
}

#[test]
fn the_deflection_of_the_table_adds_to_that_of_the_robot() {
    // The tilt axis runs along x through (1000, 0, 400); a force of 5 N along y at height z turns it by c 5 N (z -
    // 0.4 m).
    let plane = ("[1000, 0, 900]", "[0, -90, 0]");
    let load = "[[analysis]]\nkind = \"map\"\nname = \"m\"\nload = { cases_n = [[0, 5, 0]] }\n";
    let text = |more: &str| {
        // The centre alone.
        study("", plane.0, plane.1, &format!("{more}{load}"))
            .replace("half_size_mm = 100", "half_size_mm = 0")
    };
    let stiff = cell("positioner-stiff", "0", "0");
    let soft = cell("positioner-soft", "4e-6", "0");
    let arm = answered(&stiff, &text(""));
    let both = answered(&stiff, &text(&positioner("[0, 0]")));
    assert_eq!(
        arm.maps[0].grid.in_plane_um, both.maps[0].grid.in_plane_um,
        "a rigid table adds nothing"
    );
    let compliant = answered(&soft, &text(&positioner("[0, 0]")));
    let deviation = |answer: &StudyAnswer| answer.maps[0].worst.clone().unwrap();
    let (arm, compliant) = (deviation(&arm), deviation(&compliant));
    let lever = (900.0 - 400.0) * 1e-3;
    let along_y_um = 4e-6 * 5.0 * lever * lever * 1e6;
    // The joints of the table come first, from the table back.
    let share = compliant.joint_share_um[1];
    // The plane is vertical and faces the robot: the deviation in it is mostly along y, the arm's and the table's
    // alike.
    assert!(
        (share - along_y_um).abs() < 0.05 * along_y_um,
        "{share} um by the table, {along_y_um} um along y"
    );
    assert!(compliant.in_plane_um > arm.in_plane_um + 0.9 * along_y_um);
}

#[test]
fn errors_of_a_positioner_are_reported_at_their_positions() {
    let folder = cell("positioner-wrong", "", "");
    for (positioner_text, at, given) in [
        (
            positioner("[30]"),
            "joints_deg",
            "1 joint positions for the 2 joints",
        ),
        (
            positioner("[120, 0]"),
            "joints_deg",
            "tilt is 30.0 deg outside its range",
        ),
        (
            positioner("[0, 0]").replace("table.toml", "nothing.toml"),
            "robot",
            "nothing.toml",
        ),
    ] {
        let text = study("", "[1000, 0, 800]", "[0, -90, 0]", &positioner_text);
        let error = read("study.toml", &folder, text.as_bytes())
            .unwrap_err()
            .to_string();
        assert!(error.contains(given), "{error}");
        assert!(error.contains("study.toml:") && error.contains(at), "{error}");
    }
    // The frame is there only with a positioner.
    let text = study("base = \"table\"", "[0, 0, 0]", "[0, -90, 0]", "");
    let error = read("study.toml", &folder, text.as_bytes())
        .unwrap_err()
        .to_string();
    assert!(error.contains("no frame `table`"), "{error}");
}

/// A line above a part of 100 mm by 500 mm on the table, which is turned to this angle; 100 mm behind its axis is the
/// face of a low wall. Coordinates are relative to the table at home.
fn walled(turn: f64) -> String {
    format!(
        "format = 1\nrobot = \"yaskawa/mh12\"\ntolerance_um = 60\nbase = \"table\"\nleast_clearance_mm = 5\n\
         plane = {{ centre_mm = [0, 0, 200], rotation_deg = [0, 0, 0], half_size_mm = 50, step_mm = 50 }}\n\
         load = {{ cases_n = [[3, -5, 5]] }}\n\
         [[obstacle]]\nname = \"wall\"\nbox_mm = {{ from = [100, -400, 0], to = [120, 400, 40] }}\n\
         [part]\nbox_mm = {{ from = [-50, -250, -180], to = [50, 250, -140] }}\n\
         [posture]\nhome_deg = [{turn}, 0, 0, 0, 0, 0, 0, 0]\n\
         [[analysis]]\nkind = \"path\"\nname = \"line\"\nline = {{ from_mm = [-5, 0], to_mm = [5, 0] }}\nstep_mm = 5\n{}",
        positioner("[0, 0]")
    )
}

#[test]
fn obstacles_stand_in_the_cell_while_the_table_turns_the_part() {
    let folder = cell("positioner-walled", "", "");
    // By hand: the corner of the part at (50, -250) mm turns by the angle of the table.
    for turn in [0.0, 5.0, 10.0] {
        let (sin, cos) = f64::to_radians(turn).sin_cos();
        let expected = 100.0 - (50.0 * cos + 250.0 * sin);
        let path = answered(&folder, &walled(turn)).paths.remove(0);
        let least = path.least_clearance_mm.unwrap();
        assert!(
            (least - expected).abs() < 1e-3,
            "{turn} deg: {least} {expected} mm"
        );
        let mut nearest = path.nearest.unwrap();
        nearest.sort();
        assert_eq!(nearest, ["part", "wall"]);
    }
    let touching = answered(&folder, &walled(30.0)).paths.remove(0);
    assert_eq!(touching.in_collision, 3);
}

#[test]
fn the_floor_stays_where_it_is_below_a_table() {
    let folder = cell("positioner-floor", "", "");
    // A part of 400 mm by 400 mm that hangs down to 490 mm below the origin of the table, which is 500 mm above base_link.
    let at = |height: f64| {
        let text = format!(
            "least_clearance_mm = 1\n[floor]\nheight_mm = {height}\n\
             [part]\nbox_mm = {{ from = [-200, -200, -690], to = [200, 200, -180] }}\n{}",
            positioner("[0, 0]")
        );
        let study = study("base = \"table\"", "[0, 0, 200]", "[0, 0, 0]", "");
        answered(
            &folder,
            &(study.replace("half_size_mm = 100", "half_size_mm = 0") + &text),
        )
    };
    let map = &at(-520.0).maps[0];
    assert!(
        (map.least_clearance_mm.unwrap() - 30.0).abs() < 1e-3,
        "{:?}",
        map.least_clearance_mm
    );
    let mut nearest = map.nearest.clone().unwrap();
    nearest.sort();
    assert_eq!(nearest, ["floor", "part"]);
    assert_eq!(at(-480.0).maps[0].counts.in_collision, 1);
}

/// Centres of the circles of a picture: joints, and points of least distance, px.
fn circles(svg: &str) -> Vec<[f64; 2]> {
    let number = |text: &str, key: &str| -> f64 {
        let value = text.split(key).nth(1).unwrap();
        value.split('"').next().unwrap().parse().unwrap()
    };
    svg.split("<circle ")
        .skip(1)
        .map(|text| [number(text, "cx=\""), number(text, "cy=\"")])
        .collect()
}

#[test]
fn pictures_show_the_robot_as_it_stands_without_the_positioner() {
    let folder = cell("positioner-pictures", "0", "0");
    let pictures_of = |more: &str| -> Vec<(String, Vec<[f64; 2]>)> {
        let keys = "tool = { flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0], body = [{ cylinder_mm = { from = [0, 0, 10], to = [0, 0, 120], diameter = 90 } }] }";
        let cell = "[part]\nbox_mm = { from = [-150, -150, -60], to = [150, 150, -40] }\npart_from_body_mm_deg = [0, 0, 0, 5, 3, 0]\n[[obstacle]]\nname = \"wall\"\nbox_mm = { from = [1300, -400, 0], to = [1320, 400, 900] }\n[floor]\nheight_mm = -100\n";
        let text = study(keys, "[1000, 0, 800]", "[0, -30, 0]", &format!("{cell}{more}"));
        let text = text.replace("half_size_mm = 100", "half_size_mm = 0");
        let study = read("study.toml", &folder, text.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
        let done = run(&study, Watch::NONE).unwrap();
        let answer = answer(&study, &done);
        let results = StudyResults {
            study: &study,
            done: &done,
            answer: &answer,
        };
        let drawn = pictures(results).into_iter();
        let drawn = drawn.filter(|picture| picture.name == "map-arm" || picture.name == "map-clearance");
        drawn
            .map(|picture| (picture.name, circles(&picture.svg)))
            .collect()
    };
    let alone = pictures_of("");
    assert_eq!(alone.len(), 2);
    for joints in ["[0, 0]", "[35, 70]", "[-60, -110]"] {
        for ((name, alone), (_, both)) in alone.iter().zip(pictures_of(&positioner(joints))) {
            assert!(alone.len() >= 12, "{name}: {alone:?}");
            assert_eq!(alone.len(), both.len());
            for ([x, y], [other_x, other_y]) in alone.iter().zip(both) {
                // Printed to 0.01 px.
                let is_there = (x - other_x).abs() < 0.02 && (y - other_y).abs() < 0.02;
                assert!(is_there, "{name} at {joints}: {x} {y}, {other_x} {other_y} px");
            }
        }
    }
}

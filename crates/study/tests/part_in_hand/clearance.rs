//! Clearance with the part in the hand: the witness is the same robot with the part as its tool.

use std::fs;
use std::path::Path;

use armill_core::clearance::CellState;
use armill_core::watch::Watch;
use armill_study::answer::answer;
use armill_study::file::resolve::read;
use armill_study::pose::first_setting;
use armill_study::run::run;

use crate::{answered, hand, problems};

/// Spindle and cutter from the mount on, a post on the ground, the part from z = 60 to 250 mm in front of the flange.
const BODIES: &str = r#"
[[tool.body]]
name = "spindle"
cylinder_mm = { from = [0, 0, -300], to = [0, 0, 120], diameter = 120 }
[[tool.body]]
cuts = true
cylinder_mm = { from = [0, 0, 120], to = [0, 0, 200], diameter = 20 }
"#;
const POST: &str = r#"
[[obstacle]]
name = "post"
box_mm = { from = [1700, -100, 0], to = [1790, 100, 1150] }
"#;

/// The map of one point where the tip touches the part at (x, y, 250) mm of the flange.
fn hand_in_cell([x, y]: [i32; 2], more: &str) -> String {
    let part = format!(
        "[part]\nbox_mm = {{ from = [{}, {}, -190], to = [{}, {}, 0] }}\n",
        -100 - x,
        -80 - y,
        120 - x,
        90 - y
    );
    let study = hand(&format!("[{x}, {y}, 250]"), "");
    let study = study.replace("tolerance_um = 200", "tolerance_um = 200\nleast_clearance_mm = 5");
    let (before, load) = study.split_once("[load]").unwrap();
    format!("{before}{BODIES}[load]{load}{POST}{part}{more}")
}

#[test]
fn clearance_is_that_of_the_robot_with_the_part_as_its_tool() {
    let floor = |height: i32| format!("[floor]\nheight_mm = {height}\n");
    let mut nearest = Vec::new();
    for at in [[0, 0], [120, -40], [-60, 150], [-24, 0]] {
        let of_hand = answered(&hand_in_cell(at, &floor(-10)));
        let [x, y] = at;
        let with_tool = answered(&format!(
            r#"format = 1
robot = "kuka/kr210r2700extra"
tolerance_um = 200
least_clearance_mm = 5
plane = {{ centre_mm = [1800, 0, 1300], tilt_deg = 0, half_size_mm = 0, step_mm = 50 }}
load = {{ cases_n = [[-100, 60, 40]] }}
{POST}
[[obstacle]]
name = "spindle"
cylinder_mm = {{ from = [0, 0, -300], to = [0, 0, 120], diameter = 120 }}
base_from_obstacle_mm_deg = [2000, 0, 1300, 0, -90, 0]
{}
[tool]
flange_from_tool_mm_deg = [{x}, {y}, 250, 0, 0, 0]
[[tool.body]]
name = "part"
box_mm = {{ from = [-100, -80, 60], to = [120, 90, 250] }}
"#,
            floor(-10)
        ));
        let [hand, tool] = [&of_hand, &with_tool].map(|answer| &answer.maps[0]);
        assert_eq!(hand.counts.in_collision, tool.counts.in_collision);
        let [of_hand, of_tool] = [hand, tool].map(|map| map.least_clearance_mm.unwrap());
        // Joint positions are those of another chain, to 1e-12 rad.
        assert!((of_hand - of_tool).abs() < 1e-6, "{at:?}: {of_hand} {of_tool} mm");
        let names = |names: &Option<[String; 2]>| {
            let mut names = names.clone().unwrap();
            names.sort();
            names
        };
        assert_eq!(names(&hand.nearest), names(&tool.nearest), "{at:?}");
        nearest.push((
            names(&hand.nearest).join(" and "),
            of_hand,
            hand.counts.in_collision,
        ));
    }
    // By hand: x of the flange is down, so that the part ends 120 - x mm below the tip, which is at 1300 mm; the spindle ends 80 mm before it.
    assert_eq!(nearest[0].0, "part and post");
    assert!((nearest[0].1 - 30.0).abs() < 1e-6, "{nearest:?}");
    assert_eq!(nearest[1].0, "part and spindle");
    assert!((nearest[1].1 - 80.0).abs() < 1e-6, "{nearest:?}");
    assert_eq!((nearest[2].1, nearest[2].2), (0.0, 1));
    assert!((nearest[3].1 - 6.0).abs() < 1e-6, "{nearest:?}");
}

#[test]
fn a_part_that_comes_too_near_has_no_posture_and_a_search_avoids_it() {
    let path = |search: &str| {
        format!(
            "[[analysis]]\nkind = \"path\"\nname = \"line\"\nline = {{ from_mm = [-10, 0], to_mm = [10, 0] }}\nstep_mm = 5\n{search}"
        )
    };
    // The corner of the part is 20 mm too low, unless the part turns.
    let fixed = answered(&hand_in_cell([-50, 0], &path(""))).paths.remove(0);
    assert_eq!(fixed.in_collision, 5);
    let search = "posture.search = { step_deg = 15, turns_deg = [-180, 180] }\n";
    let turned = answered(&hand_in_cell([-50, 0], &path(search))).paths.remove(0);
    assert_eq!(turned.in_collision, 0);
    let least = turned.least_clearance_mm.unwrap();
    assert!(least >= 5.0, "{least} mm");
}

#[test]
fn problems_of_a_cell_with_the_part_in_the_hand_are_all_reported() {
    let obstacle =
        "[[obstacle]]\nname = \"gripper\"\non = \"A1\"\nbox_mm = { from = [0, 0, 0], to = [1, 1, 1] }\n";
    let found = problems(&hand_in_cell([0, 0], obstacle));
    assert!(
        found.contains("joint `A1` of robot") && found.contains("is a joint of the arm itself"),
        "{found}"
    );
    let floor = "[floor]\nheight_mm = 100\n";
    // The mount is inside the column of the robot.
    let inside = hand_in_cell([0, 0], floor).replace("[2000, 0, 1300, 0, -90, 0]", "[300, 0, 500, 0, 0, 0]");
    let found = problems(&inside);
    for expected in [
        "the floor at 100 mm is above the base of the robot, which is at 0 mm",
        "`spindle`, which stands in the cell, touches",
        "in every posture of the robot",
        "is base_from_mount_mm_deg right?",
    ] {
        assert!(found.contains(expected), "`{expected}` is not in:\n{found}");
    }
}

/// A closed box of 60 mm by 40 mm by 80 mm, ASCII STL in mm.
fn box_stl() -> String {
    let corner = |k: usize| {
        [
            60.0 * (k & 1) as f64,
            20.0 * (k & 2) as f64,
            20.0 * (k & 4) as f64,
        ]
    };
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let mut text = "solid box\n".to_owned();
    for [a, b, c, d] in faces {
        for triangle in [[a, b, c], [a, c, d]] {
            text += "facet normal 0 0 0\nouter loop\n";
            for [x, y, z] in triangle.map(corner) {
                text += &format!("vertex {x} {y} {z}\n");
            }
            text += "endloop\nendfacet\n";
        }
    }
    text + "endsolid box\n"
}

/// A folder with an MH12 whose links have a mesh each.
fn meshed_arm() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let urdf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../validation/urdf-forward/mh12.urdf");
    let mut urdf = fs::read_to_string(urdf).unwrap();
    for link in ["base_link", "s", "l", "u", "r", "b", "t"] {
        let mesh = "<collision><origin xyz=\"0.03 0.01 -0.05\" rpy=\"0.2 0 0.4\"/><geometry><mesh filename=\"box.stl\" scale=\"0.001 0.001 0.001\"/></geometry></collision>";
        let named = format!("<link name=\"{link}\"");
        urdf = urdf.replace(&format!("{named}/>"), &format!("{named}>{mesh}</link>"));
    }
    fs::write(folder.path().join("arm.urdf"), urdf).unwrap();
    fs::write(folder.path().join("box.stl"), box_stl()).unwrap();
    folder
}

const MESHED: &str =
    "format = 1\nrobot = \"arm.urdf\"\ntolerance_um = 200\ncompliance = { class = \"light\" }\n";
const LOAD: &str = "[load]\nframe = \"part\"\ncases_n = [[1, 2, 3]]\n";

#[test]
fn meshes_of_a_urdf_move_with_their_links() {
    let folder = meshed_arm();
    let common = format!(
        "{MESHED}[[obstacle]]\nname = \"wall\"\nbox_mm = {{ from = [-600, -900, 0], to = [-500, 900, 1200] }}\n[floor]\nheight_mm = -100\n"
    );
    let spindle = "cylinder_mm = { from = [0, 0, -300], to = [0, 0, 120], diameter = 120 }";
    let of_hand = format!(
        "{common}[part_in_hand]\nbase_from_mount_mm_deg = [900, 100, 700, 10, -80, 0]\n\
         [tool]\nflange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0]\nbody = [{{ name = \"spindle\", {spindle} }}]\n\
         [plane]\ncentre_mm = [0, 0, 150]\nrotation_deg = [0, 0, 0]\nhalf_size_mm = 0\nstep_mm = 50\n\
         [part]\nbox_mm = {{ from = [-100, -80, -90], to = [120, 90, 0] }}\n"
    );
    let with_tool = format!(
        "{common}[[obstacle]]\nname = \"spindle\"\n{spindle}\nbase_from_obstacle_mm_deg = [900, 100, 700, 10, -80, 0]\n\
         [tool]\nflange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0]\nbody = [{{ name = \"part\", box_mm = {{ from = [-100, -80, 60], to = [120, 90, 150] }} }}]\n\
         [plane]\ncentre_mm = [800, 0, 700]\ntilt_deg = 0\nhalf_size_mm = 0\nstep_mm = 50\n"
    );
    let [hand, tool] = [of_hand, with_tool].map(|text| {
        let text = format!("{text}{LOAD}");
        read("study.toml", folder.path(), text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
    });
    let mut states = [&hand, &tool].map(|study| {
        let setting = first_setting(study).unwrap();
        let cell = setting.cell.as_ref().unwrap();
        CellState::new(cell.placed(), &study.robot.robot, &setting.flange_from_tool)
    });
    let mut links = 0;
    for k in 0..400 {
        // Spread over the ranges of the joints.
        let q: Vec<f64> = (0..6)
            .map(|joint| {
                (f64::from(k) * [0.618, 0.755, 0.570, 0.857, 0.441, 0.329][joint]).fract() * 2.4 - 1.2
            })
            .collect();
        let back: Vec<f64> = q.iter().rev().copied().collect();
        states[0].set_joints(&back);
        states[1].set_joints(&q);
        let [of_hand, of_tool] = states.each_mut().map(|state| state.clearance(5.0).unwrap());
        let [distance, expected] = [of_hand, of_tool].map(|found| found.nearest.distance);
        assert!(
            (distance - expected).abs() < 1e-9,
            "{distance} {expected} m at {q:?}"
        );
        links += usize::from(of_hand.bodies[0] < 7);
    }
    assert!(links > 100, "{links}");
}

#[test]
fn a_part_that_the_wrist_is_inside_of_in_every_posture_is_refused() {
    let folder = meshed_arm();
    let text = |from: i32| {
        format!(
            "{MESHED}[part_in_hand]\nbase_from_mount_mm_deg = [900, 100, 700, 10, -80, 0]\n\
             [tool]\nflange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0]\n\
             [plane]\ncentre_mm = [0, 0, 150]\nrotation_deg = [0, 0, 0]\nhalf_size_mm = 0\nstep_mm = 50\n\
             [part]\nbox_mm = {{ from = [-150, -150, {from}], to = [150, 150, 0] }}\n{LOAD}"
        )
    };
    let read = |from: i32| read("study.toml", folder.path(), text(from).as_bytes());
    assert!(read(-90).is_ok());
    // The centre of the wrist is 250 mm behind the plane.
    let found = read(-400).unwrap_err().to_string();
    assert!(
        found.contains("the part in the hand touches b in every posture of the robot")
            && found.contains("study.toml:14:"),
        "{found}"
    );
}

/// A groove along the edge of a block in the hand, 30 mm deep, and what is left of the block when it is cut.
fn groove(least_mm: f64, bodies: &str, spin_deg: i32, posture: &str) -> armill_study::answer::PathAnswer {
    const GROOVE: &str = "G21 G90 G17\nS9000 M3\nG0 X38 Y-60 Z10\nG0 Z-30\nG1 Y60 F600\nG0 Z10\nM2\n";
    const CUT: &str = r#"
[cut]
material = "aluminium-6082-t6"
cutter = { diameter_mm = 20, flutes = 2 }
axial_depth_mm = 1
radial_depth_mm = 3
side = "down"
feed_mm_per_min = 600
spindle_rpm = 9000
stock = { from_mm = [-40, -40, -60], to_mm = [40, 40, 0] }
"#;
    let study = hand("[0, 0, 250]", "");
    let least = format!("tolerance_um = 200\nleast_clearance_mm = {least_mm}");
    let study = study.replace("tolerance_um = 200", &least);
    let (before, _) = study.split_once("[load]").unwrap();
    let analysis = format!(
        "[[analysis]]\nkind = \"path\"\nname = \"groove\"\n{posture}[analysis.program]\nfile = \"groove.ngc\"\nspin_deg = {spin_deg}\n"
    );
    let text = format!("{before}{BODIES}{bodies}{CUT}{analysis}");
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("groove.ngc"), GROOVE).unwrap();
    let study = read("study.toml", folder.path(), text.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    let answer = answer(&study, &run(&study, Watch::NONE).unwrap());
    answer.paths[0].clone()
}

#[test]
fn a_tool_that_stands_keeps_its_clearance_from_the_stock_in_the_hand() {
    // The spindle begins 80 mm behind the tip, which is 30 mm deep: 50 mm above the top of the block.
    let free = groove(45.0, "", 0, "");
    assert_eq!(free.nearest.clone().unwrap().join(" and "), "spindle and stock");
    assert_eq!((free.in_collision, free.unreachable), (0, 0));
    assert!(
        (free.least_clearance_mm.unwrap() - 50.0).abs() < 1e-3,
        "{:?}",
        free.least_clearance_mm
    );
    let near = groove(55.0, "", 0, "");
    assert!(near.in_collision > 80, "{}", near.in_collision);
    let missing = |path: &armill_study::answer::PathAnswer| {
        let values = path.obstacles.iter().filter(|found| found.kind == "collision");
        values.map(|found| found.value.unwrap()).fold(0.0, f64::max)
    };
    assert!((missing(&near) - 5.0).abs() < 1e-3, "{}", missing(&near));
}

#[test]
fn a_search_turns_the_stock_in_the_hand_away_from_a_tool_that_is_not_round() {
    // A nozzle next to the cutter, 30 mm from its axis, that ends 20 mm behind the tip: 10 mm below the top of the block.
    const NOZZLE: &str = "[[tool.body]]\nname = \"nozzle\"\ncylinder_mm = { from = [30, 0, 120], to = [30, 0, 180], diameter = 10 }\n";
    let fixed = [0, 180].map(|spin| groove(2.0, NOZZLE, spin, ""));
    let lost = fixed.map(|path| path.in_collision);
    assert!(lost[0].max(lost[1]) > 50, "{lost:?}");
    for spin in [0, 180] {
        let search = "posture.search = { step_deg = 15, turns_deg = [-180, 180] }\n";
        let found = groove(2.0, NOZZLE, spin, search);
        assert_eq!((found.in_collision, found.unreachable), (0, 0));
        assert!(found.least_clearance_mm.unwrap() >= 2.0);
    }
}

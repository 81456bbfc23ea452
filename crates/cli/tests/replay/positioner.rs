//! Programs of a part on a turntable or a two-axis positioner: each target on the table, and where the tool then is in front
//! of the robot.

use std::process::Output;

use crate::cells::{events, written};
use crate::event::{Action, Event, LinearMove};
use crate::pose::{Pose, distance};
use crate::replay::Language;

/// Turns about z at 400 mm above its root, against the right hand.
const TURNTABLE: &str = r#"format = 1
name = "Turntable"
[chain]
source = "made-up"
motions = [{ along = "z", length_mm = 400 }, { about = "z", joint = "turn" }, { along = "z", length_mm = 100 }]
[[joint]]
name = "turn"
sign = -1
limits_deg = [-360, 360]
max_speed_deg_per_s = 90
source = "made-up"
[sources.made-up]
what = "all"
where = "this test"
licence = "none needed"
"#;

/// Where the turntable stands, mm.
const ROOT: [f64; 6] = [2300.0, 150.0, 0.0, 0.0, 0.0, 20.0];
const RADIUS_MM: f64 = 900.0;

/// A ring about the axis of the table, 50 mm above it, too large for the arm on one side.
const RING: &str = "
plane = { centre_mm = [0, 0, 50], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }
base = \"table\"
[[analysis]]
kind = \"path\"
name = \"ring\"
load = { frame = \"feed\", cases_n = [[0, 0, 50]] }
circle = { radius_mm = 900 }
step_mm = 40
";

/// The study as a program `part` of this file name.
fn compensated(robot: &str, text: &str, program: &str) -> (tempfile::TempDir, Output) {
    let folder = tempfile::tempdir().unwrap();
    let study = format!(
        "format = 1\nrobot = \"{robot}\"\ntolerance_um = 500\n\
         tool = {{ flange_from_tool_mm_deg = [0, 0, 200, 0, 0, 0] }}\n{text}"
    );
    let assumed = match robot.starts_with("abb/") {
        true => "[compliance]\nclass = \"heavy\"\n",
        false => "",
    };
    std::fs::write(folder.path().join("study.toml"), study + assumed).unwrap();
    std::fs::write(folder.path().join("table.toml"), TURNTABLE).unwrap();
    let output = written(folder.path(), program, &["--feed-mm-per-min", "1200"]);
    (folder, output)
}

fn moving() -> String {
    format!(
        "{RING}[positioner]\nrobot = \"table.toml\"\nbase_from_root_mm_deg = {ROOT:?}\njoints_deg = [0]\n\
         [posture.search]\nstep_deg = 15\naxes = [{{ joint = \"turn\", step_deg = 5, range_deg = [-360, 360] }}]\n"
    )
}

fn linears(all: &[Event]) -> Vec<&LinearMove> {
    all.iter().filter_map(|event| event.action.linear()).collect()
}

#[test]
fn a_ring_is_milled_in_front_of_the_robot_while_the_table_turns() {
    for (language, robot, program, unit) in [
        (Language::Krl, "kuka/kr210r2700extra", "p/part.src", "2"),
        (Language::Rapid, "abb/irb6640-185-280", "p/part.mod", "STN1"),
    ] {
        let (folder, output) = compensated(robot, &moving(), program);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        let all = events(language, folder.path(), &output);
        let cut: Vec<&LinearMove> = linears(&all);
        assert!(cut.len() > 20, "{} moves", cut.len());
        let mut turned: Vec<f64> = Vec::new();
        for target in cut {
            assert_eq!(target.base.unit.as_deref(), Some(unit), "{said}");
            let table_from_tool = target.base.pose.unwrap().then(&target.to);
            let [x, y, z] = table_from_tool.position_mm;
            // Where it cuts it is on the ring.
            if (z - 50.0).abs() < 0.01 {
                assert!((x.hypot(y) - RADIUS_MM).abs() < 0.02, "{x} {y}");
            }
            // The table by hand: root, then the axis, which turns against the right hand.
            let turn = target.external.first().copied().flatten().unwrap();
            let [rx, ry, rz] = [ROOT[3], ROOT[4], ROOT[5] - turn];
            let base_from_table = Pose::fixed_xyz([ROOT[0], ROOT[1], ROOT[2] + 500.0, rx, ry, rz]);
            let tip = base_from_table.then(&table_from_tool).position_mm;
            // The far side of the ring is 3.2 m away.
            assert!(
                distance([0.0; 3], tip) < 2950.0,
                "{language:?}: {tip:?} at {turn} deg"
            );
            turned.push(turn);
        }
        let [least, most] = [f64::min, f64::max].map(|of| turned.iter().copied().reduce(of).unwrap());
        assert!(most - least > 90.0, "{least} to {most} deg");
    }
}

#[test]
fn a_table_that_stands_is_no_external_axis_and_said() {
    let text = format!(
        "{}[positioner]\nrobot = \"table.toml\"\nbase_from_root_mm_deg = {ROOT:?}\njoints_deg = [30]\n",
        RING.replace("radius_mm = 900", "radius_mm = 200")
    );
    let (folder, output) = compensated("kuka/kr210r2700extra", &text, "p/part.src");
    let all = events(Language::Krl, folder.path(), &output);
    let said =
        String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout);
    assert!(said.contains("must stand at turn 30"), "{said}");
    for target in linears(&all) {
        assert_eq!((&target.base.unit, target.external.len()), (&None, 0));
        let base = target.base.pose.unwrap();
        let expected = Pose::fixed_xyz([ROOT[0], ROOT[1], 550.0, 0.0, 0.0, ROOT[5] - 30.0]);
        // The frame of the path is that of the plane, whose z is up.
        assert!(
            distance(base.position_mm, expected.position_mm) < 0.01,
            "{base:?}"
        );
    }
}

#[test]
fn a_language_that_does_not_coordinate_refuses_a_moving_table() {
    let (_folder, output) = compensated("fanuc/r2000ic", &moving(), "p/part.ls");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("a positioner moves the part"), "{said}");
}

#[test]
fn a_name_that_no_mechanical_unit_has_is_refused() {
    for (robot, program, unit, rule) in [
        ("kuka/kr210r2700extra", "p/part.src", "DKP", "2 to 16"),
        ("abb/irb6640-185-280", "p/part.mod", "ST N", "letters, digits"),
    ] {
        let text = format!("{}[controller]\npositioner_unit = \"{unit}\"\n", moving());
        let (_folder, output) = compensated(robot, &text, program);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(
            said.contains(&format!("`{unit}`")) && said.contains(rule),
            "{said}"
        );
    }
}

/// Joint moves that begin and end the program carry the table too.
#[test]
fn joint_moves_carry_the_table() {
    let text = format!("{}[controller]\nhome_deg = [0, -100, 110, 0, 80, 0]\n", moving());
    let (folder, output) = compensated("kuka/kr210r2700extra", &text, "p/part.src");
    let all = events(Language::Krl, folder.path(), &output);
    let first = all.iter().find_map(|event| match &event.action {
        Action::Joint(joint) => Some(joint),
        _ => None,
    });
    // At home the table is where the study has it.
    assert_eq!(first.unwrap().external.first().copied().flatten(), Some(0.0));
}

//! Programs of cells: holes, a rail, stops without statements of the cell, data stored on the controller.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::event::{Action, Event, LinearMove};
use crate::replay::{Language, run, run_folder};

/// Holes of a study: end of each, mm, and direction out of the part.
const HOLES: [([f64; 3], [f64; 3]); 5] = [
    ([0.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
    ([60.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
    ([-60.0, 20.0, 0.0], [0.0, 0.3, 1.0]),
    ([60.0, 50.0, -2.0], [0.0, 0.0, 1.0]),
    ([0.0, 50.0, 0.0], [0.2, 0.0, 1.0]),
];
const DEPTH_MM: f64 = 9.0;
const CLEARANCE_MM: f64 = 3.0;
const PECK_MM: f64 = 4.0;

const DRILLED: &str = "
[[analysis]]
kind = \"holes\"
name = \"row\"
load = { frame = \"feed\", cases_n = [[0, 0, 150]] }
";

/// A study on this robot with this text, as the program `part`; its folder stays for the test.
fn compensated(robot: &str, text: &str, program: &str) -> (tempfile::TempDir, Output) {
    let folder = tempfile::tempdir().unwrap();
    let study = format!(
        "format = 1\nrobot = \"{robot}\"\ntolerance_um = 200\n\
         tool = {{ flange_from_tool_mm_deg = [0, 0, 200, 0, 0, 0] }}\n{text}"
    );
    std::fs::write(folder.path().join("study.toml"), study).unwrap();
    let output = written(
        folder.path(),
        program,
        &["--retract-mm", "30", "--feed-mm-per-min", "120"],
    );
    (folder, output)
}

/// Writes the nominal path of the study in this folder as a program.
pub fn written(folder: &Path, program: &str, more: &[&str]) -> Output {
    let to = ["--nominal", "--out", "out", "--program", program];
    Command::new(env!("CARGO_BIN_EXE_armill"))
        .current_dir(folder)
        .args(["compensate", "study.toml"])
        .args(to)
        .args(more)
        .output()
        .unwrap()
}

/// The events of the program that was written into the folder.
pub fn events(language: Language, folder: &Path, output: &Output) -> Vec<Event> {
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let at: PathBuf = folder.join("p");
    run_folder(language, &at, "part").unwrap_or_else(|error| panic!("{language:?}: {error}"))
}

fn holes() -> String {
    let list = |values: Vec<[f64; 3]>| format!("{values:?}");
    format!(
        "plane = {{ centre_mm = [1500, 0, 800], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }}\n{DRILLED}\
         holes = {{ at_mm = {}, normals = {}, depth_mm = {DEPTH_MM}, clearance_mm = {CLEARANCE_MM}, \
         peck_mm = {PECK_MM}, dwell_s = 0.25 }}\n",
        list(HOLES.map(|(at, _)| at).to_vec()),
        list(HOLES.map(|(_, out)| out).to_vec()),
    )
}

fn unit(of: [f64; 3]) -> [f64; 3] {
    let length = of.iter().map(|part| part * part).sum::<f64>().sqrt();
    of.map(|part| part / length)
}

/// Distance above the end of hole `index` along its axis, mm, if the move ends on that axis with the tool along it.
fn above(linear: &LinearMove, index: usize) -> Option<f64> {
    let (end, out) = HOLES[index];
    let out = unit(out);
    let to: [f64; 3] = std::array::from_fn(|axis| linear.to.position_mm[axis] - end[axis]);
    let height: f64 = (0..3).map(|axis| to[axis] * out[axis]).sum();
    let off: f64 = (0..3)
        .map(|axis| (to[axis] - height * out[axis]).powi(2))
        .sum::<f64>()
        .sqrt();
    let tool = linear.to.z_axis();
    let leans: f64 = (0..3)
        .map(|axis| (tool[axis] + out[axis]).powi(2))
        .sum::<f64>()
        .sqrt();
    (off < 0.003 && leans < 1e-4).then_some(height)
}

#[test]
fn every_hole_is_drilled_once_in_pecks_with_a_dwell_and_nothing_moves_across_below_the_clearance() {
    for (language, program) in [(Language::Krl, "p/part.src"), (Language::Rapid, "p/part.mod")] {
        let (folder, output) = compensated("fanuc/r2000ic", &holes(), program);
        let events = events(language, folder.path(), &output);
        let mut drilled = [0; HOLES.len()];
        let mut last: Option<(usize, f64)> = None;
        let mut depths: Vec<f64> = Vec::new();
        for event in &events {
            match &event.action {
                Action::Linear(linear) => {
                    let here = (0..HOLES.len()).find_map(|index| Some((index, above(linear, index)?)));
                    if let Some((index, height)) = here {
                        let moves_across = last.is_some_and(|(before, _)| before != index);
                        let lowest = last.map_or(height, |(_, before)| height.min(before));
                        assert!(!moves_across || lowest > 20.0, "{language:?}: {linear:?}");
                        if height < DEPTH_MM {
                            depths.push(height);
                        }
                        last = Some((index, height));
                    } else {
                        // Between holes: above the part.
                        assert!(linear.to.position_mm[2] > 20.0, "{language:?}: {linear:?}");
                    }
                }
                Action::Dwell { s } => {
                    let (index, height) = last.unwrap();
                    assert!(
                        (s - 0.25).abs() < 1e-9 && height.abs() < 0.003,
                        "{language:?}: {height}"
                    );
                    drilled[index] += 1;
                    // Pecks of 4 mm from the surface, each followed by a return to 0.5 mm above it.
                    let expected = [5.0, 5.5, 1.0, 1.5, 0.0];
                    assert_eq!(depths.len(), expected.len(), "{language:?}: {depths:?}");
                    for (found, expected) in depths.iter().zip(expected) {
                        assert!((found - expected).abs() < 0.003, "{language:?}: {depths:?}");
                    }
                    depths.clear();
                }
                _ => {}
            }
        }
        assert_eq!(drilled, [1; HOLES.len()], "{language:?}");
    }
}

#[test]
fn holes_without_depth_or_reach_are_refused_or_named() {
    let without = holes().replace(&format!("depth_mm = {DEPTH_MM}, "), "");
    let (_folder, output) = compensated("fanuc/r2000ic", &without, "p/part.src");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("the depth of the holes is not given"), "{said}");
    let far = holes().replace("[60.0, 50.0, -2.0]", "[3060.0, 50.0, -2.0]");
    let (folder, output) = compensated("fanuc/r2000ic", &far, "p/part.src");
    let all = events(Language::Krl, folder.path(), &output);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let expected = "1 of 5 holes cannot be drilled and are not in the program: 4";
    assert!(said.contains(expected), "{said}");
    let is_named =
        |event: &Event| matches!(&event.action, Action::Comment { text } if text.contains(expected));
    assert!(all.iter().any(is_named));
    let dwells = all
        .iter()
        .filter(|event| matches!(event.action, Action::Dwell { .. }));
    assert_eq!(dwells.count(), 4);
}

/// Joint positions of the FANUC with the tip at (1500, 0, 500) mm and the tool down, deg.
const LOW: [f64; 6] = [0.0, 9.43, -48.83, 0.0, -41.17, 180.0];

/// A line on a plane.
const LINE: &str = "plane = { centre_mm = [1500, 0, 800], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }
[load]
frame = \"feed\"
cases_n = [[-60, 40, 25]]
[[analysis]]
kind = \"path\"
name = \"line\"
line = { from_mm = [-50, 0], to_mm = [50, 0] }
step_mm = 5
";

#[test]
fn data_of_the_controller_are_selected_and_not_set_and_joint_moves_have_the_speed_of_the_cell() {
    let cell = "[controller]\nframe = 3\ntool = 4\ndata = \"controller\"\njoint_speed_percent = 25\n\
                frame_name = \"wobj_part\"\ntool_name = \"t_mill\"\nheader = [\"TPWrite \\\"begin\\\";\"]\n";
    let (folder, output) = compensated("fanuc/r2000ic", &format!("{LINE}{cell}"), "p/part.mod");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    let text = std::fs::read_to_string(folder.path().join("p/part.mod")).unwrap();
    // What the controller has stored.
    let stored = "MODULE CELL\nPERS tooldata t_mill:=[TRUE,[[0,0,200],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\n\
                  PERS wobjdata wobj_part:=[FALSE,TRUE,\"\",[[1500,0,800],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\nENDMODULE\n";
    let files = [("part.mod", text.clone()), ("cell.mod", stored.to_owned())];
    let all = run(Language::Rapid, &files, "part").unwrap();
    assert!(
        !text.contains("PERS tooldata") && !text.contains("PERS wobjdata"),
        "{text}"
    );
    let linear: Vec<&LinearMove> = all.iter().filter_map(|event| event.action.linear()).collect();
    assert!(linear.len() >= 3);
    for one in linear {
        assert_eq!(
            (one.base.name.as_str(), one.tool.name.as_str()),
            ("wobj_part", "t_mill")
        );
    }
    assert!(said.contains("t_mill must be [[0.000,0.000,200.000]"), "{said}");
    let begins = |event: &Event| matches!(&event.action, Action::Message { text } if text == "begin");
    assert!(all.iter().any(begins), "{all:?}");
}

#[test]
fn a_language_of_another_maker_is_questioned_and_a_cell_with_mistakes_is_refused() {
    let (_folder, output) = compensated("fanuc/r2000ic", LINE, "p/part.mod");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    assert!(
        said.contains("written in ABB RAPID, but controllers of FANUC"),
        "{said}"
    );
    let wrong = format!("{LINE}[controller]\nhome_deg = [0, 0]\nspindle_on = [\"A\\nB\"]\n");
    let (folder, output) = compensated("fanuc/r2000ic", &wrong, "p/part.ls");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    for part in [
        "`home_deg` has 2 values, but the robot has 6 joints",
        "a statement with a line break",
    ] {
        assert!(said.contains(part), "{said}");
    }
    assert!(!folder.path().join("p").exists());
}

#[test]
fn a_home_position_below_the_part_is_refused() {
    // The arm would come up through the part: its home is straight below it.
    let low = format!("{LINE}[controller]\nhome_deg = {LOW:?}\n");
    let (_folder, output) = compensated("fanuc/r2000ic", &low, "p/part.ls");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("below the top of the part"), "{said}");
}

/// A KR 210 of the library on a rail of 5 m along y.
fn kr210_on_rail() -> String {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let robot = std::fs::read_to_string(repository.join("robots/kuka/kr210r2700extra.toml")).unwrap();
    robot
        .replacen(
            "motions = [",
            "motions = [\n    { along = \"y\", joint = \"E1\" },",
            1,
        )
        .replacen(
            "[[joint]]",
            "[[joint]]\nname = \"E1\"\nsign = 1\nlimits_mm = [0, 5000]\nmax_speed_mm_per_s = 1000\nsource = \"rail\"\n\
             compliance_um_per_n = 0.001\ncompliance_source = \"rail\"\n\n[[joint]]",
            1,
        )
        + "\n[sources.rail]\nwhat = \"A rail for tests\"\nwhere = \"none\"\nlicence = \"none\"\n"
}

#[test]
fn a_rail_is_an_external_axis_of_kuka_and_refused_by_yaskawa() {
    let on_rail = kr210_on_rail();
    let text = LINE.replace("[1500, 0, 800]", "[1600, 1200, 900]")
        + "[controller]\nhome_deg = [1200, 0, -100, 110, 0, 80, 0]\n";
    let text = format!("[posture]\nhome_deg = [1200, 0, 0, 0, 0, 0, 0]\n{text}");
    let place = |text: &str| {
        // Tables follow the keys of the study.
        let (posture, rest) = text.split_once("plane").unwrap();
        format!("plane{rest}{posture}")
    };
    for (program, is_written) in [("p/part.src", true), ("p/part.jbi", false)] {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("arm.toml"), &on_rail).unwrap();
        let study = format!(
            "format = 1\nrobot = \"arm.toml\"\ntolerance_um = 200\n\
             tool = {{ flange_from_tool_mm_deg = [0, 0, 200, 0, 0, 0] }}\n{}",
            place(&text)
        );
        std::fs::write(folder.path().join("study.toml"), study).unwrap();
        let output = written(folder.path(), program, &["--feed-mm-per-min", "600"]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.success(), is_written, "{said}");
        if !is_written {
            assert!(said.contains("1 external axes, but Yaskawa INFORM"), "{said}");
            continue;
        }
        let all = events(Language::Krl, folder.path(), &output);
        let mut count = 0;
        for event in &all {
            let external = match &event.action {
                Action::Joint(joint) => &joint.external,
                Action::Linear(linear) => &linear.external,
                _ => continue,
            };
            assert_eq!(external.first().copied().flatten(), Some(1200.0), "{event:?}");
            count += 1;
        }
        assert!(count > 4);
    }
}

#[test]
fn a_rail_that_moves_along_the_path_is_in_the_program_at_every_point() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("arm.toml"), kr210_on_rail()).unwrap();
    let line = LINE
        .replace("[1500, 0, 800]", "[1600, 2000, 900]")
        .replace(
            "from_mm = [-50, 0], to_mm = [50, 0]",
            "from_mm = [-2000, 0], to_mm = [2000, 0]",
        )
        .replace("step_mm = 5\n", "step_mm = 40\n");
    let study = format!(
        "format = 1\nrobot = \"arm.toml\"\ntolerance_um = 500\n\
         tool = {{ flange_from_tool_mm_deg = [0, 0, 200, 0, 0, 0] }}\n\
         posture = {{ search = {{ step_deg = 30, axes = [{{ joint = \"E1\", step_mm = 100 }}] }} }}\n{line}\
         [controller]\nhome_deg = [1200, 0, -100, 110, 0, 80, 0]\n"
    );
    std::fs::write(folder.path().join("study.toml"), study).unwrap();
    let output = written(folder.path(), "p/part.src", &["--feed-mm-per-min", "600"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    let all = events(Language::Krl, folder.path(), &output);
    let of_cut = all.iter().filter_map(|event| match &event.action {
        Action::Linear(linear) => linear.external.first().copied().flatten(),
        _ => None,
    });
    let positions: Vec<f64> = of_cut.collect();
    let [least, greatest] = [f64::min, f64::max].map(|of| positions.iter().copied().reduce(of).unwrap());
    assert!(least >= 0.0 && greatest <= 5000.0, "{positions:?}");
    assert!(greatest - least > 500.0, "{positions:?}");
}

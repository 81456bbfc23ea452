//! Tool path programs in a study: the same numbers as shapes of the same form, features, forces from the cut, errors.
//!
//! `deviation`: under a load that is given; `cut`: under forces of the cut; `stock`: where the cutter meets it;
//! `turned`: turns of the tool that are searched for; `robot`: programs of robots; `holes`: those that a program
//! drills, and lists of them; `refused`: what is wrong.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

mod cut;
mod deviation;
mod holes;
mod refused;
mod robot;
mod stock;
mod turned;

use std::fs;

use armill_core::watch::Watch;
use armill_study::answer::{StudyAnswer, answer};
use armill_study::file::resolve::read;
use armill_study::run::run;

/// A horizontal plate in front of an MH12; analyses follow.
const CELL: &str = r#"format = 1
robot = "yaskawa/mh12"
tolerance_um = 60
plane = { centre_mm = [1000, 50, 500], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }
tool = { flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0] }
posture = { branch = "front elbow-up no-flip" }
"#;
/// Two cases in base axes.
const LOAD: &str = "load = { cases_n = [[3, -5, 5], [3, 5, 5]] }\n";
/// A cut of which one set of coefficients is known.
const CUT: &str = r#"
[cut]
material = "aluminium-6082-t6"
cutter = { diameter_mm = 10, flutes = 2 }
axial_depth_mm = 1
radial_depth_mm = 3
side = "down"
feed_mm_per_min = 600
spindle_rpm = 9000
"#;
/// A full circle of radius 40 mm about the zero, and a rapid to its start.
const RING: &str = "G21 G90 G17\nS9000 M3\nG0 X40 Y0 Z10\nG0 Z0\nG3 X40 Y0 I-40 J0 F600\nG0 Z10\nM2\n";

/// The result of a study with these files in its folder, or its problems as text.
fn reported(study: &str, files: &[(&str, &str)]) -> Result<StudyAnswer, String> {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    let study = read("study.toml", folder.path(), study.as_bytes()).map_err(|error| error.to_string())?;
    let found = run(&study, Watch::NONE).unwrap();
    Ok(answer(&study, &found))
}

/// A path analysis with this table of its program.
fn analysis(program: &str) -> String {
    format!("\n[[analysis]]\nkind = \"path\"\nname = \"part\"\n[analysis.program]\n{program}\n")
}

/// A slot out from the middle of a block, and a step-over back; the robot reaches all of it.
const STEP_OVER: &str =
    "G21 G90 G17\nS9000 M3\nG0 X-60 Y0 Z10\nG0 Z-1\nG1 X30 F600\nG1 Y3\nG1 X-60\nG0 Z10\nM2\n";
const STOCK: &str = "\nstock = { from_mm = [-40, -40, -20], to_mm = [40, 40, 0] }";

/// The path of the step-over under this cut.
fn of_cut(cut: &str) -> armill_study::answer::PathAnswer {
    let study = format!("{CELL}{cut}{}", analysis("file = \"step.ngc\""));
    reported(&study, &[("step.ngc", STEP_OVER)]).unwrap().paths[0].clone()
}

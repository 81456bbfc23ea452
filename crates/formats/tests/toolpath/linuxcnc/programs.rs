//! Its larger programs: read, or refused for the reason named.

use armill_formats::toolpath::gcode::{self, GcodeReadOptions, Rotaries};

use super::{bytes, linuxcnc, simulated};
use crate::samples_folder::files_below;

fn five_axes(file: &str) -> Option<Rotaries> {
    if file.contains("xyzac") {
        Some(Rotaries::table_ac())
    } else if file.contains("xyzbc") {
        Some(Rotaries::table_bc())
    } else {
        None
    }
}

/// Programs of the folders `nc_files`, `configs` and `tests/trajectory-planner` that are refused: the first problem.
const REFUSED: &[(&str, &str)] = &[
    ("nc_files/comp-g1.ngc", "p:27:1: diameter of tool 4 is not given"),
    ("nc_files/comp.ngc", "p:12:5: diameter of tool 1 is not given"),
    (
        "nc_files/daisy.ngc",
        "p:63:19: cut with A at 7.341617023617251 deg and no tool-centre control",
    ),
    (
        "nc_files/hole-circle.ngc",
        "p:10:18: ^ is not supported: polar words and spindle numbers are not understood",
    ),
    ("nc_files/mmount.ngc", "p:42:1: diameter of tool 4 is not given"),
    (
        "nc_files/nurbs/G5/butterfly-xy.ngc",
        "p:12:1: G5.2 is not supported: splines and NURBS are not expanded",
    ),
    (
        "nc_files/plasmac/imperial_circles.ngc",
        "p:13:1: parameter #<_hal[plasmac.cut-feed-rate]> was never set",
    ),
    (
        "nc_files/plasmac/metric_circles.ngc",
        "p:13:1: parameter #<_hal[plasmac.cut-feed-rate]> was never set",
    ),
    (
        "nc_files/polar.ngc",
        "p:10:1: ^ is not supported: polar words and spindle numbers are not understood",
    ),
    (
        "nc_files/spiral.ngc",
        "p:9:8: @ is not supported: polar words and spindle numbers are not understood",
    ),
    (
        "nc_files/systems.ngc",
        "p:15:1: G5.1 is not supported: splines and NURBS are not expanded",
    ),
    (
        "bridgemill/5axisgui.ngc",
        "p:18:27: word W is used by no code of this block",
    ),
    (
        "demos/xyzab-tdr-demo.ngc",
        "p:10:12: parameter #<_hal[xyzab_tdr_kins.x-rot-point]> was never set",
    ),
    (
        "demos/xyzac_switchkins.ngc",
        "p:2:1: subroutine xyzac_switchkins_sub is not known",
    ),
    (
        "demos/xyzac_switchkins_test_1.ngc",
        "p:7:1: cut with C at 90 deg and no tool-centre control",
    ),
    (
        "demos/xyzac_switchkins_test_3.ngc",
        "p:5:1: cut with C at 90 deg and no tool-centre control",
    ),
    (
        "demos/xyzbc_switchkins.ngc",
        "p:2:1: subroutine xyzbc_switchkins_sub is not known",
    ),
    (
        "demos/incremental_repetition.ngc",
        "p:1:1: G69 is not supported: tilted planes need the machine's kinematics",
    ),
    (
        "demos/incremental_repetition_back_and_forth.ngc",
        "p:1:1: G69 is not supported: tilted planes need the machine's kinematics",
    ),
    (
        "demos/incremental_repetition_g533.ngc",
        "p:1:1: G69 is not supported: tilted planes need the machine's kinematics",
    ),
    (
        "demos/simple_example.ngc",
        "p:1:1: G69 is not supported: tilted planes need the machine's kinematics",
    ),
];

/// Programs that contain only a subroutine.
const WITHOUT_CUTS: &[&str] = &[
    "ngcgui_lib/helix.ngc",
    "demos/circular_pocket.ngc",
    "demos/square.ngc",
];

#[test]
fn every_larger_program_is_read_or_refused_for_the_reason_named() {
    let Some(folder) = linuxcnc() else { return };
    let mut wrong = Vec::new();
    let mut read = 0;
    for part in ["nc_files", "configs", "tests/trajectory-planner"] {
        for file in files_below(&folder.join(part)) {
            let name = file.strip_prefix(&folder).unwrap().to_string_lossy().into_owned();
            if !name.ends_with(".ngc") {
                continue;
            }
            let expected = GcodeReadOptions {
                rotaries: five_axes(&name),
                ..simulated(None)
            };
            let outcome = gcode::read("p", bytes(&file).as_slice(), &expected, &mut |_| {});
            let known = REFUSED.iter().find(|(file, _)| name.ends_with(file));
            match (outcome, known) {
                (Ok(summary), None) => {
                    read += 1;
                    let none = WITHOUT_CUTS.iter().any(|file| name.ends_with(file));
                    if (summary.cuts == 0) != none {
                        wrong.push(format!("{name}: {} cuts", summary.cuts));
                    }
                }
                (Ok(_), Some((_, said))) => wrong.push(format!("{name}: read, not refused with `{said}`")),
                (Err(problems), known) => {
                    let first = problems.as_slice().first().unwrap().to_string();
                    if known.is_none_or(|(_, said)| first != *said) {
                        wrong.push(format!("    (\"{name}\", \"{first}\"),"));
                    }
                }
            }
        }
    }
    println!("{read} programs read");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

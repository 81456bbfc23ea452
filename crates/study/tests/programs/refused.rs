//! Errors in a program, a cut or a load are reported at their positions.

use std::fmt::Write;

use crate::{CELL, CUT, LOAD, RING, STOCK, analysis, reported};

#[test]
fn errors_are_reported_at_their_positions() {
    let ring = analysis("file = \"ring.ngc\"");
    let slow = CUT
        .replace("spindle_rpm = 9000", "")
        .replace("feed_mm_per_min = 600", "");
    let silent = "G21 G90\nG0 X0 Y0 Z0\nG1 X10 F100\nM2\n";
    for (study, program, words) in [
        (
            format!("{CELL}{LOAD}{}", analysis("file = \"none.ngc\"")),
            RING,
            &["cannot read", "none.ngc", "study.toml:"][..],
        ),
        (
            format!("{CELL}{LOAD}{ring}"),
            "G21\nG0 X1\nM2\n",
            &["no cutting move"],
        ),
        (
            format!("{CELL}{LOAD}{ring}"),
            "G21\nG1 X1 F100\nG99.5 X2\nM2\n",
            &["ring.ngc:3:1", "G99.5"],
        ),
        (
            format!("{CELL}{LOAD}{}", analysis("file = \"ring.ngc\"\nstep_mm = 0.001")),
            "G21\nG0 X0\nG1 X10000 F100\nM2\n",
            &["more than", "points"],
        ),
        (
            format!("{CELL}{LOAD}{}", analysis("file = \"ring.ngc\"\nstep_mm = 1e-30")),
            RING,
            &["step_mm` is 1e-30 mm: must be at least 0.001 mm"],
        ),
        (
            format!(
                "{CELL}{LOAD}{}",
                analysis(
                    "file = \"ring.ngc\"\nfeature = [{ name = \"a\", kind = \"line\", lines = [5, 2] }]"
                )
            ),
            RING,
            &["lines 5 to 2"],
        ),
        (
            format!(
                "{CELL}{LOAD}{}",
                analysis(
                    "file = \"ring.ngc\"\nfeature = [{ name = \"a\", kind = \"line\", lines = [8, 9] }]"
                )
            ),
            RING,
            &["`a`: lines 8 to 9 contain no cut", "lines 5 to 5"],
        ),
        (
            format!("{CELL}{LOAD}{}", analysis("file = \".\"")),
            RING,
            &["is a folder"],
        ),
        (
            format!("{CELL}{LOAD}{ring}"),
            "G21\nG1 X1\0\n",
            &["ring.ngc", "not text"],
        ),
        (format!("{CELL}{ring}"), RING, &["no `load`"]),
        (
            format!("{CELL}{slow}{ring}"),
            silent,
            &["line 3", "spindle speed", "cut.spindle_rpm"],
        ),
        (
            format!("{CELL}{}{ring}", CUT.replace("6082-t6", "6082")),
            RING,
            &[
                "no material is called `aluminium-6082`",
                "did you mean `aluminium-6082-t6`?",
            ],
        ),
        (
            format!(
                "{CELL}{}{ring}",
                CUT.replace("diameter_mm = 10", "diameter_mm = 0")
            ),
            RING,
            &["diameter"],
        ),
        (
            format!(
                "{CELL}{CUT}{}{ring}",
                STOCK.replace("[40, 40, 0]", "[40, -40, 0]")
            ),
            RING,
            &["study.toml:", "along y", "must be greater"],
        ),
        (
            format!(
                "{CELL}{}{ring}",
                CUT.replace("axial_depth_mm = 1", "axial_depth_mm = 0")
            ),
            RING,
            &["axial depth of 0 mm"],
        ),
        (
            format!("{CELL}{}{ring}", CUT.replace("radial_depth_mm = 3", "")),
            RING,
            &["radial_depth_mm"],
        ),
        (
            format!(
                "{CELL}{}{ring}",
                CUT.replace("radial_depth_mm = 3", "radial_depth_mm = 30")
            ),
            RING,
            &[
                "radial depth of cut is 30 mm: must be above 0 and at most 10 mm",
                "line 5",
            ],
        ),
        (
            format!(
                "{CELL}load = {{ frame = \"feed\", cases_n = [[1, 0, 0]] }}\n[[analysis]]\nkind = \"map\"\n"
            ),
            RING,
            &["which has no feed direction"],
        ),
    ] {
        let error = reported(&study, &[("ring.ngc", program)]).unwrap_err();
        let mut message = String::new();
        let _ = write!(message, "{error}");
        for word in words {
            assert!(message.contains(word), "no `{word}` in\n{message}");
        }
    }
}

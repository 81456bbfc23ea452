//! Mistakes in studies, programs and robots.

use super::Slip;
use crate::cell::{Cell, MH12_URDF};

/// A study without mistakes.
const STUDY: &str = r#"format = 1
robot = "yaskawa/mh12"
base = "base_link"
tolerance_um = 60
plane = { centre_mm = [1000, 0, 800], tilt_deg = 0, half_size_mm = 100, step_mm = 50 }
load = { cases_n = [[3, 5, 5]] }
tool = { flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0] }
"#;

/// A study with `from` replaced by `to`.
fn study(done: &'static str, [from, to]: [&'static str; 2], code: i32, said: &'static str) -> Slip {
    Slip {
        done,
        files: Box::new(move |cell| {
            assert!(STUDY.contains(from), "the study has no `{from}`");
            cell.file("study.toml", STUDY.replacen(from, to, 1));
        }),
        command: vec!["run", "study.toml", "--no-pictures"],
        code,
        said,
    }
}

/// Compliances, and more below them.
const COMPLIANCE: &str =
    "[compliance]\nsource = \"me\"\nrad_per_n_m = [2e-6, 2e-6, 2e-6, 2e-6, 2e-6, 2e-6]\n";

/// A study with more lines at its end.
fn with_more(done: &'static str, more: &'static str, code: i32, said: &'static str) -> Slip {
    Slip {
        files: Box::new(move |cell| {
            cell.file("study.toml", format!("{STUDY}{more}"));
        }),
        ..study(done, ["", ""], code, said)
    }
}

/// A program of a study.
fn program(done: &'static str, text: &'static str, code: i32, said: &'static str) -> Slip {
    Slip {
        files: Box::new(move |cell| {
            cell.file("part.nc", text);
            let analysis = "[[analysis]]\nkind = \"path\"\nprogram = { file = \"part.nc\" }\n";
            cell.file("study.toml", format!("{STUDY}{analysis}"));
        }),
        ..study(done, ["", ""], code, said)
    }
}

pub fn all() -> Vec<Slip> {
    let tilt = |to| ["tilt_deg = 0", to];
    let pose = "[0, 0, 150, 0, 0, 0]";
    vec![
        study(
            "`tilt_deg` in rad: 1.5708",
            tilt("tilt_deg = 1.5708"),
            0,
            "1.5708 is 90 deg in rad",
        ),
        study(
            "`tilt_deg` in rad: 0.7854",
            tilt("tilt_deg = 0.7854"),
            0,
            "0.7854 is 45 deg in rad",
        ),
        study(
            "`tilt_deg` in rad: 3.14",
            tilt("tilt_deg = 3.14"),
            0,
            "3.14 is 180 deg in rad",
        ),
        study(
            "`rotation_deg` of the plane in rad",
            tilt("rotation_deg = [0, 1.5708, 0]"),
            0,
            "The plane is rotated by only 1.5708 deg",
        ),
        study(
            "rotation of the tool in rad",
            [pose, "[0, 0, 150, 0, 1.5708, 0]"],
            0,
            "The tool is rotated by only 1.5708 deg",
        ),
        study(
            "centre of the plane in m",
            ["[1000, 0, 800]", "[1.0, 0, 0.8]"],
            0,
            "its centre is at (1, 0, 0.8) mm; is it in m?",
        ),
        study(
            "TCP in m",
            [pose, "[0, 0, 0.15, 0, 0, 0]"],
            0,
            "the TCP is 0.15 mm from the flange; is it in m?",
        ),
        study("TCP in um", [pose, "[0, 0, 150000, 0, 0, 0]"], 0, "is it in um?"),
        study(
            "no `base`, and a controller with another frame",
            ["base = \"base_link\"\n", ""],
            0,
            "The part may be 450 mm off: the study names no `base`",
        ),
        study(
            "20 kN on an arm for 12 kg",
            ["[3, 5, 5]", "[0, 0, 20000]"],
            0,
            "20000 N is more than the weight of its payload, 12 kg or 118 N",
        ),
        study(
            "a force of 1e9 N",
            ["[3, 5, 5]", "[0, 0, 1e9]"],
            2,
            "must be at most 1000000 N",
        ),
        study(
            "three numbers for the pose of the tool",
            [pose, "[0, 0, 150]"],
            2,
            "add the rotations in deg: `[0, 0, 150, 0, 0, 0]`",
        ),
        study(
            "a decimal comma",
            ["= 60", "= 60,5"],
            2,
            "write decimals with a point: `60.5`",
        ),
        study(
            "a decimal comma in a table",
            tilt("tilt_deg = 0,1"),
            2,
            "write decimals with a point: `0.1`",
        ),
        study(
            "a number in quotes",
            ["= 60", "= \"60\""],
            2,
            "write the number without quotes: `60`",
        ),
        study(
            "a name without its unit",
            ["tilt_deg = 0", "tilt = 0"],
            2,
            "angles carry their unit: write `tilt_deg`",
        ),
        study(
            "a name with another unit",
            ["tilt_deg = 0", "tilt_rad = 0"],
            2,
            "give the value in deg: write `tilt_deg`",
        ),
        study(
            "a typing error in a name",
            ["half_size_mm", "half_sise_mm"],
            2,
            "did you mean `half_size_mm`?",
        ),
        study(
            "a name of an earlier version",
            ["tolerance_um", "limit_um"],
            2,
            "`limit_um` was renamed: write `tolerance_um`",
        ),
        study(
            "two of three components of a force",
            ["[3, 5, 5]", "[3, 5]"],
            2,
            "expected an array of 3 numbers",
        ),
        study(
            "a negative step",
            ["step_mm = 50", "step_mm = -50"],
            2,
            "step_mm` is -50 mm: must be",
        ),
        with_more(
            "one number for `home_deg`",
            "posture = { home_deg = 3 }\n",
            2,
            "write a list: `[3]`",
        ),
        study(
            "a frame that the robot does not have",
            ["\"base_link\"", "\"table\""],
            2,
            "has no frame `table`",
        ),
        with_more(
            "a stiffness in place of a compliance",
            "[compliance]\nsource = \"me\"\nstiffness_n_m_per_rad = [1e6, 1e6, 1e6, 1e6, 1e6, 1e6]\n",
            2,
            "a compliance is 1/stiffness: write `rad_per_n_m` with 1/k",
        ),
        with_more(
            "a stiffness under the name of a compliance",
            "[compliance]\nsource = \"me\"\nrad_per_n_m = [1e6, 1e6, 1e6, 1e6, 1e6, 1e6]\n",
            2,
            "is 1e6 rad/(N m): must be at most 1 rad/(N m)",
        ),
        with_more(
            "compliances of five of six joints",
            "[compliance]\nsource = \"me\"\nrad_per_n_m = [2e-6, 2e-6, 2e-6, 2e-6, 2e-6]\n",
            2,
            "5 values for the 6 joints of the robot",
        ),
        with_more(
            "compliances without their uncertainty",
            COMPLIANCE,
            0,
            "The uncertainty of the deviations is not known, and no probability is reported",
        ),
        with_more(
            "thermal growth without its uncertainty",
            "[thermal]\ndifference_k = 8\n",
            0,
            "The standard uncertainties are lower bounds",
        ),
        Slip {
            command: vec![
                "place",
                "study.toml",
                "--rank-by",
                "plus-two-sigma",
                "--x-mm",
                "900,1100",
            ],
            ..with_more(
                "placements ranked by an uncertainty that is not known",
                "[compliance]\nsource = \"me\"\nrad_per_n_m = [2e-6, 2e-6, 2e-6, 2e-6, 2e-6, 2e-6]\n[[analysis]]\nkind = \"path\"\ncircle = { radius_mm = 50 }\n",
                2,
                "requires the uncertainty of the compliances, which is not known",
            )
        },
        program(
            "a decimal comma in G-code",
            "G21 G90\nG0 X10,5 Y0 Z5\n",
            2,
            "write decimals with a point, such as X10.5",
        ),
        with_more(
            "a program that does not exist",
            "[[analysis]]\nkind = \"path\"\nprogram = { file = \"other.nc\" }\n",
            2,
            "other.nc",
        ),
    ]
}

/// A command on a robot, with the MH12 as a URDF next to it.
fn robot(done: &'static str, command: &[&'static str], code: i32, said: &'static str) -> Slip {
    Slip {
        done,
        files: Box::new(|cell: &Cell| {
            cell.file("arm.urdf", MH12_URDF);
            cell.file("arm.toml", "mine");
        }),
        command: command.to_vec(),
        code,
        said,
    }
}

/// A pose of the MH12 at `10,20,-30,40,50,60` with another sign of S and another flange.
const OTHER_SIGN: &str = "-10,20,-30,40,50,60 = 991.88,224.90,653.74,96.64,-5.38,129.09";

pub fn of_robots() -> Vec<Slip> {
    let joints = ["--joints-deg", "0,0,0,0,0,0"];
    let pose = |done, name, said| robot(done, &["pose", name, joints[0], joints[1]], 2, said);
    vec![
        pose(
            "a robot by its type: `KUKA KR 120`",
            "KUKA KR 120",
            "did you mean `kuka/kr120r2500pro`?",
        ),
        pose(
            "a robot by its type: `mh-12`",
            "mh-12",
            "did you mean `yaskawa/mh12`?",
        ),
        pose(
            "a robot by its type: `ABB IRB 6640`",
            "ABB IRB 6640",
            "did you mean `abb/irb6640-185-280`?",
        ),
        robot(
            "three of six joint positions",
            &["pose", "yaskawa/mh12", "--joints-deg", "0,0,0"],
            2,
            "3 joint positions for the 6 joints of `yaskawa/mh12`",
        ),
        robot(
            "a joint that is positive the other way on the pendant (`robots check`)",
            &[
                "robots",
                "check",
                "arm.urdf",
                "--convention",
                "yaskawa",
                "--pose",
                OTHER_SIGN,
            ],
            1,
            "joint S has the opposite sign",
        ),
        robot(
            "a robot file that exists as the output of `robots import`",
            &["robots", "import", "arm.urdf", "--out", "arm.toml"],
            2,
            "the file exists; choose another place, or replace with --force",
        ),
    ]
}

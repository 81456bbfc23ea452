//! Mistakes in measurements: load tests, poses, circular tests, force records.

use std::fmt::Write;

use armill_core::nalgebra::{Point3, Vector3};
use armill_core::robot::forward::forward;
use armill_core::units::{from_deg, to_mm};
use armill_study::robots;

use super::Slip;
use crate::cell::Cell;

/// Rows of a table, changed by `change`: names of columns and numbers.
type Change = fn(&mut Row);

/// A row: cells by name.
pub struct Row {
    index: usize,
    cells: Vec<(String, f64)>,
}

impl Row {
    fn cell(&mut self, name: &str) -> &mut f64 {
        let found = self.cells.iter_mut().find(|(own, _)| own == name);
        &mut found.unwrap_or_else(|| panic!("no column `{name}`")).1
    }

    fn negate(&mut self, names: &[&str]) {
        for name in names {
            *self.cell(name) *= -1.0;
        }
    }

    fn swap(&mut self, a: &str, b: &str) {
        let (of_a, of_b) = (*self.cell(a), *self.cell(b));
        (*self.cell(a), *self.cell(b)) = (of_b, of_a);
    }

    fn scale(&mut self, names: &[&str], by: f64) {
        for name in names {
            *self.cell(name) *= by;
        }
    }
}

fn csv(rows: &[Row]) -> String {
    let mut text = String::new();
    for (k, row) in rows.iter().enumerate() {
        if k == 0 {
            let names: Vec<&str> = row.cells.iter().map(|(name, _)| name.as_str()).collect();
            let _ = writeln!(text, "{}", names.join(","));
        }
        let numbers: Vec<String> = row.cells.iter().map(|(_, number)| number.to_string()).collect();
        let _ = writeln!(text, "{}", numbers.join(","));
    }
    text
}

const DISPLACEMENT: [&str; 3] = ["dx_mm", "dy_mm", "dz_mm"];
const FORCE: [&str; 3] = ["fx_n", "fy_n", "fz_n"];
const POINT: [&str; 3] = ["x_mm", "y_mm", "z_mm"];

/// A filled-in plan of load tests of the MH12, changed.
fn tested(cell: &Cell, change: Change) {
    let plan = [
        "identify",
        "--plan",
        "14",
        "--robot",
        "yaskawa/mh12",
        "--tool-mm",
        "0,60,150",
        "--unknowns",
        "drives",
    ];
    let plan = cell.armill(&plan).fine().out;
    let mut lines = plan.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let names = lines.next().unwrap();
    let rows: Vec<Row> = lines
        .enumerate()
        .map(|(index, cells)| {
            let at = |name: &str| names.iter().position(|own| *own == name).unwrap();
            let number = |name: &str| cells[at(name)].parse::<f64>().unwrap();
            let cell = |name: &&str| match name.strip_prefix('d') {
                Some(_) if name.ends_with("_mm") => ((*name).to_owned(), number(&format!("expected_{name}"))),
                _ => ((*name).to_owned(), number(name)),
            };
            let kept = names.iter().filter(|name| !name.starts_with("expected"));
            let mut row = Row {
                index,
                cells: kept.map(cell).collect(),
            };
            change(&mut row);
            row
        })
        .collect();
    cell.file("tests.csv", csv(&rows));
}

const IDENTIFY: [&str; 10] = [
    "identify",
    "tests.csv",
    "--robot",
    "yaskawa/mh12",
    "--tool-mm",
    "0,60,150",
    "--unknowns",
    "drives",
    "--out",
    "mine.toml",
];

fn load_test(done: &'static str, change: Change, said: &'static str) -> Slip {
    Slip {
        done,
        files: Box::new(move |cell| tested(cell, change)),
        command: IDENTIFY.to_vec(),
        code: 2,
        said,
    }
}

pub fn load_tests() -> Vec<Slip> {
    let mut slips = vec![
        load_test(
            "forces of the opposite sign",
            |row| row.negate(&FORCE),
            "the displacement is against the force in 14 of 14 tests",
        ),
        load_test(
            "displacements of the opposite sign",
            |row| row.negate(&DISPLACEMENT),
            "with forces (or displacements) of the opposite sign the residual is",
        ),
        load_test(
            "x of the displacement negated",
            |row| row.negate(&["dx_mm"]),
            "with x negated in the displacements the residual is",
        ),
        load_test(
            "y of the displacement negated",
            |row| row.negate(&["dy_mm"]),
            "with y negated in the displacements the residual is",
        ),
        load_test(
            "z of the displacement negated",
            |row| row.negate(&["dz_mm"]),
            "with z negated in the displacements the residual is",
        ),
        load_test(
            "z of the force negated",
            |row| row.negate(&["fz_n"]),
            "with z negated in the forces the residual is",
        ),
        load_test(
            "columns x and y of the displacement exchanged",
            |row| row.swap("dx_mm", "dy_mm"),
            "with x and y exchanged in the displacements the residual is",
        ),
        load_test(
            "columns x and z of the displacement exchanged",
            |row| row.swap("dx_mm", "dz_mm"),
            "with x and z exchanged in the displacements the residual is",
        ),
        load_test(
            "columns x and y of the force exchanged",
            |row| row.swap("fx_n", "fy_n"),
            "with x and y exchanged in the forces the residual is",
        ),
        load_test(
            "columns of two joints exchanged",
            |row| row.swap("L_deg", "U_deg"),
            "with joints L and U exchanged the residual is",
        ),
        load_test(
            "a wrong zero of a joint",
            |row| *row.cell("U_deg") += 90.0,
            "is outside its limits -85.0 to 150.0 deg",
        ),
        load_test(
            "one gross outlier",
            |row| {
                if row.index == 4 {
                    row.scale(&DISPLACEMENT, 30.0);
                }
            },
            "with test 5 left out the residual is",
        ),
        load_test(
            "displacements in um under `dx_mm`",
            |row| row.scale(&DISPLACEMENT, 1e3),
            "are readings in micrometres called mm",
        ),
        load_test(
            "displacements in m under `dx_mm`",
            |row| row.scale(&DISPLACEMENT, 1e-3),
            "or in metres called mm?",
        ),
        load_test(
            "joint positions in rad under `_deg`",
            |row| {
                row.scale(
                    &["S_deg", "L_deg", "U_deg", "R_deg", "B_deg", "T_deg"],
                    1f64.to_radians(),
                );
            },
            "if the values are radians, name the columns `..._rad`",
        ),
        load_test("no reading in any row", |_| (), "the file exists"),
    ];
    let last = slips.len() - 1;
    slips[last] = Slip {
        done: "a robot file that exists as the output of `identify`",
        files: Box::new(|cell| {
            tested(cell, |_| ());
            cell.file("mine.toml", "# mine\n");
        }),
        ..load_test(
            "",
            |_| (),
            "the file exists; choose another place, or replace with --force",
        )
    };
    slips.push(Slip {
        done: "a plan with more than the payload: 500 N for 12 kg",
        files: Box::new(|_| ()),
        command: vec![
            "identify",
            "--plan",
            "14",
            "--robot",
            "yaskawa/mh12",
            "--pull-n",
            "500",
        ],
        code: 2,
        said: "500 N is more than the weight of the payload, 118 N",
    });
    slips
}

/// Poses of an MH12 measured by a tracker, changed.
fn measured(cell: &Cell, change: Change) {
    let found = robots::find("yaskawa/mh12", ".".as_ref()).unwrap();
    let names: Vec<String> = found
        .robot
        .joints()
        .iter()
        .map(|joint| format!("{}_deg", joint.name))
        .collect();
    let row = |index: usize| {
        let deg: Vec<f64> = (0..6)
            .map(|j| ((index * 7 + j * 5) % 13) as f64 * 9.0 - 50.0)
            .collect();
        let q: Vec<f64> = deg.iter().map(|deg| from_deg(*deg)).collect();
        let point = forward(&found.robot, &q).base_from_flange * Point3::new(0.03, 0.02, 0.1);
        // The tracker is elsewhere, and reads to a few hundredths of a millimetre.
        let noise = |k: usize| ((index * 3 + k * 5) % 7) as f64 * 1e-5;
        let at = Vector3::from_fn(|k, _| to_mm([point.y + 2.0, -point.x + 1.0, point.z - 0.5][k] + noise(k)));
        let joints = names.iter().cloned().zip(deg);
        let mut row = Row {
            index,
            cells: joints
                .chain(
                    POINT
                        .iter()
                        .map(|name| (*name).to_owned())
                        .zip(at.iter().copied()),
                )
                .collect(),
        };
        change(&mut row);
        row
    };
    let rows: Vec<Row> = (0..40).map(row).collect();
    cell.file("poses.csv", csv(&rows));
}

const CALIBRATE: [&str; 6] = [
    "calibrate",
    "poses.csv",
    "--robot",
    "yaskawa/mh12",
    "--out",
    "mine.toml",
];
const ACCURACY: [&str; 4] = ["pose-accuracy", "poses.csv", "--robot", "yaskawa/mh12"];

fn pose(done: &'static str, change: Change, said: &'static str) -> Slip {
    Slip {
        done,
        files: Box::new(move |cell| measured(cell, change)),
        command: CALIBRATE.to_vec(),
        code: 2,
        said,
    }
}

pub fn poses() -> Vec<Slip> {
    let mirrored = "with measured points mirrored (one of x, y, z negated, or two columns exchanged)";
    let gross: Change = |row| {
        if row.index == 12 {
            *row.cell("x_mm") += 50.0;
        }
    };
    let accuracy = |slip: Slip, done, code| Slip {
        done,
        command: ACCURACY.to_vec(),
        code,
        ..slip
    };
    vec![
        pose("z of the tracker negated", |row| row.negate(&["z_mm"]), mirrored),
        pose(
            "columns x and y of the tracker exchanged",
            |row| row.swap("x_mm", "y_mm"),
            mirrored,
        ),
        pose(
            "positions in m under `x_mm`",
            |row| row.scale(&POINT, 1e-3),
            "with positions in m, not in mm",
        ),
        pose(
            "positions in um under `x_mm`",
            |row| row.scale(&POINT, 1e3),
            "with positions in um, not in mm",
        ),
        pose(
            "positions in inches under `x_mm`",
            |row| row.scale(&POINT, 1.0 / 25.4),
            "with positions in inches, not in mm",
        ),
        pose(
            "a joint that is positive the other way",
            |row| row.negate(&["U_deg"]),
            "with joint U negated the residual is",
        ),
        pose(
            "another zero of a joint",
            |row| *row.cell("L_deg") -= 90.0,
            "with 90 deg added to joint L the residual is",
        ),
        pose(
            "columns of two joints exchanged",
            |row| row.swap("L_deg", "U_deg"),
            "with joints L and U exchanged the residual is",
        ),
        pose(
            "one pose 50 mm off",
            gross,
            "with line 14 left out the residual is",
        ),
        Slip {
            files: Box::new(|cell| {
                measured(cell, |_| ());
                cell.file("mine.toml", "# mine\n");
            }),
            ..pose(
                "a robot file that exists as the output of `calibrate`",
                |_| (),
                "the file exists; choose another place, or replace with --force",
            )
        },
        accuracy(
            pose("", gross, "with line 14 left out the residual is"),
            "one pose 50 mm off (`pose-accuracy`)",
            0,
        ),
        accuracy(
            pose(
                "",
                |row| row.negate(&["R_deg"]),
                "with joint R negated the residual is",
            ),
            "a joint that is positive the other way (`pose-accuracy`)",
            0,
        ),
    ]
}

/// A cell whose arm has backlash, with two circles that were measured with these keys in their tables.
fn with_circles(cell: &Cell, [flat, upright]: [&str; 2]) {
    let arm = include_str!("../../../../../robots/yaskawa/mh12.toml");
    let mut arm = arm.to_owned();
    for joint in ["S", "L", "U"] {
        let head = format!("name = \"{joint}\"\n");
        assert!(arm.contains(&head));
        arm = arm.replacen(
            &head,
            &format!("{head}backlash_deg = 0.01\nbacklash_source = \"paper\"\n"),
            1,
        );
    }
    cell.file("arm.toml", arm);
    let study = r#"format = 1
robot = "arm.toml"
tolerance_um = 200
plane = { centre_mm = [850, 250, 450], tilt_deg = 90, half_size_mm = 150, step_mm = 75 }
tool = { flange_from_tool_mm_deg = [30, -20, 150, 0, 0, 0] }
load = { cases_n = [[0, 0, 0]] }
posture.branch = "front elbow-up"
[[analysis]]
kind = "path"
name = "flat"
circle = { radius_mm = 100 }
[[analysis]]
kind = "path"
name = "upright"
plane = { centre_mm = [750, -350, 750], tilt_deg = 0 }
circle = { radius_mm = 100 }
"#;
    cell.file("study.toml", study);
    cell.armill(&["backlash", "study.toml", "--simulate", "runs", "--noise-um", "1"])
        .fine();
    let table = |name: &str, how: &str| {
        format!("[[ballbar]]\nanalysis = \"{name}\"\nfiles = [\"runs/{name}.csv\"]\n{how}\n")
    };
    cell.file(
        "study.toml",
        format!("{study}{}{}", table("flat", flat), table("upright", upright)),
    );
}

fn circle(done: &'static str, how: [&'static str; 2], said: &'static str) -> Slip {
    Slip {
        done,
        files: Box::new(move |cell| with_circles(cell, how)),
        command: vec!["backlash", "study.toml"],
        code: 0,
        said,
    }
}

pub fn circles() -> Vec<Slip> {
    vec![
        circle(
            "another zero of the angles: 90 deg",
            ["zero_deg = 90"; 2],
            "with zero_deg changed by -90 deg the residual is",
        ),
        circle(
            "another zero of the angles: 180 deg",
            ["zero_deg = 180"; 2],
            "with zero_deg changed by 180 deg the residual is",
        ),
        circle(
            "mirrored angles",
            ["mirrored = true"; 2],
            "with the angles mirrored (mirrored = true or false) the residual is",
        ),
        circle(
            "another zero of the angles of one of two circles: 90 deg",
            ["", "zero_deg = 90"],
            "with zero_deg changed by -90 deg of circle upright the residual is",
        ),
        circle(
            "mirrored angles of one of two circles",
            ["mirrored = true", ""],
            "with the angles mirrored (mirrored = true or false) of circle flat the residual is",
        ),
    ]
}

/// A record with forces (N) of `of` at each of 2000 samples, under these names of the columns.
fn record(of: fn(usize) -> [f64; 3]) -> impl Fn(&Cell) {
    move |cell| {
        let mut text = "time_s,fx_n,fy_n,fz_n\n".to_owned();
        for k in 0..2000 {
            let [x, y, z] = of(k);
            let _ = writeln!(text, "{:.4},{x},{y},{z}", k as f64 * 1e-3);
        }
        cell.file("r.csv", text);
    }
}

fn cut(k: usize) -> [f64; 3] {
    let phase = k as f64 * 0.31;
    let on = f64::from(u8::from((500..1500).contains(&k)));
    [
        on * (100.0 + 40.0 * phase.sin()),
        on * 60.0 * phase.cos(),
        on * (20.0 + 5.0 * phase.sin()),
    ]
}

fn force(done: &'static str, of: fn(usize) -> [f64; 3], said: &'static str) -> Slip {
    Slip {
        done,
        files: Box::new(record(of)),
        command: vec!["forces", "r.csv", "--no-drift"],
        code: 0,
        said,
    }
}

pub fn forces() -> Vec<Slip> {
    vec![
        force(
            "forces in kN under `fx_n`",
            |k| cut(k).map(|f| f * 1e-3),
            "are they in kN?",
        ),
        force(
            "forces in mN under `fx_n`",
            |k| cut(k).map(|f| f * 1e3),
            "are they in mN",
        ),
        force(
            "a column read twice",
            |k| [cut(k)[0], cut(k)[0], cut(k)[2]],
            "fx and fy hold the same numbers",
        ),
        force(
            "a channel that is not connected",
            |k| [cut(k)[0], 0.0, cut(k)[2]],
            "fy is 0.000 N in every sample",
        ),
        force(
            "one gross outlier",
            |k| if k == 700 { [9e3, 0.0, 0.0] } else { cut(k) },
            "that of one sample at 0.700000 s",
        ),
        force("an amplifier that is off", |_| [0.0; 3], "All forces are 0 N"),
    ]
}

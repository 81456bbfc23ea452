//! The loop of the shop with files only: a path is compensated, cut by an arm whose true lengths, compliances and backlash are hidden from it, the
//! part is measured, the journal writes the arm, and the next program is compensated with it.

use std::fmt::Write;

use armill_core::nalgebra::{DMatrix, Matrix3, Vector3};

use crate::cell::Cell;

const KNOWN: &str = include_str!("../../../../robots/yaskawa/mh12.toml");

/// What is wrong of the robot file: in it, in truth.
const TRUTH: &[[&str; 2]] = &[
    ["length_mm = 155,", "length_mm = 155.2,"],
    ["length_mm = 614,", "length_mm = 614.35,"],
    ["length_mm = 640,", "length_mm = 639.7,"],
    [
        "{ about = \"y\", joint = \"B\"",
        "{ about = \"y\", angle_deg = 0.03 },\n  { about = \"y\", joint = \"B\"",
    ],
    ["rad_per_n_m = 2.1e-6", "rad_per_n_m = 3.0e-6"],
    ["rad_per_n_m = 2.5e-6", "rad_per_n_m = 2.1e-6"],
    ["rad_per_n_m = 4.0e-5", "rad_per_n_m = 5.5e-5"],
    [
        "name = \"S\"\nsign",
        "name = \"S\"\nbacklash_deg = 0.012\nbacklash_side = \"motion\"\nbacklash_source = \"paper\"\nsign",
    ],
    [
        "name = \"L\"\nsign",
        "name = \"L\"\nbacklash_deg = 0.008\nbacklash_side = \"motion\"\nbacklash_source = \"paper\"\nsign",
    ],
];

const STUDY: &str = "format = 1
title = \"ring\"
robot = \"known.toml\"
ARM
tolerance_um = 100

[tool]
flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0]

[plane]
centre_mm = [1000, 0, 800]
tilt_deg = 90
half_size_mm = 200
step_mm = 20

[load]
cases_n = [[-120, 90, 60]]
source = \"assumed\"

[posture]
branch = \"front elbow-up\"

[[analysis]]
kind = \"path\"
name = \"ring\"
PATH
";

fn study(cell: &Cell, name: &str, arm: &str, path: &str) {
    let arm = match arm {
        "" => String::new(),
        arm => format!("calibrated_robot = \"{arm}\""),
    };
    cell.file(name, STUDY.replace("ARM", &arm).replace("PATH", path));
}

/// The rows of a table as numbers, with the names of its columns; empty cells are NaN.
fn table(cell: &Cell, name: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let text = std::fs::read_to_string(cell.at(name)).unwrap();
    let mut lines = text.lines();
    let names = lines.next().unwrap().split(',').map(str::to_owned).collect();
    let row = |line: &str| {
        line.split(',')
            .map(|cell| cell.parse().unwrap_or(f64::NAN))
            .collect()
    };
    (names, lines.map(row).collect())
}

fn columns<const N: usize>(names: &[String], wanted: [&str; N]) -> [usize; N] {
    wanted.map(|name| {
        names
            .iter()
            .position(|own| own == name)
            .unwrap_or_else(|| panic!("{name}: {names:?}"))
    })
}

/// Where the true arm takes the tool on the commanded path, mm, base, at the end of each of its lines.
fn cut(cell: &Cell, round: usize) -> Vec<Vector3<f64>> {
    let path = format!("program = {{ file = \"sent{round}/ring.commanded.csv\", spin = \"given\" }}");
    study(cell, "truth-study.toml", "truth.toml", &path);
    cell.armill(&[
        "run",
        "truth-study.toml",
        "--out",
        "truth",
        "--no-pictures",
        "--force",
    ]);
    let (names, rows) = table(cell, "truth/ring.csv");
    let [line] = columns(&names, ["line"]);
    let at = columns(&names, ["x_mm", "y_mm", "z_mm"]);
    let off = columns(
        &names,
        [
            "deviation_x_case_1_um",
            "deviation_y_case_1_um",
            "deviation_z_case_1_um",
        ],
    );
    let ends = rows
        .iter()
        .enumerate()
        .filter(|(k, row)| rows.get(k + 1).is_none_or(|next| next[line] != row[line]));
    ends.map(|(_, row)| Vector3::from_fn(|axis, _| row[at[axis]] + row[off[axis]] / 1e3))
        .collect()
}

/// Root mean square distance after the best fit, um (Kabsch 1976).
fn best_fit_um(points: &[Vector3<f64>], nominal: &[Vector3<f64>]) -> f64 {
    let middle = |all: &[Vector3<f64>]| all.iter().sum::<Vector3<f64>>() / all.len() as f64;
    let about = |all: &[Vector3<f64>]| {
        let middle = middle(all);
        DMatrix::from_fn(3, all.len(), |axis, k| all[k][axis] - middle[axis])
    };
    let (from, to) = (about(nominal), about(points));
    let parts = (&to * from.transpose()).fixed_view::<3, 3>(0, 0).svd(true, true);
    let (u, v) = (parts.u.unwrap(), parts.v_t.unwrap());
    let hand = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, (u * v).determinant().signum()));
    let off = to - DMatrix::from_column_slice(3, 3, (u * hand * v).as_slice()) * from;
    (off.norm_squared() / points.len() as f64).sqrt() * 1e3
}

#[test]
fn a_part_becomes_better_in_each_round_of_cutting_and_measuring() {
    let cell = Cell::new();
    cell.file("known.toml", KNOWN);
    let truth = TRUTH.iter().fold(KNOWN.to_owned(), |text, [known, truth]| {
        assert!(text.contains(known), "{known}");
        text.replacen(known, truth, 1)
    });
    cell.file("truth.toml", truth);
    let mut journal = "format = 1\nrobot = \"known.toml\"\ntool_mm = [0, 0, 150]\n".to_owned();
    let mut arm = String::new();
    let mut errors = Vec::new();
    for round in 0..4 {
        study(&cell, "study.toml", &arm, "circle.radius_mm = 100\nstep_mm = 10");
        let sent = format!("sent{round}");
        let nominal: &[&str] = if round == 0 { &["--nominal"] } else { &[] };
        cell.armill(&[&["compensate", "study.toml", "--out", &sent], nominal].concat())
            .fine();
        let points = cut(&cell, round);
        let (names, mut rows) = table(&cell, &format!("{sent}/ring.to-measure.csv"));
        let at = columns(&names, ["nominal_x_mm", "nominal_y_mm", "nominal_z_mm"]);
        let measured = columns(&names, ["x_mm", "y_mm", "z_mm"]);
        assert_eq!(rows.len(), points.len());
        assert!(rows.iter().flatten().filter(|value| value.is_nan()).count() == 3 * rows.len());
        // The plane is horizontal, its x along y of the base: only distances between points count.
        let nominal: Vec<Vector3<f64>> = rows
            .iter()
            .map(|row| Vector3::from_fn(|axis, _| row[at[axis]]))
            .collect();
        errors.push(best_fit_um(&points, &nominal));
        // Every third point is measured, within some um.
        for (k, (row, point)) in rows
            .iter_mut()
            .zip(&points)
            .enumerate()
            .filter(|(k, _)| k % 3 == 0)
        {
            for axis in 0..3 {
                let scatter = ((k * 7 + axis * 5 + round * 3) % 11) as f64 - 5.0;
                row[measured[axis]] = point[axis] + 1.5e-3 * scatter;
            }
        }
        let mut text = names.join(",") + "\n";
        for row in rows {
            let cells = row.iter().map(|value| {
                if value.is_nan() {
                    String::new()
                } else {
                    value.to_string()
                }
            });
            text += &(cells.collect::<Vec<_>>().join(",") + "\n");
        }
        cell.file(&format!("part{round}.csv"), text);
        let _ = write!(
            journal,
            "\n[[measurement]]\ndate = \"2026-11-2{round}\"\ntemperature_c = 21\nkind = \"part\"\nfile = \"part{round}.csv\"\nu_um = 5\n"
        );
        cell.file("journal.toml", &journal);
        arm = format!("after{round}.toml");
        cell.armill(&["journal", "journal.toml", "--out", &arm]).fine();
    }
    println!("errors of the part after the best fit, um rms: {errors:.1?}");
    let [uncompensated, first, second, third] = errors[..] else {
        panic!()
    };
    assert!(uncompensated > 80.0 && first < 10.0, "{errors:?}");
    assert!(second < first.max(6.0) && third < 6.0, "{errors:?}");
}

//! Files of the user are kept: what a command may replace, remove, follow and read.

use std::fmt::Write;
use std::process::Command;

use crate::calibrate::ROBOT as LEVER;
use crate::cell::{ARMILL, Cell, SMALL, armill};

const PRECIOUS: &str = "precious\n";
const KRL: &str = "DEF A()\n$BASE={X 1000,Y 0,Z 500,A 0,B 0,C 0}\n$TOOL={X 0,Y 0,Z 150,A 0,B 0,C 0}\n\
    PTP {X 0,Y 0,Z 10,A 0,B 180,C 0,S 2,T 35}\n$VEL.CP=0.01\nLIN {X 20.125 ,Y -.5E1,Z 0,A 0,B 180,C 0}\nEND\n";
const PROGRAM: &str = r#"
[tool]
flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0]
[[analysis]]
kind = "path"
name = "ring"
program.file = "side.src"
"#;
const RING: &str = "\n[[analysis]]\nkind = \"path\"\nname = \"ring\"\ncircle.radius_mm = 60\nstep_mm = 40\n";

/// Poses of the lever with 0.5 mm and 0.1 deg of error.
fn poses() -> String {
    let mut text = "A_deg,B_deg,x_mm,y_mm,z_mm\n".to_owned();
    for k in 0..12 {
        let (a, b) = (f64::from(k * 37 % 120 - 60), f64::from(k * 53 % 100 - 40));
        let (first, second) = (a.to_radians(), (a + b + 0.1).to_radians());
        let x = 300.5 * first.cos() + 200.0 * second.cos();
        let y = 300.5 * first.sin() + 200.0 * second.sin();
        let _ = writeln!(text, "{a},{b},{x},{y},0");
    }
    text
}

fn ballbar() -> String {
    let mut text = "# radius_mm: 100\nangle_deg,radius_dev_um,direction,run\n".to_owned();
    for k in 0..36 {
        let _ = writeln!(text, "{},{}.5,CCW,1", 10 * k, k % 7);
    }
    for k in 0..36 {
        let _ = writeln!(text, "{},{}.5,CW,1", 350 - 10 * k, k % 5);
    }
    text
}

/// A folder with an input of every kind, and files of the user.
fn cell() -> Cell {
    let cell = Cell::with_study(&format!("{SMALL}{RING}"));
    for name in ["photo.png", "sketch.svg", "placement-mine.svg", "ring.csv"] {
        cell.file(name, PRECIOUS);
    }
    cell.file("lever.toml", LEVER);
    cell.file("poses.csv", poses());
    cell.file("ball.csv", ballbar());
    cell.file("runs.csv", "x_mm,y_mm,z_mm\n0,0,0\n10,0,0\n20,0,1\n30,0,1\n");
    cell.file("path.csv", "x_mm,y_mm,z_mm\n0,0,0\n10,0,0\n20,0,0\n30,0,0\n");
    cell.file("cell/side.src", KRL);
    cell.file("cell/study.toml", format!("{SMALL}{PROGRAM}"));
    cell.armill(&[
        "identify",
        "--plan",
        "14",
        "--robot",
        "yaskawa/mh12",
        "--tool-mm",
        "0,60,150",
        "--out",
        "plan.csv",
    ])
    .fine();
    let plan = std::fs::read_to_string(cell.at("plan.csv")).unwrap();
    let filled = plan.lines().enumerate().map(|(line, text)| {
        let mut cells: Vec<&str> = text.split(',').collect();
        if line > 0 {
            cells.copy_within(13..16, 10);
        }
        cells.join(",") + "\n"
    });
    cell.file("tests.csv", filled.collect::<String>());
    cell
}

/// Every file below the folder with its bytes, but for what armill keeps for itself.
fn all_files(cell: &Cell) -> std::collections::BTreeMap<std::path::PathBuf, Vec<u8>> {
    let mut found = std::collections::BTreeMap::new();
    let mut folders = vec![cell.path().to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if !path
                .file_name()
                .unwrap()
                .to_string_lossy()
                .starts_with(".armill-")
            {
                found.insert(path.clone(), std::fs::read(&path).unwrap());
            }
        }
    }
    found
}

/// Commands whose outputs are named as inputs of theirs, or as files of the user.
const OVER_INPUTS: &[&[&str]] = &[
    &[
        "identify",
        "tests.csv",
        "--robot",
        "yaskawa/mh12",
        "--unknowns",
        "drives",
        "--out",
        "tests.csv",
    ],
    &[
        "calibrate",
        "poses.csv",
        "--robot",
        "lever.toml",
        "--out",
        "poses.csv",
    ],
    &[
        "calibrate",
        "poses.csv",
        "--robot",
        "lever.toml",
        "--residuals",
        "poses.csv",
    ],
    &[
        "calibrate",
        "poses.csv",
        "--robot",
        "lever.toml",
        "--out",
        "lever.toml",
    ],
    &["ballbar", "ball.csv", "--teach", "ball.csv"],
    &[
        "path-accuracy",
        "runs.csv",
        "--commanded",
        "path.csv",
        "--points",
        "runs.csv",
    ],
    &[
        "path-accuracy",
        "runs.csv",
        "--commanded",
        "path.csv",
        "--points",
        "path.csv",
    ],
    &["compensate", "cell", "--out", "cell"],
    &[
        "compensate",
        "cell",
        "--out",
        "sent",
        "--program",
        "cell/side.src",
        "--feed-mm-per-min",
        "600",
    ],
];
const OVER_OTHERS: &[&[&str]] = &[
    &[
        "identify",
        "tests.csv",
        "--robot",
        "yaskawa/mh12",
        "--unknowns",
        "drives",
        "--out",
        "study.toml",
    ],
    &[
        "identify",
        "--plan",
        "14",
        "--robot",
        "yaskawa/mh12",
        "--tool-mm",
        "0,60,150",
        "--out",
        "tests.csv",
    ],
    &["robots", "import", "yaskawa/mh12", "--out", "study.toml"],
    &["robots", "yaskawa/mh12", "--drawing", "sketch.svg"],
    &["new", "."],
    &["run", ".", "--out", ".", "--no-pictures"],
];

#[test]
fn no_command_replaces_its_input_even_by_force() {
    let cell = cell();
    let before = all_files(&cell);
    for words in OVER_INPUTS {
        cell.armill(words).refused(&["cannot write"]);
        let forced = [words, &["--force"][..]].concat();
        cell.armill(&forced).refused(&["this command reads that file"]);
        for (path, bytes) in &before {
            assert_eq!(
                std::fs::read(path).ok().as_ref(),
                Some(bytes),
                "{words:?}: {}",
                path.display()
            );
        }
    }
}

#[test]
fn no_command_replaces_a_foreign_file_without_force() {
    let cell = cell();
    let before = all_files(&cell);
    for words in OVER_OTHERS {
        cell.armill(words).refused(&["cannot write", "--force"]);
        assert_eq!(all_files(&cell), before, "{words:?}");
    }
    cell.armill(&["robots", "yaskawa/mh12", "--drawing", "sketch.svg", "--force"])
        .fine();
    assert!(
        std::fs::read_to_string(cell.at("sketch.svg"))
            .unwrap()
            .starts_with("<svg")
    );
    // Now it is armill's, and a drawing again needs no force.
    cell.armill(&["robots", "yaskawa/mh12", "--drawing", "sketch.svg"])
        .fine();
}

#[test]
fn a_plan_is_made_again_until_it_is_filled_in() {
    let cell = Cell::new();
    let plan = [
        "identify",
        "--plan",
        "14",
        "--robot",
        "yaskawa/mh12",
        "--tool-mm",
        "0,60,150",
        "--out",
        "plan.csv",
    ];
    cell.armill(&plan).fine();
    cell.armill(&plan).fine();
    let text = std::fs::read_to_string(cell.at("plan.csv")).unwrap();
    cell.file("plan.csv", text.replace(",,", ",0.1,"));
    cell.armill(&plan).refused(&["plan.csv", "changed since"]);
}

#[test]
fn commands_that_write_into_a_folder_keep_the_files_of_the_user() {
    let cell = cell();
    let before = all_files(&cell);
    let place = ["place", ".", "--x-mm", "990,1010", "--no-pictures", "--out", "."];
    cell.armill(&place).refused(&["ring.csv", "--force"]);
    cell.armill(&["ballbar", "ball.csv", "--out", "."])
        .refused(&["runs.csv", "--force"]);
    cell.armill(&["backlash", ".", "--simulate", ".", "--runs", "1"])
        .refused(&["ring.csv", "--force"]);
    let after = all_files(&cell);
    for (path, bytes) in &before {
        assert_eq!(after.get(path), Some(bytes), "{}", path.display());
    }
}

#[test]
fn a_backlash_folder_keeps_the_pictures_of_the_user() {
    let cell = Cell::new();
    cell.armill(&["new", "bar", "--example", "mh12-ballbar"]).fine();
    cell.file("bar/photo.png", PRECIOUS);
    cell.file("bar/placement-mine.svg", PRECIOUS);
    let before = all_files(&cell);
    cell.armill(&["backlash", "bar", "--out", "bar"]).fine();
    cell.armill(&["backlash", "bar", "--out", "bar"]).fine();
    let after = all_files(&cell);
    for (path, bytes) in &before {
        assert_eq!(after.get(path), Some(bytes), "{}", path.display());
    }
    assert!(after.len() > before.len());
}

#[test]
fn a_run_removes_its_own_stale_files_except_changed_ones() {
    let cell = Cell::with_study(&format!("{SMALL}{RING}"));
    cell.armill(&["run", ".", "--no-pictures"]).fine();
    cell.file("study.toml", format!("{SMALL}{}", RING.replace("ring", "rim")));
    cell.file("out/mine.csv", PRECIOUS);
    cell.file("out/ring.parquet", "noted by hand");
    cell.armill(&["run", ".", "--no-pictures"]).fine();
    let files = cell.files("out");
    assert!(!files.contains_key("ring.csv") && files.contains_key("rim.csv"));
    assert_eq!(files["mine.csv"], PRECIOUS.as_bytes());
    assert_eq!(files["ring.parquet"], b"noted by hand");
    // The answer names what belongs to it.
    let given = cell.result("out")["files"].as_object().unwrap().clone();
    let names: Vec<&String> = given.keys().collect();
    assert_eq!(names, ["rim.csv", "rim.parquet", "rim.vtp"]);
    assert!(given.values().all(|sum| sum.as_str().unwrap().len() == 64));
}

#[cfg(unix)]
#[test]
fn links_in_result_folders_are_not_followed() {
    use std::os::unix::fs::symlink;
    let cell = Cell::new();
    cell.file("precious", PRECIOUS);
    cell.file("side.src", KRL);
    cell.file("study.toml", format!("{SMALL}{PROGRAM}"));
    for (command, out, names) in [
        (
            &["run", ".", "--no-pictures"][..],
            "out",
            &["result.json", "ring.csv", ".armill-files", ".armill-lock"][..],
        ),
        (
            &["compensate", "."],
            "compensated",
            &[
                "side.src",
                "ring.commanded.csv",
                "ring.to-measure.csv",
                ".armill-files",
            ],
        ),
    ] {
        for name in names {
            for force in [&[][..], &["--force"]] {
                std::fs::create_dir_all(cell.at(out)).unwrap();
                let link = cell.at(out).join(name);
                symlink("../precious", &link).unwrap();
                cell.armill(&[command, force].concat()).refused(&[name, "link"]);
                assert_eq!(
                    std::fs::read_to_string(cell.at("precious")).unwrap(),
                    PRECIOUS,
                    "{name}"
                );
                std::fs::remove_dir_all(cell.at(out)).unwrap();
            }
        }
    }
}

#[cfg(unix)]
#[test]
fn an_input_is_recognised_behind_links_and_other_names() {
    let cell = Cell::new();
    cell.file("ball.csv", ballbar());
    std::fs::hard_link(cell.at("ball.csv"), cell.at("same.csv")).unwrap();
    std::os::unix::fs::symlink("ball.csv", cell.at("link.csv")).unwrap();
    let (ball, same) = ("ball.csv", "same.csv");
    for (input, output) in [
        (ball, same),
        (same, ball),
        ("link.csv", ball),
        (ball, "./ball.csv"),
    ] {
        cell.armill(&["ballbar", input, "--teach", output, "--force"])
            .refused(&["this command reads that file"]);
    }
}

#[test]
fn a_second_run_into_a_folder_is_refused_with_the_name_of_the_first() {
    let cell = Cell::with_study(&format!("{SMALL}{RING}"));
    // Another run writes into the folder: the test itself.
    let writer = armill_formats::file::Writer::new("place", false);
    let locked = writer.folder(&cell.at("out")).unwrap();
    let own = format!("armill place, process {}", std::process::id());
    cell.armill(&["run", ".", "--no-pictures"])
        .refused(&[&own, "wait for it"]);
    drop(locked);
    cell.armill(&["run", ".", "--no-pictures"]).fine();
    assert!(!cell.at("out/.armill-lock").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn inputs_named_in_a_study_are_regular_files_and_pipes_may_be_named_on_the_command_line() {
    let cell = Cell::new();
    let pipe = cell.at("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let program = |file: &str| format!("{SMALL}{}", PROGRAM.replace("side.src", file));
    for (name, text) in [
        ("program.toml", program("pipe")),
        ("zero.toml", program("/dev/zero")),
        (
            "holes.toml",
            format!("{SMALL}[[analysis]]\nkind = \"holes\"\nholes.file = \"pipe\"\n"),
        ),
        ("part.toml", format!("{SMALL}{RING}[measured]\npart = \"pipe\"\n")),
        ("robot.toml", SMALL.replace("yaskawa/mh12", "/dev/zero")),
        ("urdf.toml", SMALL.replace("yaskawa/mh12", "pipe.urdf")),
    ] {
        cell.file(name, text);
    }
    std::os::unix::fs::symlink("pipe", cell.at("pipe.urdf")).unwrap();
    for name in ["program", "zero", "holes", "part", "urdf"] {
        cell.armill(&["check", &format!("{name}.toml")])
            .refused(&["not a regular file"]);
    }
    cell.armill(&["check", "robot.toml"]).refused(&["/dev/zero"]);
    // A pipe on the command line is read to its end.
    let mut child = Command::new(ARMILL)
        .args(["ballbar", "/dev/stdin", "--json"])
        .current_dir(cell.path())
        .stdin(std::process::Stdio::piped())
        .stdout(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    std::io::Write::write_all(&mut child.stdin.take().unwrap(), ballbar().as_bytes()).unwrap();
    let said = child.wait_with_output().unwrap();
    assert!(said.status.success());
    let given: serde_json::Value = serde_json::from_slice(&said.stdout).unwrap();
    assert!(given.is_object());
}

#[test]
fn only_files_of_the_study_and_of_the_command_line_are_quoted() {
    let cell = Cell::new();
    let secret = "PASSWORD = \"CANARY-SECRET\"\nsecond = 1\n";
    cell.file("home/secret.toml", secret);
    let study = |robot: &str| SMALL.replace("yaskawa/mh12", robot);
    cell.file("cell/study.toml", study("../home/secret.toml"));
    for command in [
        &["check", "cell"][..],
        &["check", "cell", "--json"],
        &["run", "cell"],
    ] {
        let said = cell.armill(command);
        assert_eq!(said.code, 2);
        let all = said.out.clone() + &said.err;
        assert!(!all.contains("CANARY") && !all.contains("PASSWORD"), "{all}");
        said.refused(&["secret.toml:1:1", "outside the folder of the study"]);
    }
    // Named by the user, or in the folder of the study, it is quoted.
    cell.armill(&["robots", "home/secret.toml"])
        .refused(&["CANARY-SECRET"]);
    cell.file("cell/own.toml", secret);
    cell.file("cell/study.toml", study("own.toml"));
    cell.armill(&["check", "cell"]).refused(&["CANARY-SECRET"]);
    // A file that the kernel makes is empty.
    cell.file("cell/study.toml", study("/proc/self/environ"));
    let said = Command::new(ARMILL)
        .args(["check", "cell"])
        .current_dir(cell.path())
        .env("SECRET_ENV", "CANARY-SECRET")
        .output()
        .unwrap();
    assert_eq!(said.status.code(), Some(2));
    let text = String::from_utf8([said.stdout, said.stderr].concat()).unwrap();
    assert!(!text.contains("CANARY"), "{text}");
}

#[test]
fn help_of_every_writing_command_describes_force() {
    let folder = tempfile::tempdir().unwrap();
    for words in [
        &["run"][..],
        &["posture"],
        &["place"],
        &["advise"],
        &["compare"],
        &["new"],
        &["compensate"],
        &["identify"],
        &["calibrate"],
        &["forces"],
        &["roundness"],
        &["ballbar"],
        &["backlash"],
        &["path-accuracy"],
        &["motion"],
        &["drives"],
        &["frf"],
        &["receptance"],
        &["stability"],
        &["budget"],
        &["pose"],
        &["robots"],
        &["robots", "import"],
        &["man"],
    ] {
        let (code, out, _) = armill(folder.path(), &[words, &["--help"]].concat());
        assert!(code == 0 && out.contains("--force"), "{words:?}");
    }
}

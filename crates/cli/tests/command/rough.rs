//! Places and inputs that are not as one wishes: odd names, another locale, Windows' line ends, a disk that is full,
//! files
//! of gigabytes, and closed streams.

use std::process::Command;

use crate::cell::{ARMILL, Cell, EVERY_KIND, MH12_URDF, SMALL};

/// A program of a machine with a line and an arc.
const PROGRAM: &str = "G21 G90\nG0 X-60 Y0 Z20\nG1 Z0 F300\nG1 X60\nG3 X-60 Y0 I-60 J0\nM2\n";

/// The analysis of a program for the study of a robot file.
const ANALYSIS: &str =
    "\n[[analysis]]\nkind = \"path\"\nname = \"part\"\nprogram.file = \"part.nc\"\nstep_mm = 5\n";

/// [`SMALL`] with a robot file next to it.
fn with_own_robot() -> String {
    let own = SMALL.replace("\"yaskawa/mh12\"", "\"mh12.urdf\"");
    let compliance = "[compliance]\nrad_per_n_m = [2.1e-6, 2.5e-6, 4.0e-5, 6.0e-5, 6.0e-5, 8.0e-5]\nsource = \"made-up\"\n";
    format!("{own}\n{compliance}{ANALYSIS}")
}

/// `command`, run by the shell in the folder of `cell` with `$ARMILL` set: exit code and stderr.
#[cfg(unix)]
fn shell(cell: &Cell, command: &str) -> (Option<i32>, String) {
    let output = Command::new("sh")
        .args(["-c", command])
        .env("ARMILL", ARMILL)
        .current_dir(cell.path())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), said)
}

#[test]
fn odd_names_and_a_locale_with_decimal_commas_do_not_change_the_output() {
    let text = format!("{SMALL}{EVERY_KIND}");
    let (plain, odd) = (Cell::with_study(&text), Cell::new());
    plain.armill(&["run", "study.toml"]).fine();
    let folder = "Fräsen – Zelle 1/試験";
    odd.file(&format!("{folder}/study.toml"), &text);
    let status = Command::new(ARMILL)
        .args(["run", folder, "--out", "Ausgabe von heute"])
        .envs([
            ("LC_ALL", "de_DE.UTF-8"),
            ("LC_NUMERIC", "de_DE.UTF-8"),
            ("LANG", "de_DE.UTF-8"),
        ])
        .current_dir(odd.path())
        .output()
        .unwrap();
    assert!(
        status.status.success(),
        "{}",
        String::from_utf8_lossy(&status.stderr)
    );
    let (here, there) = (plain.files("out"), odd.files("Ausgabe von heute"));
    assert!(here.len() > 20 && here.keys().eq(there.keys()));
    for (name, bytes) in &here {
        assert!(there[name] == *bytes, "{name}");
    }
}

#[test]
fn line_ends_of_windows_do_not_change_the_output() {
    let [plain, windows] = [false, true].map(|crlf| {
        let cell = Cell::new();
        for (name, text) in [
            ("study.toml", with_own_robot()),
            ("mh12.urdf", MH12_URDF.to_owned()),
            ("part.nc", PROGRAM.to_owned()),
        ] {
            cell.file(name, if crlf { text.replace('\n', "\r\n") } else { text });
        }
        cell.armill(&["run", "study.toml"]).fine();
        cell.files("out")
    });
    assert!(plain.keys().eq(windows.keys()) && plain.contains_key("result.json"));
    for (name, bytes) in &plain {
        assert!(windows[name] == *bytes, "{name}");
    }
}

#[cfg(unix)]
#[test]
fn a_full_disk_is_reported_and_leaves_no_partial_file() {
    let cell = Cell::with_study(&format!("{SMALL}{EVERY_KIND}"));
    // No file may grow beyond 8 KiB: the write that goes over it fails, as on a full disk.
    let (code, said) = shell(
        &cell,
        "trap '' XFSZ; ulimit -f 16; exec \"$ARMILL\" run study.toml",
    );
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("error: ") && said.contains("out/"), "{said}");
    let left = cell.files("out");
    assert!(!left.contains_key("result.json"));
    let half: Vec<String> = left
        .iter()
        .filter_map(|(name, bytes)| crate::cell::what_is_half(name, bytes))
        .collect();
    assert!(half.is_empty(), "{half:?}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_cannot_be_written_is_reported() {
    let cell = Cell::with_study(SMALL);
    // Not even root makes a folder there.
    cell.armill(&["run", "study.toml", "--out", "/proc/armill"])
        .refused(&["/proc/armill"]);
    cell.armill(&["new", "/proc/armill"]).refused(&["/proc/armill"]);
}

#[cfg(unix)]
#[test]
fn without_any_stream_the_work_is_done() {
    let cell = Cell::with_study(&format!("{SMALL}{EVERY_KIND}"));
    let (code, _) = shell(&cell, "exec \"$ARMILL\" run study.toml <&- >&- 2>&-");
    assert_eq!(code, Some(0));
    let closed = cell.files("out");
    cell.armill(&["run", "study.toml"]).fine();
    assert!(closed == cell.files("out"));
    for command in [
        "robots",
        "check study.toml",
        "pose yaskawa/mh12 --at-mm 1000,0,800",
    ] {
        assert_eq!(
            shell(&cell, &format!("exec \"$ARMILL\" {command} <&- >&- 2>&-")).0,
            Some(0),
            "{command}"
        );
    }
}

#[cfg(target_os = "linux")]
#[test]
fn gigabytes_are_refused_before_they_fill_the_memory() {
    let cell = Cell::new();
    // Holes take no room on the disk.
    let sparse = |name: &str, bytes: u64| {
        let file = std::fs::File::create(cell.at(name)).unwrap();
        file.set_len(bytes).unwrap();
    };
    for name in ["big.toml", "big.urdf", "big.xacro", "big.csv"] {
        sparse(name, 4 << 30);
    }
    let own = SMALL.replace("yaskawa/mh12", "big.urdf");
    cell.file("study.toml", own);
    // Records are read as they come.
    for name in ["record.csv", "record.b5r", "record.qif"] {
        sparse(name, 200 << 20);
    }
    let (whole, record) = ("more than 64 MiB", "error: ");
    for (command, given) in [
        ("check big.toml", whole),
        ("check study.toml", whole),
        ("robots big.toml", whole),
        ("robots import big.urdf", whole),
        ("robots import big.xacro", whole),
        ("identify big.csv --robot yaskawa/mh12", whole),
        ("roundness record.csv", record),
        ("roundness record.qif", record),
        ("ballbar record.csv", record),
        ("ballbar record.b5r", record),
        ("forces record.csv", record),
        ("calibrate record.csv --robot yaskawa/mh12", record),
    ] {
        let (code, said) = shell(&cell, &format!("ulimit -v 1500000; exec \"$ARMILL\" {command}"));
        assert_eq!(code, Some(2), "{command}: {said}");
        assert!(
            said.contains(given) && !said.contains("panicked"),
            "{command}: {said}"
        );
    }
}

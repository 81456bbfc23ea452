//! A small cell to test the command in: a folder of its own, study files, robot files, and what armill said.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

/// The program under test.
pub const ARMILL: &str = env!("CARGO_BIN_EXE_armill");

/// A study of 25 points that runs in a moment; no optional table, so that others can be appended.
pub const SMALL: &str = r#"format = 1
base = "base_link"
robot = "yaskawa/mh12"
tolerance_um = 130

[plane]
centre_mm = [1000, 0, 800]
tilt_deg = 0
half_size_mm = 100
step_mm = 50

[load]
cases_n = [[3, 5, 5], [3, -5, 5]]
"#;

/// One analysis of every kind but holes, to be appended to [`SMALL`]: 25 + 2 x 25 + 27 + 36 points.
pub const EVERY_KIND: &str = r#"
[[analysis]]
kind = "map"
name = "plate"

[[analysis]]
kind = "sections"
name = "distances"
distances_mm = [900, 1000]

[[analysis]]
kind = "volume"
name = "space"
box = { half_size_mm = [50, 50, 50], step_mm = 50 }

[[analysis]]
kind = "path"
name = "groove"
circle.radius_mm = 60
step_mm = 10.4719756
"#;

/// The MH12 as a URDF of our own writing: numbers of ros-industrial/motoman (Apache-2.0), typed.
pub const MH12_URDF: &str = r#"<?xml version="1.0"?>
<robot name="mh12 by hand">
  <link name="base_link"/><link name="l1"/><link name="l2"/><link name="l3"/><link name="l4"/>
  <link name="l5"/><link name="l6"/><link name="tool0"/>
  <joint name="S" type="revolute"><parent link="base_link"/><child link="l1"/>
    <origin xyz="0 0 0.450" rpy="0 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-2.9670597283903604" upper="2.9670597283903604" effort="0" velocity="3.84"/></joint>
  <joint name="L" type="revolute"><parent link="l1"/><child link="l2"/>
    <origin xyz="0.155 0 0" rpy="0 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-1.5707963267948966" upper="2.705260340591211" effort="0" velocity="3.49"/></joint>
  <joint name="U" type="revolute"><parent link="l2"/><child link="l3"/>
    <origin xyz="0 0 0.614" rpy="0 0 0"/><axis xyz="0 -1 0"/>
    <limit lower="-1.4835298641951802" upper="2.6179938779914944" effort="0" velocity="3.84"/></joint>
  <joint name="R" type="revolute"><parent link="l3"/><child link="l4"/>
    <origin xyz="0.640 0 0.200" rpy="0 0 0"/><axis xyz="-1 0 0"/>
    <limit lower="-3.141592653589793" upper="3.141592653589793" effort="0" velocity="7.16"/></joint>
  <joint name="B" type="revolute"><parent link="l4"/><child link="l5"/>
    <origin xyz="0 0 0" rpy="0 0 0"/><axis xyz="0 -1 0"/>
    <limit lower="-2.356194490192345" upper="2.356194490192345" effort="0" velocity="7.16"/></joint>
  <joint name="T" type="revolute"><parent link="l5"/><child link="l6"/>
    <origin xyz="0 0 0" rpy="0 0 0"/><axis xyz="-1 0 0"/>
    <limit lower="-6.283185307179586" upper="6.283185307179586" effort="0" velocity="10.65"/></joint>
  <joint name="tool0" type="fixed"><parent link="l6"/><child link="tool0"/>
    <origin xyz="0.100 0 0" rpy="3.141592653589793 -1.5707963267948966 0"/></joint>
</robot>
"#;

/// Compliances of the library's MH12, as a flag.
pub const MH12_COMPLIANCE: &str = "2.1e-6,2.5e-6,4.0e-5,6.0e-5,6.0e-5,8.0e-5";

/// A lever: one joint that turns, one that slides.
pub const LEVER: &str = r#"format = 1
name = "lever"
[chain]
source = "made-up"
motions = [
  { along = "z", length_mm = 300 },
  { about = "z", joint = "A" },
  { along = "x", length_mm = 500 },
  { along = "x", joint = "B" },
]
[[joint]]
name = "A"
sign = 1
limits_deg = [-100, 120]
source = "made-up"
compliance_rad_per_n_m = 2e-6
compliance_source = "made-up"
[[joint]]
name = "B"
sign = 1
limits_mm = [0, 250]
source = "made-up"
compliance_um_per_n = 0.02
compliance_source = "made-up"
[sources.made-up]
what = "nothing real"
where = "this test"
licence = "none"
"#;

/// A folder that is gone when the test ends.
pub struct Cell {
    folder: TempDir,
}

/// What a command said and how it ended.
pub struct Said {
    /// Exit code; -1 where a signal ended it.
    pub code: i32,
    pub out: String,
    pub err: String,
}

impl Cell {
    pub fn new() -> Cell {
        Cell {
            folder: tempfile::tempdir().expect("a temporary folder"),
        }
    }

    /// A cell in a folder that has its files.
    pub fn of(folder: TempDir) -> Cell {
        Cell { folder }
    }

    /// A cell with `study.toml`.
    pub fn with_study(text: &str) -> Cell {
        let cell = Cell::new();
        cell.file("study.toml", text);
        cell
    }

    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    pub fn at(&self, name: &str) -> PathBuf {
        self.path().join(name)
    }

    pub fn file(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.at(name);
        std::fs::create_dir_all(path.parent().expect("a folder above")).expect("the folder can be made");
        std::fs::write(&path, bytes).expect("the file can be written");
        path
    }

    /// armill with these arguments, in this folder.
    pub fn armill<S: AsRef<std::ffi::OsStr>>(&self, arguments: &[S]) -> Said {
        let (code, out, err) = armill(self.path(), arguments);
        Said { code, out, err }
    }

    /// `result.json` of the folder `out`.
    pub fn result(&self, out: &str) -> Value {
        let path = self.at(out).join("result.json");
        serde_json::from_slice(&std::fs::read(path).expect("a result.json")).expect("JSON")
    }

    /// `result.json` of the folder `out` without the list of its files: the answer on stdout.
    pub fn answer(&self, out: &str) -> Value {
        let mut result = self.result(out);
        let files = result.as_object_mut().expect("an object").shift_remove("files");
        assert!(files.is_some_and(|files| files.is_object()));
        result
    }

    /// Every file of the folder `out` by name, but for those that armill keeps for itself.
    pub fn files(&self, out: &str) -> BTreeMap<String, Vec<u8>> {
        let mut files = files_in(&self.at(out));
        files.retain(|name, _| !name.starts_with(".armill-"));
        files
    }
}

/// armill with these arguments, in any folder: exit code (-1 where a signal ended it), stdout and stderr.
pub fn armill<S: AsRef<std::ffi::OsStr>>(folder: &Path, arguments: &[S]) -> (i32, String, String) {
    let output = Command::new(ARMILL)
        .current_dir(folder)
        .args(arguments)
        .output()
        .expect("armill starts");
    (
        output.status.code().unwrap_or(-1),
        String::from_utf8(output.stdout).expect("stdout is UTF-8"),
        String::from_utf8(output.stderr).expect("stderr is UTF-8"),
    )
}

impl Said {
    /// This, where the command did its work.
    #[track_caller]
    pub fn fine(self) -> Said {
        assert_eq!(self.code, 0, "stdout:\n{}\nstderr:\n{}", self.out, self.err);
        self
    }

    /// This, where the input was refused with exit code 2 and all of these words on stderr.
    #[track_caller]
    pub fn refused(self, words: &[&str]) -> Said {
        assert_eq!(self.code, 2, "stdout:\n{}\nstderr:\n{}", self.out, self.err);
        for word in words {
            assert!(self.err.contains(word), "no `{word}` in:\n{}", self.err);
        }
        self
    }

    /// Stdout as one JSON value.
    #[track_caller]
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.out)
            .unwrap_or_else(|error| panic!("{error} in:\n{}\nstderr:\n{}", self.out, self.err))
    }
}

/// Every file of a folder by name; nothing if the folder does not exist.
pub fn files_in(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return BTreeMap::new();
    };
    entries
        .map(|entry| {
            let path = entry.expect("an entry").path();
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            (name, std::fs::read(path).expect("a readable file"))
        })
        .collect()
}

/// What is missing at the end of a file of armill; `None` where it is whole.
pub fn what_is_half(name: &str, bytes: &[u8]) -> Option<String> {
    let text = || std::str::from_utf8(bytes).unwrap_or_default().trim_end();
    let ends = |end: &str| text().ends_with(end);
    let extension = name.rsplit('.').next().unwrap_or_default();
    let whole = match extension {
        "json" => serde_json::from_slice::<Value>(bytes).is_ok(),
        "svg" => text().starts_with("<svg") && ends("</svg>"),
        "html" => ends("</html>"),
        "vtp" | "vti" => ends("</VTKFile>"),
        // A PNG ends with the chunk IEND and its checksum.
        "png" => bytes.starts_with(b"\x89PNG\r\n\x1a\n") && bytes.ends_with(b"IEND\xaeB`\x82"),
        "parquet" => bytes.len() > 12 && bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1"),
        "csv" => {
            let commas = |line: &str| line.matches(',').count();
            let header = text()
                .lines()
                .find(|line| !line.starts_with('#'))
                .unwrap_or_default();
            bytes.ends_with(b"\n")
                && text()
                    .lines()
                    .last()
                    .is_some_and(|last| commas(last) == commas(header))
        }
        _ => false,
    };
    (!whole).then(|| {
        format!(
            "{name} ({} bytes) is half-written or not one of armill's files",
            bytes.len()
        )
    })
}

/// `value` as a number.
#[track_caller]
pub fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("`{value}` is not a number"))
}

/// `value` as a list of numbers.
#[track_caller]
pub fn numbers(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .unwrap_or_else(|| panic!("`{value}` is not a list"))
        .iter()
        .map(number)
        .collect()
}

/// `value` as rows of numbers.
#[track_caller]
pub fn rows(value: &Value) -> Vec<Vec<f64>> {
    value
        .as_array()
        .unwrap_or_else(|| panic!("`{value}` is not a list"))
        .iter()
        .map(numbers)
        .collect()
}

/// Difference of two angles, deg, whole turns taken off.
pub fn apart_deg(a: f64, b: f64) -> f64 {
    let turns = (a - b) / 360.0;
    (turns - turns.round()).abs() * 360.0
}

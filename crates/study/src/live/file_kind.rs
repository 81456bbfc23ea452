//! The probable kind of a file, by its extension and its first lines, and the line of a study that names such a file.
//!
//! Only a guess to save the user a look into the guide: the reader of the file decides.

use std::io::Read;
use std::path::Path;

use armill_formats::robot::format::Format as RobotFormat;
use armill_formats::toolpath::format::{Format as PathFormat, HEAD_BYTES};
use schemars::JsonSchema;
use serde::Serialize;

/// The probable kind of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum FileKind {
    /// A robot.
    Robot,
    /// A tool path, or the robot program.
    Path,
    /// Forces of a dynamometer.
    Forces,
    /// A circular test.
    Ballbar,
    /// A measured profile.
    Profile,
    /// Unknown.
    Unknown,
}

/// The probable kind of the file at `path`, and the line of a study that names it as `name`.
pub fn kind_of(path: &Path, name: &str) -> (FileKind, String) {
    let mut head = Vec::new();
    let opened = armill_formats::input::open(path).map(|file| file.take(HEAD_BYTES));
    // A file that cannot be read is classified by its name alone.
    let _ = opened.and_then(|mut begin| begin.read_to_end(&mut head));
    let kind = guess(Path::new(name), &String::from_utf8_lossy(&head));
    let line = match kind {
        FileKind::Robot => format!("robot = \"{name}\""),
        FileKind::Path => format!("[[analysis]] kind = \"path\" program = {{ file = \"{name}\" }}"),
        FileKind::Forces => format!("program = {{ file = \"...\", forces = {{ file = \"{name}\" }} }}"),
        FileKind::Ballbar => format!("[measured] ballbar = [\"{name}\"]"),
        FileKind::Profile => format!("[measured] part = \"{name}\""),
        FileKind::Unknown if head.is_empty() => "the file is empty".to_owned(),
        FileKind::Unknown => "armill reads no kind of file with this name".to_owned(),
    };
    (kind, line)
}

fn guess(name: &Path, head: &str) -> FileKind {
    let ending = name
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase());
    let titles = head
        .lines()
        .find(|line| !line.trim().is_empty() && !line.starts_with('#'));
    let titles = titles.unwrap_or_default().to_lowercase();
    let has = |words: &[&str]| words.iter().any(|word| titles.contains(word));
    // An empty file has no kind, whatever its name.
    if head.trim().is_empty() {
        return FileKind::Unknown;
    }
    match ending.as_deref() {
        Some("qif") => FileKind::Profile,
        Some("b5r" | "b52" | "b5t") => FileKind::Ballbar,
        Some("toml") if head.contains("tolerance_um") => FileKind::Unknown,
        Some("csv" | "txt" | "tsv" | "dat") if has(&["fx", "force", "mz"]) => FileKind::Forces,
        Some("csv" | "txt" | "tsv" | "dat") if has(&["angle", "radial", "deviation_um"]) => FileKind::Profile,
        _ if RobotFormat::has_ending(name) => FileKind::Robot,
        _ if PathFormat::of(name, head).is_ok() => FileKind::Path,
        _ => FileKind::Unknown,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_classified_by_name_and_first_line() {
        let of = |name: &str, head: &str| guess(Path::new(name), head);
        assert_eq!(of("arm.urdf", "<robot/>"), FileKind::Robot);
        assert_eq!(of("part.ngc", "G21 G90\nG1 X10 F500\n"), FileKind::Path);
        assert_eq!(of("record.csv", "time_s,Fx_N,Fy_N,Fz_N\n"), FileKind::Forces);
        assert_eq!(of("rim.csv", "angle_deg,deviation_um\n"), FileKind::Profile);
        assert_eq!(of("notes.doc", "hello"), FileKind::Unknown);
        assert_eq!(of("empty.csv", ""), FileKind::Unknown);
        assert_eq!(of("arm.urdf", " \n"), FileKind::Unknown);
    }
}

//! The kinds of tool path files, and how that of a file is recognised: from its content, otherwise from its name.

use std::path::Path;

use super::known_by::{Robots, is_apt, is_gcode, is_header, robot_language};
use crate::document::lines::is_remark;
use crate::document::{Problem, Problems};
use crate::language::Language;

/// A kind of tool path file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// G-code.
    Gcode,
    /// Cutter locations: APT-CL, CLDATA, CLSF.
    Apt,
    /// A table of points.
    Csv,
    /// A program of a robot.
    Robot(Language),
}

/// Number of bytes used to recognise the format.
pub const HEAD_BYTES: u64 = 256 * 1024;
/// Maximum number of lines that are searched for the format.
const MOST_LINES: usize = 2000;

impl Format {
    /// Its name in results.
    pub fn name(self) -> &'static str {
        match self {
            Format::Gcode => "gcode",
            Format::Apt => "apt",
            Format::Csv => "csv",
            Format::Robot(language) => language.name(),
        }
    }

    /// The format of the file `path` that begins with `text`: its first 256 KiB, or all of it.
    ///
    /// Looked for in this order: a line of any robot language, a word of cutter locations, a line of names, a line of
    /// G-code; then the ending.
    ///
    /// # Errors
    /// A robot program in an unsupported language, and a file whose format cannot be recognised from content or name.
    pub fn of(path: &Path, text: &str) -> Result<Format, Problems> {
        let refused = |message: String, hint: &str| {
            let path = path.display().to_string();
            Err(Problems::from(Problem::of_file(&path, message, hint)))
        };
        if text.contains('\0') {
            return refused(
                "this is not text".to_owned(),
                "save it as UTF-8 text; cutter locations in binary are not read",
            );
        }
        let text = text.trim_start_matches('\u{feff}');
        let lines = || {
            text.split(['\n', '\r'])
                .map(str::trim)
                .filter(|line| !line.is_empty())
                .take(MOST_LINES)
        };
        let ending = path
            .extension()
            .and_then(|ending| ending.to_str())
            .map(str::to_lowercase)
            .unwrap_or_default();
        let of_ending = Language::of_ending(&ending);
        match lines().find_map(robot_language) {
            // The moves of VAL3 are spelled as those of URScript; the endings of its files are its own.
            Some(Robots::Read(_)) if of_ending == Some(Language::Val3) => {
                return Ok(Format::Robot(Language::Val3));
            }
            Some(Robots::Read(language)) => return Ok(Format::Robot(language)),
            Some(Robots::Other(language)) => {
                let hint = "its language is not supported: give the path as the CAM system writes it, as cutter \
                    locations (APT, \
                    CLSF), G-code or CSV";
                return refused(format!("this is a robot program ({language})"), hint);
            }
            None => {}
        }
        if lines().any(is_apt) {
            return Ok(Format::Apt);
        }
        if lines().find(|line| !is_remark(line)).is_some_and(is_header) {
            return Ok(Format::Csv);
        }
        if lines().any(is_gcode) {
            return Ok(Format::Gcode);
        }
        match (ending.as_str(), of_ending) {
            (_, Some(language)) => Ok(Format::Robot(language)),
            ("apt" | "aptsource" | "cl" | "cls" | "clsf" | "cldata", _) => Ok(Format::Apt),
            ("csv" | "tsv", _) => Ok(Format::Csv),
            ("nc" | "ngc" | "gcode" | "tap" | "cnc" | "mpf" | "eia" | "iso" | "min", _) => Ok(Format::Gcode),
            _ => refused(
                "neither content nor file name identifies the format of this tool path".to_owned(),
                "supported: G-code, cutter locations (APT, CLSF), CSV and robot programs (KRL, RAPID, INFORM, TP, \
                 URScript, VAL3); use the file ending of the format, such as `.nc`, `.apt`, `.csv` or `.src`",
            ),
        }
    }
}

//! A program of a machine tool, cutter locations or a table of points as a path: its reader and the keys of the study.

use std::io::BufReader;
use std::path::Path;

use armill_core::path::{PathBuilder, SampledPath};
use armill_formats::input;
use armill_formats::toolpath::apt::Dialect;
use armill_formats::toolpath::format::{self, ToolpathReadOptions};
use armill_formats::toolpath::gcode::ToolTable;
use armill_formats::toolpath::{LengthUnit, Summary};

use crate::StudyError;
use crate::analysis::path::program_file::{FILE_HINT, MOST_POINTS, ProgramFile};
use crate::analysis::path::program_table::{DialectName, ProgramTable, RotariesName, UnitName};
use crate::input::problem_log::ProblemLog;

/// The points of the program, and its data; `None` if it has problems, reported at their keys.
///
/// # Errors
/// The problems of its file.
pub fn read(
    log: &mut ProblemLog<'_>,
    table: &ProgramTable,
    file: &ProgramFile<'_>,
) -> Result<Option<(SampledPath, Summary)>, StudyError> {
    let of_robots = [
        (
            "frame_mm_deg",
            table.frame_mm_deg.is_some(),
            "part_from_path_mm_deg specifies its placement on the part",
        ),
        (
            "cuts_up_to_mm_per_min",
            table.cuts_up_to_mm_per_min.is_some(),
            "its rapids are given in the program",
        ),
    ];
    for (key, _, hint) in of_robots.iter().filter(|(_, given, _)| *given) {
        let message = format!("`{key}`: `{}` is not a robot program", table.file);
        log.problem(&format!("program.{key}"), message, hint);
    }
    if of_robots.iter().any(|(_, given, _)| *given) {
        return Ok(None);
    }
    let opened = match input::open(&file.path) {
        Ok(opened) => opened,
        Err(error) => {
            let message = format!("cannot read {}: {error}", file.path.display());
            log.problem("program.file", message, FILE_HINT);
            return Ok(None);
        }
    };
    let unit = table.unit.map(|unit| match unit {
        UnitName::Mm => LengthUnit::Millimetre,
        UnitName::Inch => LengthUnit::Inch,
    });
    let tools = match &table.tool_table {
        None => None,
        Some(name) => {
            let path = file.folder.join(name);
            let Some(text) = text_of(log, "program.tool_table", &path) else {
                return Ok(None);
            };
            Some(ToolTable::read(
                &path.display().to_string(),
                &text,
                unit.unwrap_or_default(),
            )?)
        }
    };
    // A subroutine that is not in the program is in a separate file of the same folder, as in LinuxCNC.
    let same_folder = file.path.parent().unwrap_or(file.folder).to_owned();
    let subroutine = |name: &str| {
        let plain = name.chars().all(|c| c.is_alphanumeric() || "-_".contains(c));
        let path = same_folder.join(format!("{name}.ngc"));
        plain.then(|| input::read_text(&path).ok()).flatten()
    };
    let requested = ToolpathReadOptions {
        unit,
        dialect: table.dialect.map(|dialect| match dialect {
            DialectName::Nx => Dialect::Nx,
            DialectName::SolidWorks => Dialect::SolidWorks,
        }),
        rotaries: table.rotaries.map(RotariesName::rotaries),
        tools,
        subroutines: Some(&subroutine),
        ..ToolpathReadOptions::default()
    };
    let mut builder = PathBuilder::new(file.sampling, MOST_POINTS);
    let shown = file.path.display().to_string();
    let summary = format::read(&shown, BufReader::new(opened), &requested, &mut |step| {
        builder.take(step);
    })?;
    match builder.finish() {
        Ok(path) => Ok(Some((path, summary))),
        Err(error) => {
            file.too_many(log, error);
            Ok(None)
        }
    }
}

/// The text of a file that the study names by `key`; `None` if it cannot be read, reported at its key.
fn text_of(log: &mut ProblemLog<'_>, key: &str, path: &Path) -> Option<String> {
    let report = |error: std::io::Error| {
        let message = format!("cannot read {}: {error}", path.display());
        log.problem(key, message, FILE_HINT);
    };
    input::read_text(path).map_err(report).ok()
}

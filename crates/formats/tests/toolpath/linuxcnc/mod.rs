//! LinuxCNC's programs: the canonical calls of its interpreter tests, the reasons of its refusals, and which of its
//! larger programs are read.

mod canonical;
mod geometry;
mod programs;
mod refusals;

use std::path::{Path, PathBuf};

use armill_formats::toolpath::LengthUnit;
use armill_formats::toolpath::gcode::{GcodeReadOptions, ToolTable};

use crate::samples_folder::samples;

/// Its folder, if there are samples.
fn linuxcnc() -> Option<PathBuf> {
    samples("toolpaths/gcode/linuxcnc")
}

fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_else(|error| panic!("sample {}: {error}", path.display()))
}

fn text(path: &Path) -> String {
    String::from_utf8_lossy(&bytes(path)).into_owned()
}

/// The simulated machine of those tests counts its tool table and parameters in inches.
fn simulated(table: Option<&Path>) -> GcodeReadOptions<'static> {
    GcodeReadOptions {
        machine_unit: LengthUnit::Inch,
        tools: table.map(|path| ToolTable::read("tbl", &text(path), LengthUnit::Inch).unwrap()),
        ..GcodeReadOptions::default()
    }
}

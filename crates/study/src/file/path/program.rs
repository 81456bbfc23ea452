//! A tool path program: its file, where it lies on the part, how the tool is turned, how finely it is cut into points.
//!
//! | frame | what it is |
//! |---|---|
//! | `path` | what the program counts from, moved by `part_from_path_mm_deg` |
//! | `part` | origin at the centre of the plane, z its outward normal |
//!
//! Lines become points at most `step_mm` apart, arcs so many that no chord leaves them by more than `chord_error_mm`.
//! The reader hands its steps on one by one; at most `MOST_POINTS` points are made of them.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use armill_core::frame::Isometry;
use armill_core::nalgebra::Vector3;
use armill_core::path::{PathBuilder, Placing, SampledPath, Sampling, Spin};
use armill_formats::toolpath::apt::Dialect;
use armill_formats::toolpath::format::{self, Wanted};
use armill_formats::toolpath::gcode::{Rotaries, ToolTable};
use armill_formats::toolpath::{LengthUnit, Summary};
use schemars::JsonSchema;
use serde::Deserialize;

use super::drill::DrillTable;
use super::feature::{FeatureTable, features_have_points};
use super::measured::MeasuredTable;
use crate::StudyError;
use crate::file::places::Places;
use crate::file::quantities::{pose_mm_deg, positive};

/// A program that the tool follows.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProgramTable {
    /// Its file, relative to the study: G-code, APT-CL or CLSF, or a CSV of points.
    pub file: String,
    /// Unit of lengths where the file does not tell.
    pub unit: Option<UnitName>,
    /// Whose cutter locations (APT, CLSF) these are, where the file does not show it.
    pub dialect: Option<DialectName>,
    /// What the rotary words of G-code turn.
    pub rotaries: Option<RotariesName>,
    /// Tool table of the machine that the G-code is for, as LinuxCNC writes it, relative to the study.
    pub tool_table: Option<String>,
    /// Where its zero lies in the part frame (z = outward normal of the plane, origin at its centre): x, y, z in mm,
    /// then turns about the fixed axes x, y, z in degrees.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub part_from_path_mm_deg: Option<[f64; 6]>,
    /// Where the tool points.
    pub tool_axis: Option<ToolAxisName>,
    /// How the tool is turned about its axis.
    pub spin: Option<SpinName>,
    /// By what angle more.
    #[schemars(range(min = -360.0, max = 360.0))]
    pub spin_deg: Option<f64>,
    /// Farthest that a chord may leave its arc; 0.01 if left out.
    #[schemars(range(max = 1e3))]
    pub chord_error_mm: Option<f64>,
    /// Longest distance between points; 1 if left out.
    #[schemars(range(max = 1e6))]
    pub step_mm: Option<f64>,
    /// Whether force, depth, width and feed that keep the tolerance are told; so if left out.
    pub limits: Option<bool>,
    /// Stretches of the program that make a feature.
    #[serde(default)]
    pub feature: Vec<FeatureTable>,
    /// Measured forces: the load of this program.
    pub measured: Option<MeasuredTable>,
    /// A drill: its thrust and torque are the load of this program.
    pub drill: Option<DrillTable>,
}

/// Unit of lengths.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum UnitName {
    /// Millimetre.
    Mm,
    /// Inch.
    Inch,
}

/// Whose cutter locations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum DialectName {
    /// Siemens NX: a GOTO without tool axis keeps the one before.
    Nx,
    /// SolidWorks CAM: a GOTO without tool axis means 0,0,1.
    SolidWorks,
}

/// What rotary words turn, from the frame of the machine outwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RotariesName {
    /// A tilting table A that carries a turntable C.
    TableAc,
    /// A tilting table B that carries a turntable C.
    TableBc,
    /// A fork C that carries a tilting head A.
    HeadCa,
    /// A fork C that carries a tilting head B.
    HeadCb,
}

impl RotariesName {
    /// As the reader of G-code knows them.
    fn rotaries(self) -> Rotaries {
        match self {
            RotariesName::TableAc => Rotaries::table_ac(),
            RotariesName::TableBc => Rotaries::table_bc(),
            RotariesName::HeadCa => Rotaries::head_ca(),
            RotariesName::HeadCb => Rotaries::head_cb(),
        }
    }
}

/// Where the tool points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ToolAxisName {
    /// Where the program says; against the plane's normal where it says nothing.
    Program,
    /// Always against the plane's normal.
    Normal,
}

/// How the tool is turned about its axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SpinName {
    /// The same everywhere.
    Fixed,
    /// With the feed.
    AlongFeed,
    /// As the program tells at each point: column `spin_deg` of a CSV.
    Given,
}

/// Most points of a program: what the memory of a study holds.
pub(super) const MOST_POINTS: usize = 8_000_000;
/// What to do where a file is not found.
pub(in crate::file) const BESIDE_STUDY: &str = "the path counts from the folder of the study";
/// Greatest distance of a chord from its arc where the study says nothing, mm.
const CHORD_ERROR_MM: f64 = 0.01;
/// Greatest distance of points where the study says nothing, mm.
const STEP_MM: f64 = 1.0;

/// The points of the program of this table; `None` where it has problems, told at their places.
///
/// # Errors
/// The problems of its file.
pub(in crate::file) fn read(
    places: &mut Places<'_>,
    table: &ProgramTable,
    folder: &Path,
) -> Result<Option<(SampledPath, Summary)>, StudyError> {
    let chord_error = positive(
        places,
        "program.chord_error_mm",
        table.chord_error_mm.unwrap_or(CHORD_ERROR_MM),
    );
    let step = positive(places, "program.step_mm", table.step_mm.unwrap_or(STEP_MM));
    for (index, feature) in table.feature.iter().enumerate() {
        let [first, last] = feature.lines;
        if first == 0 || last < first {
            let message = format!("`{}` is cut by lines {first} to {last}", feature.name);
            let hint = "first and last line of the program, counted from 1";
            places.problem(&format!("program.feature[{index}].lines"), message, hint);
        }
    }
    let (Some(chord_error), Some(step)) = (chord_error, step) else {
        return Ok(None);
    };
    let file_path = folder.join(&table.file);
    if file_path.is_dir() {
        let message = format!("{} is a folder", file_path.display());
        places.problem("program.file", message, "name the file in it");
        return Ok(None);
    }
    let file = match File::open(&file_path) {
        Ok(file) => file,
        Err(error) => {
            let message = format!("cannot read {}: {error}", file_path.display());
            places.problem("program.file", message, BESIDE_STUDY);
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
            let path = folder.join(name);
            let Some(text) = text_of(places, "program.tool_table", &path) else {
                return Ok(None);
            };
            Some(ToolTable::read(
                &path.display().to_string(),
                &text,
                unit.unwrap_or_default(),
            )?)
        }
    };
    // A subroutine that is not in the program lies beside it in a file of its own, as LinuxCNC has it.
    let beside = file_path.parent().unwrap_or(folder).to_owned();
    let subroutine = |name: &str| {
        let plain = name.chars().all(|c| c.is_alphanumeric() || "-_".contains(c));
        let file = beside.join(format!("{name}.ngc"));
        plain.then(|| std::fs::read_to_string(file).ok()).flatten()
    };
    let wanted = Wanted {
        unit,
        dialect: table.dialect.map(|dialect| match dialect {
            DialectName::Nx => Dialect::Nx,
            DialectName::SolidWorks => Dialect::SolidWorks,
        }),
        rotaries: table.rotaries.map(RotariesName::rotaries),
        tools,
        subroutines: Some(&subroutine),
        ..Wanted::default()
    };
    let mut builder = PathBuilder::new(Sampling { chord_error, step }, MOST_POINTS);
    let shown = file_path.display().to_string();
    let summary = format::read(&shown, BufReader::new(file), &wanted, &mut |step| {
        builder.take(step);
    })?;
    let path = match builder.finish() {
        Ok(path) => path,
        Err(error) => {
            let message = format!("{shown} gives {error}");
            let hint = "a larger step, or a part of the program";
            places.problem("program.step_mm", message, hint);
            return Ok(None);
        }
    };
    if path.points.is_empty() {
        let message = format!("{shown} has no cutting move");
        places.problem("program.file", message, "rapids alone cut nothing");
        return Ok(None);
    }
    if table.spin == Some(SpinName::Given)
        && let Some(silent) = path.points.iter().find(|point| point.spin.is_none())
    {
        let message = format!("{shown}: line {} tells no spin", silent.line);
        let hint =
            "a CSV tells it in a column `spin_deg`; for other programs: spin = \"fixed\" or \"along-feed\"";
        places.problem("program.spin", message, hint);
        return Ok(None);
    }
    if !features_have_points(places, table, &path.points) {
        return Ok(None);
    }
    Ok(Some((path, summary)))
}

/// Where the program lies, and how the tool is turned on it.
///
/// Without `tool_axis` and `spin` the tool points where the program says, and keeps one turn about its axis.
pub(in crate::file) fn placing(table: &ProgramTable, base_from_part: &Isometry) -> Placing {
    let part_from_path = table
        .part_from_path_mm_deg
        .as_ref()
        .map_or_else(Isometry::identity, pose_mm_deg);
    let spin = table.spin_deg.unwrap_or(0.0).to_radians();
    Placing {
        base_from_path: base_from_part * part_from_path,
        axis: part_from_path.rotation.inverse() * Vector3::z_axis(),
        keeps_axis: table.tool_axis == Some(ToolAxisName::Normal),
        spin: match table.spin {
            None | Some(SpinName::Fixed) => Spin::Fixed(spin),
            Some(SpinName::AlongFeed) => Spin::AlongFeed(spin),
            Some(SpinName::Given) => Spin::Given(spin),
        },
    }
}

/// The text of a file that the study names by `key`; `None` where it cannot be read, told at its place.
fn text_of(places: &mut Places<'_>, key: &str, path: &Path) -> Option<String> {
    let tell = |error: std::io::Error| {
        let message = format!("cannot read {}: {error}", path.display());
        places.problem(key, message, BESIDE_STUDY);
    };
    std::fs::read_to_string(path).map_err(tell).ok()
}

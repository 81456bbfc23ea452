//! The keys of the study file for a program that a path follows.

use armill_formats::toolpath::gcode::Rotaries;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::analysis::path::drill::DrillTable;
use crate::analysis::path::feature::FeatureTable;
use crate::analysis::path::measured::MeasuredTable;

/// A program that the tool follows.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProgramTable {
    /// Its file, relative to the study: G-code, APT-CL or CLSF, a CSV of points, or a robot program (KRL, RAPID,
    /// INFORM, TP, URScript; of VAL3 the folder).
    pub file: String,
    /// Unit of lengths, if the file does not specify it.
    pub unit: Option<UnitName>,
    /// Dialect of the cutter locations (APT, CLSF), if the file does not show it.
    pub dialect: Option<DialectName>,
    /// Meaning of the rotary words of G-code.
    pub rotaries: Option<RotariesName>,
    /// Tool table of the machine of the G-code, in the format of LinuxCNC, relative to the study.
    pub tool_table: Option<String>,
    /// Its origin in the part frame (z = outward normal of the plane, origin at its centre): x, y, z in mm,
    /// then rotations about the fixed axes x, y, z in degrees.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub part_from_path_mm_deg: Option<[f64; 6]>,
    /// Robot programs: the frame that the program calls by its number, as in the controller: x, y, z in mm,
    /// then rotations about the fixed axes x, y, z in degrees.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub frame_mm_deg: Option<[f64; 6]>,
    /// Robot programs: straight and circular moves faster than this do not cut, as joint moves do not.
    #[schemars(range(min = 0.0, max = 1e9))]
    pub cuts_up_to_mm_per_min: Option<f64>,
    /// Direction of the tool.
    pub tool_axis: Option<ToolAxisName>,
    /// Spin of the tool about its axis.
    pub spin: Option<SpinName>,
    /// Additional spin.
    #[schemars(range(min = -360.0, max = 360.0))]
    pub spin_deg: Option<f64>,
    /// Largest distance of a chord from its arc; 0.01 if left out.
    #[schemars(range(max = 1e3))]
    pub chord_error_mm: Option<f64>,
    /// Longest distance between points; 1 if left out.
    #[schemars(range(max = 1e6))]
    pub step_mm: Option<f64>,
    /// Whether force, depth, width and feed that meet the tolerance are reported; true if left out.
    pub limits: Option<bool>,
    /// Ranges of lines of the program that make a feature.
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

/// Dialects of cutter locations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum DialectName {
    /// Siemens NX: a GOTO without tool axis keeps the one before.
    Nx,
    /// SolidWorks CAM: a GOTO without tool axis means 0,0,1.
    SolidWorks,
}

/// Meaning of rotary words, from the frame of the machine outwards.
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
    pub fn rotaries(self) -> Rotaries {
        match self {
            RotariesName::TableAc => Rotaries::table_ac(),
            RotariesName::TableBc => Rotaries::table_bc(),
            RotariesName::HeadCa => Rotaries::head_ca(),
            RotariesName::HeadCb => Rotaries::head_cb(),
        }
    }
}

/// Direction of the tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ToolAxisName {
    /// As in the program; opposite to the normal of the plane if the program has no tool axis.
    Program,
    /// Always opposite to the normal of the plane.
    Normal,
}

/// Spin of the tool about its axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SpinName {
    /// Constant.
    Fixed,
    /// With the feed.
    AlongFeed,
    /// As the program specifies at each point: column `spin_deg` of a CSV, the orientations of a robot program.
    Given,
}

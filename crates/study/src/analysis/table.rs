//! `[[analysis]]` of the study file: its kind, and the values that replace those of the study.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::analysis::holes::table::HolesTable;
use crate::analysis::path::cut::CutTable;
use crate::analysis::path::machined_part::MachinedPartTable;
use crate::analysis::path::program_table::ProgramTable;
use crate::analysis::path::shape_tables::{CircleTable, LineTable, RectangleTable};
use crate::analysis::volume::table::BoxTable;
use crate::input::tables::{LoadTable, PlaneChange, PostureTable, ToolTable};

/// Kind of an analysis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum AnalysisKind {
    /// The deviation over the plane.
    #[default]
    Map,
    /// Maps over a series of distances or tilts.
    Sections,
    /// The deviation in a box.
    Volume,
    /// The deviation along a path: a shape on the plane, or a tool path program.
    Path,
    /// The deviation at holes in any order, each with a posture of its own.
    Holes,
}

/// One analysis; values that it leaves out are those of the study.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AnalysisTable {
    /// `map`, `sections`, `volume`, `path` or `holes`.
    pub kind: AnalysisKind,
    /// Name of the answer; made from kind and number if left out.
    pub name: Option<String>,
    /// Changes to the plane.
    pub plane: Option<PlaneChange>,
    /// Another tool.
    pub tool: Option<ToolTable>,
    /// Another load.
    pub load: Option<LoadTable>,
    /// Another reference frame.
    pub base: Option<String>,
    /// Another tolerance.
    #[schemars(range(min = 0.0, max = 1e9))]
    pub tolerance_um: Option<f64>,
    /// Another posture.
    pub posture: Option<PostureTable>,
    /// Sections: the x coordinate of the plane's centre, one for each section.
    #[schemars(length(max = 1000), inner(range(min = -1e6, max = 1e6)))]
    pub distances_mm: Option<Vec<f64>>,
    /// Sections: the tilt of the plane, one for each section.
    #[schemars(length(max = 1000), inner(range(min = -360.0, max = 360.0)))]
    pub tilts_deg: Option<Vec<f64>>,
    /// Volume: the box of points.
    #[serde(rename = "box")]
    pub in_box: Option<BoxTable>,
    /// Path: a full circle.
    pub circle: Option<CircleTable>,
    /// Path: a straight line.
    pub line: Option<LineTable>,
    /// Path: straight segments through points (y', z').
    #[schemars(inner(inner(range(min = -1e6, max = 1e6))))]
    pub polyline_mm: Option<Vec<[f64; 2]>>,
    /// Path: a rectangle.
    pub rectangle: Option<RectangleTable>,
    /// Path: greatest distance between points along it.
    #[schemars(range(max = 1e6))]
    pub step_mm: Option<f64>,
    /// Path: another cut.
    pub cut: Option<CutTable>,
    /// Path: spin of the tool about its axis on a shape; for a program use `program.spin_deg`.
    #[schemars(range(min = -360.0, max = 360.0))]
    pub spin_deg: Option<f64>,
    /// Path: spin of the tool that changes along it, in addition to the constant one: points (distance along the path,
    /// spin), linear between them.
    #[schemars(length(max = 1000), inner(inner(range(min = -1e9, max = 1e9))))]
    pub spin_curve_mm_deg: Option<Vec<[f64; 2]>>,
    /// Path: a tool path program, and how the tool follows it; holes: those that it drills.
    pub program: Option<ProgramTable>,
    /// Path: the part that the tool leaves of its stock, with the deviation of its surface.
    pub machined_part: Option<MachinedPartTable>,
    /// Holes: a list of them.
    pub holes: Option<HolesTable>,
}

impl AnalysisKind {
    /// Its word in a study.
    pub fn name(self) -> &'static str {
        match self {
            AnalysisKind::Map => "map",
            AnalysisKind::Sections => "sections",
            AnalysisKind::Volume => "volume",
            AnalysisKind::Path => "path",
            AnalysisKind::Holes => "holes",
        }
    }

    /// What one of this kind is called in a sentence.
    pub fn noun(self) -> &'static str {
        match self {
            AnalysisKind::Holes => "set of holes",
            other => other.name(),
        }
    }
}

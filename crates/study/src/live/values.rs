//! The settings that an analysis resolves to: initial values for the controls of a page.
//!
//! Values are those of the analysis if it gives them, else those of the study, else the defaults.

use armill_core::robot::Branch;
use armill_core::units::to_mm;
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::resolve::plane_of;
use crate::analysis::table::AnalysisTable;
use crate::error::StudyError;
use crate::file::format::StudyFile;
use crate::input::tables::HalfSize;
use crate::live::process::ProcessValues;
use crate::live::scene::{PlateInScene, half_of};
use crate::live::{EditedAnalysis, StudyText};
use crate::naming::references;
use crate::number::without_rounding;

/// Every setting of one analysis; `null` if it has none.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ValuesAnswer {
    /// Name of the analysis.
    pub analysis: String,
    /// `map`, `sections`, `volume`, `path` or `holes`.
    pub kind: &'static str,
    /// The robot, as the study names it.
    pub robot: String,
    /// Reference frame of coordinates.
    pub base: String,
    /// Available reference frames.
    pub bases: Vec<String>,
    /// Centre of the plane; of a volume with a centre of its own that of its box.
    pub centre_mm: [f64; 3],
    /// The key that gives it: `plane.centre_mm` or `box.centre_mm`.
    pub centre_key: &'static str,
    /// Its tilt; `null` if it is given by `rotation_deg`.
    pub tilt_deg: Option<f64>,
    /// Its rotation; `null` if it is given by its tilt.
    pub rotation_deg: Option<[f64; 3]>,
    /// Half its sides along y' and z'.
    pub half_size_mm: [f64; 2],
    /// Pitch of its grid; of a path that of its points.
    pub step_mm: f64,
    /// Flange to tool centre point, as in the file.
    pub flange_from_tool_mm_deg: [f64; 6],
    /// Distance of the TCP from the flange.
    pub tool_length_mm: f64,
    /// Axes of the forces; `null` if they come with a cut.
    pub load_frame: Option<&'static str>,
    /// Forces on the tool, one a case.
    pub cases_n: Vec<[f64; 3]>,
    /// The cut or drill that the load comes from; `null` of another load.
    pub process: Option<ProcessValues>,
    /// The tolerance.
    pub tolerance_um: f64,
    /// Requested posture as in the file: words of a branch, `nominal` or `best`.
    pub branch: String,
    /// The branch that this means.
    pub branch_meant: String,
    /// Names of branches that the robot has; none if they have no names.
    pub branches: Vec<String>,
    /// Spin of the tool about its axis; of paths alone.
    pub spin_deg: Option<f64>,
    /// The curve that is added to it along a path, if there is one.
    pub spin_curve_mm_deg: Option<Vec<[f64; 2]>>,
    /// Sections: the x coordinate of the plane's centre, one a section.
    pub distances_mm: Option<Vec<f64>>,
    /// Sections: the tilt of the plane, one a section.
    pub tilts_deg: Option<Vec<f64>>,
    /// Volume: half the sides of the box.
    pub box_half_size_mm: Option<[f64; 3]>,
    /// Corners of the plane, base, in order round it.
    pub plane_corners_mm: [[f64; 3]; 4],
}

/// The settings of this analysis, or of the first.
///
/// # Errors
/// Every problem of the text that concerns the analysis; no analysis of that name.
pub fn values(text: StudyText<'_>, analysis: Option<&str>) -> Result<ValuesAnswer, StudyError> {
    values_of(&text.one_analysis(analysis)?)
}

/// The settings of this analysis.
pub(super) fn values_of(edited: &EditedAnalysis<'_>) -> Result<ValuesAnswer, StudyError> {
    let (file, table) = (&edited.parsed.file, &edited.table);
    let setting = edited.setting(0)?;
    let robot = &edited.study.robot.robot;
    let plane = plane_of(&file.plane, table);
    let half_size_mm = match plane.half_size_mm {
        HalfSize::Square(half) => [half; 2],
        HalfSize::Oblong(halves) => halves,
    };
    let tool = table.tool.as_ref().or(file.tool.as_ref());
    let load = table.load.as_ref().or(file.load.as_ref());
    let of_box = table.in_box.as_ref().and_then(|of| of.centre_mm);
    let upright = plane.rotation_deg.is_none();
    Ok(ValuesAnswer {
        kind: table.kind.name(),
        robot: file.robot.clone(),
        base: setting.base_name.clone(),
        bases: references(robot).into_iter().map(str::to_owned).collect(),
        centre_mm: of_box.unwrap_or(plane.centre_mm),
        centre_key: match of_box {
            Some(_) => "box.centre_mm",
            None => "plane.centre_mm",
        },
        tilt_deg: upright.then(|| plane.tilt_deg.unwrap_or(0.0)),
        rotation_deg: plane.rotation_deg,
        half_size_mm,
        step_mm: table.step_mm.unwrap_or(plane.step_mm),
        flange_from_tool_mm_deg: tool.map_or([0.0; 6], |tool| tool.flange_from_tool_mm_deg),
        tool_length_mm: without_rounding(to_mm(setting.flange_from_tool.translation.vector.norm())),
        load_frame: load.map(|load| load.frame.map_or("base", |frame| frame.word())),
        cases_n: load.map_or_else(Vec::new, |load| load.cases_n.clone()),
        process: ProcessValues::of(file, table, &edited.study),
        tolerance_um: table.tolerance_um.unwrap_or(file.tolerance_um),
        branch: branch_words(file, table),
        branch_meant: setting.branch(),
        branches: match robot.inverse().has_branches() {
            true => Branch::ALL.iter().map(Branch::to_string).collect(),
            false => Vec::new(),
        },
        spin_deg: spin(table),
        spin_curve_mm_deg: table.spin_curve_mm_deg.clone(),
        distances_mm: table.distances_mm.clone(),
        tilts_deg: table.tilts_deg.clone(),
        box_half_size_mm: table.in_box.as_ref().map(|of| of.half_size_mm),
        plane_corners_mm: PlateInScene::of(setting, half_of(&plane)).corners_mm,
        analysis: edited.name.clone(),
    })
}

/// The posture in the words of the file.
fn branch_words(file: &StudyFile, table: &AnalysisTable) -> String {
    let words = [&table.posture, &file.posture]
        .into_iter()
        .flatten()
        .find_map(|posture| posture.branch.clone());
    words.unwrap_or_else(|| "nominal".to_owned())
}

/// The spin of the tool on a path.
fn spin(table: &AnalysisTable) -> Option<f64> {
    match (&table.program, table.kind) {
        (Some(program), _) => Some(program.spin_deg.unwrap_or(0.0)),
        (None, crate::analysis::table::AnalysisKind::Path) => Some(table.spin_deg.unwrap_or(0.0)),
        _ => None,
    }
}

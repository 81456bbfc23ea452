//! The study file, format 1: TOML, every number with its unit in its name.
//!
//! The in-plane coordinates are y' (along base y on a tilted plane) and z', measured from the centre of the plane.

use armill_core::load::LoadFrame;
use armill_core::source::thermal;
use armill_formats::robot::spring_tables::{MassTable, SpringTable};
use schemars::JsonSchema;
use serde::Deserialize;

use super::circles::BallbarTable;
use super::experiment::ExperimentTable;
use super::holes::HolesTable;
use super::path::cut::CutTable;
use super::path::program::ProgramTable;
use super::placement::PlaceTable;
use super::posture_search::SearchTable;
use crate::compliance_class::ComplianceClass;

/// A study: robot, tool, workpiece plane, load, tolerance and analyses.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudyFile {
    /// Version of the format: 1.
    #[schemars(range(min = 1, max = 1))]
    pub format: u32,
    /// Title of the report.
    pub title: Option<String>,
    /// The question in words, for the report.
    pub question: Option<String>,
    /// Name of a library robot (`armill robots`), or a robot file of any format relative to the study.
    pub robot: String,
    /// The calibrated robot, where its controller uses the nominal model `robot`: specified in the same way.
    pub calibrated_robot: Option<String>,
    /// Reference frame of coordinates: `base_link` (default) or a frame of the robot such as `controller`.
    pub base: Option<String>,
    /// Joint compliances that replace those of the robot file, or provide missing ones.
    pub compliance: Option<ComplianceTable>,
    /// The tool; the bare flange if left out.
    pub tool: Option<ToolTable>,
    /// A turntable or positioner that carries the part; coordinates may then be relative to its frame `table`.
    pub positioner: Option<PositionerTable>,
    /// Gravity on the masses of robot and tool; neglected without this table.
    pub gravity: Option<GravityTable>,
    /// Thermal growth of the links since the calibration of the arm; neglected without this table.
    pub thermal: Option<ThermalTable>,
    /// Load-dependent stiffness: the load acts on the deflected arm instead of the undeflected one.
    #[serde(default)]
    pub load_dependent: bool,
    /// Pose repeatability RP of ISO 9283; replaces that of the robot file.
    #[schemars(range(min = 0.0, max = 30.0))]
    pub repeatability_mm: Option<f64>,
    /// The workpiece plane.
    pub plane: PlaneTable,
    /// The load on the tool; along paths a cut can be given instead.
    pub load: Option<LoadTable>,
    /// The cut: along paths its forces replace the load.
    pub cut: Option<CutTable>,
    /// Largest permitted in-plane deviation.
    #[schemars(range(min = 0.0, max = 1e9))]
    pub tolerance_um: f64,
    /// Posture of the arm.
    pub posture: Option<PostureTable>,
    /// The analyses; one map of the plane if left out.
    #[schemars(length(max = 200))]
    #[serde(default)]
    pub analysis: Vec<AnalysisTable>,
    /// Permitted placements of the part, for `armill place`.
    pub place: Option<PlaceTable>,
    /// Measurements of one circle, to compare with the prediction.
    pub measured: Option<ExperimentTable>,
    /// Circular tests without load on circles of the study, to estimate the backlash of the joints.
    #[schemars(length(max = 100))]
    #[serde(default)]
    pub ballbar: Vec<BallbarTable>,
    /// Published figures by others, to compare with these results.
    #[schemars(length(max = 1000))]
    #[serde(default)]
    pub statement: Vec<StatementTable>,
}

/// A turntable or positioner that carries the part.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PositionerTable {
    /// Its chain: a robot file of any format relative to the study; the table is its flange.
    pub robot: String,
    /// Its position: base_link of the robot to its own root, x, y, z in mm, then rotations about the fixed axes x, y, z
    /// in degrees.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub base_from_root_mm_deg: [f64; 6],
    /// Its joint positions, one for each joint; mm for prismatic joints.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub joints_deg: Vec<f64>,
}

/// Joint compliances given by the study: one for each joint, or those of a class.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ComplianceTable {
    /// One for each joint, base to flange.
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    pub rad_per_n_m: Option<Vec<f64>>,
    /// Standard uncertainty, one for each joint.
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    pub u_rad_per_n_m: Option<Vec<f64>>,
    /// Assumed values by payload in place of `rad_per_n_m`: light (to 20 kg), medium (to 100 kg), heavy (to 300 kg).
    pub class: Option<ComplianceClass>,
    /// Source of the values.
    pub source: Option<String>,
    /// Whether they are assumed: every result then states this. Those of a class always are.
    pub assumed: Option<bool>,
}

/// The tool on the flange.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ToolTable {
    /// Flange to tool centre point: x, y, z in mm, then rotations about the fixed axes x, y, z in degrees.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub flange_from_tool_mm_deg: [f64; 6],
    /// Standard uncertainty of the position of the TCP along the tool axis.
    #[schemars(range(min = 0.0, max = 1e3))]
    pub length_u_mm: Option<f64>,
    /// Stick-out of the cutter from its holder; the cutter then bends like a clamped bar.
    #[schemars(range(min = 0.01, max = 1e4))]
    pub stick_out_mm: Option<f64>,
    /// Diameter of the cutter's core.
    #[schemars(range(min = 0.01, max = 1e3))]
    pub diameter_mm: Option<f64>,
    /// Material of the cutter.
    pub material: Option<CutterMaterial>,
    /// Young's modulus of the cutter, in place of its material.
    #[schemars(range(min = 1.0, max = 2e3))]
    pub modulus_gpa: Option<f64>,
    /// Compliances of holder, spindle and tool; `at` is `flange` or `tool`.
    #[serde(default)]
    pub spring: Vec<SpringTable>,
    /// Spindle and payload, if gravity is included.
    #[serde(default)]
    pub mass: Vec<MassTable>,
}

/// Material of a cutter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum CutterMaterial {
    /// Cemented carbide, 600 GPa.
    Carbide,
    /// High-speed steel, 215 GPa.
    Hss,
}

/// Gravity: only the change of the sag relative to the posture where the tool was set is included.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GravityTable {
    /// Joint positions when the tool was set (mm for prismatic joints), in the convention of the robot file.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub reference_joints_deg: Vec<f64>,
    /// Direction of gravity in base, of any length; down the z axis if left out.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub direction: Option<[f64; 3]>,
}

/// Thermal growth of the links: the robot is warmer or colder than when it was calibrated, and its controller does not know
/// it. Tool and part do not grow.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ThermalTable {
    /// Temperature of the robot minus that of its calibration.
    #[schemars(range(min = -100.0, max = 100.0))]
    pub difference_k: f64,
    /// Coefficient of linear thermal expansion of the links; that of steel if left out.
    #[schemars(range(min = 0.0, max = 1e-4))]
    #[serde(default = "steel")]
    pub expansion_per_k: f64,
    /// Standard uncertainty of the temperature difference; 0 if left out.
    #[schemars(range(min = 0.0, max = 100.0))]
    #[serde(default)]
    pub u_k: f64,
}

fn steel() -> f64 {
    thermal::STEEL
}

/// The workpiece plane and its grid of points.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlaneTable {
    /// Centre of the plane.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub centre_mm: [f64; 3],
    /// Tilt from the vertical about base y: 0 faces the robot, 90 faces up. 0 if left out.
    #[schemars(range(min = -180.0, max = 180.0))]
    pub tilt_deg: Option<f64>,
    /// Rotation of the part frame (z = outward normal) about the fixed axes x, y, z, in place of `tilt_deg`.
    pub rotation_deg: Option<[f64; 3]>,
    /// Half the side of the plane, or both along y' and z'.
    pub half_size_mm: HalfSize,
    /// Pitch of the grid.
    #[schemars(range(max = 1e6))]
    pub step_mm: f64,
}

/// One half side, or two.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum HalfSize {
    /// The same along y' and z'.
    Square(f64),
    /// Along y' and z'.
    Oblong([f64; 2]),
}

/// Keys of a plane that one analysis changes.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlaneChange {
    /// See `plane.centre_mm`.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub centre_mm: Option<[f64; 3]>,
    /// See `plane.tilt_deg`.
    #[schemars(range(min = -180.0, max = 180.0))]
    pub tilt_deg: Option<f64>,
    /// See `plane.rotation_deg`.
    pub rotation_deg: Option<[f64; 3]>,
    /// See `plane.half_size_mm`.
    pub half_size_mm: Option<HalfSize>,
    /// See `plane.step_mm`.
    #[schemars(range(max = 1e6))]
    pub step_mm: Option<f64>,
}

/// Load cases, each of which may act at every point.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadTable {
    /// Axes of the components: `base` (default), `part` (z = outward normal), or along a program `feed` (x along the
    /// feed, y to the left, z from the tip towards the spindle).
    pub frame: Option<LoadFrameName>,
    /// Force on the tool, x, y, z, one for each case.
    #[schemars(inner(inner(range(min = -1e9, max = 1e9))))]
    pub cases_n: Vec<[f64; 3]>,
    /// Moment on the tool about the TCP, one for each case.
    #[schemars(inner(inner(range(min = -1e9, max = 1e9))))]
    pub moments_n_m: Option<Vec<[f64; 3]>>,
    /// Standard uncertainty of the size of all cases, fully correlated.
    #[schemars(range(min = 0.0, max = 1e3))]
    pub u_percent: Option<f64>,
    /// Standard uncertainty of each component of the force, in the same axes as the cases; independent.
    #[schemars(inner(range(min = 0.0, max = 1e9)))]
    pub u_n: Option<[f64; 3]>,
    /// Source of the values.
    pub source: Option<String>,
}

/// Axes of the components of a load.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum LoadFrameName {
    /// Base of the robot.
    Base,
    /// Workpiece.
    Part,
    /// Feed.
    Feed,
}

impl LoadFrameName {
    /// The frame in the core.
    pub(crate) fn frame(self) -> LoadFrame {
        match self {
            LoadFrameName::Base => LoadFrame::Base,
            LoadFrameName::Part => LoadFrame::Part,
            LoadFrameName::Feed => LoadFrame::Feed,
        }
    }

    /// Its name in the study.
    pub(crate) fn word(self) -> &'static str {
        match self {
            LoadFrameName::Base => "base",
            LoadFrameName::Part => "part",
            LoadFrameName::Feed => "feed",
        }
    }
}

/// Posture of the arm.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PostureTable {
    /// Words out of `front|back elbow-up|elbow-down flip|no-flip`, or `nominal` (default), or `best`.
    pub branch: Option<String>,
    /// Position of a rail (mm) and preferred positions of redundant joints (deg), one for each joint; if left out, the
    /// middle of their ranges.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub home_deg: Option<Vec<f64>>,
    /// Along paths: search for the best spin of the tool and branch; `branch`, if given, restricts the search.
    pub search: Option<SearchTable>,
}

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
    /// The deviation at holes in any order, each with its best posture.
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
    /// Path: a tool path program, and how the tool follows it; holes: those that it drills.
    pub program: Option<ProgramTable>,
    /// Holes: a list of them.
    pub holes: Option<HolesTable>,
}

/// A box of points along the axes of the reference frame of the study.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxTable {
    /// Centre; that of the plane if left out.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub centre_mm: Option<[f64; 3]>,
    /// Half the sides along x, y, z.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub half_size_mm: [f64; 3],
    /// Pitch.
    #[schemars(range(max = 1e6))]
    pub step_mm: f64,
}

/// A full circle on the plane, starting at its +y' and turning towards z'.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CircleTable {
    /// Centre (y', z'); the plane's centre if left out.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub centre_mm: Option<[f64; 2]>,
    /// Radius.
    #[schemars(range(max = 1e6))]
    pub radius_mm: f64,
}

/// A straight line on the plane.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LineTable {
    /// Start (y', z').
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub from_mm: [f64; 2],
    /// End (y', z').
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub to_mm: [f64; 2],
}

/// A rectangle on the plane, one turn.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RectangleTable {
    /// Centre (y', z'); the plane's centre if left out.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub centre_mm: Option<[f64; 2]>,
    /// Sides along y' and z'.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub size_mm: [f64; 2],
}

/// A published statement about the same quantity.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StatementTable {
    /// The statement in words.
    pub text: String,
    /// Where it was published.
    pub source: String,
    /// The stated bound of the in-plane deviation.
    #[schemars(range(min = 0.0, max = 1e9))]
    pub at_most_um: f64,
    /// Names of the maps or paths that it may refer to.
    pub of: Vec<String>,
}

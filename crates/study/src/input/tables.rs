//! Tables of the study file that every analysis may use: tool, plane, load, posture, gravity, thermal growth.
//!
//! The in-plane coordinates are y' (along base y on a tilted plane) and z', measured from the centre of the plane.

use armill_core::load::LoadFrame;
use armill_core::source::thermal;
use armill_formats::robot::spring_tables::{MassTable, SpringTable};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::input::cell::tables::ToolBodyTable;
use crate::input::posture_search::SearchTable;

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
    /// Bodies of spindle, holder and cutter, for the clearance.
    #[schemars(length(max = 100))]
    #[serde(default)]
    pub body: Vec<ToolBodyTable>,
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

/// Thermal growth of the links: the robot is warmer or colder than when it was calibrated, and its controller does not
/// know it. Tool and part do not grow.
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
    #[schemars(inner(inner(range(min = -1e6, max = 1e6))))]
    pub cases_n: Vec<[f64; 3]>,
    /// Moment on the tool about the TCP, one for each case.
    #[schemars(inner(inner(range(min = -1e6, max = 1e6))))]
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
    pub fn frame(self) -> LoadFrame {
        match self {
            LoadFrameName::Base => LoadFrame::Base,
            LoadFrameName::Part => LoadFrame::Part,
            LoadFrameName::Feed => LoadFrame::Feed,
        }
    }

    /// Its name in the study.
    pub fn word(self) -> &'static str {
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

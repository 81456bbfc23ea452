//! The study file, format 1: TOML, every number with its unit in its name.

use armill_formats::controller::ControllerTable;
use armill_formats::motion::MotionTable;
use schemars::JsonSchema;
use serde::Deserialize;

use super::circles::BallbarTable;
use super::experiment::ExperimentTable;
use super::placement::PlaceTable;
use crate::analysis::path::cut::CutTable;
use crate::analysis::study_tables::StudyTables;
use crate::analysis::table::AnalysisTable;
use crate::compliance_class::ComplianceClass;
use crate::input::cell::bodies::CellTables;
use crate::input::cell::tables::{FloorTable, ObstacleTable, PartTable, PedestalTable};
use crate::input::improvement::ImprovementTable;
use crate::input::stiffness::StiffnessTables;
use crate::input::tables::{GravityTable, LoadTable, PlaneTable, PostureTable, ThermalTable, ToolTable};
use crate::input::vibration::VibrationTable;

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
    /// Bodies that stand in the cell, for the clearance.
    #[schemars(length(max = 1000))]
    #[serde(default)]
    pub obstacle: Vec<ObstacleTable>,
    /// What the robot stands on, for the clearance; moved with the robot by a rail.
    pub pedestal: Option<PedestalTable>,
    /// The floor, for the clearance.
    pub floor: Option<FloorTable>,
    /// The part or its stock, for the clearance: only a cutter may touch it.
    pub part: Option<PartTable>,
    /// Least distance of the arm and its tool from all bodies, and from themselves; postures that do not keep it are not used. If left out,
    /// bodies must not touch.
    #[schemars(range(min = 0.0, max = 1e4))]
    pub least_clearance_mm: Option<f64>,
    /// A turntable or positioner that carries the part; coordinates may then be relative to its frame `table`.
    pub positioner: Option<PositionerTable>,
    /// The robot holds the part, and the tool stands in the cell; coordinates are then relative to the flange.
    pub part_in_hand: Option<PartInHandTable>,
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
    /// The least improvement for which a change of posture or placement is proposed.
    pub improvement: Option<ImprovementTable>,
    /// Posture of the arm.
    pub posture: Option<PostureTable>,
    /// The analyses; one map of the plane if left out.
    #[schemars(length(max = 200))]
    #[serde(default)]
    pub analysis: Vec<AnalysisTable>,
    /// How robot programs are written; replaces values of the robot file.
    pub controller: Option<ControllerTable>,
    /// What the controller makes of paths: speeds, times, rounded corners; replaces values of the robot file. Without this table the
    /// programmed feed is assumed.
    pub motion: Option<MotionTable>,
    /// Asks for the lowest mode of the arm and the stable depth of cut at each point; without this table neither is computed.
    pub vibration: Option<VibrationTable>,
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

impl StudyFile {
    /// What is about the cell, for the analyses of these tables.
    pub fn cell_tables(&self, analyses: &[AnalysisTable]) -> CellTables<'_> {
        let mut tools = analyses
            .iter()
            .filter_map(|analysis| analysis.tool.as_ref())
            .chain(&self.tool);
        CellTables {
            obstacles: &self.obstacle,
            pedestal: self.pedestal.as_ref(),
            floor: self.floor,
            part: self.part.as_ref(),
            plane: &self.plane,
            least_clearance_mm: self.least_clearance_mm,
            robot: &self.robot,
            tool_has_bodies: tools.any(|tool| !tool.body.is_empty()),
        }
    }

    /// What every analysis has unless it replaces it.
    pub fn common(&self) -> StudyTables<'_> {
        StudyTables {
            base: self.base.as_deref(),
            tool: self.tool.as_ref(),
            plane: &self.plane,
            load: self.load.as_ref(),
            cut: self.cut.as_ref(),
            posture: self.posture.as_ref(),
            tolerance_um: self.tolerance_um,
            improvement: self.improvement,
            motion: None,
            vibration: self.vibration.as_ref(),
            rapid: ControllerTable::default().rapid(),
            stiffness: StiffnessTables {
                gravity: self.gravity.as_ref(),
                thermal: self.thermal.as_ref(),
                load_dependent: self.load_dependent,
                repeatability_mm: self.repeatability_mm,
            },
        }
    }
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
    /// Its joint positions, one for each joint; mm for prismatic joints. A search may move them.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub joints_deg: Vec<f64>,
    /// Masses of part, stock and fixture on its table, for gravity.
    #[serde(default)]
    pub mass: Vec<TableMassTable>,
}

/// The robot holds the part, and the tool stands in the cell.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PartInHandTable {
    /// Where the tool stands: base_link of the robot to the mount of the tool, from which `flange_from_tool_mm_deg` of the
    /// tool goes on; x, y, z in mm, then rotations about the fixed axes x, y, z in degrees.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub base_from_mount_mm_deg: [f64; 6],
    /// Masses of gripper and part on the flange, for gravity.
    #[serde(default)]
    pub mass: Vec<TableMassTable>,
}

/// A mass on the table of a positioner, or in the hand of the robot.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TableMassTable {
    /// Mass.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub mass_kg: f64,
    /// Centre of mass in the frame of the table, or of the flange.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub centre_mm: [f64; 3],
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

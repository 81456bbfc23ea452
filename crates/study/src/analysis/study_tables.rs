//! What a study gives to every analysis.

use armill_formats::motion::MotionTable;

use crate::analysis::path::cut::CutTable;
use crate::input::improvement::ImprovementTable;
use crate::input::stiffness::StiffnessTables;
use crate::input::tables::{LoadTable, PlaneTable, PostureTable, ToolTable};
use crate::input::vibration::VibrationTable;

/// What the study gives to every analysis, as written.
#[derive(Clone, Copy, Debug)]
pub struct StudyTables<'a> {
    /// Reference frame of coordinates.
    pub base: Option<&'a str>,
    /// The tool.
    pub tool: Option<&'a ToolTable>,
    /// The plane.
    pub plane: &'a PlaneTable,
    /// The load.
    pub load: Option<&'a LoadTable>,
    /// The cut.
    pub cut: Option<&'a CutTable>,
    /// The posture.
    pub posture: Option<&'a PostureTable>,
    /// The tolerance.
    pub tolerance_um: f64,
    /// The least improvement that counts.
    pub improvement: Option<ImprovementTable>,
    /// How the controller moves the arm, with the values of the robot file; none if motions are not requested.
    pub motion: Option<&'a MotionTable>,
    /// What is asked of the vibration at each point.
    pub vibration: Option<&'a VibrationTable>,
    /// Speed of rapids, m/s.
    pub rapid: f64,
    /// Parts of the stiffness model.
    pub stiffness: StiffnessTables<'a>,
}

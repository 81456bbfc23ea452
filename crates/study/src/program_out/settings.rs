//! How a program is to be: from the command and the table `controller`.

use armill_core::units::{from_mm, from_um};
use armill_formats::controller::{ControllerTable, FrameDataName};
use armill_programs::{Controller, FrameData, Language};

/// How the program is to be.
#[derive(Clone, Debug, PartialEq)]
pub struct ProgramSettings {
    /// In which language.
    pub language: Language,
    /// What it is called.
    pub name: String,
    /// Number of the user frame on the controller; that of `controller` if not given.
    pub frame_number: Option<u32>,
    /// Number of the tool on the controller; that of `controller` if not given.
    pub tool_number: Option<u32>,
    /// Greatest distance of linear moves between their points from the path, m.
    pub within: f64,
    /// Greatest distance of rounded corners from the linear moves, m.
    pub rounding: f64,
    /// Height above the part to which the tool retracts where the path has no rapids, m.
    pub retract: f64,
    /// Greatest distance from a point at which approximate positioning begins, m.
    pub blend: f64,
    /// Feed if the path does not specify it, m/s.
    pub feed: Option<f64>,
}

impl ProgramSettings {
    /// Default distance of linear moves and rounded corners from the path, um.
    pub const USUAL_WITHIN_UM: f64 = 5.0;
    /// Default height of retraction where the path has no rapids, mm.
    pub const USUAL_RETRACT_MM: f64 = 50.0;
    /// Default distance at which approximate positioning begins, mm.
    pub const USUAL_BLEND_MM: f64 = 5.0;

    /// The defaults in this language, for a program of this name.
    pub fn usual(language: Language, name: &str) -> ProgramSettings {
        ProgramSettings {
            language,
            name: name.to_owned(),
            frame_number: None,
            tool_number: None,
            within: from_um(ProgramSettings::USUAL_WITHIN_UM),
            rounding: from_um(ProgramSettings::USUAL_WITHIN_UM),
            retract: from_mm(ProgramSettings::USUAL_RETRACT_MM),
            blend: from_mm(ProgramSettings::USUAL_BLEND_MM),
            feed: None,
        }
    }
}

/// The controller of the cell; numbers of the command replace those of the table.
pub(super) fn controller(table: &ControllerTable, requested: &ProgramSettings) -> Controller {
    let default = Controller::default();
    let percent = |value: f64| value / 100.0;
    Controller {
        frame_number: requested
            .frame_number
            .or(table.frame)
            .unwrap_or(default.frame_number),
        tool_number: requested
            .tool_number
            .or(table.tool)
            .unwrap_or(default.tool_number),
        frame_name: table.frame_name.clone(),
        tool_name: table.tool_name.clone(),
        positioner_unit: table.positioner_unit.clone(),
        data: match table.data {
            Some(FrameDataName::Controller) => FrameData::Controller,
            Some(FrameDataName::Program) | None => FrameData::Program,
        },
        joint_speed: table.joint_speed_percent.map_or(default.joint_speed, percent),
        joint_acceleration: table.joint_acceleration_percent.map(percent),
        acceleration: table.acceleration_m_per_s2,
        header: table.header.clone().unwrap_or_default(),
        footer: table.footer.clone().unwrap_or_default(),
    }
}

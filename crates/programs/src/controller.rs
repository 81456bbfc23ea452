//! How programs of a cell are written: numbers and names of frame and tool, speeds, statements of its own.

/// Where the values of frame and tool come from when the program runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FrameData {
    /// The program sets them.
    #[default]
    Program,
    /// They are stored on the controller, and the program selects them by number or name.
    Controller,
}

/// How programs of a cell are written. Speeds and accelerations in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Controller {
    /// Number of the user frame.
    pub frame_number: u32,
    /// Number of the tool.
    pub tool_number: u32,
    /// Name of the user frame, in languages that have names.
    pub frame_name: Option<String>,
    /// Name of the tool, in languages that have names.
    pub tool_name: Option<String>,
    /// The mechanical unit of the positioner: its name in RAPID, the number of its MACHINE_DEF in KRL.
    pub positioner_unit: Option<String>,
    /// Where the values of frame and tool come from.
    pub data: FrameData,
    /// Speed of joint moves relative to the maximum, 0.01 to 1.
    pub joint_speed: f64,
    /// Acceleration of joint moves relative to the maximum, 0.01 to 1; that of the controller if not given.
    pub joint_acceleration: Option<f64>,
    /// Acceleration of linear moves, m/s^2; that of the controller if not given.
    pub acceleration: Option<f64>,
    /// Statements before the first move, in the language of the program, each one line of ASCII characters.
    pub header: Vec<String>,
    /// Statements after the last move.
    pub footer: Vec<String>,
}

impl Default for Controller {
    /// Frame and tool 1, set by the program; joint moves at 10 % of the maximum speed.
    fn default() -> Controller {
        Controller {
            frame_number: 1,
            tool_number: 1,
            frame_name: None,
            tool_name: None,
            positioner_unit: None,
            data: FrameData::Program,
            joint_speed: 0.1,
            joint_acceleration: None,
            acceleration: None,
            header: Vec::new(),
            footer: Vec::new(),
        }
    }
}

impl Controller {
    /// Speed or acceleration as a whole percentage, at least 1.
    pub(super) fn percent(part: f64) -> u32 {
        (part * 100.0).round().clamp(1.0, 100.0) as u32
    }

    /// Whether the program sets frame and tool.
    pub(super) fn sets_data(&self) -> bool {
        self.data == FrameData::Program
    }
}

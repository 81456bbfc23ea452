//! What a controller does when it runs a program: one list for all languages.

use crate::pose::Pose;
use crate::source::Place;

/// One action and the statement that caused it.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    pub place: Place,
    pub action: Action,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    Joint(JointMove),
    Linear(LinearMove),
    Circular {
        /// A pose between start and end.
        via: Pose,
        end: LinearMove,
    },
    Output {
        /// As the language writes it: `$OUT[5]`, `do_spindle`, `OT#(3)`, `DO[5]`, `digital_out[0]`, `doSpindle[0]`.
        name: String,
        /// `TRUE`, `FALSE` or a number, whatever the language's words are (`ON`, 1, high).
        value: String,
        /// The last move has possibly not ended when the output changes.
        moving: bool,
    },
    /// The program waits for the operator.
    Stop {
        /// Messages directly before the stop.
        message: Option<String>,
    },
    Dwell {
        s: f64,
    },
    /// The program waits for an input.
    Wait {
        condition: String,
    },
    /// A call of a routine that is not in the files.
    Call {
        name: String,
        arguments: Vec<String>,
    },
    /// A message that does not wait.
    Message {
        text: String,
    },
    Comment {
        text: String,
    },
}

impl Action {
    /// The move on a line.
    pub fn linear(&self) -> Option<&LinearMove> {
        match self {
            Action::Linear(linear) => Some(linear),
            _ => None,
        }
    }
}

/// A move on a straight line, or the end of one on an arc.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearMove {
    /// Tool relative to the base.
    pub to: Pose,
    /// External axes, deg or mm; `None` for an axis that is not used.
    pub external: Vec<Option<f64>>,
    pub base: Reference,
    pub tool: Reference,
    pub speed: Speed,
    pub blend: Blend,
}

#[derive(Clone, Debug, PartialEq)]
pub struct JointMove {
    pub to: JointTarget,
    /// External axes, deg or mm; `None` for an axis that is not used.
    pub external: Vec<Option<f64>>,
    pub base: Reference,
    pub tool: Reference,
    pub speed: Speed,
    pub blend: Blend,
}

#[derive(Clone, Debug, PartialEq)]
pub enum JointTarget {
    /// Axes of the robot, deg or mm.
    Axes(Vec<f64>),
    /// Axes of the robot in pulses of their encoders; pulses per degree differ from robot to robot.
    Pulses(Vec<f64>),
    /// The tool relative to the base.
    Pose { pose: Pose, posture: Posture },
    /// Where the robot is.
    Current,
}

/// Which of the postures of a pose, in the words of the language.
#[derive(Clone, Debug, PartialEq)]
pub enum Posture {
    /// That of the last move.
    Unspecified,
    /// KUKA.
    StatusTurn { status: Option<u32>, turn: Option<u32> },
    /// ABB: cf1, cf4, cf6, cfx.
    Quadrants([f64; 4]),
    /// Yaskawa: RCONF; 0 and 1 by the manual, also turns (-1) in programs of other software.
    Flags(Vec<i32>),
    /// FANUC: the letters, then the turns.
    Config { letters: String, turns: [i32; 3] },
    /// Staubli: shoulder, elbow, wrist.
    Named([String; 3]),
    /// Universal Robots: the solution next to these axes, deg.
    Near(Vec<f64>),
}

/// A frame or tool of the controller.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reference {
    /// Number or name; empty if the program does not set any.
    pub name: String,
    /// Relative to the robot or the flange, if the program gives it; to the table of the unit that moves it.
    pub pose: Option<Pose>,
    /// The mechanical unit that moves it.
    pub unit: Option<String>,
    /// Whether it is on the other side than usual: a tool that stands in the cell, a frame on the flange.
    pub is_swapped: bool,
}

impl Reference {
    pub fn new(name: impl Into<String>, pose: Option<Pose>) -> Reference {
        Reference {
            name: name.into(),
            pose,
            unit: None,
            is_swapped: false,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Speed {
    MmPerS(f64),
    DegPerS(f64),
    /// Of the largest speed.
    Percent(f64),
    /// Duration of the move.
    Seconds(f64),
    /// By a value of the controller.
    Unspecified,
}

/// How a move ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Blend {
    /// In its target, at rest.
    Exact,
    /// Leaves the path at this distance from the target, mm.
    DistanceMm(f64),
    Percent(f64),
    /// Yaskawa: position level, 1 to 8.
    Level(u32),
    /// Approximates the target by a value of the controller.
    Unspecified,
}

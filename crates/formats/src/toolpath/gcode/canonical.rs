//! The canonical calls that a program comes down to: one motion, offset or setting each.
//!
//! Lengths are in the unit of the last `USE_LENGTH_UNITS`, angles in degrees, places in the work coordinate system in
//! force. Their text is that of the interpreter tests of LinuxCNC, so that both can be compared line by line.
//!
//! Source: Kramer, Proctor, Messina, The NIST RS274NGC Interpreter, NISTIR 6556 (2000), section 4; the meaning of
//! the arguments: formats of the LinuxCNC interpreter tests.

use crate::toolpath::LengthUnit;
use std::fmt;

/// X, Y, Z, A, B, C.
pub type Axes = [f64; 6];

/// The plane of arcs, cycles and cutter compensation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Plane {
    /// G17.
    #[default]
    Xy,
    /// G18: first axis Z, second X.
    Zx,
    /// G19.
    Yz,
}

impl Plane {
    /// Indices of its first and second axis and of the axis across; right-handed in this order.
    pub fn axes(self) -> [usize; 3] {
        match self {
            Plane::Xy => [0, 1, 2],
            Plane::Zx => [2, 0, 1],
            Plane::Yz => [1, 2, 0],
        }
    }
}

/// Which way an arc turns in its plane, seen against the axis across.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// G3.
    Counterclockwise,
    /// G2.
    Clockwise,
}

impl Sense {
    /// 1 counterclockwise, -1 clockwise.
    pub fn sign(self) -> i32 {
        match self {
            Sense::Counterclockwise => 1,
            Sense::Clockwise => -1,
        }
    }
}

/// How exactly corners are followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathControl {
    /// G61.
    ExactPath,
    /// G61.1.
    ExactStop,
    /// G64, with its tolerance.
    Continuous(f64),
}

/// An arc or helix in a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArcFeed {
    /// Its plane.
    pub plane: Plane,
    /// End along the first and second axis of the plane.
    pub end: [f64; 2],
    /// Centre along the first and second axis of the plane.
    pub centre: [f64; 2],
    /// Turns, begun ones counted; negative is clockwise.
    pub turns: i32,
    /// End along the axis across.
    pub across: f64,
    /// Ends of A, B, C.
    pub rotary: [f64; 3],
}

impl ArcFeed {
    /// Which way it turns.
    pub fn sense(&self) -> Sense {
        match self.turns > 0 {
            true => Sense::Counterclockwise,
            false => Sense::Clockwise,
        }
    }
}

/// A request of a block to the machine.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum Canonical {
    /// A rapid to this place.
    StraightTraverse(Axes),
    /// A cut along a line to this place.
    StraightFeed(Axes),
    /// A cut along an arc or helix.
    ArcFeed(ArcFeed),
    /// G20, G21: what lengths count in from here on.
    UseLengthUnits(LengthUnit),
    /// Number of the coordinate system, 1 for G54, and its zero in machine coordinates.
    SetG5xOffset(u8, Axes),
    /// Offset of G92 or G52 in force.
    SetG92Offset(Axes),
    /// Turn of the coordinate system about Z, deg.
    SetXyRotation(f64),
    /// G17 to G19.
    SelectPlane(Plane),
    /// Whether feeds are per revolution of the spindle.
    SetFeedMode {
        per_revolution: bool,
    },
    /// Units per minute, or per revolution.
    SetFeedRate(f64),
    /// The feed of this block, given before its new unit, is in the new one. Not a call of NISTIR 6556.
    FeedRateInNewUnit(f64),
    SetMotionControlMode(PathControl),
    /// Q of G64: how far points nearly on a line may be joined.
    SetNaivecamTolerance(f64),
    /// G43 to G49: the offset of the tip in force.
    UseToolLengthOffset(Axes),
    /// G10 L1, L10, L11: offset and diameter of a tool, in the unit of the program.
    SetToolTableEntry {
        tool: u32,
        offset: Axes,
        diameter: f64,
    },
    /// T: the tool that the next change takes.
    SelectTool(u32),
    /// Number of the tool that is in the spindle from here on.
    ChangeTool(u32),
    /// Revolutions per minute.
    SetSpindleSpeed(f64),
    /// M3.
    StartSpindleClockwise,
    /// M4.
    StartSpindleCounterclockwise,
    /// M5; also part of M6, G86, G88 and the end.
    StopSpindleTurning,
    /// G97: turns a minute; also part of the end.
    SetSpindleMode,
    /// M7, M8: mist or flood on; M9: both off. Not a call of NISTIR 6556, which has one for each.
    Coolant {
        on: bool,
    },
    /// Seconds.
    Dwell(f64),
    /// What a comment says to the operator.
    Message(String),
    /// M0, M1, M60, G88: the operator goes on.
    ProgramStop,
    /// M2, M30.
    ProgramEnd,
    /// Tool-centre control: from here on X, Y, Z are the tip in the frame of the part.
    ToolCentreControl {
        on: bool,
    },
    /// The tool axis from tip to spindle, given as a vector of the next move.
    ToolAxis([f64; 3]),
    /// The next move is counted in machine coordinates.
    MachineCoordinates,
}

/// Numbers with four decimals, and their separator.
struct Listed<'a>(&'a [f64], &'a str);

impl fmt::Display for Listed<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, value) in self.0.iter().enumerate() {
            if index > 0 {
                f.write_str(self.1)?;
            }
            write!(f, "{value:.4}")?;
        }
        Ok(())
    }
}

impl fmt::Display for Canonical {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Canonical::StraightTraverse(end) => write!(f, "STRAIGHT_TRAVERSE({})", Listed(end, ", ")),
            Canonical::StraightFeed(end) => write!(f, "STRAIGHT_FEED({})", Listed(end, ", ")),
            Canonical::ArcFeed(arc) => write!(
                f,
                "ARC_FEED({}, {}, {}, {:.4}, {})",
                Listed(&arc.end, ", "),
                Listed(&arc.centre, ", "),
                arc.turns,
                arc.across,
                Listed(&arc.rotary, ", ")
            ),
            Canonical::UseLengthUnits(LengthUnit::Millimetre) => {
                f.write_str("USE_LENGTH_UNITS(CANON_UNITS_MM)")
            }
            Canonical::UseLengthUnits(LengthUnit::Inch) => {
                f.write_str("USE_LENGTH_UNITS(CANON_UNITS_INCHES)")
            }
            Canonical::SetG5xOffset(system, zero) => {
                write!(f, "SET_G5X_OFFSET({system}, {})", Listed(zero, ", "))
            }
            Canonical::SetG92Offset(zero) => write!(f, "SET_G92_OFFSET({})", Listed(zero, ", ")),
            Canonical::SetXyRotation(angle) => write!(f, "SET_XY_ROTATION({angle:.4})"),
            Canonical::SelectPlane(plane) => write!(
                f,
                "SELECT_PLANE(CANON_PLANE_{})",
                match plane {
                    Plane::Xy => "XY",
                    Plane::Zx => "XZ",
                    Plane::Yz => "YZ",
                }
            ),
            Canonical::SetFeedMode { per_revolution } => {
                write!(f, "SET_FEED_MODE(0, {})", i32::from(*per_revolution))
            }
            Canonical::SetFeedRate(rate) => write!(f, "SET_FEED_RATE({rate:.4})"),
            Canonical::FeedRateInNewUnit(rate) => write!(f, "FEED_RATE_IN_NEW_UNIT({rate:.4})"),
            Canonical::SetMotionControlMode(mode) => match mode {
                PathControl::ExactPath => f.write_str("SET_MOTION_CONTROL_MODE(CANON_EXACT_PATH)"),
                PathControl::ExactStop => f.write_str("SET_MOTION_CONTROL_MODE(CANON_EXACT_STOP)"),
                PathControl::Continuous(tolerance) => {
                    write!(f, "SET_MOTION_CONTROL_MODE(CANON_CONTINUOUS, {tolerance:.6})")
                }
            },
            Canonical::SetNaivecamTolerance(tolerance) => write!(f, "SET_NAIVECAM_TOLERANCE({tolerance:.4})"),
            Canonical::UseToolLengthOffset([x, y, z, a, b, c]) => write!(
                f,
                "USE_TOOL_LENGTH_OFFSET({x:.4} {y:.4} {z:.4}, {a:.4} {b:.4} {c:.4}, 0.0000 0.0000 0.0000)"
            ),
            Canonical::SetToolTableEntry {
                tool,
                offset,
                diameter,
            } => write!(
                f,
                "SET_TOOL_TABLE_ENTRY({tool}, {} 0.0000 0.0000 0.0000, {diameter:.4})",
                Listed(offset, " ")
            ),
            Canonical::SelectTool(tool) => write!(f, "SELECT_TOOL({tool})"),
            Canonical::ChangeTool(_) => f.write_str("CHANGE_TOOL()"),
            Canonical::SetSpindleSpeed(speed) => write!(f, "SET_SPINDLE_SPEED(0, {speed:.4})"),
            Canonical::StartSpindleClockwise => f.write_str("START_SPINDLE_CLOCKWISE(0)"),
            Canonical::StartSpindleCounterclockwise => f.write_str("START_SPINDLE_COUNTERCLOCKWISE(0)"),
            Canonical::StopSpindleTurning => f.write_str("STOP_SPINDLE_TURNING(0)"),
            Canonical::SetSpindleMode => f.write_str("SET_SPINDLE_MODE(0 0.0000)"),
            Canonical::Coolant { on } => write!(f, "COOLANT({})", if *on { "ON" } else { "OFF" }),
            Canonical::Dwell(seconds) => write!(f, "DWELL({seconds:.4})"),
            Canonical::Message(text) => write!(f, "MESSAGE(\"{text}\")"),
            Canonical::ProgramStop => f.write_str("PROGRAM_STOP()"),
            Canonical::ProgramEnd => f.write_str("PROGRAM_END()"),
            Canonical::ToolCentreControl { on } => write!(f, "TOOL_CENTRE_CONTROL({on})"),
            Canonical::ToolAxis(axis) => write!(f, "TOOL_AXIS({})", Listed(axis, ", ")),
            Canonical::MachineCoordinates => f.write_str("MACHINE_COORDINATES()"),
        }
    }
}

//! Tool path programs: the moves of the tool tip, one after the other.
//!
//! Readers return [`Step`]s one by one, so a program of any length can be processed without storing all of it. All in
//! the frame of the path: relative to the workpiece zero of the program. m, rad, s.

use nalgebra::{Point3, Unit, UnitQuaternion, Vector3};

/// Next item of a program.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// A new tool or spindle speed.
    Operation(Operation),
    /// A command between two moves.
    Command(Command),
    /// The tip moves.
    Move(Move),
}

/// A command of the program between two moves, other than those of tool and spindle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    /// Coolant on or off, flood or mist.
    Coolant(bool),
    /// The tool rests, s.
    Dwell(f64),
    /// The program stops until the operator continues it.
    Stop,
}

/// A stretch of the program with one tool, one spindle speed and one depth of cut.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Operation {
    /// Name of the operation or its tool.
    pub name: Option<String>,
    /// Number of the tool.
    pub tool: Option<u32>,
    /// Diameter of the cutter, m.
    pub diameter: Option<f64>,
    /// Radius of its corner, m: half the diameter of a ball, none of a flat end mill.
    pub corner_radius: Option<f64>,
    /// Speed of the spindle, rad/s; clockwise seen from the spindle is positive.
    pub spindle: Option<f64>,
    /// Depths of cut, where given in the program.
    pub depths: Option<DepthOfCut>,
    /// Line of the program where it begins, from 1.
    pub line: u32,
}

impl Operation {
    /// Whether the operation after this one has another tool: number, diameter or corner.
    pub(super) fn has_other_tool(&self, next: &Operation) -> bool {
        self.tool != next.tool || self.diameter != next.diameter || self.corner_radius != next.corner_radius
    }
}

/// How deep the cutter is in the material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthOfCut {
    /// Along the tool, m.
    pub axial: f64,
    /// Across the tool and the feed, m.
    pub radial: f64,
}

/// A move of the tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Move {
    /// Where it ends, m.
    pub end: Point3<f64>,
    /// The tool at its end, from the tip towards the spindle; `None` where not given.
    pub axis: Option<Unit<Vector3<f64>>>,
    /// Turn of the tool about its axis at its end; `None` where not given.
    pub spin: Option<GivenSpin>,
    /// Shape of the move.
    pub course: Course,
    /// Speed.
    pub pace: Pace,
    /// Its line in the program, from 1.
    pub line: u32,
}

/// Turn of the tool about its axis, as given in a program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GivenSpin {
    /// By this angle from spin zero, rad, by the right hand about the direction from spindle to tip.
    Angle(f64),
    /// With the whole orientation, path to tool: its z is the direction from spindle to tip.
    Orientation(UnitQuaternion<f64>),
}

/// Shape of a move from the end of the one before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Course {
    /// A straight line.
    Line,
    /// An arc or a helix.
    Arc(Arc),
}

/// An arc about an axis; a difference of start and end along the axis makes it a helix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// A point of the axis, m.
    pub centre: Point3<f64>,
    /// Its direction: the arc turns by the right hand.
    pub axis: Unit<Vector3<f64>>,
    /// By how much, full turns included, rad; positive.
    pub sweep: f64,
}

/// How fast the tip moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// A rapid, not cutting.
    Rapid,
    /// At this speed, m/s.
    Feed(f64),
    /// Cutting, at a speed that the program does not specify.
    Unknown,
}

impl Pace {
    /// Whether the move is a cut.
    pub fn cuts(self) -> bool {
        self != Pace::Rapid
    }

    /// Its speed, m/s, if it is given and not zero.
    pub fn feed(self) -> Option<f64> {
        match self {
            Pace::Feed(speed) if speed > 0.0 => Some(speed),
            _ => None,
        }
    }
}

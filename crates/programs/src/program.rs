//! A program after reading: its moves with their targets, and the position of each target in the text.

use std::ops::Range;

use armill_core::frame::Isometry;
use armill_core::path::Passage;
use armill_core::robot::BranchPattern;
use armill_formats::language::Language;

use super::text::ProgramText;

/// A program of a robot. Lengths m, angles rad, speeds m/s.
#[derive(Clone, Debug)]
pub struct RobotProgram {
    /// Language.
    pub language: Language,
    /// Name in the program.
    pub name: String,
    /// Its moves in the order of the text; control flow is not evaluated.
    pub moves: Vec<RobotMove>,
    /// Notes on ignored statements and assumptions, one sentence each, with line.
    pub notes: Vec<String>,
    /// The files, the main one first.
    pub texts: Vec<ProgramText>,
}

/// A move to a target.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotMove {
    /// Kind of motion.
    pub motion: Motion,
    /// End of the move.
    pub target: Target,
    /// Reference frame of its poses.
    pub frame: Frame,
    /// The tool at its flange: flange to TCP.
    pub tool: Frame,
    /// Speed.
    pub speed: Speed,
    /// How its end is passed.
    pub passage: Passage,
    /// Line number, from 1, in the main file or in the called file that contains it.
    pub line: u32,
}

/// Kind of motion.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// Joint move: the path of the tip is not specified.
    Joint,
    /// The tip moves on a straight line.
    Linear,
    /// The tip moves on an arc through a via point.
    Circular {
        /// Via point.
        via: Target,
    },
}

/// End of a move.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// Pose of the tool.
    Pose {
        /// Frame to tool.
        pose: Isometry,
        /// Posture, as far as it is given.
        branch: BranchPattern,
        /// Turns of the joints as the language numbers them; empty if not given.
        turns: Vec<i32>,
        /// Its position in the text.
        spelled: Spelled,
    },
    /// Joint positions, rad (m for prismatic joints), as the controller reports them.
    Joints(Vec<f64>),
    /// Not in the program: a register of the controller, or pulses of its motors.
    Elsewhere {
        /// Name in the program.
        name: String,
    },
}

/// A target with the frame of its pose and the tool, while a program is read.
#[derive(Clone, Debug)]
pub(super) struct FramedTarget {
    pub target: Target,
    pub frame: Frame,
    pub tool: Frame,
}

impl FramedTarget {
    /// Whether it has the same frame and the same tool.
    pub fn is_framed_like(&self, other: &FramedTarget) -> bool {
        (self.frame, self.tool) == (other.frame, other.tool)
    }

    /// The move to it; the speed of a joint move is not a tip speed.
    pub fn reached(self, motion: Motion, speed: Speed, line: u32) -> RobotMove {
        RobotMove {
            speed: match motion {
                Motion::Joint => Speed::Joints,
                Motion::Linear | Motion::Circular { .. } => speed,
            },
            motion,
            target: self.target,
            frame: self.frame,
            tool: self.tool,
            passage: Passage::Unknown,
            line,
        }
    }
}

/// The bytes of a target in a text, as its language's `spell` writes it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Spelled {
    /// Index of the text.
    pub text: usize,
    /// Byte range in [`ProgramText::text`].
    pub bytes: Range<usize>,
}

/// A frame or a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Frame {
    /// Given by the program: robot base to frame, flange to TCP.
    Given(Isometry),
    /// Stored on the controller under this number.
    Numbered(u32),
    /// Not known.
    Unknown,
}

/// Whether a frame is that of the poses or a tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FrameKind {
    /// The reference frame of poses: base, user frame.
    Reference,
    Tool,
}

/// Speed of a move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Speed {
    /// Of the tip, m/s.
    Tip(f64),
    /// Given for the joints or otherwise, without the tip speed.
    Joints,
    /// Not given in the program.
    Unknown,
}

impl Target {
    /// Its pose, if it is given as one.
    pub fn pose(&self) -> Option<&Isometry> {
        match self {
            Target::Pose { pose, .. } => Some(pose),
            Target::Joints(_) | Target::Elsewhere { .. } => None,
        }
    }
}

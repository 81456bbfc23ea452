//! A program as it was read: its moves with their targets, and where each target is spelled in the text.

use std::ops::Range;

use armill_core::frame::Isometry;
use armill_core::robot::BranchPattern;

use super::language::Language;
use super::text::ProgramText;

/// A program of a robot. Lengths m, angles rad, speeds m/s.
#[derive(Clone, Debug)]
pub struct RobotProgram {
    /// Which language it is written in.
    pub language: Language,
    /// What it calls itself.
    pub name: String,
    /// Its moves in the order in which they are run, branches and loops left aside: as they stand in the text.
    pub moves: Vec<RobotMove>,
    /// What was passed over or taken for granted, each a sentence with its line.
    pub notes: Vec<String>,
    /// The files, the main one first.
    pub texts: Vec<ProgramText>,
}

/// A move to a target.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotMove {
    /// How it goes there.
    pub motion: Motion,
    /// Where to.
    pub target: Target,
    /// What its poses count in.
    pub frame: Frame,
    /// The tool at its flange: flange to TCP.
    pub tool: Frame,
    /// How fast.
    pub speed: Speed,
    /// Line where it stands, from 1: of the main file, or of the called one that holds it.
    pub line: u32,
}

/// How a move goes to its target.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// Each joint on its own: where the tip goes on the way is not told.
    Joint,
    /// The tip goes straight.
    Linear,
    /// The tip goes on a circle through this place.
    Circular {
        /// On the way.
        via: Target,
    },
}

/// Where a move ends.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// The tool stands so.
    Pose {
        /// Frame to tool.
        pose: Isometry,
        /// What is said of the posture.
        branch: BranchPattern,
        /// Which of the joints' turns, as the language numbers them; empty where it says nothing.
        turns: Vec<i32>,
        /// Where it is spelled.
        spelled: Spelled,
    },
    /// The joints stand so, rad (m of a sliding one), as the controller counts them.
    Joints(Vec<f64>),
    /// The program does not tell it: a register of the controller, or pulses of its motors.
    Elsewhere {
        /// What the program calls it.
        name: String,
    },
}

/// The bytes of a text that spell a target, as its language's `spell` writes it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Spelled {
    /// Which of the program's texts.
    pub text: usize,
    /// Which of its bytes, as characters are held in [`ProgramText::text`].
    pub bytes: Range<usize>,
}

/// A frame or a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Frame {
    /// The program tells it: robot base to frame, flange to TCP.
    Told(Isometry),
    /// It stands on the controller under this number.
    Numbered(u32),
    /// Nothing is said of it.
    EvaluateError,
}

/// How fast a move is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Speed {
    /// Of the tip, m/s.
    Tip(f64),
    /// Of the joints, as a part of their greatest; or another that says nothing of the tip.
    Joints,
    /// It is not told in the program.
    EvaluateError,
}

impl Target {
    /// Its pose, if it is told as one.
    pub fn pose(&self) -> Option<&Isometry> {
        match self {
            Target::Pose { pose, .. } => Some(pose),
            Target::Joints(_) | Target::Elsewhere { .. } => None,
        }
    }
}

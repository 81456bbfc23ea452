//! Why a block is refused: one variant for each reason.
//!
//! Messages name the word or code, its value and the limit. Lengths in them are in the unit of the program, which they
//! do not name. The variants contain the limits, so that a message can give the exceeded limit.

use std::fmt;

use thiserror::Error;

/// Why a block is refused.
#[derive(Clone, Debug, Error, PartialEq)]
#[allow(missing_docs)]
pub enum Refusal {
    #[error("cannot be read further: {0}")]
    Unreadable(String),
    // Invalid form of a block.
    #[error("line of more than {limit} bytes")]
    LineTooLong { limit: usize },
    #[error("`{0}` begins no word")]
    NotAWord(char),
    #[error("`,` begins no word: write decimals with a point, such as X10.5")]
    DecimalComma,
    #[error("comment without `)` at its end")]
    CommentOpen,
    #[error("expected a number, found `{0}`")]
    NotANumber(String),
    #[error("expected `{0}`")]
    Expected(char),
    #[error("`{0}` is not a function or operator")]
    UnknownFunction(String),
    #[error("expected `#` of a parameter inside EXISTS")]
    ExpectedParameter,
    #[error("name of a parameter without `>` at its end")]
    NameOpen,
    #[error("expression nested more than {limit} deep")]
    TooDeep { limit: usize },
    #[error("parameter #{0} does not exist: they run from 1 to {1}")]
    ParameterOutOfRange(f64, usize),
    #[error("parameter #<{0}> was never set")]
    ParameterUnset(String),
    #[error("parameter {0} cannot be set")]
    ParameterReadOnly(String),
    #[error("offset in parameter #{number} is {value}: must be within 1e9")]
    ParameterValue { number: usize, value: f64 },
    #[error("more than {limit} named parameters")]
    TooManyNames { limit: usize },
    #[error("{0} has no real value here")]
    NoValue(&'static str),
    #[error("word {0} twice in a block")]
    WordTwice(char),
    #[error("word {0} is used by no code of this block")]
    WordUnused(char),
    #[error("word {0} could belong to two codes of this block")]
    WordAmbiguous(char),
    #[error("word {word} is {value}: must be {requested}")]
    WordValue {
        word: char,
        value: f64,
        requested: &'static str,
    },
    #[error("{0} and {1} in one block, but only one code of their group is allowed")]
    SameGroup(String, String),
    #[error("unknown code {0}")]
    UnknownCode(String),
    // Known but not supported.
    #[error("{code} is not supported: {reason}")]
    Unsupported { code: String, reason: &'static str },
    // Motion.
    #[error("axis words without a code that moves")]
    AxesWithoutMotion,
    #[error("{0} without any axis word")]
    AxesMissing(String),
    #[error("{0} and {1} both need the axis words of this block")]
    AxesTwice(String, String),
    #[error("{0} without {1} word")]
    WordMissing(String, &'static str),
    #[error("{0} with a feed of zero")]
    NoFeed(String),
    #[error("{0} without its own F word in inverse time, G93")]
    NoInverseTime(String),
    #[error("G53 needs G0 or G1")]
    MachineCoordinates,
    #[error("arc without I, J, K or R")]
    ArcWithoutCentre,
    #[error("arc with both R and a centre")]
    ArcWithBoth,
    #[error("arc of radius {radius} at its start and {end_radius} at its end: they may differ by {limit}")]
    ArcRadii {
        radius: f64,
        end_radius: f64,
        limit: f64,
    },
    #[error("arc of radius {radius} whose ends are {chord} apart")]
    ArcTooSmall { radius: f64, chord: f64 },
    #[error("arc with R that ends where it starts: it could be any circle")]
    ArcAnywhere,
    #[error("arc with radius 0")]
    ArcPoint,
    // Canned cycles.
    #[error("{word} in a canned cycle")]
    RotaryInCycle { word: char },
    #[error("canned cycle whose R at {clear} is below its bottom at {bottom}")]
    ClearBelowBottom { clear: f64, bottom: f64 },
    // Cutter compensation.
    #[error("cutter compensation is on already")]
    CompensationOn,
    #[error("{0} while cutter compensation is on")]
    NotUnderCompensation(String),
    #[error("cutter compensation in the YZ plane")]
    CompensationPlane,
    #[error("move after cutter compensation that is not a straight line")]
    ArcAfterCompensation,
    #[error("corner that a cutter of radius {radius} cannot reach without gouging")]
    Gouging { radius: f64 },
    #[error("arc of radius {arc} that a cutter of radius {radius} cannot follow inside")]
    ArcInsideCutter { arc: f64, radius: f64 },
    #[error("more than {limit} calls between two moves of cutter compensation")]
    CompensationWaits { limit: usize },
    #[error("diameter of tool {0} is not given")]
    DiameterUnknown(u32),
    #[error("tool {0} is not in the tool table")]
    ToolUnknown(u32),
    #[error("tool {0} is a turning tool, with orientation {1}")]
    TurningTool(u32, u8),
    // Flow.
    #[error("subroutine inside a subroutine")]
    NestedSubroutine,
    #[error("o-word `{0}` that nothing begins")]
    FlowUnopened(String),
    #[error("o-word `{0}` that nothing ends")]
    FlowUnclosed(String),
    #[error("`{0}` is not an o-word")]
    FlowUnknown(String),
    #[error("words after an o-word")]
    FlowTrailing,
    #[error("subroutine {0} is not known")]
    SubroutineUnknown(String),
    #[error("call with more than {limit} arguments")]
    TooManyArguments { limit: usize },
    #[error("subroutines called more than {limit} deep")]
    CallsTooDeep { limit: usize },
    #[error("more than {limit} {what}")]
    TooMuch { what: Excess, limit: usize },
    // The tip and its axis.
    #[error("cut with {axis} at {angle} deg and no tool-centre control")]
    RotaryCut { axis: char, angle: f64 },
    #[error(
        "{axis} rotates under tool-centre control, but the arrangement of the machine's rotary axes is not given"
    )]
    RotariesUnknown { axis: char },
    #[error("{axis} rotates, but the specified machine has no such axis")]
    RotaryAbsent { axis: char },
    #[error("tool axis I, J, K of length {length}: must be from 1e-6 to 1e6")]
    NoDirection { length: f64 },
    #[error("cut in {0} after cuts in {1}, but their relative position is not given")]
    SystemUnknown(&'static str, &'static str),
    #[error("cut in machine coordinates, but the position of the workpiece in them is not given")]
    MachineCut,
}

impl Refusal {
    /// A hint, if there is one.
    ///
    /// `None` where the message says it.
    pub fn hint(&self) -> Option<String> {
        let hint = match self {
            Refusal::WordTwice(_) | Refusal::SameGroup(..) => "write them in separate blocks",
            Refusal::WordAmbiguous(_) | Refusal::AxesTwice(..) => "write the codes on separate lines",
            Refusal::UnknownCode(_) => {
                "see the list of words in the guide (tool-path-words.md); remove the block if it does not move the tool"
            }
            Refusal::NoFeed(_) => "give F before the first cut",
            Refusal::NoInverseTime(_) => {
                "under G93 every cut needs its own F, the inverse of its time in minutes"
            }
            Refusal::AxesWithoutMotion => "give G0, G1, G2 or G3",
            Refusal::ArcRadii { .. } => {
                "I, J, K lead from the start to the centre; with G90.1 they are the centre itself"
            }
            Refusal::ArcAnywhere => "write full circles with I, J, K",
            Refusal::ArcAfterCompensation => "leave cutter compensation with a straight move",
            Refusal::Gouging { .. } | Refusal::ArcInsideCutter { .. } => {
                "use a smaller cutter, or a path it can follow"
            }
            Refusal::DiameterUnknown(_) => "give a tool table, or G41.1 D with the diameter",
            Refusal::ToolUnknown(_) => "add it to the tool table",
            Refusal::SubroutineUnknown(_) => "define it before its call, or give its file",
            Refusal::RotaryCut { .. } => {
                "post-process with tool-centre control (G43.4, M428, TRAORI, M128), so that X Y Z are the tip in the \
                 frame of the part; and give the rotary axes: rotaries = \"table-ac\", \"table-bc\", \"head-ca\" or \
                 \"head-cb\""
            }
            Refusal::RotariesUnknown { .. } => {
                "give the rotary axes: rotaries = \"table-ac\" (A tilts the table that carries C), \"table-bc\", \
                 \"head-ca\" (C carries the head that A tilts) or \"head-cb\""
            }
            Refusal::SystemUnknown(..) => {
                "give the offsets of both before the first cut with G10 L2, or split the program"
            }
            Refusal::MachineCut => "give the work offset before with G10 L2",
            Refusal::ParameterUnset(_) => "names are local to their subroutine unless they begin with `_`",
            Refusal::TooMuch {
                what: Excess::RepeatedLines,
                ..
            } => "the program may never end: check the conditions of its loops",
            Refusal::TooMuch {
                what: Excess::KeptBytes,
                ..
            } => "only subroutines and loops are kept: write long cuts outside of them",
            Refusal::TooMuch {
                what: Excess::Pecks, ..
            } => "check the step Q of this cycle: its unit, and that no digit is missing",
            Refusal::TooMuch {
                what: Excess::MovesOfALine,
                ..
            } => "check L and Q of this cycle: each hole is several moves, each step more",
            _ => return None,
        };
        Some(hint.to_owned())
    }
}

/// Quantity with a maximum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Excess {
    /// Text of subroutines and loops.
    KeptBytes,
    /// Lines of subroutines and loops, each round counted.
    RepeatedLines,
    /// What one line expands to.
    MovesOfALine,
    /// Steps of one drilled hole.
    Pecks,
}

impl fmt::Display for Excess {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Excess::KeptBytes => "bytes of subroutines and loops",
            Excess::RepeatedLines => "executed lines of loops and subroutines",
            Excess::MovesOfALine => "moves of one line",
            Excess::Pecks => "steps in one hole",
        })
    }
}

/// A refusal and the bytes of its line.
///
/// Of the line as the file has it, blanks and comments included.
#[derive(Clone, Debug, PartialEq)]
pub struct Refused {
    /// Why.
    pub refusal: Refusal,
    /// Bytes of the line.
    pub place: std::ops::Range<usize>,
}

/// A refusal and its position in its file.
///
/// One per line: a line that fails in every round of a loop is reported once.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// Why.
    pub refusal: Refusal,
    /// Line, from 1.
    pub line: u32,
    /// Bytes of the line.
    pub place: std::ops::Range<usize>,
    /// The line itself.
    pub text: String,
    /// The file, where it is not the program itself.
    pub file: Option<String>,
    /// Where the line begins in its file, bytes.
    pub offset: usize,
}

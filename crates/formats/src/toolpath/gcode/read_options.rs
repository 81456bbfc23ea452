//! Options for reading a program: properties of the machine for which it was written.

use std::collections::BTreeMap;

use super::rotaries::Rotaries;
use super::tools::ToolTable;
use crate::toolpath::LengthUnit;

/// Gives the text of a subroutine by its name: the reader opens no files itself.
pub type Lookup<'a> = &'a dyn Fn(&str) -> Option<String>;

/// Options for a program that does not give these values.
#[derive(Clone, Default)]
pub struct GcodeReadOptions<'a> {
    /// The unit before the first G20 or G21.
    pub unit: LengthUnit,
    /// The unit of the parameters 5161 to 5386. With a tool table it is not looked at: then they have the unit of the
    /// table.
    pub machine_unit: LengthUnit,
    /// Parameters of the machine before the program, such as work offsets from 5221 on.
    pub parameters: BTreeMap<u16, f64>,
    /// The tools; without them every tool number is accepted, without length and diameter.
    pub tools: Option<ToolTable>,
    /// How rotary axes turn tool and part.
    pub rotaries: Option<Rotaries>,
    /// Whether blocks that begin with `/` are left out.
    pub block_delete: bool,
    /// Maximum number of executed lines in loops and subroutines, repetitions included; the default is 20 million.
    pub most_repeated_lines: Option<usize>,
    /// Subroutines that are not in the program.
    pub subroutines: Option<Lookup<'a>>,
}

/// Ignored words and assumptions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Warning {
    /// No G20 or G21 before the first axis word.
    UnitAssumed,
    /// G28 or G30 without a stored position: machine zero.
    HomeAssumed,
    /// A move in machine coordinates without a work offset: program zero is taken as machine zero.
    MachineZeroAssumed,
    /// A program that begins with an arc: from program zero.
    StartAssumed,
    /// An M code of the machine builder.
    UserCode,
    /// Waiting for or setting an input or output.
    Output,
    /// A tool without a length in the tool table.
    LengthUnknown,
    /// A cut in feed per revolution with a spindle that does not turn.
    SpindleStopped,
    /// A tapping cycle: the spindle turns back at its bottom.
    Tapping,
}

impl Warning {
    /// What it means for the path.
    ///
    /// A sentence without its end: where it came first is put behind it.
    pub fn meaning(self) -> &'static str {
        match self {
            Warning::UnitAssumed => "no G20 or G21: the unit is assumed",
            Warning::HomeAssumed => "G28 or G30 without stored position: machine zero is assumed",
            Warning::MachineZeroAssumed => {
                "machine coordinates without work offset: program zero is assumed there"
            }
            Warning::StartAssumed => "the program begins with an arc: program zero is used as its start",
            Warning::UserCode => "codes of the machine builder are ignored",
            Warning::Output => "inputs and outputs are ignored",
            Warning::LengthUnknown => "the tool length is not given: X Y Z are read as the tool tip",
            Warning::SpindleStopped => "feed per revolution with the spindle stopped: the feed is not known",
            Warning::Tapping => "tapping: the programmed feed is used",
        }
    }
}

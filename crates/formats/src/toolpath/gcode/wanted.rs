//! What a program cannot tell itself: the machine it was written for; and what it was read with.

use std::collections::BTreeMap;

use super::rotaries::Rotaries;
use super::tools::ToolTable;
use crate::toolpath::LengthUnit;

/// Gives the text of a subroutine by its name: the reader opens no files itself.
pub type Lookup<'a> = &'a dyn Fn(&str) -> Option<String>;

/// What a user may say of a program where it is silent.
#[derive(Clone, Default)]
pub struct Wanted<'a> {
    /// The unit before the first G20 or G21.
    pub unit: LengthUnit,
    /// The unit of the parameters 5161 to 5386. With a tool table it is not looked at: then they have the unit of the
    /// table.
    pub machine_unit: LengthUnit,
    /// Parameters as the machine holds them before the program, such as work offsets from 5221 on.
    pub parameters: BTreeMap<u16, f64>,
    /// The tools; without them every tool number is accepted, without length and diameter.
    pub tools: Option<ToolTable>,
    /// How rotary axes turn tool and part.
    pub rotaries: Option<Rotaries>,
    /// Whether blocks that begin with `/` are left out.
    pub block_delete: bool,
    /// Lines of loops and subroutines that may be done, repetitions counted; 20 million where nothing is told.
    pub most_repeated_lines: Option<usize>,
    /// Subroutines that are not in the program.
    pub subroutines: Option<Lookup<'a>>,
}

/// What was read and has no part in the path, or was taken for granted.
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
    /// A tool whose length the tool table does not tell.
    LengthUnknown,
    /// A cut in feed per revolution with a spindle that does not turn.
    SpindleStands,
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
            Warning::StartAssumed => "the program begins with an arc: from program zero",
            Warning::UserCode => "codes of the machine builder are passed over",
            Warning::Output => "inputs and outputs are passed over",
            Warning::LengthUnknown => "length of the tool is not told: X Y Z are taken as its tip",
            Warning::SpindleStands => "feed per revolution with the spindle standing: the feed is not told",
            Warning::Tapping => "tapping: the feed is taken as told",
        }
    }
}

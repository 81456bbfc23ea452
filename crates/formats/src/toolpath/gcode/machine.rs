//! The modal state: modes, words of a cycle, offsets, position; and the relation of program and machine coordinates.
//!
//! `m = g5x + length + Rz(turn) (p + g92)`, where `Rz` turns X and Y alone.
//!
//! | symbol | meaning |
//! |---|---|
//! | `m` | machine coordinates |
//! | `p` | coordinates of the program |
//! | `g5x`, `turn` | zero and turn of the coordinate system, G54 to G59.3; deg |
//! | `g92` | offset of G92 or G52 |
//! | `length` | offset of the tool, G43 |
//!
//! All in the unit of the program in force and in degrees. Witness: the interpreter tests of LinuxCNC, folders g10, g52
//! and rotation.

use super::canonical::{Axes, Canonical, PathControl, Plane};
use super::cutter::{Cutter, Out};
use super::expression::Values;
use super::parameters::{self, Parameters};
use super::read_options::{GcodeReadOptions, Warning};
use super::refusal::Refusal;
use super::tools::{Tool, ToolTable};
use crate::toolpath::LengthUnit;
use crate::toolpath::direction::LARGEST;
use crate::toolpath::notes::Notes;
use armill_core::units::from_deg;

/// What F means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FeedMode {
    /// G93: one over the minutes of its move.
    InverseTime,
    /// G94: units a minute.
    PerMinute,
    /// G95: units a turn of the spindle.
    PerRevolution,
}

/// Words that later blocks of a cycle need not repeat, as they were written.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cycle {
    /// R.
    pub clear: f64,
    /// X, Y or Z across the plane.
    pub bottom: f64,
    /// Q of G73 and G83.
    pub step: Option<f64>,
    /// P, s.
    pub dwell: Option<f64>,
}

impl Cycle {
    /// Counts lengths in another unit, of which `by` make one of the old.
    pub fn scale(&mut self, by: f64) {
        self.clear *= by;
        self.bottom *= by;
        self.step = self.step.map(|step| step * by);
    }
}

/// The state of the interpreter.
pub(super) struct Machine {
    pub parameters: Parameters,
    /// In the unit of the machine.
    pub tools: ToolTable,
    /// Whether there is a tool table at all.
    pub has_tool_table: bool,
    /// The unit of the program in force: of all lengths below.
    pub unit: LengthUnit,
    pub plane: Plane,
    /// G90, not G91.
    pub absolute: bool,
    /// G90.1, not G91.1: I, J, K are the centre itself.
    pub arc_absolute: bool,
    pub feed_mode: FeedMode,
    /// Units per minute, or per revolution; 0 if none was given.
    pub feed: f64,
    /// Revolutions a minute.
    pub speed: f64,
    /// The code of motion in force, in tenths; G80 is none.
    pub motion: u16,
    /// G99, not G98.
    pub retract_to_r: bool,
    pub path: PathControl,
    /// Tolerance of G64 Q, units.
    pub naive: f64,
    /// The work coordinate system in force: 1 is G54, 9 is G59.3.
    pub system: u8,
    /// Its zero in machine coordinates, units and deg.
    pub g5x: Axes,
    /// Its turn about Z, deg.
    pub turn: f64,
    /// Offset of G92 or G52, units and deg.
    pub g92: Axes,
    /// Offset of the tool, units and deg.
    pub length: Axes,
    /// Position of the tip in coordinates of the program, units and deg.
    pub at: Axes,
    /// Number of the tool that T chose.
    pub selected: u32,
    /// The call that started the spindle last: drilling cycles that stop it start it so again.
    pub spindle: Canonical,
    /// Number of the tool in the spindle.
    pub tool: u32,
    pub cycle: Cycle,
    pub cutter: Cutter,
    /// Tool-centre control is on.
    pub centre: bool,
    /// By G43.4 or G43.5.
    pub centre_by_length: bool,
    /// G43.5: I, J, K are the tool axis.
    pub vector: bool,
    /// What has no part in the path, or was taken for granted.
    pub notes: Notes<Warning>,
    /// Number of the line being read.
    pub line: u32,
    /// Whether G20 or G21 came, or its absence was warned of.
    pub unit_given: bool,
}

/// Adds `by` times `second`.
fn plus(first: Axes, by: f64, second: Axes) -> Axes {
    std::array::from_fn(|axis| first[axis] + by * second[axis])
}

/// Turns X and Y by this angle about Z.
fn turned(mut of: Axes, degrees: f64) -> Axes {
    if degrees != 0.0 {
        let (sine, cosine) = from_deg(degrees).sin_cos();
        (of[0], of[1]) = (of[0] * cosine - of[1] * sine, of[0] * sine + of[1] * cosine);
    }
    of
}

/// Scales lengths, not angles.
pub(super) fn scaled(mut of: Axes, by: f64) -> Axes {
    of.iter_mut().take(3).for_each(|value| *value *= by);
    of
}

impl Machine {
    /// Before the first block: G17, G90, G91.1, G94, G98, G64 and no motion, with the given parameters.
    pub fn new(requested: &GcodeReadOptions<'_>) -> Machine {
        let mut parameters = Parameters::new();
        for (number, value) in &requested.parameters {
            if let Ok(index) = Parameters::index(f64::from(*number)) {
                parameters.set_numbered(index, *value);
            }
        }
        let mut machine = Machine {
            parameters,
            tools: requested.tools.clone().unwrap_or(ToolTable {
                unit: requested.machine_unit,
                ..ToolTable::default()
            }),
            has_tool_table: requested.tools.is_some(),
            unit: requested.unit,
            plane: Plane::Xy,
            absolute: true,
            arc_absolute: false,
            feed_mode: FeedMode::PerMinute,
            feed: 0.0,
            speed: 0.0,
            motion: 800,
            retract_to_r: false,
            path: PathControl::Continuous(0.0),
            naive: 0.0,
            system: 1,
            g5x: [0.0; 6],
            turn: 0.0,
            g92: [0.0; 6],
            length: [0.0; 6],
            at: [0.0; 6],
            selected: 0,
            tool: 0,
            spindle: Canonical::StartSpindleClockwise,
            cycle: Cycle::default(),
            cutter: Cutter::default(),
            centre: false,
            centre_by_length: false,
            vector: false,
            notes: Notes::default(),
            line: 1,
            unit_given: false,
        };
        let system = machine.parameters.numbered(parameters::SYSTEM);
        machine.system = if (1.0..=9.0).contains(&system) {
            system as u8
        } else {
            1
        };
        machine
    }

    /// Start of a program: the stored offsets of the machine.
    pub fn begin(&mut self, out: Out<'_>) -> Result<(), Refusal> {
        (self.g5x, self.turn) = self.stored_system(self.system)?;
        if self.parameters.numbered(parameters::G92_FLAG) != 0.0 {
            self.g92 = self.stored(parameters::G92_FLAG + 1)?;
        }
        out(Canonical::UseLengthUnits(self.unit), self.line)?;
        out(Canonical::SetG5xOffset(self.system, self.g5x), self.line)?;
        out(Canonical::SetG92Offset(self.g92), self.line)?;
        out(Canonical::SetXyRotation(self.turn), self.line)
    }

    /// Gives a call on, behind what waits for cutter compensation.
    pub fn call(&mut self, call: Canonical, out: Out<'_>) -> Result<(), Refusal> {
        self.cutter.pass(call, out)
    }

    /// Counts something for the notes, at the line being read.
    pub fn warn(&mut self, warning: Warning) {
        self.notes.count(warning, self.line);
    }

    /// Machine coordinates of a place of the program; see the equation above.
    pub fn in_machine(&self, program: Axes) -> Axes {
        let offset = turned(plus(program, 1.0, self.g92), self.turn);
        plus(plus(offset, 1.0, self.g5x), 1.0, self.length)
    }

    /// The reverse of `in_machine`.
    pub fn in_program(&self, machine: Axes) -> Axes {
        let offset = plus(plus(machine, -1.0, self.g5x), -1.0, self.length);
        plus(turned(offset, -self.turn), -1.0, self.g92)
    }

    /// Changes offsets: the machine does not move, but the position has new coordinates.
    ///
    /// What the program calls this place is then another.
    pub fn recount(&mut self, change: impl FnOnce(&mut Machine)) {
        let machine = self.in_machine(self.at);
        change(self);
        self.at = self.in_program(machine);
    }

    /// Six parameters from this one on, in the unit of the program; refused where one is beyond [`LARGEST`].
    pub fn stored(&self, first: usize) -> Result<Axes, Refusal> {
        let mut values = [0.0; 6];
        for (axis, value) in values.iter_mut().enumerate() {
            *value = self.stored_at(first + axis)?;
        }
        Ok(scaled(values, self.tools.unit.in_units_of(self.unit)))
    }

    /// A parameter that contains an offset.
    fn stored_at(&self, number: usize) -> Result<f64, Refusal> {
        let value = self.parameters.numbered(number);
        match value.abs() <= LARGEST {
            true => Ok(value),
            false => Err(Refusal::ParameterValue { number, value }),
        }
    }

    /// Sets six parameters from this one on; values are in the unit of the program.
    pub fn store(&mut self, first: usize, values: Axes) {
        let values = scaled(values, self.unit.in_units_of(self.tools.unit));
        for (axis, value) in values.into_iter().enumerate() {
            self.parameters.set_numbered(first + axis, value);
        }
    }

    /// Zero and turn (deg) of a coordinate system.
    pub fn stored_system(&self, system: u8) -> Result<(Axes, f64), Refusal> {
        let zero = self.stored(parameters::zero_of(system))?;
        Ok((zero, self.stored_at(parameters::turn_of(system))?))
    }

    /// A tool of the table; without a table any tool, without data.
    ///
    /// Number 0 means no tool, without length and diameter, unless the table contains it.
    ///
    /// # Errors
    /// A number that the table does not have.
    pub fn tool(&self, number: u32) -> Result<Option<Tool>, Refusal> {
        match self.tools.tools.get(&number) {
            Some(tool) => Ok(Some(*tool)),
            None if number == 0 => Ok(Some(Tool::default())),
            None if self.has_tool_table => Err(Refusal::ToolUnknown(number)),
            None => Ok(None),
        }
    }

    /// Its offset in the unit of the program; zero where the table says nothing.
    pub fn tool_offset(&self, number: u32) -> Result<Axes, Refusal> {
        let offset = self.tool(number)?.unwrap_or_default().offset;
        Ok(scaled(offset, self.tools.unit.in_units_of(self.unit)))
    }

    /// G20 and G21: lengths of the state count in the new unit. The feed does not.
    pub fn use_unit(&mut self, unit: LengthUnit) {
        let by = self.unit.in_units_of(unit);
        for of in [&mut self.at, &mut self.g5x, &mut self.g92, &mut self.length] {
            *of = scaled(*of, by);
        }
        self.cycle.scale(by);
        self.unit = unit;
        self.unit_given = true;
    }

    /// A parameter of [`parameters::READ_ONLY`]: it gives the state.
    fn read_only_parameter(&self, index: usize) -> f64 {
        let tool = self.tools.tools.get(&self.tool);
        match index {
            5400 => f64::from(self.tool),
            5401..=5406 => tool.map_or(0.0, |tool| tool.offset[index - 5401]),
            5410 => tool.map_or(0.0, |tool| tool.diameter),
            5420..=5425 => self.at[index - 5420],
            _ => 0.0,
        }
    }

    /// State variable with a name that begins with `_`, as in LinuxCNC.
    fn named_state(&self, name: &[u8]) -> Option<f64> {
        let flag = |flag: bool| Some(f64::from(u8::from(flag)));
        let axis = |of: Axes, letter: u8| {
            let index = b"xyzabc".iter().position(|axis| *axis == letter)?;
            Some(of[index])
        };
        match name {
            [b'_', letter] => axis(self.at, *letter),
            [b'_', b'a', b'b', b's', b'_', letter] => axis(self.in_machine(self.at), *letter),
            b"_metric" => flag(self.unit == LengthUnit::Millimetre),
            b"_imperial" => flag(self.unit == LengthUnit::Inch),
            b"_absolute" => flag(self.absolute),
            b"_incremental" => flag(!self.absolute),
            b"_feed" => Some(self.feed),
            b"_rpm" => Some(self.speed),
            b"_current_tool" => Some(f64::from(self.tool)),
            b"_selected_tool" => Some(f64::from(self.selected)),
            b"_line" => Some(f64::from(self.line)),
            b"_coord_system" => Some(match self.system {
                system @ 1..=6 => 530.0 + 10.0 * f64::from(system),
                system => 584.0 + f64::from(system),
            }),
            b"_plane" => Some(match self.plane {
                Plane::Xy => 170.0,
                Plane::Zx => 180.0,
                Plane::Yz => 190.0,
            }),
            _ => None,
        }
    }
}

impl Values for Machine {
    fn numbered(&self, number: f64) -> Result<f64, Refusal> {
        let index = Parameters::index(number)?;
        if parameters::READ_ONLY.contains(&index) {
            return Ok(self.read_only_parameter(index));
        }
        Ok(self.parameters.numbered(index))
    }

    fn named(&self, name: &[u8]) -> Option<f64> {
        self.named_state(name).or_else(|| self.parameters.named(name))
    }
}

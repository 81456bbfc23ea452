//! Codes that change the reference of coordinates: G10, G43, G52, G54, G92 and similar.
//!
//! With `m = g5x + length + Rz(turn) (p + g92)` (see `machine`), the tip at `m` and the words `w`:
//!
//! | code | sets | so that |
//! |---|---|---|
//! | `G10 L2 P R` | `g5x = w`, `turn = R` of system `P` | |
//! | `G10 L20 P` | `g5x` of system `P` | `p = w` there: `g5x = m - length - Rz(turn) (w + g92)` |
//! | `G10 L1 P R` | `length = w` of tool `P`, its radius `R` | |
//! | `G10 L10 P` | `length` of tool `P` | `p = w`: `length = m - g5x - Rz(turn) (w + g92)` |
//! | `G10 L11 P` | the same, counted from G59.3 without `g92` | |
//! | `G92` | `g92` | `p = w`: `g92 = g92 + p - w` |
//! | `G52` | `g92 = w` | |
//!
//! Source: LinuxCNC documentation, G10, G43, G52, G54, G92; witnesses: its interpreter tests g10, g52, rotation.

use super::block::Block;
use super::canonical::{Axes, Canonical};
use super::cutter::Out;
use super::groups;
use super::machine::{Machine, scaled};
use super::parameters;
use super::read_options::Warning;
use super::refusal::Refusal;

/// G59.3, which G10 L11 counts from.
const FIXTURE: u8 = 9;

/// The words that are given, otherwise the base.
fn over(words: [Option<f64>; 6], base: Axes) -> Axes {
    std::array::from_fn(|axis| words[axis].unwrap_or(base[axis]))
}

/// A word as a whole number of a range.
///
/// Within 1e-6 of one: it may be computed.
fn whole(
    word: char,
    value: f64,
    range: std::ops::RangeInclusive<f64>,
    requested: &'static str,
) -> Result<u32, Refusal> {
    // Words may be computed.
    let whole = value.round();
    if (value - whole).abs() > 1e-6 || !range.contains(&whole) {
        return Err(Refusal::WordValue {
            word,
            value,
            requested,
        });
    }
    Ok(whole as u32)
}

/// A tool's number.
pub(super) fn tool_number(word: char, value: f64) -> Result<u32, Refusal> {
    whole(word, value, 0.0..=99_999_999.0, "a whole number")
}

impl Machine {
    /// Refuses a code while cutter compensation is on.
    fn not_compensating(&self, code: &str) -> Result<(), Refusal> {
        if self.cutter.is_on() {
            return Err(Refusal::NotUnderCompensation(code.to_owned()));
        }
        Ok(())
    }

    /// G10.
    pub(super) fn set_data(&mut self, block: &mut Block, out: Out<'_>) -> Result<(), Refusal> {
        let missing = |word| Refusal::WordMissing("G10".to_owned(), word);
        let kind = block.take(b'l').ok_or_else(|| missing("L"))?;
        let number = block.take(b'p').ok_or_else(|| missing("P"))?;
        match whole('L', kind, 1.0..=20.0, "1, 2, 10, 11 or 20")? {
            kind @ (2 | 20) => {
                let system = whole('P', number, 0.0..=9.0, "0 to 9")?;
                let system = if system == 0 { self.system } else { system as u8 };
                self.set_system(system, kind, block, out)
            }
            kind @ (1 | 10 | 11) => {
                let tool = tool_number('P', number)?;
                self.set_tool(tool, kind, block, out)
            }
            _ => Err(Refusal::WordValue {
                word: 'L',
                value: kind,
                requested: "1, 2, 10, 11 or 20",
            }),
        }
    }

    /// G10 L2 and L20.
    ///
    /// What the words do not name stays; under a turn X and Y are found together. Of the system in force the change
    /// takes effect at once.
    fn set_system(&mut self, system: u8, kind: u32, block: &mut Block, out: Out<'_>) -> Result<(), Refusal> {
        self.not_compensating("G10")?;
        let (zero, turn) = self.stored_system(system)?;
        let turn = block.take(b'r').unwrap_or(turn);
        let words = block.axes();
        let zero = if kind == 20 {
            // Position of the system with which the tip is at the words.
            let machine = self.in_machine(self.at);
            self.with_system(zero, turn, |other| {
                let at = over(words, other.in_program(machine));
                other.g5x = [0.0; 6];
                let from_zero = other.in_machine(at);
                std::array::from_fn(|axis| match words[axis] {
                    // The turn of X and Y binds them together.
                    None if axis > 1 => zero[axis],
                    _ => machine[axis] - from_zero[axis],
                })
            })
        } else {
            over(words, zero)
        };
        self.store(parameters::zero_of(system), zero);
        self.parameters.set_numbered(parameters::turn_of(system), turn);
        if system == self.system {
            self.recount(|machine| (machine.g5x, machine.turn) = (zero, turn));
            self.call(Canonical::SetG5xOffset(system, zero), out)?;
            self.call(Canonical::SetXyRotation(turn), out)?;
        }
        Ok(())
    }

    /// What another coordinate system would give.
    ///
    /// Offsets are as they were afterwards.
    fn with_system<T>(&mut self, zero: Axes, turn: f64, of: impl FnOnce(&mut Machine) -> T) -> T {
        let kept = (self.g5x, self.turn, self.g92, self.length);
        (self.g5x, self.turn) = (zero, turn);
        let result = of(self);
        (self.g5x, self.turn, self.g92, self.length) = kept;
        result
    }

    /// G10 L1, L10 and L11.
    ///
    /// The table changes, not the offset in force. I and J, angles of turning tools, are ignored.
    fn set_tool(&mut self, number: u32, kind: u32, block: &mut Block, out: Out<'_>) -> Result<(), Refusal> {
        self.not_compensating("G10")?;
        let mut tool = self.tool(number)?.unwrap_or_default();
        let offset = scaled(tool.offset, self.tools.unit.in_units_of(self.unit));
        let words = block.axes();
        let machine = self.in_machine(self.at);
        let offset = match kind {
            1 => over(words, offset),
            // The offset with which the tip is at the words.
            10 => {
                let (zero, turn) = (self.g5x, self.turn);
                self.with_system(zero, turn, |other| other.offset_for(machine, offset, words))
            }
            _ => {
                let (zero, turn) = self.stored_system(FIXTURE)?;
                self.with_system(zero, turn, |other| {
                    other.g92 = [0.0; 6];
                    other.offset_for(machine, offset, words)
                })
            }
        };
        let per_unit = self.unit.in_units_of(self.tools.unit);
        tool.offset = scaled(offset, per_unit);
        if let Some(radius) = block.take(b'r') {
            tool.diameter = 2.0 * radius * per_unit;
        }
        if let Some(orientation) = block.take(b'q') {
            tool.orientation = whole('Q', orientation, 0.0..=9.0, "0 to 9")? as u8;
        }
        for letter in [b'i', b'j'] {
            block.take(letter);
        }
        self.tools.tools.insert(number, tool);
        self.call(
            Canonical::SetToolTableEntry {
                tool: number,
                offset,
                diameter: tool.diameter / per_unit,
            },
            out,
        )
    }

    /// The offset with which the tip at `machine` is at the words; axes without word keep `offset`.
    fn offset_for(&mut self, machine: Axes, offset: Axes, words: [Option<f64>; 6]) -> Axes {
        self.length = offset;
        let at = over(words, self.in_program(machine));
        self.length = [0.0; 6];
        let bare = self.in_machine(at);
        std::array::from_fn(|axis| machine[axis] - bare[axis])
    }

    /// G54 to G59.3.
    ///
    /// The tip does not move but has new coordinates.
    pub(super) fn use_system(&mut self, code: u16, out: Out<'_>) -> Result<(), Refusal> {
        let system = match code {
            540 => 1,
            550 => 2,
            560 => 3,
            570 => 4,
            580 => 5,
            590 => 6,
            591 => 7,
            592 => 8,
            _ => 9,
        };
        if system == self.system {
            return Ok(());
        }
        let (zero, turn) = self.stored_system(system)?;
        self.not_compensating(&groups::name(b'g', code))?;
        self.parameters
            .set_numbered(parameters::SYSTEM, f64::from(system));
        self.recount(|machine| (machine.system, machine.g5x, machine.turn) = (system, zero, turn));
        self.call(Canonical::SetG5xOffset(system, self.g5x), out)?;
        self.call(Canonical::SetG92Offset(self.g92), out)?;
        self.call(Canonical::SetXyRotation(self.turn), out)
    }

    /// G52 and G92 to G92.3.
    ///
    /// G92.1 forgets the offset, G92.2 puts it aside, G92.3 takes it up again.
    pub(super) fn shift(&mut self, code: u16, block: &mut Block, out: Out<'_>) -> Result<(), Refusal> {
        let name = groups::name(b'g', code);
        self.not_compensating(&name)?;
        let (offset, flag) = match code {
            520 | 920 => {
                if !block.has_axes() {
                    return Err(Refusal::AxesMissing(name));
                }
                let words = block.axes();
                let offset = std::array::from_fn(|axis| match words[axis] {
                    Some(value) if code == 520 => value,
                    Some(value) => self.g92[axis] + self.at[axis] - value,
                    None => self.g92[axis],
                });
                self.store(parameters::G92_FLAG + 1, offset);
                (offset, 1.0)
            }
            921 => {
                self.store(parameters::G92_FLAG + 1, [0.0; 6]);
                ([0.0; 6], 0.0)
            }
            922 => ([0.0; 6], 0.0),
            _ => (self.stored(parameters::G92_FLAG + 1)?, 1.0),
        };
        self.parameters.set_numbered(parameters::G92_FLAG, flag);
        self.recount(|machine| machine.g92 = offset);
        self.call(Canonical::SetG92Offset(offset), out)
    }

    /// G28.1 and G30.1.
    ///
    /// Position of the tip, in machine coordinates.
    pub(super) fn store_home(&mut self, code: u16) {
        let machine = self.in_machine(self.at);
        self.store(parameters::home_of(code), machine);
    }

    /// G43 to G49: length of the tool, and tool-centre control.
    ///
    /// G43 by H or the tool in the spindle, G43.1 by the words, G43.2 adds, G49 takes off; G43.4 and G43.5 turn
    /// tool-centre control on.
    pub(super) fn tool_length(&mut self, code: u16, block: &mut Block, out: Out<'_>) -> Result<(), Refusal> {
        self.not_compensating(&groups::name(b'g', code))?;
        let offset = match code {
            431 => over(block.axes(), self.length),
            490 => [0.0; 6],
            _ => {
                let tool = match block.take(b'h') {
                    Some(number) => tool_number('H', number)?,
                    None => self.tool,
                };
                if self.tool(tool)?.is_none() {
                    self.warn(Warning::LengthUnknown);
                }
                let offset = self.tool_offset(tool)?;
                if code == 432 {
                    std::array::from_fn(|axis| self.length[axis] + offset[axis])
                } else {
                    offset
                }
            }
        };
        self.recount(|machine| machine.length = offset);
        self.call(Canonical::UseToolLengthOffset(offset), out)?;
        // G43 replaces G43.4 and G43.5, which are of its group, not M128; G49 ends them all.
        let given = match code {
            434 | 435 => Some(true),
            490 if self.centre => Some(false),
            _ if self.centre_by_length => Some(false),
            _ => None,
        };
        if let Some(on) = given {
            (self.centre, self.centre_by_length, self.vector) = (on, on, code == 435);
            self.call(Canonical::ToolCentreControl { on }, out)?;
        }
        Ok(())
    }
}

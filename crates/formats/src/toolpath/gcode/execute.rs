//! What a block does, in the order of the standard: modes first, then offsets, then motion, then stopping.
//!
//! | step | words |
//! |---|---|
//! | `feed_and_spindle` | G93 to G95, F, S, T |
//! | `machine_codes` | M6, M61, M3 to M5, M19, M48 to M53, M62 to M68, M100 on, tool-centre control |
//! | `modes` | G4, plane, unit, cutter and length compensation, coordinate system, G61, G64, G90, G91, G97 to G99 |
//! | `moves` | G10, G28, G30, G52, G92, then motion |
//! | `stopping` | M98, M99; M0, M1, M2, M30, M60 |
//!
//! Codes G are in tenths: 921 is G92.1. Each step takes the words of its codes; a word that is not used is
//! refused.
//!
//! Source: NISTIR 6556, section 3.8, order of execution.

use super::block::{Block, shown};
use super::canonical::{Canonical, PathControl, Plane};
use super::cutter::Out;
use super::groups;
use super::machine::{FeedMode, Machine};
use super::offsets::tool_number;
use super::read_options::Warning;
use super::refusal::Refusal;
use crate::toolpath::LengthUnit;

/// What follows a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// The next block.
    Next,
    /// M2 or M30.
    End,
    /// M98.
    Call(NumberedCall),
    /// M99.
    Return,
}

/// M98: a subroutine, so many times.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct NumberedCall {
    /// Of the subroutine.
    pub number: u32,
    /// Rounds, 0 to 9999.
    pub times: u32,
}

/// Calls of one M98.
const MOST_CALLS: f64 = 9999.0;

impl Machine {
    /// Does what a block says.
    ///
    /// # Errors
    /// The first thing that is refused; what was done until then stays done.
    pub(super) fn execute(&mut self, block: &mut Block, out: Out<'_>) -> Result<Outcome, Refusal> {
        if block.has_g(640) && block.m[groups::SPINDLE].is_some_and(|(code, _)| code == 19) && block.has(b'r')
        {
            return Err(Refusal::WordAmbiguous('R'));
        }
        self.feed_and_spindle(block, out)?;
        self.machine_codes(block, out)?;
        self.modes(block, out)?;
        self.moves(block, out)?;
        let outcome = self.stopping(block, out)?;
        match block.unused() {
            Some(letter) => Err(Refusal::WordUnused(shown(letter))),
            None => Ok(outcome),
        }
    }

    /// Feed and its mode, speed, choice of the tool. Under inverse time F belongs to its block alone and is left to the
    /// move.
    fn feed_and_spindle(&mut self, block: &mut Block, out: Out<'_>) -> Result<(), Refusal> {
        if let Some((code, _)) = block.g[groups::FEED_MODE] {
            self.feed_mode = match code {
                930 => FeedMode::InverseTime,
                940 => FeedMode::PerMinute,
                _ => FeedMode::PerRevolution,
            };
            let per_revolution = self.feed_mode == FeedMode::PerRevolution;
            self.call(Canonical::SetFeedMode { per_revolution }, out)?;
            // A new mode resets the feed, whose number could have another meaning.
            if self.feed_mode != FeedMode::InverseTime {
                self.feed = 0.0;
                self.call(Canonical::SetFeedRate(0.0), out)?;
            }
        }
        if let Some(feed) = block.take(b'f') {
            if feed < 0.0 {
                return Err(Refusal::WordValue {
                    word: 'F',
                    value: feed,
                    requested: "at least 0",
                });
            }
            if self.feed_mode != FeedMode::InverseTime {
                self.feed = feed;
                self.call(Canonical::SetFeedRate(feed), out)?;
            }
        }
        if let Some(speed) = block.take(b's') {
            if speed < 0.0 {
                return Err(Refusal::WordValue {
                    word: 'S',
                    value: speed,
                    requested: "at least 0",
                });
            }
            self.speed = speed;
            self.call(Canonical::SetSpindleSpeed(speed), out)?;
        }
        if let Some(tool) = block.take(b't') {
            self.selected = tool_number('T', tool)?;
            self.tool(self.selected)?;
            self.call(Canonical::SelectTool(self.selected), out)?;
        }
        Ok(())
    }

    /// Codes M that move nothing: tool change, spindle, and those of the machine, which are ignored with their
    /// words.
    fn machine_codes(&mut self, block: &mut Block, out: Out<'_>) -> Result<(), Refusal> {
        if let Some((code, _)) = block.m[groups::TOOL] {
            if self.cutter.is_on() {
                return Err(Refusal::NotUnderCompensation(groups::name(b'm', code)));
            }
            // M61 sets the tool in the spindle; M6 changes to the one selected by T, with the spindle stopped.
            if code == 61 {
                let number = block
                    .take(b'q')
                    .ok_or(Refusal::WordMissing("M61".to_owned(), "Q"))?;
                self.selected = tool_number('Q', number)?;
                self.tool(self.selected)?;
            } else {
                self.call(Canonical::StopSpindleTurning, out)?;
            }
            self.tool = self.selected;
            self.call(Canonical::ChangeTool(self.tool), out)?;
        }
        match block.m[groups::SPINDLE] {
            Some((code @ (3 | 4), _)) => {
                self.spindle = match code {
                    3 => Canonical::StartSpindleClockwise,
                    _ => Canonical::StartSpindleCounterclockwise,
                };
                self.call(self.spindle.clone(), out)?;
            }
            Some((5, _)) => self.call(Canonical::StopSpindleTurning, out)?,
            // M19 turns the spindle to an angle, which is not followed.
            Some(_) => [b'r', b'p', b'q'].iter().for_each(|letter| {
                block.take(*letter);
            }),
            None => {}
        }
        if let Some((code, _)) = block.m[groups::COOLANT] {
            self.call(Canonical::Coolant { on: code != 9 }, out)?;
        }
        if block.m[groups::OVERRIDE].is_some() {
            block.take(b'p');
        }
        for (group, letters, warning) in [
            (groups::OUTPUTS, &b"pqel"[..], Warning::Output),
            (groups::USER, &b"pq"[..], Warning::UserCode),
        ] {
            if block.m[group].is_some() {
                self.warn(warning);
                for letter in letters {
                    block.take(*letter);
                }
            }
        }
        if let Some((code, _)) = block.m[groups::CENTRE] {
            let on = matches!(code, 128 | 428 | groups::TRAORI);
            (self.centre, self.centre_by_length, self.vector) = (on, false, false);
            self.call(Canonical::ToolCentreControl { on }, out)?;
        }
        Ok(())
    }

    /// Modes in the order of the standard. Those that cutter compensation rests on may not change while it is on.
    fn modes(&mut self, block: &mut Block, out: Out<'_>) -> Result<(), Refusal> {
        if block.has_g(40) {
            let seconds = block
                .take(b'p')
                .ok_or(Refusal::WordMissing("G4".to_owned(), "P"))?;
            self.call(Canonical::Dwell(seconds), out)?;
        }
        let off = |code: u16, machine: &Machine| match machine.cutter.is_on() {
            true => Err(Refusal::NotUnderCompensation(groups::name(b'g', code))),
            false => Ok(()),
        };
        if let Some((code, _)) = block.g[groups::PLANE] {
            let plane = [Plane::Xy, Plane::Zx, Plane::Yz][usize::from(code / 10 - 17)];
            if plane != self.plane {
                off(code, self)?;
            }
            self.plane = plane;
            self.call(Canonical::SelectPlane(plane), out)?;
        }
        if let Some((code, _)) = block.g[groups::UNITS] {
            let unit = if code == 200 {
                LengthUnit::Inch
            } else {
                LengthUnit::Millimetre
            };
            if unit != self.unit {
                off(code, self)?;
            }
            let changes = unit != self.unit;
            self.use_unit(unit);
            self.call(Canonical::UseLengthUnits(unit), out)?;
            // The order of the standard sets the feed before the unit; but F of that block is meant in the new unit.
            if changes && block.has(b'f') && self.feed_mode != FeedMode::InverseTime {
                self.call(Canonical::FeedRateInNewUnit(self.feed), out)?;
            }
        }
        if let Some((code, _)) = block.g[groups::CUTTER] {
            self.compensate(code, block, out)?;
        }
        if let Some((code, _)) = block.g[groups::LENGTH] {
            self.tool_length(code, block, out)?;
        }
        if let Some((code, _)) = block.g[groups::SYSTEM] {
            self.use_system(code, out)?;
        }
        if let Some((code, _)) = block.g[groups::PATH] {
            self.path = match code {
                610 => PathControl::ExactPath,
                611 => PathControl::ExactStop,
                _ => PathControl::Continuous(block.take(b'p').unwrap_or_default()),
            };
            self.call(Canonical::SetMotionControlMode(self.path), out)?;
            if let PathControl::Continuous(tolerance) = self.path {
                self.naive = block.take(b'q').unwrap_or(tolerance);
                self.call(Canonical::SetNaivecamTolerance(self.naive), out)?;
            }
        }
        if let Some((code, _)) = block.g[groups::DISTANCE] {
            self.absolute = code == 900;
        }
        if let Some((code, _)) = block.g[groups::ARC_DISTANCE] {
            self.arc_absolute = code == 901;
        }
        if let Some((code, _)) = block.g[groups::RETRACT] {
            self.retract_to_r = code == 990;
        }
        if block.g[groups::SPINDLE_MODE].is_some() {
            self.call(Canonical::SetSpindleMode, out)?;
        }
        Ok(())
    }

    /// G40 to G42.1: the cutter of the tool, or of D; a diameter in D itself under G41.1 and G42.1.
    fn compensate(&mut self, code: u16, block: &mut Block, out: Out<'_>) -> Result<(), Refusal> {
        if code == 400 {
            return self.cutter.end(out);
        }
        let diameter = if matches!(code, 411 | 421) {
            block.take(b'l');
            block
                .take(b'd')
                .ok_or(Refusal::WordMissing(groups::name(b'g', code), "D"))?
        } else {
            let number = match block.take(b'd') {
                Some(number) => tool_number('D', number)?,
                None => self.tool,
            };
            let tool = self.tool(number)?.ok_or(Refusal::DiameterUnknown(number))?;
            if tool.orientation != 0 {
                return Err(Refusal::TurningTool(number, tool.orientation));
            }
            tool.diameter * self.tools.unit.in_units_of(self.unit)
        };
        let left = if matches!(code, 410 | 411) { 0.5 } else { -0.5 };
        self.cutter.begin(self.plane, left * diameter)
    }

    /// Codes that use axis words: codes for one block, then motion, given here or by a previous block.
    fn moves(&mut self, block: &mut Block, out: Out<'_>) -> Result<(), Refusal> {
        let once = block.g[groups::ONCE]
            .map(|(code, _)| code)
            .filter(|code| *code != 40);
        let given = block.g[groups::MOTION].map(|(code, _)| code);
        // G43.1 has taken the axis words of its block.
        let takes_axes = once.filter(|code| matches!(code, 100 | 280 | 300 | 520 | 920));
        if let (Some(once), Some(given)) = (takes_axes, given.filter(|code| *code != 800))
            && block.has_axes()
        {
            return Err(Refusal::AxesTwice(
                groups::name(b'g', once),
                groups::name(b'g', given),
            ));
        }
        match once {
            Some(100) => self.set_data(block, out)?,
            Some(code @ (280 | 300)) => self.home(code, block, out)?,
            Some(code @ (281 | 301)) => self.store_home(code),
            Some(code) => self.shift(code, block, out)?,
            None => {}
        }
        // Axis words that no other code uses move the tip, by the code in this block or by the modal one.
        let moving = takes_axes.is_none()
            && !block.has_g(431)
            && (block.has_axes() || self.vector && block.has_vector());
        let code = match (given, moving) {
            (Some(code), _) => code,
            (None, true) => self.motion,
            (None, false) => return Ok(()),
        };
        if moving && !self.unit_given {
            self.unit_given = true;
            self.warn(Warning::UnitAssumed);
        }
        if block.g[groups::MACHINE].is_some() && !matches!(code, 0 | 10) {
            return Err(Refusal::MachineCoordinates);
        }
        let result = match code {
            0 | 10 => self.straight(code, block, out),
            20 | 30 => self.arc(code, block, out),
            382..=385 if !block.has_axes() => Err(Refusal::AxesMissing(groups::name(b'g', code))),
            382..=385 => Err(Refusal::Unsupported {
                code: groups::name(b'g', code),
                reason: "where a probe stops is not in the program",
            }),
            800 if block.has_axes() => Err(Refusal::AxesWithoutMotion),
            800 => Ok(()),
            _ => self.cycle(code, block, out),
        };
        // In force from here on even where this block was refused, so that later ones are read as they were meant.
        self.motion = code;
        result
    }

    /// Calls and ends. What M0, M1 and M60 wait for has no part in the path.
    fn stopping(&mut self, block: &mut Block, out: Out<'_>) -> Result<Outcome, Refusal> {
        if let Some((code, _)) = block.m[groups::CALL] {
            if code == 99 {
                block.take(b'p');
                return Ok(Outcome::Return);
            }
            let number = block
                .take(b'p')
                .ok_or(Refusal::WordMissing("M98".to_owned(), "P"))?;
            let times = block.take(b'l').unwrap_or(1.0);
            if !(0.0..=MOST_CALLS).contains(&times) || times.fract() != 0.0 {
                let requested = "a whole number, at most 9999";
                return Err(Refusal::WordValue {
                    word: 'L',
                    value: times,
                    requested,
                });
            }
            return Ok(Outcome::Call(NumberedCall {
                number: tool_number('P', number)?,
                times: times as u32,
            }));
        }
        match block.m[groups::STOPPING] {
            Some((2 | 30, _)) => {
                self.finish(out)?;
                Ok(Outcome::End)
            }
            Some(_) => {
                self.call(Canonical::ProgramStop, out)?;
                Ok(Outcome::Next)
            }
            None => Ok(Outcome::Next),
        }
    }

    /// M2 and M30: back to the modes that a program begins with.
    fn finish(&mut self, out: Out<'_>) -> Result<(), Refusal> {
        self.cutter.end(out)?;
        let (zero, turn) = self.stored_system(1)?;
        self.recount(|machine| (machine.system, machine.g5x, machine.turn) = (1, zero, turn));
        self.call(Canonical::SetG5xOffset(1, zero), out)?;
        self.call(Canonical::SetXyRotation(turn), out)?;
        if self.plane != Plane::Xy {
            self.plane = Plane::Xy;
            self.call(Canonical::SelectPlane(Plane::Xy), out)?;
        }
        self.call(
            Canonical::SetFeedMode {
                per_revolution: false,
            },
            out,
        )?;
        self.call(Canonical::SetFeedRate(0.0), out)?;
        self.call(Canonical::StopSpindleTurning, out)?;
        self.call(Canonical::SetSpindleMode, out)?;
        self.call(Canonical::ProgramEnd, out)
    }
}

//! Canned cycles G73 and G81 to G89: a hole as the moves it takes.
//!
//! | cycle | at the bottom | back |
//! |---|---|---|
//! | G81, G82 | G82 waits P | fast |
//! | G83, G73 | by steps of Q; G83 clears the hole, G73 breaks the chip | fast |
//! | G84 | the spindle turns back | at feed |
//! | G85, G89 | G89 waits P | at feed |
//! | G86, G88 | waits P, the spindle stops; G88 waits for the operator | fast |
//!
//! G98 retracts to the position of the axis before the cycle, G99 to R.
//!
//! ```text
//! G81 X_ Y_ Z_ R_ L_      Z bottom, R where it begins to cut, L holes
//! X_ Y_                   another hole of the same cycle: words stay until the code changes
//! ```
//!
//! Z and R apply to the axis across the plane. Under G91 R is relative to the position of the axis and Z to R, and L
//! holes go on by the same step.
//!
//! Source: NISTIR 6556, section 3.5.16; G73: LinuxCNC documentation.

use super::block::{Block, shown};
use super::canonical::{Axes, Canonical, PathControl};
use super::cutter::Out;
use super::groups;
use super::machine::{Cycle, FeedMode, Machine};
use super::read_options::Warning;
use super::refusal::{Excess, Refusal};

/// Gap between the drill and the bottom it comes back to, mm and inch: 0.010 inch as in NISTIR 6556.
const PECK_GAP: [f64; 2] = [0.254, 0.010];
/// Holes of one block.
const MOST_REPEATS: f64 = 100_000.0;
/// Steps of one hole.
const MOST_PECKS: f64 = 100_000.0;

/// How a stroke is made.
type Straight = fn(Axes) -> Canonical;
/// G0.
const FAST: Straight = Canonical::StraightTraverse;
/// G1.
const CUTTING: Straight = Canonical::StraightFeed;

/// A hole.
#[derive(Clone, Copy)]
struct Hole {
    /// Along the first and second axis of the plane.
    at: [f64; 2],
    /// Where it begins to cut, along the axis across.
    clear: f64,
    /// Where it ends.
    bottom: f64,
    /// Where it goes back to: R under G99, else the height before the cycle, or R where that is higher.
    back: f64,
}

impl Machine {
    /// Executes a block of a cycle, code in tenths: up to R if the axis is below, then hole by hole. Corners are
    /// followed exactly meanwhile.
    ///
    /// # Errors
    /// Refusals of `may_drill` and `keep`, L that is not a number of holes, R below the bottom, more than 100000 steps.
    pub(super) fn cycle(&mut self, code: u16, block: &mut Block, out: Out<'_>) -> Result<(), Refusal> {
        self.may_drill(code, block)?;
        let [first, second, across] = self.plane.axes();
        let words = block.axes();
        self.keep(code, words[across], block)?;
        let repeats = match block.take(b'l') {
            None => 1.0,
            Some(repeats) if repeats >= 0.0 && repeats.fract() == 0.0 && repeats <= MOST_REPEATS => repeats,
            Some(value) => {
                let requested = "a whole number of holes, at most 100000";
                return Err(Refusal::WordValue {
                    word: 'L',
                    value,
                    requested,
                });
            }
        };
        let Cycle {
            mut clear,
            mut bottom,
            ..
        } = self.cycle;
        if !self.absolute {
            clear += self.at[across];
            bottom += clear;
        }
        if clear < bottom {
            return Err(Refusal::ClearBelowBottom { clear, bottom });
        }
        if self.at[across] < clear {
            self.across_to(clear, FAST, out)?;
        }
        let back = if self.retract_to_r { clear } else { self.at[across] };
        let continuous = matches!(self.path, PathControl::Continuous(_));
        if continuous {
            self.call(Canonical::SetMotionControlMode(PathControl::ExactPath), out)?;
        }
        // Proven whole and at most MOST_REPEATS.
        for _ in 0..repeats as u32 {
            let target = self.target(words);
            let at = [target[first], target[second]];
            self.hole(
                code,
                Hole {
                    at,
                    clear,
                    bottom,
                    back,
                },
                out,
            )?;
        }
        if continuous {
            self.call(Canonical::SetMotionControlMode(self.path), out)?;
            self.call(Canonical::SetNaivecamTolerance(self.naive), out)?;
        }
        Ok(())
    }

    /// Whether a hole may be drilled here and now.
    ///
    /// # Errors
    /// Rotary words, cutter compensation, no axis word, inverse time, no feed.
    fn may_drill(&self, code: u16, block: &Block) -> Result<(), Refusal> {
        let name = groups::name(b'g', code);
        if let Some(letter) = b"abc".iter().find(|letter| block.has(**letter)) {
            return Err(Refusal::RotaryInCycle { word: shown(*letter) });
        }
        if self.cutter.is_on() {
            return Err(Refusal::NotUnderCompensation(name));
        }
        if !block.has_axes() {
            return Err(Refusal::AxesMissing(name));
        }
        if self.feed_mode == FeedMode::InverseTime {
            return Err(Refusal::NoInverseTime(name));
        }
        match self.feed == 0.0 {
            true => Err(Refusal::NoFeed(name)),
            false => Ok(()),
        }
    }

    /// Takes the words of the cycle, or those of its block before.
    ///
    /// Words of the block before count only where the code is the same.
    fn keep(&mut self, code: u16, bottom: Option<f64>, block: &mut Block) -> Result<(), Refusal> {
        let missing = |word| Refusal::WordMissing(groups::name(b'g', code), word);
        let again = self.motion == code;
        let mut kept = if again { self.cycle } else { Cycle::default() };
        match (block.take(b'r'), again) {
            (Some(clear), _) => kept.clear = clear,
            (None, true) => {}
            (None, false) => return Err(missing("R")),
        }
        match (bottom, again) {
            (Some(bottom), _) => kept.bottom = bottom,
            (None, true) => {}
            (None, false) => {
                let [.., across] = self.plane.axes();
                return Err(missing(["X", "Y", "Z"][across]));
            }
        }
        if matches!(code, 730 | 830) {
            kept.step = block.take(b'q').or(kept.step);
            match kept.step {
                None => return Err(missing("Q")),
                Some(step) if step > 0.0 => {}
                Some(value) => {
                    return Err(Refusal::WordValue {
                        word: 'Q',
                        value,
                        requested: "above 0",
                    });
                }
            }
        }
        if matches!(code, 820 | 840 | 860 | 880 | 890) {
            kept.dwell = block.take(b'p').or(kept.dwell);
            if kept.dwell.is_none() && code != 840 {
                return Err(missing("P"));
            }
        }
        self.cycle = kept;
        Ok(())
    }

    /// Moves along the axis across alone.
    fn across_to(&mut self, to: f64, how: Straight, out: Out<'_>) -> Result<(), Refusal> {
        let [.., across] = self.plane.axes();
        let mut end = self.at;
        end[across] = to;
        self.to(end, how, out)
    }

    /// Moves to a position.
    fn to(&mut self, end: Axes, how: Straight, out: Out<'_>) -> Result<(), Refusal> {
        self.at = end;
        self.call(how(end), out)
    }

    /// The moves of one hole: above it, down to R, the strokes, and back. Behind G86 and G88 the spindle turns
    /// as it did before.
    fn hole(&mut self, code: u16, hole: Hole, out: Out<'_>) -> Result<(), Refusal> {
        let [first, second, across] = self.plane.axes();
        let mut above = self.at;
        (above[first], above[second]) = (hole.at[0], hole.at[1]);
        self.to(above, FAST, out)?;
        if self.at[across] != hole.clear {
            self.across_to(hole.clear, FAST, out)?;
        }
        if let (730 | 830, Some(step)) = (code, self.cycle.step) {
            self.pecks(code, step, hole, out)?;
        }
        self.across_to(hole.bottom, CUTTING, out)?;
        if let Some(seconds) = self.cycle.dwell {
            self.call(Canonical::Dwell(seconds), out)?;
        }
        match code {
            840 => {
                self.warn(Warning::Tapping);
                self.across_to(hole.clear, CUTTING, out)?;
            }
            850 | 890 => self.across_to(hole.clear, CUTTING, out)?,
            860 | 880 => {
                self.call(Canonical::StopSpindleTurning, out)?;
                if code == 880 {
                    self.call(Canonical::ProgramStop, out)?;
                }
                self.across_to(hole.back, FAST, out)?;
                return self.call(self.spindle.clone(), out);
            }
            _ => {}
        }
        if self.at[across] != hole.back {
            self.across_to(hole.back, FAST, out)?;
        }
        Ok(())
    }

    /// The strokes before the last: G83 goes back to R after each, G73 by the gap alone.
    fn pecks(&mut self, code: u16, step: f64, hole: Hole, out: Out<'_>) -> Result<(), Refusal> {
        let pecks = ((hole.clear - hole.bottom) / step).ceil() - 1.0;
        if pecks > MOST_PECKS {
            let limit = MOST_PECKS as usize;
            return Err(Refusal::TooMuch {
                what: Excess::Pecks,
                limit,
            });
        }
        let gap = self.unit.choose(PECK_GAP);
        // At most MOST_PECKS.
        for peck in 1..=pecks.max(0.0) as u32 {
            let depth = hole.clear - step * f64::from(peck);
            self.across_to(depth, CUTTING, out)?;
            if code == 830 {
                self.across_to(hole.clear, FAST, out)?;
            }
            self.across_to((depth + gap).min(hole.clear), FAST, out)?;
        }
        Ok(())
    }
}

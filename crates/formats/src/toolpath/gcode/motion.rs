//! Lines and arcs: where a block says that the tip goes, as canonical calls.
//!
//! The centre of an arc given by its radius `R`: `M + h n`, `h = sqrt(R^2 - d^2 / 4)`, on the side that makes the arc
//! shorter than half a turn where `R > 0`.
//!
//! | symbol | meaning |
//! |---|---|
//! | `d`, `M`, `n` | length, middle and normal of the chord |
//!
//! Source: NISTIR 6556, section 3.5.3; how far start and end radius may differ: the interpreter tests of LinuxCNC,
//! `tests/interp/bad/README.arc-radius-tolerance`.

use std::f64::consts::{SQRT_2, TAU};
use std::ops::RangeInclusive;

use armill_core::nalgebra::{Point2, Vector2, Vector3, center};

use super::block::{Block, shown, within};
use super::canonical::{ArcFeed, Axes, Canonical, Sense};
use super::contour::{Contour, ContourMove, sweep};
use super::cutter::Out;
use super::groups;
use super::machine::{FeedMode, Machine};
use super::parameters;
use super::read_options::Warning;
use super::refusal::Refusal;

/// Least difference of radii that is looked at, per 2 sqrt(2): mm and inch.
const RADII_APART: [f64; 2] = [0.01, 0.001];
/// Differences so many times larger are refused on any arc.
const RADII_FAR_APART: f64 = 100.0;
/// Part of the radius that lesser differences may be.
const RADII_RELATIVE: f64 = 1e-3;
/// Turns of one helix: a spring, not a cut.
const MOST_TURNS: f64 = 10_000.0;
/// Range of the length of a tool axis given as a vector: beyond it digits are lost.
const VECTOR_LENGTHS: RangeInclusive<f64> = 1e-6..=1e6;

impl Machine {
    /// Where the axis words of a block lead.
    ///
    /// Counted from the program's zero under G90, from the tip under G91; an axis without word stays.
    pub(super) fn target(&self, words: [Option<f64>; 6]) -> Axes {
        std::array::from_fn(|axis| match words[axis] {
            Some(value) if self.absolute => value,
            Some(value) => self.at[axis] + value,
            None => self.at[axis],
        })
    }

    /// G0 and G1.
    ///
    /// With G53 the words are machine coordinates, and always absolute.
    ///
    /// # Errors
    /// A cut without feed, G53 under cutter compensation, an end beyond 1e9.
    pub(super) fn straight(&mut self, code: u16, block: &mut Block, out: Out<'_>) -> Result<(), Refusal> {
        let vector = self.vector_words(block, out)?;
        if !block.has_axes() && !vector {
            // G1 alone is modal: it says how later blocks move.
            return Ok(());
        }
        let words = block.axes();
        let mut end = self.target(words);
        if block.g[groups::MACHINE].is_some() {
            if self.cutter.is_on() {
                return Err(Refusal::NotUnderCompensation("G53".to_owned()));
            }
            let mut machine = self.in_machine(self.at);
            for (place, word) in machine.iter_mut().zip(words) {
                *place = word.unwrap_or(*place);
            }
            end = self.in_program(machine);
            self.call(Canonical::MachineCoordinates, out)?;
        }
        bounded(&end)?;
        if code == 10 {
            let length = length(&self.at, &end);
            self.feed_for(code, block, length, out)?;
        }
        let call = if code == 0 {
            Canonical::StraightTraverse(end)
        } else {
            Canonical::StraightFeed(end)
        };
        self.follow(Contour::Line, call, out)?;
        self.at = end;
        Ok(())
    }

    /// Gives a move to cutter compensation, which gives it on.
    fn follow(&mut self, contour: Contour, call: Canonical, out: Out<'_>) -> Result<(), Refusal> {
        let [first, second, across] = self.plane.axes();
        let next = ContourMove {
            contour,
            from: Point2::new(self.at[first], self.at[second]),
            across: self.at[across],
            call,
        };
        self.cutter.follow(next, out)
    }

    /// I, J, K under G43.5.
    ///
    /// Returns whether the block has them; the tool axis is a separate call.
    fn vector_words(&mut self, block: &mut Block, out: Out<'_>) -> Result<bool, Refusal> {
        if !self.vector || !block.has_vector() {
            return Ok(false);
        }
        let axis = b"ijk".map(|letter| block.take(letter).unwrap_or_default());
        let length = Vector3::from(axis).norm();
        if !VECTOR_LENGTHS.contains(&length) {
            return Err(Refusal::NoDirection { length });
        }
        self.call(Canonical::ToolAxis(axis), out)?;
        Ok(true)
    }

    /// Whether a cut of this length has a feed, and under inverse time which.
    ///
    /// `length` is what F counts along, see below.
    fn feed_for(&mut self, code: u16, block: &Block, length: f64, out: Out<'_>) -> Result<(), Refusal> {
        if self.feed_mode == FeedMode::InverseTime {
            return match block.peek(b'f') {
                Some(feed) => self.call(Canonical::SetFeedRate(feed * length), out),
                None => Err(Refusal::NoInverseTime(groups::name(b'g', code))),
            };
        }
        if self.feed == 0.0 {
            return Err(Refusal::NoFeed(groups::name(b'g', code)));
        }
        Ok(())
    }

    /// G2 and G3.
    ///
    /// Turns about the axis across the plane; words of that axis make a helix, P its turns, begun ones counted.
    ///
    /// # Errors
    /// No centre or two, radii that differ, P that is not a number of turns, no feed.
    pub(super) fn arc(&mut self, code: u16, block: &mut Block, out: Out<'_>) -> Result<(), Refusal> {
        let [first, second, across] = self.plane.axes();
        let end = self.target(block.axes());
        bounded(&end)?;
        let sense = match code {
            30 => Sense::Counterclockwise,
            _ => Sense::Clockwise,
        };
        let start = Point2::new(self.at[first], self.at[second]);
        let stop = Point2::new(end[first], end[second]);
        let centre = self.centre(block, start, stop, sense)?;
        let turns = match block.take(b'p') {
            None => 1.0,
            Some(turns) if turns >= 1.0 && turns.fract() == 0.0 && turns <= MOST_TURNS => turns,
            Some(value) => {
                return Err(Refusal::WordValue {
                    word: 'P',
                    value,
                    requested: "a whole number of turns, 1 to 10000",
                });
            }
        };
        let radius = (start - centre).norm();
        let swept = sweep(start - centre, stop - centre, sense) + TAU * (turns - 1.0);
        let length = (radius * swept).hypot(end[across] - self.at[across]);
        self.feed_for(code, block, length, out)?;
        let call = Canonical::ArcFeed(ArcFeed {
            plane: self.plane,
            end: stop.into(),
            centre: centre.into(),
            // At most MOST_TURNS.
            turns: sense.sign() * turns as i32,
            across: end[across],
            rotary: [end[3], end[4], end[5]],
        });
        self.follow(Contour::Arc { centre, sense }, call, out)?;
        self.at = end;
        Ok(())
    }

    /// The centre of an arc given by I, J, K or R.
    ///
    /// I, J, K count from the start, or are the centre itself under G90.1; one that is left out is that of the start.
    fn centre(
        &self,
        block: &mut Block,
        start: Point2<f64>,
        stop: Point2<f64>,
        sense: Sense,
    ) -> Result<Point2<f64>, Refusal> {
        let [first, second, _] = self.plane.axes();
        let words = [b"ijk"[first], b"ijk"[second]].map(|letter| block.take(letter));
        match (block.take(b'r'), words) {
            (Some(_), [Some(_), _] | [_, Some(_)]) => Err(Refusal::ArcWithBoth),
            (Some(radius), _) => centre_by_radius(start, stop, radius, sense),
            (None, [None, None]) => Err(Refusal::ArcWithoutCentre),
            (None, words) => {
                let base = if self.arc_absolute {
                    Point2::origin()
                } else {
                    start
                };
                let word = |index: usize| match words[index] {
                    Some(value) => base[index] + value,
                    None => start[index],
                };
                let centre = Point2::new(word(0), word(1));
                self.check_radii((start - centre).norm(), (stop - centre).norm())?;
                Ok(centre)
            }
        }
    }

    /// Radii at start and end: they may differ by a thousandth of the larger, but by no less than 0.028 mm (0.0028
    /// inch) and no more than a hundred times that.
    fn check_radii(&self, radius: f64, end_radius: f64) -> Result<(), Refusal> {
        if radius == 0.0 {
            return Err(Refusal::ArcPoint);
        }
        let least = self.unit.choose(RADII_APART) * 2.0 * SQRT_2;
        let apart = (radius - end_radius).abs();
        let limit = (RADII_RELATIVE * radius.max(end_radius)).clamp(least, RADII_FAR_APART * least);
        if apart > limit {
            return Err(Refusal::ArcRadii {
                radius,
                end_radius,
                limit,
            });
        }
        Ok(())
    }

    /// G28 and G30: by a point of the program to the stored place of the machine.
    ///
    /// Both are rapids. Only axes with words go to the stored place; all where no axis has one.
    pub(super) fn home(&mut self, code: u16, block: &mut Block, out: Out<'_>) -> Result<(), Refusal> {
        if self.cutter.is_on() {
            return Err(Refusal::NotUnderCompensation(groups::name(b'g', code)));
        }
        let stored = self.stored(parameters::home_of(code))?;
        if stored == [0.0; 6] {
            self.warn(Warning::HomeAssumed);
        }
        let words = block.axes();
        self.at = self.target(words);
        bounded(&self.at)?;
        self.call(Canonical::StraightTraverse(self.at), out)?;
        let mut machine = self.in_machine(self.at);
        let all = words.iter().all(Option::is_none);
        for axis in 0..6 {
            if all || words[axis].is_some() {
                machine[axis] = stored[axis];
            }
        }
        self.at = self.in_program(machine);
        self.call(Canonical::MachineCoordinates, out)?;
        self.call(Canonical::StraightTraverse(self.at), out)
    }
}

/// Increments may add up to what no word may say.
fn bounded(end: &Axes) -> Result<(), Refusal> {
    let mut axes = end.iter().zip(b"xyzabc");
    axes.try_for_each(|(value, letter)| within(shown(*letter), *value))
}

/// Length to which the feed refers: the path of the tip, or degrees if it does not move.
fn length(from: &Axes, to: &Axes) -> f64 {
    let apart = |axes: std::ops::Range<usize>| {
        axes.map(|axis| (to[axis] - from[axis]).powi(2))
            .sum::<f64>()
            .sqrt()
    };
    match apart(0..3) {
        0.0 => apart(3..6),
        length => length,
    }
}

/// The centre of an arc by its radius; see the equation above.
///
/// # Errors
/// Ends at one point, ends farther apart than twice the radius, but for a thousandth.
fn centre_by_radius(
    start: Point2<f64>,
    stop: Point2<f64>,
    radius: f64,
    sense: Sense,
) -> Result<Point2<f64>, Refusal> {
    let chord = stop - start;
    let d = chord.norm();
    if d == 0.0 {
        return Err(Refusal::ArcAnywhere);
    }
    let square = radius * radius - d * d / 4.0;
    // A half circle, rounded: the radius may be too small by its last digit.
    if d / 2.0 > radius.abs() * (1.0 + RADII_RELATIVE) {
        return Err(Refusal::ArcTooSmall { radius, chord: d });
    }
    let n = Vector2::new(-chord.y, chord.x) / d;
    let h = square.max(0.0).sqrt();
    let left = (radius > 0.0) == (sense == Sense::Counterclockwise);
    Ok(center(&start, &stop) + if left { n * h } else { -n * h })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn a_radius_above_zero_makes_the_shorter_arc() {
        let (start, stop) = (Point2::new(0.0, 0.0), Point2::new(2.0, 0.0));
        let senses = [Sense::Counterclockwise, Sense::Clockwise];
        for (radius, sense, shorter) in [
            (2.0, senses[0], true),
            (2.0, senses[1], true),
            (-2.0, senses[0], false),
            (-2.0, senses[1], false),
        ] {
            let centre = centre_by_radius(start, stop, radius, sense).unwrap();
            assert!(((start - centre).norm() - 2.0).abs() < 1e-15, "one rounding");
            let sweep = sweep(start - centre, stop - centre, sense);
            assert_eq!(sweep < PI, shorter, "R {radius} {sense:?}");
        }
    }
}

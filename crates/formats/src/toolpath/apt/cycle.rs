//! Drilling cycles as moves: each GOTO between CYCLE/... and CYCLE/OFF is the top of a hole `p`, tool axis `a`.
//!
//! | parameter | meaning |
//! |---|---|
//! | `FEDTO,d` | depth: the tip cuts to `p - d a`; NX writes it with the sign of the axis, below the point negative |
//! | `RAPTO,h` | the tip cuts from `p + h a` on |
//! | `RTRCTO,h` | between holes it goes at `p + h a`; without it at RAPTO |
//! | `MMPM,v`, `IPM`, `MMPR`, `IPR` | feed of the cycle; without it that of FEDRAT |
//! | `INCR,q` (DEEP) | depth of a peck |
//! | `1STPECK,q`, `SUBPECK,q` (DEEP2) | of the first, of each that follows |
//! | `DWELL,t` | dwell at the bottom, s |
//!
//! Pecks count from RAPTO; after each the tip goes back there and down again in rapid. What is cut is the same if a
//! machine only breaks the chip. The cycles are DRILL, DEEP and DEEP2, and BORE, REAM and TAP, which cut on the way
//! down as DRILL does; others are refused, since what they do depends on the machine.

use armill_core::nalgebra::{Point3, Unit, Vector3};
use armill_core::path::{Command, Course, Move, Pace};

use super::modal::Interpreter;
use super::options::Dialect;
use super::settings::{Cycle, Feed};
use super::statement::Statement;

/// No hole has more pecks.
const MOST_PECKS: f64 = 1000.0;

/// The parameters of a CYCLE, in its own units.
#[derive(Default)]
struct Parameters {
    /// FEDTO.
    depth: Option<f64>,
    rapid_to: Option<f64>,
    retract_to: Option<f64>,
    /// INCR or 1STPECK.
    first_peck: Option<f64>,
    /// SUBPECK.
    next_peck: Option<f64>,
    dwell: Option<f64>,
    feed: Option<Feed>,
}

impl Interpreter<'_> {
    /// CYCLE/...
    ///
    /// A refused cycle also ends the previous one, so that its points are not drilled with it.
    pub fn cycle(&mut self, statement: &Statement) {
        let kind = statement.word_at(0);
        match kind.as_str() {
            "OFF" => self.cycle = None,
            // Opens the list of holes, and chooses how to go between them: the cycle itself follows.
            "INIT" | "CLEAR" => self.ignore(statement),
            "DRILL" | "DEEP" | "DEEP2" => self.drill(statement, &kind),
            "BORE" | "REAM" | "TAP" => {
                self.warn(
                    statement,
                    format!("CYCLE/{kind} is read as DRILL: retract in rapid, spindle behaviour ignored"),
                );
                self.drill(statement, "DRILL");
            }
            _ => {
                let message = format!("the cycle `{kind}` is not supported");
                let hint = "supported: DRILL, DEEP, DEEP2, BORE, REAM and TAP; let the CAM system write others as GOTO";
                let span = statement
                    .parameters()
                    .next()
                    .map_or(statement.word_span(), |first| first.span);
                self.report(statement, span, message, hint);
            }
        }
    }

    /// A cycle of the kind DRILL, DEEP or DEEP2: pairs of a word and its number.
    fn drill(&mut self, statement: &Statement, kind: &str) {
        let metres = self.metres(statement);
        let before = self.problems.len();
        let mut given = Parameters::default();
        let mut parameters = statement.parameters().skip(1);
        while let Some(key) = parameters.next() {
            let name = key.text.to_uppercase();
            let Some(value) = parameters.next() else {
                let message = format!("`{name}` has no number");
                self.report(
                    statement,
                    key.span,
                    message,
                    "each word of a cycle needs a number after it",
                );
                break;
            };
            let Some(value) = self.number(statement, &value) else {
                continue;
            };
            match name.as_str() {
                "FEDTO" => given.depth = Some(value * metres),
                "RAPTO" => given.rapid_to = Some(value * metres),
                "RTRCTO" => given.retract_to = Some(value * metres),
                "INCR" if kind == "DEEP" => given.first_peck = Some(value * metres),
                "1STPECK" if kind == "DEEP2" => given.first_peck = Some(value * metres),
                "SUBPECK" if kind == "DEEP2" => given.next_peck = Some(value * metres),
                "DWELL" => given.dwell = Some(value),
                "MMPM" | "IPM" | "MMPR" | "IPR" => given.feed = self.feed_in(statement, &name, value),
                _ => {
                    let message = format!("`{name}` is not supported in the cycle {kind}");
                    let hint = "supported: FEDTO, RAPTO, RTRCTO, DWELL, MMPM, IPM, MMPR, IPR; in DEEP INCR, in \
                                DEEP2 1STPECK and SUBPECK";
                    self.report(statement, key.span, message, hint);
                }
            }
        }
        self.cycle = None;
        if self.problems.len() > before {
            return;
        }
        match made(&given, kind, self.dialect) {
            Ok(cycle) => self.cycle = Some(cycle),
            Err((message, hint)) => self.report(statement, statement.parameters_span(), message, hint),
        }
    }

    /// The moves of a hole with this top.
    ///
    /// In rapid to the retract height and the height where it begins to cut, then pecks or one cut down, then back in
    /// rapid.
    pub fn hole(
        &mut self,
        statement: &Statement,
        cycle: &Cycle,
        top: Point3<f64>,
        axis: Option<Unit<Vector3<f64>>>,
    ) {
        let Some(up) = axis else {
            let message = "a hole, but the tool axis is not given";
            self.report(
                statement,
                statement.parameters_span(),
                message,
                "write the axis: `GOTO/x,y,z,i,j,k`",
            );
            return;
        };
        let modal = self.feed;
        self.feed = cycle.feed.or(modal);
        let feed = self.pace(statement);
        self.feed = modal;
        let to_height = |height: f64, pace: Pace| Move {
            end: top + up.into_inner() * height,
            axis,
            spin: None,
            course: Course::Line,
            pace,
            line: statement.line(),
        };
        let mut go = |height: f64, pace: Pace| self.give(statement, to_height(height, pace));
        go(cycle.retract_to, Pace::Rapid);
        go(cycle.rapid_to, Pace::Rapid);
        let bottom = -cycle.depth;
        let mut reached = cycle.rapid_to;
        // `made` has bounded the number of pecks.
        for peck in cycle
            .pecks
            .into_iter()
            .flat_map(|[first, next]| std::iter::once(first).chain(std::iter::repeat(next)))
        {
            let to = reached - peck;
            // A last peck of nothing but rounding is none.
            if to <= bottom + 1e-9 {
                break;
            }
            go(to, feed);
            go(cycle.rapid_to, Pace::Rapid);
            go(to, Pace::Rapid);
            reached = to;
        }
        go(bottom, feed);
        if cycle.dwell > 0.0 {
            self.command(Command::Dwell(cycle.dwell));
        }
        let mut go = |height: f64, pace: Pace| self.give(statement, to_height(height, pace));
        go(cycle.retract_to, Pace::Rapid);
    }
}

/// The given cycle, or the problem and a hint.
///
/// Refused are: no depth or height, nothing to cut below the point, a retract height below that where it begins to cut,
/// more than 1000 pecks.
fn made(given: &Parameters, kind: &str, dialect: Option<Dialect>) -> Result<Cycle, (String, &'static str)> {
    let missing = |name: &str| {
        let hint =
            "a cycle needs its depth (FEDTO) and the height above the point where it begins to cut (RAPTO)";
        (format!("the cycle {kind} has no {name}"), hint)
    };
    let fed_to = given.depth.ok_or_else(|| missing("FEDTO"))?;
    let rapid_to = given.rapid_to.ok_or_else(|| missing("RAPTO"))?;
    let depth = match dialect {
        Some(Dialect::Nx) => -fed_to,
        _ => fed_to,
    };
    if depth + rapid_to <= 0.0 || depth < 0.0 {
        let hint = match dialect {
            Some(Dialect::Nx) => "NX writes a depth below the point as a negative FEDTO",
            _ => "a depth below the point is a positive FEDTO",
        };
        return Err((format!("the cycle {kind} cuts nothing below its points"), hint));
    }
    let retract_to = given.retract_to.unwrap_or(rapid_to);
    if retract_to < rapid_to {
        let hint = "RTRCTO and RAPTO are heights above the point";
        return Err((
            format!("the cycle {kind} retracts lower (RTRCTO) than it begins to cut (RAPTO)"),
            hint,
        ));
    }
    let pecks = match kind {
        "DRILL" => None,
        _ => {
            let first = given
                .first_peck
                .ok_or_else(|| missing(if kind == "DEEP" { "INCR" } else { "1STPECK" }))?;
            let next = given.next_peck.unwrap_or(first);
            let most = (depth + rapid_to) / MOST_PECKS;
            if first < most || next < most {
                let hint = "the depth of a peck is a length above 0";
                return Err((
                    format!("the cycle {kind} needs more than {MOST_PECKS} pecks"),
                    hint,
                ));
            }
            Some([first, next])
        }
    };
    Ok(Cycle {
        depth,
        rapid_to,
        retract_to,
        feed: given.feed,
        pecks,
        dwell: given.dwell.unwrap_or_default(),
    })
}

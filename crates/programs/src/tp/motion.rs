//! A move of a program: its positions, its speed and options, and rows of A.

use super::frames::Frames;
use super::position::Taught;
use super::read::{Program, Reader, SHIFTS};
use super::statement::{Statement, index};
use crate::arc_row::{ArcEnd, Next};
use crate::program::{FrameKind, FramedTarget, Motion, RobotMove, Speed, Target};
use crate::spelling::{Part, number};
use armill_core::path::Passage;

/// Units of speed: a length in m and a time in s; `None` if the unit does not give the tip speed.
const UNITS: [(&str, Option<[f64; 2]>); 10] = [
    ("mm/sec", Some([1e-3, 1.0])),
    ("mm/sek", Some([1e-3, 1.0])),
    ("cm/min", Some([1e-2, 60.0])),
    ("inch/min", Some([0.0254, 60.0])),
    ("deg/sec", None),
    ("msec", None),
    ("sec", None),
    ("msek", None),
    ("sek", None),
    ("%", None),
];

impl Reader<'_> {
    /// J, L, C, A or S, with the words after it.
    pub fn motion(&mut self, program: &mut Program, statement: &Statement) {
        let kind = statement.word(0).to_ascii_uppercase();
        let goals = if kind == "C" { 2 } else { 1 };
        let (words, rest) = statement.words[1..].split_at(goals.min(statement.words.len() - 1));
        if !matches!(kind.as_str(), "J" | "L" | "C" | "A" | "S") {
            let message = format!("the move `{kind}` is not followed");
            let hint = "supported: J, L, C, A and S";
            self.messages.problem(statement.span.clone(), message, hint);
            return;
        }
        let mut goals: Vec<FramedTarget> = words
            .iter()
            .filter_map(|word| self.goal(program, statement, word))
            .collect();
        let speed = self.speed(statement, &kind, rest);
        if goals.len() < words.len() || !self.is_supported(statement, rest) {
            return;
        }
        let Some(end) = goals.pop() else {
            return;
        };
        if kind == "A" {
            let next = program.row.next(end, ArcEnd::Unmarked, statement.span.clone());
            return self.arc(statement, next, speed);
        }
        self.end_row(program);
        let motion = match (kind.as_str(), goals.pop()) {
            ("J", _) => Motion::Joint,
            ("C", Some(via)) => {
                return self.circle(statement, via, end, speed);
            }
            ("C", None) => {
                let message = "an arc with one position";
                let hint = "an arc needs two positions: `C P[1] P[2] 100mm/sec FINE`";
                self.messages.problem(statement.span.clone(), message, hint);
                return;
            }
            ("S", _) => {
                let what = "S is read as straight lines between its positions";
                self.messages.note(statement.line, what);
                Motion::Linear
            }
            _ => Motion::Linear,
        };
        let stops = rest.iter().any(|word| word.text.eq_ignore_ascii_case("FINE"));
        self.moves.push(RobotMove {
            // How far CNT rounds a corner depends on the controller.
            passage: if stops { Passage::Stop } else { Passage::Unknown },
            ..end.reached(motion, speed, statement.line)
        });
    }

    /// The target in a word of a move.
    fn goal(&mut self, program: &Program, statement: &Statement, word: &Part) -> Option<FramedTarget> {
        let elsewhere = |frames: &Frames| FramedTarget {
            target: Target::Elsewhere {
                name: word.text.to_owned(),
            },
            frame: frames.get(FrameKind::Reference, None),
            tool: frames.get(FrameKind::Tool, None),
        };
        let Some((at, _)) = index(word.text, "P") else {
            if index(word.text, "PR").is_some() {
                return Some(elsewhere(&self.frames));
            }
            let message = format!("`{}` is not a position", word.text);
            let hint = "a move names one position: `L P[1] 100mm/sec FINE`; an arc names two";
            self.messages.problem(word.range(), message, hint);
            return None;
        };
        let Some(number) = at.first().and_then(|at| at.parse::<u32>().ok()) else {
            return Some(elsewhere(&self.frames));
        };
        let position = program.positions.get(&number);
        let (message, hint) = match position.map(|position| &position.taught) {
            Some(Taught::There(target)) => {
                let [user, tool] = position.map_or([None; 2], |position| position.numbers);
                for (kind, own, what) in [
                    (FrameKind::Reference, user, "user frame"),
                    (FrameKind::Tool, tool, "tool"),
                ] {
                    if let (Some(own), Some(chosen)) = (own, self.frames.chosen(kind))
                        && own != chosen
                    {
                        let what = format!(
                            "positions of {what} {own} are used while {what} {chosen} is selected: they are read in \
                             their own {what}"
                        );
                        self.messages.note(statement.line, what);
                    }
                }
                return Some(FramedTarget {
                    target: target.clone(),
                    frame: self.frames.get(FrameKind::Reference, user),
                    tool: self.frames.get(FrameKind::Tool, tool),
                });
            }
            Some(Taught::Refused) => return None,
            Some(Taught::Missing(why)) => (
                format!("P[{number}] has no usable position: {why}"),
                "teach it, or write its numbers",
            ),
            None => (
                format!("the position P[{number}] is not in this listing"),
                "positions are listed after /POS: save the whole program as ASCII (.LS)",
            ),
        };
        self.messages.problem(word.range(), message, hint);
        None
    }

    fn speed(&mut self, statement: &Statement, kind: &str, rest: &[Part]) -> Speed {
        if kind == "J" {
            return Speed::Joints;
        }
        // The unit may be a separate word after the number.
        let apart = rest.first().is_some_and(|word| number(word.text).is_some());
        if let Some(word) = rest.get(usize::from(apart)) {
            let lower = word.text.to_ascii_lowercase();
            let unit = UNITS.iter().find(|(unit, _)| lower.ends_with(unit));
            let given = match (apart, unit) {
                (true, _) => rest.first().map_or("", |word| word.text),
                (false, Some((unit, _))) => word.text.get(..lower.len() - unit.len()).unwrap_or_default(),
                (false, None) => "",
            };
            let computed = given.starts_with(['R', 'r', 'A', 'a']) && given.contains('[');
            match (unit, number(given).filter(|value| *value >= 0.0)) {
                (None, _) => {}
                (Some((_, None)), _) => return Speed::Joints,
                (Some((_, Some([length, time]))), Some(value)) => return Speed::Tip(value * length / time),
                (Some(_), None) if computed => {
                    let what = "a speed from a register is not known";
                    self.messages.note(statement.line, what);
                    return Speed::Unknown;
                }
                (Some(_), None) => {
                    let message = format!("`{given}` is not a valid speed");
                    self.messages
                        .problem(word.range(), message, "write it as `100mm/sec`");
                    return Speed::Unknown;
                }
            }
        }
        let what = "a speed that the program does not give (WELD_SPEED, max_speed, ...) is not known";
        self.messages.note(statement.line, what);
        Speed::Unknown
    }

    /// Whether a move with these options ends at its position; otherwise a problem is added.
    fn is_supported(&mut self, statement: &Statement, rest: &[Part]) -> bool {
        for word in rest {
            let said = word.text.to_ascii_uppercase();
            let name = said.split([',', '[']).next().unwrap_or_default();
            let refused = match name {
                "INC" => Some("is incremental (INC)"),
                "RTCP" => Some("has a stationary tool (RTCP)"),
                _ => None,
            };
            if let Some(refused) = refused {
                let message = format!("this move {refused}, which is not supported");
                let hint = "write it as a move of a tool on the flange to a position";
                self.messages.problem(word.range(), message, hint);
                return false;
            }
            if SHIFTS.contains(&name) || name == "COORD" {
                let what = format!("{name} of moves is ignored: the taught positions are used");
                self.messages.note(statement.line, what);
            }
        }
        true
    }

    /// The meaning of an A in its row.
    fn arc(&mut self, statement: &Statement, next: Next<FramedTarget>, speed: Speed) {
        match next {
            Next::Straight(goal) => self
                .moves
                .push(goal.reached(Motion::Linear, speed, statement.line)),
            Next::Waits => {}
            Next::Arc { via, end } => self.circle(statement, via, end, speed),
            Next::Uncertain => {
                let message = "a fourth A in a row: the arcs are ambiguous";
                let hint = "write arcs as C with two positions";
                self.messages.problem(statement.span.clone(), message, hint);
            }
        }
    }

    fn circle(&mut self, statement: &Statement, via: FramedTarget, end: FramedTarget, speed: Speed) {
        if !via.is_framed_like(&end) {
            let message =
                "the positions of this arc are relative to different frames or have different tools";
            let hint = "teach the positions of an arc in one frame with one tool";
            self.messages.problem(statement.span.clone(), message, hint);
            return;
        }
        let motion = Motion::Circular { via: via.target };
        self.moves.push(end.reached(motion, speed, statement.line));
    }
}

//! What a program does with its positions: moves, and what is passed over between them.

use std::collections::BTreeMap;

use super::frames::{Frames, Which};
use super::position::{Position, Taught, positions};
use super::statement::{Statement, index, sections};
use crate::document::{Problem, Problems};
use crate::robot_program::arc_row::{ArcEnd, ArcRow, Next};
use crate::robot_program::findings::Findings;
use crate::robot_program::language::Language;
use crate::robot_program::program::{Frame, Motion, RobotMove, RobotProgram, Speed, Target};
use crate::robot_program::spelling::{Part, number};
use crate::robot_program::text::ProgramText;

/// Programs that call programs are followed so deep.
const DEEPEST: usize = 30;

/// Words that choose what runs and how often.
const CHOICES: [&str; 12] = [
    "JMP", "LBL", "IF", "ELSE", "ENDIF", "SELECT", "FOR", "ENDFOR", "MONITOR", "RUN", "ABORT", "END",
];

/// Words that shift what follows, or end moves early.
const SHIFTS: [&str; 4] = ["OFFSET", "TOOL_OFFSET", "VOFFSET", "SKIP"];

/// Units of speed: a length in m, and a time in s; nothing where it says nothing of the tip.
const UNITS: [(&str, Option<[f64; 2]>); 7] = [
    ("mm/sec", Some([1e-3, 1.0])),
    ("cm/min", Some([1e-2, 60.0])),
    ("inch/min", Some([0.0254, 60.0])),
    ("deg/sec", None),
    ("msec", None),
    ("sec", None),
    ("%", None),
];

/// Reads the program that comes first, with those that it calls as far as they are among `texts`.
///
/// # Errors
/// Every problem of the files, at most 200.
pub fn read(texts: Vec<ProgramText>) -> Result<RobotProgram, Problems> {
    let mut names = Vec::new();
    for text in &texts {
        let head = text
            .text()
            .lines()
            .take(50)
            .find_map(|line| line.trim_start().strip_prefix("/PROG"));
        let told = head
            .and_then(|rest| rest.split_whitespace().next())
            .unwrap_or_default();
        names.push(told.to_owned());
    }
    let mut reader = Reader {
        texts: &texts,
        names: &names,
        done: vec![false; texts.len()],
        frames: Frames::default(),
        moves: Vec::new(),
        findings: Findings::default(),
    };
    reader.program(0, 0)?;
    let Reader { moves, findings, .. } = reader;
    let notes = findings.finish()?;
    Ok(RobotProgram {
        language: Language::Tp,
        name: names.into_iter().next().unwrap_or_default(),
        moves,
        notes,
        texts,
    })
}

struct Reader<'a> {
    texts: &'a [ProgramText],
    names: &'a [String],
    done: Vec<bool>,
    frames: Frames,
    moves: Vec<RobotMove>,
    findings: Findings,
}

/// Where a move goes.
#[derive(Debug)]
struct Goal {
    target: Target,
    frame: Frame,
    tool: Frame,
}

/// A program on its way.
struct Program<'a> {
    text: &'a ProgramText,
    positions: BTreeMap<u32, Position>,
    row: ArcRow<Goal>,
    depth: usize,
}

impl<'a> Reader<'a> {
    fn program(&mut self, at: usize, depth: usize) -> Result<(), Problems> {
        let (Some(text), Some(done)) = (self.texts.get(at), self.done.get_mut(at)) else {
            return Ok(());
        };
        *done = true;
        let Some(sections) = sections(text.text()) else {
            let message = "this is no listing of a FANUC program: it has neither /PROG nor /MN";
            let hint = "save the program as ASCII (.LS); a .TP file is binary and not read";
            return Err(Problem::of_file(text.name(), message, hint).into());
        };
        let mut program = Program {
            text,
            positions: positions((text, at), &sections.positions, &mut self.findings),
            row: ArcRow::default(),
            depth,
        };
        for statement in &sections.statements {
            if self.findings.is_full() {
                break;
            }
            self.statement(&mut program, statement)?;
        }
        self.end_row(&mut program);
        Ok(())
    }

    fn statement(&mut self, program: &mut Program<'a>, statement: &Statement) -> Result<(), Problems> {
        let first = statement.word(0);
        if first.is_empty() || first.starts_with('!') || first.starts_with("--") {
            return Ok(());
        }
        let goes = |name| index(statement.word(1), name).is_some();
        if first.len() == 1 && (goes("P") || goes("PR")) {
            self.motion(program, statement);
            return Ok(());
        }
        let span = |words: &[Part]| match (words.first(), words.last()) {
            (Some(first), Some(last)) => first.at..last.range().end,
            _ => statement.span.clone(),
        };
        let said = program
            .text
            .text()
            .get(span(&statement.words))
            .unwrap_or_default();
        if self.frames.assign(said, &program.positions) {
            return Ok(());
        }
        let word = first.to_ascii_uppercase();
        let name: String = word
            .chars()
            .take_while(|c| c.is_ascii_alphabetic() || *c == '_')
            .collect();
        if name == "CALL" {
            let called = statement.word(1).split('(').next().unwrap_or_default();
            return self.call(program, statement, called);
        }
        if CHOICES.contains(&name.as_str()) {
            let what = format!("{name} is passed over: what stands here runs once");
            self.findings.note(program.text, statement.line, what);
        } else if SHIFTS.contains(&name.as_str()) {
            let what = format!("{name} is passed over: moves go to their positions as taught");
            self.findings.note(program.text, statement.line, what);
        } else if let Some((_, behind)) = index(first, "P") {
            if behind.starts_with('=') {
                let what = "a position is computed, and passed over: it is taken as taught";
                self.findings.note(program.text, statement.line, what);
            }
        }
        Ok(())
    }

    fn call(&mut self, program: &mut Program<'a>, statement: &Statement, name: &str) -> Result<(), Problems> {
        self.end_row(program);
        let known = self
            .names
            .iter()
            .position(|other| other.eq_ignore_ascii_case(name));
        match known {
            Some(at) if !self.done[at] && program.depth < DEEPEST => {
                return self.program(at, program.depth + 1);
            }
            Some(_) => {
                let what = format!("{name} is called again: it is read once");
                self.findings.note(program.text, statement.line, what);
            }
            None => {
                let what = format!("{name} is called, but not given: what it does is passed over");
                self.findings.note(program.text, statement.line, what);
            }
        }
        Ok(())
    }

    fn motion(&mut self, program: &mut Program<'a>, statement: &Statement) {
        let kind = statement.word(0).to_ascii_uppercase();
        let goals = if kind == "C" { 2 } else { 1 };
        let (words, rest) = statement.words[1..].split_at(goals.min(statement.words.len() - 1));
        if !matches!(kind.as_str(), "J" | "L" | "C" | "A" | "S") {
            let message = format!("the move `{kind}` is not followed");
            let hint = "understood are J, L, C, A and S";
            self.findings
                .problem(program.text, statement.span.clone(), message, hint);
            return;
        }
        let mut goals: Vec<Goal> = words
            .iter()
            .filter_map(|word| self.goal(program, statement, word))
            .collect();
        let speed = self.speed(program, statement, (&kind, rest));
        if goals.len() < words.len() || !self.follows(program, statement, rest) {
            return;
        }
        let Some(end) = goals.pop() else {
            return;
        };
        if kind == "A" {
            return self.arc(program, statement, (end, speed));
        }
        self.end_row(program);
        let motion = match (kind.as_str(), goals.pop()) {
            ("J", _) => Motion::Joint,
            ("C", Some(via)) => {
                return self.circle(program, statement, (via, end, speed));
            }
            ("C", None) => {
                let message = "an arc with one position".to_owned();
                let hint = "it goes through one to another: `C P[1] P[2] 100mm/sec FINE`";
                self.findings
                    .problem(program.text, statement.span.clone(), message, hint);
                return;
            }
            ("S", _) => {
                let what = "S is taken as straight between its positions";
                self.findings.note(program.text, statement.line, what);
                Motion::Linear
            }
            _ => Motion::Linear,
        };
        self.push((motion, end, speed), statement);
    }

    /// Where a word of a move goes.
    fn goal(&mut self, program: &Program<'a>, statement: &Statement, word: &Part) -> Option<Goal> {
        let elsewhere = |frames: &Frames| Goal {
            target: Target::Elsewhere {
                name: word.text.to_owned(),
            },
            frame: frames.get(Which::User, None),
            tool: frames.get(Which::Tool, None),
        };
        let Some((at, _)) = index(word.text, "P") else {
            if index(word.text, "PR").is_some() {
                return Some(elsewhere(&self.frames));
            }
            let message = format!("`{}` is no position", word.text);
            let hint = "a move names one: `L P[1] 100mm/sec FINE`; an arc two";
            self.findings.problem(program.text, word.range(), message, hint);
            return None;
        };
        let Some(number) = at.first().and_then(|at| at.parse::<u32>().ok()) else {
            return Some(elsewhere(&self.frames));
        };
        let position = program.positions.get(&number);
        let (message, hint) = match position.map(|position| &position.taught) {
            Some(Taught::There(target)) => {
                let [user, tool] = position.map_or([None; 2], |position| position.numbers);
                for (which, own, what) in [(Which::User, user, "user frame"), (Which::Tool, tool, "tool")] {
                    if let (Some(own), Some(chosen)) = (own, self.frames.chosen(which))
                        && own != chosen
                    {
                        let what = format!(
                            "positions of {what} {own} are gone to while {what} {chosen} is chosen: they are taken in their own"
                        );
                        self.findings.note(program.text, statement.line, what);
                    }
                }
                return Some(Goal {
                    target: target.clone(),
                    frame: self.frames.get(Which::User, user),
                    tool: self.frames.get(Which::Tool, tool),
                });
            }
            Some(Taught::Refused) => return None,
            Some(Taught::Missing(why)) => (
                format!("P[{number}] does not tell where it is: {why}"),
                "teach it, or write its numbers",
            ),
            None => (
                format!("the position P[{number}] is not in this listing"),
                "it stands behind /POS: save the whole program as ASCII (.LS)",
            ),
        };
        self.findings.problem(program.text, word.range(), message, hint);
        None
    }

    fn speed(
        &mut self,
        program: &Program<'a>,
        statement: &Statement,
        (kind, rest): (&str, &[Part]),
    ) -> Speed {
        let mut before = None;
        for word in rest {
            let lower = word.text.to_ascii_lowercase();
            let unit = UNITS.iter().find(|(unit, _)| lower.ends_with(unit));
            let Some((unit, of_tip)) = unit else {
                // The unit may stand alone behind its number.
                before = Some(word.text);
                continue;
            };
            let alone = lower.len() == unit.len();
            let told = match (alone, before) {
                (true, Some(before)) => before,
                (true, None) => "",
                (false, _) => word.text.get(..lower.len() - unit.len()).unwrap_or_default(),
            };
            let computed = told.starts_with(['R', 'r', 'A', 'a']) && told.contains('[');
            return match (of_tip, number(told).filter(|value| *value >= 0.0)) {
                _ if kind == "J" => Speed::Joints,
                (None, _) => Speed::Joints,
                (Some([length, time]), Some(value)) => Speed::Tip(value * length / time),
                (Some(_), None) if computed => {
                    let what = "a speed out of a register is not known";
                    self.findings.note(program.text, statement.line, what);
                    Speed::Untold
                }
                (Some(_), None) => {
                    let message = format!("`{told}` is no speed");
                    self.findings
                        .problem(program.text, word.range(), message, "write it as `100mm/sec`");
                    Speed::Untold
                }
            };
        }
        if kind == "J" {
            return Speed::Joints;
        }
        let what = "a speed that the program does not tell (WELD_SPEED, max_speed, ...) is not known";
        self.findings.note(program.text, statement.line, what);
        Speed::Untold
    }

    /// Whether a move goes to its position, whatever else is said of it.
    fn follows(&mut self, program: &Program<'a>, statement: &Statement, rest: &[Part]) -> bool {
        for word in rest {
            let said = word.text.to_ascii_uppercase();
            let name = said.split([',', '[']).next().unwrap_or_default();
            let refused = match name {
                "INC" => Some("goes by an increment (INC)"),
                "RTCP" => Some("has a tool that stands still (RTCP)"),
                _ => None,
            };
            if let Some(refused) = refused {
                let message = format!("this move {refused}, which is not followed");
                let hint = "write it as a move of a tool at the flange to a position of its own";
                self.findings.problem(program.text, word.range(), message, hint);
                return false;
            }
            if SHIFTS.contains(&name) || name == "COORD" {
                let what = format!("{name} of moves is passed over: they go to their positions as taught");
                self.findings.note(program.text, statement.line, what);
            }
        }
        true
    }

    /// One more A of a row.
    fn arc(&mut self, program: &mut Program<'a>, statement: &Statement, (goal, speed): (Goal, Speed)) {
        match program.row.next(goal, ArcEnd::Untold, statement.span.clone()) {
            Next::Straight(goal) => self.push((Motion::Linear, goal, speed), statement),
            Next::Waits => {}
            Next::Arc { via, end } => self.circle(program, statement, (via, end, speed)),
            Next::Uncertain => {
                let message = "a fourth A in a row: which positions make which arc is not certain".to_owned();
                let hint = "write arcs as C with two positions";
                self.findings
                    .problem(program.text, statement.span.clone(), message, hint);
            }
        }
    }

    fn circle(
        &mut self,
        program: &Program<'a>,
        statement: &Statement,
        (via, end, speed): (Goal, Goal, Speed),
    ) {
        if (via.frame, via.tool) != (end.frame, end.tool) {
            let message =
                "the positions of this arc count in different frames or have different tools".to_owned();
            let hint = "teach the positions of an arc in one frame with one tool";
            self.findings
                .problem(program.text, statement.span.clone(), message, hint);
            return;
        }
        self.push((Motion::Circular { via: via.target }, end, speed), statement);
    }

    /// No A follows: whether what came made arcs.
    fn end_row(&mut self, program: &mut Program<'a>) {
        if let Some(span) = program.row.end() {
            let message = "this row of A has no three positions".to_owned();
            self.findings.problem(
                program.text,
                span,
                message,
                "an arc goes through three A in a row",
            );
        }
    }

    fn push(&mut self, (motion, goal, speed): (Motion, Goal, Speed), statement: &Statement) {
        let Goal { target, frame, tool } = goal;
        self.moves.push(RobotMove {
            motion,
            target,
            frame,
            tool,
            speed,
            line: statement.line,
        });
    }
}

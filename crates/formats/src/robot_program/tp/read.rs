//! What a program does with its positions: moves, and what is passed over between them.

use std::collections::BTreeMap;

use super::frames::Frames;
use super::motion::Goal;
use super::position::{Position, positions};
use super::statement::{Statement, index, sections};
use crate::document::{Problem, Problems};
use crate::robot_program::arc_row::ArcRow;
use crate::robot_program::language::Language;
use crate::robot_program::program::{RobotMove, RobotProgram};
use crate::robot_program::spelling::Part;
use crate::robot_program::text::ProgramText;
use crate::robot_program::given::Told;

/// Programs that call programs are followed so deep.
const DEEPEST: usize = 30;

/// Words that choose what runs and how often.
const CHOICES: [&str; 13] = [
    "JMP", "LBL", "IF", "ELSE", "ENDIF", "SELECT", "FOR", "ENDFOR", "MONITOR", "RUN", "ABORT", "END", "WENN",
];

/// Words that shift what follows, or end moves early.
pub(super) const SHIFTS: [&str; 4] = ["OFFSET", "TOOL_OFFSET", "VOFFSET", "SKIP"];

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
        let given = head
            .and_then(|rest| rest.split_whitespace().next())
            .unwrap_or_default();
        names.push(given.to_owned());
    }
    let mut reader = Reader {
        texts: &texts,
        names: &names,
        done: vec![false; texts.len()],
        frames: Frames::default(),
        moves: Vec::new(),
        given: Told::default(),
    };
    reader.program(0, 0)?;
    let Reader { moves, given, .. } = reader;
    let notes = given.finish()?;
    Ok(RobotProgram {
        language: Language::Tp,
        name: names.into_iter().next().unwrap_or_default(),
        moves,
        notes,
        texts,
    })
}

/// Programs on their way.
pub(super) struct Reader<'a> {
    texts: &'a [ProgramText],
    names: &'a [String],
    done: Vec<bool>,
    pub frames: Frames,
    pub moves: Vec<RobotMove>,
    pub given: Told,
}

/// A program on its way.
pub(super) struct Program<'a> {
    pub text: &'a ProgramText,
    pub positions: BTreeMap<u32, Position>,
    pub row: ArcRow<Goal>,
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
            positions: positions((text, at), &sections.positions, &mut self.given),
            row: ArcRow::default(),
            depth,
        };
        for statement in &sections.statements {
            if self.given.is_full() {
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
        if matches!(name.as_str(), "CALL" | "AUFRUF") {
            let called = statement.word(1).split('(').next().unwrap_or_default();
            return self.call(program, statement, called);
        }
        if CHOICES.contains(&name.as_str()) {
            let what = format!("{name} is passed over: what stands here runs once");
            self.given.note((program.text, statement.line), what);
        } else if SHIFTS.contains(&name.as_str()) {
            let what = format!("{name} is passed over: moves go to their positions as taught");
            self.given.note((program.text, statement.line), what);
        } else if index(first, "P").is_some_and(|(_, behind)| behind.starts_with('=')) {
            let what = "a position is computed, and passed over: it is taken as taught";
            self.given.note((program.text, statement.line), what);
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
                self.given.note((program.text, statement.line), what);
            }
            None => {
                let what = format!("{name} is called, but not given: what it does is passed over");
                self.given.note((program.text, statement.line), what);
            }
        }
        Ok(())
    }

    /// No A follows: whether what came made arcs.
    pub fn end_row(&mut self, program: &mut Program<'a>) {
        if let Some(span) = program.row.end() {
            let message = "this row of A has no three positions".to_owned();
            self.given.problem(
                program.text,
                span,
                message,
                "an arc goes through three A in a row",
            );
        }
    }
}

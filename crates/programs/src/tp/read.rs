//! The statements of a program: moves, and the statements between them that are ignored.

use std::collections::BTreeMap;

use armill_formats::document::{Problem, Problems};
use armill_formats::language::Language;

use super::frames::Frames;
use super::position::{Position, positions};
use super::statement::{Statement, index, sections};
use crate::arc_row::ArcRow;
use crate::messages::ProgramMessages;
use crate::program::{FramedTarget, RobotMove, RobotProgram};
use crate::spelling::Part;
use crate::text::ProgramText;

/// Maximum nesting of program calls.
const DEEPEST: usize = 30;

/// Words of control flow.
const CHOICES: [&str; 13] = [
    "JMP", "LBL", "IF", "ELSE", "ENDIF", "SELECT", "FOR", "ENDFOR", "MONITOR", "RUN", "ABORT", "END", "WENN",
];

/// Words that shift the following positions, or end moves early.
pub(super) const SHIFTS: [&str; 4] = ["OFFSET", "TOOL_OFFSET", "VOFFSET", "SKIP"];

/// Reads the first program, and the programs that it calls if they are among `texts`.
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
        messages: ProgramMessages::new(&texts),
    };
    reader.program(0, 0)?;
    let Reader { moves, messages, .. } = reader;
    let notes = messages.finish()?;
    Ok(RobotProgram {
        language: Language::Tp,
        name: names.into_iter().next().unwrap_or_default(),
        moves,
        notes,
        texts,
    })
}

/// Reads programs.
pub(super) struct Reader<'a> {
    texts: &'a [ProgramText],
    names: &'a [String],
    done: Vec<bool>,
    pub frames: Frames,
    pub moves: Vec<RobotMove>,
    pub messages: ProgramMessages<'a>,
}

/// A program while it is read.
pub(super) struct Program {
    pub positions: BTreeMap<u32, Position>,
    pub row: ArcRow<FramedTarget>,
    depth: usize,
}

impl Reader<'_> {
    fn program(&mut self, at: usize, depth: usize) -> Result<(), Problems> {
        let (Some(text), Some(done)) = (self.texts.get(at), self.done.get_mut(at)) else {
            return Ok(());
        };
        *done = true;
        let Some(sections) = sections(text.text()) else {
            let message = "this is not a listing of a FANUC program: it has neither /PROG nor /MN";
            let hint = "save the program as ASCII (.LS); binary .TP files cannot be read";
            return Err(Problem::of_file(text.name(), message, hint).into());
        };
        let caller = self.messages.go_to(at);
        let mut program = Program {
            positions: positions(&sections.positions, &mut self.messages),
            row: ArcRow::default(),
            depth,
        };
        for statement in &sections.statements {
            if self.messages.is_full() {
                break;
            }
            self.statement(&mut program, statement)?;
        }
        self.end_row(&mut program);
        self.messages.go_to(caller);
        Ok(())
    }

    fn statement(&mut self, program: &mut Program, statement: &Statement) -> Result<(), Problems> {
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
        let said = self
            .messages
            .text()
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
            let what = format!("{name} is ignored: the statements here are read once");
            self.messages.note(statement.line, what);
        } else if SHIFTS.contains(&name.as_str()) {
            let what = format!("{name} is ignored: the taught positions are used");
            self.messages.note(statement.line, what);
        } else if index(first, "P").is_some_and(|(_, behind)| behind.starts_with('=')) {
            let what = "an assignment to a position is ignored: the taught position is used";
            self.messages.note(statement.line, what);
        }
        Ok(())
    }

    fn call(&mut self, program: &mut Program, statement: &Statement, name: &str) -> Result<(), Problems> {
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
                self.messages.note(statement.line, what);
            }
            None => {
                let what = format!("{name} is called, but not given: it is ignored");
                self.messages.note(statement.line, what);
            }
        }
        Ok(())
    }

    /// Ends a row of A: checks that it formed arcs.
    pub fn end_row(&mut self, program: &mut Program) {
        if let Some(span) = program.row.end() {
            let message = "this row of A has fewer than three positions";
            self.messages
                .problem(span, message, "an arc has three A in a row");
        }
    }
}

//! A project as moves: its code with its data.

use armill_core::path::Passage;
use std::collections::BTreeMap;

use armill_formats::document::Problems;
use armill_formats::language::Language;

use super::code::{Event, EventKind, LineCount, Program, events, programs};
use super::data::{Data, Datum, Reference};
use super::tags::{Piece, attributes, pieces, value};
use crate::messages::ProgramMessages;
use crate::program::{Frame, Motion, RobotMove, RobotProgram, Speed, Target};
use crate::spelling::Part;
use crate::text::ProgramText;

/// Maximum nesting of program calls.
const DEEPEST: usize = 30;

/// Maximum length of expressions in messages, in characters.
const LONGEST_SHOWN: usize = 60;

/// The main program of a project.
const START: &str = "start";

/// Reads a project: its data, and the program `start` with the programs that it calls if they are among `texts`.
///
/// # Errors
/// All problems of the files, at most 200: missing items with their names.
pub fn read(texts: Vec<ProgramText>) -> Result<RobotProgram, Problems> {
    let mut reader = Reader {
        data: Data::default(),
        has_data: false,
        programs: Vec::new(),
        names: BTreeMap::new(),
        done: Vec::new(),
        moves: Vec::new(),
        messages: ProgramMessages::new(&texts),
    };
    let mut project = None;
    for (index, text) in texts.iter().enumerate() {
        reader.messages.go_to(index);
        match kind(text) {
            Kind::Data => {
                reader.has_data = true;
                reader.data.take(&mut reader.messages);
            }
            Kind::Project => {
                project.get_or_insert(text.stem());
                reader.project(text);
            }
            Kind::Code => {
                let found = programs(text.text(), text.stem()).into_iter();
                reader.programs.extend(found.map(|program| (index, program)));
            }
        }
    }
    reader.messages.go_to(0);
    reader.done = vec![false; reader.programs.len()];
    for (at, (_, program)) in reader.programs.iter().enumerate() {
        reader.names.entry(program.name).or_insert(at);
    }
    let first_is_code = texts.first().is_some_and(|text| matches!(kind(text), Kind::Code));
    let start = reader
        .programs
        .iter()
        .position(|(_, program)| program.name == START);
    let main = if first_is_code { Some(0) } else { start.or(Some(0)) };
    let name = project.or(main
        .and_then(|main| reader.programs.get(main))
        .map(|(_, program)| program.name));
    let name = name.unwrap_or_default().to_owned();
    match main.filter(|main| *main < reader.programs.len()) {
        Some(main) => reader.program(main, 0),
        None => {
            let hint = "give the whole folder of the project: .pjx, .dtx and .pgx";
            let message = "no program (.pgx) is among these files";
            reader.messages.problem(0..0, message, hint);
        }
    }
    let Reader { moves, messages, .. } = reader;
    let notes = messages.finish()?;
    Ok(RobotProgram {
        language: Language::Val3,
        name,
        moves,
        notes,
        texts,
    })
}

enum Kind {
    Project,
    Data,
    Code,
}

fn kind(text: &ProgramText) -> Kind {
    match text.ending().as_deref() {
        Some("pjx") => Kind::Project,
        Some("dtx") => Kind::Data,
        Some("pgx") => Kind::Code,
        _ if text.text().contains("<Database") => Kind::Data,
        _ if text.text().contains("<Project") => Kind::Project,
        _ => Kind::Code,
    }
}

struct Reader<'a> {
    data: Data,
    has_data: bool,
    /// The programs, each with the index of its text.
    programs: Vec<(usize, Program<'a>)>,
    /// Indices of the programs by name; the first one of equal names.
    names: BTreeMap<&'a str, usize>,
    done: Vec<bool>,
    moves: Vec<RobotMove>,
    messages: ProgramMessages<'a>,
}

/// Target of a move.
struct Val3Target {
    target: Target,
    frame: Frame,
}

impl<'a> Reader<'a> {
    fn project(&mut self, text: &ProgramText) {
        for piece in pieces(text.text()) {
            if let Piece::Tag(tag) = piece
                && tag.name == "Parameters"
                && value(&attributes(tag.inside), "millimeterUnit") == Some("false")
            {
                let message = "this project uses inches, which is not supported";
                let hint = "set its unit of length to mm (millimeterUnit) in the manufacturer's suite";
                self.messages.problem(tag.inside.range(), message, hint);
            }
        }
    }

    fn program(&mut self, at: usize, depth: usize) {
        let (Some((text, program)), Some(done)) = (self.programs.get(at).cloned(), self.done.get_mut(at))
        else {
            return;
        };
        *done = true;
        let caller = self.messages.go_to(text);
        let mut lines = LineCount::new(self.messages.text().text());
        for event in program.code.iter().flat_map(|code| events(*code, &mut lines)) {
            if self.messages.is_full() {
                break;
            }
            self.event(&program, &event, depth);
        }
        self.messages.go_to(caller);
    }

    fn event(&mut self, program: &Program, event: &Event, depth: usize) {
        match &event.what {
            EventKind::Move { word, arguments } => self.motion(program, event.line, *word, arguments),
            EventKind::Unclosed(word) => {
                let message = format!("the bracket of `{}` is not closed", word.text);
                let hint = "close it: `movel(pPoint[0],tTool,mSpeed)`";
                self.messages.problem(word.range(), message, hint);
            }
            EventKind::Call(name) => {
                let known = self.names.get(name).copied();
                match known {
                    Some(at) if !self.done[at] && depth < DEEPEST => self.program(at, depth + 1),
                    Some(_) => {
                        let what = format!("{name} is called again: it is read once");
                        self.messages.note(event.line, what);
                    }
                    None => {
                        let what = format!("{name} is called, but not given: it is ignored");
                        self.messages.note(event.line, what);
                    }
                }
            }
            EventKind::Choice(word) => {
                let what = format!("{word} is ignored: the statements here are read once");
                self.messages.note(event.line, what);
            }
            EventKind::Assign(name) => {
                let first = Reference::of(name);
                let used = first.and_then(|first| self.data.get(&first));
                if used.is_some() {
                    let what = format!("the assignment to {name} is ignored: its value in the data is used");
                    self.messages.note(event.line, what);
                }
            }
        }
    }

    fn motion(&mut self, program: &Program, line: u32, word: Part, arguments: &[Part]) {
        let goals = match word.text {
            "movej" | "movel" => 1,
            "movec" => 2,
            _ => {
                let message = format!("the move `{}` is not followed", word.text);
                let hint = "supported: movej, movel and movec of one robot";
                self.messages.problem(word.range(), message, hint);
                return;
            }
        };
        let (Some(goals), Some([tool, speed])) = (arguments.get(..goals), arguments.get(goals..)) else {
            let message = format!("`{}` with {} arguments", word.text, arguments.len());
            let hint = "write `movel(point,tool,mdesc)` or `movec(via,point,tool,mdesc)`";
            self.messages.problem(word.range(), message, hint);
            return;
        };
        let mut found: Vec<Val3Target> = goals
            .iter()
            .filter_map(|goal| self.goal(program, *goal))
            .collect();
        if found.len() < goals.len() {
            return;
        }
        let Some(end) = found.pop() else {
            return;
        };
        let tool = self.tool(line, *tool);
        let (motion, speed) = match (word.text, found.pop()) {
            ("movej", _) => (Motion::Joint, Speed::Joints),
            (_, None) => (Motion::Linear, self.speed(line, *speed)),
            (_, Some(via)) if via.frame == end.frame => {
                (Motion::Circular { via: via.target }, self.speed(line, *speed))
            }
            (_, Some(_)) => {
                let message = "the points of this arc are relative to different frames";
                let hint = "give both points of an arc the same fatherId";
                self.messages.problem(word.range(), message, hint);
                return;
            }
        };
        self.moves.push(RobotMove {
            motion,
            target: end.target,
            frame: end.frame,
            tool,
            speed,
            passage: Passage::Unknown,
            line,
        });
    }

    /// The target in an argument of a move.
    fn goal(&mut self, program: &Program, argument: Part) -> Option<Val3Target> {
        let elsewhere = || {
            let name = argument.text.chars().take(LONGEST_SHOWN).collect();
            Some(Val3Target {
                target: Target::Elsewhere { name },
                frame: Frame::Unknown,
            })
        };
        let Some(reference) = Reference::of(argument.text) else {
            return elsewhere();
        };
        let (message, hint) = match self.data.get(&reference) {
            Some(Datum::Point { target, father }) => {
                let frame = self.data.pose_of(father).map_or(Frame::Unknown, Frame::Given);
                return Some(Val3Target {
                    target: target.clone(),
                    frame,
                });
            }
            Some(Datum::Joints(target)) => {
                return Some(Val3Target {
                    target: target.clone(),
                    frame: Frame::Unknown,
                });
            }
            Some(Datum::Refused) => return None,
            Some(_) => (
                format!("`{}` is neither a point nor joints", argument.text),
                "a move needs a pointRx or a jointRx",
            ),
            None if program.locals.contains(reference.name.as_str()) || reference.name.contains(':') => {
                return elsewhere();
            }
            None if !self.has_data => (
                format!(
                    "`{}` is not defined: there are no data (.dtx) among these files",
                    argument.text
                ),
                "give the whole folder of the project: .pjx, .dtx and .pgx",
            ),
            None if self.data.knows(&reference.name) => (
                format!("`{}` has no value in the data (.dtx)", argument.text),
                "teach it, or write its value",
            ),
            None => (
                format!("`{}` is not in the data (.dtx)", argument.text),
                "give all data files of the project",
            ),
        };
        self.messages.problem(argument.range(), message, hint);
        None
    }

    fn tool(&mut self, line: u32, argument: Part) -> Frame {
        let given = Reference::of(argument.text).and_then(|_| self.data.pose_of(argument.text));
        given.map_or_else(
            || {
                let name: String = argument.text.chars().take(LONGEST_SHOWN).collect();
                let what = format!("the tool `{name}` is not in the data");
                self.messages.note(line, what);
                Frame::Unknown
            },
            Frame::Given,
        )
    }

    fn speed(&mut self, line: u32, argument: Part) -> Speed {
        let given = Reference::of(argument.text).and_then(|reference| self.data.get(&reference));
        match given {
            Some(Datum::Speed(Some(tip))) => Speed::Tip(*tip),
            Some(Datum::Speed(None)) => Speed::Joints,
            _ => {
                let name: String = argument.text.chars().take(LONGEST_SHOWN).collect();
                let what = format!("the move description `{name}` is not in the data");
                self.messages.note(line, what);
                Speed::Unknown
            }
        }
    }
}

//! Statements: one per line, or several lines within brackets.

use std::collections::{HashMap, HashSet};

use armill_formats::document::{Problem, Problems};
use armill_formats::language::Language;

use super::SYNTAX;
use super::value::Value;
use crate::messages::ProgramMessages;
use crate::program::{Frame, RobotMove, RobotProgram};
use crate::text::ProgramText;
use crate::tokens::{Cursor, Kind, Token, tokens};

/// Words of control flow, which end with a colon.
const CONTROL: [&str; 5] = ["if", "elif", "while", "for", "thread"];
/// Calls that do not move the robot.
const QUIET: [&str; 24] = [
    "set_", "get_", "textmsg", "popup", "sleep", "sync", "modbus_", "rpc_", "write_", "read_", "socket_",
    "enter_", "exit_", "stopj", "stopl", "end_", "halt", "request_", "reset_", "step_", "is_", "rtde_",
    "assert", "zero_",
];
/// Moves controlled by a signal or a computation.
const FOLLOWING: [&str; 6] = ["servoj", "servol", "servoc", "servop", "speedj", "speedl"];

/// Reads a program.
///
/// # Errors
/// All problems of the files, at most 200: undefined targets, moves without target, invalid numbers.
pub fn read(texts: Vec<ProgramText>) -> Result<RobotProgram, Problems> {
    let mut reader = Reader {
        messages: ProgramMessages::new(&texts),
        known: HashMap::new(),
        tool: Frame::Unknown,
        routines: HashSet::new(),
        name: None,
        is_started: false,
        moves: Vec::new(),
    };
    let found: Vec<Vec<Token>> = texts
        .iter()
        .map(|text| unbroken(tokens(text.text(), &SYNTAX)))
        .collect();
    let all: Vec<Vec<Cursor<'_>>> = texts
        .iter()
        .zip(&found)
        .map(|(text, found)| statements(text.text(), found))
        .collect();
    for statement in all.iter().flatten() {
        let mut cursor = statement.clone();
        if raw_word(&mut cursor) == Some("def") {
            reader.routines.extend(raw_word(&mut cursor));
        }
    }
    for (index, statements) in all.iter().enumerate() {
        reader.messages.go_to(index);
        for statement in statements {
            reader.statement(statement.clone());
        }
    }
    let Reader {
        messages,
        moves,
        name,
        ..
    } = reader;
    let notes = messages.finish()?;
    let file = texts.first().map_or("", ProgramText::name);
    if moves.is_empty() {
        let hint = "give the .script file that moves the robot: movej, movel, movep, movec";
        return Err(Problem::of_file(file, "the program contains no moves", hint).into());
    }
    let stem = texts.first().map_or("", ProgramText::stem);
    Ok(RobotProgram {
        language: Language::UrScript,
        name: name.unwrap_or(stem).to_owned(),
        moves,
        notes,
        texts,
    })
}

/// The tokens without line ends inside brackets.
fn unbroken(mut all: Vec<Token>) -> Vec<Token> {
    let mut depth = 0_usize;
    all.retain(|token| {
        match token.kind {
            Kind::Mark('(' | '[') => depth += 1,
            Kind::Mark(')' | ']') => depth = depth.saturating_sub(1),
            _ => {}
        }
        token.kind != Kind::Line || depth == 0
    });
    all
}

/// The tokens of each statement.
fn statements<'a>(text: &'a str, tokens: &'a [Token]) -> Vec<Cursor<'a>> {
    tokens
        .split(|token| matches!(token.kind, Kind::Line | Kind::Mark(';')))
        .filter(|statement| !statement.is_empty())
        .map(|statement| Cursor::new(text, statement))
        .collect()
}

/// Moves past the word at the cursor and returns it as written.
pub(super) fn raw_word<'a>(cursor: &mut Cursor<'a>) -> Option<&'a str> {
    let token = cursor.peek().filter(|token| token.kind == Kind::Word)?;
    cursor.next();
    Some(&cursor.text[token.span()])
}

/// State while statements are read.
pub(super) struct Reader<'a> {
    pub messages: ProgramMessages<'a>,
    /// Values of names.
    pub known: HashMap<&'a str, Value>,
    pub tool: Frame,
    routines: HashSet<&'a str>,
    name: Option<&'a str>,
    /// Whether the main routine has been called.
    is_started: bool,
    pub moves: Vec<RobotMove>,
}

impl<'a> Reader<'a> {
    fn statement(&mut self, statement: Cursor<'a>) {
        let mut cursor = statement;
        while let Some(at) = cursor.peek() {
            let Some(word) = raw_word(&mut cursor) else { return };
            match word {
                "global" | "local" => {}
                "def" | "sec" => {
                    self.routine(&mut cursor);
                }
                "else" => _ = cursor.pass(':'),
                _ if CONTROL.contains(&word) => {
                    let sentence = format!("`{word}`: its body is read once");
                    self.messages.note(at.line, sentence);
                    if !past_colon(&mut cursor) {
                        return;
                    }
                }
                _ => return self.plain(at, word, cursor),
            }
        }
    }

    /// A routine begins: its name, and its parameters, whose values are not known.
    fn routine(&mut self, cursor: &mut Cursor<'a>) {
        self.name = self.name.or(raw_word(cursor));
        while let Some(token) = cursor.next() {
            match token.kind {
                Kind::Word => _ = self.known.insert(&cursor.text[token.span()], Value::Unknown),
                Kind::Mark(':') => return,
                _ => {}
            }
        }
    }

    /// An assignment or a call.
    fn plain(&mut self, at: Token, word: &'a str, mut cursor: Cursor<'a>) {
        if cursor.pass('=') {
            let value = self.value(&mut cursor, 0);
            let is_whole = cursor.peek().is_none();
            self.known
                .insert(word, if is_whole { value } else { Value::Unknown });
            return;
        }
        if cursor.pass('[') {
            // One number of a list is assigned: the list is then not known.
            self.known.insert(word, Value::Unknown);
            return;
        }
        if !cursor.pass('(') {
            return;
        }
        match word {
            "movej" | "movel" | "movep" | "movec" => {
                let arguments = self.arguments(&mut cursor, 0);
                self.motion(at, word, &arguments);
            }
            "set_tcp" => {
                let arguments = self.arguments(&mut cursor, 0);
                let tool = match arguments.first().map(|argument| &argument.value) {
                    Some(Value::Pose(tool)) => tool.in_base(),
                    _ => None,
                };
                self.tool = match tool {
                    Some(tool) => Frame::Given(tool),
                    None => {
                        let sentence = "the tool is computed on the controller: it is not known";
                        self.messages.note(at.line, sentence);
                        Frame::Unknown
                    }
                };
            }
            // The program calls its main routine after its definition.
            _ if self.name == Some(word) && !self.is_started => self.is_started = true,
            _ if self.routines.contains(word) => {
                let sentence = format!("`{word}` is called: its moves are read once, where it is defined");
                self.messages.note(at.line, sentence);
            }
            _ if FOLLOWING.contains(&word) || word.starts_with("move") => {
                let message = format!("`{word}` is an unsupported move");
                let hint = "supported: movej, movel, movep and movec";
                self.messages.problem(at.span(), message, hint);
            }
            _ if QUIET.iter().any(|begin| word.starts_with(begin)) => {}
            _ => {
                let sentence = format!("`{word}` is called: its effect is not known");
                self.messages.note(at.line, sentence);
            }
        }
    }
}

/// Moves past the colon that ends a condition. Returns whether there is one.
fn past_colon(cursor: &mut Cursor<'_>) -> bool {
    while let Some(token) = cursor.next() {
        if token.is(':') {
            return true;
        }
    }
    false
}

//! Statements: data of all modules first, then the routines in order.

use std::collections::HashSet;

use armill_formats::document::{Problem, Problems};
use armill_formats::language::Language;

use super::SYNTAX;
use super::names::Names;
use super::statement::statements;
use crate::messages::ProgramMessages;
use crate::program::{RobotMove, RobotProgram};
use crate::text::ProgramText;
use crate::tokens::{Cursor, Kind, Token, tokens};

/// Words of control flow: their bodies are read once.
const CONTROL: [&str; 8] = ["IF", "ELSEIF", "ELSE", "FOR", "WHILE", "TEST", "GOTO", "ERROR"];
/// Instructions that neither move the robot nor affect moves.
const QUIET: [&str; 58] = [
    "ACCSET",
    "ACTUNIT",
    "ADD",
    "BREAK",
    "CLEAR",
    "CLKRESET",
    "CLKSTART",
    "CLKSTOP",
    "CLOSE",
    "CONFJ",
    "CONFL",
    "CONNECT",
    "DEACTUNIT",
    "DECR",
    "DEFAULT",
    "CASE",
    "ENDIF",
    "ENDFOR",
    "ENDWHILE",
    "ENDTEST",
    "ENDMODULE",
    "ENDRECORD",
    "EXIT",
    "GRIPLOAD",
    "IDELETE",
    "IDISABLE",
    "IENABLE",
    "INCR",
    "ISIGNALDI",
    "ITIMER",
    "LANGUAGE",
    "MODULE",
    "MOTIONSUP",
    "OPEN",
    "PATHACCLIM",
    "PDISPOFF",
    "EOFFSOFF",
    "PULSEDO",
    "RAISE",
    "RECORD",
    "RESET",
    "RETRY",
    "RETURN",
    "SET",
    "SETAO",
    "SETDO",
    "SETGO",
    "SINGAREA",
    "STOP",
    "TPERASE",
    "TPWRITE",
    "TRYNEXT",
    "UNDO",
    "VERSION",
    "WAITDI",
    "WAITDO",
    "WAITTIME",
    "WAITUNTIL",
];

/// Reads a program. The routines of several modules are read in order.
///
/// # Errors
/// All problems of the files, at most 200: names that no module declares, unsupported moves, invalid numbers,
/// stationary tools.
pub fn read(texts: Vec<ProgramText>) -> Result<RobotProgram, Problems> {
    let found: Vec<Vec<Token>> = texts
        .iter()
        .map(|text| {
            let mut found = tokens(text.text(), &SYNTAX);
            found.retain(|token| token.kind != Kind::Line);
            found
        })
        .collect();
    let all: Vec<Vec<Cursor<'_>>> = texts
        .iter()
        .zip(&found)
        .map(|(text, found)| statements(text.text(), found))
        .collect();
    let mut reader = Reader {
        messages: ProgramMessages::new(&texts),
        names: Names::default(),
        routines: HashSet::new(),
        name: None,
        in_routine: false,
        moves: Vec::new(),
    };
    for pass in [Pass::Data, Pass::Routines] {
        for (index, statements) in all.iter().enumerate() {
            reader.messages.go_to(index);
            reader.in_routine = false;
            for statement in statements {
                reader.statement(pass, statement.clone());
            }
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
        let hint = "give the module whose routines move the robot: MoveJ, MoveL, MoveC, MoveAbsJ";
        return Err(Problem::of_file(file, "the program contains no moves", hint).into());
    }
    Ok(RobotProgram {
        language: Language::Rapid,
        name: name.unwrap_or_default(),
        moves,
        notes,
        texts,
    })
}

/// Data outside routines may be declared after the routines that use them, and in other files.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pass {
    Data,
    Routines,
}

/// State while statements are read.
pub(super) struct Reader<'a> {
    pub messages: ProgramMessages<'a>,
    pub names: Names,
    pub routines: HashSet<String>,
    name: Option<String>,
    in_routine: bool,
    pub moves: Vec<RobotMove>,
}

impl<'a> Reader<'a> {
    /// The characters of the text that is being read.
    pub fn text(&self) -> &'a str {
        self.messages.text().text()
    }

    fn statement(&mut self, pass: Pass, statement: Cursor<'a>) {
        let mut cursor = statement.clone();
        let Some(at) = cursor.peek() else { return };
        let Some(mut word) = cursor.word() else { return };
        while matches!(word.as_str(), "LOCAL" | "TASK") {
            match cursor.word() {
                Some(next) => word = next,
                None => return,
            }
        }
        match word.as_str() {
            "PROC" | "TRAP" | "FUNC" => {
                self.in_routine = true;
                if pass == Pass::Data && word == "PROC" {
                    let name = cursor.peek().filter(|token| token.kind == Kind::Word);
                    let name = name.map(|token| cursor.text[token.span()].to_owned());
                    self.routines
                        .extend(name.as_ref().map(|name| name.to_ascii_uppercase()));
                    self.name = self.name.take().or(name);
                }
            }
            "ENDPROC" | "ENDTRAP" | "ENDFUNC" => self.in_routine = false,
            "CONST" | "PERS" | "VAR" => {
                if self.in_routine == (pass == Pass::Routines) {
                    self.declaration(cursor);
                }
            }
            _ if pass == Pass::Data => {}
            _ if CONTROL.contains(&word.as_str()) => {
                let sentence = format!("`{word}`: its body is read once");
                self.messages.note(at.line, sentence);
            }
            "PDISPON" | "PDISPSET" | "EOFFSON" | "EOFFSSET" => {
                let message = format!("`{word}` displaces all targets after it");
                let hint = "write the final positions, without program displacement";
                self.messages.problem(at.span(), message, hint);
            }
            "VELSET" => {
                let sentence = "`VelSet` is ignored: the speeds of the moves are used";
                self.messages.note(at.line, sentence);
            }
            _ if QUIET.contains(&word.as_str()) => {}
            _ => self.plain(at, &word, statement),
        }
    }

    /// `robtarget name{3} := value`
    fn declaration(&mut self, mut cursor: Cursor<'a>) {
        if cursor.word().is_none() {
            return;
        }
        let name = self.reference(&mut cursor, 0).name;
        if cursor.pass(':') && cursor.pass('=') {
            let node = self.expression(&mut cursor, 0);
            self.names.put(name, node, self.messages.index());
        }
    }

    /// An assignment, a move or a call.
    fn plain(&mut self, at: Token, word: &str, statement: Cursor<'a>) {
        let mut cursor = statement.clone();
        let reference = self.reference(&mut cursor, 0);
        if cursor.pass(':') && cursor.pass('=') {
            let node = self.expression(&mut cursor, 0);
            let text = self.messages.index();
            match reference.steps.is_empty() {
                true => self.names.put(reference.name, node, text),
                false => self.names.change(&reference, node, text),
            }
            return;
        }
        let mut cursor = statement;
        cursor.next();
        let is_bare = cursor.peek().is_none();
        let name = &self.text()[at.span()];
        if self.routines.contains(word) {
            let sentence = format!("`{name}` is called: its moves are read once, where it is defined");
            self.messages.note(at.line, sentence);
        } else if is_bare || !self.motion(at, word, cursor) {
            let sentence = format!("`{name}` is called: its effect is not known");
            self.messages.note(at.line, sentence);
        }
    }
}

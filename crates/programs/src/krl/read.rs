//! Statements, line by line: data files first, then the routines in order.

use armill_formats::document::{Problem, Problems};
use armill_formats::language::Language;

use super::SYNTAX;
use super::points::{self, declared, lines};
use super::state::Reader;
use crate::program::RobotProgram;
use crate::text::ProgramText;
use crate::tokens::{Cursor, Kind, Token, tokens};

/// Words of control flow: their bodies are read once.
const CONTROL: [&str; 7] = ["IF", "FOR", "WHILE", "LOOP", "REPEAT", "SWITCH", "GOTO"];
/// Beginnings of the names of moves.
const MOVES: [&str; 7] = ["PTP", "LIN", "CIRC", "SPTP", "SLIN", "SCIRC", "SPL"];

/// Reads a program with its data files. The routines of several `.src` files are read in order.
///
/// # Errors
/// All problems of the files, at most 200: points that no file declares, unknown moves, components that are
/// missing or not numbers.
pub fn read(texts: Vec<ProgramText>) -> Result<RobotProgram, Problems> {
    let found: Vec<Vec<Token>> = texts.iter().map(|text| tokens(text.text(), &SYNTAX)).collect();
    let mut reader = Reader::new(&texts);
    let mut routines = Vec::new();
    for (index, (text, found)) in texts.iter().zip(&found).enumerate() {
        let lines = lines(text.text(), found);
        let is_data = lines
            .iter()
            .any(|line| line.peek_word().is_some_and(|word| word == "DEFDAT"));
        if is_data {
            reader.messages.go_to(index);
            for wrong in points::take_data(&mut reader.names, &module_of(text), index, &lines) {
                let hint = "components are numbers, as in `{X 100.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}`";
                reader.messages.problem(wrong.bytes, wrong.message, hint);
            }
        } else {
            reader.routines.extend(
                lines
                    .iter()
                    .filter_map(routine)
                    .map(|name| name.to_ascii_uppercase()),
            );
            routines.push((index, lines));
        }
    }
    let name = routines
        .first()
        .and_then(|(_, lines)| lines.iter().find_map(routine))
        .or_else(|| texts.first().map(module_of))
        .unwrap_or_default();
    for (index, lines) in &routines {
        reader.messages.go_to(*index);
        reader.module = module_of(&texts[*index]);
        for line in lines {
            reader.statement(line.clone());
        }
    }
    let Reader { messages, moves, .. } = reader;
    let notes = messages.finish()?;
    if moves.is_empty() {
        let name = texts.first().map_or("", ProgramText::name);
        let hint = "give the .src file that moves the robot, with the .dat file of its points";
        return Err(Problem::of_file(name, "the program contains no moves", hint).into());
    }
    Ok(RobotProgram {
        language: Language::Krl,
        name,
        moves,
        notes,
        texts,
    })
}

/// The module that a file belongs to: its name without folder and ending, in capitals.
fn module_of(text: &ProgramText) -> String {
    text.stem().to_ascii_uppercase()
}

/// The name of the routine that begins in the line.
fn routine(line: &Cursor<'_>) -> Option<String> {
    let mut cursor = line.clone();
    while cursor.peek_word().is_some_and(|word| word == "GLOBAL") {
        cursor.next();
    }
    cursor.word().filter(|word| word == "DEF")?;
    let name = cursor.peek().filter(|token| token.kind == Kind::Word)?;
    Some(line.text[name.span()].to_owned())
}

impl<'a> Reader<'a> {
    fn statement(&mut self, line: Cursor<'a>) {
        let Some(first) = line.peek() else { return };
        let mut cursor = line.clone();
        let Some(word) = cursor.word() else { return };
        let follows = cursor.peek().map(|token| token.kind);
        match word.as_str() {
            "PTP" | "SPTP" | "LIN" | "SLIN" | "SPL" | "CIRC" | "SCIRC" | "PTP_REL" | "SPTP_REL"
            | "LIN_REL" | "SLIN_REL" => self.motion(first, &word, cursor),
            "DEF" => self.former = None,
            "BAS" => self.bas(cursor),
            "SPLINE" | "PTP_SPLINE" => {
                let sentence = format!("`{word}`: its points are read, but not the curve between them");
                self.messages.note(first.line, sentence);
                self.before_spline = Some(self.modal.clone());
                self.with(&cursor);
            }
            "ENDSPLINE" | "END_SPLINE" => {
                if let Some(before) = self.before_spline.take() {
                    self.modal = before;
                }
            }
            _ if CONTROL.contains(&word.as_str()) && follows != Some(Kind::Mark('=')) => {
                let sentence = format!("`{word}`: its body is read once");
                self.messages.note(first.line, sentence);
            }
            // No other statement has a target after its word.
            _ if follows == Some(Kind::Mark('{')) || is_like_a_move(&word) && follows == Some(Kind::Word) => {
                let message = format!("`{word}` is an unsupported move");
                let hint = "supported: PTP, LIN, CIRC, SPTP, SLIN, SCIRC, SPL and PTP_REL, LIN_REL";
                self.messages.problem(first.span(), message, hint);
            }
            _ => match declared(&line) {
                Some(declared) => {
                    for (reference, value) in declared.values {
                        self.assign(first, &reference, value);
                    }
                }
                None if follows == Some(Kind::Mark('(')) => self.call(first),
                None => {}
            },
        }
    }

    fn call(&mut self, word: Token) {
        let name = &self.messages.text().text()[word.span()];
        let ours = self.routines.contains(&name.to_ascii_uppercase());
        let what = match ours {
            true => "its moves are read once, where it is defined",
            false => "its effect is not known",
        };
        self.messages
            .note(word.line, format!("`{name}` is called: {what}"));
    }
}

fn is_like_a_move(word: &str) -> bool {
    MOVES.iter().any(|known| {
        word.strip_prefix(known)
            .is_some_and(|rest| rest.is_empty() || rest.starts_with('_'))
    })
}

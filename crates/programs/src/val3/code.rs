//! The code of a program as events: moves with their arguments, calls, control flow, assignments.

use std::collections::BTreeSet;
use std::ops::Range;

use super::tags::{Piece, attributes, pieces, value};
use crate::spelling::Part;

/// Words of control flow.
const CHOICES: [&str; 9] = [
    "if", "elseIf", "else", "while", "do", "until", "for", "switch", "case",
];

/// An event with its line.
#[derive(Clone, Debug)]
pub(super) struct Event<'a> {
    pub line: u32,
    pub what: EventKind<'a>,
}

/// Kind of event.
#[derive(Clone, Debug)]
pub(super) enum EventKind<'a> {
    /// A call of `mov..`.
    Move {
        word: Part<'a>,
        arguments: Vec<Part<'a>>,
    },
    /// A call of `mov..` with an unclosed bracket.
    Unclosed(Part<'a>),
    /// `call NAME(..)`.
    Call(&'a str),
    /// `if`, `while`, ...
    Choice(&'a str),
    /// `NAME[..].field = ..`.
    Assign(&'a str),
}

/// A program of a file.
#[derive(Clone, Debug, Default)]
pub(super) struct Program<'a> {
    pub name: &'a str,
    /// Its code, in parts.
    pub code: Vec<Part<'a>>,
    /// Names of its parameters and local variables.
    pub locals: BTreeSet<&'a str>,
}

/// The programs of a file. A file without tags is the code of one program with the name of the file.
pub(super) fn programs<'a>(text: &'a str, file: &'a str) -> Vec<Program<'a>> {
    if !text.contains("<![CDATA[") && !text.contains("<Code") {
        return vec![Program {
            name: file,
            code: vec![Part { at: 0, text }],
            locals: BTreeSet::new(),
        }];
    }
    let mut found: Vec<Program> = Vec::new();
    for piece in pieces(text) {
        match (piece, found.last_mut()) {
            (Piece::Tag(tag), _) if tag.name == "Program" => found.push(Program {
                name: value(&attributes(tag.inside), "name").unwrap_or(file),
                ..Program::default()
            }),
            (Piece::Tag(tag), Some(program)) if matches!(tag.name, "Parameter" | "Local") => {
                program.locals.extend(value(&attributes(tag.inside), "name"));
            }
            (Piece::Verbatim(code), Some(program)) => program.code.push(code),
            (Piece::Verbatim(code), None) => found.push(Program {
                name: file,
                code: vec![code],
                locals: BTreeSet::new(),
            }),
            _ => {}
        }
    }
    found
}

/// Line numbers of positions, which must be requested in ascending order.
pub(super) struct LineCount<'a> {
    text: &'a str,
    at: usize,
    line: u32,
}

impl<'a> LineCount<'a> {
    pub fn new(text: &'a str) -> LineCount<'a> {
        LineCount { text, at: 0, line: 1 }
    }

    /// Line of a position after the previously requested one.
    pub fn of(&mut self, at: usize) -> u32 {
        let between = self.text.as_bytes().get(self.at..at).unwrap_or_default();
        let ends = between.iter().filter(|byte| **byte == b'\n').count();
        self.line = self.line.saturating_add(u32::try_from(ends).unwrap_or(u32::MAX));
        self.at = self.at.max(at);
        self.line
    }
}

/// The events in a piece of code, in order.
pub(super) fn events<'a>(code: Part<'a>, lines: &mut LineCount) -> Vec<Event<'a>> {
    let bytes = code.text.as_bytes();
    let mut events = Vec::new();
    let mut at = 0;
    let mut begins_line = true;
    while let Some(byte) = bytes.get(at) {
        match byte {
            b'\n' => {
                begins_line = true;
                at += 1;
            }
            b'"' => at = behind_text(bytes, at),
            b'/' if bytes.get(at + 1) == Some(&b'/') => at = end_of_line(bytes, at),
            _ if is_letter(*byte) || *byte == b'$' => {
                let word = word(bytes, at);
                let said = &code.text[word.clone()];
                let place = Part {
                    at: code.at + word.start,
                    text: said,
                };
                let mut happens = |what| {
                    events.push(Event {
                        line: lines.of(place.at),
                        what,
                    });
                };
                at = word.end;
                if begins_line && assigned(code.text, word.clone()) {
                    happens(EventKind::Assign(said));
                }
                begins_line = false;
                let behind = blanks(bytes, at);
                let moves = said
                    .trim_start_matches(['$', 'X'])
                    .to_ascii_lowercase()
                    .starts_with("mov");
                if said == "call" {
                    let called = self::word(bytes, behind);
                    happens(EventKind::Call(&code.text[called.clone()]));
                    at = called.end;
                } else if moves && bytes.get(behind) == Some(&b'(') {
                    match arguments(code, behind) {
                        Some((arguments, end)) => {
                            happens(EventKind::Move {
                                word: place,
                                arguments,
                            });
                            at = end;
                        }
                        None => {
                            happens(EventKind::Unclosed(place));
                            at = bytes.len();
                        }
                    }
                } else if CHOICES.contains(&said) {
                    happens(EventKind::Choice(said));
                }
            }
            _ => {
                begins_line &= byte.is_ascii_whitespace();
                at += 1;
            }
        }
    }
    events
}

fn is_letter(byte: u8) -> bool {
    byte.is_ascii_alphabetic() || byte == b'_'
}

/// The word that begins here, with the name of its library.
fn word(bytes: &[u8], at: usize) -> Range<usize> {
    let mut end = at;
    while let Some(byte) = bytes.get(end) {
        let library = *byte == b':' && bytes.get(end + 1).copied().is_some_and(is_letter);
        if !(is_letter(*byte) || byte.is_ascii_digit() || library || (*byte == b'$' && end == at)) {
            break;
        }
        end += 1;
    }
    at..end
}

fn blanks(bytes: &[u8], at: usize) -> usize {
    let blank = |byte: &&u8| matches!(byte, b' ' | b'\t');
    at + bytes
        .get(at..)
        .unwrap_or_default()
        .iter()
        .take_while(blank)
        .count()
}

fn end_of_line(bytes: &[u8], at: usize) -> usize {
    let rest = bytes.get(at..).unwrap_or_default();
    at + rest.iter().take_while(|byte| **byte != b'\n').count()
}

/// End of the text that begins here; it ends on its line.
fn behind_text(bytes: &[u8], at: usize) -> usize {
    let mut end = at + 1;
    while let Some(byte) = bytes.get(end) {
        match byte {
            b'\\' => end += 2,
            b'"' => return end + 1,
            b'\n' => return end,
            _ => end += 1,
        }
    }
    bytes.len()
}

/// Whether the variable that begins with this word is assigned on this line.
fn assigned(text: &str, word: Range<usize>) -> bool {
    let end = end_of_line(text.as_bytes(), word.end);
    let rest = &text[word.end..end];
    let Some(equals) = rest.find('=') else {
        return false;
    };
    let [left, right] = [&rest[..equals], &rest[equals + 1..]];
    !right.starts_with('=') && !left.contains(['(', '"', '!', '<', '>', '/'])
}

/// The arguments in a bracket, and its end.
fn arguments(code: Part<'_>, open: usize) -> Option<(Vec<Part<'_>>, usize)> {
    let bytes = code.text.as_bytes();
    let mut found = Vec::new();
    let mut depth = 0_usize;
    let mut start = open + 1;
    let mut at = open;
    let part = |range: Range<usize>| {
        let part = Part {
            at: code.at + range.start,
            text: &code.text[range],
        };
        part.trimmed()
    };
    while let Some(byte) = bytes.get(at) {
        match byte {
            b'"' => {
                at = behind_text(bytes, at);
                continue;
            }
            b'/' if bytes.get(at + 1) == Some(&b'/') => {
                at = end_of_line(bytes, at);
                continue;
            }
            b'(' | b'{' | b'[' => depth += 1,
            b')' | b'}' | b']' => {
                depth -= 1;
                if depth == 0 {
                    found.push(part(start..at));
                    return Some((found, at + 1));
                }
            }
            b',' if depth == 1 => {
                found.push(part(start..at));
                start = at + 1;
            }
            _ => {}
        }
        at += 1;
    }
    None
}

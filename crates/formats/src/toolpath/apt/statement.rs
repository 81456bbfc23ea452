//! Lines as statements: `WORD/parameter,parameter`, continued behind `$`, with remarks behind `$$`.
//!
//! ```text
//! GOTO/10.0,20.0,$        $$ a remark
//!      -5.0,0,0,1                              word GOTO, six parameters
//! PARTNO bracket, 2nd side                     word PARTNO, one free text
//! ```
//!
//! Blanks round words and parameters do not count, nor do capitals of words. Places are kept through continued lines: a
//! statement knows where in its text each of its lines begins.

use std::io::BufRead;
use std::ops::Range;

use crate::document::lines::{Line, Lines};
use crate::document::{Problem, Problems};

/// No statement goes over more lines.
const MOST_LINES: usize = 200;

/// Words after which the rest of the line is text for people, with or without slash.
const FREE_TEXT: [&str; 6] = ["PARTNO", "PPRINT", "INSERT", "REMARK", "LETTER", "TITLES"];

/// One statement.
#[derive(Debug)]
pub(super) struct Statement {
    /// Its major word, in capitals.
    pub word: String,
    /// The text after it.
    text: String,
    /// Its place in the text.
    word_span: Range<usize>,
    /// Ranges in the text, without blanks; an empty one between two commas is kept.
    parameters: Vec<Range<usize>>,
    /// Its lines, and the offset of each in the text.
    pieces: Vec<(usize, Line)>,
}

/// One parameter.
#[derive(Clone, Debug)]
pub(super) struct Parameter<'a> {
    /// As it is written, without blanks round it.
    pub text: &'a str,
    /// Its place in the text of its statement.
    pub span: Range<usize>,
}

impl Statement {
    /// The line it begins on.
    pub fn line(&self) -> u32 {
        let first = self.pieces.first().map_or(0, |(_, line)| line.number);
        u32::try_from(first).unwrap_or(u32::MAX)
    }

    /// Its parameters, in order.
    pub fn parameters(&self) -> impl Iterator<Item = Parameter<'_>> {
        self.parameters.iter().map(|span| Parameter {
            text: self.text.get(span.clone()).unwrap_or_default(),
            span: span.clone(),
        })
    }

    /// Its parameter at `index`, in capitals; empty if there is none.
    pub fn word_at(&self, index: usize) -> String {
        self.parameters()
            .nth(index)
            .map_or_else(String::new, |parameter| parameter.text.to_uppercase())
    }

    /// The text after its word, as written.
    pub fn free_text(&self) -> &str {
        self.text
            .get(self.word_span.end..)
            .unwrap_or_default()
            .trim_start_matches('/')
            .trim()
    }

    /// The place of its word.
    pub fn word_span(&self) -> Range<usize> {
        self.word_span.clone()
    }

    /// The place of all its parameters; of its word if there are none.
    pub fn parameters_span(&self) -> Range<usize> {
        match (self.parameters.first(), self.parameters.last()) {
            (Some(first), Some(last)) => first.start..last.end,
            _ => self.word_span(),
        }
    }

    /// A problem at a place of this statement.
    ///
    /// It is reported on the line where `span` begins.
    pub fn problem(&self, name: &str, span: Range<usize>, message: impl Into<String>, hint: &str) -> Problem {
        let after = self.pieces.partition_point(|(start, _)| *start <= span.start);
        // The first piece begins at 0, so that one always begins before.
        let (start, line) = &self.pieces[after.saturating_sub(1)];
        line.problem(
            name,
            span.start - start..span.end.saturating_sub(*start),
            message,
            hint,
        )
    }
}

/// The statements of a text, one by one.
pub(super) struct Statements<R> {
    lines: Lines<R>,
}

impl<R: BufRead> Statements<R> {
    /// Before the first line of the file `name`.
    pub fn new(name: &str, reader: R) -> Statements<R> {
        Statements {
            lines: Lines::new(name, reader),
        }
    }

    /// The next statement; `None` behind the last.
    ///
    /// Lines without anything but blanks and remarks are ignored.
    ///
    /// # Errors
    /// A file that is not text, and an unfinished statement.
    pub fn next(&mut self) -> Result<Option<Statement>, Problems> {
        let mut text = String::new();
        let mut pieces: Vec<(usize, Line)> = Vec::new();
        while let Some(line) = self.lines.next()? {
            let (said, continued) = match free_text(&line.text) && pieces.is_empty() {
                true => (line.text.as_str(), false),
                false => said(&line.text),
            };
            if pieces.is_empty() && said.trim_matches(is_blank).is_empty() && !continued {
                continue;
            }
            let start = text.len();
            text.push_str(said.trim_end_matches(is_blank));
            pieces.push((start, line));
            if !continued {
                return Ok(Some(statement(text, pieces)));
            }
            if pieces.len() == MOST_LINES {
                return Err(unended(self.lines.name(), &pieces).into());
            }
        }
        if !pieces.is_empty() {
            return Err(unended(self.lines.name(), &pieces).into());
        }
        Ok(None)
    }
}

/// A statement that goes on and does not end, at its first line.
fn unended(name: &str, pieces: &[(usize, Line)]) -> Problem {
    let (_, first) = &pieces[0];
    let message = match pieces.len() {
        MOST_LINES => format!("this statement has more than {MOST_LINES} lines"),
        _ => "this statement is continued by `$`, but the file ends".to_owned(),
    };
    first.problem(
        name,
        0..first.text.len(),
        message,
        "a `$` at the end of a line continues the statement on the next line",
    )
}

/// Blanks, and the byte that ended texts in DOS.
fn is_blank(c: char) -> bool {
    c.is_whitespace() || c == '\x1a'
}

/// What a line says before remarks, and whether the next one goes on.
fn said(line: &str) -> (&str, bool) {
    let line = line.split_once("$$").map_or(line, |(said, _)| said);
    line.split_once('$')
        .map_or((line, false), |(said, _)| (said, true))
}

/// Whether a line begins with a word of [`FREE_TEXT`], and not merely with its letters.
fn free_text(line: &str) -> bool {
    let line = line.trim_start();
    FREE_TEXT.iter().any(|word| {
        line.get(..word.len())
            .is_some_and(|begin| begin.eq_ignore_ascii_case(word))
            && !line[word.len()..].starts_with(|c: char| c.is_alphanumeric() || c == '_')
    })
}

/// Takes a text apart at its slash and commas.
fn statement(text: String, pieces: Vec<(usize, Line)>) -> Statement {
    let trimmed = |range: Range<usize>| {
        let part = &text[range.clone()];
        let start = range.start + part.len() - part.trim_start_matches(is_blank).len();
        start..start + part.trim_matches(is_blank).len()
    };
    let free = free_text(&text);
    let begin = text.len() - text.trim_start().len();
    let ends: &[char] = if free { &['/', ' ', '\t'] } else { &['/'] };
    let word_end = text[begin..].find(ends).map_or(text.len(), |at| begin + at);
    let word_span = trimmed(0..word_end);
    let mut parameters = Vec::new();
    if !free && word_end < text.len() {
        let mut from = word_end + 1;
        for at in text[from..]
            .match_indices(',')
            .map(|(at, _)| from + at)
            .chain([text.len()])
            .collect::<Vec<_>>()
        {
            parameters.push(trimmed(from..at));
            from = at + 1;
        }
        // `RAPID/` has no parameter rather than an empty one.
        if parameters.len() == 1 && parameters[0].is_empty() {
            parameters.clear();
        }
    }
    Statement {
        word: text[word_span.clone()].to_uppercase(),
        word_span,
        parameters,
        text,
        pieces,
    }
}

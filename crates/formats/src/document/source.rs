//! A text with the path it came from: turns byte offsets into lines, columns and excerpts.
//!
//! Offsets count bytes of the text without a byte order mark; lines and columns count from 1, columns in characters, as
//! editors show them. A line ends with `\n`; a `\r` before it belongs to the line and is not shown.

use std::ops::Range;
use std::str::Utf8Error;

use super::problem::{Excerpt, Problem};

/// A line longer than this is not shown: its problem is reported by line and column alone.
const LONGEST_EXCERPT_BYTES: usize = 8192;

/// A text and the path it was read from: what a [`Problem`] refers to.
///
/// Made for every text format, not for TOML alone. Offsets are bytes of [`Source::text`].
#[derive(Debug, Clone)]
pub struct Source {
    name: String,
    text: String,
    /// Offsets at which lines begin, rising: 0 first, then behind every `\n`.
    line_starts: Vec<usize>,
}

impl Source {
    /// A text to find problems in; a byte order mark at its start is dropped.
    pub fn new(name: &str, text: &str) -> Self {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let starts = text
            .bytes()
            .enumerate()
            .filter(|(_, byte)| *byte == b'\n')
            .map(|(at, _)| at + 1);
        Self {
            name: name.to_owned(),
            text: text.to_owned(),
            line_starts: std::iter::once(0).chain(starts).collect(),
        }
    }

    /// The path that problems show.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The text, without a byte order mark.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Line and column of a byte offset, both from 1; columns count characters.
    ///
    /// An offset past the end counts as the end, one inside a character as that character.
    pub fn position(&self, offset: usize) -> (usize, usize) {
        let offset = self.text.floor_char_boundary(offset);
        let line = self.line_starts.partition_point(|start| *start <= offset);
        let column = self.text[self.line_starts[line - 1]..offset].chars().count() + 1;
        (line, column)
    }

    /// A problem at a byte range of this text.
    ///
    /// The message names the thing, its value, the limit and the unit; the hint says what to do.
    pub fn problem(&self, span: Range<usize>, message: impl Into<String>, hint: Option<String>) -> Problem {
        let start = self.text.floor_char_boundary(span.start);
        let end = self.text.ceil_char_boundary(span.end).max(start);
        let (line, column) = self.position(start);
        Problem {
            file: self.name.clone(),
            line,
            column,
            span: start..end,
            message: message.into(),
            hint,
            excerpt: self.excerpt(line, start..end),
        }
    }

    /// The line a span begins on, and the part of the span that is on it.
    ///
    /// `None` for a line of more than 8192 bytes.
    fn excerpt(&self, line: usize, span: Range<usize>) -> Option<Excerpt> {
        let from = self.line_starts[line - 1];
        let to = self.line_starts.get(line).copied().unwrap_or(self.text.len());
        let text = self.text[from..to].trim_end_matches(['\n', '\r']);
        let within = |offset: usize| (offset - from).min(text.len());
        (text.len() <= LONGEST_EXCERPT_BYTES).then(|| Excerpt {
            text: text.to_owned(),
            span: within(span.start)..within(span.end),
        })
    }
}

/// The first byte that is not UTF-8, shown in the text as far as it can be read.
pub(super) fn not_utf8(name: &str, bytes: &[u8], error: &Utf8Error) -> Problem {
    let source = Source::new(name, &String::from_utf8_lossy(bytes));
    // Everything before the first bad byte is the same in both texts, but for the byte order mark that Source drops.
    let mark = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
    let at = error.valid_up_to().saturating_sub(mark);
    let message = match bytes.get(error.valid_up_to()) {
        Some(byte) => format!("the byte 0x{byte:02x} is not UTF-8 text"),
        None => "the text ends inside a UTF-8 character".to_owned(),
    };
    let hint = if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        "this file is UTF-16: save it as UTF-8"
    } else {
        "save the file as UTF-8"
    };
    source.problem(at..at + 1, message, Some(hint.to_owned()))
}

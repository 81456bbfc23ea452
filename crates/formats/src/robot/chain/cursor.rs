//! Walks over a text character by character and keeps its position.
//!
//! Offsets are bytes of the whole text, so that a range between two of them is the place of a problem. It never passes
//! the end of its range, and a search without result does not move it.

use std::ops::Range;

/// A place in a text.
#[derive(Clone, Debug)]
pub(super) struct Cursor<'a> {
    text: &'a str,
    at: usize,
    end: usize,
}

impl<'a> Cursor<'a> {
    /// The start of a range of `text`.
    pub fn over(text: &'a str, range: Range<usize>) -> Cursor<'a> {
        let end = range.end.min(text.len());
        Cursor {
            text,
            at: range.start.min(end),
            end,
        }
    }

    /// Its position, in bytes of the text.
    pub fn at(&self) -> usize {
        self.at
    }

    /// The text before it.
    fn rest(&self) -> &'a str {
        self.text.get(self.at..self.end).unwrap_or_default()
    }

    /// The character it is at; `None` at the end.
    pub fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    /// Steps over `requested` if it is next.
    pub fn take(&mut self, requested: char) -> bool {
        let here = self.peek() == Some(requested);
        if here {
            self.at += requested.len_utf8();
        }
        here
    }

    /// Steps over characters as long as they are `of` a kind.
    pub fn while_of(&mut self, of: impl Fn(char) -> bool) -> &'a str {
        let rest = self.rest();
        let length = rest.find(|c| !of(c)).unwrap_or(rest.len());
        self.at += length;
        rest.get(..length).unwrap_or_default()
    }

    /// Steps over white space.
    pub fn skip_blanks(&mut self) {
        self.while_of(char::is_whitespace);
    }

    /// A number without sign: digits, point, exponent.
    ///
    /// `None` if none is next, or one that is not finite.
    pub fn number(&mut self) -> Option<f64> {
        let rest = self.rest();
        let mut length = 0;
        let mut before = ' ';
        for c in rest.chars() {
            let part = c.is_ascii_digit()
                || c == '.'
                || (matches!(c, 'e' | 'E') && length > 0)
                || (matches!(c, '+' | '-') && matches!(before, 'e' | 'E'));
            if !part {
                break;
            }
            length += c.len_utf8();
            before = c;
        }
        let value = rest
            .get(..length)?
            .parse::<f64>()
            .ok()
            .filter(|value| value.is_finite())?;
        self.at += length;
        Some(value)
    }

    /// A name: letters, digits, `_`, `'`; a letter first.
    pub fn name(&mut self) -> Option<&'a str> {
        self.peek().filter(|c| c.is_alphabetic() || *c == '_')?;
        Some(self.while_of(|c| c.is_alphanumeric() || matches!(c, '_' | '\'')))
    }
}

//! A text as words, numbers, texts and marks, each with its place: what KRL, URScript and RAPID have in common.
//!
//! A sign is a mark of its own. What begins like a number and is none (`1.2.3`, `12mm`, beyond [`LARGEST`]) is told as
//! such: only who needs a number there knows whether it matters. Linear in the length of the text.

use std::ops::Range;

/// A piece of a text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Token {
    pub kind: Kind,
    pub start: usize,
    pub end: usize,
    /// Its line, from 1.
    pub line: u32,
}

/// What a piece is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// Letters, digits, underscores, `$`.
    Word,
    /// A number without sign.
    Number(f64),
    /// What begins with a digit and is no number.
    NoNumber,
    /// A text with its quotes.
    Text,
    /// Any other character.
    Mark(char),
    /// The end of a line.
    Line,
}

/// How a language writes remarks and texts.
pub(super) struct Syntax {
    /// What goes from here to the end of the line is for people.
    pub remark: char,
    /// What encloses texts; none goes over the end of its line.
    pub quotes: &'static [char],
}

/// No controller holds a larger number: 9E9 is ABB's word for an axis that is not there.
const LARGEST: f64 = 1e10;

impl Token {
    pub fn span(&self) -> Range<usize> {
        self.start..self.end
    }

    pub fn is(&self, mark: char) -> bool {
        self.kind == Kind::Mark(mark)
    }
}

/// The tokens of `text`, remarks left out.
pub(super) fn tokens(text: &str, syntax: &Syntax) -> Vec<Token> {
    let mut found = Vec::new();
    let mut line = 1;
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        let (kind, length) = if c == '\n' {
            (Kind::Line, 1)
        } else if c.is_whitespace() {
            at += c.len_utf8();
            continue;
        } else if c == syntax.remark {
            at += rest.find('\n').unwrap_or(rest.len());
            continue;
        } else if syntax.quotes.contains(&c) {
            let within = &rest[1..];
            let end = within.find([c, '\n']).unwrap_or(within.len());
            let closed = usize::from(within[end..].starts_with(c));
            (Kind::Text, 1 + end + closed)
        } else if is_digit(rest, 0) || (c == '.' && is_digit(rest, 1)) {
            number(rest)
        } else if is_of_word(c) {
            let end = rest.find(|c| !is_of_word(c)).unwrap_or(rest.len());
            (Kind::Word, end)
        } else {
            (Kind::Mark(c), c.len_utf8())
        };
        found.push(Token {
            kind,
            start: at,
            end: at + length,
            line,
        });
        line += u32::from(kind == Kind::Line);
        at += length;
    }
    found
}

fn is_of_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_' || c == '$'
}

fn is_digit(text: &str, at: usize) -> bool {
    text.as_bytes().get(at).is_some_and(u8::is_ascii_digit)
}

/// What stands at the beginning of `rest`, which begins like a number.
fn number(rest: &str) -> (Kind, usize) {
    let bytes = rest.as_bytes();
    let mut end = 0;
    while let Some(byte) = bytes.get(end) {
        let exponent = end > 0 && matches!(bytes[end - 1], b'e' | b'E') && is_digit(rest, end + 1);
        match byte {
            b'+' | b'-' if exponent => {}
            b'0'..=b'9' | b'a'..=b'z' | b'A'..=b'Z' | b'_' | b'.' => {}
            _ => break,
        }
        end += 1;
    }
    match rest[..end].parse::<f64>() {
        Ok(value) if value <= LARGEST => (Kind::Number(value), end),
        _ => (Kind::NoNumber, end),
    }
}

/// A way through tokens.
#[derive(Clone)]
pub(super) struct Cursor<'a> {
    pub text: &'a str,
    pub tokens: &'a [Token],
    /// Where its last token ends.
    pub end: usize,
    passed: usize,
}

impl<'a> Cursor<'a> {
    pub fn new(text: &'a str, tokens: &'a [Token]) -> Cursor<'a> {
        Cursor {
            text,
            tokens,
            end: tokens.last().map_or(0, |last| last.end),
            passed: tokens.first().map_or(0, |first| first.start),
        }
    }

    pub fn peek(&self) -> Option<Token> {
        self.tokens.first().copied()
    }

    pub fn next(&mut self) -> Option<Token> {
        let token = self.peek()?;
        self.tokens = &self.tokens[1..];
        self.passed = token.end;
        Some(token)
    }

    /// Goes past this mark, if it stands here.
    pub fn pass(&mut self, mark: char) -> bool {
        let here = self.peek().is_some_and(|token| token.is(mark));
        if here {
            self.next();
        }
        here
    }

    /// The word that stands here, in capitals.
    pub fn peek_word(&self) -> Option<String> {
        let token = self.peek().filter(|token| token.kind == Kind::Word)?;
        Some(self.text[token.span()].to_ascii_uppercase())
    }

    /// Goes past the word that stands here, if one does.
    pub fn word(&mut self) -> Option<String> {
        let word = self.peek_word()?;
        self.next();
        Some(word)
    }

    /// Goes past a number with its signs, if one stands here.
    pub fn number(&mut self) -> Option<f64> {
        let mut ahead = self.clone();
        let mut sign = 1.0;
        loop {
            match ahead.next()?.kind {
                Kind::Mark('-') => sign = -sign,
                Kind::Mark('+') => {}
                Kind::Number(value) => {
                    *self = ahead;
                    return Some(sign * value);
                }
                _ => return None,
            }
        }
    }

    /// Where the token that it passed last ends; of none, where its first begins.
    pub fn before(&self) -> usize {
        self.passed
    }

    /// Where it stands: the next token, or the end of the last.
    pub fn place(&self) -> Range<usize> {
        self.peek().map_or(self.end..self.end, |token| token.span())
    }
}

/// How many decimals a number is written with, within these bounds.
pub(super) fn decimals(number: &str, least: usize, most: usize) -> usize {
    let written = number.split_once('.').map_or(0, |(_, behind)| {
        behind.bytes().take_while(u8::is_ascii_digit).count()
    });
    written.clamp(least, most)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SYNTAX: Syntax = Syntax {
        remark: ';',
        quotes: &['"', '\''],
    };

    fn kinds(text: &str) -> Vec<(Kind, &str)> {
        tokens(text, &SYNTAX)
            .into_iter()
            .map(|token| (token.kind, &text[token.span()]))
            .collect()
    }

    #[test]
    fn a_line_falls_into_words_numbers_texts_and_marks() {
        let found = kinds("$VEL.CP=-.2E-1 ; a;b\nP[1]'B0;1'");
        assert_eq!(
            found,
            [
                (Kind::Word, "$VEL"),
                (Kind::Mark('.'), "."),
                (Kind::Word, "CP"),
                (Kind::Mark('='), "="),
                (Kind::Mark('-'), "-"),
                (Kind::Number(0.02), ".2E-1"),
                (Kind::Line, "\n"),
                (Kind::Word, "P"),
                (Kind::Mark('['), "["),
                (Kind::Number(1.0), "1"),
                (Kind::Mark(']'), "]"),
                (Kind::Text, "'B0;1'"),
            ]
        );
    }

    #[test]
    fn what_begins_like_a_number_and_is_none_is_told_whole() {
        for text in ["1.2.3", "12mm", "1e400", "0x1F", "1E", "9e10"] {
            assert_eq!(kinds(text), [(Kind::NoNumber, text)]);
        }
        assert_eq!(kinds("9E+09"), [(Kind::Number(9e9), "9E+09")]);
        assert_eq!(kinds("5."), [(Kind::Number(5.0), "5.")]);
    }

    #[test]
    fn a_text_without_end_ends_with_its_line() {
        assert_eq!(
            kinds("\"a\nb"),
            [(Kind::Text, "\"a"), (Kind::Line, "\n"), (Kind::Word, "b")]
        );
        assert_eq!(kinds("\""), [(Kind::Text, "\"")]);
    }

    #[test]
    fn decimals_are_those_written_within_bounds() {
        for (number, requested) in [
            ("1", 3),
            ("1.25", 3),
            ("1.23456", 5),
            ("1.5E3", 3),
            ("1.0123456789012", 9),
        ] {
            assert_eq!(decimals(number, 3, 9), requested);
        }
    }
}

//! A text as words, numbers, texts and marks with their positions: used for KRL, URScript and RAPID.
//!
//! A sign is a separate mark. Text that begins like a number and is not one (`1.2.3`, `12mm`, beyond [`LARGEST`]) gets
//! its own kind: the parser decides whether it needs a number there. The time is linear in the length of the text.

use std::ops::Range;

/// A token.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Token {
    pub kind: Kind,
    pub start: usize,
    pub end: usize,
    /// Its line, from 1.
    pub line: u32,
}

/// Kind of token.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// Letters, digits, underscores, `$`.
    Word,
    /// A number without sign.
    Number(f64),
    /// Begins with a digit and is not a number.
    NoNumber,
    /// A quoted text, quotes included.
    Text,
    /// Any other character.
    Mark(char),
    /// The end of a line.
    Line,
}

/// Syntax of remarks and quoted texts.
pub(super) struct Syntax {
    /// Beginning of a remark, which ends with the line.
    pub remark: char,
    /// Quotes; a text ends on its line.
    pub quotes: &'static [char],
}

/// Largest number: 9E9 is ABB's value for an absent axis.
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

/// The token at the beginning of `rest`, which begins like a number.
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

/// Position in a list of tokens.
#[derive(Clone)]
pub(super) struct Cursor<'a> {
    pub text: &'a str,
    pub tokens: &'a [Token],
    /// End of its last token.
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

    /// Moves past this mark, if it is next.
    pub fn pass(&mut self, mark: char) -> bool {
        let here = self.peek().is_some_and(|token| token.is(mark));
        if here {
            self.next();
        }
        here
    }

    /// The next word, in capitals, without moving.
    pub fn peek_word(&self) -> Option<String> {
        let token = self.peek().filter(|token| token.kind == Kind::Word)?;
        Some(self.text[token.span()].to_ascii_uppercase())
    }

    /// Moves past the next token if it is a word, and returns it.
    pub fn word(&mut self) -> Option<String> {
        let word = self.peek_word()?;
        self.next();
        Some(word)
    }

    /// Moves past the next number with its signs, if there is one.
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

    /// The byte ranges of the numbers of `[1, 2, 3]`, if the cursor is at a list of this many numbers and nothing
    /// follows.
    pub fn number_list(mut self, count: usize) -> Option<Vec<Range<usize>>> {
        self.pass('[').then_some(())?;
        let mut places = Vec::with_capacity(count);
        for index in 1..=count {
            let start = self.place().start;
            self.number()?;
            places.push(start..self.before());
            self.pass(if index < count { ',' } else { ']' }).then_some(())?;
        }
        self.peek().is_none().then_some(places)
    }

    /// End of the last passed token; before the first one its beginning.
    pub fn before(&self) -> usize {
        self.passed
    }

    /// Bytes of the next token, or the end of the last one.
    pub fn place(&self) -> Range<usize> {
        self.peek().map_or(self.end..self.end, |token| token.span())
    }
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
    fn a_line_is_split_into_words_numbers_texts_and_marks() {
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
    fn text_that_begins_like_a_number_and_is_not_one_is_a_single_token() {
        for text in ["1.2.3", "12mm", "1e400", "0x1F", "1E", "9e10"] {
            assert_eq!(kinds(text), [(Kind::NoNumber, text)]);
        }
        assert_eq!(kinds("9E+09"), [(Kind::Number(9e9), "9E+09")]);
        assert_eq!(kinds("5."), [(Kind::Number(5.0), "5.")]);
    }

    #[test]
    fn an_unclosed_text_ends_with_its_line() {
        assert_eq!(
            kinds("\"a\nb"),
            [(Kind::Text, "\"a"), (Kind::Line, "\n"), (Kind::Word, "b")]
        );
        assert_eq!(kinds("\""), [(Kind::Text, "\"")]);
    }
}

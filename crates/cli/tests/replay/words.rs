//! The words of a statement, and a cursor over them.

use crate::source::{Place, ReplayError};

#[derive(Clone, Debug, PartialEq)]
pub enum Word {
    /// Letters, digits, `_` and `$`, not beginning with a digit.
    Name(String),
    Number(f64),
    /// Between double quotes.
    Text(String),
    Symbol(char),
}

/// The statement of a line, and the comment that begins with a mark outside of quotes.
pub fn split_comment<'a>(line: &'a str, mark: &str) -> (&'a str, Option<&'a str>) {
    let mut quoted = false;
    for (at, letter) in line.char_indices() {
        if letter == '"' {
            quoted = !quoted;
        } else if !quoted && line[at..].starts_with(mark) {
            return (line[..at].trim(), Some(line[at + mark.len()..].trim()));
        }
    }
    (line.trim(), None)
}

/// The words of one statement, from left to right.
#[derive(Debug)]
pub struct Cursor {
    words: Vec<Word>,
    at: usize,
    place: Place,
}

impl Cursor {
    pub fn new(text: &str, place: &Place) -> Result<Cursor, ReplayError> {
        Ok(Cursor {
            words: words(text, place)?,
            at: 0,
            place: place.clone(),
        })
    }

    pub fn place(&self) -> &Place {
        &self.place
    }

    pub fn error(&self, message: impl Into<String>) -> ReplayError {
        self.place.error(message)
    }

    /// An error that quotes the next word.
    pub fn unexpected(&self, expected: &str) -> ReplayError {
        let found = self
            .words
            .get(self.at)
            .map_or("the end".to_owned(), |word| match word {
                Word::Name(name) => format!("`{name}`"),
                Word::Number(number) => format!("`{number}`"),
                Word::Text(text) => format!("\"{text}\""),
                Word::Symbol(symbol) => format!("`{symbol}`"),
            });
        self.error(format!("{expected} expected, found {found}"))
    }

    pub fn peek(&self) -> Option<&Word> {
        self.words.get(self.at)
    }

    /// Whether these symbols are next.
    pub fn sees(&self, symbols: &str) -> bool {
        symbols
            .chars()
            .enumerate()
            .all(|(ahead, symbol)| self.words.get(self.at + ahead) == Some(&Word::Symbol(symbol)))
    }

    /// Whether this name is next, in small or capital letters.
    pub fn sees_name(&self, name: &str) -> bool {
        matches!(self.peek(), Some(Word::Name(found)) if found.eq_ignore_ascii_case(name))
    }

    /// Whether these symbols follow the next word.
    pub fn sees_after(&self, symbols: &str) -> bool {
        symbols
            .chars()
            .enumerate()
            .all(|(ahead, symbol)| self.words.get(self.at + 1 + ahead) == Some(&Word::Symbol(symbol)))
    }

    /// Takes these symbols if they are next.
    pub fn eat(&mut self, symbols: &str) -> bool {
        let found = self.sees(symbols);
        if found {
            self.at += symbols.chars().count();
        }
        found
    }

    /// Takes this name if it is next, in small or capital letters.
    pub fn eat_name(&mut self, name: &str) -> bool {
        let found = self.sees_name(name);
        if found {
            self.at += 1;
        }
        found
    }

    pub fn expect(&mut self, symbols: &str) -> Result<(), ReplayError> {
        if self.eat(symbols) {
            return Ok(());
        }
        Err(self.unexpected(&format!("`{symbols}`")))
    }

    pub fn name(&mut self) -> Result<String, ReplayError> {
        match self.peek() {
            Some(Word::Name(name)) => {
                let name = name.clone();
                self.at += 1;
                Ok(name)
            }
            _ => Err(self.unexpected("a name")),
        }
    }

    /// A number with its sign.
    pub fn number(&mut self) -> Result<f64, ReplayError> {
        let sign = if self.eat("-") {
            -1.0
        } else {
            self.eat("+");
            1.0
        };
        match self.peek() {
            Some(Word::Number(number)) => {
                let number = *number;
                self.at += 1;
                Ok(sign * number)
            }
            _ => Err(self.unexpected("a number")),
        }
    }

    /// Takes words up to this symbol, which stays.
    pub fn skip_to(&mut self, symbol: char) -> Result<(), ReplayError> {
        while !self.at_end() {
            if self.words[self.at] == Word::Symbol(symbol) {
                return Ok(());
            }
            self.at += 1;
        }
        Err(self.unexpected(&format!("`{symbol}`")))
    }

    /// A number without fraction and sign.
    pub fn count(&mut self) -> Result<u32, ReplayError> {
        let number = self.number()?;
        if number < 0.0 || number.fract() != 0.0 || number > f64::from(u32::MAX) {
            return Err(self.error(format!("`{number}` is not a whole number from 0")));
        }
        Ok(number as u32)
    }

    pub fn text(&mut self) -> Result<String, ReplayError> {
        match self.peek() {
            Some(Word::Text(text)) => {
                let text = text.clone();
                self.at += 1;
                Ok(text)
            }
            _ => Err(self.unexpected("a text between quotes")),
        }
    }

    pub fn at_end(&self) -> bool {
        self.at >= self.words.len()
    }

    /// Checks that nothing follows.
    pub fn end(&self) -> Result<(), ReplayError> {
        if self.at_end() {
            return Ok(());
        }
        Err(self.unexpected("the end of the statement"))
    }

    /// Everything that follows, written again.
    pub fn rest(&mut self) -> String {
        let mut out = String::new();
        for word in &self.words[self.at.min(self.words.len())..] {
            let piece = match word {
                Word::Name(name) => name.clone(),
                Word::Number(number) => number.to_string(),
                Word::Text(text) => format!("\"{text}\""),
                Word::Symbol(symbol) => symbol.to_string(),
            };
            let glued = |c: Option<char>| c.is_none_or(|c| !c.is_alphanumeric());
            if !glued(out.chars().last()) && !glued(piece.chars().next()) {
                out.push(' ');
            }
            out.push_str(&piece);
        }
        self.at = self.words.len();
        out
    }
}

fn words(text: &str, place: &Place) -> Result<Vec<Word>, ReplayError> {
    let letters: Vec<char> = text.chars().collect();
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(&letter) = letters.get(at) {
        let end = |from: usize, part: &dyn Fn(char) -> bool| {
            (from..letters.len())
                .find(|&at| !part(letters[at]))
                .unwrap_or(letters.len())
        };
        let is_digit = |at: usize| letters.get(at).is_some_and(char::is_ascii_digit);
        if letter.is_whitespace() {
            at += 1;
        } else if letter.is_alphabetic() || letter == '_' || letter == '$' {
            let to = end(at, &|c| c.is_alphanumeric() || c == '_' || c == '$');
            found.push(Word::Name(letters[at..to].iter().collect()));
            at = to;
        } else if letter.is_ascii_digit()
            || letter == '.' && is_digit(at + 1) && !(at > 0 && ends_value(letters[at - 1]))
        {
            let mut to = end(at, &|c| c.is_ascii_digit());
            if letters.get(to) == Some(&'.') {
                to = end(to + 1, &|c| c.is_ascii_digit());
            }
            if matches!(letters.get(to), Some('e' | 'E')) {
                let sign = usize::from(matches!(letters.get(to + 1), Some('+' | '-')));
                if is_digit(to + 1 + sign) {
                    to = end(to + 1 + sign, &|c| c.is_ascii_digit());
                }
            }
            let written: String = letters[at..to].iter().collect();
            let number = written
                .parse()
                .map_err(|_| place.error(format!("`{written}` is not a number")))?;
            found.push(Word::Number(number));
            at = to;
        } else if letter == '"' {
            let mut text = String::new();
            at += 1;
            loop {
                match (letters.get(at), letters.get(at + 1)) {
                    (None, _) => return Err(place.error("the text has no closing quote")),
                    // A doubled quote is one quote of the text.
                    (Some('"'), Some('"')) => at += 1,
                    (Some('"'), _) => break,
                    _ => {}
                }
                text.push(letters[at]);
                at += 1;
            }
            at += 1;
            found.push(Word::Text(text));
        } else {
            found.push(Word::Symbol(letter));
            at += 1;
        }
    }
    Ok(found)
}

/// Whether a point directly after this letter is that of a component: `a.1` is not `a` and `0.1`.
fn ends_value(letter: char) -> bool {
    letter.is_alphanumeric() || "_$])}".contains(letter)
}

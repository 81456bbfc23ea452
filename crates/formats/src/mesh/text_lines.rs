//! Lines of a text format in memory, and the numbers on them.
//!
//! Lines end with `\n`, `\r\n` or `\r`. A text of any encoding that contains ASCII is accepted: numbers and keywords are
//! ASCII, names and comments are not used.

use crate::document::{Problem, Problems, Source};

use super::assembly::checked;

/// Of a longer line, in bytes, only the number is shown.
const LONGEST_SHOWN: usize = 1 << 16;

/// One line without its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct TextLine<'a> {
    /// From 1.
    pub number: usize,
    /// What is on it.
    pub bytes: &'a [u8],
    /// Bytes of the file before it.
    start: usize,
}

/// The lines of a file, one by one.
#[derive(Clone, Copy, Debug)]
pub(super) struct TextLines<'a> {
    /// What follows.
    rest: &'a [u8],
    /// Lines so far.
    number: usize,
    /// Bytes so far.
    start: usize,
}

impl<'a> TextLines<'a> {
    /// Before the first line; a byte order mark of UTF-8 is passed over.
    pub fn new(bytes: &'a [u8]) -> TextLines<'a> {
        let rest = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        TextLines {
            rest,
            number: 0,
            start: bytes.len() - rest.len(),
        }
    }

    /// Bytes of the file before the next line.
    pub fn start(&self) -> usize {
        self.start
    }
}

impl<'a> Iterator for TextLines<'a> {
    type Item = TextLine<'a>;

    fn next(&mut self) -> Option<TextLine<'a>> {
        if self.rest.is_empty() {
            return None;
        }
        let end = self.rest.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
        let length = end.unwrap_or(self.rest.len());
        let taken = match self.rest.get(length..) {
            Some([b'\r', b'\n', ..]) => length + 2,
            Some([_, ..]) => length + 1,
            _ => length,
        };
        self.number += 1;
        let line = TextLine {
            number: self.number,
            bytes: &self.rest[..length],
            start: self.start,
        };
        self.rest = &self.rest[taken..];
        self.start += taken;
        Some(line)
    }
}

impl<'a> TextLine<'a> {
    /// Its words, between blanks.
    pub fn words(&self) -> impl Iterator<Item = &'a [u8]> + use<'a> {
        self.bytes
            .split(u8::is_ascii_whitespace)
            .filter(|word| !word.is_empty())
    }

    /// The same line with other text: without a comment, or joined with the lines that continue it.
    pub fn with_bytes<'b>(&self, bytes: &'b [u8]) -> TextLine<'b> {
        TextLine { bytes, ..*self }
    }

    /// A problem of the line, at `word` if that is a part of it; of a very long line without column.
    pub fn problem(&self, name: &str, word: &[u8], message: impl Into<String>, hint: &str) -> Problem {
        if self.bytes.len() > LONGEST_SHOWN {
            return Problem::of_file(name, message, hint).in_file(self.number, self.start);
        }
        let before = word.as_ptr().addr().wrapping_sub(self.bytes.as_ptr().addr());
        let is_part = before.saturating_add(word.len()) <= self.bytes.len();
        let span = match is_part {
            true => before..before + word.len(),
            false => 0..self.bytes.len(),
        };
        let text = String::from_utf8_lossy(self.bytes);
        Source::new(name, &text)
            .problem(span, message, Some(hint.to_owned()))
            .in_file(self.number, self.start)
    }
}

/// The number that a word is.
///
/// # Errors
/// Not a number, not finite, or too large: what is wrong.
pub(super) fn coordinate(word: &[u8]) -> Result<f64, String> {
    let number = std::str::from_utf8(word)
        .ok()
        .and_then(|word| word.parse::<f64>().ok());
    match number {
        Some(number) => checked(number),
        None => Err(format!("`{}` is not a number", String::from_utf8_lossy(word))),
    }
}

/// What to do about a coordinate that is not accepted.
pub(super) const NUMBERS: &str = "coordinates are finite numbers with a decimal point, up to 1e9";

/// Three coordinates, the next words of a line.
///
/// # Errors
/// Fewer than three words, or one that is no coordinate.
pub(super) fn three<'a>(
    line: &TextLine<'a>,
    words: &mut impl Iterator<Item = &'a [u8]>,
    name: &str,
) -> Result<[f64; 3], Problems> {
    let mut point = [0.0; 3];
    for (index, value) in point.iter_mut().enumerate() {
        let Some(word) = words.next() else {
            let message = format!("{index} coordinates: 3 required");
            return Err(line.problem(name, line.bytes, message, NUMBERS).into());
        };
        *value =
            coordinate(word).map_err(|message| Problems::from(line.problem(name, word, message, NUMBERS)))?;
    }
    Ok(point)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_line_ends_are_read_and_places_are_those_of_the_file() {
        let lines: Vec<TextLine> = TextLines::new(b"\xef\xbb\xbfa\r\nb b\rc\n\nd").collect();
        let texts: Vec<&[u8]> = lines.iter().map(|line| line.bytes).collect();
        assert_eq!(texts, [&b"a"[..], b"b b", b"c", b"", b"d"]);
        let word = lines[1].words().nth(1).unwrap();
        let problem = lines[1].problem("a.obj", word, "no", "yes");
        assert_eq!((problem.line(), problem.column(), problem.span()), (2, 3, 8..9));
        assert_eq!(problem.to_string(), "a.obj:2:3: no");
        let of_line = lines[4].problem("a.obj", b"elsewhere", "no", "yes");
        assert_eq!((of_line.line(), of_line.span()), (5, 13..14));
        let long = [b"a\n".to_vec(), vec![b'b'; LONGEST_SHOWN + 1]].concat();
        let line = TextLines::new(&long).nth(1).unwrap();
        let of_long = line.problem("a.obj", &line.bytes[9..], "no", "yes");
        assert_eq!((of_long.line(), of_long.column(), of_long.span()), (2, 1, 2..2));
    }

    #[test]
    fn numbers_keep_all_their_digits() {
        assert_eq!(coordinate(b"0.1234567890123456"), Ok(0.1234567890123456));
        assert_eq!(coordinate(b"1,5").unwrap_err(), "`1,5` is not a number");
        assert_eq!(coordinate(b"nan").unwrap_err(), "NaN is not a finite number");
        assert!(coordinate(b"\xff").unwrap_err().ends_with("is not a number"));
    }
}

//! A text that is read line by line, never as a whole: tool paths and force records may be of any length.
//!
//! UTF-8 with or without byte order mark, any line ends; a line that is not UTF-8 is read as Latin-1, which only
//! comments and names can contain. Zero bytes at the end of a line are dropped.
//!
//! | byte | taken as |
//! |---|---|
//! | `\n`, `\r`, `\r\n` | end of a line; mixed ends are fine |
//! | `EF BB BF` at the start of the file | dropped |
//! | `FF FE`, `FE FF` at the start of the file | UTF-16: refused |
//! | `00` at the end of a line | dropped |
//! | tab, `0C` (form feed), `1A` (end of a text in DOS) | kept in the line |
//! | any other below `20`, and `7F` | refused: the file is not text |

use std::io::{self, BufRead, ErrorKind};
use std::ops::Range;

use super::problem::{Excerpt, Problem, Problems};

/// No line of a tool path or of a record is longer, in bytes.
pub(crate) const LONGEST_LINE: usize = 1 << 16;

/// A line longer than this is not shown: its problem is reported by line and column alone.
const LONGEST_EXCERPT_BYTES: usize = 8192;

/// One line, and where it is in its file.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    /// From 1.
    pub number: usize,
    /// What is on it, without its end.
    pub text: String,
    /// Bytes of the file before it.
    start: usize,
}

impl Line {
    /// A problem at a byte range of this line of the file `name`.
    ///
    /// The column counts characters; the span of the problem is in bytes of the whole file, as far as the line is
    /// UTF-8.
    pub fn problem(&self, name: &str, span: Range<usize>, message: impl Into<String>, hint: &str) -> Problem {
        let begin = self.text.floor_char_boundary(span.start);
        let end = self.text.ceil_char_boundary(span.end).max(begin);
        Problem {
            file: name.to_owned(),
            line: self.number,
            column: self.text[..begin].chars().count() + 1,
            span: self.start + begin..self.start + end,
            message: message.into(),
            hint: Some(hint.to_owned()),
            excerpt: (self.text.len() <= LONGEST_EXCERPT_BYTES).then(|| Excerpt {
                text: self.text.clone(),
                span: begin..end,
            }),
        }
    }
}

/// The lines of a text as bytes, one by one: each ends with a line feed, a carriage return, or both.
#[derive(Debug)]
pub(crate) struct RawLines<R> {
    reader: R,
    /// Lines so far.
    number: usize,
    /// Bytes of the file so far.
    start: usize,
    /// Whether the line before ended with a carriage return, to which a line feed may belong.
    after_return: bool,
}

impl<R: BufRead> RawLines<R> {
    /// Before the first line.
    pub fn new(reader: R) -> RawLines<R> {
        RawLines {
            reader,
            number: 0,
            start: 0,
            after_return: false,
        }
    }

    /// Takes the next line into `bytes`, without its end and without the mark that begins a text in UTF-8; the bytes of
    /// the file before it, `None` behind the last. Of a line of more than `longest` bytes one more than that is kept.
    ///
    /// So a caller sees by the length alone that the line is too long, and a file without line ends takes no more
    /// memory than one line may. A last line without an end counts as one; an empty piece behind the last end does not.
    ///
    /// # Errors
    /// A reader that fails, unless it was merely interrupted.
    pub fn next(&mut self, bytes: &mut Vec<u8>, longest: usize) -> io::Result<Option<usize>> {
        const MARK: &[u8] = b"\xef\xbb\xbf";
        bytes.clear();
        let mut taken = 0;
        loop {
            let buffer = match self.reader.fill_buf() {
                Ok(buffer) => buffer,
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(error) => return Err(error),
            };
            if buffer.is_empty() {
                break;
            }
            if std::mem::take(&mut self.after_return) && buffer.first() == Some(&b'\n') {
                self.reader.consume(1);
                self.start += 1;
                continue;
            }
            let end = buffer.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
            let length = end.unwrap_or(buffer.len());
            let room = (longest + 1).saturating_sub(bytes.len()).min(length);
            bytes.extend_from_slice(&buffer[..room]);
            self.after_return = end.is_some_and(|end| buffer[end] == b'\r');
            let used = length + usize::from(end.is_some());
            self.reader.consume(used);
            taken += used;
            if end.is_some() {
                break;
            }
        }
        if taken == 0 {
            return Ok(None);
        }
        let mut start = self.start;
        self.start += taken;
        self.number += 1;
        if self.number == 1 && bytes.starts_with(MARK) {
            bytes.drain(..MARK.len());
            start += MARK.len();
        }
        Ok(Some(start))
    }
}

impl<R: BufRead> RawLines<R> {
    /// Takes the next `count` bytes as they are, fewer at the end of the file: binary data between lines. A line feed after a carriage return belongs
    /// to the line before.
    ///
    /// # Errors
    /// Those of [`RawLines::next`].
    pub fn take_bytes(&mut self, count: usize) -> io::Result<Vec<u8>> {
        let mut taken = Vec::new();
        while taken.len() < count {
            let buffer = match self.reader.fill_buf() {
                Ok(buffer) => buffer,
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(error) => return Err(error),
            };
            if buffer.is_empty() {
                break;
            }
            if std::mem::take(&mut self.after_return) && buffer.first() == Some(&b'\n') {
                self.reader.consume(1);
                self.start += 1;
                continue;
            }
            let used = buffer.len().min(count - taken.len());
            taken.extend_from_slice(&buffer[..used]);
            self.reader.consume(used);
            self.start += used;
        }
        Ok(taken)
    }
}

/// The lines of a text, one by one.
#[derive(Debug)]
pub(crate) struct Lines<R> {
    /// Where it is in the file.
    raw: RawLines<R>,
    name: String,
    /// The line that was read last; kept so that its memory is used again.
    bytes: Vec<u8>,
}

impl<R: BufRead> Lines<R> {
    /// Before the first line of the file `name`.
    pub fn new(name: &str, reader: R) -> Lines<R> {
        Lines {
            raw: RawLines::new(reader),
            name: name.to_owned(),
            bytes: Vec::new(),
        }
    }

    /// The path that problems show.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The next line that is neither empty nor a remark; `None` behind the last.
    ///
    /// # Errors
    /// Those of [`Lines::next`].
    pub fn next_row(&mut self) -> Result<Option<Line>, Problems> {
        loop {
            match self.next()? {
                Some(line) if is_remark(&line.text) => {}
                other => return Ok(other),
            }
        }
    }

    /// The next `count` bytes as they are, fewer at the end of the file: binary data between lines.
    ///
    /// # Errors
    /// A reader that fails.
    pub fn take_bytes(&mut self, count: usize) -> Result<Vec<u8>, Problems> {
        self.raw.take_bytes(count).map_err(|error| {
            let message = format!("cannot be read further: {error}");
            self.nothing_to_show(self.raw.number + 1, message, "copy the file again")
        })
    }

    /// The next line; `None` behind the last.
    ///
    /// # Errors
    /// A reader that fails, a line longer than [`LONGEST_LINE`], bytes that no text has.
    pub fn next(&mut self) -> Result<Option<Line>, Problems> {
        let start = match self.raw.next(&mut self.bytes, LONGEST_LINE) {
            Ok(Some(start)) => start,
            Ok(None) => return Ok(None),
            Err(error) => {
                let message = format!("cannot be read further: {error}");
                return Err(self.nothing_to_show(self.raw.number + 1, message, "copy the file again"));
            }
        };
        let number = self.raw.number;
        let bytes = self.bytes.as_slice();
        if bytes.len() > LONGEST_LINE {
            let message = format!("line {number} is longer than {LONGEST_LINE} bytes");
            return Err(self.nothing_to_show(number, message, "a text file with lines is required"));
        }
        if number == 1 && (bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff])) {
            let hint = "this file is UTF-16: save it as UTF-8";
            return Err(self.nothing_to_show(1, "not a text of single bytes", hint));
        }
        let kept = bytes
            .iter()
            .rposition(|byte| *byte != 0)
            .map_or(0, |last| last + 1);
        let bytes = bytes.get(..kept).unwrap_or_default();
        let text = match std::str::from_utf8(bytes) {
            Ok(text) => text.to_owned(),
            Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect(),
        };
        let line = Line { number, text, start };
        // 0x1a ends a text in DOS.
        let strange = |c: char| c.is_ascii_control() && !matches!(c, '\t' | '\x0c' | '\x1a');
        if let Some((at, c)) = line.text.char_indices().find(|(_, c)| strange(*c)) {
            let message = format!("not a text file: it contains the byte 0x{:02x}", u32::from(c));
            let hint = "a text file is required: this is a file of another kind";
            return Err(line.problem(&self.name, at..at + 1, message, hint).into());
        }
        Ok(Some(line))
    }

    /// A problem of line `number`, of which no text can be shown.
    ///
    /// It follows the last line that was read.
    fn nothing_to_show(&self, number: usize, message: impl Into<String>, hint: &str) -> Problems {
        Problems::from(Problem {
            file: self.name.clone(),
            line: number,
            column: 1,
            span: self.raw.start..self.raw.start,
            message: message.into(),
            hint: Some(hint.to_owned()),
            excerpt: None,
        })
    }
}

/// Whether a line has no content: it is empty, or begins with `#`.
pub(crate) fn is_remark(line: &str) -> bool {
    let line = line.trim_start();
    line.is_empty() || line.starts_with('#')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(bytes: &[u8]) -> Result<Vec<Line>, Problems> {
        let mut lines = Lines::new("a.txt", bytes);
        let mut all = Vec::new();
        while let Some(line) = lines.next()? {
            all.push(line);
        }
        Ok(all)
    }

    #[test]
    fn all_line_ends_marks_zero_bytes_and_latin_letters_are_read() {
        let text = b"\xef\xbb\xbfone\r\ntwo\rthree\n\nH\xf6he\0\0";
        let found: Vec<String> = lines(text).unwrap().into_iter().map(|line| line.text).collect();
        assert_eq!(found, ["one", "two", "three", "", "H\u{f6}he"]);
    }

    #[test]
    fn a_carriage_return_and_its_line_feed_are_one_end_across_a_buffer() {
        let reader = io::BufReader::with_capacity(4, &b"one\r\ntwo\r\n"[..]);
        let mut lines = Lines::new("a.txt", reader);
        assert_eq!(lines.next().unwrap().unwrap().text, "one");
        let two = lines.next().unwrap().unwrap();
        assert_eq!((two.text.as_str(), two.number), ("two", 2));
        assert!(lines.next().unwrap().is_none());
    }

    #[test]
    fn a_problem_has_line_column_and_byte() {
        let all = lines("\u{e4}\r\n\u{e4}bc".as_bytes()).unwrap();
        let problem = all[1].problem("a.txt", 2..3, "no", "yes");
        assert_eq!((problem.line(), problem.column()), (2, 2));
        assert_eq!(problem.span(), 6..7);
        assert_eq!(problem.to_string(), "a.txt:2:2: no");
    }

    #[test]
    fn refuses_bytes_that_are_not_text_with_their_place() {
        let refused = |bytes: &[u8]| lines(bytes).unwrap_err().to_string();
        assert!(refused(b"a\nb\x01\n").contains("a.txt:2:2: not a text file: it contains the byte 0x01"));
        assert!(refused(b"\xff\xfea\0").contains("UTF-16"));
        let long = vec![b'x'; LONGEST_LINE + 1];
        assert!(refused(&long).contains("a.txt:1:1: line 1 is longer than 65536 bytes"));
    }

    #[test]
    fn remarks_begin_with_a_hash_or_are_empty() {
        assert!(is_remark("") && is_remark("  ") && is_remark(" # x") && !is_remark("x # y"));
    }
}

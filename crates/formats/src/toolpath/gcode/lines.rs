//! Lines of a program, one at a time: a file of any length is never stored completely.

use std::collections::VecDeque;
use std::io::{self, BufRead};
use std::rc::Rc;

use super::block::LONGEST_LINE;
use crate::document::lines::RawLines;

/// A line and its position.
#[derive(Clone, Debug, Default)]
pub(super) struct Line {
    /// Without its end; cut where it is longer than any line may be.
    pub text: Vec<u8>,
    /// From 1.
    pub number: u32,
    /// Bytes of the file before it.
    pub offset: usize,
    /// The file, where it is not the program.
    pub file: Option<Rc<str>>,
}

impl Line {
    /// Memory needed to store it.
    fn bytes(&self) -> usize {
        self.text.len() + size_of::<Line>()
    }
}

/// The lines of a program still to come.
pub(super) struct Lines<'r> {
    raw: RawLines<&'r mut dyn BufRead>,
    /// Read already while something was looked for, in order.
    ahead: VecDeque<Line>,
    /// Bytes that these take.
    ahead_bytes: usize,
    /// Of the line that was read last.
    number: u32,
    file: Option<Rc<str>>,
}

impl<'r> Lines<'r> {
    /// Of the program itself, or of another file.
    pub fn new(reader: &'r mut dyn BufRead, file: Option<Rc<str>>) -> Lines<'r> {
        Lines {
            raw: RawLines::new(reader),
            ahead: VecDeque::new(),
            ahead_bytes: 0,
            number: 0,
            file,
        }
    }

    /// The next line; false at the end.
    pub fn next(&mut self, line: &mut Line) -> io::Result<bool> {
        if let Some(next) = self.ahead.pop_front() {
            self.ahead_bytes -= next.bytes();
            *line = next;
            return Ok(true);
        }
        self.read(line)
    }

    /// The next line of the text, whatever was read ahead.
    fn read(&mut self, line: &mut Line) -> io::Result<bool> {
        line.file.clone_from(&self.file);
        let Some(offset) = self.raw.next(&mut line.text, LONGEST_LINE)? else {
            return Ok(false);
        };
        self.number = self.number.saturating_add(1);
        (line.number, line.offset) = (self.number, offset);
        Ok(true)
    }

    /// All lines still to come, at most so many bytes; they still come.
    ///
    /// They are kept, and `next` gives them before anything else is read.
    pub fn look_ahead(&mut self, most_bytes: usize) -> io::Result<&VecDeque<Line>> {
        let mut line = Line::default();
        while self.ahead_bytes < most_bytes && self.read(&mut line)? {
            self.ahead_bytes += line.bytes();
            self.ahead.push_back(std::mem::take(&mut line));
        }
        Ok(&self.ahead)
    }
}

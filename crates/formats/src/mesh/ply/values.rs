//! The numbers of a PLY file behind its header, one after the other.

use super::super::text_lines::{TextLine, TextLines};
use super::header::{Element, Encoding, Property, Scalar};
use crate::document::Problem;

/// Why a value or a row is not accepted.
#[derive(Debug)]
pub(super) enum Fault {
    /// The file ends.
    End,
    /// What is wrong in the row, and a hint.
    Row(String, &'static str),
}

/// What is left of the file.
#[derive(Clone)]
pub(super) struct Values<'a> {
    encoding: Encoding,
    /// Of a binary file: what follows.
    rest: &'a [u8],
    /// Bytes of the whole file, and those before the row.
    length: usize,
    row_start: usize,
    /// Of an ASCII file: the lines that follow.
    lines: TextLines<'a>,
    /// The line of the last row, and what follows on it.
    line: Option<TextLine<'a>>,
    rest_of_line: &'a [u8],
}

impl<'a> Values<'a> {
    /// The values behind the header, of which `lines` are those that follow.
    pub fn new(bytes: &'a [u8], lines: TextLines<'a>, encoding: Encoding) -> Values<'a> {
        Values {
            encoding,
            rest: bytes.get(lines.start()..).unwrap_or_default(),
            length: bytes.len(),
            row_start: lines.start(),
            lines,
            line: None,
            rest_of_line: &[],
        }
    }

    /// The next value.
    ///
    /// # Errors
    /// The end of the file; text that is not a number.
    pub fn next(&mut self, scalar: Scalar) -> Result<f64, Fault> {
        if self.encoding == Encoding::Ascii {
            return self.word();
        }
        let (bytes, rest) = self.rest.split_at_checked(scalar.bytes()).ok_or(Fault::End)?;
        self.rest = rest;
        let mut number = [0; 8];
        // As little-endian bytes, the first of a number that fills the array.
        match self.encoding {
            Encoding::BigEndian => (0..bytes.len()).for_each(|at| number[at] = bytes[bytes.len() - 1 - at]),
            _ => number[..bytes.len()].copy_from_slice(bytes),
        }
        let [a, b, c, d, ..] = number;
        Ok(match scalar {
            Scalar::I8 => f64::from(i8::from_le_bytes([a])),
            Scalar::U8 => f64::from(a),
            Scalar::I16 => f64::from(i16::from_le_bytes([a, b])),
            Scalar::U16 => f64::from(u16::from_le_bytes([a, b])),
            Scalar::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Scalar::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Scalar::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Scalar::F64 => f64::from_le_bytes(number),
        })
    }

    /// The number of values of a list.
    ///
    /// # Errors
    /// Not a whole number from 0; the end of the file.
    pub fn count(&mut self, scalar: Scalar) -> Result<usize, Fault> {
        let value = self.next(scalar)?;
        let count = value as usize;
        if count as f64 == value {
            return Ok(count);
        }
        let message = format!("{value} is not a number of values");
        Err(Fault::Row(message, "lists begin with their number of values"))
    }

    /// The next word of an ASCII file as a number; a row begins on a new line.
    fn word(&mut self) -> Result<f64, Fault> {
        loop {
            let text = self.rest_of_line.trim_ascii_start();
            let length = text
                .iter()
                .position(u8::is_ascii_whitespace)
                .unwrap_or(text.len());
            let (word, rest) = text.split_at(length);
            self.rest_of_line = rest;
            if !word.is_empty() {
                let number = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
                return number.ok_or_else(|| {
                    let message = format!("`{}` is not a number", String::from_utf8_lossy(word));
                    Fault::Row(message, "numbers have a decimal point, and blanks between them")
                });
            }
            let line = self.lines.next().ok_or(Fault::End)?;
            self.rest_of_line = line.bytes;
            self.line = Some(line);
        }
    }

    /// Begins a row, which problems are then reported at.
    pub fn begin_row(&mut self) {
        self.row_start = self.length - self.rest.len();
    }

    /// Ends a row: in an ASCII file nothing may follow on its line.
    ///
    /// # Errors
    /// Further words on the line.
    pub fn end_row(&mut self) -> Result<(), Fault> {
        let rest = self.rest_of_line.trim_ascii();
        if rest.is_empty() {
            return Ok(());
        }
        let message = format!(
            "`{}` exceeds the properties of the header",
            String::from_utf8_lossy(rest)
        );
        Err(Fault::Row(
            message,
            "each line has one value for each property, lists with their number",
        ))
    }

    /// Whether nothing follows but blanks.
    pub fn is_at_end(&self) -> bool {
        match self.encoding {
            Encoding::Ascii => self.lines.clone().all(|line| line.bytes.trim_ascii().is_empty()),
            _ => self.rest.is_empty(),
        }
    }

    /// The number of rows of an element, as far as the rest of the file can contain them: for memory that is reserved.
    pub fn most_rows(&self, element: &Element) -> usize {
        let shortest = |property: &Property| match self.encoding {
            // A digit and a blank.
            Encoding::Ascii => 2,
            _ => property.list_count.unwrap_or(property.scalar).bytes(),
        };
        let row: usize = element.properties.iter().map(shortest).sum();
        element.count.min(self.rest.len() / row.max(1) + 1)
    }

    /// A problem of the row that was begun last.
    pub fn problem(&self, name: &str, element: &Element, index: usize, fault: Fault) -> Problem {
        let row = format!("{} {} of {}", element.name, index + 1, element.count);
        let (message, hint) = match fault {
            Fault::End => (
                format!("the file ends before {row}"),
                "it is cut short: export it again",
            ),
            Fault::Row(message, hint) => (format!("{row}: {message}"), hint),
        };
        // Before the first row of an ASCII file there is no line yet.
        let line = match (self.encoding, self.line) {
            (Encoding::Ascii, Some(line)) => line,
            _ => {
                let message = format!("byte {}: {message}", self.row_start);
                return Problem::of_file(name, message, hint).in_file(1, self.row_start);
            }
        };
        line.problem(name, line.bytes, message, hint)
    }
}

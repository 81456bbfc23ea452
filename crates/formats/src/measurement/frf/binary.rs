//! Binary data of a function: dataset 58b.
//!
//! | field of the line with the number | content |
//! |---|---|
//! | 1 | byte order: 1 little endian, 2 big endian |
//! | 2 | format of numbers: 2 IEEE 754; 1 (DEC VMS) and 3 (IBM) are not read |
//! | 3 | lines of text that follow: 11, the records 1 to 11 of dataset 58 |
//! | 4 | bytes that follow them, up to the last line `-1` |
//!
//! Numbers follow each other as in the dataset in text, in single precision (4 bytes) for the types of data 2 and 5, else double. With uneven spacing and
//! double precision the abscissa has 8 bytes, or 4 if that gives the stated number of bytes. If neither does, the count of record 7 decides, and
//! the end of the dataset must follow: pyuff 2.5.8 states half of the bytes of complex data. Source: universal file formats of the
//! SDRC, dataset 58b, University of Cincinnati (text in pyuff 2.5.8).

use std::io::BufRead;

use super::layout::Shape;
use crate::document::lines::{Line, Lines};
use crate::document::{Problem, Problems};

/// Lines of text before the data.
const TEXT_LINES: &str = "11";
const HINT: &str = "export the file again, or as text: dataset 58";

/// How the data are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct BinaryForm {
    is_big_endian: bool,
    /// Bytes as stated.
    bytes: usize,
}

impl BinaryForm {
    /// Of the line `58b 1 2 11 4096 ...`.
    ///
    /// # Errors
    /// Another form of numbers; a count that is not a number.
    pub(super) fn of(path: &str, line: &Line) -> Result<BinaryForm, Problems> {
        let mut words = line
            .text
            .trim()
            .trim_start_matches("58b")
            .split_ascii_whitespace();
        let mut word = || words.next().unwrap_or_default();
        let [order, format, lines, bytes] = [word(), word(), word(), word()];
        let problem = |message: String, hint: &str| {
            Problems::from(line.problem(path, 0..line.text.len(), message, hint))
        };
        if !matches!(order, "1" | "2") {
            let message = format!("`{order}` is not a byte order");
            return Err(problem(message, "1 is little endian, 2 big endian"));
        }
        if format != "2" {
            let message = format!("numbers of the format `{format}` are not supported, only IEEE 754 (2)");
            return Err(problem(message, HINT));
        }
        if lines != TEXT_LINES {
            let message = format!("`{lines}` lines of text before the data, not {TEXT_LINES}");
            return Err(problem(message, HINT));
        }
        let Ok(bytes) = bytes.parse() else {
            return Err(problem(format!("`{bytes}` is not a number of bytes"), HINT));
        };
        Ok(BinaryForm {
            is_big_endian: order == "2",
            bytes,
        })
    }

    /// The numbers of the data, and a note if their number of bytes is not the stated one.
    ///
    /// # Errors
    /// A file that ends before; a number that is not finite.
    pub(super) fn numbers(
        &self,
        lines: &mut Lines<impl BufRead>,
        shape: &Shape,
    ) -> Result<(Vec<f64>, Option<String>), Problems> {
        let width = if shape.is_double { 8 } else { 4 };
        let even: Vec<usize> = vec![width; shape.per_value()];
        let mut mixed = even.clone();
        if shape.is_uneven {
            mixed[0] = 4;
        }
        let total = |widths: &[usize]| shape.count * widths.iter().sum::<usize>();
        let widths = if total(&mixed) == self.bytes { mixed } else { even };
        let total = total(&widths);
        let note = (total != self.bytes).then(|| {
            format!(
                "a function states {} bytes of data and has {total}: the count of its values is used",
                self.bytes
            )
        });
        let bytes = lines.take_bytes(total)?;
        if bytes.len() < total {
            let message = format!("the file ends after {} of {total} bytes of data", bytes.len());
            let hint = "the file is not complete: export it again";
            return Err(Problem::of_file(lines.name(), message, hint).into());
        }
        let mut found = Vec::with_capacity(shape.count * shape.per_value());
        let mut rest = &bytes[..];
        for width in widths.iter().cycle().take(shape.count * shape.per_value()) {
            let (own, after) = rest.split_at(*width);
            rest = after;
            let value = self.number(own);
            if !value.is_finite() {
                let message = format!("number {} of the data is not finite", found.len() + 1);
                let hint = "is the byte order right? 1 is little endian, 2 big endian";
                return Err(Problem::of_file(lines.name(), message, hint).into());
            }
            found.push(value);
        }
        Ok((found, note))
    }

    /// A number of four or eight bytes.
    fn number(&self, bytes: &[u8]) -> f64 {
        let mut eight = [0; 8];
        let mut four = [0; 4];
        match bytes.len() {
            8 => {
                eight.copy_from_slice(bytes);
                if self.is_big_endian {
                    f64::from_be_bytes(eight)
                } else {
                    f64::from_le_bytes(eight)
                }
            }
            4 => {
                four.copy_from_slice(bytes);
                f64::from(if self.is_big_endian {
                    f32::from_be_bytes(four)
                } else {
                    f32::from_le_bytes(four)
                })
            }
            _ => f64::NAN,
        }
    }
}

#[cfg(test)]
mod tests;

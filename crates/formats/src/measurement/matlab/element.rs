//! Tagged elements: type, length, data.
//!
//! ```text
//! usual   type u32, length u32, data, filled up to 8 bytes (not after compressed data)
//! small   length in the upper half of the type, data of up to 4 bytes
//! ```

use super::bytes::{NumberType, Order};

/// Type of compressed data.
pub(super) const COMPRESSED: u32 = 15;
/// Type of an array.
pub(super) const MATRIX: u32 = 14;

/// One element.
#[derive(Clone, Copy, Debug)]
pub(super) struct Element<'a> {
    /// Code of its type.
    pub code: u32,
    /// Its data.
    pub data: &'a [u8],
    /// Its length with its tag and the bytes that fill it up.
    pub length: usize,
}

impl<'a> Element<'a> {
    /// The element at the beginning of `bytes`.
    ///
    /// # Errors
    /// It is cut off.
    pub(super) fn first(bytes: &'a [u8], order: Order) -> Result<Element<'a>, String> {
        let word = |at: usize| -> Result<u32, String> {
            let four = bytes
                .get(at..at + 4)
                .and_then(|four| <[u8; 4]>::try_from(four).ok());
            Ok(order.u32(four.ok_or("the tag of an element is cut off")?))
        };
        let tag = word(0)?;
        let (code, start, size) = match tag >> 16 {
            0 => (tag, 8_usize, word(4)? as usize),
            small => (tag & 0xffff, 4, small as usize),
        };
        if start == 4 && size > 4 {
            return Err(format!(
                "a small element of {size} bytes, and it can have at most 4"
            ));
        }
        let end = start.checked_add(size).ok_or("an element is too long")?;
        let data = bytes.get(start..end).ok_or_else(|| {
            format!(
                "an element of {size} bytes is cut off after {}",
                bytes.len().saturating_sub(start)
            )
        })?;
        let length = match (start, code) {
            (4, _) => 8,
            (_, COMPRESSED) => end,
            _ => end.next_multiple_of(8),
        };
        Ok(Element { code, data, length })
    }

    /// Its numbers.
    ///
    /// # Errors
    /// It contains none.
    pub(super) fn numbers(&self, order: Order) -> Result<Vec<f64>, String> {
        let kind = NumberType::of(self.code)
            .ok_or_else(|| format!("an element of type {} contains no numbers", self.code))?;
        Ok(self
            .data
            .chunks_exact(kind.length())
            .map(|bytes| kind.number(bytes, order))
            .collect())
    }

    /// Its text: bytes up to the first zero.
    pub(super) fn text(&self) -> String {
        text(self.data)
    }
}

/// Bytes up to the first zero, as text.
pub(super) fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end]).into_owned()
}

/// The elements of `bytes`, one after the other.
pub(super) struct Elements<'a> {
    rest: &'a [u8],
    order: Order,
}

impl<'a> Elements<'a> {
    pub(super) fn of(rest: &'a [u8], order: Order) -> Elements<'a> {
        Elements { rest, order }
    }

    /// The next one.
    ///
    /// # Errors
    /// It is cut off or missing.
    pub(super) fn next(&mut self) -> Result<Element<'a>, String> {
        let element = Element::first(self.rest, self.order)?;
        self.rest = self.rest.get(element.length..).unwrap_or_default();
        Ok(element)
    }
}

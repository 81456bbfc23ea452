//! Arrays and structures of level 5, and the numbers of those that are requested.

use std::io::Read as _;

use flate2::read::ZlibDecoder;

use super::array::{Collected, DEEPEST, MOST_BYTES, MatlabFile};
use super::bytes::Order;
use super::element::{COMPRESSED, Element, Elements, MATRIX, text};

/// Longest name, byte.
const LONGEST_NAME: usize = 256;
/// Class of a structure; classes of numeric arrays.
const STRUCTURE: u32 = 2;
const NUMERIC: std::ops::RangeInclusive<u32> = 6..=15;

/// Reads the arrays `wanted` of the elements after the header.
///
/// # Errors
/// What is wrong with the file, with the path of its variable.
pub(super) fn read(elements: &[u8], order: Order, wanted: &[&str]) -> Result<MatlabFile, String> {
    let mut walk = Walk {
        collected: Collected::new(wanted),
        order,
        expanded: 0,
    };
    let mut rest = elements;
    while !rest.is_empty() {
        let element = Element::first(rest, order)?;
        walk.top(&element)?;
        rest = rest.get(element.length..).unwrap_or_default();
    }
    Ok(walk.collected.into_file())
}

/// Name of a class that is not one of numbers.
fn other_class(class: u32) -> &'static str {
    match class {
        1 => "cell",
        STRUCTURE => "struct",
        4 => "char",
        5 => "sparse",
        _ => "object",
    }
}

struct Walk<'w> {
    collected: Collected<'w>,
    order: Order,
    /// Of the compressed variables so far, byte.
    expanded: u64,
}

impl Walk<'_> {
    /// Takes an element of the file: a variable, compressed or not.
    ///
    /// # Errors
    /// What is wrong with it.
    fn top(&mut self, element: &Element<'_>) -> Result<(), String> {
        match element.code {
            COMPRESSED => {
                let left = MOST_BYTES - self.expanded;
                let mut bytes = Vec::new();
                let read = ZlibDecoder::new(element.data)
                    .take(left + 1)
                    .read_to_end(&mut bytes);
                read.map_err(|error| format!("a compressed variable is damaged: {error}"))?;
                self.expanded += bytes.len() as u64;
                if self.expanded > MOST_BYTES {
                    return Err(format!(
                        "the variables need more than {MOST_BYTES} bytes when expanded"
                    ));
                }
                let inner = Element::first(&bytes, self.order)?;
                match inner.code {
                    MATRIX => self.matrix(inner.data, None, 0),
                    _ => Ok(()),
                }
            }
            MATRIX => self.matrix(element.data, None, 0),
            _ => Ok(()),
        }
    }

    /// Takes an array; `own` is its path, if it is a field.
    fn matrix(&mut self, data: &[u8], own: Option<&str>, depth: usize) -> Result<(), String> {
        if data.is_empty() {
            return Ok(());
        }
        let mut elements = Elements::of(data, self.order);
        let flags = elements.next()?;
        let class = flags
            .numbers(self.order)?
            .first()
            .map_or(0, |flags| *flags as u32 & 0xff);
        if !(1..=*NUMERIC.end()).contains(&class) {
            return Ok(());
        }
        let dimensions: Vec<usize> = elements
            .next()?
            .numbers(self.order)?
            .iter()
            .map(|size| *size as usize)
            .collect();
        let named = elements.next()?.text();
        let path = own.map_or(named, str::to_owned);
        let within = |error: String| format!("`{path}`: {error}");
        if NUMERIC.contains(&class) {
            return self.numeric(&path, dimensions, &mut elements).map_err(within);
        }
        self.collected.pass_over(&path, other_class(class));
        match class == STRUCTURE && dimensions.iter().all(|size| *size == 1) {
            true => self.structure(&path, &mut elements, depth),
            false => Ok(()),
        }
    }

    fn structure(&mut self, path: &str, elements: &mut Elements<'_>, depth: usize) -> Result<(), String> {
        if depth == DEEPEST {
            return Err(format!(
                "`{path}`: structures are nested more than {DEEPEST} deep"
            ));
        }
        let within = |error: String| format!("`{path}`: {error}");
        let length = elements
            .next()
            .and_then(|length| length.numbers(self.order))
            .map_err(within)?;
        let length = length.first().map_or(0, |length| *length as usize);
        if length == 0 || length > LONGEST_NAME {
            return Err(within(format!(
                "field names of {length} bytes (1 to {LONGEST_NAME} are possible)"
            )));
        }
        let names = elements.next().map_err(within)?;
        for name in names.data.chunks_exact(length).map(text) {
            let field = format!("{path}.{name}");
            let element = elements.next().map_err(|error| format!("`{field}`: {error}"))?;
            if element.code == MATRIX {
                self.matrix(element.data, Some(&field), depth + 1)?;
            }
        }
        Ok(())
    }

    fn numeric(
        &mut self,
        path: &str,
        dimensions: Vec<usize>,
        elements: &mut Elements<'_>,
    ) -> Result<(), String> {
        if !self.collected.lists(path)? {
            return Ok(());
        }
        let values = elements.next()?.numbers(self.order)?;
        self.collected.take(path, dimensions, values)
    }
}

//! Arrays and structures, and the numbers of those that are requested.

use std::io::Read as _;

use flate2::read::ZlibDecoder;

use super::bytes::Order;
use super::element::{COMPRESSED, Element, Elements, MATRIX, text};

/// Most bytes that the compressed variables of a file are expanded to.
const MOST_BYTES: u64 = 1 << 28;
/// Deepest structure.
const DEEPEST: usize = 16;
/// Most numeric arrays.
const MOST_ARRAYS: usize = 100_000;
/// Longest name, byte.
const LONGEST_NAME: usize = 256;
/// Class of a structure; classes of numeric arrays.
const STRUCTURE: u32 = 2;
const NUMERIC: std::ops::RangeInclusive<u32> = 6..=15;

/// The requested arrays, and the names of all of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MatlabFile {
    /// The requested arrays, in the order of the request; `None` where the file has no such numeric array.
    pub arrays: Vec<Option<MatlabArray>>,
    /// Path of each numeric array of the file, in the order of the file.
    pub names: Vec<String>,
}

/// A numeric array.
#[derive(Clone, Debug, PartialEq)]
pub struct MatlabArray {
    /// Size of each dimension.
    pub dimensions: Vec<usize>,
    /// Its values, column after column.
    // unit: that of the file
    pub values: Vec<f64>,
}

impl MatlabArray {
    /// The array as signals of `samples` values: its rows or its columns, whichever have that length. `None` if neither has.
    pub fn signals(&self, samples: usize) -> Option<Vec<Vec<f64>>> {
        let &[rows, columns] = &self.dimensions[..] else {
            return None;
        };
        if samples == 0 {
            return None;
        }
        if rows == samples {
            return Some(self.values.chunks_exact(rows).map(<[f64]>::to_vec).collect());
        }
        let row = |row: usize| self.values.iter().skip(row).step_by(rows).copied().collect();
        (columns == samples).then(|| (0..rows).map(row).collect())
    }
}

/// What was found so far.
pub(super) struct Collected<'w> {
    wanted: &'w [&'w str],
    order: Order,
    expanded: u64,
    file: MatlabFile,
}

impl<'w> Collected<'w> {
    pub(super) fn new(wanted: &'w [&'w str], order: Order) -> Collected<'w> {
        let file = MatlabFile {
            arrays: vec![None; wanted.len()],
            names: Vec::new(),
        };
        Collected {
            wanted,
            order,
            expanded: 0,
            file,
        }
    }

    pub(super) fn into_file(self) -> MatlabFile {
        self.file
    }

    /// Takes an element of the file: a variable, compressed or not.
    ///
    /// # Errors
    /// What is wrong with it.
    pub(super) fn top(&mut self, element: &Element<'_>) -> Result<(), String> {
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
        if class != STRUCTURE && !NUMERIC.contains(&class) {
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
        match class {
            STRUCTURE if dimensions.iter().all(|size| *size == 1) => {
                self.structure(&path, &mut elements, depth)
            }
            STRUCTURE => Ok(()),
            _ => self.numeric(&path, dimensions, &mut elements).map_err(within),
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
        if self.file.names.len() == MOST_ARRAYS {
            return Err(format!("more than {MOST_ARRAYS} arrays"));
        }
        self.file.names.push(path.to_owned());
        if !self.wanted.contains(&path) {
            return Ok(());
        }
        let values = elements.next()?.numbers(self.order)?;
        let size = dimensions
            .iter()
            .try_fold(1_usize, |size, next| size.checked_mul(*next));
        if size != Some(values.len()) {
            return Err(format!("{} values, but its size is {dimensions:?}", values.len()));
        }
        let array = MatlabArray { dimensions, values };
        for (place, wanted) in self.file.arrays.iter_mut().zip(self.wanted) {
            if *wanted == path {
                *place = Some(array.clone());
            }
        }
        Ok(())
    }
}

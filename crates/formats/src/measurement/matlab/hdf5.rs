//! Arrays of MATLAB files of version 7.3 (`save -v7.3`): HDF5 after a block of 512 bytes.
//!
//! A structure is a group. An array is a data set with its dimensions in reverse order, so that its values are in MATLAB's order, column after
//! column. The attribute `MATLAB_class` names the class. An empty array has the attribute `MATLAB_empty`, and its dimensions as data. A sparse
//! array is a group with the attribute `MATLAB_sparse`; elements of cells are in the group `#refs#`, and the cell refers to them. Complex
//! numbers are pairs, and are passed over as are cells, texts, sparse arrays, objects and arrays of structures. Other HDF5 files are read in the
//! same way: each numeric data set is an array.
//!
//! The crate `hdf5-pure` reads HDF5. Its memory and time are limited here: the size of an array and of its chunks before its data are read,
//! and what is read in total (`metered`). It returns an error for what is malformed: no panic is known, and none is caught here.

use hdf5_pure::{AttrValue, DType, Dataset, Error, File, Group};

use super::array::{Collected, DEEPEST, MOST_BYTES, MatlabFile};
use super::metered::Metered;

/// Most groups; a group counts once for each path to it.
const MOST_GROUPS: usize = 10_000;
/// Most chunks of an array.
const MOST_CHUNKS: u64 = 1 << 20;
/// Most bytes that are read for each byte of the file, and in addition to them.
const MOST_READ: [u64; 2] = [8, 1 << 24];
/// Groups that are not variables.
const INTERNAL: [&str; 2] = ["#refs#", "#subsystem#"];
/// Classes of numeric arrays.
const NUMERIC: [&str; 11] = [
    "double", "single", "logical", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64",
];

/// Reads the arrays `wanted` of the file `content`.
///
/// # Errors
/// What is wrong with the file, with the path of its variable.
pub(super) fn read(content: Vec<u8>, wanted: &[&str]) -> Result<MatlabFile, String> {
    let [each, more] = MOST_READ;
    let length = content.len() as u64;
    let most = length.saturating_mul(each).saturating_add(more);
    let file = File::from_source(Metered::new(content, most)).map_err(text)?;
    let mut walk = Walk {
        collected: Collected::new(wanted),
        length,
        groups: 0,
        memory: 0,
        expanded: 0,
    };
    walk.group(&file.root(), "", 0)?;
    Ok(walk.collected.into_file())
}

fn text(error: Error) -> String {
    format!("the HDF5 file cannot be read: {error}")
}

struct Walk<'w> {
    collected: Collected<'w>,
    /// Of the file, byte.
    length: u64,
    groups: usize,
    /// Memory for the requested arrays so far, and the length of their expanded chunks, byte.
    memory: u64,
    expanded: u64,
}

impl Walk<'_> {
    fn group(&mut self, group: &Group, path: &str, depth: usize) -> Result<(), String> {
        let within = |error: String| match path {
            "" => error,
            _ => format!("`{path}`: {error}"),
        };
        if depth > DEEPEST {
            return Err(within(format!("structures are nested more than {DEEPEST} deep")));
        }
        self.groups += 1;
        if self.groups > MOST_GROUPS {
            return Err(within(format!("more than {MOST_GROUPS} structures")));
        }
        let named = |name: &str| match path {
            "" => name.to_owned(),
            _ => format!("{path}.{name}"),
        };
        for (name, dataset) in group.iter_datasets().map_err(text).map_err(within)? {
            let path = named(&name);
            self.variable(&dataset, &path)
                .map_err(|error| format!("`{path}`: {error}"))?;
        }
        for (name, inner) in group.iter_groups().map_err(text).map_err(within)? {
            if INTERNAL.contains(&name.as_str()) {
                continue;
            }
            let path = named(&name);
            let attributes = inner
                .attrs()
                .map_err(|error| format!("`{path}`: {}", text(error)))?;
            if attributes.contains_key("MATLAB_sparse") {
                self.collected.pass_over(&path, "sparse");
                continue;
            }
            self.collected.pass_over(&path, "struct");
            self.group(&inner, &path, depth + 1)?;
        }
        Ok(())
    }

    /// Takes a data set: an array or another variable.
    fn variable(&mut self, dataset: &Dataset, path: &str) -> Result<(), String> {
        let attributes = dataset.attrs().map_err(text)?;
        let class = attributes.get("MATLAB_class").and_then(AttrValue::as_str);
        let stored = dataset.dtype().map_err(text)?;
        let other = match class {
            Some(class) if !NUMERIC.contains(&class) => Some(class.to_owned()),
            Some(class) if !is_number(&stored) => Some(format!("complex {class}")),
            None if !is_number(&stored) => Some(stored.to_string()),
            _ => None,
        };
        if let Some(class) = other {
            self.collected.pass_over(path, &class);
            return Ok(());
        }
        if !self.collected.lists(path)? {
            return Ok(());
        }
        let mut dimensions = Vec::new();
        for size in dataset.shape().map_err(text)?.into_iter().rev() {
            dimensions.push(usize::try_from(size).map_err(|error| error.to_string())?);
        }
        dimensions.resize(dimensions.len().max(2), 1);
        self.check_size(dataset, &dimensions)?;
        let values = dataset.read_f64().map_err(text)?;
        let is_empty = attributes.get("MATLAB_empty").and_then(AttrValue::as_i64);
        if is_empty.is_none_or(|is_empty| is_empty == 0) {
            return self.collected.take(path, dimensions, values);
        }
        // The data are the dimensions.
        let dimensions = values.iter().map(|size| *size as usize).collect();
        self.collected.take(path, dimensions, Vec::new())
    }

    /// Counts what an array needs.
    ///
    /// # Errors
    /// It is beyond the limits.
    fn check_size(&mut self, dataset: &Dataset, dimensions: &[usize]) -> Result<(), String> {
        let element = dataset.element_size().map_err(text)?.max(size_of::<f64>() as u64);
        let sizes: Vec<u64> = dimensions.iter().map(|size| *size as u64).collect();
        count(&mut self.memory, product(&sizes, element))?;
        let Some(mut chunk) = dataset.chunk_shape().map_err(text)? else {
            return Ok(());
        };
        chunk.reverse();
        let counts: Vec<u64> = sizes
            .iter()
            .zip(&chunk)
            .map(|(size, chunk)| size.div_ceil((*chunk).max(1)))
            .collect();
        if product(&counts, 1).is_none_or(|count| count > MOST_CHUNKS) {
            return Err(format!("more than {MOST_CHUNKS} chunks"));
        }
        let bytes = product(&chunk, element);
        count(&mut self.memory, bytes)?;
        // The index may name more chunks than the array has, larger ones than the file has, and the same one many times.
        for stored in dataset.chunks().map_err(text)? {
            if stored.address.saturating_add(stored.storage_size) > self.length {
                return Err(format!("a chunk of {} bytes is cut off", stored.storage_size));
            }
            count(&mut self.expanded, bytes)?;
        }
        Ok(())
    }
}

/// Counts bytes for the requested arrays; `None` is more than can be counted.
///
/// # Errors
/// There are too many of them.
fn count(counted: &mut u64, bytes: Option<u64>) -> Result<(), String> {
    *counted = bytes
        .and_then(|bytes| counted.checked_add(bytes))
        .filter(|bytes| *bytes <= MOST_BYTES)
        .ok_or_else(|| format!("the requested arrays need more than {MOST_BYTES} bytes"))?;
    Ok(())
}

/// Product of sizes and of a first factor; `None` if it is too large for the type.
fn product(sizes: &[u64], first: u64) -> Option<u64> {
    sizes
        .iter()
        .try_fold(first, |product, size| product.checked_mul(*size))
}

fn is_number(stored: &DType) -> bool {
    matches!(
        stored,
        DType::F32
            | DType::F64
            | DType::I8
            | DType::I16
            | DType::I32
            | DType::I64
            | DType::U8
            | DType::U16
            | DType::U32
            | DType::U64
    )
}

#[cfg(test)]
mod tests;

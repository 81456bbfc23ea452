//! MATLAB files of level 5 (`save -v6`, `-v7`): numeric arrays, in structures too.
//!
//! A name is a path: `rec.time` is the field `time` of the structure `rec`. Structures of one element are entered; cells, objects,
//! texts, sparse arrays and arrays of structures are passed over. Real parts are read; whole numbers become floating-point numbers.
//! Compressed variables (`-v7`) are expanded up to a limit. Files of level 4 and of version 7.3 (HDF5) are refused with the way to save them.
//!
//! Format: MathWorks, "MAT-File Format", R2023b, chapter 1 (MAT-file level 5).
//!
//! `bytes`: numbers in either byte order. `element`: tagged elements. `array`: arrays and structures.

use crate::document::{Problem, Problems};

mod array;
mod bytes;
mod element;

pub use array::{MatlabArray, MatlabFile};

use array::Collected;
use bytes::Order;
use element::Element;

/// Length of the header, byte.
const HEADER: usize = 128;
/// Version of level 5.
const LEVEL_5: u16 = 0x0100;
/// Version of files that are HDF5.
const LEVEL_7_3: u16 = 0x0200;
/// How to save a file that can be read.
const HINT: &str = "save it in MATLAB with `save('file.mat', ..., '-v7')`, or export a table with one column for each signal (CSV)";

/// Reads the arrays `wanted` of the file `content`. `path` is the file name shown in problems.
///
/// # Errors
/// A file that is not level 5; an element that is cut off, too large or nested too deep, with the path of its variable.
pub fn read(path: &str, content: &[u8], wanted: &[&str]) -> Result<MatlabFile, Problems> {
    let refuse = |message: String| Problems::from(vec![Problem::of_file(path, message, HINT)]);
    let order = order(content).map_err(refuse)?;
    let mut collected = Collected::new(wanted, order);
    let mut rest = content.get(HEADER..).unwrap_or_default();
    while !rest.is_empty() {
        let element = Element::first(rest, order).map_err(refuse)?;
        collected.top(&element).map_err(refuse)?;
        rest = rest.get(element.length..).unwrap_or_default();
    }
    Ok(collected.into_file())
}

/// Whether the content is that of a MATLAB file, by its first bytes.
pub fn is_matlab(content: &[u8]) -> bool {
    content.starts_with(b"MATLAB ") || content.starts_with(b"\x89HDF\r\n")
}

/// Byte order of a file of level 5; otherwise why it is none.
fn order(content: &[u8]) -> Result<Order, String> {
    if content.starts_with(b"\x89HDF\r\n") {
        return Err("a file of MATLAB 7.3 (HDF5) is not supported".to_owned());
    }
    let Some(header) = content.get(..HEADER) else {
        return Err(format!(
            "a MATLAB file needs a header of {HEADER} bytes, and this has {}",
            content.len()
        ));
    };
    let order = match &header[126..128] {
        b"IM" => Order::Little,
        b"MI" => Order::Big,
        _ => return Err("not a MATLAB file of level 5: the header has no mark of its byte order".to_owned()),
    };
    match order.u16([header[124], header[125]]) {
        LEVEL_5 => Ok(order),
        LEVEL_7_3 => Err("a file of MATLAB 7.3 (HDF5) is not supported".to_owned()),
        other => Err(format!(
            "version {other:#06x} of the MATLAB file is not supported"
        )),
    }
}

#[cfg(test)]
mod tests;

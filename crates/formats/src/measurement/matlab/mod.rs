//! MATLAB files of level 5 (`save -v6`, `-v7`) and of version 7.3 (`-v7.3`): numeric arrays, in structures too.
//!
//! A name is a path: `rec.time` is the field `time` of the structure `rec`. Structures of one element are entered; cells, objects,
//! texts, sparse arrays and arrays of structures are passed over. Real parts are read, of level 5 alone: complex arrays of version 7.3 are passed over.
//! Whole numbers become floating-point numbers. Compressed variables are expanded up to a limit. Files of level 4 are refused with the way to save them.
//!
//! Format: MathWorks, "MAT-File Format", R2023b, chapter 1 (MAT-file level 5); version 7.3: "HDF5 File Format Specification", version 3.0.
//!
//! `bytes`: numbers in either byte order. `element`: tagged elements. `array`: arrays, and those that are requested. `level_5`: variables of
//! level 5. `metered`: a limit on what is read. `hdf5`: variables of version 7.3.

use crate::document::{Problem, Problems};

mod array;
mod bytes;
mod element;
mod hdf5;
mod level_5;
mod metered;

pub use array::{MatlabArray, MatlabFile, Requested};

use bytes::Order;

/// Length of the header, byte.
const HEADER: usize = 128;
/// Version of level 5.
const LEVEL_5: u16 = 0x0100;
/// Version of files that are HDF5.
const LEVEL_7_3: u16 = 0x0200;
/// Beginning of an HDF5 file without a header of MATLAB.
const HDF5: &[u8] = b"\x89HDF\r\n";
/// How to save a file that can be read.
const HINT: &str = "save the arrays that are needed in MATLAB with `save('file.mat', ..., '-v7')`, or export a table with one column for each signal (CSV)";

/// Reads the arrays `wanted` of the file `content`. `path` is the file name shown in problems.
///
/// # Errors
/// A file of another version; a part that is cut off, damaged, too large or nested too deep, with the path of its variable.
pub fn read(path: &str, content: Vec<u8>, wanted: &[&str]) -> Result<MatlabFile, Problems> {
    let found = match version(&content) {
        Err(message) => Err(message),
        Ok(Version::Level5(order)) => level_5::read(content.get(HEADER..).unwrap_or_default(), order, wanted),
        Ok(Version::Hdf5) => hdf5::read(content, wanted),
    };
    found.map_err(|message| Problems::from(vec![Problem::of_file(path, message, HINT)]))
}

/// Whether the content is that of a MATLAB file, by its first bytes.
pub fn is_matlab(content: &[u8]) -> bool {
    content.starts_with(b"MATLAB ") || content.starts_with(HDF5)
}

enum Version {
    Level5(Order),
    Hdf5,
}

/// Version of a file; otherwise why it is none that can be read.
fn version(content: &[u8]) -> Result<Version, String> {
    if content.starts_with(HDF5) {
        return Ok(Version::Hdf5);
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
        _ => {
            return Err(
                "not a MATLAB file of level 5 or 7.3: the header has no mark of its byte order".to_owned(),
            );
        }
    };
    match order.u16([header[124], header[125]]) {
        LEVEL_5 => Ok(Version::Level5(order)),
        LEVEL_7_3 => Ok(Version::Hdf5),
        other => Err(format!(
            "version {other:#06x} of the MATLAB file is not supported"
        )),
    }
}

#[cfg(test)]
mod tests;

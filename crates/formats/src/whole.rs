//! Files that are read as a whole: studies, robots, programs of robots, tables that somebody typed.
//!
//! They have some kB, the largest some MB. A file of another kind under such a name may have any size, and must not take
//! all memory before it is refused.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Larger than this is no file that is read as a whole, in bytes.
pub const MOST_BYTES: u64 = 64 << 20;

/// The bytes of the file at `path`.
///
/// # Errors
/// A file that cannot be read; [`io::ErrorKind::FileTooLarge`] where it has more than [`MOST_BYTES`].
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    bytes_of(File::open(path)?)
}

/// All that `reader` gives.
///
/// # Errors
/// As of [`read`].
pub fn bytes_of(reader: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    reader.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST_BYTES {
        let message = format!("it has more than {} MiB; is it the right file?", MOST_BYTES >> 20);
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, message));
    }
    Ok(bytes)
}

/// The text of the file at `path`.
///
/// # Errors
/// As of [`read`], and bytes that are not UTF-8.
pub fn read_text(path: &Path) -> io::Result<String> {
    String::from_utf8(read(path)?).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_as_large_as_may_be_is_read_and_a_larger_one_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("some");
        let file = File::create(&path).unwrap();
        // Holes take no room on the disk.
        file.set_len(MOST_BYTES).unwrap();
        assert_eq!(read(&path).unwrap().len() as u64, MOST_BYTES);
        file.set_len(MOST_BYTES + 1).unwrap();
        let refused = read(&path).unwrap_err();
        assert_eq!(refused.kind(), io::ErrorKind::FileTooLarge);
        assert!(refused.to_string().contains("more than 64 MiB"), "{refused}");
    }

    #[test]
    fn bytes_that_are_no_text_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("some");
        std::fs::write(&path, b"caf\xe9").unwrap();
        assert_eq!(read(&path).unwrap(), b"caf\xe9");
        assert_eq!(read_text(&path).unwrap_err().kind(), io::ErrorKind::InvalidData);
    }
}

//! A file of a program: its bytes and its characters.
//!
//! UTF-8 with or without byte order mark. A file that is not UTF-8 is read as Latin-1, one character per byte: comments
//! in other encodings look wrong but are written back unchanged.

use armill_formats::document::Source;

/// A file of a program. Its bytes are written back unchanged, except for rewritten parts.
#[derive(Clone, Debug)]
pub struct ProgramText {
    source: Source,
    encoding: Encoding,
}

/// Encoding of the characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Encoding {
    Utf8,
    Utf8WithMark,
    Latin1,
}

/// The byte order mark of UTF-8.
const MARK: &[u8] = b"\xEF\xBB\xBF";

impl ProgramText {
    /// The file `name` with these bytes.
    pub fn new(name: &str, bytes: &[u8]) -> ProgramText {
        let (encoding, rest) = match bytes.strip_prefix(MARK) {
            Some(rest) => (Encoding::Utf8WithMark, rest),
            None => (Encoding::Utf8, bytes),
        };
        match std::str::from_utf8(rest) {
            Ok(text) => ProgramText {
                source: Source::new(name, text),
                encoding,
            },
            Err(_) => {
                let text: String = bytes.iter().map(|byte| char::from(*byte)).collect();
                ProgramText {
                    source: Source::new(name, &text),
                    encoding: Encoding::Latin1,
                }
            }
        }
    }

    /// Its name as given.
    pub fn name(&self) -> &str {
        self.source.name()
    }

    /// Its name without folder and ending.
    pub(super) fn stem(&self) -> &str {
        let file = self.name().rsplit(['/', '\\']).next().unwrap_or_default();
        file.rsplit_once('.').map_or(file, |(stem, _)| stem)
    }

    /// The ending of its name, in lower case.
    pub(super) fn ending(&self) -> Option<String> {
        let (_, ending) = self.name().rsplit_once('.')?;
        Some(ending.to_lowercase())
    }

    /// Its characters, without byte order mark.
    pub fn text(&self) -> &str {
        self.source.text()
    }

    /// Its characters with their positions, for problems.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// These characters as the bytes of this file.
    pub fn encoded(&self, text: &str) -> Vec<u8> {
        match self.encoding {
            Encoding::Utf8 => text.as_bytes().to_vec(),
            Encoding::Utf8WithMark => [MARK, text.as_bytes()].concat(),
            // A character that was read as one byte is below 256; everything added is ASCII.
            Encoding::Latin1 => latin1(text),
        }
    }
}

/// These characters as ISO 8859-1; `?` for other characters.
pub(super) fn latin1(text: &str) -> Vec<u8> {
    text.chars()
        .map(|c| u8::try_from(u32::from(c)).unwrap_or(b'?'))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_written_back_unchanged() {
        let shift_jis = b"'\x83\x65\x83\x58\x83\x67\r\nMOVL C00001\r\n";
        for bytes in [
            &b"LIN {X 1}\r\n"[..],
            b"\xEF\xBB\xBF<a/>\n",
            "; \u{fc}\n".as_bytes(),
            shift_jis,
            b"\xEF\xBB\xBF\xFF",
        ] {
            let text = ProgramText::new("a", bytes);
            assert_eq!(text.encoded(text.text()), bytes);
        }
    }
}

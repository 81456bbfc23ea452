//! Files of a robot program, places in them, and the error that names such a place.

use std::fmt;
use std::rc::Rc;

/// One file of a program.
#[derive(Debug)]
pub struct SourceFile {
    /// Name with its extension, without folders.
    pub name: Rc<str>,
    /// Text without the byte order mark, with any line ends.
    pub text: String,
}

impl SourceFile {
    pub fn new(name: &str, text: &str) -> SourceFile {
        SourceFile {
            name: name.rsplit(['/', '\\']).next().unwrap_or(name).into(),
            text: text.trim_start_matches('\u{feff}').to_owned(),
        }
    }

    /// Name without its extension.
    pub fn stem(&self) -> &str {
        self.name.rsplit_once('.').map_or(&*self.name, |(stem, _)| stem)
    }

    /// Extension in small letters, without the dot.
    pub fn extension(&self) -> String {
        self.name
            .rsplit_once('.')
            .map_or(String::new(), |(_, extension)| extension.to_ascii_lowercase())
    }

    /// Lines with their places.
    pub fn lines(&self) -> impl Iterator<Item = (Place, &str)> {
        self.text
            .lines()
            .enumerate()
            .map(|(index, line)| (self.place(index + 1), line))
    }

    /// A line of this file, counted from 1.
    pub fn place(&self, line: usize) -> Place {
        Place {
            file: Rc::clone(&self.name),
            line,
        }
    }
}

/// A line of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    pub file: Rc<str>,
    /// Counted from 1; 0 for the file as a whole.
    pub line: usize,
}

impl Place {
    /// Where there is no file.
    pub fn nowhere() -> Place {
        Place {
            file: "".into(),
            line: 0,
        }
    }

    pub fn error(&self, message: impl Into<String>) -> ReplayError {
        ReplayError {
            place: self.clone(),
            message: message.into(),
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}:{}", self.file, self.line)
    }
}

/// A statement that the interpreter does not know or that its controller refuses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReplayError {
    pub place: Place,
    pub message: String,
}

impl fmt::Display for ReplayError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}: {}", self.place, self.message)
    }
}

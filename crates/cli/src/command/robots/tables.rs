//! Tables of a robot file that a subcommand makes: written to a new file, or printed, to be appended to the robot file.

use std::path::PathBuf;

use armill_study::StudyError;
use serde::Serialize;

use crate::arguments::WritingOptions;
use crate::terminal::{print, say};

/// Where tables go.
pub(super) struct TablesOutput<'a> {
    /// The subcommand, for the file.
    pub command: &'static str,
    /// The file; stdout without one.
    pub file: Option<&'a PathBuf>,
    pub writing: &'a WritingOptions,
    /// Whether stdout has the answer as JSON.
    pub json: bool,
}

impl TablesOutput<'_> {
    /// Writes these tables. `answer` is that of a file, or without one of the printed text; `summary` goes to stderr.
    ///
    /// # Errors
    /// A file that must not be replaced or cannot be written.
    pub(super) fn write<A: Serialize>(
        &self,
        text: &str,
        answer: impl FnOnce(Option<String>) -> A,
        summary: &str,
    ) -> Result<(), StudyError> {
        let shown = self.file.map(|path| path.display().to_string());
        if let Some(path) = self.file {
            let writer = self.writing.writer(self.command).for_new_files();
            writer.write(path, text.as_bytes())?;
        }
        if self.json {
            print(&serde_json::to_string(&answer(shown.clone()))?)?;
        } else if shown.is_none() {
            print(text.trim_end())?;
        }
        say(summary);
        if let Some(file) = shown {
            say(&format!("created {file}: append it to the robot file"));
        }
        Ok(())
    }
}

//! What the command says: data on stdout, talk on stderr.

use std::io::{ErrorKind, IsTerminal, Write};

use armill_formats::file::FileError;
use armill_study::StudyError;

/// Prints `text` and a line end on stdout. A reader that went away (`| head`) is no error.
///
/// # Errors
/// Stdout leads to a file that takes no more.
pub(crate) fn print(text: &str) -> Result<(), StudyError> {
    let mut out = std::io::stdout().lock();
    let written = out
        .write_all(text.as_bytes())
        .and_then(|()| out.write_all(b"\n"))
        .and_then(|()| out.flush());
    match written {
        Err(source) if source.kind() != ErrorKind::BrokenPipe => Err(FileError::Other {
            path: "standard output".into(),
            source,
        }
        .into()),
        _ => Ok(()),
    }
}

/// Says `text` on stderr.
pub(crate) fn say(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// Whether colours are wanted on stderr.
fn coloured() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

/// Says what went wrong; as JSON on stdout too where `json` is asked for.
pub(crate) fn show_error(error: &StudyError, json: bool) {
    if json {
        let problems = match error {
            StudyError::Problems(problems) => problems.to_json(),
            StudyError::Value { message, hint } => serde_json::json!([{ "message": message, "hint": hint }]),
            other => serde_json::json!([{ "message": other.to_string() }]),
        };
        // What went wrong is said on stderr in any case.
        let _ = print(&serde_json::json!({ "problems": problems }).to_string());
    }
    match error {
        StudyError::Problems(problems) if coloured() => say(&problems.in_colour()),
        StudyError::Problems(problems) => say(&problems.to_string()),
        other => say(&format!("error: {other}")),
    }
}

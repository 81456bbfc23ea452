//! What the command says: data on stdout, talk on stderr.

use std::io::{IsTerminal, Write};

use armill_study::StudyError;

/// Prints `text` and a line end on stdout. A reader that went away (`| head`) is no error.
pub(crate) fn print(text: &str) {
    let mut out = std::io::stdout().lock();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.write_all(b"\n"));
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
            other => serde_json::json!([{ "message": other.to_string() }]),
        };
        print(&serde_json::json!({ "problems": problems }).to_string());
    }
    match error {
        StudyError::Problems(problems) if coloured() => say(&problems.in_colour()),
        StudyError::Problems(problems) => say(&problems.to_string()),
        other => say(&format!("error: {other}")),
    }
}

//! Output of the command: data on stdout, messages on stderr; both to the calling program if there is one.
//!
//! | what | where | ends in |
//! |---|---|---|
//! | a result, as text or JSON | stdout | one line end |
//! | warnings, files written, next steps | stderr | one line end |
//! | errors | stderr, in colour on a terminal unless `NO_COLOR` is set; with `--json` on stdout too | - |
//!
//! Control characters in the input are shown as escapes ([`visible`]), in JSON too.
//!
//! JSON of errors is `{"problems": [...]}`: problems of a file with their positions, otherwise one with a `message`
//! and, if available, a `hint`.

use std::io::{ErrorKind, IsTerminal, Write};

use armill_formats::file::FileError;
use armill_formats::visible::visible;
use armill_study::StudyError;

use crate::listener;

/// Prints `text` and a line end on stdout. A reader that closed the pipe (`| head`) is not an error.
///
/// # Errors
/// Stdout leads to a file that cannot be written.
pub(crate) fn print(text: &str) -> Result<(), StudyError> {
    let text = &*visible(text);
    if let Some(listener) = listener::current() {
        listener.hear_data(text);
        return Ok(());
    }
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

/// Prints `text` on stderr, with a line end. Failure to print does not stop the work.
pub(crate) fn say(text: &str) {
    say_as_it_is(&visible(text));
}

/// Prints `text`, which may contain colours but no other control characters.
fn say_as_it_is(text: &str) {
    match listener::current() {
        Some(listener) => listener.hear_talk(text),
        None => {
            let _ = writeln!(std::io::stderr().lock(), "{text}");
        }
    }
}

/// Whether stderr is coloured.
fn coloured() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

/// Prints an error on stderr; as JSON on stdout too if `json` is set.
pub(crate) fn show_error(error: &StudyError, json: bool) {
    if json {
        // The error is printed on stderr in any case.
        let _ = print(&serde_json::json!({ "problems": problems_of(error) }).to_string());
    }
    match error {
        StudyError::Problems(problems) if coloured() => say_as_it_is(&problems.in_colour()),
        StudyError::Problems(problems) => say(&problems.to_string()),
        other => say(&format!("error: {other}")),
    }
}

/// The problems of an error as a JSON list, as with `--json`.
pub fn problems_json(error: &StudyError) -> String {
    problems_of(error).to_string()
}

fn problems_of(error: &StudyError) -> serde_json::Value {
    match error {
        StudyError::Problems(problems) => problems.to_json(),
        StudyError::Value { message, hint } => serde_json::json!([{ "message": message, "hint": hint }]),
        other => serde_json::json!([{ "message": other.to_string() }]),
    }
}

/// Alignment of the cells of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Align {
    /// Text.
    Left,
    /// Numbers.
    Right,
}

/// One line per row in aligned columns, two blanks between, no trailing blanks. A row of one cell
/// is a line of text: it widens no column. Cells beyond the given alignments are right-aligned. Widths are numbers of
/// characters, not of screen columns.
pub(crate) fn columns(rows: &[Vec<String>], aligned: &[Align]) -> Vec<String> {
    let wide = |cell: &String| cell.chars().count();
    let mut widths: Vec<usize> = Vec::new();
    for row in rows.iter().filter(|row| row.len() > 1) {
        widths.resize(widths.len().max(row.len()), 0);
        for (width, cell) in widths.iter_mut().zip(row) {
            *width = wide(cell).max(*width);
        }
    }
    let line = |row: &Vec<String>| {
        let cells = row.iter().enumerate().map(|(k, cell)| {
            let width = widths.get(k).copied().unwrap_or(0);
            match aligned.get(k) {
                Some(Align::Left) => format!("{cell:width$}"),
                _ => format!("{cell:>width$}"),
            }
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::listener::{Listener, current, heard_by};

    #[test]
    fn columns_are_aligned_for_non_ascii_letters() {
        let row = |cells: &[&str]| cells.iter().map(|cell| (*cell).to_owned()).collect();
        let rows = [
            row(&["größe", "1.5", "x"]),
            row(&["a", "12", ""]),
            row(&["a line of words"]),
        ];
        let lines = columns(&rows, &[Align::Left, Align::Right, Align::Left]);
        assert_eq!(lines, ["größe  1.5  x", "a       12", "a line of words"]);
    }

    #[test]
    fn a_listener_receives_only_the_output_of_its_thread() {
        let (outer, inner) = (Arc::new(Listener::default()), Arc::new(Listener::default()));
        heard_by(Some(Arc::clone(&outer)), || {
            print("1").unwrap();
            heard_by(Some(Arc::clone(&inner)), || print("2").unwrap());
            say("3");
            std::thread::scope(|scope| {
                scope.spawn(|| assert!(current().is_none()));
            });
        });
        assert!(current().is_none());
        assert_eq!(outer.heard(), ("1\n".to_owned(), vec!["3".to_owned()]));
        assert_eq!(inner.heard(), ("2\n".to_owned(), Vec::new()));
    }
}

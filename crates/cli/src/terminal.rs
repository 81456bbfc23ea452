//! What the command says: data on stdout, talk on stderr; both to whoever asked where that is a program.
//!
//! | what | where | ends in |
//! |---|---|---|
//! | an answer, in words or JSON | stdout | one line end |
//! | warnings, what was written, what to do next | stderr | one line end |
//! | problems | stderr, in colour on a terminal unless `NO_COLOR` is set; with `--json` on stdout too | - |
//!
//! Characters of the input that would control a terminal are shown as escapes ([`visible`]), in JSON too.
//!
//! JSON of problems is `{"problems": [...]}`: those of a file with their places, else one with a `message` and,
//! where there is one, a `hint`.

use std::io::{ErrorKind, IsTerminal, Write};

use armill_formats::file::FileError;
use armill_formats::visible::visible;
use armill_study::StudyError;

use crate::listener;

/// Prints `text` and a line end on stdout. A reader that went away (`| head`) is no error.
///
/// # Errors
/// Stdout leads to a file that takes no more.
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

/// Says `text` on stderr, with a line end. That nobody can hear it stops no work.
pub(crate) fn say(text: &str) {
    say_as_it_is(&visible(text));
}

/// Says `text`, which may have colours and nothing else that controls a terminal.
fn say_as_it_is(text: &str) {
    match listener::current() {
        Some(listener) => listener.hear_talk(text),
        None => {
            let _ = writeln!(std::io::stderr().lock(), "{text}");
        }
    }
}

/// Whether colours are wanted on stderr.
fn coloured() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

/// Says what went wrong on stderr; as JSON on stdout too where `json` is asked for.
pub(crate) fn show_error(error: &StudyError, json: bool) {
    if json {
        // What went wrong is said on stderr in any case.
        let _ = print(&serde_json::json!({ "problems": problems_of(error) }).to_string());
    }
    match error {
        StudyError::Problems(problems) if coloured() => say_as_it_is(&problems.in_colour()),
        StudyError::Problems(problems) => say(&problems.to_string()),
        other => say(&format!("error: {other}")),
    }
}

/// The problems of an error as a JSON list, as `--json` tells them.
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

/// On which side the cells of a column stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Align {
    /// Words.
    Left,
    /// Numbers.
    Right,
}

/// A line for each row, its cells below each other, two blanks between, no blanks at the end. A row of one cell
/// is a line of words: it widens no column. Cells beyond the alignments stand to the right. Widths count
/// characters, not columns of the screen.
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
    use super::*;

    #[test]
    fn columns_stand_below_each_other_whatever_their_letters() {
        let row = |cells: &[&str]| cells.iter().map(|cell| (*cell).to_owned()).collect();
        let rows = [
            row(&["größe", "1.5", "x"]),
            row(&["a", "12", ""]),
            row(&["a line of words"]),
        ];
        let lines = columns(&rows, &[Align::Left, Align::Right, Align::Left]);
        assert_eq!(lines, ["größe  1.5  x", "a       12", "a line of words"]);
    }
}

//! What every study file must lead to: an answer of finite numbers, or problems with their places, always the same.

use armill_core::watch::Watch;
use armill_formats::document::edit::{Change, changed};
use armill_formats::document::{Document, Problem};
use armill_study::answer::answer;
use armill_study::file::resolve::{Study, read};
use armill_study::output;
use armill_study::run::{point_count, run};
use armill_study::{ErrorKind, StudyError};
use serde_json::Value;

use super::generator::Generated;

/// What messages call the study.
const SHOWN: &str = "study.toml";
/// Studies of more points are read and checked, not evaluated.
const MOST_POINTS: usize = 400;

/// How far a study came.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// It is not TOML, or not text.
    NotToml,
    /// It has problems.
    Refused,
    /// It is valid.
    Accepted,
    /// It is valid, and its answer was checked.
    Evaluated,
}

/// Reads it twice; with `evaluate` it is also edited, and evaluated if it is small.
///
/// # Errors
/// What is wrong with armill; a panic is not caught.
pub fn check(study: &Generated, evaluate: bool) -> Result<Outcome, String> {
    let once = read(SHOWN, &study.folder, &study.bytes);
    let again = read(SHOWN, &study.folder, &study.bytes);
    match (once, again) {
        (Err(once), Err(again)) => {
            if once.to_string() != again.to_string() {
                return Err(format!("not the same problems twice:\n{once}\n{again}"));
            }
            refused(&study.bytes, &once)
        }
        (Ok(_), Ok(_)) if !evaluate => Ok(Outcome::Accepted),
        (Ok(once), Ok(_)) => {
            edited(study)?;
            if point_count(&once) > MOST_POINTS {
                return Ok(Outcome::Accepted);
            }
            evaluated(&once)
        }
        (once, _) => Err(format!(
            "refused once and read once: {:?}",
            once.err().map(|error| error.to_string())
        )),
    }
}

/// The refusal of a study as text; empty if it is not refused.
pub fn refusal(study: &Generated) -> String {
    read(SHOWN, &study.folder, &study.bytes)
        .err()
        .map_or_else(String::new, |error| error.to_string())
}

/// A refusal can be mended by the user, and says where and what.
fn refused(bytes: &[u8], error: &StudyError) -> Result<Outcome, String> {
    if error.kind() != ErrorKind::InvalidInput || error.to_string().trim().is_empty() {
        return Err(format!("a refusal that the user cannot act on: {error:?}"));
    }
    let text = String::from_utf8_lossy(bytes);
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    if let StudyError::Problems(problems) = error {
        if problems.as_slice().is_empty() {
            return Err("a refusal without problems".to_owned());
        }
        for problem in problems.as_slice() {
            let wrong = |reason: &str| format!("{reason}: {problem:?}");
            if problem.message().trim().is_empty()
                || problem.hint().is_some_and(|hint| hint.trim().is_empty())
            {
                return Err(wrong("no message"));
            }
            if problem.line() == 0 || problem.column() == 0 || problem.file().is_empty() {
                return Err(wrong("no place"));
            }
            if problem.file() == SHOWN && !is_inside(text, problem) {
                return Err(wrong("a place that is not in the file"));
            }
        }
    }
    match Document::from_bytes(SHOWN, bytes) {
        Ok(_) => Ok(Outcome::Refused),
        Err(_) => Ok(Outcome::NotToml),
    }
}

/// Whether line, column and span are in the text, and name the same place.
fn is_inside(text: &str, problem: &Problem) -> bool {
    let Some(line) = text.split('\n').nth(problem.line() - 1) else {
        return false;
    };
    let before: usize = text
        .split_inclusive('\n')
        .take(problem.line() - 1)
        .map(str::len)
        .sum();
    let column = line
        .char_indices()
        .nth(problem.column() - 1)
        .map_or(line.len(), |(at, _)| at);
    problem.column() <= line.chars().count() + 1
        && text.get(problem.span()).is_some()
        && (problem.span().start == before + column || problem.span() == (0..0))
}

/// Written again with every value at its key, it is the same study.
fn edited(study: &Generated) -> Result<(), String> {
    let text = std::str::from_utf8(&study.bytes).map_err(|error| error.to_string())?;
    let document = Document::parse(SHOWN, text).map_err(|problems| problems.to_string())?;
    let values = document.to_json();
    let mut changes = Vec::new();
    leaves("", &values, &mut changes);
    let new = changed(SHOWN, text, &changes).map_err(|problems| format!("cannot be edited: {problems}"))?;
    let read_again = Document::parse(SHOWN, &new).map_err(|problems| problems.to_string())?;
    if read_again.to_json() != values {
        return Err(format!("edited, it differs:\n{new}"));
    }
    read(SHOWN, &study.folder, new.as_bytes()).map_err(|error| format!("edited, it is refused: {error}"))?;
    Ok(())
}

/// Every value that is neither a table nor a list of tables, at its path.
fn leaves(path: &str, value: &Value, found: &mut Vec<Change>) {
    match value {
        Value::Object(fields) => {
            for (key, value) in fields {
                let joined = if path.is_empty() {
                    key.clone()
                } else {
                    format!("{path}.{key}")
                };
                leaves(&joined, value, found);
            }
        }
        Value::Array(entries) if entries.iter().any(Value::is_object) => {
            for (index, entry) in entries.iter().enumerate() {
                leaves(&format!("{path}[{index}]"), entry, found);
            }
        }
        value => found.push(Change {
            path: path.to_owned(),
            value: value.clone(),
        }),
    }
}

/// The answer has finite numbers alone, and can be written.
fn evaluated(study: &Study) -> Result<Outcome, String> {
    let done = match run(study, Watch::NONE) {
        Ok(done) => done,
        Err(error) if error.kind() == ErrorKind::InvalidInput && !error.to_string().trim().is_empty() => {
            return Ok(Outcome::Accepted);
        }
        Err(error) => return Err(format!("a study that was read cannot be run: {error}")),
    };
    let answer = answer(study, &done);
    // JSON has null for what is not finite; the debug text has the number.
    if let Some(found) = not_finite(&format!("{answer:?}")) {
        return Err(format!("a number of the answer is not finite: {found}"));
    }
    let json = output::json(&answer).map_err(|error| error.to_string())?;
    serde_json::from_str::<Value>(&json).map_err(|error| error.to_string())?;
    for analysis in &done {
        let table = output::table_csv(study, analysis).map_err(|error| error.to_string())?;
        if let Some(found) = not_finite(&String::from_utf8_lossy(&table)) {
            return Err(format!("a number of the table is not finite: {found}"));
        }
    }
    Ok(Outcome::Evaluated)
}

/// The text around the first number that is not finite.
fn not_finite(text: &str) -> Option<&str> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let word = |name: &str| {
        let mut found = text.match_indices(name).map(|(at, _)| at);
        found.find(|at| !text[..*at].ends_with(is_word) && !text[at + name.len()..].starts_with(is_word))
    };
    let at = word("NaN").or_else(|| word("inf"))?;
    let [start, end] = [
        text.floor_char_boundary(at.saturating_sub(300)),
        text.ceil_char_boundary(at + 30),
    ];
    text.get(start..end)
}

//! A TOML document that is checked completely: every problem is reported, all at once, at its place.
//!
//! Reading has three steps. [`Document::parse`] finds what is not TOML. [`Document::read`] compares the tree with the
//! JSON schema of the target type, then lets serde build the value. What no schema can say (a step larger than its
//! plane) the caller checks, and reports through [`Document::problem`], which finds the place of a value by its path.
//!
//! In reading order: `source` (the text), `problem` (what is reported of it), `path` (names a value), `tree` (the
//! values, each with its place), `lookup` (finds one by its path), `limits` (refuses what would nest too deep); `shape`
//! (what a value must look like), `schema` (reads that from a JSON schema) and `merge` (puts shapes together), `check`
//! (compares tree and shape), `unit` and `words` (units of names, and how both are written in messages);
//! [`edit`] (changes values of a text and leaves the rest) with `entries` (list entries: added and removed); `lines`
//! (text that is not TOML, line by line).
//!
//! ```
//! use armill_formats::document::Document;
//!
//! #[derive(serde::Deserialize, schemars::JsonSchema, Debug)]
//! #[serde(deny_unknown_fields)]
//! struct Plane {
//!     step_mm: f64,
//! }
//!
//! let document = Document::parse("plane.toml", "step = 5.0\n")?;
//! let problems = document.read::<Plane>().unwrap_err();
//! assert!(problems.to_string().contains("plane.toml:1:1: unknown field `step`"));
//! assert!(problems.to_string().contains("lengths carry their unit: write `step_mm`"));
//! # Ok::<(), armill_formats::document::Problems>(())
//! ```

mod check;
pub mod edit;
mod entries;
mod limits;
pub(crate) mod lines;
mod lookup;
mod merge;
mod path;
mod problem;
mod schema;
mod shape;
mod source;
mod tree;
pub(crate) mod unit;
mod words;

use std::ops::Range;

use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use toml::de::DeTable;

pub(crate) use self::path::joined;
pub(crate) use self::problem::unreadable;
pub use self::problem::{MOST_PROBLEMS, Problem, Problems};
pub use self::source::Source;

/// More syntax problems than this are not listed: after the first few, one mistake begets the next.
const MOST_SYNTAX_PROBLEMS: usize = 20;

/// A TOML file as text and as a tree in which every key and value has its place.
///
/// Not checked: whether the tree is a valid value; [`Document::read`] checks that.
#[derive(Debug, Clone)]
pub struct Document {
    source: Source,
    root: tree::Node,
}

impl Document {
    /// The tree of a TOML text; `name` is the path that problems show.
    ///
    /// A byte order mark and Windows line ends are accepted.
    ///
    /// # Errors
    /// What is not TOML, one problem a line, at most 20; and nesting deeper than 64 levels.
    pub fn parse(name: &str, text: &str) -> Result<Self, Problems> {
        let source = Source::new(name, text);
        if let Some(problem) = limits::too_deep(&source) {
            return Err(Problems::from(vec![problem]));
        }
        let (root, errors) = DeTable::parse_recoverable(source.text());
        if !errors.is_empty() {
            return Err(syntax_problems(&source, &errors));
        }
        let root = tree::root(root.into_inner());
        Ok(Self { source, root })
    }

    /// The tree of a TOML file as it was read from disk, see [`Document::parse`].
    ///
    /// # Errors
    /// Those of [`Document::parse`], and bytes that are not UTF-8.
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<Self, Problems> {
        Self::parse(name, Self::text_of(name, bytes)?)
    }

    /// The text of a file as it was read from disk, in any format.
    ///
    /// # Errors
    /// Bytes that are not UTF-8, at their place.
    pub fn text_of<'a>(name: &str, bytes: &'a [u8]) -> Result<&'a str, Problems> {
        std::str::from_utf8(bytes)
            .map_err(|error| Problems::from(vec![source::not_utf8(name, bytes, &error)]))
    }

    /// The value this document describes.
    ///
    /// Understood of the schema: structs, maps, lists, tuples, options, and enums of any tagging.
    /// Not checked before serde does: `pattern`, `format`, `multipleOf`, `uniqueItems`; serde's `alias` is not known
    /// here.
    ///
    /// # Errors
    /// Every unknown or missing field, wrong type, wrong number of entries, number out of range and number that is not
    /// finite (at most 1000); only when there is none, the first thing serde refuses.
    pub fn read<T: DeserializeOwned + JsonSchema>(&self) -> Result<T, Problems> {
        let shapes = schema::shapes(&schemars::schema_for!(T).to_value());
        let problems = check::all_problems(&self.source, &self.root, &shapes);
        if !problems.is_empty() {
            return Err(Problems::from(problems));
        }
        toml::from_str(self.source.text()).map_err(|error| {
            let span = error.span().unwrap_or(0..0);
            Problems::from(vec![self.source.problem(span, error.message().trim(), None)])
        })
    }

    /// A problem at the value that `path` names, such as `plane.step_mm` or `analysis[2].distances_mm[0]`.
    ///
    /// Where the path does not exist, the problem is at the nearest parent that does. Keys that are not bare are
    /// written in quotes, as in TOML: `material."EN AW-6082"`.
    pub fn problem(&self, path: &str, message: impl Into<String>, hint: Option<&str>) -> Problem {
        self.source
            .problem(self.span(path), message, hint.map(str::to_owned))
    }

    /// The position of the value that `path` names, in bytes of the text; of its nearest parent if there is none.
    fn span(&self, path: &str) -> Range<usize> {
        lookup::nearest_span(&self.root, path)
    }

    /// Whether the file itself gives a value at `path`, rather than leaving it to a default.
    pub fn contains(&self, path: &str) -> bool {
        lookup::exists(&self.root, path)
    }

    /// The paths of all values at or below `path` that are not tables, such as `centre_mm` and `half_size_mm` below
    /// `plane`; counted from there, in the order of the alphabet.
    pub fn keys(&self, path: &str) -> Vec<String> {
        let mut found = Vec::new();
        if let Some(node) = lookup::found(&self.root, path) {
            tree::leaves(node, "", &mut found);
        }
        found
    }

    /// All values as JSON has them: dates as text, what cannot be represented as `null`.
    pub fn to_json(&self) -> serde_json::Value {
        tree::json(&self.root)
    }

    /// The position of the value that `path` names, in bytes of the text; `None` where there is none.
    pub fn place(&self, path: &str) -> Option<Range<usize>> {
        lookup::found(&self.root, path).map(|node| node.span.clone())
    }

    /// Every text in the document, with its path as [`Document::problem`] takes it.
    pub(crate) fn texts(&self) -> Vec<(String, &str)> {
        let mut found = Vec::new();
        tree::texts(&self.root, "", &mut found);
        found
    }
}

/// The JSON schema of a document type, for editors: indented, with a newline at its end.
pub fn schema_json<T: JsonSchema>() -> String {
    format!("{:#}\n", schemars::schema_for!(T).to_value())
}

/// One problem a line: what follows on the same line is most often the echo of the first.
fn syntax_problems(source: &Source, errors: &[toml::de::Error]) -> Problems {
    let mut problems: Vec<Problem> = Vec::new();
    for error in errors {
        let span = error.span().unwrap_or(0..0);
        let line = source.position(span.start).0;
        if problems.iter().any(|known| known.line() == line) {
            continue;
        }
        let message = format!("not valid TOML: {}", error.message().trim());
        let hint = decimal_comma(source.text(), &span).or_else(|| syntax_hint(error.message()));
        problems.push(source.problem(span, message, hint));
        if problems.len() == MOST_SYNTAX_PROBLEMS {
            break;
        }
    }
    Problems::from(problems)
}

/// Advice where a comma between two digits, at `span` or just before, is a decimal comma: `0,1`.
fn decimal_comma(text: &str, span: &Range<usize>) -> Option<String> {
    let bytes = text.as_bytes();
    let is_digit = |at: Option<usize>| at.and_then(|at| bytes.get(at)).is_some_and(u8::is_ascii_digit);
    let is_decimal = |at: &usize| {
        bytes.get(*at) == Some(&b',') && is_digit(at.checked_sub(1)) && is_digit(at.checked_add(1))
    };
    // A parser may notice it only behind the decimals.
    let decimals = bytes[..span.start.min(bytes.len())]
        .iter()
        .rev()
        .take_while(|byte| byte.is_ascii_digit())
        .count();
    let before = span.start.saturating_sub(1);
    let at = [span.start, before, before.saturating_sub(decimals)]
        .into_iter()
        .find(is_decimal)?;
    let digits = |byte: &&u8| byte.is_ascii_digit();
    let before = bytes[..at].iter().rev().take_while(digits).count();
    let after = bytes[at + 1..].iter().take_while(digits).count();
    let [whole, part] = [&text[at - before..at], &text[at + 1..at + 1 + after]];
    Some(format!("write decimals with a point: `{whole}.{part}`"))
}

/// Advice for the two slips that are made most often, by what the parser says of them.
fn syntax_hint(message: &str) -> Option<String> {
    let hint = if message.contains("string values must be quoted") {
        "write text in quotes, and numbers with a point and without a unit: `step_mm = 2.5`"
    } else if message.contains("duplicate key") {
        "keep one of the two; tables that repeat are written `[[name]]`"
    } else {
        return None;
    };
    Some(hint.to_owned())
}

#[cfg(test)]
mod tests;

//! The little of YAML that parameter files use: keys with a scalar, a list in brackets, or a list of lines.
//!
//! No YAML reader would do: `deg(-90.0)` is text to them, and its place is lost. Indentation, and keys that only
//! contain other keys, do not matter here.
//!
//! ```text
//! key: 1.5                      one value
//! key: [1, 2,                   values up to the bracket, over any number of lines
//!       3]
//! key:                          values a line each
//!   - 1
//!   - 2
//! # comment                     to the end of its line; a `#` behind a letter is none
//! ```

use std::ops::Range;

/// A key with its values.
#[derive(Debug, PartialEq)]
pub(in crate::robot) struct Entry<'a> {
    /// Without quotes round it.
    pub key: &'a str,
    /// Of the key, in bytes of the text.
    pub place: Range<usize>,
    /// In order; empty for a key that only contains others.
    pub values: Vec<Scalar<'a>>,
}

/// A value as it is written.
#[derive(Debug, PartialEq)]
pub(in crate::robot) struct Scalar<'a> {
    /// Without blanks, brackets and commas round it; quotes stay.
    pub text: &'a str,
    /// Bytes of the text.
    pub place: Range<usize>,
}

/// Every key of the text, in order.
///
/// Nothing is refused: a text of another kind has none of the requested keys. A key that is given twice is there twice.
pub(in crate::robot) fn entries(text: &str) -> Vec<Entry<'_>> {
    let mut entries: Vec<Entry<'_>> = Vec::new();
    let mut in_brackets = false;
    let mut line_start = 0;
    for line in text.split_inclusive('\n') {
        let start = line_start;
        line_start += line.len();
        let content = without_comment(line);
        let (key, rest) = match content.split_once(':') {
            _ if in_brackets => (None, content),
            Some((key, rest)) => (Some(key.trim().trim_matches(['\'', '"'])), rest),
            None => (None, content),
        };
        let rest_start = start + content.len() - rest.len();
        if let Some(key) = key {
            let at = start + content.find(key).unwrap_or(0);
            entries.push(Entry {
                key,
                place: at..at + key.len(),
                values: Vec::new(),
            });
        }
        let Some(entry) = entries.last_mut() else { continue };
        let item = match rest.trim_start().strip_prefix("- ") {
            Some(item) if key.is_none() && !in_brackets => item,
            _ => rest,
        };
        let item_start = rest_start + rest.len() - item.len();
        // A line that is neither key nor list item contains nothing that is needed.
        if key.is_some() || in_brackets || item.len() < rest.len() {
            entry.values.extend(scalars(item, item_start));
        }
        in_brackets = match (item.rfind('['), item.rfind(']')) {
            (Some(open), Some(close)) => open > close,
            (Some(_), None) => true,
            (None, Some(_)) => false,
            (None, None) => in_brackets,
        };
    }
    entries
}

/// The values of one line, without brackets and commas.
fn scalars(item: &str, start: usize) -> impl Iterator<Item = Scalar<'_>> {
    let mut at = start;
    item.split_inclusive(['[', ']', ',']).filter_map(move |piece| {
        let begins = at;
        at += piece.len();
        let word = piece.trim_end_matches(['[', ']', ',']);
        let text = word.trim();
        let place = begins + word.len() - word.trim_start().len();
        (!text.is_empty()).then_some(Scalar {
            text,
            place: place..place + text.len(),
        })
    })
}

/// A line up to its comment: a `#` at its start, or behind a blank or tab.
fn without_comment(line: &str) -> &str {
    let starts = line.char_indices().find(|(at, c)| {
        *c == '#'
            && line
                .get(..*at)
                .is_none_or(|before| before.is_empty() || before.ends_with([' ', '\t']))
    });
    match starts {
        Some((at, _)) => line.get(..at).unwrap_or(line),
        None => line,
    }
}

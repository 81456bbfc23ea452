//! The values of a TOML text, each with its place.
//!
//! The values of the crate `toml` in the form in which they are compared: numbers parsed, texts owned, tables sorted by
//! their keys, so that problems come in one order whatever the parser does. Spans are bytes of the text.

use std::collections::BTreeMap;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::path::joined;

/// A value and the bytes it is written in; a table's are those of its header.
#[derive(Debug, Clone)]
pub(super) struct Node {
    pub(super) span: Range<usize>,
    pub(super) value: Value,
}

/// A value of TOML.
#[derive(Debug, Clone)]
pub(super) enum Value {
    Text(String),
    /// A whole number; one beyond 128 bits is cut to them.
    Whole(i128),
    /// Any other number; one that cannot be represented is infinite.
    Real(f64),
    Flag(bool),
    /// A date or time, as it is written.
    Date(String),
    List(Vec<Node>),
    Table(Table),
}

/// Fields by their keys, in the order of the alphabet.
pub(super) type Table = BTreeMap<String, Entry>;

/// A field of a table: the position of its key, and its value.
#[derive(Debug, Clone)]
pub(super) struct Entry {
    pub(super) key_span: Range<usize>,
    pub(super) node: Node,
}

/// The whole document as one node, with an empty span at its start.
pub(super) fn root(table: DeTable<'_>) -> Node {
    Node {
        span: 0..0,
        value: Value::Table(fields(table)),
    }
}

/// Adds every text at or below `node`, which is at `path`, with its own path.
///
/// Paths are as `path` reads them; tables in the order of their keys.
pub(super) fn texts<'a>(node: &'a Node, path: &str, found: &mut Vec<(String, &'a str)>) {
    match &node.value {
        Value::Text(text) => found.push((path.to_owned(), text)),
        Value::List(entries) => {
            for (index, entry) in entries.iter().enumerate() {
                texts(entry, &format!("{path}[{index}]"), found);
            }
        }
        Value::Table(table) => {
            for (key, entry) in table {
                texts(&entry.node, &joined(path, key), found);
            }
        }
        _ => {}
    }
}

/// Adds the path of every value at or below `node` that is not a table; lists are values as a whole.
pub(super) fn leaves(node: &Node, path: &str, found: &mut Vec<String>) {
    match &node.value {
        Value::Table(table) => {
            for (key, entry) in table {
                leaves(&entry.node, &joined(path, key), found);
            }
        }
        _ => found.push(path.to_owned()),
    }
}

/// The values at and below `node` as JSON has them.
pub(super) fn json(node: &Node) -> serde_json::Value {
    use serde_json::Value as Json;
    match &node.value {
        Value::Text(text) | Value::Date(text) => Json::from(text.as_str()),
        Value::Whole(whole) => i64::try_from(*whole).map_or(Json::Null, Json::from),
        // JSON has neither infinite numbers nor NaN.
        Value::Real(real) => Json::from(*real),
        Value::Flag(flag) => Json::from(*flag),
        Value::List(entries) => entries.iter().map(json).collect(),
        Value::Table(table) => {
            let fields = table.iter().map(|(key, entry)| (key.clone(), json(&entry.node)));
            Json::Object(fields.collect())
        }
    }
}

/// The fields of a table with the places of their keys.
fn fields(table: DeTable<'_>) -> Table {
    let entry = |(key, value): (Spanned<_>, _)| {
        let key_span = key.span();
        let name: std::borrow::Cow<'_, str> = key.into_inner();
        (
            name.into_owned(),
            Entry {
                key_span,
                node: node(value),
            },
        )
    };
    table.into_iter().map(entry).collect()
}

/// A value of the parser with its place. The parser has checked that a number is one, so that what does not parse here
/// is merely too large to be represented.
fn node(spanned: Spanned<DeValue<'_>>) -> Node {
    let span = spanned.span();
    let value = match spanned.into_inner() {
        DeValue::String(text) => Value::Text(text.into_owned()),
        DeValue::Integer(integer) => {
            let beyond = if integer.as_str().starts_with('-') {
                i128::MIN
            } else {
                i128::MAX
            };
            Value::Whole(i128::from_str_radix(integer.as_str(), integer.radix()).unwrap_or(beyond))
        }
        DeValue::Float(float) => Value::Real(float.as_str().parse().unwrap_or(f64::INFINITY)),
        DeValue::Boolean(flag) => Value::Flag(flag),
        DeValue::Datetime(date) => Value::Date(date.to_string()),
        DeValue::Array(entries) => Value::List(entries.into_iter().map(node).collect()),
        DeValue::Table(table) => Value::Table(fields(table)),
    };
    Node { span, value }
}

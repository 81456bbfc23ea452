//! Where numbers come from: the table `[sources]` of our robot and material files, and the keys that name its entries.
//!
//! A field called `source`, or ending in `_source`, names a source by its key, anywhere. No number without a
//! source, no source without a number.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use crate::document::{Document, Problem, joined};

/// Where numbers come from.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, JsonSchema)]
pub struct Source {
    /// Key inside the file.
    pub key: String,
    /// What was taken.
    pub what: String,
    /// Its position.
    #[serde(rename = "where")]
    pub place: String,
    /// Under which licence, or that it is a fact.
    pub licence: String,
}

/// A source as written in a file, below its key.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SourceEntry {
    /// What was taken.
    pub what: String,
    /// Its position.
    #[serde(rename = "where")]
    pub place: String,
    /// Under which licence, or that it is a fact.
    pub licence: String,
}

/// The table `[sources]`, by key.
pub(crate) type SourceTable = BTreeMap<String, SourceEntry>;

/// The sources of a file, in the order of their keys.
pub(crate) fn listed(table: SourceTable) -> Vec<Source> {
    let source = |(key, entry): (String, SourceEntry)| Source {
        key,
        what: entry.what,
        place: entry.place,
        licence: entry.licence,
    };
    table.into_iter().map(source).collect()
}

/// Every place of the document that names a source: its path, and the key it names.
pub(crate) fn named(document: &Document) -> Vec<(String, &str)> {
    let names_one = |path: &str| {
        let field = path.rsplit('.').next().unwrap_or(path);
        (field == "source" || field.ends_with("_source")) && !path.starts_with("sources.")
    };
    let mut texts = document.texts();
    texts.retain(|(path, _)| names_one(path));
    texts
}

/// Keys that are named but missing in the table, and keys of the table that nothing names.
pub(crate) fn problems(document: &Document, table: &SourceTable) -> Vec<Problem> {
    let named = named(document);
    let missing = named.iter().filter(|(_, key)| !table.contains_key(*key));
    let missing = missing.map(|(path, key)| {
        let known: Vec<&str> = table.keys().map(String::as_str).collect();
        let hint = format!("add a table [sources.{key}], or use one of: {}", known.join(", "));
        let message = format!("source `{key}` is not among the sources");
        document.problem(path, message, Some(&hint))
    });
    let unused = table
        .keys()
        .filter(|key| named.iter().all(|(_, used)| used != key));
    let unused = unused.map(|key| {
        let hint = "name it where its numbers are, or remove it";
        let message = format!("source `{key}` is used by no number");
        document.problem(&joined("sources", key), message, Some(hint))
    });
    missing.chain(unused).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, Deserialize, JsonSchema)]
    struct File {
        sources: SourceTable,
    }

    const ENTRY: &str = "what = \"\"\nwhere = \"\"\nlicence = \"\"\n";

    fn reported(fields: &str, keys: &[&str]) -> Vec<String> {
        let tables = keys.iter().map(|key| format!("[sources.{key}]\n{ENTRY}"));
        let text = format!("{fields}\n{}", tables.collect::<String>());
        let document = Document::parse("a.toml", &text).unwrap();
        let file: File = document.read().unwrap();
        let problems = problems(&document, &file.sources);
        problems.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn sources_are_named_in_lists_and_tables_of_any_depth() {
        let fields = "source = \"a\"\nlist = [{ u_source = \"b\", inner = { source = \"c d\" } }]\nresource = \"none\"";
        assert_eq!(reported(fields, &["a", "b", "\"c d\""]), [""; 0]);
    }

    #[test]
    fn a_source_that_is_missing_and_one_without_number_are_reported_at_their_place() {
        assert_eq!(
            reported("source = \"a\"\nlist = [{ u_source = \"b\" }]", &["a", "\"c d\""]),
            [
                "a.toml:2:22: source `b` is not among the sources",
                "a.toml:7:1: source `c d` is used by no number",
            ]
        );
    }

    #[test]
    fn a_key_of_the_list_itself_names_nothing() {
        let entry = "[sources.source]\nwhat = \"source\"\nwhere = \"\"\nlicence = \"\"\n";
        assert_eq!(
            reported(entry, &[]),
            ["a.toml:1:1: source `source` is used by no number"]
        );
    }
}

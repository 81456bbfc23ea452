//! TOML as the rules need it: tables with their line, which sources they name, whether they contain numbers.
//!
//! ```text
//! [joints.mass]                     name "joints.mass"
//! centre_mm = [1.0, 2.0, 3.0]       first_number
//! mass_source = ["paper", "scale"]  two sources with the key "mass_source"
//! d = { source = "scale" }          an inline table belongs to the table that it is in
//! ```
//!
//! Not checked: that it is TOML; the crate `formats` reads it as such in its tests.

use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Keys of numbers that were not measured.
const NOT_MEASURED: &[&str] = &[
    "format",
    "format_version",
    "version",
    "schema",
    "joint",
    "axis",
    "index",
];

/// One table, from its header to the next.
#[derive(Default)]
pub struct Table {
    /// Dotted, without brackets; empty for the lines before the first header.
    pub name: String,
    /// The line of its header, from 1.
    pub line: usize,
    /// The values of its keys `source` and `*_source`, with line and key.
    pub sources: Vec<Source>,
    /// The first line with a number.
    pub first_number: Option<usize>,
}

/// A key that says where numbers come from.
pub struct Source {
    /// From 1.
    pub line: usize,
    /// `source`, or `mass_source` where one table has several.
    pub key: String,
    /// The name of a `[sources.NAME]` table.
    pub name: String,
}

/// The tables of `text`, in order.
pub fn tables(text: &str) -> Vec<Table> {
    let (content, _) = DeTable::parse_recoverable(text);
    let mut reader = Reader {
        text,
        tables: vec![Table {
            line: 1,
            ..Table::default()
        }],
    };
    reader.entries(0, "", content.get_ref());
    reader.tables.sort_by_key(|table| table.line);
    reader.tables
}

/// The line of `text` where `span` begins, from 1.
pub fn line_of(text: &str, span: Range<usize>) -> usize {
    1 + text[..span.start].matches('\n').count()
}

/// Collects the tables of a text; methods take the place in `tables` of the one that they fill.
struct Reader<'a> {
    text: &'a str,
    tables: Vec<Table>,
}

impl Reader<'_> {
    /// The keys and values of the table with this name.
    fn entries(&mut self, at: usize, name: &str, content: &DeTable<'_>) {
        for (key, value) in content {
            let key = key.get_ref().as_ref();
            let inside = if name.is_empty() {
                key.to_owned()
            } else {
                format!("{name}.{key}")
            };
            self.value(at, (key, &inside), value);
        }
    }

    /// A value with its key, alone and after the names of the tables around it.
    fn value(&mut self, at: usize, (key, name): (&str, &str), value: &Spanned<DeValue<'_>>) {
        let line = line_of(self.text, value.span());
        match value.get_ref() {
            // An inline table begins with a brace.
            DeValue::Table(content) if self.text[value.span().start..].starts_with('[') => {
                self.tables.push(Table {
                    name: name.to_owned(),
                    line,
                    ..Table::default()
                });
                self.entries(self.tables.len() - 1, name, content);
            }
            DeValue::Table(content) => self.entries(at, name, content),
            DeValue::Array(values) => values.iter().for_each(|value| self.value(at, (key, name), value)),
            DeValue::String(source) if key == "source" || key.ends_with("_source") => {
                let source = Source {
                    line,
                    key: key.to_owned(),
                    name: source.to_string(),
                };
                self.tables[at].sources.push(source);
            }
            DeValue::Integer(_) | DeValue::Float(_) if !NOT_MEASURED.contains(&key) => {
                let first = self.tables[at].first_number.get_or_insert(line);
                *first = line.min(*first);
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_reported_with_their_sources_and_numbers() {
        let text = "format = 1\nname = \"KR 210\" # 3 of\n[a]\nx_mm = [\n  [1.0, 2],\n]\nmass_source = [\"p\", \"q\"]\n\
                    [[b.\"c\"]]\nd = { e = 1, source = \"r\", f = \"s\" }\n";
        let tables = tables(text);
        let given: Vec<_> = tables
            .iter()
            .map(|table| (table.name.as_str(), table.line, table.first_number))
            .collect();
        assert_eq!(given, [("", 1, None), ("a", 3, Some(5)), ("b.c", 8, Some(9))]);
        let sources = |at: usize| {
            tables[at]
                .sources
                .iter()
                .map(|source| source.name.as_str())
                .collect::<Vec<_>>()
        };
        assert_eq!(sources(1), ["p", "q"]);
        assert_eq!(sources(2), ["r"]);
        assert_eq!(tables[1].sources[0].key, "mass_source");
    }
}

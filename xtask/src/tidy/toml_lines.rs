//! TOML as the rules need it: tables with their line, which sources they name, whether they contain numbers.
//! Read line by line; our files have one key a line.
//!
//! ```text
//! [joints.mass]                     name "joints.mass"
//! centre_mm = [1.0, 2.0, 3.0]       first_number
//! mass_source = ["paper", "scale"]  two sources with the key "mass_source"
//! ```
//!
//! Not checked: that it is TOML; the crate `formats` reads it as such in its tests.

use super::rust::is_word;

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
    let mut tables = Vec::new();
    let mut table = Table {
        name: String::new(),
        line: 1,
        sources: Vec::new(),
        first_number: None,
    };
    for (index, line) in text.lines().enumerate() {
        let number = index + 1;
        let line = without_comment(line).trim();
        if let Some(name) = header(line) {
            tables.push(table);
            table = Table {
                name,
                line: number,
                sources: Vec::new(),
                first_number: None,
            };
            continue;
        }
        table.sources.extend(sources_in(line, number));
        let key = line.split('=').next().map(str::trim).unwrap_or_default();
        if table.first_number.is_none() && !NOT_MEASURED.contains(&key) && has_number(line) {
            table.first_number = Some(number);
        }
    }
    tables.push(table);
    tables
}

/// The name in `[name]` or `[[name]]`; nothing for a line of an array that spans lines.
fn header(line: &str) -> Option<String> {
    let inside = line.strip_prefix('[')?.strip_suffix(']')?;
    let inside = inside
        .strip_prefix('[')
        .and_then(|inside| inside.strip_suffix(']'))
        .unwrap_or(inside)
        .trim();
    let is_name = inside.starts_with(|c: char| c.is_alphabetic() || c == '_')
        && inside
            .chars()
            .all(|c| is_word(c) || matches!(c, '.' | '-' | '"' | ' '));
    is_name.then(|| inside.replace('"', ""))
}

/// Every `source = "a"`, `mass_source = ["a", "b"]`, also inside an inline table.
fn sources_in(line: &str, number: usize) -> Vec<Source> {
    let mut sources = Vec::new();
    for (at, word) in line.match_indices("source") {
        let begin = line[..at]
            .rfind(|c: char| !is_word(c))
            .map_or(0, |before| before + 1);
        let key = &line[begin..at + word.len()];
        let value = line[at + word.len()..]
            .trim_start()
            .strip_prefix('=')
            .map(str::trim_start);
        let Some(value) = value.filter(|_| key == word || key.ends_with("_source")) else {
            continue;
        };
        let names = match value.strip_prefix('[') {
            Some(list) => quoted(list.split(']').next().unwrap_or_default()),
            None => quoted(value).into_iter().take(1).collect(),
        };
        let source = |name: &str| Source {
            line: number,
            key: key.to_owned(),
            name: name.to_owned(),
        };
        sources.extend(names.into_iter().map(source));
    }
    sources
}

/// What is between quotes, in order.
fn quoted(text: &str) -> Vec<&str> {
    text.split('"').skip(1).step_by(2).collect()
}

/// Whether a number is in `line` outside of strings, not as a part of a name.
fn has_number(line: &str) -> bool {
    let value = line.split_once('=').map_or(line, |(_, value)| value);
    value.split('"').step_by(2).any(|outside| {
        let digit = |(at, c): (usize, char)| c.is_ascii_digit() && !outside[..at].ends_with(is_word);
        outside.char_indices().any(digit)
    })
}

/// `line` up to a `#` that is in no string.
fn without_comment(line: &str) -> &str {
    let mut in_string = false;
    for (at, c) in line.char_indices() {
        match c {
            '"' => in_string = !in_string,
            '#' if !in_string => return &line[..at],
            _ => {}
        }
    }
    line
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

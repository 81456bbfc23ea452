//! Fields that cross a boundary: those of types that a file, a result or a command line is made of.
//!
//! A type crosses where it derives serde's traits, a JSON schema or clap's: its field names are then keys or
//! options. Found in the text by its brackets, without a parser; types made by macros are not seen.

use super::rust::{RustFile, find_word, is_word};

/// Deriving one of these makes the names of the fields part of a format that users see.
const BOUNDARY_DERIVES: &[&str] = &[
    "Serialize",
    "Deserialize",
    "JsonSchema",
    "Args",
    "Parser",
    "Subcommand",
];

/// A named field.
#[derive(Debug, PartialEq, Eq)]
pub struct Field {
    /// Its position, from 1.
    pub line: usize,
    /// Its name.
    pub name: String,
    /// Its type, as written.
    pub of_type: String,
}

/// The named fields of all structs and enums of `file` that derive what makes them a format.
pub fn boundary_fields(file: &RustFile<'_>) -> Vec<Field> {
    let text = file.code.join("\n");
    let mut fields = Vec::new();
    for keyword in ["struct ", "enum "] {
        for (at, _) in text.match_indices(keyword) {
            let whole_word = !text[..at].ends_with(is_word);
            if whole_word && derives_a_format(&text[..at]) {
                fields.extend(
                    body(&text, at)
                        .into_iter()
                        .flat_map(|(begin, end)| fields_in(&text, begin, end)),
                );
            }
        }
    }
    fields
}

/// Whether the attributes at the end of `before` derive one of [`BOUNDARY_DERIVES`].
fn derives_a_format(before: &str) -> bool {
    let attributes = before
        .rfind([';', '}', '{'])
        .map_or(before, |at| &before[at + 1..]);
    attributes.contains("derive(")
        && BOUNDARY_DERIVES
            .iter()
            .any(|name| find_word(attributes, name).is_some())
}

/// Where the text between the braces of the type at `at` begins and ends; nothing for a tuple or unit struct.
fn body(text: &str, at: usize) -> Option<(usize, usize)> {
    let open = at + text[at..].find(['{', ';', '('])?;
    text[open..]
        .starts_with('{')
        .then(|| (open + 1, closing(text, open)))
}

/// Where the bracket that opens at `open` closes.
fn closing(text: &str, open: usize) -> usize {
    let mut depth = 0;
    for (at, c) in text[open..].char_indices() {
        match c {
            '{' | '[' | '(' => depth += 1,
            '}' | ']' | ')' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return open + at;
        }
    }
    text.len()
}

/// The `name: type` pairs between `begin` and `end`, also those inside the variants of an enum.
fn fields_in(text: &str, begin: usize, end: usize) -> Vec<Field> {
    let mut fields = Vec::new();
    let mut at = begin;
    while at < end {
        let rest = &text[at..end];
        let name_length = rest.find(|c: char| !is_word(c)).unwrap_or(rest.len());
        let after_name = rest[name_length..].trim_start();
        if rest.starts_with("#[") {
            at = closing(text, at + 1) + 1;
        } else if name_length > 0 && after_name.starts_with(':') && !after_name.starts_with("::") {
            let type_begin = end - after_name.len() + 1;
            let length = type_length(&text[type_begin..end]);
            fields.push(Field {
                line: 1 + text[..at].matches('\n').count(),
                name: rest[..name_length].to_owned(),
                of_type: text[type_begin..type_begin + length].trim().to_owned(),
            });
            at = type_begin + length;
        } else {
            at += name_length.max(rest.chars().next().map_or(1, char::len_utf8));
        }
    }
    fields
}

/// How far a type goes: to the comma or the brace that does not belong to it.
fn type_length(text: &str) -> usize {
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        match c {
            ',' | '}' if depth == 0 => return at,
            '<' | '[' | '(' | '{' => depth += 1,
            '>' | ']' | ')' | '}' => depth -= 1,
            _ => {}
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fields(text: &str) -> Vec<(usize, String, String)> {
        let fields = boundary_fields(&RustFile::read("a.rs", text)).into_iter();
        fields
            .map(|field| (field.line, field.name, field.of_type))
            .collect()
    }

    fn field(line: usize, name: &str, of_type: &str) -> (usize, String, String) {
        (line, name.to_owned(), of_type.to_owned())
    }

    #[test]
    fn fields_of_a_format_are_found_with_their_types() {
        let text = "#[derive(Debug, Deserialize)]\n#[serde(deny_unknown_fields)]\npub struct A<'a> {\n    \
                    #[serde(default = \"b::c\")]\n    pub d: Option<[f64; 3]>,\n    pub e: BTreeMap<u8, f64>,\n}\n";
        assert_eq!(
            fields(text),
            [
                field(5, "d", "Option<[f64; 3]>"),
                field(6, "e", "BTreeMap<u8, f64>")
            ]
        );
    }

    #[test]
    fn fields_of_variants_are_found() {
        let text = "#[derive(Serialize)]\nenum A {\n    B { c: f64, d: u8 },\n    E(f64),\n}\n";
        assert_eq!(fields(text), [field(3, "c", "f64"), field(3, "d", "u8")]);
    }

    #[test]
    fn other_types_are_no_boundary() {
        let text = "#[derive(Serialize)]\nstruct A(f64);\n#[derive(Debug)]\nstruct B {\n    c: f64,\n}\n\
                    fn serialize(d: f64) -> Serialize { instruct { e: f64 } }\n";
        assert_eq!(fields(text), []);
    }
}

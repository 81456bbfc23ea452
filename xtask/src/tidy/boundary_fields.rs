//! Fields that cross a boundary: those of types that a file, a result or a command line is made of.
//!
//! A type crosses where it derives serde's traits, a JSON schema or clap's: its field names are then keys or
//! options. Types made by macros are not seen.

use super::rust::{RustFile, is_punct, item_length, tokens};
use proc_macro2::TokenTree;
use syn::spanned::Spanned;
use syn::{Data, DeriveInput};

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
pub fn boundary_fields(file: &RustFile) -> Vec<Field> {
    let mut fields = Vec::new();
    read_items(&file.trees, &mut fields);
    fields
}

/// Adds the fields of the types in `trees`, inside of modules and functions too.
fn read_items(trees: &[TokenTree], fields: &mut Vec<Field>) {
    for (at, tree) in trees.iter().enumerate() {
        let TokenTree::Group(group) = tree else { continue };
        let inside: Vec<TokenTree> = group.stream().into_iter().collect();
        if at > 0 && is_punct(&trees[at - 1], '#') && derives_a_format(&inside) {
            let item = &trees[at - 1..];
            let item = item[..item_length(item)].iter().cloned().collect();
            fields.extend(syn::parse2(item).map(fields_of).unwrap_or_default());
        }
        read_items(&inside, fields);
    }
}

/// Whether an attribute derives one of [`BOUNDARY_DERIVES`].
fn derives_a_format(attribute: &[TokenTree]) -> bool {
    let words = tokens(attribute.iter().cloned());
    words.iter().any(|word| word.text == "derive")
        && words
            .iter()
            .any(|word| BOUNDARY_DERIVES.contains(&word.text.as_str()))
}

/// The named fields of a type, of an enum those of its variants.
fn fields_of(item: DeriveInput) -> Vec<Field> {
    let fields: Vec<syn::Field> = match item.data {
        Data::Struct(content) => content.fields.into_iter().collect(),
        Data::Enum(content) => content
            .variants
            .into_iter()
            .flat_map(|variant| variant.fields)
            .collect(),
        Data::Union(_) => Vec::new(),
    };
    let field = |field: syn::Field| {
        let name = field.ident?;
        Some(Field {
            line: name.span().start().line,
            name: name.to_string(),
            of_type: field.ty.span().source_text().unwrap_or_default(),
        })
    };
    fields.into_iter().filter_map(field).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fields(text: &str) -> Vec<(usize, String, String)> {
        let fields = boundary_fields(&RustFile::read("a.rs", text).unwrap()).into_iter();
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

//! The tags of an XML text and their attributes, with their positions. The text between them is not evaluated.

use crate::spelling::Part;

/// Maximum number of attributes of a tag that are read: no tag of VAL3 has twenty.
const MOST_ATTRIBUTES: usize = 100;

/// A tag.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tag<'a> {
    /// Its name; `/Data` is a closing tag.
    pub name: &'a str,
    /// Its attributes as text.
    pub inside: Part<'a>,
}

/// An attribute.
#[derive(Clone, Copy, Debug)]
pub(super) struct Attribute<'a> {
    pub name: &'a str,
    pub value: Part<'a>,
}

/// A piece of an XML text.
#[derive(Clone, Copy, Debug)]
pub(super) enum Piece<'a> {
    /// A tag.
    Tag(Tag<'a>),
    /// `<![CDATA[` and its content.
    Verbatim(Part<'a>),
    /// An unclosed tag.
    Broken(Part<'a>),
}

/// The tags of a text and the content of CDATA. Comments, declarations and processing instructions are left out.
pub(super) fn pieces(text: &str) -> impl Iterator<Item = Piece<'_>> {
    let mut rest = Part { at: 0, text };
    std::iter::from_fn(move || {
        loop {
            let begin = rest.text.find('<')?;
            let tag = rest.from(begin);
            let until = |end: &str, from: usize| {
                tag.text
                    .get(from..)
                    .and_then(|text| text.find(end))
                    .map(|at| from + at)
            };
            if tag.text.starts_with("<!--") {
                rest = tag.from(until("-->", 4).map_or(tag.text.len(), |at| at + 3));
            } else if tag.text.starts_with("<![CDATA[") {
                let end = until("]]>", 9).unwrap_or(tag.text.len());
                rest = tag.from(end + 3);
                return Some(Piece::Verbatim(Part {
                    at: tag.at + 9,
                    text: &tag.text[9..end],
                }));
            } else if tag.text.starts_with("<?") || tag.text.starts_with("<!") {
                rest = tag.from(until(">", 2).map_or(tag.text.len(), |at| at + 1));
            } else {
                let Some(end) = end_of_tag(tag.text) else {
                    rest = tag.from(tag.text.len());
                    return Some(Piece::Broken(Part {
                        at: tag.at,
                        text: &tag.text[..1],
                    }));
                };
                rest = tag.from(end + 1);
                let said = tag.text[1..end].trim_end_matches('/');
                let name = said.split(|c: char| c.is_whitespace()).next().unwrap_or_default();
                // A closing tag begins with a slash.
                let name_end = 1 + name.len().max(usize::from(said.is_empty()));
                return Some(Piece::Tag(Tag {
                    name,
                    inside: Part {
                        at: tag.at + name_end,
                        text: tag.text.get(name_end..1 + said.len()).unwrap_or_default(),
                    },
                }));
            }
        }
    })
}

/// Position of the `>` that ends a tag: not one between quotes.
fn end_of_tag(text: &str) -> Option<usize> {
    let mut quote = None;
    text.bytes().enumerate().skip(1).find_map(|(at, byte)| {
        match (quote, byte) {
            (None, b'>') => return Some(at),
            (None, b'"' | b'\'') => quote = Some(byte),
            (Some(open), _) if open == byte => quote = None,
            _ => {}
        }
        None
    })
}

/// The attributes in a tag.
pub(super) fn attributes(inside: Part<'_>) -> Vec<Attribute<'_>> {
    let mut found = Vec::new();
    let mut rest = inside;
    while found.len() < MOST_ATTRIBUTES {
        let Some(equals) = rest.text.find('=') else {
            break;
        };
        let name = rest.text[..equals].split_whitespace().last().unwrap_or_default();
        let behind = rest.from(equals + 1);
        let Some(open) = behind.text.find(['"', '\'']) else {
            break;
        };
        let value = behind.from(open + 1);
        let quote = &behind.text[open..=open];
        let Some(close) = value.text.find(quote) else {
            break;
        };
        found.push(Attribute {
            name,
            value: Part {
                at: value.at,
                text: &value.text[..close],
            },
        });
        rest = value.from(close + 1);
    }
    found
}

/// The value of an attribute.
pub(super) fn value<'a>(attributes: &[Attribute<'a>], name: &str) -> Option<&'a str> {
    let attribute = attributes.iter().find(|attribute| attribute.name == name)?;
    Some(attribute.value.text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tags_have_names_and_attributes_with_their_positions() {
        let text = "<?xml a='<'?><!-- <b> --><A x=\"1>2\" y = '3'/>t<![CDATA[a<b]]></A><B";
        let said: Vec<String> = pieces(text)
            .map(|piece| match piece {
                Piece::Tag(tag) => {
                    let attributes = attributes(tag.inside);
                    for attribute in &attributes {
                        assert_eq!(&text[attribute.value.range()], attribute.value.text);
                    }
                    let values: Vec<String> = attributes
                        .iter()
                        .map(|one| format!("{}={}", one.name, one.value.text))
                        .collect();
                    format!("{} {}", tag.name, values.join(" "))
                }
                Piece::Verbatim(part) => {
                    assert_eq!(&text[part.range()], part.text);
                    format!("verbatim {}", part.text)
                }
                Piece::Broken(part) => format!("broken {}", part.at),
            })
            .collect();
        assert_eq!(said, ["A x=1>2 y=3", "verbatim a<b", "/A ", "broken 65"]);
    }
}

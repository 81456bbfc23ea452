//! XML with the place of everything that is wrong in it: the ground of URDF, xacro, QIF and results of ball-bars.
//!
//! The parser is the crate `roxmltree`; before it runs, and behind it, what would take it or those who walk its tree
//! too long is refused. Places are bytes of the text.

use std::io::Read;
use std::ops::Range;

use roxmltree::{Document, Node, ParsingOptions};

use crate::document::{Problems, Source, unreadable};
use crate::input;

/// More elements, attributes and texts than this are not accepted: the largest robot of ROS-Industrial has 2000.
const MOST_NODES: u32 = 1_000_000;
/// Attributes of one element: none has ten.
const MOST_ATTRIBUTES: usize = 200;
/// Elements within elements: robots have five, xacro with conditions ten. What walks the tree calls itself for each.
const MOST_LEVELS: usize = 64;

/// The text of the XML file `path`.
///
/// # Errors
/// A reader that fails; more than [`input::MOST_BYTES`].
pub(crate) fn text_of(path: &str, reader: impl Read) -> Result<String, Problems> {
    let bytes = input::bytes_of(reader).map_err(|error| unreadable(path, &error))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// The tree of an XML text.
///
/// # Errors
/// What is not well-formed, at its place; elements that nest deeper than [`MOST_LEVELS`].
pub(crate) fn parse(source: &Source) -> Result<Document<'_>, Problems> {
    if let Some(place) = too_many_attributes(source.text()) {
        let message = format!("an element with more than {MOST_ATTRIBUTES} attributes");
        return Err(source.problem(place, message, None).into());
    }
    let options = ParsingOptions {
        nodes_limit: MOST_NODES,
        ..ParsingOptions::default()
    };
    let document = Document::parse_with_options(source.text(), options).map_err(|error| {
        let at = offset(source.text(), error.pos().row, error.pos().col);
        // The place precedes the message already.
        let text = error.to_string();
        let message = text
            .rsplit_once(" at ")
            .map_or(text.as_str(), |(before, _)| before);
        let hint =
            "the XML is broken there or just before: a tag left open, a quote or `<` too many".to_owned();
        Problems::from(source.problem(at..at, format!("not XML: {message}"), Some(hint)))
    })?;
    match too_deep(&document) {
        Some(place) => {
            let message = format!("elements nest deeper than {MOST_LEVELS} levels");
            Err(source.problem(place, message, None).into())
        }
        None => Ok(document),
    }
}

/// Where an element begins that has too many attributes, by its quotes: the parser compares each with all others.
///
/// Not exact: quotes in the text behind an element count as well, up to the next one.
fn too_many_attributes(text: &str) -> Option<Range<usize>> {
    let mut at = 0;
    for piece in text.split_inclusive('<') {
        let quotes = piece.bytes().filter(|byte| matches!(byte, b'"' | b'\'')).count();
        // Comments may contain any text.
        if quotes > 2 * MOST_ATTRIBUTES && !piece.starts_with(['!', '?']) {
            return Some(at..at);
        }
        at += piece.len();
    }
    None
}

/// The position of an element that is nested in too many others.
fn too_deep(document: &Document<'_>) -> Option<Range<usize>> {
    let mut front = vec![(document.root(), 0)];
    while let Some((node, level)) = front.pop() {
        if level > MOST_LEVELS {
            return Some(tag(node));
        }
        let inside = node.children().filter(Node::is_element);
        front.extend(inside.map(|child| (child, level + 1)));
    }
    None
}

/// The byte at a line and column, both counted from 1.
///
/// Columns count characters; a place past the end of the text counts as its end.
fn offset(text: &str, row: u32, column: u32) -> usize {
    let before: usize = text
        .split_inclusive('\n')
        .take(row.saturating_sub(1) as usize)
        .map(str::len)
        .sum();
    let rest = text.get(before..).unwrap_or_default();
    let within = rest.char_indices().nth(column.saturating_sub(1) as usize);
    before + within.map_or(rest.len(), |(at, _)| at)
}

/// The elements inside `node` that are called `name`, whatever their namespace.
pub(crate) fn children<'a, 'input: 'a>(
    node: Node<'a, 'input>,
    name: &'a str,
) -> impl Iterator<Item = Node<'a, 'input>> {
    node.children()
        .filter(move |child| child.is_element() && child.tag_name().name() == name)
}

/// The position of the start tag of an element.
///
/// From `<` to the end of its name; it ends early where the name has a prefix.
pub(crate) fn tag(node: Node<'_, '_>) -> Range<usize> {
    let start = node.range().start;
    start..start + 1 + node.tag_name().name().len()
}

/// The position of the value of an attribute; the start tag if there is no such attribute.
pub(crate) fn value_place(node: Node<'_, '_>, attribute: &str) -> Range<usize> {
    node.attribute_node(attribute)
        .map_or_else(|| tag(node), |found| found.range_value())
}

/// The text of an attribute that must be there.
///
/// # Errors
/// The attribute is missing.
pub(crate) fn required<'a>(
    source: &Source,
    node: Node<'a, '_>,
    attribute: &str,
) -> Result<&'a str, Problems> {
    node.attribute(attribute).ok_or_else(|| {
        let message = format!("<{}> has no attribute `{attribute}`", node.tag_name().name());
        source.problem(tag(node), message, None).into()
    })
}

/// The numbers of an attribute, or `default` where it is left out.
///
/// # Errors
/// Another number of values than required, or what is not a finite number.
pub(crate) fn numbers<const N: usize>(
    source: &Source,
    node: Node<'_, '_>,
    attribute: &str,
    default: [f64; N],
) -> Result<[f64; N], Problems> {
    let Some(text) = node.attribute(attribute) else {
        return Ok(default);
    };
    let refused = |message: String| -> Problems {
        let hint = if text.contains("${") || text.contains("$(") {
            "an expression that was not evaluated: save the file with the ending .xacro"
        } else {
            "numbers with a decimal point, blanks between them"
        };
        source
            .problem(value_place(node, attribute), message, Some(hint.to_owned()))
            .into()
    };
    let values: Vec<f64> = text
        .split_whitespace()
        .map(|word| match word.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(refused(format!(
                "`{word}` in {attribute}=\"{text}\" is not a number"
            ))),
        })
        .collect::<Result<_, _>>()?;
    let count = values.len();
    <[f64; N]>::try_from(values).map_err(|_| {
        refused(format!(
            "{attribute}=\"{text}\" has {count} numbers: {N} required"
        ))
    })
}

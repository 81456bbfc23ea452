//! Lists of numbers in the text of an element, with the place of what is wrong.

use std::ops::Range;

use roxmltree::Node;

use super::super::text_lines::{NUMBERS, coordinate};
use crate::document::{Problems, Source};
use crate::xml::tag;

/// The words of an element's text, between blanks, without its comments.
fn words<'a>(node: Node<'a, '_>) -> impl Iterator<Item = &'a str> {
    let texts = node.children().filter_map(|child| match child.is_text() {
        true => child.text(),
        false => None,
    });
    texts.flat_map(str::split_ascii_whitespace)
}

/// Where a word of an element is; the start tag if it is not a part of the text (it contained `&`).
fn place(source: &Source, node: Node<'_, '_>, word: &str) -> Range<usize> {
    let before = word.as_ptr().addr().wrapping_sub(source.text().as_ptr().addr());
    match before < source.text().len() {
        true => before..before + word.len(),
        false => tag(node),
    }
}

/// The coordinates in the text of an element.
///
/// # Errors
/// The first that is not accepted.
pub(super) fn coordinates(source: &Source, node: Node<'_, '_>) -> Result<Vec<f64>, Problems> {
    words(node)
        .map(|word| {
            coordinate(word.as_bytes()).map_err(|message| -> Problems {
                source
                    .problem(place(source, node, word), message, Some(NUMBERS.to_owned()))
                    .into()
            })
        })
        .collect()
}

/// The indices in the text of an element.
///
/// # Errors
/// The first that is not a whole number from 0.
pub(super) fn indices(source: &Source, node: Node<'_, '_>) -> Result<Vec<usize>, Problems> {
    words(node)
        .map(|word| {
            word.parse().map_err(|_| -> Problems {
                let message = format!("`{word}` is not an index");
                let hint = "indices are whole numbers from 0".to_owned();
                source
                    .problem(place(source, node, word), message, Some(hint))
                    .into()
            })
        })
        .collect()
}

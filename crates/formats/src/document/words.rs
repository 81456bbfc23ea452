//! How shapes and values are called in a message: `an array of 3 numbers in mm`, `the string "3"`.
//!
//! A message reads `expected` [`in_words`], `found` [`found`]. Values are repeated as far as one recognises them, so
//! that a value as long as its file does not bury what is wrong with it.

use super::shape::{ListShape, Shape, Shapes};
use super::tree::Value;
use serde_json::Value as Json;

/// Characters of a value that a message repeats.
const LONGEST_SHOWN: usize = 40;

/// A shape with its article: `a number in mm`, `one of "map", "path"`.
///
/// The unit is added to numbers and lists of them, never to texts or tables.
pub(super) fn in_words(shapes: &Shapes, shape: &Shape, unit: Option<&str>) -> String {
    match shapes.resolved(shape) {
        Shape::Any | Shape::Named(_) => "a value".to_owned(),
        Shape::Number(_) => in_unit("a number", unit),
        Shape::Integer(_) => in_unit("a whole number", unit),
        Shape::Text { .. } => "a string".to_owned(),
        Shape::Flag => "true or false".to_owned(),
        Shape::Choice(choices) => choices_in_words(choices),
        Shape::List(list) => list_in_words(shapes, list, unit),
        Shape::Table(_) | Shape::Tagged(_) => "a table".to_owned(),
        Shape::OneOf(alternatives) => {
            let mut words: Vec<String> = Vec::new();
            for alternative in alternatives {
                // An alternative within an alternative is only called a value: a type may be its own alternative.
                let alternative = match shapes.resolved(alternative) {
                    Shape::OneOf(_) => &Shape::Any,
                    other => other,
                };
                let word = in_words(shapes, alternative, unit);
                if !words.contains(&word) {
                    words.push(word);
                }
            }
            words.join(" or ")
        }
    }
}

/// `an array of 3 numbers in mm`, `an array of at least 2 tables`.
/// The count is that of the schema; what the entries are called is taken from the first.
fn list_in_words(shapes: &Shapes, list: &ListShape, unit: Option<&str>) -> String {
    let count = match (list.fewest, list.most) {
        (fewest, Some(most)) if fewest == most => format!("{most} "),
        (0, Some(most)) => format!("at most {most} "),
        (0, None) => String::new(),
        (fewest, Some(most)) => format!("{fewest} to {most} "),
        (fewest, None) => format!("at least {fewest} "),
    };
    let entries = plural(shapes, list.first.first().unwrap_or(&list.others));
    in_unit(
        &format!("an array of {count}{entries}"),
        unit.filter(|_| entries.contains("number")),
    )
}

/// What the entries of a list are called.
///
/// One list deeper at most: a matrix is `arrays of numbers`, a list of points `arrays of 3 numbers`.
fn plural(shapes: &Shapes, shape: &Shape) -> &'static str {
    match shapes.resolved(shape) {
        Shape::Number(_) => "numbers",
        Shape::Integer(_) => "whole numbers",
        Shape::Text { .. } | Shape::Choice(_) => "strings",
        Shape::List(list) => match (list.fewest, list.most, plural_of_entries(shapes, list)) {
            (3, Some(3), "numbers") => "arrays of 3 numbers",
            (_, _, "numbers") => "arrays of numbers",
            _ => "arrays",
        },
        Shape::Table(_) | Shape::Tagged(_) => "tables",
        _ => "values",
    }
}

/// What the entries of an inner list are called, if they have a name.
fn plural_of_entries(shapes: &Shapes, list: &ListShape) -> &'static str {
    match shapes.resolved(list.first.first().unwrap_or(&list.others)) {
        Shape::Number(_) => "numbers",
        _ => "entries",
    }
}

/// `"map"` or `one of "map", "path"`.
pub(super) fn choices_in_words(choices: &[Json]) -> String {
    let words: Vec<String> = choices.iter().map(Json::to_string).collect();
    if words.len() == 1 {
        words.join("")
    } else {
        format!("one of {}", words.join(", "))
    }
}

/// What is in the file, with its kind: `the string "3 mm"`, `an array of 2 entries`.
pub(super) fn found(value: &Value) -> String {
    match value {
        Value::Text(text) => format!("the string {:?}", shortened(text)),
        Value::Whole(whole) => format!("the number {whole}"),
        Value::Real(real) => format!("the number {real:?}"),
        Value::Flag(flag) => flag.to_string(),
        Value::Date(date) => format!("the date {date}"),
        Value::List(entries) if entries.len() == 1 => "an array of 1 entry".to_owned(),
        Value::List(entries) => format!("an array of {} entries", entries.len()),
        Value::Table(_) => "a table".to_owned(),
    }
}

/// The first 40 characters of a text.
pub(super) fn shortened(text: &str) -> String {
    match text.char_indices().nth(LONGEST_SHOWN) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}

/// `3 mm`, or `3` without a unit.
pub(super) fn with_unit(number: &str, unit: Option<&str>) -> String {
    match unit {
        Some(unit) => format!("{} {unit}", shortened(number)),
        None => shortened(number),
    }
}

/// `a number in mm`.
fn in_unit(noun: &str, unit: Option<&str>) -> String {
    match unit {
        Some(unit) => format!("{noun} in {unit}"),
        None => noun.to_owned(),
    }
}

//! Compares a document's tree with the shape it should have and collects every difference.
//!
//! Value by value from the root: a value of the wrong kind is reported and not looked into; of a table, its fields,
//! then what is unknown, then what is missing. Where a value may have several shapes, the problems of the one with the
//! fewest are reported. Numbers that are not finite are reported everywhere, also where any value is accepted.
//!
//! | part of the tree | what is compared |
//! |---|---|
//! | number | its kind, then its range; a whole number is a number too, the other way it is not |
//! | text | its length in characters, or whether it is one of the names |
//! | list | the count of its entries, then every entry |
//! | table | known fields, unknown ones, missing ones; a tagged one by the variant that its tag names |
//!
//! Every message is `path: the value, the requirement`, with the unit that the field's name ends with; so a number in
//! a list has the unit of the list.

use std::ops::Range;

use serde_json::Value as Json;

use super::path::joined;
use super::problem::Problem;
use super::shape::{ExtraFields, Limits, ListShape, Shape, Shapes, TableShape, TaggedShape};
use super::source::Source;
use super::tree::{Node, Table, Value};
use super::unit;
use super::words::{choices_in_words, found, in_words, shortened, with_unit};

/// A file with more problems than this is not the file that was meant.
const MOST_PROBLEMS: usize = 1000;

/// Shapes within shapes, deeper than any document can be: only a type that is its own alternative goes there.
const MOST_LEVELS: usize = 256;

/// Known fields are listed in a hint only when they are no more than this.
const MOST_FIELDS_IN_HINT: usize = 12;

/// Everything in which the tree differs from the shape, and every number that is not finite; at most 1000.
///
/// In the order of the walk, not of the text: the caller that makes `Problems` of them sorts them.
pub(super) fn all_problems(source: &Source, root: &Node, shapes: &Shapes) -> Vec<Problem> {
    let mut checker = Checker {
        source,
        shapes,
        problems: Vec::new(),
    };
    checker.finite(root, "");
    checker.value(
        root,
        &shapes.root,
        &ValuePosition {
            path: "",
            field: "",
            level: 0,
        },
    );
    checker.problems.truncate(MOST_PROBLEMS);
    checker.problems
}

/// Walks the tree and collects; one more of them is made for each alternative that is tried, so that its problems stay
/// apart until the closest is known.
struct Checker<'a> {
    /// Shows values as they are written, and places problems.
    source: &'a Source,
    shapes: &'a Shapes,
    problems: Vec<Problem>,
}

/// The current position: the path in the document, the field it is in, and how many shapes enclose it.
struct ValuePosition<'a> {
    /// As messages show it: `analysis[2].x_mm[0]`, empty at the root.
    path: &'a str,
    /// The name that carries the unit: `x_mm` for the path `analysis[2].x_mm[0]`.
    field: &'a str,
    /// Shapes around this one, up to [`MOST_LEVELS`].
    level: usize,
}

impl ValuePosition<'_> {
    /// The unit of the value, as people read it.
    fn unit(&self) -> Option<String> {
        unit::of_value(self.field, self.path)
    }
}

impl Checker<'_> {
    /// Keeps a problem; beyond 1000 none.
    fn report(&mut self, span: Range<usize>, message: String, hint: Option<String>) {
        if self.problems.len() < MOST_PROBLEMS {
            self.problems.push(self.source.problem(span, message, hint));
        }
    }

    /// No number may be nan or infinite, anywhere.
    ///
    /// A separate walk, before any shape is considered: where any value is accepted, or a value is of the wrong kind
    /// and its entries are not checked, such a number would not be found otherwise.
    fn finite(&mut self, value: &Node, path: &str) {
        match &value.value {
            Value::Real(real) if !real.is_finite() => {
                let written = shortened(&self.source.text()[value.span.clone()]);
                let message = format!("`{path}` is {written}: must be a finite number");
                self.report(value.span.clone(), message, None);
            }
            Value::List(entries) => {
                for (index, entry) in entries.iter().enumerate() {
                    self.finite(entry, &format!("{path}[{index}]"));
                }
            }
            Value::Table(table) => {
                for (key, entry) in table {
                    self.finite(&entry.node, &joined(path, key));
                }
            }
            _ => {}
        }
    }

    /// Compares a value with its shape, down to its last entry.
    ///
    /// `Shape::Any` fits everything. The order of the arms matters: a choice and alternatives check values of any kind,
    /// the other shapes only those of their own, and what is left is of the wrong kind.
    fn value(&mut self, value: &Node, shape: &Shape, place: &ValuePosition<'_>) {
        if place.level > MOST_LEVELS || self.problems.len() >= MOST_PROBLEMS {
            return;
        }
        match (self.shapes.resolved(shape), &value.value) {
            (Shape::Any, _) | (Shape::Flag, Value::Flag(_)) => {}
            // A number that is not finite was reported as such.
            (Shape::Number(_), Value::Real(real)) if !real.is_finite() => {}
            (Shape::Number(limits), Value::Real(real)) => self.limits(value, limits, place, *real),
            (Shape::Number(limits) | Shape::Integer(limits), Value::Whole(whole)) => {
                self.limits(value, limits, place, *whole as f64);
            }
            (Shape::Text { shortest, longest }, Value::Text(text)) => {
                let length = text.chars().count() as u64;
                if length < *shortest || longest.is_some_and(|longest| length > longest) {
                    let limit = match longest {
                        Some(longest) => format!("between {shortest} and {longest}"),
                        None => format!("at least {shortest}"),
                    };
                    let message = format!("`{}` has {length} characters: must have {limit}", place.path);
                    self.report(value.span.clone(), message, None);
                }
            }
            (Shape::Choice(choices), _) => self.choice(value, choices, place),
            (Shape::List(list), Value::List(entries)) => self.list(value, list, entries, place),
            (Shape::Table(shape), Value::Table(table)) => self.table(value.span.clone(), table, shape, place),
            (Shape::Tagged(shape), Value::Table(table)) => {
                self.tagged(value.span.clone(), table, shape, place);
            }
            (Shape::OneOf(alternatives), _) => self.one_of(value, alternatives, place),
            (shape, _) => self.wrong_type(value, shape, place),
        }
    }

    /// A value of another kind than required: what was expected, what was found, and the likely mistake.
    fn wrong_type(&mut self, value: &Node, shape: &Shape, place: &ValuePosition<'_>) {
        let expected = in_words(self.shapes, shape, place.unit().as_deref());
        let message = format!(
            "`{}`: expected {expected}, found {}",
            place.path,
            found(&value.value)
        );
        let hint = match (shape, &value.value) {
            (Shape::Number(_) | Shape::Integer(_), Value::Text(text))
                if text.trim().parse::<f64>().is_ok() =>
            {
                Some(format!("write the number without quotes: `{}`", text.trim()))
            }
            (Shape::Integer(_), Value::Real(_)) => Some("write it without a decimal point".to_owned()),
            (Shape::List(list), Value::Whole(_) | Value::Real(_)) if list.fewest <= 1 => Some(format!(
                "write a list: `[{}]`",
                &self.source.text()[value.span.clone()]
            )),
            (Shape::List(_), Value::Table(_)) => {
                Some(format!("tables that repeat are written `[[{}]]`", place.path))
            }
            _ => None,
        };
        self.report(value.span.clone(), message, hint);
    }

    /// A number outside its range, as it is written in the file, with the limit and the unit of its field.
    fn limits(&mut self, value: &Node, limits: &Limits, place: &ValuePosition<'_>, number: f64) {
        let limit = match limits {
            Limits {
                at_least: Some(limit),
                ..
            } if number < *limit => ("at least", limit),
            Limits {
                above: Some(limit), ..
            } if number <= *limit => ("above", limit),
            Limits {
                at_most: Some(limit), ..
            } if number > *limit => ("at most", limit),
            Limits {
                below: Some(limit), ..
            } if number >= *limit => ("below", limit),
            _ => return,
        };
        let unit = place.unit();
        let given = with_unit(&self.source.text()[value.span.clone()], unit.as_deref());
        let requested = with_unit(&limit.1.to_string(), unit.as_deref());
        let message = format!("`{}` is {given}: must be {} {requested}", place.path, limit.0);
        self.report(value.span.clone(), message, None);
    }

    /// A value that is none of those allowed, with the most similar of them.
    fn choice(&mut self, value: &Node, choices: &[Json], place: &ValuePosition<'_>) {
        let given = &value.value;
        if choices.iter().any(|choice| same(choice, given)) {
            return;
        }
        let message = format!(
            "`{}` is {}: must be {}",
            place.path,
            found(given),
            choices_in_words(choices)
        );
        let names: Vec<&str> = choices.iter().filter_map(Json::as_str).collect();
        let suggestion = match given {
            Value::Text(text) => {
                unit::renamed(text, names.iter().copied()).or_else(|| unit::suggestion(text, &names))
            }
            _ => None,
        };
        self.report(
            value.span.clone(),
            message,
            suggestion.map(|(name, _)| format!("did you mean \"{name}\"?")),
        );
    }

    /// A list with too few or too many entries is reported once; those that it has are compared all the same. Entries
    /// beyond the shapes of the first have the common one.
    fn list(&mut self, value: &Node, list: &ListShape, entries: &[Node], place: &ValuePosition<'_>) {
        let count = entries.len() as u64;
        if count < list.fewest || list.most.is_some_and(|most| count > most) {
            let expected = in_words(
                self.shapes,
                &Shape::List(Box::new(list.clone())),
                place.unit().as_deref(),
            );
            let noun = if count == 1 { "entry" } else { "entries" };
            let message = format!("`{}` has {count} {noun}: expected {expected}", place.path);
            self.report(
                value.span.clone(),
                message,
                pose_hint(value, entries, place, self.source),
            );
        }
        for (index, entry) in entries.iter().enumerate() {
            let shape = list.first.get(index).unwrap_or(&list.others);
            let path = format!("{}[{index}]", place.path);
            self.value(
                entry,
                shape,
                &ValuePosition {
                    path: &path,
                    field: place.field,
                    level: place.level + 1,
                },
            );
        }
    }

    /// The fields of a table whose header is at `span`.
    ///
    /// An unknown field goes with the most similar known one that is absent, unit included: `step` for `step_mm`.
    /// Missing fields are reported at the header, with the first line of what the field means.
    fn table(&mut self, span: Range<usize>, table: &Table, shape: &TableShape, place: &ValuePosition<'_>) {
        let absent: Vec<&str> = shape
            .fields
            .keys()
            .map(String::as_str)
            .filter(|name| table.get(*name).is_none())
            .collect();
        let mut misspelled = Vec::new();
        for (key, entry) in table {
            let path = joined(place.path, key);
            let inner = ValuePosition {
                path: &path,
                field: key,
                level: place.level + 1,
            };
            match (shape.fields.get(key), &shape.others) {
                (Some(field), _) => self.value(&entry.node, &field.shape, &inner),
                (None, ExtraFields::Each(each)) => self.value(&entry.node, each, &inner),
                (None, ExtraFields::Any) => {}
                (None, ExtraFields::Refused) => {
                    let suggestion = unit::renamed(key, shape.fields.keys().map(String::as_str))
                        .or_else(|| unit::suggestion(key, &absent));
                    misspelled.extend(suggestion.as_ref().map(|(meant, _)| *meant));
                    let hint = suggestion
                        .map(|(_, advice)| advice)
                        .or_else(|| known_fields(shape));
                    self.report(entry.key_span.clone(), format!("unknown field `{path}`"), hint);
                }
            }
        }
        // A field whose misspelling was reported is not reported again as missing.
        for name in absent
            .iter()
            .filter(|name| shape.required.contains(**name) && !misspelled.contains(name))
        {
            let field = &shape.fields[*name];
            let path = joined(place.path, name);
            let unit = unit::split(name).map(|(_, unit)| unit.shown);
            let expected = in_words(self.shapes, &field.shape, unit.as_deref());
            let hint = field
                .meaning
                .as_ref()
                .map(|meaning| format!("`{name}` is: {meaning}"));
            self.report(span.clone(), format!("missing field `{path}`: {expected}"), hint);
        }
    }

    /// A table whose field `tag` says which of the variants it is; without a known tag its other fields are not
    /// checked.
    fn tagged(&mut self, span: Range<usize>, table: &Table, shape: &TaggedShape, place: &ValuePosition<'_>) {
        let TaggedShape { tag, variants } = shape;
        let names: Vec<Json> = variants.iter().map(|(name, _)| name.as_str().into()).collect();
        let path = joined(place.path, tag);
        match table.get(tag) {
            None => {
                let hint = format!("`{tag}` says which kind of table this is and so which fields it has");
                self.report(
                    span,
                    format!("missing field `{path}`: {}", choices_in_words(&names)),
                    Some(hint),
                );
            }
            Some(given) => {
                let given = &given.node;
                let variant = variants
                    .iter()
                    .find(|(name, _)| matches!(&given.value, Value::Text(text) if text == name));
                match variant {
                    Some((_, shape)) => self.table(span, table, shape, place),
                    None => {
                        self.choice(
                            given,
                            &names,
                            &ValuePosition {
                                path: &path,
                                field: tag,
                                level: place.level,
                            },
                        );
                    }
                }
            }
        }
    }

    /// The problems of the alternative that comes closest; none if one of them fits.
    ///
    /// Only alternatives of the value's kind are tried; where there is none, all are named as what was expected. Of
    /// those with equally many problems the first counts.
    fn one_of(&mut self, value: &Node, alternatives: &[Shape], place: &ValuePosition<'_>) {
        let mut closest: Option<Vec<Problem>> = None;
        let fitting = alternatives
            .iter()
            .filter(|shape| self.shapes.resolved(shape).fits_kind_of(&value.value));
        for shape in fitting {
            // A checker of its own, so that the problems of an alternative that was not meant are forgotten.
            let mut trial = Checker {
                source: self.source,
                shapes: self.shapes,
                problems: Vec::new(),
            };
            trial.value(
                value,
                shape,
                &ValuePosition {
                    level: place.level + 1,
                    ..*place
                },
            );
            if closest
                .as_ref()
                .is_none_or(|problems| trial.problems.len() < problems.len())
            {
                closest = Some(trial.problems);
            }
            if closest.as_ref().is_some_and(Vec::is_empty) {
                return;
            }
        }
        match closest {
            Some(problems) => self.problems.extend(problems),
            None => self.wrong_type(value, &Shape::OneOf(alternatives.to_vec()), place),
        }
    }
}

/// Whether a value is this choice; an integer does not match a number that the schema writes with a decimal point.
fn same(choice: &Json, given: &Value) -> bool {
    match given {
        Value::Text(text) => choice.as_str() == Some(text),
        Value::Flag(flag) => choice.as_bool() == Some(*flag),
        Value::Whole(whole) => choice.as_i64().map(i128::from) == Some(*whole),
        Value::Real(real) => choice.as_f64() == Some(*real),
        _ => false,
    }
}

/// A hint for a pose of three numbers: its rotations are missing.
fn pose_hint(value: &Node, entries: &[Node], place: &ValuePosition<'_>, source: &Source) -> Option<String> {
    let is_number = |entry: &Node| matches!(entry.value, Value::Whole(_) | Value::Real(_));
    let is_position = place.field.ends_with("_mm_deg") && entries.len() == 3 && entries.iter().all(is_number);
    let text = source.text().get(value.span.clone())?;
    let numbers = text.strip_suffix(']')?.trim_end().trim_end_matches(',');
    is_position.then(|| format!("add the rotations in deg: `{numbers}, 0, 0, 0]`"))
}

/// A hint that lists the fields of a table, unless they are many.
fn known_fields(shape: &TableShape) -> Option<String> {
    let names: Vec<String> = shape.fields.keys().map(|name| format!("`{name}`")).collect();
    match names.len() {
        0 => Some("this table has no fields".to_owned()),
        1..=MOST_FIELDS_IN_HINT => Some(format!("the fields here are {}", names.join(", "))),
        _ => None,
    }
}

//! Shapes put together: alternatives into a choice, and the fields of flattened tables into one table.
//!
//! schemars writes an enum as alternatives (`oneOf`, `anyOf`) and serde's `flatten` as fields next to a reference.
//! Messages are clearer for simpler shapes: for names `one of "a", "b"`, for a tagged table the fields of its one
//! variant, so both are brought together here, where a schema is read, and not where a document is checked.

use std::collections::BTreeSet;

use super::shape::{ExtraFields, Shape, TableShape, TaggedShape};

/// The simplest shape for a choice: one shape, a list of names, a tagged table, or the alternatives as they are.
///
/// Names of all alternatives become one list, which is first; nested alternatives are flattened.
/// Tables become tagged only where nothing but tables is offered. No shape at all is [`Shape::Any`].
pub(super) fn one_of(shapes: Vec<Shape>) -> Shape {
    let mut choices = Vec::new();
    let mut rest = Vec::new();
    for shape in shapes {
        match shape {
            Shape::Choice(more) => choices.extend(more),
            Shape::OneOf(more) => rest.extend(more),
            other => rest.push(other),
        }
    }
    if let Some(tagged) = tagged(&rest).filter(|_| choices.is_empty()) {
        return tagged;
    }
    if !choices.is_empty() {
        rest.insert(0, Shape::Choice(choices));
    }
    match rest.len() {
        0 => Shape::Any,
        1 => rest.remove(0),
        _ => Shape::OneOf(rest),
    }
}

/// The tagged table that tables make which all require one field with a text of their own.
///
/// `None` where one is not a table, or no field that the first requires distinguishes all of them. The texts must
/// differ from table to table: else the tag would not say which one is meant.
fn tagged(shapes: &[Shape]) -> Option<Shape> {
    let tables: Vec<&TableShape> = shapes
        .iter()
        .map(|shape| match shape {
            Shape::Table(table) => Some(table),
            _ => None,
        })
        .collect::<Option<_>>()?;
    let only_text = |table: &TableShape, field: &str| match &table.fields.get(field)?.shape {
        Shape::Choice(choices) if choices.len() == 1 => Some(choices[0].as_str()?.to_owned()),
        _ => None,
    };
    let tag = tables.first()?.required.iter().find(|field| {
        let texts: Option<BTreeSet<String>> = tables.iter().map(|table| only_text(table, field)).collect();
        texts.is_some_and(|texts| texts.len() == tables.len())
    })?;
    let variants = tables
        .iter()
        .filter_map(|table| Some((only_text(table, tag)?, (*table).clone())))
        .collect();
    Some(Shape::Tagged(TaggedShape {
        tag: tag.clone(),
        variants,
    }))
}

/// A table with the fields of another shape in addition to its own; `None` where that shape is not a table.
///
/// Of a tagged table every variant gets them.
pub(super) fn merged(table: &TableShape, shape: &Shape) -> Option<Shape> {
    match shape {
        Shape::Table(other) => Some(Shape::Table(union(table, other))),
        Shape::Tagged(TaggedShape { tag, variants }) => Some(Shape::Tagged(TaggedShape {
            tag: tag.clone(),
            variants: variants
                .iter()
                .map(|(name, other)| (name.clone(), union(table, other)))
                .collect(),
        })),
        _ => None,
    }
}

/// Fields and duties of both; a field of the same name is taken from `other`. What else may be there `table` says,
/// unless it leaves that open and `other` is a map.
fn union(table: &TableShape, other: &TableShape) -> TableShape {
    let mut union = table.clone();
    union.fields.extend(other.fields.clone());
    union.required.extend(other.required.iter().cloned());
    if let ExtraFields::Any = union.others {
        // Only the table that says so itself refuses: the other one speaks for its own fields.
        if let ExtraFields::Each(shape) = &other.others {
            union.others = ExtraFields::Each(shape.clone());
        }
    }
    union
}

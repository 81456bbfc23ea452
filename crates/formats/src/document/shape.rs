//! What a value must look like: the few cases of a JSON schema that a TOML file knows.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;

use super::tree;

/// The shape of a document and the named shapes it refers to.
#[derive(Debug)]
pub(super) struct Shapes {
    pub(super) root: Shape,
    /// Those of `$defs`, by their key there.
    pub(super) named: BTreeMap<String, Shape>,
}

/// What one value must look like.
#[derive(Debug, Clone)]
pub(super) enum Shape {
    /// Anything.
    Any,
    /// Written with or without a point.
    Number(Limits),
    /// Written without a point.
    Integer(Limits),
    /// A text, its length counted in characters.
    Text {
        shortest: u64,
        longest: Option<u64>,
    },
    /// `true` or `false`.
    Flag,
    /// One of these strings, numbers or flags.
    Choice(Vec<Value>),
    List(Box<ListShape>),
    Table(TableShape),
    /// A table in which the text of one field decides what the others are.
    Tagged(TaggedShape),
    /// Any of these.
    OneOf(Vec<Shape>),
    /// One of the named shapes of [`Shapes`], which may contain itself.
    Named(String),
}

/// Tables of which the text of one field selects one.
#[derive(Clone, Debug)]
pub(super) struct TaggedShape {
    /// Name of the field that decides.
    pub tag: String,
    /// Text of the tag, and the table that it represents, the tag among its fields.
    pub variants: Vec<(String, TableShape)>,
}

/// A list: the first entries may have their own shapes, all others have one.
#[derive(Debug, Clone)]
pub(super) struct ListShape {
    /// Shapes of the first entries, one each, as of a tuple.
    pub(super) first: Vec<Shape>,
    pub(super) others: Shape,
    /// Entries that must be there; 0 if the schema does not say.
    pub(super) fewest: u64,
    /// Entries that may be there; `None`: any number.
    pub(super) most: Option<u64>,
}

/// A table: its known fields, those that must be there, and what else may be.
#[derive(Debug, Clone, Default)]
pub(super) struct TableShape {
    pub(super) fields: BTreeMap<String, Field>,
    pub(super) required: BTreeSet<String>,
    pub(super) others: ExtraFields,
}

/// A known field.
#[derive(Debug, Clone)]
pub(super) struct Field {
    pub(super) shape: Shape,
    /// The first line of its documentation.
    pub(super) meaning: Option<String>,
}

/// Which fields are allowed in addition to the known ones.
#[derive(Debug, Clone, Default)]
pub(super) enum ExtraFields {
    #[default]
    Any,
    /// There may be none.
    Refused,
    /// Any name, and every one of this shape: a map.
    Each(Box<Shape>),
}

/// The range of a number; an end that is `None` is open.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Limits {
    pub(super) at_least: Option<f64>,
    pub(super) above: Option<f64>,
    pub(super) at_most: Option<f64>,
    pub(super) below: Option<f64>,
}

impl Shapes {
    /// The shape itself where another is only named; [`Shape::Any`] for names that lead nowhere.
    pub(super) fn resolved<'a>(&'a self, shape: &'a Shape) -> &'a Shape {
        let mut shape = shape;
        for _ in 0..=self.named.len() {
            let Shape::Named(name) = shape else { return shape };
            match self.named.get(name) {
                Some(target) => shape = target,
                None => break,
            }
        }
        &Shape::Any
    }
}

impl Shape {
    /// Whether this shape is of the same kind as a value, so that its problems are useful.
    ///
    /// `Any`, `Named` and `OneOf` accept any kind. For choices of names and numbers the kind is compared, not the
    /// value: a misspelled name is a better match than a table.
    pub(super) fn fits_kind_of(&self, value: &tree::Value) -> bool {
        match self {
            Self::Any | Self::Named(_) | Self::OneOf(_) => true,
            Self::Number(_) => matches!(value, tree::Value::Real(_) | tree::Value::Whole(_)),
            Self::Integer(_) => matches!(value, tree::Value::Whole(_)),
            Self::Text { .. } => matches!(value, tree::Value::Text(_)),
            Self::Flag => matches!(value, tree::Value::Flag(_)),
            Self::List(_) => matches!(value, tree::Value::List(_)),
            Self::Table(_) | Self::Tagged(_) => matches!(value, tree::Value::Table(_)),
            Self::Choice(choices) => choices.iter().any(|choice| match choice {
                Value::String(_) => matches!(value, tree::Value::Text(_)),
                Value::Number(_) => matches!(value, tree::Value::Whole(_) | tree::Value::Real(_)),
                _ => matches!(value, tree::Value::Flag(_)),
            }),
        }
    }
}

//! Expressions: numbers, lists, names with components, calls; all others are computed on the controller.

use std::ops::Range;

/// An expression and its position.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub value: Value,
    pub bytes: Range<usize>,
}

/// Kind of expression.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Number(f64),
    List(Vec<Node>),
    Name(Reference),
    Call(String, Vec<Argument>),
    /// Computed on the controller.
    Other,
    /// Invalid, and reported as a problem.
    Wrong,
}

/// A variable, or a part of it; names in lower case.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Reference {
    pub name: String,
    pub steps: Vec<Step>,
}

/// Selects a part of a value.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Step {
    /// `.name`
    Field(String),
    /// `{3}`, from 1.
    Index(usize),
    /// An index that is computed.
    Unknown,
}

/// An argument: `\Name:=value`, `\Name` or a value.
#[derive(Clone, Debug)]
pub(super) struct Argument {
    /// In lower case.
    pub name: Option<String>,
    pub value: Option<Node>,
}

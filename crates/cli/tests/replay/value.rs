//! Values of the languages, and expressions of numbers.

use std::collections::BTreeMap;

use crate::pose::Pose;
use crate::source::ReplayError;
use crate::words::{Cursor, Word};

#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    Number(f64),
    Truth(bool),
    Text(String),
    List(Vec<Value>),
    /// Components by their names in capital letters.
    Record(BTreeMap<String, f64>),
    Pose(Pose),
}

impl Value {
    pub fn number(&self, cursor: &Cursor) -> Result<f64, ReplayError> {
        match self {
            Value::Number(number) => Ok(*number),
            other => Err(cursor.error(format!("a number expected, found {other:?}"))),
        }
    }

    /// Numbers of a list without lists in it; `None` for any other value.
    pub fn numbers(&self) -> Option<Vec<f64>> {
        let Value::List(values) = self else { return None };
        let number = |value: &Value| match value {
            Value::Number(number) => Some(*number),
            _ => None,
        };
        values.iter().map(number).collect()
    }

    /// As an output has it: TRUE, FALSE, a number.
    pub fn as_output(&self) -> Option<String> {
        match self {
            Value::Truth(truth) => Some(truth_word(*truth)),
            Value::Number(number) => Some(number.to_string()),
            _ => None,
        }
    }
}

/// A state of an output.
pub fn truth_word(truth: bool) -> String {
    if truth { "TRUE" } else { "FALSE" }.to_owned()
}

/// What a name, call or bracket gives in a language.
pub type Atom<'a> = &'a mut dyn FnMut(&mut Cursor) -> Result<Value, ReplayError>;

/// Sums and products of numbers, or any other value alone.
pub fn expression(cursor: &mut Cursor, atom: Atom<'_>) -> Result<Value, ReplayError> {
    let mut left = product(cursor, atom)?;
    loop {
        let sign = if cursor.eat("+") {
            1.0
        } else if cursor.eat("-") {
            -1.0
        } else {
            return Ok(left);
        };
        let right = product(cursor, atom)?.number(cursor)?;
        left = Value::Number(left.number(cursor)? + sign * right);
    }
}

fn product(cursor: &mut Cursor, atom: Atom<'_>) -> Result<Value, ReplayError> {
    let mut left = factor(cursor, atom)?;
    loop {
        if cursor.eat("*") {
            let right = factor(cursor, atom)?.number(cursor)?;
            left = Value::Number(left.number(cursor)? * right);
        } else if cursor.eat("/") {
            let right = factor(cursor, atom)?.number(cursor)?;
            if right == 0.0 {
                return Err(cursor.error("division by zero"));
            }
            left = Value::Number(left.number(cursor)? / right);
        } else {
            return Ok(left);
        }
    }
}

fn factor(cursor: &mut Cursor, atom: Atom<'_>) -> Result<Value, ReplayError> {
    if cursor.eat("-") {
        let value = factor(cursor, atom)?.number(cursor)?;
        return Ok(Value::Number(-value));
    }
    if cursor.eat("+") {
        return factor(cursor, atom);
    }
    if cursor.eat("(") {
        let value = expression(cursor, atom)?;
        cursor.expect(")")?;
        return Ok(value);
    }
    if cursor.eat_name("TRUE") {
        return Ok(Value::Truth(true));
    }
    if cursor.eat_name("FALSE") {
        return Ok(Value::Truth(false));
    }
    match cursor.peek() {
        Some(Word::Number(_)) => Ok(Value::Number(cursor.number()?)),
        Some(Word::Text(_)) => Ok(Value::Text(cursor.text()?)),
        Some(_) => atom(cursor),
        None => Err(cursor.unexpected("a value")),
    }
}

//! Expressions made of numbers, and their values.

use std::ops::Range;

use armill_core::frame::Isometry;
use armill_core::units::{from_deg, to_deg};
use armill_formats::convention::Convention;

use super::read::Reader;
use super::value::{Argument, Posed, Reference, Value};
use crate::program::Spelled;
use crate::tokens::{Cursor, Kind, Token};

/// Maximum nesting of brackets.
const MOST_LEVELS: usize = 40;

/// Maximum length of a stored list: longer than lists of joints and positions.
const LONGEST_LIST: usize = 64;

impl<'a> Reader<'a> {
    /// The arguments up to `)`; the cursor is after `(`.
    pub fn arguments(&mut self, cursor: &mut Cursor<'a>, level: usize) -> Vec<Argument> {
        let mut all = Vec::new();
        while !cursor.pass(')') {
            if cursor.peek().is_none_or(|token| token.is(']')) {
                self.messages.unclosed(cursor.place(), ')');
                break;
            }
            let mut ahead = cursor.clone();
            let name = ahead.peek().filter(|token| token.kind == Kind::Word);
            ahead.next();
            let name = name.filter(|_| ahead.pass('=') && !ahead.pass('='));
            if name.is_some() {
                *cursor = ahead;
            }
            let start = cursor.place().start;
            let value = self.value(cursor, level + 1);
            let bytes = start..cursor.before().max(start);
            all.push(Argument {
                name: name.map(|token| cursor.text[token.span()].to_owned()),
                value: self.past_comma(cursor, value),
                bytes,
            });
        }
        all
    }

    /// Moves to the next entry of a list, past its comma, or to its closing mark. If there are other tokens before it,
    /// the value is not known.
    fn past_comma(&mut self, cursor: &mut Cursor<'a>, value: Value) -> Value {
        let (mut value, mut depth) = (value, 0_usize);
        while let Some(token) = cursor.peek() {
            match token.kind {
                Kind::Mark(')' | ']') if depth == 0 => return value,
                Kind::Mark(',') if depth == 0 => {
                    cursor.next();
                    return value;
                }
                Kind::Mark('(' | '[') => depth += 1,
                Kind::Mark(')' | ']') => depth -= 1,
                _ => {}
            }
            if !matches!(value, Value::Wrong) {
                value = Value::Unknown;
            }
            cursor.next();
        }
        value
    }

    /// The expression at the cursor: sums of products.
    pub fn value(&mut self, cursor: &mut Cursor<'a>, level: usize) -> Value {
        let mut sum = self.product(cursor, level);
        loop {
            let sign = match cursor.peek().map(|token| token.kind) {
                Some(Kind::Mark('+')) => 1.0,
                Some(Kind::Mark('-')) => -1.0,
                _ => return sum,
            };
            cursor.next();
            sum = match (sum, self.product(cursor, level)) {
                (Value::Number(one), Value::Number(other)) => Value::Number(one + sign * other),
                _ => Value::Unknown,
            };
        }
    }

    fn product(&mut self, cursor: &mut Cursor<'a>, level: usize) -> Value {
        let mut product = self.primary(cursor, level);
        loop {
            let divides = match cursor.peek().map(|token| token.kind) {
                Some(Kind::Mark('*')) => false,
                Some(Kind::Mark('/')) => true,
                _ => return product,
            };
            cursor.next();
            let factor = self.primary(cursor, level);
            product = match (product, factor, divides) {
                (Value::Number(one), Value::Number(other), false) => Value::Number(one * other),
                (Value::Number(one), Value::Number(other), true) if other != 0.0 => {
                    Value::Number(one / other)
                }
                _ => Value::Unknown,
            };
        }
    }

    fn primary(&mut self, cursor: &mut Cursor<'a>, level: usize) -> Value {
        let mut sign = 1.0;
        while cursor.peek().is_some_and(|token| token.is('-') || token.is('+')) {
            sign = if cursor.pass('-') { -sign } else { sign };
            cursor.pass('+');
        }
        let Some(token) = cursor.peek() else {
            return Value::Unknown;
        };
        if level > MOST_LEVELS {
            return Value::Unknown;
        }
        let value = match token.kind {
            Kind::Number(number) => {
                cursor.next();
                Value::Number(number)
            }
            Kind::NoNumber => {
                cursor.next();
                let message = format!("`{}` is not a number", &cursor.text[token.span()]);
                let hint = "write numbers as `0.25`, `-1.5`, `1e-3`; m and rad";
                self.messages.problem(token.span(), message, hint);
                Value::Wrong
            }
            Kind::Mark('(') => {
                cursor.next();
                let mut inner = self.arguments(cursor, level);
                match (inner.len(), inner.pop()) {
                    (1, Some(argument)) => argument.value,
                    _ => Value::Unknown,
                }
            }
            Kind::Mark('[') => {
                cursor.next();
                let all = self.list(cursor, level);
                numbers(&all).map_or_else(|| unknown(&all), Value::Numbers)
            }
            Kind::Word => {
                cursor.next();
                self.named(token, cursor, level)
            }
            // A closing mark belongs to the caller.
            Kind::Mark(')' | ']' | ',') => return Value::Unknown,
            _ => {
                cursor.next();
                Value::Unknown
            }
        };
        match self.indexed(value, cursor, level) {
            Value::Number(number) => Value::Number(sign * number),
            value if sign > 0.0 || matches!(value, Value::Wrong) => value,
            _ => Value::Unknown,
        }
    }

    /// The content of brackets; the cursor is after the opening one.
    fn list(&mut self, cursor: &mut Cursor<'a>, level: usize) -> Vec<Value> {
        let mut all = Vec::new();
        while !cursor.pass(']') {
            if cursor.peek().is_none_or(|token| token.is(')')) {
                self.messages.unclosed(cursor.place(), ']');
                all.push(Value::Wrong);
                break;
            }
            let value = self.value(cursor, level + 1);
            all.push(self.past_comma(cursor, value));
        }
        all
    }

    /// `value[2]`, if brackets follow.
    fn indexed(&mut self, value: Value, cursor: &mut Cursor<'a>, level: usize) -> Value {
        let mut value = value;
        while cursor.pass('[') {
            let index = self.list(cursor, level);
            value = match (value, index.as_slice()) {
                (Value::Numbers(all), [Value::Number(index)]) if *index >= 0.0 && index.fract() == 0.0 => all
                    .get(*index as usize)
                    .map_or(Value::Unknown, |number| Value::Number(*number)),
                _ => Value::Unknown,
            };
        }
        value
    }

    /// A pose, a variable or a function.
    fn named(&mut self, word: Token, cursor: &mut Cursor<'a>, level: usize) -> Value {
        let name = &cursor.text[word.span()];
        if name == "p" && cursor.pass('[') {
            let all = self.list(cursor, level);
            return self.pose(&all, word.start..cursor.before());
        }
        if !cursor.pass('(') {
            return match name {
                "pi" | "PI" => Value::Number(std::f64::consts::PI),
                _ => self.known.get(name).cloned().unwrap_or(Value::Unknown),
            };
        }
        let arguments = self.arguments(cursor, level);
        let first = arguments
            .first()
            .map(|argument| &cursor.text[argument.bytes.clone()]);
        let feature = first
            .filter(|name| is_name(name) && !self.known.contains_key(name))
            .map(str::to_owned);
        let mut arguments = arguments.into_iter().map(|argument| argument.value);
        let bytes = word.start..cursor.before();
        match (name, arguments.next(), arguments.next()) {
            ("d2r", Some(Value::Number(deg)), None) => Value::Number(from_deg(deg)),
            ("r2d", Some(Value::Number(rad)), None) => Value::Number(to_deg(rad)),
            ("get_inverse_kin", Some(pose @ Value::Pose(_)), _) => pose,
            ("pose_inv", Some(Value::Pose(posed)), None) => match posed.in_base() {
                Some(pose) => self.computed(pose.inverse(), bytes),
                None => Value::Unknown,
            },
            ("pose_trans", Some(frame), Some(Value::Pose(target))) => {
                let Reference::Given(inner) = &target.frame else {
                    return Value::Unknown;
                };
                let outer = match (frame, feature) {
                    (Value::Pose(frame), _) => frame.in_base().map(|frame| Reference::Given(frame * inner)),
                    // Its pose is not known, but that of the target in it is, if nothing is between them.
                    (Value::Unknown, Some(feature)) if *inner == Isometry::identity() => {
                        Some(Reference::Feature(feature))
                    }
                    _ => None,
                };
                outer.map_or(Value::Unknown, |frame| Value::Pose(Posed { frame, ..target }))
            }
            _ => Value::Unknown,
        }
    }

    fn pose(&mut self, all: &[Value], bytes: Range<usize>) -> Value {
        let mut wrong = |message: String| {
            let hint = "a pose is `p[x, y, z, rx, ry, rz]`, m and rad";
            self.messages.problem(bytes.clone(), message, hint);
            Value::Wrong
        };
        if all.iter().any(|value| matches!(value, Value::Wrong)) {
            return Value::Wrong;
        }
        if all.len() != 6 {
            return wrong(format!("{} numbers in a pose, but 6 are required", all.len()));
        }
        let Some(mut numbers) = numbers(all) else {
            return Value::Unknown;
        };
        for number in &mut numbers[..3] {
            *number *= 1e3;
        }
        match Convention::Ur.pose(&numbers) {
            Ok(pose) => self.computed(pose, bytes),
            Err(error) => wrong(error.to_string()),
        }
    }

    /// A pose in the base with these bytes.
    fn computed(&self, pose: Isometry, bytes: Range<usize>) -> Value {
        Value::Pose(Posed {
            frame: Reference::Given(Isometry::identity()),
            pose,
            spelled: Spelled {
                text: self.messages.index(),
                bytes,
            },
        })
    }
}

/// Whether a text is the name of a variable.
pub(super) fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_alphabetic() || c == '_')
        && text.chars().all(|c| c.is_alphanumeric() || c == '_')
}

/// The numbers of a list that contains only numbers.
fn numbers(all: &[Value]) -> Option<Vec<f64>> {
    (all.len() <= LONGEST_LIST).then_some(())?;
    all.iter()
        .map(|value| match value {
            Value::Number(number) => Some(*number),
            Value::Pose(_) | Value::Numbers(_) | Value::Unknown | Value::Wrong => None,
        })
        .collect()
}

/// The value of a list that does not contain only numbers.
fn unknown(all: &[Value]) -> Value {
    match all.iter().any(|value| matches!(value, Value::Wrong)) {
        true => Value::Wrong,
        false => Value::Unknown,
    }
}

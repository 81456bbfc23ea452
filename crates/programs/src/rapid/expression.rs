//! How expressions are read: numbers, lists, names with components, calls.

use super::read::Reader;
use super::value::{Argument, Node, Reference, Step, Value};
use crate::tokens::{Cursor, Kind};

/// Maximum nesting of brackets.
const MOST_LEVELS: usize = 40;

impl<'a> Reader<'a> {
    /// The expression at the cursor, to the next `,`, `)`, `]`, `}`, `\` or the end.
    pub fn expression(&mut self, cursor: &mut Cursor<'a>, level: usize) -> Node {
        let start = cursor.place().start;
        let mut value = self.primary(cursor, level);
        let mut depth = 0_usize;
        while let Some(token) = cursor.peek() {
            match token.kind {
                Kind::Mark(',' | ')' | ']' | '}' | '\\') if depth == 0 => break,
                Kind::Mark('(' | '[' | '{') => depth += 1,
                Kind::Mark(')' | ']' | '}') => depth -= 1,
                _ => {}
            }
            cursor.next();
            // Results of operators are not evaluated.
            if !matches!(value, Value::Wrong) {
                value = Value::Other;
            }
        }
        Node {
            value,
            bytes: start..cursor.before().max(start),
        }
    }

    fn primary(&mut self, cursor: &mut Cursor<'a>, level: usize) -> Value {
        if let Some(number) = cursor.number() {
            return Value::Number(number);
        }
        let Some(token) = cursor.peek().filter(|_| level <= MOST_LEVELS) else {
            return Value::Other;
        };
        match token.kind {
            Kind::NoNumber => {
                cursor.next();
                let message = format!("`{}` is not a number", &cursor.text[token.span()]);
                let hint = "write numbers as `100`, `-0.5`, `9E9`";
                self.messages.problem(token.span(), message, hint);
                Value::Wrong
            }
            Kind::Mark('[') => {
                cursor.next();
                self.list(cursor, level)
            }
            Kind::Word => {
                let reference = self.reference(cursor, level);
                if !reference.steps.is_empty() || !cursor.pass('(') {
                    return Value::Name(reference);
                }
                let arguments = self.arguments(cursor, level + 1);
                if !cursor.pass(')') {
                    return self.unclosed(cursor, ')');
                }
                Value::Call(reference.name, arguments)
            }
            _ => Value::Other,
        }
    }

    /// The content of brackets; the cursor is after the opening one.
    fn list(&mut self, cursor: &mut Cursor<'a>, level: usize) -> Value {
        let mut all = Vec::new();
        while !cursor.pass(']') {
            all.push(self.expression(cursor, level + 1));
            if !cursor.pass(',') && !cursor.peek().is_some_and(|token| token.is(']')) {
                return self.unclosed(cursor, ']');
            }
        }
        Value::List(all)
    }

    fn unclosed(&mut self, cursor: &Cursor<'a>, mark: char) -> Value {
        self.messages.unclosed(cursor.place(), mark);
        Value::Wrong
    }

    /// The variable at the cursor, with its components.
    pub fn reference(&mut self, cursor: &mut Cursor<'a>, level: usize) -> Reference {
        let word = cursor.peek().filter(|token| token.kind == Kind::Word);
        let name = word
            .map_or("", |token| &cursor.text[token.span()])
            .to_ascii_lowercase();
        cursor.next();
        let mut steps = Vec::new();
        loop {
            if cursor.pass('.') {
                let field = cursor.word().unwrap_or_default();
                steps.push(Step::Field(field.to_ascii_lowercase()));
            } else if cursor.pass('{') {
                while !cursor.pass('}') {
                    steps.push(match self.expression(cursor, level + 1).value {
                        Value::Number(index) if index >= 1.0 && index.fract() == 0.0 => {
                            Step::Index(index as usize)
                        }
                        _ => Step::Unknown,
                    });
                    if !cursor.pass(',') && !cursor.peek().is_some_and(|token| token.is('}')) {
                        self.unclosed(cursor, '}');
                        break;
                    }
                }
            } else {
                return Reference { name, steps };
            }
        }
    }

    /// Arguments between commas, to the end or a closing mark.
    pub fn arguments(&mut self, cursor: &mut Cursor<'a>, level: usize) -> Vec<Argument> {
        let mut all = Vec::new();
        loop {
            if cursor.pass(',') {
                continue;
            }
            if cursor.pass('\\') {
                let place = cursor.place();
                let name = cursor.word().map(|name| name.to_ascii_lowercase());
                if name.is_none() {
                    let message = "the name of an argument is missing after this `\\`";
                    let hint = "write optional arguments as `\\WObj:=wobj1`, `\\NoEOffs`";
                    self.messages.problem(place, message, hint);
                }
                let given = cursor.pass(':') && cursor.pass('=');
                all.push(Argument {
                    name: Some(name.unwrap_or_default()),
                    value: given.then(|| self.expression(cursor, level)),
                });
                continue;
            }
            match cursor.peek() {
                None => return all,
                Some(token) if matches!(token.kind, Kind::Mark(')' | ']' | '}')) => return all,
                Some(_) => all.push(Argument {
                    name: None,
                    value: Some(self.expression(cursor, level)),
                }),
            }
        }
    }
}

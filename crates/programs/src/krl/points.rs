//! Content of data files: points, frames of the controller, and the sets of numbers that inline forms name.

use std::collections::{BTreeMap, HashMap};

use super::aggregate::{Aggregate, Broken, LocatedAggregate};
use crate::tokens::{Cursor, Kind, Token};

/// Types whose components are numbers that a move needs: errors in them are problems.
const POINTS: [&str; 7] = ["E6POS", "POS", "E3POS", "FRAME", "E6AXIS", "E3AXIS", "AXIS"];
/// Words before the type of a declaration.
const BEFORE_TYPE: [&str; 4] = ["DECL", "GLOBAL", "PUBLIC", "CONST"];

/// Value of a name.
#[derive(Clone, Debug)]
pub(super) enum PointValue {
    /// Given by this aggregate.
    Given(LocatedAggregate),
    /// It is computed while the program runs, in this line.
    Computed { line: u32 },
}

/// All names, by name, then by module: two programs may each have an `XP1`.
#[derive(Default)]
pub(super) struct Names(HashMap<String, BTreeMap<String, PointValue>>);

impl Names {
    /// The value of the name in this module, otherwise in the first other module that has it.
    pub fn find(&self, module: &str, name: &str) -> Option<&PointValue> {
        let modules = self.0.get(name)?;
        modules.get(module).or_else(|| modules.values().next())
    }

    /// Sets the value of the name in this module.
    pub fn put(&mut self, module: &str, name: String, known: PointValue) {
        self.0.entry(name).or_default().insert(module.to_owned(), known);
    }
}

/// A variable: `XP1`, `P[3]`, `XP1.X`, `$VEL.CP`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Reference {
    /// In capitals, with its index: `P[3]`; `P[?]` if the index is not a number.
    pub name: String,
    /// The component after its point, if there is one.
    pub field: Option<String>,
}

impl Reference {
    /// Name and index, if the index is a number.
    pub fn index(&self) -> Option<(&str, u32)> {
        let (name, rest) = self.name.split_once('[')?;
        Some((name, rest.strip_suffix(']')?.parse().ok()?))
    }

    /// Reads the variable at the cursor.
    pub fn read(cursor: &mut Cursor<'_>) -> Option<Reference> {
        let mut name = cursor.word()?;
        if cursor.pass('[') {
            let index = cursor
                .number()
                .filter(|_| cursor.peek().is_some_and(|token| token.is(']')));
            match index.filter(|index| index.fract() == 0.0) {
                Some(index) => name.push_str(&format!("[{index}]")),
                None => name.push_str("[?]"),
            }
            while cursor.next().is_some_and(|token| !token.is(']')) {}
        }
        let field = match cursor.pass('.') {
            true => Some(cursor.word().unwrap_or_default()),
            false => None,
        };
        Some(Reference { name, field })
    }
}

/// A declaration with values, or an assignment: the type, if there is one, and the variables with the positions of
/// their values.
pub(super) struct Declared<'a> {
    pub kind: Option<String>,
    pub values: Vec<(Reference, Cursor<'a>)>,
}

/// The line as a declaration or an assignment; `None` if it is neither.
pub(super) fn declared<'a>(line: &Cursor<'a>) -> Option<Declared<'a>> {
    let mut cursor = line.clone();
    while cursor
        .peek_word()
        .is_some_and(|word| BEFORE_TYPE.contains(&word.as_str()))
    {
        cursor.next();
    }
    let mut ahead = cursor.clone();
    let kind = ahead
        .word()
        .filter(|_| ahead.peek().is_some_and(|token| token.kind == Kind::Word));
    if kind.is_some() {
        cursor = ahead;
    }
    let mut values = Vec::new();
    loop {
        let reference = Reference::read(&mut cursor)?;
        if cursor.pass('=') {
            values.push((reference, cursor.clone()));
        }
        // Go to the next variable of a list.
        let mut depth = 0_usize;
        loop {
            match cursor.next().map(|token| token.kind) {
                None => {
                    let given = kind.is_some() || !values.is_empty();
                    return given.then_some(Declared { kind, values });
                }
                Some(Kind::Mark('{' | '(' | '[')) => depth += 1,
                Some(Kind::Mark('}' | ')' | ']')) => depth = depth.saturating_sub(1),
                Some(Kind::Mark(',')) if depth == 0 && kind.is_some() => break,
                Some(_) => {}
            }
        }
    }
}

/// Stores all values of the lines of a data file; returns the errors in points.
pub(super) fn take_data(names: &mut Names, module: &str, text: usize, lines: &[Cursor<'_>]) -> Vec<Broken> {
    let mut broken = Vec::new();
    for line in lines {
        let Some(declared) = declared(line) else { continue };
        let is_point = declared.kind.as_deref().is_none_or(|kind| POINTS.contains(&kind));
        for (reference, mut value) in declared.values {
            if reference.field.is_some() || !value.peek().is_some_and(|token| token.is('{')) {
                continue;
            }
            match Aggregate::read(&mut value) {
                Ok(aggregate) => {
                    let known = PointValue::Given(LocatedAggregate { aggregate, text });
                    names.put(module, reference.name, known);
                }
                Err(wrong) if is_point => broken.push(wrong),
                Err(_) => {}
            }
        }
    }
    broken
}

/// The lines of a text that are not empty, without those of the file manager.
pub(super) fn lines<'a>(text: &'a str, tokens: &'a [Token]) -> Vec<Cursor<'a>> {
    tokens
        .split(|token| token.kind == Kind::Line)
        .filter(|line| line.first().is_some_and(|first| !first.is('&')))
        .map(|line| Cursor::new(text, line))
        .collect()
}

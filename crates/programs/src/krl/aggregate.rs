//! Aggregates: `{X 1.0,Y 2.0}`, `{AXIS: A1 0.0}`, `{TOOL_NO 1,IPO_FRAME #BASE}`; and how a pose is written in them.

use std::ops::Range;

use armill_core::frame::Isometry;
use armill_formats::convention::Convention;

use super::SYNTAX;
use crate::number::{decimals, fixed, write_fixed};
use crate::posture::Configuration;
use crate::spelling::Respelling;
use crate::tokens::{Cursor, Kind, tokens};

/// The components of a pose, in the order of [`Convention::Kuka`].
pub(super) const POSE: [&str; 6] = ["X", "Y", "Z", "A", "B", "C"];
/// The axes of the arm.
pub(super) const AXES: [&str; 6] = ["A1", "A2", "A3", "A4", "A5", "A6"];
/// External axes.
const EXTERNAL: [&str; 6] = ["E1", "E2", "E3", "E4", "E5", "E6"];
/// Maximum nesting of braces, deeper than any data of KUKA.
const MOST_LEVELS: usize = 8;
/// Minimum and maximum number of decimals of mm and deg.
const MM: usize = 3;
const DEG: usize = 4;
const MOST_DECIMALS: usize = 9;

/// An aggregate.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Aggregate {
    /// Names in capitals; of a repeated name the last one is used.
    pub fields: Vec<(String, Value)>,
    /// Its bytes, braces included.
    pub bytes: Range<usize>,
}

/// An aggregate, and the index of the text that contains it.
#[derive(Clone, Debug)]
pub(super) struct LocatedAggregate {
    pub aggregate: Aggregate,
    pub text: usize,
}

/// A component.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    /// A number.
    Number(f64),
    /// `#NAME`, in capitals.
    Flag(String),
    /// Bits, as `'B010'` or `'H1F'`.
    Bits(i64),
    /// Any other value.
    Other,
}

/// A text that is not an aggregate, and its position.
#[derive(Debug, PartialEq)]
pub(super) struct Broken {
    pub bytes: Range<usize>,
    pub message: String,
}

impl Aggregate {
    /// Reads the aggregate at the cursor.
    pub fn read(cursor: &mut Cursor<'_>) -> Result<Aggregate, Broken> {
        nested(cursor, 0)
    }

    /// The last component with this name.
    pub fn field(&self, name: &str) -> Option<&Value> {
        let found = self.fields.iter().rev().find(|(other, _)| other == name);
        found.map(|(_, value)| value)
    }

    /// The number with this name.
    pub fn number(&self, name: &str) -> Option<f64> {
        match self.field(name)? {
            Value::Number(number) => Some(*number),
            Value::Bits(bits) => Some(*bits as f64),
            Value::Flag(_) | Value::Other => None,
        }
    }

    /// Whether it has any of these components.
    pub fn has_any(&self, names: &[&str]) -> bool {
        names.iter().any(|name| self.field(name).is_some())
    }

    /// The numbers with these names. Missing ones are taken from `former`; without it their names are returned.
    pub fn numbers(&self, names: [&'static str; 6], former: Option<[f64; 6]>) -> Result<[f64; 6], String> {
        let mut numbers = former.unwrap_or_default();
        let mut missing = Vec::new();
        for (number, name) in numbers.iter_mut().zip(names) {
            match self.number(name) {
                Some(given) => *number = given,
                None if former.is_none() || self.field(name).is_some() => missing.push(name),
                None => {}
            }
        }
        match missing.is_empty() {
            true => Ok(numbers),
            false => Err(missing.join(", ")),
        }
    }

    /// S as a configuration.
    pub fn configuration(&self) -> Configuration {
        let Some(status) = self.bits("S") else {
            return Configuration::default();
        };
        Configuration {
            rear: Some(status & 1 != 0),
            lower: Some(status & 2 == 0),
            flip: Some(status & 4 != 0),
        }
    }

    /// T as bits of A1 to A6.
    pub fn turns(&self) -> Vec<i32> {
        match self.bits("T") {
            Some(turn) => (0..6).map(|axis| i32::from(turn >> axis & 1 != 0)).collect(),
            None => Vec::new(),
        }
    }

    /// Whether an external axis is not at zero.
    pub fn moves_external_axes(&self) -> bool {
        EXTERNAL
            .iter()
            .any(|name| self.number(name).is_some_and(|value| value != 0.0))
    }

    fn bits(&self, name: &str) -> Option<i64> {
        self.number(name)
            .filter(|number| number.fract() == 0.0 && (0.0..=1e6).contains(number))
            .map(|number| number as i64)
    }
}

fn nested(cursor: &mut Cursor<'_>, level: usize) -> Result<Aggregate, Broken> {
    let start = cursor.place().start;
    let broken = |bytes: Range<usize>, message: String| Err(Broken { bytes, message });
    if !cursor.pass('{') {
        return broken(cursor.place(), "`{` is missing here".to_owned());
    }
    if level > MOST_LEVELS {
        return broken(
            cursor.place(),
            "braces within braces, too deep to be data".to_owned(),
        );
    }
    let mut ahead = cursor.clone();
    if ahead.word().is_some() && ahead.pass(':') {
        *cursor = ahead;
    }
    let mut fields = Vec::new();
    loop {
        let place = cursor.place();
        if let Some(last) = cursor.peek().filter(|token| token.is('}')) {
            cursor.next();
            return Ok(Aggregate {
                fields,
                bytes: start..last.end,
            });
        }
        let Some(name) = cursor.word() else {
            return broken(place, "a component is missing here".to_owned());
        };
        if cursor.pass('[') {
            while cursor.next().is_some_and(|token| !token.is(']')) {}
        }
        fields.push((name, value(cursor, level)?));
        let place = cursor.place();
        if !cursor.pass(',') && !cursor.peek().is_some_and(|token| token.is('}')) {
            return broken(place, "`,` or `}` is missing here".to_owned());
        }
    }
}

fn value(cursor: &mut Cursor<'_>, level: usize) -> Result<Value, Broken> {
    if let Some(number) = cursor.number() {
        return Ok(Value::Number(number));
    }
    let bytes = cursor.place();
    let Some(token) = cursor.peek() else {
        return Err(Broken {
            bytes,
            message: "a value and `}` are missing here".to_owned(),
        });
    };
    match token.kind {
        Kind::Mark('{') => nested(cursor, level + 1).map(|_| Value::Other),
        Kind::Mark('#') => {
            cursor.next();
            Ok(Value::Flag(cursor.word().unwrap_or_default()))
        }
        Kind::Text => {
            cursor.next();
            Ok(bits(&cursor.text[token.span()]).map_or(Value::Other, Value::Bits))
        }
        Kind::Word => {
            cursor.next();
            Ok(Value::Other)
        }
        _ => {
            // The sign of an invalid number is shown with it.
            cursor.next();
            let end = match (token.kind, cursor.peek()) {
                (Kind::Mark('-' | '+'), Some(next)) => next.end,
                _ => token.end,
            };
            Err(Broken {
                bytes: token.start..end,
                message: format!("`{}` is not a number", &cursor.text[token.start..end]),
            })
        }
    }
}

/// `'B010'` and `'H1F'`.
fn bits(text: &str) -> Option<i64> {
    let inner = text.strip_prefix('\'')?.strip_suffix('\'')?;
    let digits = inner.get(1..)?;
    let base = match inner.get(..1)?.to_ascii_uppercase().as_str() {
        "B" => 2,
        "H" => 16,
        _ => return None,
    };
    i64::from_str_radix(digits, base).ok()
}

/// Writes a pose in place of `before`: an aggregate with its other components, a relative move, or an expression of
/// points.
pub(crate) fn spell(pose: &Isometry, respelling: Respelling, before: &str, out: &mut String) {
    let numbers = Convention::Kuka.numbers_of(pose);
    let found = tokens(before, &SYNTAX);
    let mut cursor = Cursor::new(before, &found);
    if let Some(word) = cursor.peek_word() {
        // `LIN_REL {...}` becomes `LIN {...}`; `P1:{...}` becomes `{...}`.
        if let Some(absolute) = word.strip_suffix("_REL") {
            out.push_str(&before[..absolute.len()]);
            out.push(' ');
        }
        return whole(&numbers, out);
    }
    let composed = found.iter().any(|token| token.kind == Kind::Mark(':'));
    let closed = Aggregate::read(&mut cursor.clone()).is_ok_and(|first| first.bytes == (0..before.len()));
    if composed && !closed {
        return whole(&numbers, out);
    }
    // The missing angles of a partial orientation come from the previous move, which may have been rewritten.
    let given = found
        .iter()
        .filter(|token| token.kind == Kind::Word)
        .filter(|token| POSE[3..].contains(&before[token.span()].to_ascii_uppercase().as_str()))
        .count();
    let respelling = if matches!(given, 0 | 3) {
        respelling
    } else {
        Respelling::Pose
    };
    let mut done = 0;
    let mut last = None;
    let mut spelled = [false; 6];
    while let Some(token) = cursor.next() {
        last = last.or(token.is('{').then_some(token.end));
        if token.is(':') {
            last = Some(token.end);
        }
        let name = match token.kind {
            Kind::Word => before[token.span()].to_ascii_uppercase(),
            _ => continue,
        };
        let start = cursor.place().start;
        let (Some(index), Some(_)) = (POSE.iter().position(|known| *known == name), cursor.number()) else {
            continue;
        };
        let end = cursor.before();
        (last, spelled[index]) = (Some(end), true);
        if !respelling.includes(index) {
            continue;
        }
        out.push_str(&before[done..start]);
        // `A-5` is a component, `A5` would be an axis.
        if out.ends_with(|c: char| c.is_alphanumeric()) {
            out.push(' ');
        }
        let least = if index < 3 { MM } else { DEG };
        write_fixed(
            out,
            numbers[index],
            decimals(&before[start..end], least, MOST_DECIMALS),
        );
        done = end;
    }
    let missing: Vec<usize> = (0..6)
        .filter(|index| !spelled[*index] && respelling.includes(*index))
        .collect();
    let last = last.unwrap_or(before.len());
    // Missing components follow the last given one; nothing has been written between them.
    if !missing.is_empty() {
        out.push_str(&before[done..last]);
        for index in missing {
            let comma = if out.ends_with(['{', ':']) { "" } else { "," };
            let least = if index < 3 { MM } else { DEG };
            out.push_str(&format!(
                "{comma}{} {}",
                POSE[index],
                fixed(numbers[index], least)
            ));
        }
        let rest = before[last..].trim_start();
        if !spelled.contains(&true) && !rest.starts_with('}') {
            out.push(',');
        }
        done = last;
    }
    out.push_str(&before[done..]);
}

/// The numbers of a pose as a complete aggregate.
pub(super) fn whole(numbers: &[f64], out: &mut String) {
    for (index, (name, number)) in POSE.iter().zip(numbers).enumerate() {
        let decimals = if index < 3 { MM } else { DEG };
        out.push_str(if index == 0 { "{" } else { "," });
        out.push_str(&format!("{name} {}", fixed(*number, decimals)));
    }
    out.push('}');
}

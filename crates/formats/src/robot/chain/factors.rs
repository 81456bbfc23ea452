//! The factors of a chain and the symbols they use.
//!
//! ```text
//! line     = [ name "=" ] product | name "=" number        # a comment goes to the line's end
//! product  = factor { blank | "*" | "·" | "," factor }
//! factor   = word "(" argument ")"                         word: Tx Ty Tz Rx Ry Rz, A1 to A6, A^{1}
//! argument = [ sign ] term { sign term }                   term: number, symbol, joint (one at most)
//! ```
//!
//! Definitions apply to the whole text, also before their own line; of two of one symbol the last is used.

use std::collections::BTreeMap;
use std::ops::Range;

use armill_core::robot::chain::LONGEST;
use armill_core::robot::joint::Sign;
use armill_core::robot::{Amount, Axis, Motion};
use armill_core::units::{from_deg, from_mm, to_mm};

use super::cursor::Cursor;
use crate::document::{Problems, Source};

/// Which motion a factor makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A translation; constants in mm.
    Along(Axis),
    /// A turn; constants in deg.
    About(Axis),
}

impl Kind {
    /// The motion by this much, m or rad.
    pub fn by(self, amount: Amount) -> Motion {
        match self {
            Kind::Along(axis) => Motion::Along(axis, amount),
            Kind::About(axis) => Motion::About(axis, amount),
        }
    }

    /// A constant of the file in m or rad.
    pub fn si(self, constant: f64) -> f64 {
        match self {
            Kind::Along(_) => from_mm(constant),
            Kind::About(_) => from_deg(constant),
        }
    }

    /// The largest constant, and its unit.
    fn longest(self) -> (f64, &'static str) {
        match self {
            Kind::Along(_) => (to_mm(LONGEST), "mm"),
            Kind::About(_) => (360.0, "deg"),
        }
    }
}

/// One factor: a motion, and how far.
#[derive(Debug)]
pub(super) struct Factor {
    /// Along or about which axis.
    pub kind: Kind,
    /// How far.
    pub argument: Argument,
    /// From its word to its closing bracket, in bytes of the text.
    pub place: Range<usize>,
}

/// What is in the brackets.
#[derive(Debug, Default)]
pub(super) struct Argument {
    /// mm or deg.
    pub constant: f64,
    /// Name of the joint, and whether it has the sign of the chain.
    pub joint: Option<(String, Sign)>,
    /// The symbol, where the argument is one alone.
    pub symbol: Option<String>,
}

/// More problems than this are not reported: what is not a chain at all has one in every word.
const MOST_PROBLEMS: usize = 20;

/// How a chain is written.
const SHAPE: &str =
    "a factor is Tx(155), Ry(q2), or A1(155), A5(q2) as in the paper; a symbol is `H = 450` on its own line";

/// Values of symbols, mm or deg.
type Symbols<'a> = BTreeMap<&'a str, f64>;

/// Every factor, in order.
///
/// # Errors
/// What is neither factor nor definition, lengths without value, numbers that are none; at most 20: behind a factor
/// that is refused it goes on with the next.
pub(super) fn read(file: &Source) -> Result<Vec<Factor>, Problems> {
    let text = file.text();
    let mut symbols = Symbols::new();
    let mut products = Vec::new();
    let mut problems = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let content = line.split('#').next().unwrap_or_default();
        let range = start..start + content.len();
        start += line.len();
        match content.split_once('=') {
            // `A = A3(H) A6(phi) ...`: what precedes is the name of the whole.
            Some((before, after)) if after.contains('(') => {
                products.push(range.start + before.len() + 1..range.end);
            }
            Some((name, value)) => match definition(name, value) {
                Some((name, value)) => {
                    symbols.insert(name, value);
                }
                None if problems.len() < MOST_PROBLEMS => {
                    let word = content.trim();
                    let at = range.start + content.len() - content.trim_start().len();
                    let message = format!("`{word}` defines nothing");
                    problems.push(file.problem(at..at + word.len(), message, Some(SHAPE.to_owned())));
                }
                None => {}
            },
            None => products.push(range),
        }
    }
    let mut factors = Vec::new();
    for range in products {
        let mut cursor = Cursor::over(text, range);
        loop {
            cursor.while_of(|c| c.is_whitespace() || matches!(c, '*' | '·' | ','));
            if cursor.peek().is_none() || problems.len() >= MOST_PROBLEMS {
                break;
            }
            match factor(file, &mut cursor, &symbols) {
                Ok(factor) => factors.push(factor),
                Err(found) => {
                    problems.extend(found);
                    // Goes on behind the next bracket.
                    cursor.while_of(|c| c != ')' && !c.is_whitespace());
                    cursor.take(')');
                }
            }
        }
    }
    Problems::from(problems).into_result().map(|()| factors)
}

/// Name and value of a line such as `H = 450`.
///
/// The number may have a sign; `None` where the name is none, or the value no finite number.
fn definition<'a>(name: &'a str, value: &str) -> Option<(&'a str, f64)> {
    let name = name.trim();
    let mut cursor = Cursor::over(name, 0..name.len());
    let whole = cursor.name()? == name;
    let value = value
        .trim()
        .parse::<f64>()
        .ok()
        .filter(|value| value.is_finite())?;
    whole.then_some((name, value))
}

/// The factor that begins at the cursor, which then follows it.
fn factor(file: &Source, cursor: &mut Cursor<'_>, symbols: &Symbols<'_>) -> Result<Factor, Problems> {
    let start = cursor.at();
    let word = cursor.while_of(|c| !c.is_whitespace() && c != '(' && c != ')');
    let Some(kind) = kind(word) else {
        let message = format!("`{word}` is not an elementary motion");
        return Err(file
            .problem(start..cursor.at(), message, Some(SHAPE.to_owned()))
            .into());
    };
    cursor.skip_blanks();
    if !cursor.take('(') {
        let message = format!("`{word}` has no bracket behind it");
        return Err(file
            .problem(start..cursor.at(), message, Some(SHAPE.to_owned()))
            .into());
    }
    let argument = argument(file, cursor, symbols, kind)?;
    if !cursor.take(')') {
        let message = format!("the bracket of `{word}` is not closed");
        return Err(file
            .problem(start..cursor.at(), message, Some(SHAPE.to_owned()))
            .into());
    }
    Ok(Factor {
        kind,
        argument,
        place: start..cursor.at(),
    })
}

/// Which motion a word names.
///
/// Capitals do not count, nor do the `^{}` of a formula that was copied.
fn kind(word: &str) -> Option<Kind> {
    Some(
        match word.to_ascii_lowercase().replace(['^', '{', '}'], "").as_str() {
            "tx" | "a1" => Kind::Along(Axis::X),
            "ty" | "a2" => Kind::Along(Axis::Y),
            "tz" | "a3" => Kind::Along(Axis::Z),
            "rx" | "a4" => Kind::About(Axis::X),
            "ry" | "a5" => Kind::About(Axis::Y),
            "rz" | "a6" => Kind::About(Axis::Z),
            _ => return None,
        },
    )
}

/// A sum of numbers, symbols and at most one joint.
///
/// A name with a value is a symbol. Any other is a joint: about an axis any name, along one only `q1`,
/// `q2`, ... The constant is then the chain position at the joint's zero.
///
/// # Errors
/// A length without value, a second joint, a term that is none, a constant beyond 1000 m or 360 deg.
fn argument(
    file: &Source,
    cursor: &mut Cursor<'_>,
    symbols: &Symbols<'_>,
    kind: Kind,
) -> Result<Argument, Problems> {
    let start = cursor.at();
    let mut found = Argument::default();
    let mut terms = 0;
    loop {
        cursor.skip_blanks();
        // One sign: `q1--90` is a typing error, and its meaning is ambiguous.
        let sign = if cursor.take('-') || cursor.take('−') {
            Sign::Negative
        } else if cursor.take('+') || terms == 0 {
            Sign::Positive
        } else {
            break;
        };
        cursor.skip_blanks();
        let at = cursor.at();
        if let Some(number) = cursor.number() {
            found.constant += sign.factor() * number;
        } else if let Some(name) = cursor.name() {
            match symbols.get(name) {
                Some(value) => {
                    found.constant += sign.factor() * value;
                    found.symbol = (terms == 0 && sign == Sign::Positive).then(|| name.to_owned());
                }
                None if matches!(kind, Kind::Along(_)) && !is_joint_number(name) => {
                    let message = format!("the length `{name}` has no value");
                    let hint =
                        format!("add a line `{name} = 155` (mm); joints that slide are called q1, q2, ...");
                    return Err(file.problem(at..cursor.at(), message, Some(hint)).into());
                }
                None if found.joint.is_some() => {
                    let message = format!("`{name}` is a second joint in one factor");
                    let hint = format!("if it is a constant, add a line `{name} = ...`");
                    return Err(file.problem(at..cursor.at(), message, Some(hint)).into());
                }
                None => found.joint = Some((name.to_owned(), sign)),
            }
        } else {
            cursor.while_of(|c| !c.is_whitespace() && c != ')');
            let message = "a number, joint or symbol is missing here".to_owned();
            return Err(file
                .problem(at..cursor.at(), message, Some(SHAPE.to_owned()))
                .into());
        }
        terms += 1;
    }
    if terms > 1 {
        found.symbol = None;
    }
    let (longest, unit) = kind.longest();
    if found.constant.abs() > longest {
        let value = found.constant;
        let message = format!("{value} {unit} is beyond {longest} {unit}");
        return Err(file.problem(start..cursor.at(), message, None).into());
    }
    Ok(found)
}

/// `q1`, `q2`, ...
fn is_joint_number(name: &str) -> bool {
    name.strip_prefix(['q', 'Q'])
        .is_some_and(|digits| !digits.is_empty() && digits.chars().all(|c| c.is_ascii_digit()))
}

//! Real values: numbers, parameters, functions and bracketed expressions.
//!
//! | binds | operators |
//! |---|---|
//! | strongest | `**` |
//! | | `*` `/` `MOD` |
//! | | `+` `-` |
//! | | `EQ` `NE` `GT` `GE` `LT` `LE`, which give 1 or 0 |
//! | weakest | `AND` `OR` `XOR` |
//!
//! Functions: `ABS ACOS ASIN ATAN[y]/[x] COS EXISTS EXP FIX FUP LN ROUND SIN SQRT TAN`; angles in degrees. The text has
//! neither blanks nor capitals.
//!
//! ```text
//! value    = number | "#" parameter | "[" sum "]" | function "[" sum "]" | ("+" | "-") value
//! sum      = value { operator value }                    operators of one line of the table bind from the left
//! function ATAN has two brackets: atan[y]/[x]
//! ```
//!
//! `FIX` rounds down and `FUP` up. A result that is not finite is refused.
//!
//! Source: NISTIR 6556, section 3.3.2; EXISTS and named parameters: LinuxCNC documentation.

use super::refusal::Refusal;
use armill_core::units::{from_deg, to_deg};

/// Brackets inside brackets.
pub(super) const DEEPEST: usize = 100;

/// Values that an expression can use.
pub(super) trait Values {
    /// The value of a parameter `#number`, which may be computed; zero where it was never set.
    fn numbered(&self, number: f64) -> Result<f64, Refusal>;
    /// The value of `#<name>`; `None` where it was never set.
    fn named(&self, name: &[u8]) -> Option<f64>;
}

/// Walks over a text without blanks.
pub(super) struct Reader<'a> {
    /// In small letters, without blanks.
    pub text: &'a [u8],
    /// The current byte.
    pub at: usize,
    /// Source of parameter values.
    pub values: &'a dyn Values,
    /// Levels around it.
    depth: usize,
}

/// A parameter on the left of `=` or inside EXISTS.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Name {
    /// `#5221`; not yet known to exist.
    Numbered(f64),
    /// `#<depth>`, in small letters.
    Named(Vec<u8>),
}

/// What was read, or why it cannot be.
type Read<T> = Result<T, Refusal>;

impl<'a> Reader<'a> {
    /// From this byte on.
    pub fn new(text: &'a [u8], at: usize, values: &'a dyn Values) -> Reader<'a> {
        Reader {
            text,
            at,
            values,
            depth: 0,
        }
    }

    /// The current byte; `None` at the end.
    pub fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    /// Moves past the `requested` byte if it is next.
    pub fn take(&mut self, requested: u8) -> bool {
        let here = self.peek() == Some(requested);
        self.at += usize::from(here);
        here
    }

    /// Moves past the `requested` byte, which must be next.
    fn expect(&mut self, requested: u8) -> Read<()> {
        if self.take(requested) {
            return Ok(());
        }
        Err(Refusal::Expected(char::from(requested)))
    }

    /// The text from the current byte.
    fn rest(&self) -> &'a [u8] {
        self.text.get(self.at..).unwrap_or_default()
    }

    /// Reads a nested part, no more than [`DEEPEST`] deep: the reader is recursive.
    fn deeper<T>(&mut self, read: impl FnOnce(&mut Self) -> Read<T>) -> Read<T> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(Refusal::TooDeep { limit: DEEPEST });
        }
        let value = read(self);
        self.depth -= 1;
        value
    }

    /// A number, parameter, function or bracketed expression.
    pub fn value(&mut self) -> Read<f64> {
        match self.peek() {
            Some(b'0'..=b'9' | b'.') => self.number(),
            Some(b'[') => self.bracketed(),
            Some(b'#') => {
                let name = self.deeper(Reader::parameter)?;
                self.parameter_value(&name)
            }
            Some(b'-') => {
                self.at += 1;
                Ok(-self.deeper(Reader::value)?)
            }
            Some(b'+') => {
                self.at += 1;
                self.deeper(Reader::value)
            }
            Some(b'a'..=b'z') => self.function(),
            found => Err(Refusal::NotANumber(
                found.map(|byte| char::from(byte).to_string()).unwrap_or_default(),
            )),
        }
    }

    /// Digits with at most one point; no exponent, since `E` is a word.
    fn number(&mut self) -> Read<f64> {
        let rest = self.rest();
        let length = rest
            .iter()
            .position(|byte| !matches!(byte, b'0'..=b'9' | b'.'))
            .unwrap_or(rest.len());
        let digits = std::str::from_utf8(rest.get(..length).unwrap_or_default()).unwrap_or_default();
        self.at += length;
        digits
            .parse::<f64>()
            .ok()
            .filter(|value| value.is_finite())
            .ok_or_else(|| Refusal::NotANumber(digits.to_owned()))
    }

    /// `[...]`.
    pub fn bracketed(&mut self) -> Read<f64> {
        self.deeper(|reader| {
            reader.expect(b'[')?;
            let value = reader.operation(0)?;
            reader.expect(b']')?;
            finite(value, "an expression")
        })
    }

    /// Operators that bind at least so strongly.
    ///
    /// Ends before `]`, before an operator that binds less, and before any sign that is none; letters that are none are
    /// refused.
    fn operation(&mut self, weakest: u8) -> Read<f64> {
        let mut left = self.value()?;
        while self.peek().is_some_and(|byte| byte != b']') {
            let Some((operator, length, strength)) = operator(self.rest()) else {
                // Inside EXISTS and functions of two brackets an operator has no place: the caller wants `]`.
                return match self.peek() {
                    Some(b'a'..=b'z') => Err(self.unknown()),
                    _ => Ok(left),
                };
            };
            if strength < weakest {
                break;
            }
            self.at += length;
            let right = self.deeper(|reader| reader.operation(strength + 1))?;
            left = applied(operator, left, right)?;
        }
        Ok(left)
    }

    /// The part after `#`: a number or a name.
    pub fn parameter(&mut self) -> Read<Name> {
        self.expect(b'#')?;
        if self.take(b'<') {
            let rest = self.rest();
            let Some(length) = rest.iter().position(|byte| *byte == b'>') else {
                return Err(Refusal::NameOpen);
            };
            self.at += length + 1;
            return Ok(Name::Named(rest.get(..length).unwrap_or_default().to_vec()));
        }
        Ok(Name::Numbered(self.deeper(Reader::value)?))
    }

    /// The value of a parameter whose name was read.
    ///
    /// # Errors
    /// A number that is none of a parameter, a name that was never set.
    fn parameter_value(&self, name: &Name) -> Read<f64> {
        match name {
            Name::Numbered(number) => self.values.numbered(*number),
            Name::Named(name) => self
                .values
                .named(name)
                .ok_or_else(|| Refusal::ParameterUnset(String::from_utf8_lossy(name).into_owned())),
        }
    }

    /// The letters here as an unknown function.
    fn unknown(&self) -> Refusal {
        let letters = self.rest().iter().take_while(|byte| byte.is_ascii_lowercase());
        Refusal::UnknownFunction(letters.map(|byte| char::from(*byte)).collect())
    }

    /// A function and its bracket; the name is the first that fits, since no blanks part it from others.
    fn function(&mut self) -> Read<f64> {
        let rest = self.rest();
        let Some(name) = FUNCTIONS.iter().find(|name| rest.starts_with(name.as_bytes())) else {
            return Err(self.unknown());
        };
        self.at += name.len();
        if *name == "exists" {
            return self.exists();
        }
        let argument = self.bracketed()?;
        let (value, what) = match *name {
            "abs" => (argument.abs(), "ABS"),
            "acos" => (to_deg(argument.acos()), "ACOS"),
            "asin" => (to_deg(argument.asin()), "ASIN"),
            "cos" => (from_deg(argument).cos(), "COS"),
            "exp" => (argument.exp(), "EXP"),
            "fix" => (argument.floor(), "FIX"),
            "fup" => (argument.ceil(), "FUP"),
            "ln" => (argument.ln(), "LN"),
            "round" => (argument.round(), "ROUND"),
            "sin" => (from_deg(argument).sin(), "SIN"),
            "sqrt" => (argument.sqrt(), "SQRT"),
            "tan" => (from_deg(argument).tan(), "TAN"),
            _ => {
                self.expect(b'/')?;
                let other = self.bracketed()?;
                (to_deg(argument.atan2(other)), "ATAN")
            }
        };
        finite(value, what)
    }

    /// 1 for a name that was set, else 0; 1 for any number that a parameter may have, while others are refused.
    fn exists(&mut self) -> Read<f64> {
        self.expect(b'[')?;
        if self.peek() != Some(b'#') {
            return Err(Refusal::ExpectedParameter);
        }
        let name = self.deeper(Reader::parameter)?;
        self.expect(b']')?;
        Ok(match name {
            Name::Numbered(number) => {
                self.values.numbered(number)?;
                1.0
            }
            Name::Named(name) => f64::from(u8::from(self.values.named(&name).is_some())),
        })
    }
}

/// Names of the functions; none begins another.
const FUNCTIONS: [&str; 14] = [
    "abs", "acos", "asin", "atan", "cos", "exists", "exp", "fix", "fup", "ln", "round", "sin", "sqrt", "tan",
];

/// Refuses what is infinite or no number; `what` says where it came from.
fn finite(value: f64, what: &'static str) -> Read<f64> {
    if value.is_finite() {
        return Ok(value);
    }
    Err(Refusal::NoValue(what))
}

/// Operator between two values.
#[derive(Clone, Copy)]
enum Operator {
    Power,
    Times,
    Over,
    Mod,
    Plus,
    Minus,
    Equal,
    NotEqual,
    Greater,
    GreaterOrEqual,
    Less,
    LessOrEqual,
    And,
    Or,
    Xor,
}

/// The operator here, its length and how strongly it binds.
fn operator(text: &[u8]) -> Option<(Operator, usize, u8)> {
    const WORDS: [(&[u8], Operator, u8); 15] = [
        (b"**", Operator::Power, 4),
        (b"*", Operator::Times, 3),
        (b"/", Operator::Over, 3),
        (b"mod", Operator::Mod, 3),
        (b"+", Operator::Plus, 2),
        (b"-", Operator::Minus, 2),
        (b"eq", Operator::Equal, 1),
        (b"ne", Operator::NotEqual, 1),
        (b"ge", Operator::GreaterOrEqual, 1),
        (b"gt", Operator::Greater, 1),
        (b"le", Operator::LessOrEqual, 1),
        (b"lt", Operator::Less, 1),
        (b"and", Operator::And, 0),
        (b"or", Operator::Or, 0),
        (b"xor", Operator::Xor, 0),
    ];
    WORDS
        .iter()
        .find(|(word, ..)| text.starts_with(word))
        .map(|(word, operator, strength)| (*operator, word.len(), *strength))
}

/// Computed numbers that differ by less are equal, as the interpreter of LinuxCNC takes them.
const EQUAL: f64 = 1e-6;

/// The value of an operation; comparisons give 1 or 0. MOD is never below zero.
fn applied(operator: Operator, left: f64, right: f64) -> Read<f64> {
    let truth = |truth: bool| f64::from(u8::from(truth));
    let value = match operator {
        Operator::Power => left.powf(right),
        Operator::Times => left * right,
        Operator::Over => left / right,
        Operator::Mod => left.rem_euclid(right),
        Operator::Plus => left + right,
        Operator::Minus => left - right,
        Operator::Equal => truth((left - right).abs() < EQUAL),
        Operator::NotEqual => truth((left - right).abs() >= EQUAL),
        Operator::Greater => truth(left > right),
        Operator::GreaterOrEqual => truth(left >= right),
        Operator::Less => truth(left < right),
        Operator::LessOrEqual => truth(left <= right),
        Operator::And => truth(left != 0.0 && right != 0.0),
        Operator::Or => truth(left != 0.0 || right != 0.0),
        Operator::Xor => truth((left != 0.0) != (right != 0.0)),
    };
    finite(value, "an operation")
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Few;

    impl Values for Few {
        fn numbered(&self, number: f64) -> Read<f64> {
            Ok(number * 10.0)
        }

        fn named(&self, name: &[u8]) -> Option<f64> {
            (name == b"a").then_some(7.0)
        }
    }

    fn value(text: &str) -> Read<f64> {
        let mut reader = Reader::new(text.as_bytes(), 0, &Few);
        let value = reader.value()?;
        assert_eq!(reader.at, text.len(), "{text} is read to its end");
        Ok(value)
    }

    #[test]
    fn operators_bind_as_the_standard_says() {
        for (text, expected) in [
            ("[1+2*3]", 7.0),
            ("[2**3**2]", 64.0),
            ("[10-4-3]", 3.0),
            ("[7mod4+1]", 4.0),
            ("[-1mod4]", 3.0),
            ("[1+1eq2and3gt2]", 1.0),
            ("[2lt1or1le1]", 1.0),
            ("[1xor1]", 0.0),
            ("[-[2+1]*-2]", 6.0),
            ("##1", 100.0),
            ("#<a>", 7.0),
            ("[#1+#<a>]", 17.0),
        ] {
            assert_eq!(value(text), Ok(expected), "{text}");
        }
    }

    #[test]
    fn functions_take_and_give_degrees() {
        for (text, expected) in [
            ("sin[30]", 0.5),
            ("acos[0]", 90.0),
            ("atan[1]/[-1]", 135.0),
            ("fix[-2.8]", -3.0),
            ("fup[2.2]", 3.0),
            ("round[2.5]", 3.0),
            ("exists[#<a>]", 1.0),
            ("exists[#<b>]", 0.0),
        ] {
            // Sines of degrees are rounded at pi: a few last places.
            assert!((value(text).unwrap() - expected).abs() < 1e-14, "{text}");
        }
    }

    #[test]
    fn what_has_no_value_is_refused() {
        for (text, refusal) in [
            ("[1/0]", Refusal::NoValue("an operation")),
            ("sqrt[-1]", Refusal::NoValue("SQRT")),
            ("[1+]", Refusal::NotANumber("]".to_owned())),
            ("[1", Refusal::Expected(']')),
            ("1.2.3", Refusal::NotANumber("1.2.3".to_owned())),
            ("foo[1]", Refusal::UnknownFunction("foo".to_owned())),
            ("#<b>", Refusal::ParameterUnset("b".to_owned())),
            ("#<a", Refusal::NameOpen),
            ("exists[1]", Refusal::ExpectedParameter),
        ] {
            assert_eq!(value(text), Err(refusal), "{text}");
        }
        let deep = format!("{}1{}", "[".repeat(200), "]".repeat(200));
        assert_eq!(value(&deep), Err(Refusal::TooDeep { limit: DEEPEST }));
    }
}

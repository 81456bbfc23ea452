//! Units of time and joint position, as headers and options name them.

use std::str::FromStr;

/// Unit of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimeUnit {
    /// s
    Second,
    /// ms
    Millisecond,
    /// us
    Microsecond,
    /// ns
    Nanosecond,
}

impl TimeUnit {
    /// All of them, from the longest.
    pub const ALL: [TimeUnit; 4] = [
        TimeUnit::Second,
        TimeUnit::Millisecond,
        TimeUnit::Microsecond,
        TimeUnit::Nanosecond,
    ];

    /// s in one unit.
    pub fn factor(self) -> f64 {
        match self {
            TimeUnit::Second => 1.0,
            TimeUnit::Millisecond => 1e-3,
            TimeUnit::Microsecond => 1e-6,
            TimeUnit::Nanosecond => 1e-9,
        }
    }

    /// Its symbol.
    pub fn symbol(self) -> &'static str {
        match self {
            TimeUnit::Second => "s",
            TimeUnit::Millisecond => "ms",
            TimeUnit::Microsecond => "us",
            TimeUnit::Nanosecond => "ns",
        }
    }
}

impl FromStr for TimeUnit {
    type Err = ();

    fn from_str(text: &str) -> Result<TimeUnit, ()> {
        let found = TimeUnit::ALL.into_iter().find(|unit| unit.symbol() == text);
        found.or((text == "sec").then_some(TimeUnit::Second)).ok_or(())
    }
}

/// Unit of a joint position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AngleUnit {
    /// deg
    Degree,
    /// rad
    Radian,
}

impl FromStr for AngleUnit {
    type Err = ();

    fn from_str(text: &str) -> Result<AngleUnit, ()> {
        match text {
            "deg" | "grad" | "\u{b0}" => Ok(AngleUnit::Degree),
            "rad" => Ok(AngleUnit::Radian),
            _ => Err(()),
        }
    }
}

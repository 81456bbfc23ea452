//! Units of the lengths of a profile.

use std::fmt;
use std::str::FromStr;

/// A unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LengthUnit {
    /// mm
    Millimetre,
    /// um
    Micrometre,
    /// m
    Metre,
    /// in, 25.4 mm
    Inch,
}

impl LengthUnit {
    /// Its length in m.
    pub fn factor(self) -> f64 {
        match self {
            LengthUnit::Millimetre => 1e-3,
            LengthUnit::Micrometre => 1e-6,
            LengthUnit::Metre => 1.0,
            LengthUnit::Inch => 25.4e-3,
        }
    }
}

/// The text is not a known unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("known units of length are mm, um, m and in")]
pub struct NoUnit;

impl FromStr for LengthUnit {
    type Err = NoUnit;

    fn from_str(text: &str) -> Result<LengthUnit, NoUnit> {
        match text.to_lowercase().as_str() {
            "mm" => Ok(LengthUnit::Millimetre),
            "um" | "\u{b5}m" | "\u{3bc}m" => Ok(LengthUnit::Micrometre),
            "m" => Ok(LengthUnit::Metre),
            "in" | "inch" => Ok(LengthUnit::Inch),
            _ => Err(NoUnit),
        }
    }
}

impl fmt::Display for LengthUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            LengthUnit::Millimetre => "mm",
            LengthUnit::Micrometre => "um",
            LengthUnit::Metre => "m",
            LengthUnit::Inch => "in",
        })
    }
}

//! The units of length that tool path programs count in.

/// Units of length that a program may count in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LengthUnit {
    /// Millimetres, G21.
    #[default]
    Millimetre,
    /// Inches, G20.
    Inch,
}

impl LengthUnit {
    /// Its length, m.
    pub fn metres(self) -> f64 {
        match self {
            LengthUnit::Millimetre => 1e-3,
            LengthUnit::Inch => 25.4e-3,
        }
    }

    /// How many of `other` make one of it.
    pub(super) fn in_units_of(self, other: LengthUnit) -> f64 {
        match (self, other) {
            (LengthUnit::Inch, LengthUnit::Millimetre) => 25.4,
            (LengthUnit::Millimetre, LengthUnit::Inch) => 1.0 / 25.4,
            _ => 1.0,
        }
    }
}

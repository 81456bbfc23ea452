//! The units of length that tool path programs count in.

/// Units of length that a program may count in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LengthUnit {
    /// Millimetres.
    #[default]
    Millimetre,
    /// Inches of 25.4 mm.
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

    /// That of two values which is in this unit: mm, inch.
    pub(super) fn choose(self, of: [f64; 2]) -> f64 {
        match self {
            LengthUnit::Millimetre => of[0],
            LengthUnit::Inch => of[1],
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

//! The unit of length of a mesh: given by the file (3MF, DAE), or estimated from its size.

use armill_core::units::{from_mm, from_um};

/// A longest side below this is in m: no machined part and no link of a robot has 5 mm.
const LONGEST_IN_METRES: f64 = 5.0;
/// A longest side above this is in mm: no cell has 50 m.
const SHORTEST_IN_MILLIMETRES: f64 = 50.0;
/// Smallest and largest unit that a file may give, m.
const UNITS_M: [f64; 2] = [1e-9, 1e6];

/// A unit of length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshUnit {
    metres: f64,
}

impl MeshUnit {
    /// The metre.
    pub const METRE: MeshUnit = MeshUnit { metres: 1.0 };

    /// The millimetre.
    pub fn millimetre() -> MeshUnit {
        MeshUnit { metres: from_mm(1.0) }
    }

    /// A unit of this length in m; `None` unless it is between 1e-9 and 1e6 m.
    pub fn of_metres(metres: f64) -> Option<MeshUnit> {
        (UNITS_M[0]..=UNITS_M[1])
            .contains(&metres)
            .then_some(MeshUnit { metres })
    }

    /// The unit of this name in 3MF: `micron`, `millimeter`, `centimeter`, `inch`, `foot`, `meter`.
    pub(super) fn named(name: &str) -> Option<MeshUnit> {
        let metres = match name {
            "micron" => from_um(1.0),
            "millimeter" => from_mm(1.0),
            "centimeter" => from_mm(10.0),
            "inch" => from_mm(25.4),
            "foot" => from_mm(304.8),
            "meter" => 1.0,
            _ => return None,
        };
        Some(MeshUnit { metres })
    }

    /// Its length, m.
    pub fn metres(self) -> f64 {
        self.metres
    }
}

/// The likely unit of a mesh whose longest side (of its bounds, along an axis) has this length in file units: m below 5,
/// mm above 50, `None` between, where it may be either.
///
/// A guess: a part of 2 mm in mm is taken for one of 2 m.
pub fn likely_unit(longest_side: f64) -> Option<MeshUnit> {
    if longest_side < LONGEST_IN_METRES {
        Some(MeshUnit::METRE)
    } else if longest_side > SHORTEST_IN_MILLIMETRES {
        Some(MeshUnit::millimetre())
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_have_the_length_of_the_standard() {
        let lengths = ["micron", "millimeter", "centimeter", "inch", "foot", "meter"]
            .map(|name| MeshUnit::named(name).map(MeshUnit::metres));
        let expected = [1e-6, 1e-3, 1e-2, 0.0254, 0.3048, 1.0];
        for (length, expected) in lengths.into_iter().zip(expected) {
            assert!((length.unwrap() - expected).abs() < 1e-15 * expected);
        }
        assert_eq!(MeshUnit::named("furlong"), None);
    }

    #[test]
    fn a_unit_without_a_sensible_length_is_refused() {
        for metres in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-10, 1e7] {
            assert_eq!(MeshUnit::of_metres(metres), None, "{metres}");
        }
        assert_eq!(MeshUnit::of_metres(0.0254).map(MeshUnit::metres), Some(0.0254));
    }

    #[test]
    fn small_numbers_are_metres_and_large_ones_millimetres() {
        assert_eq!(likely_unit(1.3), Some(MeshUnit::METRE));
        assert_eq!(likely_unit(5.0), None);
        assert_eq!(likely_unit(50.0), None);
        assert_eq!(likely_unit(300.0), Some(MeshUnit::millimetre()));
    }
}

//! The units of files and of people: um, mm, degrees. Inside, everything is SI.
//!
//! ```text
//! file, option, request -> from_mm, from_um, from_deg -> SI -> to_mm, to_um, to_deg -> answer, table, message
//! ```
//!
//! The one place of these factors: `cargo xtask tidy` finds a factor written elsewhere. Lengths may be numbers,
//! vectors or references to them; what is a length per something else, such as a compliance in m/N, takes the functions
//! of lengths.

use core::ops::Mul;

/// m (or m per any unit) in um.
pub fn to_um<T: Mul<f64>>(metres: T) -> T::Output {
    metres * 1e6
}

/// m (or m per any unit) in mm.
pub fn to_mm<T: Mul<f64>>(metres: T) -> T::Output {
    metres * 1e3
}

/// rad (or rad per any unit) in urad.
pub fn to_urad<T: Mul<f64>>(radians: T) -> T::Output {
    radians * 1e6
}

/// urad in rad.
pub fn from_urad(urad: f64) -> f64 {
    urad * 1e-6
}

/// s in ms.
pub fn to_ms(seconds: f64) -> f64 {
    seconds * 1e3
}

/// ms in s.
pub fn from_ms(ms: f64) -> f64 {
    ms * 1e-3
}

/// um (or um per any unit) in m.
pub fn from_um<T: Mul<f64>>(um: T) -> T::Output {
    um * 1e-6
}

/// mm (or mm per any unit) in m.
pub fn from_mm<T: Mul<f64>>(mm: T) -> T::Output {
    mm * 1e-3
}

/// mm in um.
pub fn um_from_mm(mm: f64) -> f64 {
    mm * 1e3
}

/// m2 in mm2.
pub fn to_mm2(square_metres: f64) -> f64 {
    square_metres * 1e6
}

/// Something per m, such as a stiffness in N/m, per mm.
pub fn to_per_mm(per_metre: f64) -> f64 {
    per_metre * 1e-3
}

/// Something per um, from per m.
pub fn to_per_um(per_metre: f64) -> f64 {
    per_metre * 1e-6
}

/// Something per mm, such as a stiffness in N/mm, per m.
pub fn from_per_mm(per_mm: f64) -> f64 {
    per_mm * 1e3
}

/// rad in degrees.
pub fn to_deg(radians: impl Angle) -> f64 {
    radians.value().to_degrees()
}

/// Degrees in rad.
pub fn from_deg(degrees: impl Angle) -> f64 {
    degrees.value().to_radians()
}

/// An angle or a reference to one, so that `map(to_deg)` serves both.
pub trait Angle {
    /// The number itself.
    fn value(self) -> f64;
}

impl Angle for f64 {
    fn value(self) -> f64 {
        self
    }
}

impl Angle for &f64 {
    fn value(self) -> f64 {
        *self
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;

    #[test]
    fn lengths_and_angles_in_the_units_of_people() {
        assert_eq!(
            (to_um(2e-6), to_mm(&0.5), to_deg(core::f64::consts::PI)),
            (2.0, 500.0, 180.0)
        );
        assert_eq!(
            to_mm(Vector3::new(0.1, 0.0, -1.0)),
            Vector3::new(100.0, 0.0, -1000.0)
        );
        assert_eq!(
            (from_um(4.0), from_mm(12.0), from_deg(90.0)),
            (4e-6, 0.012, core::f64::consts::FRAC_PI_2)
        );
    }
}

//! Material and circular or annular cross section of a beam.
//!
//! ```text
//! A = pi/4 (D^2 - d^2)      I = pi/64 (D^4 - d^4)      J = 2 I      G = E / (2 (1 + nu))
//! k = 6 (1 + nu)(1 + m^2)^2 / ((7 + 6 nu)(1 + m^2)^2 + (20 + 12 nu) m^2)      m = d / D
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `D`, `d` | outer diameter; bore, 0 if solid | m |
//! | `A`, `I`, `J` | area, second moment about a diameter, polar moment | m^2, m^4, m^4 |
//! | `E`, `G`, `nu` | Young's modulus, shear modulus, Poisson's ratio | Pa, Pa, - |
//! | `k` | shear coefficient | - |
//!
//! A cutter with flutes is a solid cylinder of an equivalent diameter. Source: Cowper, The shear coefficient in Timoshenko's beam theory, J. Appl. Mech. 33
//! (1966) 335-340 (recalled); [`FLUTED`] after Kops & Vo, CIRP Annals 39/1 (1990) 93-96 (recalled).

use std::f64::consts::PI;

/// Equivalent diameter of the fluted part of an end mill over its diameter.
pub const FLUTED: f64 = 0.8;

/// An isotropic material with structural damping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// `E`: Young's modulus, Pa.
    pub modulus: f64,
    /// `rho`: density, kg/m^3.
    pub density: f64,
    /// `nu`: Poisson's ratio.
    pub poisson: f64,
    /// `eta`: loss factor; the modulus is `E (1 + i eta)`.
    pub loss_factor: f64,
}

/// A circular or annular cross section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// `D`: outer diameter, m.
    pub outer: f64,
    /// `d`: diameter of the bore, below that outside, m.
    pub bore: f64,
}

impl Section {
    /// `A`, m^2.
    pub fn area(&self) -> f64 {
        PI / 4.0 * (self.outer.powi(2) - self.bore.powi(2))
    }

    /// `I` about a diameter, m^4.
    pub fn second_moment(&self) -> f64 {
        PI / 64.0 * (self.outer.powi(4) - self.bore.powi(4))
    }

    /// `k` of Cowper.
    pub fn shear_coefficient(&self, poisson: f64) -> f64 {
        let m = (self.bore / self.outer).powi(2);
        let both = (1.0 + m).powi(2);
        6.0 * (1.0 + poisson) * both / ((7.0 + 6.0 * poisson) * both + (20.0 + 12.0 * poisson) * m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shear_coefficients_are_those_of_the_solid_and_the_thin_tube() {
        let of = |bore: f64| Section { outer: 1.0, bore }.shear_coefficient(0.3);
        // Solid: 6 (1 + nu)/(7 + 6 nu) = 7.8/8.8. Thin tube: 2 (1 + nu)/(4 + 3 nu) = 2.6/4.9.
        assert!((of(0.0) - 7.8 / 8.8).abs() < 1e-15);
        assert!((of(1.0) - 2.6 / 4.9).abs() < 1e-15);
    }

    #[test]
    fn area_and_second_moment_of_a_tube() {
        // D = 40, d = 20 mm: A = 300 pi mm^2, I = 37500 pi mm^4.
        let tube = Section {
            outer: 0.04,
            bore: 0.02,
        };
        assert!((tube.area() / (300e-6 * PI) - 1.0).abs() < 1e-14);
        assert!((tube.second_moment() / (37_500e-12 * PI) - 1.0).abs() < 1e-14);
    }
}

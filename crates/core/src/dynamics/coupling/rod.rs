//! Stretching and torsion of a uniform beam: dynamic stiffness of its ends.
//!
//! ```text
//! D = K z/sin(z) | cos z   -1   |      z = w L sqrt(rho/E),  K = E A/L      torsion: E -> G, A -> J
//!                |  -1    cos z |
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `K` | static stiffness | N/m, N m/rad |
//! | `w`, `L`, others | angular frequency, length, [`super::section`]; `E`, `G` complex | rad/s, m |
//!
//! Source: the wave equation of any text on vibration.

use nalgebra::Complex;

use super::segment::Segment;

/// Below this `z` its sine is summed as a series: two terms are left out of order `z^6`.
const SMALL: f64 = 1e-3;

/// Stiffness of an end by itself, and of one by the displacement of the other.
#[derive(Clone, Copy, Debug)]
pub(super) struct RodStiffness {
    /// Of both ends.
    pub own: Complex<f64>,
    /// Between them.
    pub across: Complex<f64>,
}

/// Stretching, N/m.
pub(super) fn stretching(segment: &Segment, w: f64) -> RodStiffness {
    let modulus = Complex::new(1.0, segment.material.loss_factor) * segment.material.modulus;
    of(segment, w, modulus, segment.section.area())
}

/// Torsion, N m/rad.
pub(super) fn torsion(segment: &Segment, w: f64) -> RodStiffness {
    let material = &segment.material;
    let shear =
        Complex::new(1.0, material.loss_factor) * (material.modulus / (2.0 * (1.0 + material.poisson)));
    of(segment, w, shear, 2.0 * segment.section.second_moment())
}

fn of(segment: &Segment, w: f64, modulus: Complex<f64>, moment: f64) -> RodStiffness {
    let z = (Complex::new(segment.material.density, 0.0) / modulus).sqrt() * (w * segment.length);
    let stiffness = modulus * (moment / segment.length);
    let square = z * z;
    let ratio = match z.norm() < SMALL {
        // z/sin z
        true => Complex::new(1.0, 0.0) + square / 6.0 + square * square * (7.0 / 360.0),
        false => z / z.sin(),
    };
    RodStiffness {
        own: stiffness * ratio * z.cos(),
        across: -stiffness * ratio,
    }
}

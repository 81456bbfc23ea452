//! Stretching and torsion of a uniform beam: transfer matrix from one end to the other.
//!
//! ```text
//! | u_2 |   | cos z               L/(E A) sin(z)/z | | u_1 |     z = w L sqrt(rho/E)
//! | N_2 | = | -(E A/L) z sin z    cos z            | | N_1 |     torsion: E -> G, A -> J
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `u`, `N` | displacement; force that the part of larger z exerts (torsion: turn, torque) | m, N (rad, N m) |
//! | `w`, `L`, others | angular frequency, length, [`super::section`]; `E`, `G` complex | rad/s, m |
//!
//! Source: the wave equation of any text on vibration.

use nalgebra::{Complex, Matrix2};

use super::segment::Segment;

/// Below this `z` its sine is summed as a series: what is left out is of order `z^6`.
const SMALL: f64 = 1e-3;

/// Transfer in stretching of a piece of this length: m, N.
pub(super) fn stretching(segment: &Segment, length: f64, w: f64) -> Matrix2<Complex<f64>> {
    let modulus = Complex::new(1.0, segment.material.loss_factor) * segment.material.modulus;
    let z = wave_number(segment, modulus, w) * length;
    transfer(z, modulus * (segment.section.area() / length))
}

/// Transfer in torsion of a piece of this length: rad, N m.
pub(super) fn torsion(segment: &Segment, length: f64, w: f64) -> Matrix2<Complex<f64>> {
    let material = &segment.material;
    let shear =
        Complex::new(1.0, material.loss_factor) * (material.modulus / (2.0 * (1.0 + material.poisson)));
    let z = wave_number(segment, shear, w) * length;
    transfer(z, shear * (2.0 * segment.section.second_moment() / length))
}

/// `w sqrt(rho/E)`, rad/m.
fn wave_number(segment: &Segment, modulus: Complex<f64>, w: f64) -> Complex<f64> {
    (Complex::new(segment.material.density, 0.0) / modulus).sqrt() * w
}

/// `stiffness`: `E A/L`.
fn transfer(z: Complex<f64>, stiffness: Complex<f64>) -> Matrix2<Complex<f64>> {
    let square = z * z;
    let ratio = match z.norm() < SMALL {
        // sin z/z
        true => Complex::new(1.0, 0.0) - square / 6.0 + square * square / 120.0,
        false => z.sin() / z,
    };
    Matrix2::new(z.cos(), ratio / stiffness, -stiffness * square * ratio, z.cos())
}

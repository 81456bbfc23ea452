//! Bending of a uniform beam in one plane: transfer matrix from one end to the other.
//!
//! ```text
//! s = (v/L, p, Q L^2/(E I), M L/(E I))      ds/dz = a s / L      s_2 = exp(a) s_1
//!     | 0  1  c  0 |
//! a = | 0  0  0  1 |     b = w^2 rho A L^4/(E I)      r = w^2 rho L^2/E      c = E I/(k G A L^2)
//!     |-b  0  0  0 |
//!     | 0 -r -1  0 |     Euler and Bernoulli: c = r = 0
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `v`, `p` | deflection; rotation of the section, `dv/dz` if shear is neglected | m, rad |
//! | `Q`, `M` | shear force and bending moment that the part of larger z exerts | N, N m |
//! | `w`, `L`, others | angular frequency, length, [`super::section`]; `E`, `G` complex | rad/s, m |
//!
//! The exponential is summed as a power series, of a piece short enough. Source: Timoshenko's beam of any text; Weaver, Timoshenko, Young, Vibration
//! problems in engineering (recalled).

use nalgebra::{Complex, Matrix4};

use super::segment::{BeamTheory, Segment};

/// Largest coefficient of the characteristic polynomial of `a` of a short piece.
const SHORT: f64 = 1.0;
/// Terms of the exponential at most.
const MOST_TERMS: usize = 60;

/// The dimensionless numbers of a piece.
pub(super) struct Bending {
    b: Complex<f64>,
    r: Complex<f64>,
    c: f64,
    /// `E I`.
    stiffness: Complex<f64>,
    /// `L`.
    length: f64,
}

impl Bending {
    /// Of a piece of this length at `w` (rad/s).
    pub(super) fn of(segment: &Segment, length: f64, w: f64) -> Bending {
        let (section, material) = (&segment.section, &segment.material);
        let modulus = Complex::new(1.0, material.loss_factor) * material.modulus;
        let (area, moment) = (section.area(), section.second_moment());
        let inertia = w * w * material.density;
        let shear = 2.0 * (1.0 + material.poisson) / section.shear_coefficient(material.poisson);
        let [r, c] = match segment.theory {
            BeamTheory::Timoshenko => [1.0, shear * moment / (area * length.powi(2))],
            BeamTheory::Euler => [0.0, 0.0],
        };
        Bending {
            b: inertia * area * length.powi(4) / (modulus * moment),
            r: inertia * length.powi(2) * r / modulus,
            c,
            stiffness: modulus * moment,
            length,
        }
    }

    /// Whether the power series of this piece is short, without large terms that cancel.
    pub(super) fn is_short(&self) -> bool {
        let (b, r, c) = (self.b, self.r, self.c);
        [b, r, b * c, b * r * c]
            .iter()
            .all(|number| number.norm() <= SHORT)
    }

    /// Transfer of `v`, `p`, `Q`, `M`; m, rad, N, N m.
    pub(super) fn transfer(&self) -> Matrix4<Complex<f64>> {
        let (zero, one) = (Complex::new(0.0, 0.0), Complex::new(1.0, 0.0));
        #[rustfmt::skip]
        let a = Matrix4::new(
            zero, one, Complex::new(self.c, 0.0), zero,
            zero, zero, zero, one,
            -self.b, zero, zero, zero,
            zero, -self.r, -one, zero,
        );
        let scaled = exponential(&a);
        let moment = self.stiffness / self.length;
        let size = [Complex::new(self.length, 0.0), one, moment / self.length, moment];
        Matrix4::from_fn(|i, j| scaled[(i, j)] * size[i] / size[j])
    }
}

fn exponential(a: &Matrix4<Complex<f64>>) -> Matrix4<Complex<f64>> {
    let mut sum = Matrix4::identity();
    let mut term = Matrix4::identity();
    for k in 1..=MOST_TERMS {
        term = term * a / Complex::new(k as f64, 0.0);
        sum += term;
        if term.norm() <= f64::EPSILON * sum.norm() * 1e-6 {
            break;
        }
    }
    sum
}

//! An elastic connection without length: taper, collet, shrink fit.
//!
//! ```text
//! C_k = 1 / (k_k (1 + i eta) + i w c_k)      0 where the joint is rigid
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `k_k` | stiffness along x, y, z and about x, y, z | N/m, N m/rad |
//! | `c_k` | viscous damping | N s/m, N m s/rad |
//! | `eta` | loss factor | - |
//!
//! The joint has the same stiffness in all directions across the axis. Source: Schmitz & Smith, Machining dynamics (recalled).

use nalgebra::{Complex, Matrix6};

/// Stiffness and damping along or about one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spring {
    /// `k`, above 0, N/m or N m/rad; none: rigid.
    pub stiffness: Option<f64>,
    /// `c`, N s/m or N m s/rad.
    pub damping: f64,
}

/// A joint; the axis of the beam is z.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Joint {
    /// Across the axis.
    pub lateral: Spring,
    /// Along the axis.
    pub axial: Spring,
    /// About directions across the axis.
    pub bending: Spring,
    /// About the axis.
    pub torsion: Spring,
    /// `eta`: loss factor of all stiffnesses.
    pub loss_factor: f64,
}

impl Joint {
    /// Compliance at the angular frequency `w` (rad/s): diagonal, m/N and rad/(N m).
    pub fn compliance(&self, w: f64) -> Matrix6<Complex<f64>> {
        let of = |spring: &Spring| match spring.stiffness {
            None => Complex::new(0.0, 0.0),
            Some(k) => Complex::new(k, k * self.loss_factor + w * spring.damping).inv(),
        };
        let [lateral, axial] = [of(&self.lateral), of(&self.axial)];
        let [bending, torsion] = [of(&self.bending), of(&self.torsion)];
        let diagonal = [lateral, lateral, axial, bending, bending, torsion];
        Matrix6::from_fn(|i, j| {
            if i == j {
                diagonal[i]
            } else {
                Complex::new(0.0, 0.0)
            }
        })
    }
}

//! Modes of vibration of an arm, from its mass matrix and the compliances of its drives and springs.
//!
//! ```text
//! M d2x/dt2 + D dx/dt + C^-1 x = s^T w        twist of the tool = s x
//! C^1/2 M C^1/2 y = y / omega^2               x = omega C^1/2 y,  y^T y = 1:  x^T M x = 1
//! phi = s x        e_k = y_k^2        2 zeta omega = x^T D x
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `M`, `C`, `D` | mass matrix, compliances and viscous damping of drives, then springs; `C`, `D` diagonal | kg m^2, rad/(N m), N m s/rad |
//! | `s` | their screws at the TCP, base | m/rad, rad/rad |
//! | `x` | their deflections in a mode, normalised by mass | rad/(m sqrt(kg)) |
//! | `phi` | shape at the tool ([`super::mode`]) | 1/sqrt(kg), rad/(m sqrt(kg)) |
//! | `e_k` | share of the potential energy; the sum over `k` is 1 | - |
//! | `omega`, `zeta` | undamped angular frequency, damping ratio | rad/s, - |
//!
//! A rigid drive or spring (`c = 0`) does not move. A motion without mass has no mode: it follows statically, and its compliance
//! is the `static_compliance`. Damping between modes is neglected: valid where `zeta` is small and frequencies are apart.
//! Source: any text on vibration; the symmetric form is the usual one with stiffness and mass exchanged.

use nalgebra::{DMatrix, Matrix6, Vector3, Vector6};

use super::mode::Mode;
use crate::robot::Damping;
use crate::spatial::Twist;

/// Damping ratio of every mode of an arm whose damping is not known. Published modal tests of machining robots have 0.01 to 0.06
/// (recalled).
pub const ASSUMED_DAMPING: f64 = 0.03;

/// The range of published damping ratios of machining robots (recalled).
pub const PUBLISHED_DAMPING: [f64; 2] = [0.01, 0.06];

/// Greatest damping ratio of a mode with viscous dampers: beyond it nothing vibrates.
const OVERDAMPED: f64 = 0.999;

/// Modes of an arm in one posture.
#[derive(Clone, Debug, PartialEq)]
pub struct ArmModes {
    /// The modes, frequencies rising.
    pub modes: Vec<ArmMode>,
    /// Compliance at the tool of the motions without mass, which have no mode: 6 x 6, base, m/N, 1/N, rad/(N m).
    pub static_compliance: Matrix6<f64>,
}

/// One mode of an arm.
#[derive(Clone, Debug, PartialEq)]
pub struct ArmMode {
    /// Frequency, damping and shape at the tool, base axes.
    pub at_tool: Mode,
    /// `e_k`: share of each drive, then each spring, in the potential energy.
    pub shares: Vec<f64>,
    /// `x`: deflection of each drive, then each spring, normalised by mass.
    pub deflections: Vec<f64>,
}

impl ArmMode {
    /// Modal mass in the direction `n` (unit, base) of the tool's translation, kg; infinite where the tool does not move along it.
    pub fn modal_mass(&self, n: &Vector3<f64>) -> f64 {
        let phi = self.at_tool.shape.fixed_rows::<3>(0).dot(n);
        1.0 / (phi * phi)
    }

    /// Relative standard uncertainty of the frequency by the covariance `S_kl` of the compliances `c`: `u(f)/f = u(ln c)/2`,
    /// weighted with the shares: `d ln omega = -1/2 sum e_k d ln c_k`.
    pub fn relative_uncertainty(&self, compliances: &[f64], covariance: impl Fn(usize, usize) -> f64) -> f64 {
        let weight = |k: usize| match compliances[k] > 0.0 {
            true => 0.5 * self.shares[k] / compliances[k],
            false => 0.0,
        };
        let size = self.shares.len();
        let mut variance = 0.0;
        for k in 0..size {
            for l in 0..size {
                variance += weight(k) * weight(l) * covariance(k, l);
            }
        }
        variance.max(0.0).sqrt()
    }
}

/// Modes of drives, then springs, with these screws at the TCP, these compliances (rad/(N m), m/N; not negative), and this mass matrix.
///
/// # Panics
/// If the number of compliances or the size of `mass` is not that of `screws`.
pub fn modes_of(
    mass: &DMatrix<f64>,
    screws: &[Twist],
    compliances: &[f64],
    damping: Option<&Damping>,
) -> ArmModes {
    let moving: Vec<usize> = (0..screws.len()).filter(|k| compliances[*k] > 0.0).collect();
    let roots: Vec<f64> = moving.iter().map(|k| compliances[*k].sqrt()).collect();
    let size = moving.len();
    let weighed = DMatrix::from_fn(size, size, |i, j| {
        roots[i] * mass[(moving[i], moving[j])] * roots[j]
    });
    let mut found = ArmModes {
        modes: Vec::new(),
        static_compliance: Matrix6::zeros(),
    };
    if size == 0 {
        return found;
    }
    let eigen = weighed.symmetric_eigen();
    let (values, vectors) = (eigen.eigenvalues, eigen.eigenvectors);
    let mut order: Vec<usize> = (0..size).collect();
    order.sort_by(|a, b| values[*b].total_cmp(&values[*a]));
    // `size` products of rounding each are left of a zero; a hundred times that is zero.
    let zero = values.max().max(0.0) * 1e2 * size as f64 * f64::EPSILON;
    for column in order {
        let (value, y) = (values[column], vectors.column(column));
        let omega = 1.0 / value.sqrt();
        let scale = if value > zero { omega } else { 1.0 };
        let mut shape = Vector6::zeros();
        for (i, k) in moving.iter().enumerate() {
            shape += screws[*k].to_vector() * (scale * roots[i] * y[i]);
        }
        if value <= zero {
            found.static_compliance += shape * shape.transpose();
            continue;
        }
        let mut shares = vec![0.0; screws.len()];
        let mut deflections = vec![0.0; screws.len()];
        for (i, k) in moving.iter().enumerate() {
            shares[*k] = y[i] * y[i];
            deflections[*k] = scale * roots[i] * y[i];
        }
        let mode = Mode {
            angular_frequency: omega,
            damping_ratio: damping_ratio(damping, &deflections, omega),
            shape,
        };
        found.modes.push(ArmMode {
            at_tool: mode,
            shares,
            deflections,
        });
    }
    found
}

/// `zeta` of a mode with these deflections.
fn damping_ratio(damping: Option<&Damping>, deflections: &[f64], omega: f64) -> f64 {
    match damping {
        None => ASSUMED_DAMPING,
        Some(Damping::Ratio(ratio)) => *ratio,
        Some(Damping::Joints(dampers)) => {
            let each = dampers.iter().zip(deflections);
            let lost: f64 = each.map(|(damper, x)| damper * x * x).sum();
            (lost / (2.0 * omega)).min(OVERDAMPED)
        }
    }
}

#[cfg(test)]
mod tests;

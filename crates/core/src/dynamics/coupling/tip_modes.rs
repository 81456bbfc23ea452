//! Modes of a coupled tip: poles fitted to its receptances, and real shapes from their residues.
//!
//! ```text
//! G_ij(w) ~ sum_r A_r,ij / (omega_r^2 - w^2 + 2 i zeta_r omega_r w) + residuals       i, j: x, y, z
//! A_r = sum_k l_k n_k n_k^T      phi = sqrt(l_k) n_k
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `omega_r`, `zeta_r`, `A_r` | pole and residues of [`modal_fit`](super::super::modal_fit), common to all `G_ij` | rad/s, -, 1/kg |
//! | `l_k`, `n_k` | eigenvalues and eigenvectors of the symmetric `A_r` | 1/kg, - |
//!
//! A round tool on a machine of the same stiffness in two directions has two modes of one frequency: `A_r` has then two equal eigenvalues, and each
//! gives a mode. Eigenvalues below [`LEAST`] of the largest of all poles at this frequency, and negative ones, are left out. Structural damping is described by
//! equal viscous damping at resonance.

use nalgebra::{Matrix3, Vector3, Vector6};

use super::super::modal_fit::{Dof, FitError, FitOptions, Frf, ModalFit, fit};
use super::super::mode::Mode;
use super::sweep::Swept;

/// Eigenvalues below this part of the largest of a pole are left out.
pub const LEAST: f64 = 0.02;
/// Receptances below this part of the largest of all at one frequency are taken as zero.
const NOTHING: f64 = 1e-9;
/// The pairs of directions of a symmetric receptance.
const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

/// Modes of a tip and how well they describe it.
#[derive(Clone, Debug, PartialEq)]
pub struct TipFit {
    /// The modes, frequencies rising; the rotation in their shapes is not known and zero.
    pub modes: Vec<Mode>,
    /// Largest deviation of the modes alone from the receptance, over the largest receptance in that direction; x, y, z.
    pub deviation: [f64; 3],
}

/// Modes of the translation of the tip within the frequencies of the sweep.
///
/// # Errors
/// Too few frequencies; no mode.
pub fn tip_modes(swept: &[Swept], most: Option<usize>) -> Result<TipFit, FitError> {
    let (Some(first), Some(last)) = (swept.first(), swept.last()) else {
        return Err(FitError::TooFew(0));
    };
    let frfs: Vec<Frf> = PAIRS.iter().filter_map(|pair| frf(swept, *pair)).collect();
    let found = fit(
        &frfs,
        &FitOptions {
            band: [first.w, last.w],
            modes: most,
            // What is left over is the difference of structural from viscous damping, not noise.
            seeks_weak: false,
        },
    )?;
    let mut modes = modes_of(&found, &frfs);
    if modes.is_empty() {
        return Err(FitError::NoMode);
    }
    modes.sort_by(|a, b| a.angular_frequency.total_cmp(&b.angular_frequency));
    Ok(TipFit {
        deviation: deviation(swept, &modes),
        modes,
    })
}

/// The receptance between two directions; `None` if there is none.
fn frf(swept: &[Swept], pair: [usize; 2]) -> Option<Frf> {
    let [i, j] = pair;
    let at = |axis: usize| Dof { point: 1, axis };
    let is_something = swept.iter().any(|own| {
        let largest = (0..3).map(|k| own.tip[(k, k)].norm()).fold(0.0, f64::max);
        own.tip[(i, j)].norm() > NOTHING * largest
    });
    is_something.then(|| Frf {
        response: at(i),
        reference: at(j),
        angular_frequencies: swept.iter().map(|own| own.w).collect(),
        receptance: swept.iter().map(|own| own.tip[(i, j)]).collect(),
        // Of one size over all frequencies, also between a high and a low resonance.
        weights: swept
            .iter()
            .map(|own| (own.tip[(i, i)].norm() * own.tip[(j, j)].norm()).powf(-0.25))
            .collect(),
    })
}

fn modes_of(found: &ModalFit, frfs: &[Frf]) -> Vec<Mode> {
    let mut modes = Vec::new();
    for own in &found.modes {
        let mut residues = Matrix3::zeros();
        for (frf, residue) in frfs.iter().zip(&own.residues) {
            let (i, j) = (frf.response.axis, frf.reference.axis);
            residues[(i, j)] = *residue;
            residues[(j, i)] = *residue;
        }
        let eigen = residues.symmetric_eigen();
        let largest = eigen.eigenvalues.max();
        for (value, direction) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
            if *value > LEAST * largest && *value > 0.0 {
                let mut direction: Vector3<f64> = direction.into_owned();
                if direction[direction.iamax()] < 0.0 {
                    direction.neg_mut();
                }
                let phi = direction * value.sqrt();
                modes.push(Mode {
                    angular_frequency: own.angular_frequency,
                    damping_ratio: own.damping_ratio,
                    shape: Vector6::new(phi.x, phi.y, phi.z, 0.0, 0.0, 0.0),
                });
            }
        }
    }
    modes
}

/// See [`TipFit::deviation`].
fn deviation(swept: &[Swept], modes: &[Mode]) -> [f64; 3] {
    let (mut most, mut largest) = ([0.0_f64; 3], [0.0_f64; 3]);
    for own in swept {
        let by_modes = super::super::receptance(modes, own.w);
        for k in 0..3 {
            most[k] = most[k].max((by_modes[(k, k)] - own.tip[(k, k)]).norm());
            largest[k] = largest[k].max(own.tip[(k, k)].norm());
        }
    }
    [0, 1, 2].map(|k| most[k] / largest[k])
}

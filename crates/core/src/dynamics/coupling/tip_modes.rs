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
//! gives a mode. Poles closer than half of their half widths are one group, whose residues are added. Eigenvalues below [`LEAST`] of the largest of a group, and negative ones, are left out; then `rank_one` fits poles and shapes
//! together. Structural damping is described by
//! equal viscous damping at resonance.

use nalgebra::{Matrix3, Vector3, Vector6};

use super::super::modal_fit::{Dof, FitError, FitOptions, FittedMode, Frf, ModalFit, fit};
use super::super::mode::Mode;
use super::rank_one::refined;
use super::sweep::Swept;

/// Eigenvalues below this part of the largest of a group of poles are left out.
pub const LEAST: f64 = 0.1;
/// Poles closer than this, in half widths of their peaks, are one group.
const CLOSE: f64 = 0.5;
/// Receptances below this part of the largest of all at one frequency are taken as zero.
const NOTHING: f64 = 1e-9;
/// The pairs of directions of a symmetric receptance.
const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

/// Modes of a tip and how well they describe it.
#[derive(Clone, Debug, PartialEq)]
pub struct TipFit {
    /// The modes, frequencies rising; the rotation in their shapes is not known and zero.
    pub modes: Vec<Mode>,
    /// Largest deviation of the modes alone from the receptance in x, y, z, over the largest receptance of all directions.
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
    let first = modes_of(&found, &frfs);
    if first.is_empty() {
        return Err(FitError::NoMode);
    }
    let mut modes = refined(&frfs, &first);
    for mode in &mut modes {
        if mode.shape[mode.shape.iamax()] < 0.0 {
            mode.shape.neg_mut();
        }
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

/// Modes with one shape each from the residues of the fitted poles; poles closer than [`CLOSE`] half widths together, as only the sum of their
/// residues is determined.
fn modes_of(found: &ModalFit, frfs: &[Frf]) -> Vec<Mode> {
    let is_close = |one: &FittedMode, other: &FittedMode| {
        let apart = other.angular_frequency - one.angular_frequency;
        apart < CLOSE * one.damping_ratio * one.angular_frequency
    };
    // The modes of a fit are in the order of their frequencies.
    let groups = found.modes.chunk_by(is_close);
    groups.flat_map(|group| of_group(group, frfs)).collect()
}

fn of_group(group: &[FittedMode], frfs: &[Frf]) -> Vec<Mode> {
    let mean = |part: &dyn Fn(&FittedMode) -> f64| group.iter().map(part).sum::<f64>() / group.len() as f64;
    let mut residues = Matrix3::zeros();
    for (index, frf) in frfs.iter().enumerate() {
        let (i, j) = (frf.response.axis, frf.reference.axis);
        let residue: f64 = group.iter().map(|own| own.residues[index]).sum();
        residues[(i, j)] = residue;
        residues[(j, i)] = residue;
    }
    let eigen = residues.symmetric_eigen();
    let least = LEAST * eigen.eigenvalues.max().max(0.0);
    let pairs = eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter());
    let kept = pairs.filter(|(value, _)| **value > least);
    kept.map(|(value, direction)| {
        let phi: Vector3<f64> = direction * value.sqrt();
        Mode {
            angular_frequency: mean(&|own| own.angular_frequency),
            damping_ratio: mean(&|own| own.damping_ratio),
            shape: Vector6::new(phi.x, phi.y, phi.z, 0.0, 0.0, 0.0),
        }
    })
    .collect()
}

/// See [`TipFit::deviation`].
fn deviation(swept: &[Swept], modes: &[Mode]) -> [f64; 3] {
    let (mut most, mut largest) = ([0.0_f64; 3], 0.0_f64);
    for own in swept {
        let by_modes = super::super::receptance(modes, own.w);
        for k in 0..3 {
            most[k] = most[k].max((by_modes[(k, k)] - own.tip[(k, k)]).norm());
            largest = largest.max(own.tip[(k, k)].norm());
        }
    }
    most.map(|part| part / largest)
}

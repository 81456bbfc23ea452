//! Shape of a fitted mode in the measured degrees of freedom, normalised by mass.
//!
//! ```text
//! sum over k of (a_k - phi_i phi_j)^2 -> least,   i, j: response and reference of FRF k
//! cov(phi) = G cov(a) G^T,   G = (D^T D)^-1 D^T,   D_k: phi_j at i, phi_i at j
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `a_k` | residue of FRF k ([`super::fit`](mod@super::fit)) | 1/kg |
//! | `phi_i` | shape at the degree of freedom i | 1/sqrt(kg) |
//!
//! A drive point, where response and reference are the same, gives the scale. The sign of the largest part is positive. Source: Ewins, Modal
//! testing (recalled).

use nalgebra::{DMatrix, DVector};
use thiserror::Error;

use super::fit::FittedMode;
use super::frf::{Dof, Frf};

/// Steps of Gauss and Newton at most.
const MOST_STEPS: usize = 100;
/// The relative change that ends the search.
const END: f64 = 1e-14;

/// The shape of a mode.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredShape {
    /// The degrees of freedom, rising.
    pub dofs: Vec<Dof>,
    /// `phi` at each, 1/sqrt(kg).
    pub shape: Vec<f64>,
    /// Covariance of `phi`, 1/kg.
    pub covariance: DMatrix<f64>,
}

/// Why a mode has no shape that is normalised by mass.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum NoShape {
    /// No FRF has force and displacement at the same degree of freedom.
    #[error(
        "no drive point: no FRF has its force and its displacement at the same point in the same direction"
    )]
    NoDrivePoint,
    /// Residues of drive points are not positive.
    #[error("the mode is not visible at a drive point, or force and displacement there have opposite signs")]
    NotVisible,
    /// The FRFs do not connect all degrees of freedom.
    #[error("the FRFs do not determine the shape at every measured point")]
    NotDetermined,
}

/// FRFs that share degrees of freedom, directly or by others: their places. Modes of different sets are independent.
pub fn connected(frfs: &[Frf]) -> Vec<Vec<usize>> {
    let mut sets: Vec<Vec<usize>> = Vec::new();
    for (index, frf) in frfs.iter().enumerate() {
        let shares = |other: &usize| {
            let other = &frfs[*other];
            [other.response, other.reference]
                .iter()
                .any(|dof| *dof == frf.response || *dof == frf.reference)
        };
        let (joined, mut apart): (Vec<_>, Vec<_>) = sets.into_iter().partition(|set| set.iter().any(shares));
        let mut own: Vec<usize> = joined.into_iter().flatten().chain([index]).collect();
        own.sort_unstable();
        apart.push(own);
        sets = apart;
    }
    sets.sort();
    sets
}

/// The shape of a mode of these FRFs.
///
/// # Errors
/// No drive point; a mode that is not visible there; degrees of freedom that are not connected.
///
/// # Panics
/// If `mode` was fitted to fewer FRFs.
pub fn shape_of(mode: &FittedMode, frfs: &[Frf]) -> Result<MeasuredShape, NoShape> {
    let mut dofs: Vec<Dof> = frfs
        .iter()
        .flat_map(|frf| [frf.response, frf.reference])
        .collect();
    dofs.sort_unstable();
    dofs.dedup();
    let place = |dof: Dof| dofs.binary_search(&dof).unwrap_or_default();
    let pairs: Vec<[usize; 2]> = frfs
        .iter()
        .map(|frf| [place(frf.response), place(frf.reference)])
        .collect();
    let drives = (0..frfs.len()).filter(|k| pairs[*k][0] == pairs[*k][1]);
    let strongest = drives
        .max_by(|a, b| mode.residues[*a].total_cmp(&mode.residues[*b]))
        .ok_or(NoShape::NoDrivePoint)?;
    if mode.residues[strongest].is_nan() || mode.residues[strongest] <= 0.0 {
        return Err(NoShape::NotVisible);
    }
    let measured = DVector::from_column_slice(&mode.residues[..frfs.len()]);
    let mut shape = start(&pairs, &mode.residues, strongest, dofs.len()).ok_or(NoShape::NotDetermined)?;
    for _ in 0..MOST_STEPS {
        let found = DVector::from_iterator(pairs.len(), pairs.iter().map(|[i, j]| shape[*i] * shape[*j]));
        let gain = gain(&pairs, &shape).ok_or(NoShape::NotDetermined)?;
        let step = gain * (&measured - found);
        shape += &step;
        if step.norm() <= END * shape.norm() {
            break;
        }
    }
    if shape[shape.iamax()] < 0.0 {
        shape.neg_mut();
    }
    let gain = gain(&pairs, &shape).ok_or(NoShape::NotDetermined)?;
    Ok(MeasuredShape {
        dofs,
        shape: shape.iter().copied().collect(),
        covariance: &gain * &mode.residues_covariance * gain.transpose(),
    })
}

/// A first shape: from the strongest drive point along the FRFs; `None` if they do not reach every degree of freedom.
fn start(pairs: &[[usize; 2]], residues: &[f64], strongest: usize, dofs: usize) -> Option<DVector<f64>> {
    let mut known: Vec<Option<f64>> = vec![None; dofs];
    known[pairs[strongest][0]] = Some(residues[strongest].sqrt());
    for _ in 0..dofs {
        for ([i, j], residue) in pairs.iter().zip(residues) {
            match (known[*i], known[*j]) {
                (None, Some(phi)) if phi != 0.0 => known[*i] = Some(residue / phi),
                (Some(phi), None) if phi != 0.0 => known[*j] = Some(residue / phi),
                _ => {}
            }
        }
    }
    let known: Option<Vec<f64>> = known.into_iter().collect();
    known.map(DVector::from_vec)
}

/// `(D^T D)^-1 D^T`.
fn gain(pairs: &[[usize; 2]], shape: &DVector<f64>) -> Option<DMatrix<f64>> {
    let mut slopes = DMatrix::<f64>::zeros(pairs.len(), shape.len());
    for (k, [i, j]) in pairs.iter().enumerate() {
        slopes[(k, *i)] += shape[*j];
        slopes[(k, *j)] += shape[*i];
    }
    let normal = slopes.transpose() * &slopes;
    Some(normal.cholesky()?.inverse() * slopes.transpose())
}

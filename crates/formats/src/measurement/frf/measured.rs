//! What is read of a file of FRFs.

use armill_core::dynamics::modal_fit::{Dof, Frf};

/// Largest number of frequencies of a file, all FRFs together.
pub(super) const MOST_FREQUENCIES: usize = 2_000_000;

/// FRFs of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeasuredFrfs {
    /// The FRFs, in the order of the file.
    pub frfs: Vec<Frf>,
    /// Coherence at each frequency of each FRF; empty if it is not known.
    pub coherences: Vec<Vec<f64>>,
    /// Ignored columns or datasets.
    pub unused: Vec<String>,
    /// What to know of them: assumed units, points and weights.
    pub notes: Vec<String>,
}

/// A degree of freedom with the sign of its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SignedDof {
    pub dof: Dof,
    /// 1 or -1.
    pub sign: f64,
}

impl SignedDof {
    /// Of the direction 1 to 3 for +x, +y, +z, negative for the opposite ones; `None` for rotations and scalars.
    pub fn of_direction(point: i64, direction: i64) -> Option<SignedDof> {
        let axis = direction.unsigned_abs().checked_sub(1)?;
        (axis < 3).then_some(SignedDof {
            dof: Dof {
                point,
                axis: axis as usize,
            },
            sign: direction.signum() as f64,
        })
    }

    /// Of a name: `1X`, `12-Y`, `3+Z`.
    pub fn of_name(name: &str) -> Option<SignedDof> {
        let name = name.trim();
        let (number, axis) = name.split_at_checked(name.len().checked_sub(1)?)?;
        let direction = match axis {
            "X" | "x" => 1,
            "Y" | "y" => 2,
            "Z" | "z" => 3,
            _ => return None,
        };
        let (number, sign) = match (number.strip_suffix('-'), number.strip_suffix('+')) {
            (Some(number), _) => (number, -1),
            (_, Some(number)) => (number, 1),
            _ => (number, 1),
        };
        SignedDof::of_direction(number.parse().ok()?, sign * direction)
    }
}

//! The four postures that differ in more than the wrist's flip, as signs of shoulder and elbow.

use crate::robot::{Branch, Elbow, Shoulder};

/// Signs of shoulder and elbow.
pub(in crate::kernel::lanes) fn signs(branch: Branch) -> [f64; 2] {
    [
        if branch.shoulder == Shoulder::Front {
            1.0
        } else {
            -1.0
        },
        if branch.elbow == Elbow::Up { 1.0 } else { -1.0 },
    ]
}

/// Shoulder and elbow signs of the four postures that differ in more than the wrist's flip, in the order of
/// [`Branch::ALL`].
pub(in crate::kernel::lanes) const FOUR: [[f64; 2]; 4] = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];

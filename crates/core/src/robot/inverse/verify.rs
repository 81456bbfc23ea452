//! Whether forward kinematics agrees with a solution.

use super::super::forward::Frames;
use super::super::unreachable::Unreachable;
use crate::frame::{Isometry, turn_between};

/// Greatest distance between the forward kinematics of a solution and the requested pose, m and rad.
///
/// The closed form is accurate to 1e-15 of the arm's length; a thousand times its worst is an inconsistent geometry.
pub(crate) const VERIFIED: f64 = 1e-9;

/// Verifies that these frames have the flange at the requested pose, within 1e-9 m and rad.
///
/// # Errors
/// [`Unreachable::Unverified`] with the distance missed.
pub fn verify(frames: &Frames, base_from_flange: &Isometry) -> Result<(), Unreachable> {
    let reached = &frames.base_from_flange;
    let away = reached.translation.vector - base_from_flange.translation.vector;
    let requested = base_from_flange.rotation.to_rotation_matrix();
    let turned = turn_between(reached.rotation.matrix(), requested.matrix());
    if away.norm() < VERIFIED && turned.norm() < VERIFIED {
        Ok(())
    } else {
        Err(Unreachable::Unverified { by: away.norm() })
    }
}
